//! Reading of text files named by the user.

use std::io::Read as _;
use std::path::Path;

/// Returns the text of a regular file of at most `most_bytes`, without a byte order mark. An error
/// is a single line with the file's name.
pub fn read(path: &Path, most_bytes: u64) -> Result<String, String> {
    let unreadable = |reason: &str| format!("{}: cannot be read: {reason}", path.display());
    // Devices and pipes may never end. Checked before the file is opened, because opening a pipe
    // waits for its other end.
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(&error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable(crate::not_a_file(&metadata)));
    }
    let mut bytes = Vec::new();
    // The reported size may be wrong: the file may grow, or be generated while it is read, as below
    // /proc.
    std::fs::File::open(path)
        .and_then(|file| file.take(most_bytes + 1).read_to_end(&mut bytes))
        .map_err(|error| unreadable(&error.to_string()))?;
    if bytes.len() as u64 > most_bytes {
        return Err(format!("{}: is larger than {most_bytes} bytes; keep what is needed alone", path.display()));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        format!("{}: is not UTF-8 text, from byte {place} on; save it as UTF-8", path.display())
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}
