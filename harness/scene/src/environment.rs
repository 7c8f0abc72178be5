//! Light from far away.

use crate::environment_map::EnvironmentMap;
use glam::{DVec3, UVec2};
use lapidary_environment::oracle;
use std::sync::OnceLock;

mod jeweller;

/// The light around a scene.
#[derive(Clone, Debug)]
pub enum Environment {
    /// The procedural studio of `wgsl/environment.wgsl`.
    Studio,
    /// A latitude-longitude image.
    Map(EnvironmentMap),
}

/// An environment that needs no file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BuiltInEnvironment {
    /// A dim tent with a few lights: the procedural studio of `wgsl/environment.wgsl`.
    #[default]
    Studio,
    /// Softboxes, black flags and rows of small bright lights, as an image.
    Jeweller,
}

impl BuiltInEnvironment {
    /// Each once.
    pub const ALL: [Self; 2] = [Self::Studio, Self::Jeweller];

    /// Returns the name that a user types.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Studio => "studio",
            Self::Jeweller => "jeweller",
        }
    }

    /// Makes the environment.
    #[must_use]
    pub fn make(self) -> Environment {
        match self {
            Self::Studio => Environment::Studio,
            Self::Jeweller => {
                static MAP: OnceLock<EnvironmentMap> = OnceLock::new();
                Environment::Map(MAP.get_or_init(jeweller::map).clone())
            }
        }
    }
}

impl Environment {
    /// Returns the linear RGB radiance that arrives from a direction, in f64, by the recipe's rule:
    /// the studio, or the map's four nearest texels.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        match self {
            Self::Studio => oracle::studio(direction),
            Self::Map(map) => bilinear(map, direction),
        }
    }
}

fn bilinear(map: &EnvironmentMap, direction: DVec3) -> DVec3 {
    let uv = oracle::uv_from_direction(direction);
    let texels = oracle::texels(uv, UVec2::new(map.width, map.height));
    let texel = |column: u32, row: u32| {
        let [red, green, blue, _] = map.pixels[row as usize * map.width as usize + column as usize];
        DVec3::new(red.into(), green.into(), blue.into())
    };
    let lower = texel(texels.lower.x, texels.lower.y).lerp(texel(texels.upper.x, texels.lower.y), texels.weight.x);
    let upper = texel(texels.lower.x, texels.upper.y).lerp(texel(texels.upper.x, texels.upper.y), texels.weight.x);
    lower.lerp(upper, texels.weight.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texels_middle_is_the_texel_and_between_two_is_their_mean() {
        let pixels: Vec<[f32; 4]> = (0..32u16).map(|k| [f32::from(k), f32::from(k * k), 1.0, 1.0]).collect();
        let map = EnvironmentMap { width: 8, height: 4, pixels: pixels.clone() };
        let environment = Environment::Map(map);
        let seen = |column: f64, row: f64| {
            let uv = glam::DVec2::new((column + 0.5) / 8.0, (row + 0.5) / 4.0);
            environment.radiance(oracle::direction_from_uv(uv))
        };
        let texel = |k: usize| DVec3::new(pixels[k][0].into(), pixels[k][1].into(), 1.0);
        assert!(seen(3.0, 2.0).abs_diff_eq(texel(19), 1e-9));
        assert!(seen(3.5, 2.0).abs_diff_eq(0.5 * (texel(19) + texel(20)), 1e-9));
        assert!(seen(7.5, 1.5).abs_diff_eq(0.25 * (texel(15) + texel(8) + texel(23) + texel(16)), 1e-9));
    }
}
