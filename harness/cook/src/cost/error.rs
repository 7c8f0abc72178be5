//! How far a rung's picture is from the reference.

use crate::snapshot;
use lapidary_render::Picture;
use serde::{Deserialize, Serialize};

/// The distance of a picture from its reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Mean FLIP of the tone-mapped pictures, over the pixels that the stone covers, 0 to 1.
    pub flip: f64,
    /// RMSE of linear radiance over the reference's root mean square.
    pub rmse: f64,
    /// Mean radiance over the reference's, less 1: positive where the picture is too bright.
    pub energy: f64,
}

impl Errors {
    /// Of `picture` against `reference`, both of one size and both shown alike: of a committed reference there are means alone, so that its counterpart
    /// is of [`render_means`](lapidary_render::render_means).
    pub fn between(picture: &Picture, reference: &Picture) -> Self {
        let map = snapshot::flip(picture, reference);
        let covered = |index: usize| reference.linear[index][3] > 0.0;
        let (mut flip, mut count) = (0.0, 0.0);
        let (mut error, mut power, mut sum, mut reference_sum) = (0.0, 0.0, 0.0, 0.0);
        for (index, (found, expected)) in picture.linear.iter().zip(&reference.linear).enumerate() {
            if covered(index) {
                flip += f64::from(map[index]);
                count += 1.0;
            }
            for (found, expected) in found[..3].iter().zip(&expected[..3]) {
                let (found, expected) = (f64::from(*found), f64::from(*expected));
                error += (found - expected).powi(2);
                power += expected.powi(2);
                sum += found;
                reference_sum += expected;
            }
        }
        Self { flip: flip / count, rmse: (error / power).sqrt(), energy: sum / reference_sum - 1.0 }
    }

    /// The size of the error by the measure of that number in [`super::MEASURES`], of which it has the first three.
    pub fn of(&self, measure: usize) -> f64 {
        match measure {
            0 => self.flip,
            1 => self.rmse,
            _ => self.energy.abs(),
        }
    }
}
