//! Pictures that are compared after the one exposure that brings them nearest.

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
