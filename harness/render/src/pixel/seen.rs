//! The radiance of a pixel.

use super::geometry::Stone;
use super::ray::Event;
use super::shading::Shading;
use super::surface::SurfacePoint;
use crate::stone::wavelengths::GemWavelength;
use glam::Vec3;
use lapidary_fresnel as fresnel;
use lapidary_plan::{Rung, Spectrum};
use lapidary_refraction as refraction;

/// A pixel's radiance and the events of its rays, wavelength by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixel {
    /// Linear radiance.
    pub radiance: Vec3,
    /// One list per ray: one ray, or one for each separate wavelength.
    pub rays: Vec<Vec<Event>>,
}

impl Shading<'_> {
    fn reflectance_channels(&self, cosine: f32) -> Vec3 {
        Vec3::from_array(self.material.channel_indices.to_array().map(|index| fresnel::dielectric(cosine, index)))
    }

    /// Returns the radiance of a pixel whose centre shows `point` of `stone` to an eye at `eye`, in
    /// world space; the point is in the stone's space.
    pub fn pixel(&self, stone: &Stone<'_>, point: SurfacePoint, eye: Vec3) -> Pixel {
        let entry = stone.entry(point);
        let eye = self.copy.as_ref().map_or(eye, |copy| copy.rotation * (eye - copy.translation) / copy.scale);
        let transmits = self.settings.rung != Rung::Surface;
        let direction = (entry.position - eye).normalize();
        let cosine = (-entry.face_normal.dot(direction)).clamp(0.0, 1.0);
        let reflected = self.surroundings(entry.position, refraction::reflect(direction, entry.face_normal));
        let mut rays = Vec::new();
        let met = self.met(entry.position, refraction::reflect(direction, entry.face_normal));
        rays.extend(met.map(|_| vec![Event { facet: None, total: 0, met }]));
        if let Spectrum::Separate(_) = self.settings.rung.spectrum() {
            let (mut surface, mut inside) = (Vec3::ZERO, Vec3::ZERO);
            for &GemWavelength { weights, index } in &self.wavelengths {
                let reflectance = fresnel::dielectric(cosine, index);
                surface += weights * (reflectance * reflected);
                if transmits {
                    let ray = self.trace(&entry, direction, index);
                    inside += weights * ((1.0 - reflectance) * ray.radiance);
                    rays.push(ray.events);
                }
            }
            return Pixel { radiance: surface + inside * self.base_color(), rays };
        }
        let mut reflectance = Vec3::splat(fresnel::dielectric(cosine, self.material.index));
        if matches!(self.settings.rung.spectrum(), Spectrum::Tracker | Spectrum::Split) {
            reflectance = self.reflectance_channels(cosine);
        }
        let traced = match self.settings.rung.spectrum() {
            _ if !transmits => Vec::new(),
            Spectrum::Paper => vec![self.trace_paper(&entry, direction)],
            Spectrum::Tracker => vec![self.trace_tracked(&entry, direction)],
            Spectrum::Split => self.trace_split(&entry, direction).into(),
            Spectrum::One | Spectrum::Separate(_) => vec![self.trace(&entry, direction, self.material.index)],
        };
        let inside: Vec3 = traced.iter().map(|ray| ray.radiance).sum();
        rays.extend(traced.into_iter().map(|ray| ray.events));
        let radiance = reflectance * reflected + (1.0 - reflectance) * self.base_color() * inside;
        Pixel { radiance, rays }
    }
}
