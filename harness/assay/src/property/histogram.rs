//! A distribution of non-negative numbers in bounded memory, accurate to under one per cent.

/// Counts per upper 16 bits of the number's f32: 128 steps per power of two.
#[derive(Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(from = "Steps"))]
pub struct Histogram {
    counts: Vec<u64>,
    total: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: vec![0; 1 << 15], total: 0 }
    }
}

impl Histogram {
    /// Adds a number; a NaN counts as infinite.
    pub fn add(&mut self, value: f64) {
        let value = if value.is_nan() { f32::INFINITY } else { (value as f32).abs() };
        self.counts[(value.to_bits() >> 16) as usize] += 1;
        self.total += 1;
    }

    /// Adds the numbers of another histogram.
    pub fn join(&mut self, other: &Histogram) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, other)| *count += other);
        self.total += other.total;
    }

    /// Returns the smallest recorded number that at least `share` (0 to 1) of all numbers do not
    /// exceed, rounded down to its step; 0 if nothing was added.
    pub fn quantile(&self, share: f64) -> f64 {
        let wanted = (share * self.total as f64).ceil().max(1.0) as u64;
        let mut seen = 0;
        for (index, count) in self.counts.iter().enumerate() {
            seen += count;
            if seen >= wanted {
                return f64::from(f32::from_bits((index as u32) << 16));
            }
        }
        0.0
    }
}

/// The non-empty steps: the index and the count of each.
#[cfg(feature = "serde")]
type Steps = Vec<(usize, u64)>;

#[cfg(feature = "serde")]
impl serde::Serialize for Histogram {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.counts.iter().enumerate().filter(|(_, count)| **count > 0))
    }
}

#[cfg(feature = "serde")]
impl From<Steps> for Histogram {
    fn from(steps: Steps) -> Histogram {
        let mut histogram = Histogram::default();
        for (place, count) in steps {
            if let Some(found) = histogram.counts.get_mut(place) {
                *found += count;
                histogram.total += count;
            }
        }
        histogram
    }
}

impl std::fmt::Debug for Histogram {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (median, p99) = (self.quantile(0.5), self.quantile(0.99));
        f.debug_struct("Histogram").field("total", &self.total).field("median", &median).field("p99", &p99).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_numbers() {
        let mut histogram = Histogram::default();
        assert_eq!(histogram.quantile(0.5), 0.0);
        (1..=1000).for_each(|value| histogram.add(f64::from(value)));
        for (share, value) in [(0.5, 500.0), (0.99, 990.0), (1.0, 1000.0)] {
            let found = histogram.quantile(share);
            assert!(found <= value && found > value * 0.99, "{share}: {found}");
        }
        histogram.add(f64::NAN);
        assert_eq!(histogram.quantile(1.0), f64::INFINITY);
    }
}
