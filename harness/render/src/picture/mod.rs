//! Pictures: their pixels, the tiles in which they are drawn, how samples are displayed, and files.

pub(crate) mod display;
pub(crate) mod displayed;
pub mod file;
pub(crate) mod formats;
mod rendered;
mod tile;

pub use rendered::{Picture, WalkedPicture};
pub(crate) use tile::Tile;
