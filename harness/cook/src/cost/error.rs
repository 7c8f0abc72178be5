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

/// What `found` is to be multiplied by to come as near as it can to `truth`, in linear radiance by root mean square. Both are pixels of one size with
/// coverage, which does not count. Of a picture without light no exposure is nearer than another: 1.
#[must_use]
pub fn best_exposure(found: &[[f32; 4]], truth: &[[f32; 4]]) -> f64 {
    let [both, own, _] = products(found, truth);
    if own > 0.0 { both / own } else { 1.0 }
}

/// Root mean square distance of linear radiance from `truth`, over the root mean square of that, after the [`best_exposure`].
#[must_use]
pub fn exposed_distance(found: &[[f32; 4]], truth: &[[f32; 4]]) -> f64 {
    let [both, own, other] = products(found, truth);
    if ![both, own, other].into_iter().all(f64::is_finite) {
        return f64::INFINITY;
    }
    // The least of |k a - b|^2 over k.
    let nearer = if own > 0.0 { both * both / own } else { 0.0 };
    ((other - nearer).max(0.0) / other).sqrt()
}

/// The sums of a b, a a and b b over all pixels' channels.
fn products(found: &[[f32; 4]], truth: &[[f32; 4]]) -> [f64; 3] {
    let (mut both, mut own, mut other) = (0.0, 0.0, 0.0);
    for (found, truth) in found.iter().zip(truth) {
        for (a, b) in found[..3].iter().zip(&truth[..3]) {
            let (a, b) = (f64::from(*a), f64::from(*b));
            both += a * b;
            own += a * a;
            other += b * b;
        }
    }
    [both, own, other]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_does_not_count_and_shape_does() {
        let truth = [[1.0, 2.0, 0.0, 1.0], [0.0, 0.0, 2.0, 1.0]];
        let brighter = truth.map(|[r, g, b, _]| [3.0 * r, 3.0 * g, 3.0 * b, 0.0]);
        assert!(exposed_distance(&brighter, &truth) < 1e-7);
        // Two of nine parts of the square can be met.
        assert!(
            (exposed_distance(&[[0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0]], &truth).powi(2) - 7.0 / 9.0).abs() < 1e-12
        );
        assert_eq!(exposed_distance(&[[0.0; 4]; 2], &truth), 1.0);
    }
}
