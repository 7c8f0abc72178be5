//! Point and directional lights. Light from all around the scene is its environment.

use glam::{DVec3, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A light without size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// A light so far away that its rays are parallel.
    Directional {
        /// Unit vector towards the light.
        toward: Vec3,
        /// Irradiance on a surface perpendicular to the light, linear RGB, at least 0.
        irradiance: Vec3,
    },
    /// A point that radiates equally in all directions.
    Point {
        /// Position in world space.
        position: Vec3,
        /// Radiant intensity, linear RGB, at least 0: the irradiance at distance 1.
        intensity: Vec3,
    },
    /// A point that radiates into a cone.
    Spot {
        /// Position in world space.
        position: Vec3,
        /// Unit vector along the cone's axis, away from the light.
        direction: Vec3,
        /// Radiant intensity along the axis, linear RGB, at least 0: the irradiance there at
        /// distance 1.
        intensity: Vec3,
        /// Angle from the axis within which the intensity is full, in radians: at least 0 and less
        /// than `outer_angle`.
        inner_angle: f32,
        /// Angle from the axis beyond which there is no light, in radians: at most π/2.
        outer_angle: f32,
    },
}

/// Returns the irradiance by `lights` at a point of a surface with a unit `normal`, if nothing blocks them.
#[must_use]
pub fn irradiance(lights: &[Light], point: DVec3, normal: DVec3) -> DVec3 {
    let arrivals = lights.iter().map(|light| light.arrival(point));
    arrivals.map(|arrival| arrival.direction.dot(normal).max(0.0) * arrival.irradiance).sum()
}

/// Light that arrives at a point if nothing blocks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// Unit vector towards the light; 0 at the exact position of a light, where nothing arrives.
    pub direction: DVec3,
    /// Distance to the light, infinite for a directional one.
    pub distance: f64,
    /// Irradiance on a surface perpendicular to the direction, linear RGB.
    pub irradiance: DVec3,
}

/// Falloff of a spot's intensity from its inner to its outer angle: ((c - `edge`) `slope`)²,
/// clamped to 0 to 1, where c is the cosine of the angle from the axis. This is the formula that
/// `KHR_lights_punctual` recommends, without its lower limit of .001 for the difference of the
/// cosines, which would dim the middle of a cone of less than 2.6°.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Falloff {
    /// Cosine of the outer angle.
    pub edge: f64,
    /// Reciprocal of the difference of the two angles' cosines.
    pub slope: f64,
}

impl Falloff {
    /// Returns the falloff between two angles in radians, 0 ≤ `inner` < `outer` ≤ π/2.
    #[must_use]
    pub fn between(inner: f32, outer: f32) -> Self {
        let [inner, outer] = [f64::from(inner), f64::from(outer)];
        // The difference of the cosines as a product, because cosines of small angles all round to
        // 1.
        let difference = 2.0 * (0.5 * (outer + inner)).sin() * (0.5 * (outer - inner)).sin();
        Self { edge: outer.cos(), slope: 1.0 / difference }
    }

    /// Returns the fraction of the intensity in a direction with this cosine to the axis.
    fn share(self, cosine: f64) -> f64 {
        ((cosine - self.edge) * self.slope).clamp(0.0, 1.0).powi(2)
    }
}

impl Light {
    /// Returns the light that arrives at a point.
    #[must_use]
    pub fn arrival(&self, position: DVec3) -> Arrival {
        match *self {
            Self::Directional { toward, irradiance } => Arrival {
                direction: toward.as_dvec3().normalize(),
                distance: f64::INFINITY,
                irradiance: irradiance.as_dvec3(),
            },
            Self::Point { position: place, intensity } => from_place(place, intensity, position),
            Self::Spot { position: place, direction, intensity, inner_angle, outer_angle } => {
                let whole = from_place(place, intensity, position);
                let cosine = -whole.direction.dot(direction.as_dvec3().normalize());
                let share = Falloff::between(inner_angle, outer_angle).share(cosine);
                Arrival { irradiance: share * whole.irradiance, ..whole }
            }
        }
    }

    /// Returns a directional light's irradiance or a lamp's intensity, linear RGB.
    #[must_use]
    pub fn power(&self) -> Vec3 {
        match *self {
            Self::Directional { irradiance: power, .. }
            | Self::Point { intensity: power, .. }
            | Self::Spot { intensity: power, .. } => power,
        }
    }

    /// Returns which field is invalid and what to do, or `None` if the light is valid.
    #[must_use]
    pub fn problem(&self) -> Option<&'static str> {
        let is_light = |light: Vec3| light.is_finite() && light.cmpge(Vec3::ZERO).all();
        match *self {
            Self::Directional { toward: direction, .. } | Self::Spot { direction, .. }
                if !direction.is_normalized() =>
            {
                Some("its direction has not unit length; normalise it")
            }
            Self::Point { position, .. } | Self::Spot { position, .. } if !position.is_finite() => {
                Some("its position is not finite; mend it")
            }
            _ if !is_light(self.power()) => Some("its light is not finite and at least 0; mend it"),
            Self::Spot { inner_angle, outer_angle, .. } if !are_cone_angles(inner_angle, outer_angle) => {
                Some("its cone's angles are not 0 ≤ inner < outer ≤ π/2; mend them")
            }
            _ => None,
        }
    }
}

/// Whether these angles, in radians, are valid for a cone.
pub(super) fn are_cone_angles(inner: f32, outer: f32) -> bool {
    0.0 <= inner && inner < outer && outer <= FRAC_PI_2
}

/// Returns the light that arrives from a point of this intensity.
fn from_place(place: Vec3, intensity: Vec3, position: DVec3) -> Arrival {
    let way = place.as_dvec3() - position;
    let distance = way.length();
    if distance == 0.0 {
        return Arrival { direction: DVec3::ZERO, distance, irradiance: DVec3::ZERO };
    }
    Arrival { direction: way / distance, distance, irradiance: intensity.as_dvec3() / (distance * distance) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn spot(inner_angle: f32, outer_angle: f32) -> Light {
        Light::Spot {
            position: Vec3::new(1.0, 2.0, 3.0),
            direction: Vec3::NEG_Y,
            intensity: Vec3::new(8.0, 4.0, 2.0),
            inner_angle,
            outer_angle,
        }
    }

    /// Returns the light that arrives at this angle from the axis, at distance 2.
    fn arrival(light: Light, angle: f64) -> Arrival {
        let below = DVec3::new(angle.sin(), -angle.cos(), 0.0);
        let found = light.arrival(DVec3::new(1.0, 2.0, 3.0) + 2.0 * below);
        assert!((found.distance - 2.0).abs() < 1e-12 && found.direction.distance(-below) < 1e-12);
        found
    }

    #[test]
    fn a_spot_is_a_point_within_its_inner_angle_and_nothing_beyond_its_outer() {
        let light = spot(0.3, 0.7);
        for angle in [0.0, 0.1, 0.2999] {
            assert!(arrival(light, angle).irradiance.distance(DVec3::new(2.0, 1.0, 0.5)) < 1e-12);
        }
        for angle in [0.7001, 1.0, 1.6, PI] {
            assert_eq!(arrival(light, angle).irradiance, DVec3::ZERO);
        }
        let Light::Spot { position, intensity, .. } = light else { panic!("{light:?}") };
        assert_eq!(arrival(light, 0.1), arrival(Light::Point { position, intensity }, 0.1));
    }

    /// glTF's own formula: scale = 1 / (cos i - cos o), offset = -cos o · scale,
    /// saturate(c · scale + offset)².
    #[test]
    fn between_its_angles_a_spot_falls_off_as_gltf_has_it() {
        let (inner, outer) = (0.3f64, 0.7f64);
        let scale = 1.0 / (inner.cos() - outer.cos());
        let offset = -outer.cos() * scale;
        let mut last = f64::INFINITY;
        for step in 0..=40 {
            let angle = inner + (outer - inner) * f64::from(step) / 40.0;
            let found = arrival(spot(0.3, 0.7), angle).irradiance.x;
            let expected = 2.0 * (angle.cos() * scale + offset).clamp(0.0, 1.0).powi(2);
            assert!((found - expected).abs() < 1e-6, "{angle}: {found}, {expected}");
            assert!(found < last + 1e-7);
            last = found;
        }
        // The middle of the range of cosines.
        let middle = (0.5 * (inner.cos() + outer.cos())).acos();
        assert!((arrival(spot(0.3, 0.7), middle).irradiance.x - 0.5).abs() < 1e-6);
    }

    /// The integral of the falloff over the sphere: with u = cos,
    /// 2π [(1 - cos i) + (cos i - cos o) / 3].
    #[test]
    fn a_spots_flux_is_the_integral_of_its_falloff() {
        for (inner, outer) in [(0.0, 0.5), (0.4, 0.9), (0.0, FRAC_PI_2), (1.0, FRAC_PI_2)] {
            let light = spot(inner, outer);
            let steps = 20_000;
            let flux: f64 = (0..steps)
                .map(|step| {
                    let angle = PI * (f64::from(step) + 0.5) / f64::from(steps);
                    let intensity = 4.0 * arrival(light, angle).irradiance.x;
                    intensity * TAU * angle.sin() * PI / f64::from(steps)
                })
                .sum();
            let [inner, outer] = [inner, outer].map(|angle| f64::from(angle).cos());
            let expected = 8.0 * TAU * ((1.0 - inner) + (inner - outer) / 3.0);
            assert!((flux / expected - 1.0).abs() < 1e-5, "{flux}, {expected}");
        }
    }

    #[test]
    fn the_narrowest_cones_are_whole_in_their_middle() {
        for (inner, outer) in [(0.0, 1e-3), (0.0, 1e-7), (0.0, f32::from_bits(1)), (1e-7, 2e-7)] {
            let falloff = Falloff::between(inner, outer);
            assert!(falloff.slope > 0.0 && !falloff.slope.is_nan(), "{falloff:?}");
        }
        let found = arrival(spot(0.0, 1e-3), 0.0).irradiance.x;
        assert!((found - 2.0).abs() < 1e-6, "{found}");
    }

    #[test]
    fn at_the_place_of_a_light_nothing_arrives() {
        let place = DVec3::new(1.0, 2.0, 3.0);
        for light in [spot(0.1, 0.2), Light::Point { position: place.as_vec3(), intensity: Vec3::ONE }] {
            let found = light.arrival(place);
            assert_eq!((found.distance, found.irradiance, found.direction), (0.0, DVec3::ZERO, DVec3::ZERO));
        }
    }

    #[test]
    fn a_sun_is_the_same_everywhere() {
        let sun = Light::Directional { toward: Vec3::Z, irradiance: Vec3::ONE };
        let expected = Arrival { direction: DVec3::Z, distance: f64::INFINITY, irradiance: DVec3::ONE };
        assert_eq!([DVec3::ZERO, DVec3::splat(1e9)].map(|place| sun.arrival(place)), [expected; 2]);
    }
}
