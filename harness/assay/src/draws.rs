//! Random inputs from a counter-based stream of draws.
//!
//! Row r of a run is a pure function of (seed, r). A million rows are therefore generated without a
//! value tree, and a single row is rebuilt alone to be shrunk. Shrinking works on the draws: each
//! is pulled towards 0, and each generator maps 0 to the simplest value. Every guarantee of a
//! generator (unit length, an angle, a side of a plane) thus holds for the shrunk inputs as well.

#[cfg(feature = "gpu")]
mod shrinking;
#[cfg(feature = "gpu")]
mod tree;

use glam::{DVec3, Vec2, Vec3};
use std::sync::Arc;

#[cfg(feature = "gpu")]
pub use tree::Tree;

/// A stream of random draws, or the replay of a record.
#[derive(Debug)]
pub struct Draws<'a> {
    key: u64,
    count: u64,
    replayed: Option<&'a [u32]>,
}

impl<'a> Draws<'a> {
    /// Creates the stream of row `row` in a run with `seed`.
    pub fn of_row(seed: u64, row: u64) -> Draws<'static> {
        Draws { key: mix(seed ^ mix(row)), count: 0, replayed: None }
    }

    /// Creates a stream that repeats `draws`, then continues with zeros.
    pub fn replay(draws: &'a [u32]) -> Draws<'a> {
        Draws { key: 0, count: 0, replayed: Some(draws) }
    }

    /// Returns the next 32 bits.
    pub fn bits(&mut self) -> u32 {
        let index = self.count;
        self.count += 1;
        match self.replayed {
            Some(draws) => draws.get(index as usize).copied().unwrap_or(0),
            None => (mix(self.key.wrapping_add(index.wrapping_mul(0x9e37_79b9_7f4a_7c15))) >> 32) as u32,
        }
    }

    /// Returns a whole number in [0, n); 0 is the simplest.
    pub fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(n)) >> 32) as u32
    }

    /// Returns one of `choices`; the first is the simplest.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len() as u32) as usize]
    }

    /// Returns a number uniform in [0, 1), a multiple of 2⁻³².
    pub fn unit(&mut self) -> f64 {
        f64::from(self.bits()) * 2f64.powi(-32)
    }

    /// Returns a number uniform in [low, high]; `low` is the simplest.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        let value = f64::from(low) + self.unit() * (f64::from(high) - f64::from(low));
        value as f32
    }

    /// Returns a number uniform in [low, high], in f64; `low` is the simplest.
    pub fn between_f64(&mut self, low: f64, high: f64) -> f64 {
        low + self.unit() * (high - low)
    }

    /// Returns a positive number with an exponent uniform in [low, high] and any mantissa, so that
    /// all magnitudes occur. The exponent nearest 0 and the mantissa 1 are the simplest.
    pub fn magnitude(&mut self, low: i32, high: i32) -> f32 {
        let near = 0.clamp(low, high);
        let step = self.below((high - low + 1).unsigned_abs()) as i32;
        // Fans out from `near`: 0, -1, 1, -2, 2, … until one side ends, then continues on the
        // other.
        let (below, above) = (near - low, high - near);
        let side = below.min(above);
        let exponent = if step <= 2 * side {
            if step % 2 == 0 { near + step / 2 } else { near - step / 2 - 1 }
        } else if below > above {
            near - (step - side)
        } else {
            near + (step - side)
        };
        let exponent = exponent.clamp(low, high);
        let mantissa = 1.0 + f64::from(self.bits() >> 9) * 2f64.powi(-23);
        (mantissa * 2f64.powi(exponent)) as f32
    }

    /// Returns a [`Draws::magnitude`] with either sign; plus is the simplest.
    pub fn signed(&mut self, low: i32, high: i32) -> f32 {
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        sign * self.magnitude(low, high)
    }

    /// Returns `value` moved by up to `ulps` units in the last place, either way, and often not at
    /// all.
    pub fn nudged(&mut self, value: f32, ulps: u32) -> f32 {
        let steps = self.below(2 * ulps + 1);
        let (count, down) = (steps.div_ceil(2), steps % 2 == 1);
        (0..count).fold(value, |value, _| if down { value.next_down() } else { value.next_up() })
    }

    /// Returns a vector with components in [-1, 1].
    pub fn in_cube(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// Returns a point in the unit square.
    pub fn in_square(&mut self) -> Vec2 {
        Vec2::new(self.between(0.0, 1.0), self.between(0.0, 1.0))
    }

    /// Returns a direction uniform on the sphere, in f64; +z is the simplest.
    pub fn direction(&mut self) -> DVec3 {
        let z = 1.0 - 2.0 * self.unit();
        let azimuth = std::f64::consts::TAU * self.unit();
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
    }

    /// Returns a unit vector: in one case of four along an axis, where sums of products are exact,
    /// otherwise anywhere.
    pub fn unit_vector(&mut self) -> Vec3 {
        match self.below(4) {
            0 => self.pick(&[Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::NEG_X, Vec3::NEG_Y]),
            _ => self.direction().as_vec3(),
        }
    }

    /// Returns a unit vector perpendicular to `axis` (unit, f64), exactly so if `axis` lies along a
    /// coordinate axis.
    pub fn perpendicular(&mut self, axis: DVec3) -> DVec3 {
        let helper = if axis.z.abs() < 0.9 { DVec3::Z } else { DVec3::X };
        let first = axis.cross(helper).normalize();
        let second = axis.cross(first);
        match self.below(2) {
            0 => first,
            _ => {
                let azimuth = std::f64::consts::TAU * self.unit();
                azimuth.cos() * first + azimuth.sin() * second
            }
        }
    }
}

/// SplitMix64's output function: a bijection of 64 bits that passes statistical tests on counters.
/// Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
pub fn mix(key: u64) -> u64 {
    let key = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let key = (key ^ (key >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let key = (key ^ (key >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    key ^ (key >> 31)
}

/// A generator of values from draws. With the feature `gpu` it is also a proptest strategy, which
/// shrinks a value through its draws.
pub struct Domain<T> {
    generate: Arc<dyn Fn(&mut Draws<'_>) -> T + Send + Sync>,
    /// Shrinks a row other than through its draws.
    #[cfg(feature = "gpu")]
    tree: Option<tree::MakeTree<T>>,
}

impl<T> Domain<T> {
    /// Creates a domain from its generator.
    pub fn new(generate: impl Fn(&mut Draws<'_>) -> T + Send + Sync + 'static) -> Self {
        Self {
            generate: Arc::new(generate),
            #[cfg(feature = "gpu")]
            tree: None,
        }
    }

    /// Returns the value of row `row`.
    pub fn row(&self, seed: u64, row: u64) -> T {
        (self.generate)(&mut Draws::of_row(seed, row))
    }

    /// Returns the draws behind row `row`.
    pub fn draws(&self, seed: u64, row: u64) -> Vec<u32> {
        let mut draws = Draws::of_row(seed, row);
        (self.generate)(&mut draws);
        let count = draws.count;
        let mut again = Draws::of_row(seed, row);
        (0..count).map(|_| again.bits()).collect()
    }

    /// Returns whether the values come from a strategy, so that the draws say nothing about them.
    #[cfg(feature = "gpu")]
    pub(crate) fn is_of_strategy(&self) -> bool {
        self.tree.is_some()
    }

    /// Returns the value of these draws.
    pub fn of_draws(&self, draws: &[u32]) -> T {
        (self.generate)(&mut Draws::replay(draws))
    }
}

impl<T> Clone for Domain<T> {
    fn clone(&self) -> Self {
        Self {
            generate: Arc::clone(&self.generate),
            #[cfg(feature = "gpu")]
            tree: self.tree.clone(),
        }
    }
}

impl<T> std::fmt::Debug for Domain<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Domain")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnitudes_reach_both_ends_and_zero_draws_are_simplest() {
        let values: Vec<f32> = (0..20_000).map(|row| Draws::of_row(1, row).magnitude(-126, 127)).collect();
        assert!(values.iter().all(|value| value.is_normal() && *value > 0.0));
        assert!(values.iter().any(|value| *value < 2f32.powi(-125)) && values.iter().any(|value| *value > 1.6e38));
        assert_eq!(Draws::replay(&[]).magnitude(-126, 127), 1.0);
        assert_eq!(Draws::replay(&[]).magnitude(-126, -20).log2(), -20.0);
        for (low, high) in [(-3, 1), (-1, 4), (2, 5), (-5, -2)] {
            let mut met: Vec<i32> =
                (0..2000).map(|row| Draws::of_row(2, row).magnitude(low, high).log2().floor() as i32).collect();
            met.sort_unstable();
            met.dedup();
            assert_eq!(met, (low..=high).collect::<Vec<_>>());
        }
    }
}
