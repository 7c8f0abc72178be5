//! Comparison of a new picture with its reference.

use super::error::SnapshotError;
use super::files::read;
use lapidary_render::{Picture, file};
use std::path::Path;

// The limits lie between the effect of another driver and that of a deliberate error, with a factor
// of two or more above the first. Another driver's sample positions differ by 1/256 of their
// distance: for the glass bunny, whose facets are small, this gives a mean FLIP of 0.0015, 0.055
// for a thousandth of the pixels and an RMSE of 0.014; for cut stones at most 0.0012, 0.040 and
// 0.004. A rotation of 1 degree gives at least 0.10, 0.9 and 0.33, two swapped channels 0.13, 0.3
// and 0.087. A black square of 32 by 32 pixels gives a mean of 0.001 to 0.005 and at least 0.46 for
// the thousandth.

/// Largest allowed mean FLIP of all pixels.
pub const MOST_FLIP: f32 = 0.005;
/// Largest allowed FLIP of all pixels but a thousandth.
pub const MOST_HIGH_FLIP: f32 = 0.15;
/// Largest allowed RMSE in linear radiance, relative to the reference's root mean square.
pub const MOST_RMSE: f32 = 0.03;

/// Number of pixels in a thousand that may differ by more than [`MOST_HIGH_FLIP`].
const PER_MILLE: usize = 1;
/// The largest half float, which is the limit of an EXR.
const LARGEST_HALF: f32 = 65504.0;

/// Differences of a picture from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean FLIP of the PNGs, 0 to 1.
    pub flip: f32,
    /// The FLIP that a thousandth of the pixels exceed.
    ///
    /// The mean hides a small region that is completely wrong. The maximum is that of a single
    /// pixel, whose samples may all lie on an edge and fall on its other side with another driver.
    pub high_flip: f32,
    /// RMSE of linear RGB, divided by the reference's root mean square. Coverage is not light and
    /// does not count.
    pub rmse: f32,
}

impl Comparison {
    /// Whether the pictures count as equal.
    pub fn holds(&self) -> bool {
        // A NaN fails.
        self.flip <= MOST_FLIP && self.high_flip <= MOST_HIGH_FLIP && self.rmse <= MOST_RMSE
    }
}

/// Compares new pictures with the references called `name` in `folder`. If they differ too much,
/// the new PNG and a picture of the difference are written beside the reference, as
/// `<name>.new.png` and `<name>.difference.png`.
///
/// # Errors
/// Returns an error if a reference is missing, unreadable or of another size, or if a pixel of
/// either is not finite.
pub fn compare(name: &str, [seen, linear]: &[Picture; 2], folder: &Path) -> Result<Comparison, SnapshotError> {
    let png = folder.join(format!("{name}.png"));
    let reference = read(&png, (seen.width, seen.height))?.into_rgb8();
    let rmse = linear_rmse(name, linear, folder)?;
    require_finite(&format!("the new picture {name}"), seen.width, &seen.linear)?;
    let map = flip_map(seen, reference.as_raw());
    let comparison = Comparison { flip: lapidary_flip::mean(&map), high_flip: high(&mut map.clone()), rmse };
    let beside = ["new", "difference"].map(|kind| folder.join(format!("{name}.{kind}.png")));
    if comparison.holds() {
        // Files from an earlier failure are out of date.
        for path in beside {
            let _ = std::fs::remove_file(path);
        }
    } else {
        file::write(seen, &beside[0])?;
        let opaque = |[r, g, b]: [u8; 3]| [r, g, b, 255];
        let pixels: Vec<[u8; 4]> = map.iter().map(|error| opaque(lapidary_flip::magma(*error))).collect();
        let encode = |reason| file::FileError::Encode { path: beside[1].clone(), reason };
        let bytes = file::png(seen.width, seen.height, &pixels).map_err(encode)?;
        lapidary_files::replace(&beside[1], &bytes).map_err(file::FileError::from)?;
    }
    Ok(comparison)
}

/// Returns the RMSE of linear RGB, divided by the root mean square of the reference called `name`
/// in `folder`. If it is above [`MOST_RMSE`], the new picture is written beside the reference, as
/// `<name>.new.png`.
///
/// # Errors
/// Returns an error as in [`compare`].
pub fn compare_linear(name: &str, linear: &Picture, folder: &Path) -> Result<f32, SnapshotError> {
    let rmse = linear_rmse(name, linear, folder)?;
    if rmse > MOST_RMSE || rmse.is_nan() {
        file::write(linear, &folder.join(format!("{name}.new.png")))?;
    }
    Ok(rmse)
}

fn linear_rmse(name: &str, linear: &Picture, folder: &Path) -> Result<f32, SnapshotError> {
    let exr = folder.join(format!("{name}.exr"));
    let reference = read(&exr, (linear.width, linear.height))?.into_rgba32f();
    let reference: Vec<[f32; 4]> = reference.pixels().map(|pixel| pixel.0).collect();
    require_finite(&exr.display().to_string(), linear.width, &reference)?;
    require_finite(&format!("the new picture {name}"), linear.width, &linear.linear)?;
    Ok(relative_rmse(&linear.linear, &reference))
}

/// Rejects a picture with a pixel that is NaN, or that an EXR cannot store.
pub(crate) fn require_finite(what: &str, width: u32, pixels: &[[f32; 4]]) -> Result<(), SnapshotError> {
    let is_finite = |pixel: &[f32; 4]| pixel.iter().all(|value| value.abs() <= LARGEST_HALF);
    match (0..).zip(pixels).find(|(_, pixel)| !is_finite(pixel)) {
        None => Ok(()),
        Some((index, value)) => Err(SnapshotError::NotFinite {
            what: what.to_owned(),
            column: index % width,
            row: index / width,
            value: *value,
        }),
    }
}

/// Returns the FLIP map of the encoded picture against `reference`, RGB of the same size.
fn flip_map(seen: &Picture, reference: &[u8]) -> Vec<f32> {
    lapidary_flip::flip((seen.width, seen.height), reference, &rgb(seen))
}

fn rgb(picture: &Picture) -> Vec<u8> {
    picture.encoded.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

/// Returns the FLIP of each pixel of two pictures of the same size, row by row.
pub fn flip(picture: &Picture, reference: &Picture) -> Vec<f32> {
    flip_map(picture, &rgb(reference))
}

/// Returns the value that a thousandth of the values exceed.
fn high(values: &mut [f32]) -> f32 {
    let place = (values.len() - 1).saturating_sub(values.len() * PER_MILLE / 1000);
    *values.select_nth_unstable_by(place, f32::total_cmp).1
}

fn relative_rmse(new: &[[f32; 4]], reference: &[[f32; 4]]) -> f32 {
    let (mut error, mut power) = (0.0, 0.0);
    for (new, reference) in new.iter().zip(reference) {
        for (new, reference) in new[..3].iter().zip(&reference[..3]) {
            error += f64::from(new - reference).powi(2);
            power += f64::from(*reference).powi(2);
        }
    }
    (error / power).sqrt() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body of radiance 0.1 that is half again too bright is 50 % wrong, whatever its coverage.
    #[test]
    fn coverage_is_no_light() {
        let reference = [[0.1, 0.1, 0.1, 1.0]; 16];
        let found = [[0.15, 0.15, 0.15, 1.0]; 16];
        assert!((relative_rmse(&found, &reference) - 0.5).abs() < 1e-6);
        // A channel in another's place also counts.
        let red = [[0.1, 0.0, 0.0, 1.0]; 16];
        let blue = [[0.0, 0.0, 0.1, 1.0]; 16];
        assert!(relative_rmse(&blue, &red) > 1.4);
    }

    #[test]
    fn a_thousandth_may_be_higher() {
        let values = |count: usize| (0..5000).map(|k| f32::from(u8::from(k < count))).collect::<Vec<_>>();
        assert_eq!([0, 5, 6].map(|count| high(&mut values(count))), [0.0, 0.0, 1.0]);
        assert_eq!(high(&mut [0.5]), 0.5);
    }

    #[test]
    fn what_is_no_number_is_named() {
        for value in [f32::NAN, f32::INFINITY, -f32::INFINITY, 65536.0] {
            for channel in 0..4 {
                let mut pixels = [[0.5; 4]; 12];
                assert!(require_finite("x", 4, &pixels).is_ok());
                pixels[6][channel] = value;
                let error = require_finite("x", 4, &pixels).expect_err("not finite");
                assert!(matches!(error, SnapshotError::NotFinite { column: 2, row: 1, .. }), "{error}");
            }
        }
    }
}
