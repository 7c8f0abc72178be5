//! Failing inputs, kept as bits in a folder and replayed first in later runs of the cookbook's own
//! functions.
//!
//! One file per function, one line per input: the words in hexadecimal, then a comment with the
//! reason of the failure.

use crate::formula::Words;
use std::io::Write as _;
use std::path::PathBuf;

/// The reason why inputs could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PersistenceError {
    /// An error from the operating system.
    #[error("{path}: failing inputs cannot be kept there: {error}; choose another folder with --failures DIR")]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// Cause.
        error: std::io::Error,
    },
    /// A line that does not hold a row.
    #[error("{path}:{line}: expected {expected} words of 8 hexadecimal digits; correct or delete the line")]
    Line {
        /// Path of the file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// Number of words in a row.
        expected: usize,
    },
}

/// The folder that holds the files of a run.
#[derive(Clone, Debug)]
pub struct Regressions {
    folder: PathBuf,
}

impl Regressions {
    /// Uses the files in `folder`.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    fn path(&self, function: &str) -> PathBuf {
        self.folder.join(format!("{function}.txt"))
    }

    /// Returns the rows kept for `function`, of `words` words each; empty if there is no file.
    pub fn load(&self, function: &str, words: usize) -> Result<Vec<Words>, PersistenceError> {
        let path = self.path(function);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(PersistenceError::Io { path, error }),
        };
        let mut rows = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let bits = line.split('#').next().unwrap_or_default().trim();
            if bits.is_empty() {
                continue;
            }
            let row: Option<Words> = bits.split_whitespace().map(|word| u32::from_str_radix(word, 16).ok()).collect();
            match row {
                Some(row) if row.len() == words => rows.push(row),
                _ => return Err(PersistenceError::Line { path, line: index + 1, expected: words }),
            }
        }
        Ok(rows)
    }

    /// Keeps a failing row, unless it is already kept, and returns the file's path.
    pub fn store(&self, function: &str, row: &Words, reason: &str) -> Result<PathBuf, PersistenceError> {
        let path = self.path(function);
        if self.load(function, row.len())?.contains(row) {
            return Ok(path);
        }
        let write = || {
            std::fs::create_dir_all(&self.folder)?;
            let mut file = std::fs::OpenOptions::new().create(true).append(true).open(&path)?;
            let words: Vec<String> = row.iter().map(|word| format!("{word:08x}")).collect();
            writeln!(file, "{} # {}", words.join(" "), reason.replace('\n', " "))
        };
        write().map_err(|error| PersistenceError::Io { path: path.clone(), error })?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_row_is_replayed_with_its_bits() {
        let folder = tempfile::tempdir().expect("a folder");
        let regressions = Regressions::in_folder(folder.path());
        assert_eq!(regressions.load("f", 2).expect("no file is no rows"), Vec::<Words>::new());
        let rows = [vec![0x7fc0_0001, 0x8000_0000], vec![1, 2]];
        for row in &rows {
            regressions.store("f", row, "why\nso").expect("written");
            regressions.store("f", row, "again").expect("written once");
        }
        assert_eq!(regressions.load("f", 2).expect("read"), rows);
        assert!(regressions.load("f", 3).expect_err("another width").to_string().contains("f.txt:1: expected 3 words"));
    }
}
