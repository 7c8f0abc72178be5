//! `cook compare`.

use super::{Failure, Outcome, output};
use lapidary_cook::compare::{Difference, compare};
use std::path::PathBuf;

/// Compares two pictures of one size, PNG or EXR: mean FLIP of what one sees, and RMSE of linear
/// radiance over the reference's root mean square. Only pixels that the reference covers count;
/// all, if it covers none.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook compare reference.exr brilliant.exr")]
pub(super) struct Arguments {
    /// Picture that counts as right.
    reference: PathBuf,
    /// Picture to compare with it.
    picture: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let Difference { flip, rmse, pixels } = compare(&arguments.reference, &arguments.picture)?;
    output::line(&format!("FLIP {flip:.4}, RMSE {rmse:.4}, over {pixels} pixels"))?;
    Ok(Outcome::Passed)
}
