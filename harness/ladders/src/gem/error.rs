//! Errors of a rung's picture against the reference.

use lapidary_render::Picture;
use lapidary_snapshots as snapshot;

/// Errors of a picture against its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Mean FLIP of the tone-mapped pictures over the pixels that the stone covers, 0 to 1.
    pub flip: f64,
    /// RMSE of linear radiance, divided by the reference's root mean square.
    pub rmse: f64,
    /// Mean radiance divided by the reference's, minus 1: positive if the picture is too bright.
    pub energy: f64,
}

impl Errors {
    /// Compares `picture` with `reference`, which have the same size and tone mapping. A committed
    /// reference holds only pixel means, so its counterpart has to come from
    /// [`render_means`](lapidary_render::render_means).
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
}
