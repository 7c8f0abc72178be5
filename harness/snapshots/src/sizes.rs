//! Sizes of committed pictures and files.

/// Width and height in pixels of a usual PNG for viewing.
pub const PNG_SIDE: u32 = 512;
/// Width and height in pixels of the EXR with linear radiance.
pub const EXR_SIDE: u32 = 256;
/// Size limit of a committed file in bytes.
pub const LARGEST_FILE: u64 = 1024 * 1024;
