//! The committed pictures, and how a new one is compared with them: FLIP on the encoded picture,
//! RMSE on linear radiance.

pub mod beside_walks;
pub mod browse;
mod committed;
mod comparison;
mod error;
pub mod exposure;
mod files;
pub mod frames;
mod label;
pub mod motion;
mod shots;
mod sizes;
pub mod strip;
mod walked;

pub use committed::{Committed, accept, render_scene, render_shot};
pub use comparison::{Comparison, MOST_FLIP, MOST_HIGH_FLIP, MOST_RMSE, compare, compare_linear, flip};
pub use error::SnapshotError;
pub use files::{folder, read, reference_picture};
pub use shots::{SHOTS, Shot};
pub use sizes::{EXR_SIDE, LARGEST_FILE, PNG_SIDE};
pub use walked::{WALKED, WalkedReference};
