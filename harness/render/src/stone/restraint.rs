//! When to end a ray inside a stone because the light it carries can no longer be seen.
//!
//! Beyond any point, the radiance that a ray still gathers lies, in each channel, between 0 and its
//! throughput there times the largest radiance of the environment: the shares and the remainder
//! after them add up to at most 1, whether the rest is taken from the environment or dropped. The
//! same holds for the radiance that replaces it where the ray ends. So the two differ by no more
//! than throughput × largest radiance. A pixel weights a ray by the share that its surface
//! transmits, at most 1, by the base colour, and by the exposure; with separate wavelengths also by
//! their matrices, whose entries may be negative, so that magnitudes add up. `throughput_limit`
//! divides by all of these.

pub use crate::light::environment::{LEAST_DIFFERENCE, STUDIO_LARGEST, largest_radiance};

use super::wavelengths::wavelengths;
use crate::settings::Settings;
use lapidary_plan::{Rung, Spectrum};
use lapidary_scene::Material;

/// The number of hits from which rays end by their throughput, unless the settings say otherwise:
/// the smallest number at which this slowed down no scene and no geometry by more than the
/// measurement noise (docs/gem.md). With fewer hits, a diamond's rays keep their throughput, and
/// nothing is gained.
pub const LEAST_HITS: u32 = 16;

/// Returns whether rays end by their throughput.
pub fn limits_throughput(rung: Rung, settings: &Settings) -> bool {
    let Rung::Inside { hits, .. } = rung else { return false };
    settings.gem.limit_throughput.unwrap_or(hits >= LEAST_HITS)
}

/// Returns the weight of the rays of all wavelengths in the pixel's sum: the largest sum of
/// absolute values in a row of their matrices.
pub fn largest_weight(material: &Material, spectrum: Spectrum) -> f64 {
    let Spectrum::Separate(_) = spectrum else { return 1.0 };
    let table = wavelengths(material, spectrum);
    let row = |row: usize| table.iter().flat_map(|w| w.weights.row(row).to_array()).map(|w| f64::from(w.abs())).sum();
    (0..3).map(row).fold(0.0, f64::max)
}

/// Returns `throughput_limit` of the recipe's `GemMaterial`; 0, which ends no ray, if the settings
/// have no such limit.
pub(crate) fn throughput_limit(material: &Material, rung: Rung, settings: &Settings) -> f32 {
    if !limits_throughput(rung, settings) {
        return 0.0;
    }
    let radiance = largest_radiance(&settings.environment) * material.base_color.max_element();
    let shown = f64::from(settings.exposure) * f64::from(radiance) * largest_weight(material, rung.spectrum());
    // In darkness nothing can be seen.
    (LEAST_DIFFERENCE / shown).min(f64::from(f32::MAX)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::GemOptions;

    #[test]
    fn rungs_of_many_hits_are_limited_where_nothing_is_said() {
        let limits = |rung: &str, limit_throughput| {
            let rung = rung.parse().expect(rung);
            limits_throughput(
                rung,
                &Settings {
                    rung,
                    gem: GemOptions { limit_throughput, ..GemOptions::default() },
                    ..Settings::of_size(1, 1)
                },
            )
        };
        assert_eq!(
            ["proxy-15", "convex-16", "bvh-64+3", "surface"].map(|rung| limits(rung, None)),
            [false, true, true, false]
        );
        assert_eq!(["proxy-1", "convex-64", "surface"].map(|rung| limits(rung, Some(true))), [true, true, false]);
        assert!(!limits("convex-64", Some(false)));
    }

    #[test]
    fn the_limit_is_the_least_difference_over_all_that_follows() {
        let material = Material { base_color: glam::Vec3::new(0.25, 0.5, 0.125), ..Material::standard() };
        let rung = "convex-16".parse().expect("a rung");
        let settings = Settings { rung, exposure: 4.0, ..Settings::of_size(1, 1) };
        let found = f64::from(throughput_limit(&material, rung, &settings));
        assert!((found * 510.0 * 4.0 * 20.4 * 0.5 - 1.0).abs() < 1e-6, "{found}");
        assert_eq!(
            throughput_limit(
                &material,
                rung,
                &Settings { gem: GemOptions { limit_throughput: Some(false), ..settings.gem }, ..settings }
            ),
            0.0
        );
    }
}
