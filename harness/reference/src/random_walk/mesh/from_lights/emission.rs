//! Sampling of rays from lights towards bodies.

use super::super::walk::Ray;
use glam::{DVec2, DVec3};
use lapidary_scene::{Bounds, Light};
use std::f64::consts::{PI, TAU};

/// Lights around a sphere that contains all bodies.
pub(super) struct Emission {
    lights: Vec<Light>,
    /// Share of all rays that come from each light or one before it, by the power of its strongest
    /// channel.
    shares: Vec<f64>,
    centre: DVec3,
    radius: f64,
}

impl Emission {
    pub(super) fn new(lights: &[Light], bounds: Bounds) -> Self {
        // Slightly more than half the diagonal, which is rounded.
        let (centre, radius) = (bounds.centre().as_dvec3(), 1.0001 * f64::from(bounds.radius()));
        let mut emission = Self { lights: lights.to_vec(), shares: Vec::new(), centre, radius };
        let mut sum = 0.0;
        emission.shares = lights
            .iter()
            .map(|light| {
                sum += emission.measure(light) * f64::from(light.power().max_element());
                sum
            })
            .collect();
        emission.shares.iter_mut().for_each(|share| *share /= sum);
        emission
    }

    /// Area of the sphere's disc for a directional light; solid angle of the sphere as seen from a
    /// point light or spot.
    fn measure(&self, light: &Light) -> f64 {
        match light {
            Light::Directional { .. } => PI * self.radius * self.radius,
            Light::Point { position, .. } | Light::Spot { position, .. } => TAU * self.rise(position.as_dvec3()),
        }
    }

    /// 1 minus the cosine of the half-angle of the cone of directions from a point to the sphere; 2
    /// inside the sphere.
    fn rise(&self, position: DVec3) -> f64 {
        let distance = position.distance(self.centre);
        if distance <= self.radius {
            return 2.0;
        }
        let sine = self.radius / distance;
        // 1 - sqrt(1 - s²) without cancellation.
        sine * sine / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt())
    }

    /// Samples a ray and its power: two numbers in [0, 1) choose its `place` and one its light.
    /// Returns `None` if no light shines.
    pub(super) fn emit(&self, place: DVec2, choice: f64) -> Option<(Ray, DVec3)> {
        let chosen = self.shares.iter().position(|share| choice < *share)?;
        let light = &self.lights[chosen];
        let probability = self.shares[chosen] - if chosen > 0 { self.shares[chosen - 1] } else { 0.0 };
        let (sine, cosine) = (TAU * place.y).sin_cos();
        let ray = match light {
            Light::Directional { toward, .. } => {
                let toward = toward.as_dvec3().normalize();
                let (a, b) = toward.any_orthonormal_pair();
                let aside = place.x.sqrt() * (cosine * a + sine * b);
                Ray { position: self.centre + self.radius * (aside + toward), direction: -toward }
            }
            Light::Point { position, .. } | Light::Spot { position, .. } => {
                let position = position.as_dvec3();
                let axis = (self.centre - position).normalize_or(DVec3::Z);
                let (a, b) = axis.any_orthonormal_pair();
                let rise = place.x * self.rise(position);
                let aside = (rise * (2.0 - rise)).max(0.0).sqrt();
                let direction = (1.0 - rise) * axis + aside * (cosine * a + sine * b);
                Ray { position, direction: direction.normalize() }
            }
        };
        // At distance 1, a lamp's irradiance equals its intensity.
        let brightness = light.arrival(ray.position + ray.direction).irradiance;
        Some((ray, brightness * self.measure(light) / probability))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn bounds() -> Bounds {
        Bounds { min: Vec3::new(-1.0, 0.0, 2.0), max: Vec3::new(3.0, 2.0, 3.0) }
    }

    /// The power of rays through a small disc, divided by its area, is the irradiance that the
    /// lights give there.
    #[test]
    fn what_arrives_is_the_lights_irradiance() {
        let sun = Light::Directional { toward: Vec3::new(0.0, 0.6, 0.8), irradiance: Vec3::new(1.0, 2.0, 3.0) };
        let far = Light::Point { position: Vec3::new(8.0, 5.0, -3.0), intensity: Vec3::new(300.0, 100.0, 50.0) };
        let amid = Light::Point { position: Vec3::new(1.0, 1.0, 2.0), intensity: Vec3::splat(4.0) };
        let spot = Light::Spot {
            position: Vec3::new(1.0, 9.0, 3.0),
            direction: Vec3::NEG_Y,
            intensity: Vec3::splat(90.0),
            inner_angle: 0.05,
            outer_angle: 0.4,
        };
        let centre = DVec3::new(1.3, 1.1, 2.6);
        let disc = 0.12;
        for lights in [vec![sun], vec![far], vec![amid], vec![spot], vec![sun, far, spot]] {
            let emission = Emission::new(&lights, bounds());
            let side = 1000;
            let mut received = DVec3::ZERO;
            for index in 0u32..side * side {
                let place = DVec2::new(f64::from(index % side) + 0.5, f64::from(index / side) + 0.5) / f64::from(side);
                let choice = f64::from(index.wrapping_mul(2_654_435_761)) / 4_294_967_296.0;
                let (ray, power) = emission.emit(place, choice).expect("light");
                let along = (centre - ray.position).dot(ray.direction);
                if along > 0.0 && (ray.position + along * ray.direction).distance(centre) < disc {
                    received += power / f64::from(side * side) / (PI * disc * disc);
                }
            }
            // The disc is perpendicular to each ray, so the irradiances add up.
            let wanted: DVec3 = lights.iter().map(|light| light.arrival(centre).irradiance).sum();
            let error = (received / wanted - 1.0).abs().max_element();
            assert!(error < 0.05, "{lights:?}: {received} {wanted}");
        }
    }

    #[test]
    fn without_light_there_is_no_ray() {
        assert!(Emission::new(&[], bounds()).emit(DVec2::splat(0.5), 0.5).is_none());
        let dark = Light::Point { position: Vec3::ZERO, intensity: Vec3::ZERO };
        assert!(Emission::new(&[dark], bounds()).emit(DVec2::splat(0.5), 0.5).is_none());
    }
}
