//! Accuracy of a device's built-in functions: those of one float over all floats, and those of two,
//! as well as the rounding of sums and products, on samples.

mod binary;
pub mod command;
mod lavapipe;
mod measure;
mod measured;
mod page;
mod unary;

pub use lavapipe::Lavapipe;
pub use measure::{count, measure};
pub use measured::{Measured, Report, Start};
pub use page::{side_by_side, text};
