//! A file that is either complete or absent.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Reason why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{path}: cannot be written: {error}")]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// The system's error.
    pub error: std::io::Error,
}

/// An output is a file that the command reads.
#[derive(Debug, thiserror::Error)]
#[error("{}: the command reads it{}, and would overwrite it; name another file with --out", .out.display(), .by)]
pub struct InputError {
    out: PathBuf,
    /// By which other name the command reads it, if it has one.
    by: String,
}

/// Refuses an output that is one of the files that a command reads, by whatever name or link.
pub fn refuse_input<'a>(out: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), InputError> {
    let is_out = |input: &&Path| same_file::is_same_file(out, input).unwrap_or(false);
    let Some(input) = inputs.into_iter().find(is_out) else { return Ok(()) };
    let by = if input == out { String::new() } else { format!(" as {}", input.display()) };
    Err(InputError { out: out.to_owned(), by })
}

/// Checks that a file can be written at `path`, so that an error shows before hours of rendering
/// instead of after.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let writable = || {
        let target = followed(path)?;
        if target.is_dir() {
            return Err(std::io::Error::from(std::io::ErrorKind::IsADirectory));
        }
        if is_stream(&target) {
            std::fs::OpenOptions::new().write(true).open(&target).map(drop)
        } else {
            aside(&target).map(drop)
        }
    };
    writable().map_err(|error| WriteError { path: path.to_owned(), error: plain(&error) })
}

/// Writes bytes to a temporary file next to `path`, then renames it, so that no reader sees a
/// partial file.
///
/// Links are followed, an existing file keeps its permissions, and devices and pipes are written to
/// directly.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let write = || {
        let target = followed(path)?;
        if is_stream(&target) {
            return std::fs::OpenOptions::new().write(true).open(&target)?.write_all(bytes);
        }
        let mut file = aside(&target)?;
        file.write_all(bytes)?;
        if let Ok(older) = std::fs::metadata(&target) {
            file.as_file().set_permissions(older.permissions())?;
        }
        file.persist(&target).map_err(|error| error.error)?;
        Ok(())
    };
    write().map_err(|error| WriteError { path: path.to_owned(), error: plain(&error) })
}

/// Creates a temporary file next to `path`, which is deleted when dropped. Other users may read it
/// as far as the process's umask allows.
fn aside(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(path))
}

/// Largest number of links followed, as on Linux.
const MOST_LINKS: usize = 40;

/// Follows the links at `path` and returns their target; the last target need not exist.
fn followed(path: &Path) -> std::io::Result<PathBuf> {
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&place) {
            Ok(target) => place = folder_of(&place).join(target),
            Err(_) => return Ok(place),
        }
    }
    Err(std::io::Error::other("it is a link that leads back to itself"))
}

/// Returns whether `path` exists but is not a regular file or folder: a device, a pipe, a socket.
fn is_stream(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
}

/// Returns the system's own error, without the name of a temporary file.
fn plain(error: &std::io::Error) -> std::io::Error {
    // Links are followed and files are made, so only the folder can be missing.
    if error.kind() == std::io::ErrorKind::NotFound {
        return std::io::Error::other("its folder does not exist; make it first");
    }
    let inner = error.get_ref().and_then(std::error::Error::source);
    let code = inner.and_then(|inner| inner.downcast_ref::<std::io::Error>()).and_then(std::io::Error::raw_os_error);
    match code.or_else(|| error.raw_os_error()) {
        Some(code) => std::io::Error::from_raw_os_error(code),
        None if error.kind() == std::io::ErrorKind::Other => std::io::Error::other(error.to_string()),
        None => error.kind().into(),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    #[test]
    fn links_are_followed_and_permissions_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path_of = |name: &str| folder.path().join(name);
        std::fs::create_dir(path_of("far")).expect("a folder");
        std::fs::write(path_of("far/old.txt"), "old").expect("a file");
        std::fs::set_permissions(path_of("far/old.txt"), std::fs::Permissions::from_mode(0o640)).expect("set");
        // A chain of links, relative and absolute, and one link to a missing file.
        symlink("far/old.txt", path_of("near")).expect("a link");
        symlink(path_of("near"), path_of("nearer")).expect("a link");
        symlink("far/new.txt", path_of("dangling")).expect("a link");
        replace(&path_of("nearer"), b"new").expect("written");
        replace(&path_of("dangling"), b"first").expect("written");
        for link in ["near", "nearer", "dangling"] {
            assert!(path_of(link).is_symlink(), "{link}");
        }
        let read = |name: &str| std::fs::read_to_string(path_of(name)).expect("a file");
        assert_eq!((read("far/old.txt").as_str(), read("far/new.txt").as_str()), ("new", "first"));
        let mode = |name: &str| std::fs::metadata(path_of(name)).expect("a file").permissions().mode() & 0o777;
        assert_eq!(mode("far/old.txt"), 0o640);
        assert_eq!(std::fs::read_dir(path_of("far")).expect("a folder").count(), 2);
        symlink("circle", path_of("circle")).expect("a link");
        let message = replace(&path_of("circle"), b"").expect_err("nowhere").to_string();
        assert!(message.contains("circle: cannot be written: it is a link that leads back to itself"), "{message}");
    }

    #[test]
    fn devices_stay_devices() {
        let folder = tempfile::tempdir().expect("a folder");
        let link = folder.path().join("null.png");
        symlink("/dev/null", &link).expect("a link");
        check_writable(&link).expect("writable");
        replace(&link, b"nothing").expect("written");
        let metadata = std::fs::metadata("/dev/null").expect("it is there");
        assert!(!metadata.is_file() && link.is_symlink());
    }

    #[test]
    fn no_message_names_a_temporary_file() {
        let folder = tempfile::tempdir().expect("a folder");
        for path in ["none/out.png", "file/out.png"] {
            std::fs::write(folder.path().join("file"), "").expect("a file");
            let path = folder.path().join(path);
            for message in
                [check_writable(&path), replace(&path, b"")].map(|error| error.expect_err("nowhere").to_string())
            {
                let rest =
                    message.strip_prefix(&format!("{}: cannot be written: ", path.display())).expect("the path first");
                assert!(!rest.contains(".tmp") && !rest.contains(" at path"), "{message}");
            }
        }
    }
}
