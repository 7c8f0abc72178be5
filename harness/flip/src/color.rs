//! Colour spaces of FLIP: from sRGB to the opponent space of the filters, and on to the differences of colour.
//!
//! The tristimulus values here are relative to the white point, which makes white (1, 1, 1) in all of them.

/// Linear Rec. 709 RGB to X/Xn, Y/Yn, Z/Zn for D65: the matrix of IEC 61966-2-1 with unrounded primaries, each
/// row divided by its sum, the white point.
const RGB_TO_XYZ: [[f32; 3]; 3] = [
    [0.433895389, 0.376242373, 0.189862239],
    [0.212636822, 0.715182982, 0.072180196],
    [0.017752423, 0.109465629, 0.872781948],
];

/// The inverse of [`RGB_TO_XYZ`].
const XYZ_TO_RGB: [[f32; 3]; 3] = [
    [3.080341988, -1.537398969, -0.542943019],
    [-0.921178396, 1.875929984, 0.045248412],
    [0.052881293, -0.204011206, 1.151129913],
];

fn transform(matrix: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

/// Returns the linear value, 0 to 1, of each of the 256 sRGB code values, by the two-piece curve of IEC 61966-2-1.
pub(crate) fn linear_values() -> [f32; 256] {
    std::array::from_fn(|code| {
        let encoded = code as f32 / 255.0;
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    })
}

/// Converts linear RGB to Y, Cx and Cz, the linear opponent space: luminance, red-green and blue-yellow.
/// Black is (-16, 0, 0), white (100, 0, 0). Source: Andersson et al. 2020, spatial filtering, after Zhang and
/// Wandell.
pub(crate) fn opponent(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = transform(&RGB_TO_XYZ, rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Returns the luminance, 0 to 1, of the first coordinate of [`opponent`].
pub(crate) fn luminance(y: f32) -> f32 {
    (y + 16.0) / 116.0
}

/// The inverse of [`opponent`].
fn linear_rgb([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = luminance(y);
    transform(&XYZ_TO_RGB, [y + cx / 500.0, y, y - cz / 200.0])
}

/// Converts linear RGB to CIE L*a*b*.
fn lab(rgb: [f32; 3]) -> [f32; 3] {
    const EDGE: f32 = 6.0 / 29.0;
    let root = |t: f32| if t > EDGE.powi(3) { t.cbrt() } else { t / (3.0 * EDGE * EDGE) + 4.0 / 29.0 };
    let [x, y, z] = transform(&RGB_TO_XYZ, rgb).map(root);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Converts linear RGB to L*a*b* with Hunt's effect: colours look less colourful in the dark, so a* and b* shrink
/// with L*. Source: Andersson et al. 2020, perceptually uniform colour space.
pub(crate) fn perceived(rgb: [f32; 3]) -> [f32; 3] {
    let [l, a, b] = lab(rgb);
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// Converts a filtered colour of the opponent space as [`perceived`] does, clamped to what a display can show:
/// the filters leave the range of RGB, because their widths differ.
pub(crate) fn perceived_of_opponent(filtered: [f32; 3]) -> [f32; 3] {
    perceived(linear_rgb(filtered).map(|value| value.clamp(0.0, 1.0)))
}

/// Returns the HyAB distance of two colours: the difference of lightness, plus the Euclidean distance of the
/// chromatic parts. For large differences this is nearer to what is seen than the Euclidean distance of all three.
/// Source: Abasi et al. 2020, "Distance metrics for very large color differences".
pub(crate) fn hyab([l, a, b]: [f32; 3], [other_l, other_a, other_b]: [f32; 3]) -> f32 {
    let (a, b) = (a - other_a, b - other_b);
    (l - other_l).abs() + (a * a + b * b).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: [f32; 3], expected: [f32; 3], most: f32) {
        let differences = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs());
        assert!(differences.fold(0.0, f32::max) <= most, "{found:?}, not {expected:?}");
    }

    #[test]
    fn white_and_black_have_no_hue() {
        near(opponent([1.0; 3]), [100.0, 0.0, 0.0], 1e-4);
        near(opponent([0.0; 3]), [-16.0, 0.0, 0.0], 0.0);
        near(lab([1.0; 3]), [100.0, 0.0, 0.0], 1e-4);
        near(lab([0.0; 3]), [0.0, 0.0, 0.0], 1e-5);
    }

    #[test]
    fn the_opponent_space_is_left_as_it_was_entered() {
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.5, 0.9]] {
            near(linear_rgb(opponent(rgb)), rgb, 2e-6);
        }
    }

    /// L*a*b* of the primaries as usually tabulated for sRGB and D65.
    #[test]
    fn the_primaries_are_where_cie_has_them() {
        near(lab([1.0, 0.0, 0.0]), [53.24, 80.09, 67.20], 0.02);
        near(lab([0.0, 1.0, 0.0]), [87.73, -86.18, 83.18], 0.02);
        near(lab([0.0, 0.0, 1.0]), [32.30, 79.19, -107.86], 0.02);
    }

    #[test]
    fn hunt_shrinks_chroma_by_lightness() {
        let [l, a, b] = lab([0.0, 0.0, 1.0]);
        near(perceived([0.0, 0.0, 1.0]), [l, a * l / 100.0, b * l / 100.0], 1e-4);
    }

    #[test]
    fn hyab_adds_lightness_to_chroma() {
        assert_eq!(hyab([10.0, 3.0, 0.0], [4.0, 0.0, 4.0]), 6.0 + 5.0);
    }

    #[test]
    fn code_values_are_linear_light() {
        let linear = linear_values();
        assert_eq!((linear[0], linear[255]), (0.0, 1.0));
        assert!((linear[10] - 10.0 / 255.0 / 12.92).abs() < 1e-9);
        // IEC 61966-2-1: code value 128 is 0.2159.
        assert!((linear[128] - 0.2158605).abs() < 1e-6);
    }
}
