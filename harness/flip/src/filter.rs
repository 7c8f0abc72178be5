//! Separable filters with clamped edges, and the kernels of FLIP.

use std::f32::consts::PI;

/// A kernel of odd length, its middle at the pixel that it filters.
pub(crate) type Kernel = Vec<f32>;

/// Values of a picture, row by row.
pub(crate) struct Plane {
    width: usize,
    values: Vec<f32>,
}

impl Plane {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self { width, values: vec![0.0; width * height] }
    }

    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [f32] {
        &mut self.values[y * self.width..][..self.width]
    }

    /// Filters down the columns, for row `y`.
    pub(crate) fn filter_column(&self, y: usize, kernel: &[f32], filtered: &mut [f32]) {
        let last = self.values.len() / self.width - 1;
        filtered.fill(0.0);
        for (k, weight) in kernel.iter().enumerate() {
            let row = (y + k).saturating_sub(kernel.len() / 2).min(last);
            add(*weight, &self.values[row * self.width..][..self.width], filtered);
        }
    }
}

/// Adds weighted values to sums. Going through rows like this, and not through the kernel for each pixel, the
/// compiler uses vector instructions.
fn add(weight: f32, values: &[f32], sums: &mut [f32]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
}

/// Returns a row with its first and last value repeated `radius` times.
pub(crate) fn pad(row: impl Iterator<Item = f32>, radius: usize, padded: &mut Vec<f32>) {
    padded.clear();
    padded.resize(radius, 0.0);
    padded.extend(row);
    let (first, last) = (padded[radius], padded[padded.len() - 1]);
    padded[..radius].fill(first);
    padded.resize(padded.len() + radius, last);
}

/// Filters along a row of [`pad`], which has two radii more than `filtered`.
pub(crate) fn filter_row(padded: &[f32], kernel: &[f32], filtered: &mut [f32]) {
    filtered.fill(0.0);
    for (k, weight) in kernel.iter().enumerate() {
        add(*weight, &padded[k..], filtered);
    }
}

/// Constants a and b of a Gaussian a √(π/b) exp(-π² x²/b) of x in degrees of visual angle.
type Gaussian = (f32, f32);

/// The contrast sensitivity functions as sums of Gaussians. Source: Andersson et al. 2020, spatial filtering, table
/// of constants; the blue-yellow one is the sum of both.
const ACHROMATIC: Gaussian = (1.0, 0.0047);
const RED_GREEN: Gaussian = (1.0, 0.0053);
const BLUE_YELLOW: [Gaussian; 2] = [(34.1, 0.04), (13.5, 0.025)];

/// The contrast sensitivity filters, one-dimensional. In both directions each takes its kernel; the blue-yellow
/// filter is the sum of two, which only together have the sum 1.
pub(crate) struct Sensitivity {
    pub(crate) achromatic: Kernel,
    pub(crate) red_green: Kernel,
    pub(crate) blue_yellow: [Kernel; 2],
}

impl Sensitivity {
    /// Source: Andersson et al. 2020, spatial filtering. All kernels reach three standard deviations of the widest
    /// Gaussian.
    pub(crate) fn new(pixels_per_degree: f32) -> Self {
        let widest = BLUE_YELLOW[0].1;
        let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
        // A factor's square root goes to each of the two directions.
        let gaussian = |(a, b): Gaussian| {
            let scale = (a * (PI / b).sqrt()).sqrt();
            kernel(radius, |x| scale * (-PI * PI * (x / pixels_per_degree).powi(2) / b).exp())
        };
        let blue_yellow = BLUE_YELLOW.map(gaussian);
        let sums = blue_yellow.each_ref().map(|kernel| kernel.iter().sum::<f32>());
        let norm = (sums[0] * sums[0] + sums[1] * sums[1]).sqrt();
        Self {
            achromatic: normalized(gaussian(ACHROMATIC)),
            red_green: normalized(gaussian(RED_GREEN)),
            blue_yellow: blue_yellow.map(|kernel| kernel.iter().map(|weight| weight / norm).collect()),
        }
    }

    pub(crate) fn radius(&self) -> usize {
        self.achromatic.len() / 2
    }
}

/// Width of the feature detector in degrees of visual angle. Source: Andersson et al. 2020, feature pipeline.
const FEATURE_WIDTH: f32 = 0.082;

/// The filters that detect edges and points: a Gaussian and its first and second derivative. Across a feature a
/// derivative is taken, along it the Gaussian.
pub(crate) struct Features {
    pub(crate) gaussian: Kernel,
    pub(crate) edge: Kernel,
    pub(crate) point: Kernel,
}

impl Features {
    /// Source: Andersson et al. 2020, feature pipeline. A derivative's positive weights have the sum 1, its negative
    /// ones -1, each normalised by themselves: they would not cancel otherwise.
    pub(crate) fn new(pixels_per_degree: f32) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as usize;
        let gaussian = |x: f32| (-x * x / (2.0 * deviation * deviation)).exp();
        Self {
            gaussian: normalized(kernel(radius, gaussian)),
            edge: balanced(kernel(radius, |x| -x * gaussian(x))),
            point: balanced(kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * gaussian(x))),
        }
    }

    pub(crate) fn radius(&self) -> usize {
        self.gaussian.len() / 2
    }
}

/// Samples a function at the whole numbers of -radius to radius.
fn kernel(radius: usize, weight: impl Fn(f32) -> f32) -> Kernel {
    (0..=2 * radius).map(|k| weight(k as f32 - radius as f32)).collect()
}

fn normalized(kernel: Kernel) -> Kernel {
    let sum: f32 = kernel.iter().sum();
    kernel.into_iter().map(|weight| weight / sum).collect()
}

fn balanced(kernel: Kernel) -> Kernel {
    let positive: f32 = kernel.iter().filter(|weight| **weight > 0.0).sum();
    let negative: f32 = kernel.iter().filter(|weight| **weight < 0.0).sum();
    kernel.into_iter().map(|weight| if weight > 0.0 { weight / positive } else { weight / -negative }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 67 pixels per degree: three deviations of 3.0 and of 2.7 pixels.
    #[test]
    fn the_radii_are_those_of_the_paper() {
        let radii = [67.0, 33.5, 134.0].map(|ppd| (Sensitivity::new(ppd).radius(), Features::new(ppd).radius()));
        assert_eq!(radii, [(10, 9), (5, 5), (19, 17)]);
    }

    #[test]
    fn a_uniform_picture_stays_uniform() {
        let Sensitivity { achromatic, red_green, blue_yellow } = Sensitivity::new(67.0);
        let sum = |kernel: &Kernel| kernel.iter().map(|weight| f64::from(*weight)).sum::<f64>();
        assert!((sum(&achromatic) - 1.0).abs() < 1e-6 && (sum(&red_green) - 1.0).abs() < 1e-6);
        let both: f64 = blue_yellow.iter().map(|kernel| sum(kernel).powi(2)).sum();
        assert!((both - 1.0).abs() < 1e-6, "{both}");
    }

    #[test]
    fn derivatives_balance() {
        let Features { gaussian, edge, point } = Features::new(67.0);
        assert!((gaussian.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        for kernel in [edge, point] {
            for sign in [1.0, -1.0] {
                let sum: f32 = kernel.iter().map(|weight| (sign * weight).max(0.0)).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{kernel:?}");
            }
        }
    }

    /// Also where the kernel is wider than the picture.
    #[test]
    fn edges_are_clamped() {
        let kernel = [1.0, 10.0, 100.0, 1000.0, 10000.0];
        let values = [3.0, 5.0];
        let expected = [3.0 * 111.0 + 5.0 * 11000.0, 3.0 * 11.0 + 5.0 * 11100.0];
        let (mut padded, mut row) = (Vec::new(), [0.0; 2]);
        pad(values.into_iter(), 2, &mut padded);
        filter_row(&padded, &kernel, &mut row);
        assert_eq!(row, expected);
        let mut plane = Plane::new(1, 2);
        (0..2).for_each(|y| plane.row_mut(y)[0] = values[y]);
        for (y, expected) in expected.into_iter().enumerate() {
            let mut column = [0.0];
            plane.filter_column(y, &kernel, &mut column);
            assert_eq!(column, [expected]);
        }
    }
}
