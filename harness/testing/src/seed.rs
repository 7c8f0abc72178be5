//! The suite's seed, derived from the commit: each change is tested with different inputs, and
//! repeated runs on one commit with the same ones.

use lapidary_assay::draws::mix;
use lapidary_cookbook::repository;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Environment variable that overrides the suite's seed: a whole number, as printed by a failing
/// run.
pub const SEED_VARIABLE: &str = "LAPIDARY_SEED";

/// The seed if there is no commit to derive it from, as in an unpacked archive.
const WITHOUT_COMMIT: u32 = 0x1a91_da21;

/// A seed and its origin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SuiteSeed {
    /// The seed; a derived one fits 32 bits, so that it is easy to retype.
    pub value: u64,
    /// Description of the origin, for the first line of a run.
    pub origin: String,
}

impl SuiteSeed {
    /// Returns the suite's seed: from the environment, else from the commit, else a fixed one.
    ///
    /// # Errors
    /// Returns an error if the environment's value is not a whole number.
    pub fn of_environment() -> Result<&'static SuiteSeed, String> {
        static SEED: OnceLock<Result<SuiteSeed, String>> = OnceLock::new();
        SEED.get_or_init(|| derive(std::env::var(SEED_VARIABLE).ok().as_deref(), || tree_of(&repository::place())))
            .as_ref()
            .map_err(Clone::clone)
    }

    /// Returns another seed of the same commit, for a second run with different inputs.
    pub fn second(&self) -> u64 {
        mix(self.value) >> 32
    }
}

/// The tree of the checked-out commit, and whether files differ from it.
struct Tree {
    id: String,
    changed: bool,
}

fn derive(variable: Option<&str>, tree: impl FnOnce() -> Option<Tree>) -> Result<SuiteSeed, String> {
    if let Some(text) = variable {
        let value =
            text.parse().map_err(|_| format!("{SEED_VARIABLE}={text}: expected a whole number from 0 to 2^64 - 1"))?;
        return Ok(SuiteSeed { value, origin: format!("from {SEED_VARIABLE}") });
    }
    let Some(Tree { id, changed }) = tree() else {
        let origin = "no commit here to derive it from".to_owned();
        return Ok(SuiteSeed { value: WITHOUT_COMMIT.into(), origin });
    };
    let note = if changed { "; uncommitted changes: once committed they have another" } else { "" };
    let value = u64::from_str_radix(id.get(..8).unwrap_or_default(), 16).unwrap_or(WITHOUT_COMMIT.into());
    Ok(SuiteSeed { value, origin: format!("from the commit's tree {}{note}", id.get(..12).unwrap_or(&id)) })
}

/// Returns the tree of the folder itself; `None` for an archive unpacked inside another repository.
fn tree_of(folder: &Path) -> Option<Tree> {
    let git = |arguments: &[&str]| -> Option<String> {
        let output = Command::new("git").arg("-C").arg(folder).args(arguments).stderr(Stdio::null()).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let id = git(&["rev-parse", "--verify", "HEAD:./"])?;
    let changed =
        git(&["status", "--porcelain", "--untracked-files=no", "."]).is_none_or(|changes| !changes.is_empty());
    Some(Tree { id, changed })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ID: &str = "8f3c2a10bb4e0d4f9a3f1c2d3e4f5061728394a5";

    fn tree(changed: bool) -> Option<Tree> {
        Some(Tree { id: ID.to_owned(), changed })
    }

    #[test]
    fn a_seed_follows_from_the_commit_and_can_be_given() {
        let committed = derive(None, || tree(false)).expect("a seed");
        assert_eq!(committed.value, 0x8f3c_2a10);
        assert_eq!(committed.origin, "from the commit's tree 8f3c2a10bb4e");
        let changed = derive(None, || tree(true)).expect("a seed");
        assert_eq!(changed.value, committed.value);
        assert!(changed.origin.contains("uncommitted changes"), "{}", changed.origin);
        assert_eq!(derive(Some("12"), || unreachable!("given")).expect("a seed").value, 12);
        assert_eq!(derive(None, || None).expect("a seed").value, u64::from(WITHOUT_COMMIT));
        assert!(derive(Some("-1"), || None).expect_err("no seed").starts_with("LAPIDARY_SEED=-1: expected"));
    }

    #[test]
    fn the_second_seed_is_another_one_that_fits_32_bits() {
        for value in [0, 1, 2, u64::from(u32::MAX)] {
            let seed = SuiteSeed { value, origin: String::new() };
            assert_ne!(seed.second(), value);
            assert!(seed.second() <= u64::from(u32::MAX));
        }
    }

    #[test]
    fn a_folder_outside_of_a_repository_has_no_tree() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(tree_of(folder.path()).is_none());
        let git = |arguments: &[&str]| {
            let status = Command::new("git").arg("-C").arg(folder.path()).args(arguments).output().expect("git runs");
            assert!(status.status.success(), "{status:?}");
        };
        git(&["init", "--quiet"]);
        assert!(tree_of(folder.path()).is_none(), "no commit yet");
        std::fs::write(folder.path().join("a"), "1").expect("written");
        git(&["add", "a"]);
        git(&["-c", "user.name=a", "-c", "user.email=a@b", "commit", "--quiet", "--message", "one"]);
        let first = tree_of(folder.path()).expect("a tree");
        assert!(!first.changed);
        std::fs::write(folder.path().join("a"), "2").expect("written");
        let second = tree_of(folder.path()).expect("a tree");
        assert!(second.changed && second.id == first.id);
        let inside = folder.path().join("archive");
        std::fs::create_dir(&inside).expect("made");
        assert!(tree_of(&inside).is_none(), "not of this repository");
    }
}
