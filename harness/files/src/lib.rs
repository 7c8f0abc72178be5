//! What a user names: files and folders, read and written whole; names, with the nearest known one.

pub mod folder;
pub mod nearest;
mod regular_file;
pub mod text_file;
mod whole_file;

pub use regular_file::not_a_file;
pub use whole_file::{InputError, WriteError, check_writable, refuse_input, replace};
