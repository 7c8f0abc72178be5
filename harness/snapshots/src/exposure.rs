//! Compares pictures after applying the exposure that brings them closest.

/// Returns the factor that brings `found` closest to `truth`, by root mean square of linear
/// radiance. Both are pixels of the same size; coverage is ignored. For a picture without light
/// every exposure is equally good: 1.
#[must_use]
pub fn best_exposure(found: &[[f32; 4]], truth: &[[f32; 4]]) -> f64 {
    let [both, found_power, _] = products(found, truth);
    if found_power > 0.0 { both / found_power } else { 1.0 }
}

/// Returns the root mean square distance of linear radiance from `truth`, divided by the root mean
/// square of `truth`, after applying [`best_exposure`].
#[must_use]
pub fn exposed_distance(found: &[[f32; 4]], truth: &[[f32; 4]]) -> f64 {
    let [both, found_power, other] = products(found, truth);
    if ![both, found_power, other].into_iter().all(f64::is_finite) {
        return f64::INFINITY;
    }
    // The minimum of |k a - b|^2 over k.
    let nearer = if found_power > 0.0 { both * both / found_power } else { 0.0 };
    ((other - nearer).max(0.0) / other).sqrt()
}

/// Returns the root mean square distance of linear radiance from `truth`, divided by the root mean
/// square of `truth`, as both are.
#[must_use]
pub fn distance(found: &[[f32; 4]], truth: &[[f32; 4]]) -> f64 {
    let [both, found_power, other] = products(found, truth);
    let square = (found_power - 2.0 * both + other) / other;
    if square.is_nan() { f64::INFINITY } else { square.max(0.0).sqrt() }
}

/// Returns the sums of a b, a a and b b over the colour channels of all pixels.
fn products(found: &[[f32; 4]], truth: &[[f32; 4]]) -> [f64; 3] {
    let (mut both, mut found_power, mut other) = (0.0, 0.0, 0.0);
    for (found, truth) in found.iter().zip(truth) {
        for (a, b) in found[..3].iter().zip(&truth[..3]) {
            let (a, b) = (f64::from(*a), f64::from(*b));
            both += a * b;
            found_power += a * a;
            other += b * b;
        }
    }
    [both, found_power, other]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_does_not_count_and_shape_does() {
        let truth = [[1.0, 2.0, 0.0, 1.0], [0.0, 0.0, 2.0, 1.0]];
        let brighter = truth.map(|[r, g, b, _]| [3.0 * r, 3.0 * g, 3.0 * b, 0.0]);
        assert!(exposed_distance(&brighter, &truth) < 1e-7);
        // Two ninths of the square can be matched.
        assert!(
            (exposed_distance(&[[0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0]], &truth).powi(2) - 7.0 / 9.0).abs() < 1e-12
        );
        assert_eq!(exposed_distance(&[[0.0; 4]; 2], &truth), 1.0);
        assert_eq!([distance(&[[0.0; 4]; 2], &truth), distance(&truth, &truth)], [1.0, 0.0]);
        assert!((distance(&brighter, &truth) - 2.0).abs() < 1e-12);
    }
}
