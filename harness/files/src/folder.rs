//! Writes a folder that is either complete or absent: it is filled elsewhere and then replaces an
//! older one, but only one that it wrote itself.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Whose folder it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Owner {
    /// The command that writes it, such as `cook gallery`.
    pub command: &'static str,
    /// Name of the file that lists the files written by [`replace`], except itself, one path per line.
    pub marker: &'static str,
}

/// The reasons why a folder was not written.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder contains something that the command did not write.
    #[error(
        "{} holds `{name}`, which `{command}` did not write and would have to delete; \
        name another folder with --out, or move `{name}` away",
        out.display()
    )]
    Foreign {
        /// Path of the folder.
        out: PathBuf,
        /// The first such file, as a path relative to the folder.
        name: String,
        /// The command.
        command: &'static str,
    },
    /// A file with that name exists.
    #[error("{} is not a folder; name another one with --out", out.display())]
    NotAFolder {
        /// Path of the file.
        out: PathBuf,
    },
    /// The folder cannot be read.
    #[error("{} cannot be read: {source}; name another folder with --out", path.display())]
    Read {
        /// Path of the folder.
        path: PathBuf,
        /// The underlying file system error.
        source: io::Error,
    },
    /// The folder cannot be written or replaced.
    #[error("{} cannot be written: {source}; name another folder with --out, on a disk with room", path.display())]
    Write {
        /// Path of the folder or file.
        path: PathBuf,
        /// The underlying file system error.
        source: io::Error,
    },
}

/// Files that file managers create in a folder when it is merely viewed.
const LITTER: [&str; 3] = [".DS_Store", "Thumbs.db", "desktop.ini"];

/// Lets `fill` write into an empty folder, and moves that in place of `out`, which may be absent,
/// empty or an earlier result. Returns the folder's absolute path.
///
/// # Errors
/// Returns the errors of `fill` and of the file system, and [`FolderError::Foreign`] if `out`
/// contains anything that an earlier call of the owner did not write. In each case `out` stays
/// unchanged.
pub fn replace<E: From<FolderError>>(
    out: &Path,
    owner: Owner,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<PathBuf, E> {
    let failed = |source: io::Error| FolderError::Write { path: out.to_owned(), source };
    // An existing folder under its canonical name, so that a link to it stays a link.
    let out = match out.canonicalize() {
        Ok(existing) => existing,
        Err(_) => std::path::absolute(out).map_err(failed)?,
    };
    refuse_foreign(&out, owner)?;
    let parent = out.parent().ok_or_else(|| failed(io::Error::other("it has no folder around it")))?;
    fs::create_dir_all(parent).map_err(failed)?;

    let aside = tempfile::Builder::new().prefix(&format!("{}-", owner.marker)).tempdir_in(parent).map_err(failed)?;
    // A temporary folder is private to its owner; the folder inside it has the usual permissions.
    let (new, old) = (aside.path().join("new"), aside.path().join("old"));
    fs::create_dir(&new).map_err(failed)?;
    fill(&new)?;
    let mut names = files(&new).map_err(failed)?;
    names.sort();
    fs::write(new.join(owner.marker), names.join("\n") + "\n").map_err(failed)?;

    let exists = fs::symlink_metadata(&out).is_ok();
    if exists {
        fs::rename(&out, &old).map_err(failed)?;
    }
    if let Err(source) = fs::rename(&new, &out) {
        if exists && fs::rename(&old, &out).is_err() {
            // Keeps the older folder, which would otherwise be deleted with the temporary folder.
            let _kept = aside.keep();
        }
        return Err(failed(source).into());
    }
    Ok(out)
}

/// Returns an error if `out` exists and is neither empty nor made up of files that [`replace`]
/// wrote.
fn refuse_foreign(out: &Path, owner: Owner) -> Result<(), FolderError> {
    let failed = |source: io::Error| FolderError::Read { path: out.to_owned(), source };
    if fs::symlink_metadata(out).is_err() {
        return Ok(());
    }
    if !out.is_dir() {
        return Err(FolderError::NotAFolder { out: out.to_owned() });
    }
    let written = match fs::read_to_string(out.join(owner.marker)) {
        Ok(list) => Some(list),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(failed(error)),
    };
    // Without the marker, checking the top level is enough: the folder may be somebody's home.
    let mut found = match &written {
        Some(_) => files(out).map_err(failed)?,
        None => entries(out).map_err(failed)?.into_iter().map(|(name, _)| name).collect(),
    };
    found.sort();
    let ours = |name: &String| {
        let last = name.rsplit('/').next().unwrap_or(name);
        let listed = written.as_deref().unwrap_or_default().lines().any(|line| line == name);
        name == owner.marker || LITTER.contains(&last) || listed
    };
    match found.into_iter().find(|name| !ours(name)) {
        Some(name) => Err(FolderError::Foreign { out: out.to_owned(), name, command: owner.command }),
        None => Ok(()),
    }
}

/// Returns the entries of a folder: names, and whether each is a folder itself. A link is not a
/// folder, whatever its target.
fn entries(folder: &Path) -> io::Result<Vec<(String, bool)>> {
    fs::read_dir(folder)?
        .map(|entry| {
            let entry = entry?;
            Ok((entry.file_name().to_string_lossy().into_owned(), entry.file_type()?.is_dir()))
        })
        .collect()
}

/// Returns the files below a folder as relative paths with `/` between the parts.
fn files(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for (name, is_folder) in entries(folder)? {
        if is_folder {
            let below = files(&folder.join(&name))?;
            names.extend(below.into_iter().map(|file| format!("{name}/{file}")));
        } else {
            names.push(name);
        }
    }
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWNER: Owner = Owner { command: "cook test", marker: ".lapidary-test" };

    fn fill(text: &'static str) -> impl FnOnce(&Path) -> Result<(), FolderError> {
        move |folder| {
            fs::create_dir(folder.join("images")).expect("a new folder");
            fs::write(folder.join("images/a.png"), text).expect("a new file");
            Ok(())
        }
    }

    #[test]
    fn a_result_replaces_an_empty_folder_and_an_earlier_result() {
        let around = tempfile::tempdir().expect("temporary folder");
        let out = around.path().join("deep/out");
        fs::create_dir_all(&out).expect("a new folder");
        for text in ["first", "second"] {
            let written = replace(&out, OWNER, fill(text)).expect("nothing foreign");
            assert_eq!(fs::read_to_string(written.join("images/a.png")).expect("written"), text);
            fs::write(out.join(".DS_Store"), "looked at").expect("writable");
        }
        assert_eq!(fs::read_dir(around.path().join("deep")).expect("readable").count(), 1, "nothing is left aside");
    }

    #[test]
    fn a_foreign_folder_or_file_is_refused_and_kept() {
        let around = tempfile::tempdir().expect("temporary folder");
        let out = around.path().join("out");
        fs::create_dir(&out).expect("a new folder");
        fs::write(out.join("thesis.tex"), "years").expect("writable");
        let error = replace(&out, OWNER, fill("x")).expect_err("foreign");
        assert!(error.to_string().contains("thesis.tex"), "{error}");
        assert_eq!(fs::read_to_string(out.join("thesis.tex")).expect("kept"), "years");
        assert!(matches!(replace(&out.join("thesis.tex"), OWNER, fill("x")), Err(FolderError::NotAFolder { .. })));
    }

    #[test]
    fn a_file_that_was_added_to_a_result_is_refused_and_kept() {
        let around = tempfile::tempdir().expect("temporary folder");
        let out = around.path().join("out");
        replace(&out, OWNER, fill("x")).expect("nothing is there");
        fs::write(out.join("images/mine.png"), "mine").expect("writable");
        assert!(matches!(replace(&out, OWNER, fill("y")), Err(FolderError::Foreign { .. })));
        assert_eq!(fs::read_to_string(out.join("images/mine.png")).expect("kept"), "mine");
        assert_eq!(fs::read_to_string(out.join("images/a.png")).expect("kept"), "x");
    }

    #[test]
    fn a_failed_run_leaves_what_was_there() {
        let around = tempfile::tempdir().expect("temporary folder");
        let out = around.path().join("out");
        let fail = |folder: &Path| {
            fs::write(folder.join("half"), "half").expect("writable");
            Err(FolderError::NotAFolder { out: folder.to_owned() })
        };
        assert!(replace(&out, OWNER, fail).is_err());
        assert_eq!(fs::read_dir(around.path()).expect("readable").count(), 0);
        replace(&out, OWNER, fill("x")).expect("nothing is there");
        assert!(replace(&out, OWNER, fail).is_err());
        assert_eq!(fs::read_to_string(out.join("images/a.png")).expect("kept"), "x");
    }
}
