//! From wavelengths to linear Rec. 709 RGB and back, with the CIE 1931 observer under daylight.
//!
//! Environments are RGB. Three basis spectra turn an RGB colour into a spectrum: σ_R above 591 nm,
//! σ_G between, σ_B below 489 nm, with soft crossovers. They are nowhere negative and add up to 1.
//! A picture's RGB is the integral of a spectrum with the matching functions under D65. To get back
//! exactly the colour that went in, radiance uses ρ_c, the σ combined by the inverse of their own
//! 3×3 integral. It lies within 3 % of σ, and also adds up to 1, since the integral of white is
//! white.

use glam::{DMat3, DVec3};

/// Shortest wavelength in nm.
pub const SHORTEST: f64 = 400.0;
/// Longest wavelength in nm. 0.03 % of the luminance and 0.3 % of the red and blue of D65 lie
/// outside these two limits.
pub const LONGEST: f64 = 700.0;

/// x̄, ȳ and z̄ of the CIE 1931 standard observer (2°) at 400, 410 ... 700 nm. Source: CIE 15
/// (Colorimetry), table T.4; data set doi:10.25039/CIE.DS.xvudnb9b.
const OBSERVER: [[f64; 3]; 31] = [
    [0.014310, 0.000396, 0.067850],
    [0.043510, 0.001210, 0.207400],
    [0.134380, 0.004000, 0.645600],
    [0.283900, 0.011600, 1.385600],
    [0.348280, 0.023000, 1.747060],
    [0.336200, 0.038000, 1.772110],
    [0.290800, 0.060000, 1.669200],
    [0.195360, 0.090980, 1.287640],
    [0.095640, 0.139020, 0.812950],
    [0.032010, 0.208020, 0.465180],
    [0.004900, 0.323000, 0.272000],
    [0.009300, 0.503000, 0.158200],
    [0.063270, 0.710000, 0.078250],
    [0.165500, 0.862000, 0.042160],
    [0.290400, 0.954000, 0.020300],
    [0.433450, 0.994950, 0.008750],
    [0.594500, 0.995000, 0.003900],
    [0.762100, 0.952000, 0.002100],
    [0.916300, 0.870000, 0.001650],
    [1.026300, 0.757000, 0.001100],
    [1.062200, 0.631000, 0.000800],
    [1.002600, 0.503000, 0.000340],
    [0.854450, 0.381000, 0.000190],
    [0.642400, 0.265000, 0.000050],
    [0.447900, 0.175000, 0.000020],
    [0.283500, 0.107000, 0.000000],
    [0.164900, 0.061000, 0.000000],
    [0.087400, 0.032000, 0.000000],
    [0.046770, 0.017000, 0.000000],
    [0.022700, 0.008210, 0.000000],
    [0.011359, 0.004102, 0.000000],
];

/// Relative spectral power of the CIE standard illuminant D65 at 400, 410 ... 700 nm. Source: CIE
/// 15, table T.1; data set doi:10.25039/CIE.DS.hjfjmt59.
const DAYLIGHT: [f64; 31] = [
    82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
    104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886,
    83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
];

/// Chromaticities (x, y, z) of the red, green and blue of ITU-R BT.709, which sRGB shares.
const PRIMARIES: [[f64; 3]; 3] = [[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]];

/// Crossovers from blue to green and from green to red, in nm, with the widths of the two logistic
/// curves. Rounded to whole nm, these bring the integral of the σ closest to the identity, so that
/// ρ differs least from σ.
const CROSSOVERS: [(f64, f64); 2] = [(489.0, 9.0), (591.0, 7.0)];

/// Fewest wavelengths that can tell three colours apart.
pub const FEWEST: usize = 3;

/// One of the wavelengths that represent a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelength {
    /// Wavelength in nm.
    pub nanometres: f64,
    /// Contribution of linear RGB radiance, seen at this wavelength alone, to a pixel's linear RGB.
    /// Over all wavelengths these add up to the identity.
    pub weights: DMat3,
}

/// Returns `count` equally spaced wavelengths from [`SHORTEST`] to [`LONGEST`]; 31 match the
/// tables, other counts are interpolated linearly.
///
/// # Panics
/// If `count` is less than [`FEWEST`].
#[must_use]
pub fn weights(count: usize) -> Vec<Wavelength> {
    assert!(count >= FEWEST, "a spectrum needs at least {FEWEST} wavelengths, not {count}");
    let step = (LONGEST - SHORTEST) / (count - 1) as f64;
    let grid: Vec<f64> = (0..count).map(|k| SHORTEST + step * k as f64).collect();
    let rgb_from_xyz = DMat3::from_cols_array_2d(&PRIMARIES).inverse();
    let stimuli: Vec<DVec3> = grid.iter().map(|&nanometres| rgb_from_xyz * stimulus(nanometres)).collect();
    // Each channel is scaled so that the illuminant sums to 1 (white) on this grid.
    let white: DVec3 = stimuli.iter().sum();
    let stimuli: Vec<DVec3> = stimuli.iter().map(|stimulus| *stimulus / white).collect();
    let integral = grid.iter().zip(&stimuli).map(|(&nanometres, stimulus)| outer(*stimulus, basis(nanometres)));
    let to_radiance = integral.fold(DMat3::ZERO, |sum, part| sum + part).inverse().transpose();
    let wavelength = |(&nanometres, stimulus): (&f64, &DVec3)| {
        let basis = basis(nanometres);
        Wavelength { nanometres, weights: outer(*stimulus, to_radiance * basis) }
    };
    grid.iter().zip(&stimuli).map(wavelength).collect()
}

/// Returns X, Y and Z of daylight at one wavelength, up to a factor.
fn stimulus(nanometres: f64) -> DVec3 {
    let place = (nanometres - SHORTEST) / 10.0;
    let below = (place.floor() as usize).min(OBSERVER.len() - 2);
    let share = place - below as f64;
    let observer = DVec3::from_array(OBSERVER[below]).lerp(DVec3::from_array(OBSERVER[below + 1]), share);
    observer * (DAYLIGHT[below] + share * (DAYLIGHT[below + 1] - DAYLIGHT[below]))
}

/// Returns σ at one wavelength: blue takes its share, red its share of the rest, green the
/// remainder.
fn basis(nanometres: f64) -> DVec3 {
    let [above_blue, above_green] =
        CROSSOVERS.map(|(middle, width)| 1.0 / (1.0 + ((middle - nanometres) / width).exp()));
    DVec3::new(above_blue * above_green, above_blue * (1.0 - above_green), 1.0 - above_blue)
}

/// Returns the matrix with elements a_row · b_column.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(wavelengths: &[Wavelength]) -> DMat3 {
        wavelengths.iter().fold(DMat3::ZERO, |sum, wavelength| sum + wavelength.weights)
    }

    /// Returns the colour of light of one wavelength, with the brightest channel scaled to 1.
    fn hue(nanometres: f64) -> DVec3 {
        let wavelengths = weights(301);
        let seen = wavelengths.iter().find(|wavelength| wavelength.nanometres == nanometres).unwrap();
        let color = seen.weights * DVec3::ONE;
        color / color.max_element()
    }

    #[test]
    fn weights_add_up_to_the_identity() {
        for count in [FEWEST, 8, 31, 61, 301] {
            let difference = sum(&weights(count)) - DMat3::IDENTITY;
            let largest = difference.to_cols_array().into_iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            assert!(largest < 1e-12, "{count}: {largest}");
        }
    }

    #[test]
    fn daylight_is_white() {
        let white: DVec3 = weights(31).iter().map(|wavelength| wavelength.weights * DVec3::ONE).sum();
        assert!(white.abs_diff_eq(DVec3::ONE, 1e-12), "{white}");
    }

    /// sRGB's white is x = 0.3127, y = 0.3290, and its matrix from XYZ is printed in IEC 61966-2-1.
    /// Cut off at 400 and 700 nm, white lacks 0.15 % of its X and 0.2 % of its Z, which stretches
    /// the matrix by up to 0.3 %.
    #[test]
    fn white_point_and_matrix_are_srgbs() {
        let white: DVec3 = (0..31).map(|k| stimulus(SHORTEST + 10.0 * f64::from(k))).sum();
        let chromaticity = white / (white.x + white.y + white.z);
        assert!(chromaticity.abs_diff_eq(DVec3::new(0.3127, 0.3290, 0.3583), 4e-4), "{chromaticity}");
        let rgb_from_xyz = DMat3::from_cols_array_2d(&PRIMARIES).inverse();
        let scale = rgb_from_xyz * (white / white.y);
        let matrix = DMat3::from_diagonal(scale.recip()) * rgb_from_xyz;
        let printed = [[3.2406, -0.9689, 0.0557], [-1.5372, 1.8758, -0.2040], [-0.4986, 0.0415, 1.0570]];
        let printed = DMat3::from_cols_array_2d(&printed);
        assert!(matrix.abs_diff_eq(printed, 0.003 * 3.25), "{matrix}");
    }

    #[test]
    fn both_bases_add_up_to_one() {
        for wavelength in weights(61) {
            assert!(basis(wavelength.nanometres).min_element() >= 0.0);
            assert!((basis(wavelength.nanometres).element_sum() - 1.0).abs() < 1e-15);
        }
        // Row by row, the weights are one stimulus times ρ, so ρ is a row divided by its sum.
        for Wavelength { weights, nanometres } in weights(31) {
            let basis = basis(nanometres);
            let white = weights * DVec3::ONE;
            let brightest = if white.x.abs() > white.y.abs() { 0 } else { 1 };
            let spectra = weights.row(brightest) / white[brightest];
            assert!((spectra.element_sum() - 1.0).abs() < 1e-12);
            assert!(spectra.abs_diff_eq(basis, 0.03), "{nanometres}: {spectra} against {basis}");
        }
    }

    #[test]
    fn monochromatic_light_has_its_hue() {
        let (blue, cyan, green, yellow, red) = (hue(450.0), hue(490.0), hue(530.0), hue(575.0), hue(620.0));
        assert!(blue.z == 1.0 && blue.x < 0.3 && blue.y < 0.0, "{blue}");
        assert!(cyan.x < 0.0 && cyan.y > 0.4 && cyan.z > 0.6, "{cyan}");
        assert!(green.y == 1.0 && green.x < 0.0 && green.z < 0.05, "{green}");
        assert!(yellow.x > 0.6 && yellow.y > 0.6 && yellow.z < 0.0, "{yellow}");
        assert!(red.x == 1.0 && red.y < 0.05 && red.z.abs() < 0.05, "{red}");
    }

    #[test]
    #[should_panic(expected = "at least 3 wavelengths")]
    fn two_wavelengths_are_too_few() {
        let _ = weights(2);
    }
}
