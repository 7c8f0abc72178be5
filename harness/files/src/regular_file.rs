//! Regular files, told from folders and devices.

/// Returns what is wrong with a path whose `metadata` is not that of a regular file, as the end of a
/// sentence.
#[must_use]
pub fn not_a_file(metadata: &std::fs::Metadata) -> &'static str {
    if metadata.is_dir() { "it is a folder" } else { "it is not a regular file" }
}
