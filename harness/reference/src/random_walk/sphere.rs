//! The translucent sphere in parallel light (Kubo et al.): the scattered light that leaves it, by
//! the angle from the light, and the light that went straight through.

use super::{Ball, Exit, Walks, fold, in_disc};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Number of intervals of the angle, from 0 to pi.
pub const BINS: usize = 36;

/// Light leaving a sphere, by the angle between its normal and the direction to the light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Radius in mean free paths.
    pub radius: f64,
    /// Albedo of one scattering.
    pub albedo: f64,
    /// Radiant exitance in each interval of the angle, divided by the irradiance of a surface that
    /// faces the light. Scattered light only: light that went straight through is seen only by an
    /// observer who looks into the light.
    #[serde(with = "by_interval")]
    pub exitance: [f64; BINS],
    /// Standard error of each exitance.
    #[serde(with = "by_interval")]
    pub standard_error: [f64; BINS],
}

impl Profile {
    /// Bounds of an interval as cosines, the greater first.
    pub fn cosines(bin: usize) -> [f64; 2] {
        [bin, bin + 1].map(|edge| (PI * edge as f64 / BINS as f64).cos())
    }

    /// Share of the sphere's surface in an interval.
    pub fn share(bin: usize) -> f64 {
        let [greater, less] = Self::cosines(bin);
        0.5 * (greater - less)
    }

    /// Mean of a function of the cosine over an interval's surface, by three-point Gauss
    /// quadrature.
    pub fn mean(bin: usize, function: impl Fn(f64) -> f64) -> f64 {
        let [greater, less] = Self::cosines(bin);
        // Equal steps of the cosine cover equal areas.
        let (middle, reach) = (0.5 * (greater + less), 0.5 * (greater - less) * 0.6f64.sqrt());
        (5.0 * function(middle - reach) + 8.0 * function(middle) + 5.0 * function(middle + reach)) / 18.0
    }

    /// Share of the light falling on the sphere that leaves it scattered.
    pub fn whole(&self) -> f64 {
        // The sphere's surface is four times the disc that the light falls on.
        (0..BINS).map(|bin| 4.0 * Self::share(bin) * self.exitance[bin]).sum()
    }

    /// Returns the profile including the light that went straight through.
    ///
    /// Light that enters a sphere at the angle t leaves it at the angle pi - t after 2 R cos t mean
    /// free paths, spread as it fell: |cos| e^(-2 R |cos|) on the side away from the light. This is
    /// known without walks and has no error.
    #[must_use]
    pub fn with_unscattered(&self) -> Self {
        let exitance = std::array::from_fn(|bin| self.exitance[bin] + Self::unscattered(self.radius, bin));
        Self { exitance, ..self.clone() }
    }

    /// Mean over an interval's surface of the light that went straight through a sphere of `radius`
    /// mean free paths.
    pub fn unscattered(radius: f64, bin: usize) -> f64 {
        let [from, to] = Self::cosines(bin).map(|cosine| (-cosine).max(0.0));
        if from == to || radius.is_infinite() {
            return 0.0;
        }
        // The integral of c e^(-2 R c).
        let integral = |c: f64| {
            let depth = 2.0 * radius * c;
            -(1.0 + depth) * (-depth).exp() / (4.0 * radius * radius)
        };
        // An interval's cosines differ by twice its share.
        (integral(to) - integral(from)) / (2.0 * Self::share(bin))
    }

    /// RMS error over the surface that is due to the walks' statistics alone.
    pub fn noise(&self) -> f64 {
        (0..BINS).map(|bin| Self::share(bin) * self.standard_error[bin].powi(2)).sum::<f64>().sqrt()
    }
}

/// Serialises values by interval, since serde has no arrays of this length.
mod by_interval {
    use super::BINS;
    use serde::de::{Deserialize as _, Deserializer, Error as _};
    use serde::ser::{Serialize as _, Serializer};

    pub(super) fn serialize<S: Serializer>(values: &[f64; BINS], serializer: S) -> Result<S::Ok, S::Error> {
        values.as_slice().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; BINS], D::Error> {
        let values = Vec::deserialize(deserializer)?;
        values
            .try_into()
            .map_err(|values: Vec<f64>| D::Error::invalid_length(values.len(), &"a value for each interval"))
    }
}

/// Follows `count` walks through a sphere of `radius` mean free paths, lit from +z.
pub fn profile(radius: f64, albedo: f64, count: u64, seed: u64) -> Profile {
    let enter = |random: &mut _| {
        let (x, y) = in_disc(random);
        (radius * DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt()), DVec3::NEG_Z)
    };
    let add = |counts: &mut [u64; BINS], exit: Option<Exit>| {
        let Some(exit) = exit.filter(|exit| exit.scatterings > 0) else { return };
        // The angle is computed from both coordinates: the cosine alone loses digits at the poles.
        let angle = exit.position.truncate().length().atan2(exit.position.z);
        counts[((angle / PI * BINS as f64) as usize).min(BINS - 1)] += 1;
    };
    let join = |a: [u64; BINS], b: [u64; BINS]| std::array::from_fn(|bin| a[bin] + b[bin]);
    let counts = fold(&Ball { radius }, Walks { albedo, count, seed }, enter, || [0; BINS], add, join);
    // The beam's power is pi r^2 E; the whole surface is 4 pi r^2.
    let scale = |bin: usize| 0.25 / Profile::share(bin);
    let share = |bin: usize| counts[bin] as f64 / count as f64;
    Profile {
        radius,
        albedo,
        exitance: std::array::from_fn(|bin| share(bin) * scale(bin)),
        standard_error: std::array::from_fn(|bin| (share(bin) * (1.0 - share(bin)) / count as f64).sqrt() * scale(bin)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere that absorbs nothing returns all the light that it scatters; the share that goes
    /// straight through is known.
    #[test]
    fn all_that_is_scattered_comes_out() {
        for radius in [0.5, 2.0, 10.0] {
            let count = 200_000;
            let profile = profile(radius, 1.0, count, 5);
            let out = profile.whole();
            // The mean of exp(-2 r c) over the disc, with the measure c dc.
            let way = 2.0 * radius;
            let straight = 2.0 * (1.0 - (1.0 + way) * (-way).exp()) / (way * way);
            let error = (straight * (1.0 - straight) / count as f64).sqrt();
            assert!((out - (1.0 - straight)).abs() <= 4.0 * error, "{radius}: {out}, {}", 1.0 - straight);
        }
    }

    /// Unscattered walks leave where the closed form says; with them, a sphere that absorbs nothing
    /// returns all light.
    #[test]
    fn what_goes_straight_through_is_known() {
        for radius in [0.5f64, 2.0, 10.0] {
            let count = 200_000u64;
            let enter = |random: &mut _| {
                let (x, y) = in_disc(random);
                (radius * DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt()), DVec3::NEG_Z)
            };
            let add = |counts: &mut [u64; BINS], exit: Option<Exit>| {
                let Some(exit) = exit.filter(|exit| exit.scatterings == 0) else { return };
                let angle = exit.position.truncate().length().atan2(exit.position.z);
                counts[((angle / PI * BINS as f64) as usize).min(BINS - 1)] += 1;
            };
            let join = |a: [u64; BINS], b: [u64; BINS]| std::array::from_fn(|bin| a[bin] + b[bin]);
            let walks = Walks { albedo: 0.5, count, seed: 8 };
            let counts = fold(&Ball { radius }, walks, enter, || [0; BINS], add, join);
            let mut chi_squared = 0.0;
            for (bin, found) in counts.into_iter().enumerate() {
                let share = 4.0 * Profile::share(bin) * Profile::unscattered(radius, bin);
                let expected = share * count as f64;
                // Where almost nothing leaves, the counts are too small to compare.
                if expected > 5.0 {
                    chi_squared += (found as f64 - expected).powi(2) / (expected * (1.0 - share));
                } else {
                    assert!(found < 30, "{radius}, interval {bin}: {found} of {expected}");
                }
            }
            // For at most 18 intervals: mean 18, standard deviation 6.
            println!("radius {radius}: chi squared {chi_squared:.1}");
            assert!(chi_squared < 18.0 + 4.0 * 6.0, "{radius}: {chi_squared}");
            let whole = profile(radius, 1.0, count, 5).with_unscattered().whole();
            assert!((whole - 1.0).abs() < 4.0 * (0.25 / count as f64).sqrt(), "{radius}: {whole}");
        }
        assert_eq!(Profile::unscattered(f64::INFINITY, BINS - 1), 0.0);
    }

    /// A dense sphere follows Lambert's law except at the terminator: bright where it faces the
    /// light, dark behind.
    #[test]
    fn light_creeps_further_round_a_smaller_sphere() {
        let behind = |radius: f64| {
            let profile = profile(radius, 0.99, 200_000, 9);
            profile.exitance[BINS / 2..].iter().sum::<f64>() / profile.exitance.iter().sum::<f64>()
        };
        let shares = [2.0, 5.0, 20.0, 50.0].map(behind);
        println!("{shares:?}");
        assert!(shares.windows(2).all(|pair| pair[0] > pair[1]), "{shares:?}");
    }
}
