//! The repository that this program acts on, for what needs more of it than the program holds.

use std::path::{Path, PathBuf};

/// Variable with the repository's folder, which the launcher `./cook` sets: its own folder. A clone may be mounted elsewhere
/// than where the program was built.
pub const VARIABLE: &str = "LAPIDARY_REPOSITORY";

/// The repository is not where the program was built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`cook {command}` needs the cookbook's repository, and {} holds it no longer; clone it and run ./cook {command} there", .place.display())]
pub struct NoRepository {
    command: &'static str,
    place: PathBuf,
}

/// Returns the folder of the launcher that runs this program; without a launcher, where the repository was when the program
/// was built.
#[must_use]
pub fn place() -> PathBuf {
    if let Some(folder) = std::env::var_os(VARIABLE) {
        return PathBuf::from(folder);
    }
    let harness = Path::new(env!("CARGO_MANIFEST_DIR"));
    harness.ancestors().nth(2).unwrap_or(harness).to_owned()
}

/// Returns the repository's folder; `None` if the program outlived it, as `cargo install` allows.
#[must_use]
pub fn root() -> Option<PathBuf> {
    Some(place()).filter(|root| root.join("harness/cook/Cargo.toml").is_file())
}

/// Returns the repository's folder, for a command that does nothing without it.
///
/// # Errors
/// Returns an error that names the command if the repository is gone.
pub fn required(command: &'static str) -> Result<PathBuf, NoRepository> {
    root().ok_or_else(|| NoRepository { command, place: place() })
}

/// Returns where a command writes if it is not told: `target/NAME` for one who works in the repository, and
/// `lapidary-NAME` in the current folder elsewhere.
#[must_use]
pub fn output(name: &str) -> PathBuf {
    let is_inside = |root: &PathBuf| {
        let (root, current) = (root.canonicalize(), std::env::current_dir().and_then(|folder| folder.canonicalize()));
        matches!((root, current), (Ok(root), Ok(current)) if current.starts_with(&root))
    };
    match root().filter(is_inside) {
        Some(root) => root.join("target").join(name),
        None => PathBuf::from(format!("lapidary-{name}")),
    }
}
