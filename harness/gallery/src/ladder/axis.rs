//! A logarithmic axis: its ends, its labelled values, and where a value stands.

/// Room beyond the outermost values, in powers of ten.
const MARGIN: f64 = 0.09;
/// Labels of an axis, at most.
const MOST_TICKS: usize = 9;

/// A logarithmic axis between two pixels, laid out for values above 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// The values at its ends.
    pub ends: [f64; 2],
    /// The pixels of its ends.
    pub pixels: [f64; 2],
    /// The labelled values.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// Returns an axis with room for all values. Values that are no numbers above 0 have no place on it.
    pub fn of(values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let (low, high) = values
            .filter(|value| *value > 0.0 && value.is_finite())
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 10.0) };
        let margin = 10f64.powf(MARGIN);
        let ends = [low / margin, high * margin];
        Self { ends, pixels, ticks: ticks(ends) }
    }

    /// Returns the pixel of a value.
    pub fn at(&self, value: f64) -> f64 {
        let [low, high] = self.ends.map(f64::ln);
        let [start, end] = self.pixels;
        start + (value.ln() - low) / (high - low) * (end - start)
    }
}

/// Returns round values between the ends: as many of 1 to 9 times a power of ten as can be told apart.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    // In tenths.
    const FINE: &[u32] = &[10, 12, 14, 16, 18, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90];
    const STEPS: [&[u32]; 4] = [FINE, &[10, 20, 30, 40, 50, 60, 80], &[10, 20, 50], &[10]];
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let of = |parts: &[u32]| -> Vec<f64> {
        let values = powers.clone().flat_map(|power| {
            // Parsed, because a power of ten is not always the nearest number to its digits.
            parts.iter().filter_map(move |part| format!("{part}e{}", power - 1).parse::<f64>().ok())
        });
        values.filter(|tick| (low..=high).contains(tick)).collect()
    };
    let all = STEPS.map(of);
    all.iter().find(|ticks| ticks.len() <= MOST_TICKS).unwrap_or(&all[3]).clone()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_at_the_ends_and_every_value_between_them() {
        let axis = Axis::of([0.5, 50.0, 5.0].into_iter(), [100.0, 900.0]);
        let [low, high] = axis.ends;
        assert!((axis.at(low) - 100.0).abs() < 1e-9 && (axis.at(high) - 900.0).abs() < 1e-9);
        assert!((axis.at(5.0) - 500.0).abs() < 1e-9, "the geometric mean is in the middle: {}", axis.at(5.0));
        let down = Axis { pixels: [400.0, 20.0], ..axis };
        assert!(down.at(0.5) > down.at(50.0), "up is a smaller pixel");
    }

    #[test]
    fn labels_are_round_and_few() {
        let of = |low: f64, high: f64| Axis::of([low, high].into_iter(), [0.0, 1.0]).ticks;
        assert_eq!(of(0.11, 0.18), [0.09, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2]);
        assert_eq!(of(0.2, 0.75), [0.2, 0.3, 0.4, 0.5, 0.6, 0.8]);
        assert_eq!(of(0.7, 159.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(of(1e-4, 30.0), [1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0]);
        assert!(of(f64::NAN, 0.0).len() >= 2, "an axis of nothing is an axis");
    }
}
