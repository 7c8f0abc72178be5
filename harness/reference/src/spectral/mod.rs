//! The spectral reference: renders clear stones, with opaque bodies beside them, by following light
//! along all its paths.
//!
//! Every ray that meets a surface is split into its reflection and its refraction by the oracles of
//! `fresnel` and `refraction`, separately at each wavelength, in f64, until the remaining energy is
//! below a bound. The rest is dropped: at each wavelength an image is too dark, never too bright,
//! and [`Lost`] says by how much at most. Nothing is random, so two runs give the same image.
//!
//! A pixel is the mean of a regular grid of rays, as in the renderer. Bodies are closed; a ray that leaves one may enter
//! another, or the same one again. Bodies may lie within clear ones, touch or overlap: where they share space, the one of the
//! highest [`Material::priority`](lapidary_scene::Material::priority) is there, or else the smaller one, up to twelve around
//! a point. On a smooth clear body ([`Material::normals`](lapidary_scene::Material::normals)) the normals between a triangle's
//! corners reflect and refract; where they would send light to the wrong side of the triangle, its own does. A clear body
//! without thickness is a thin wall, which reflects and lets through what a pane of two interfaces does. Light is multiplied by the base colour on entry and
//! absorbed by the attenuation colour inside, channel by channel, as in glTF and the gem recipes. Images of base colour, normals
//! and transmission, and colours of vertices, hold at the point where light crosses the surface.
//!
//! An opaque body is matte, or a metal: light that meets a metal goes from facet to facet of its rough surface and on from there,
//! at random, to other bodies or the environment; lights count at each facet. A matte one sends the same radiance in all directions, base colour / π times the
//! irradiance, and ends every ray that meets it. The irradiance is that of the recipe
//! `cdrf_shading` without shadows: the environment by its spherical harmonics, and each light, at
//! the shared normals, interpolated between a triangle's corners. So stones show opaque bodies, but
//! neither shade them nor throw light on them. What such a surface itself reflects is left out: the
//! highlights of lights on a rough one, and the mirror image in a polished one, which
//! `lapidary-render` refuses. Bodies that scatter light send what [`Scatterer`]s say, which are lit as if nothing else were
//! there.

mod bvh;
mod cells;
mod face;
pub(crate) mod geometry;
pub(crate) mod hit;
mod matte;
mod paint;
mod rough;
mod scatterer;
mod trace;
mod within;

pub use geometry::Geometry;
pub use scatterer::Scatterer;

use crate::generator::generator;
use geometry::Bodies;
use glam::{DMat3, DVec3};
use lapidary_absorption::oracle as absorption;
use lapidary_scene::spectrum::{self, Wavelength};
use lapidary_scene::view::View;
use lapidary_scene::{Environment, LARGEST_SIDE, Light, Object, SAMPLES, Scene};
use matte::Mattes;
use paint::{Painted, is_partly_clear};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use trace::{Optics, Primary, Surface, Surroundings};
use within::{Order, Within};

/// Default number of wavelengths.
pub const WAVELENGTHS: usize = 31;
/// Default energy bound.
pub const ENERGY_BOUND: f64 = 1e-4;
/// Largest number of wavelengths in a spectrum.
pub const MOST_WAVELENGTHS: usize = 301;
/// Number of ways that light takes for each sample and wavelength, if any body is rough or scatters.
const ROUGH_PATHS: u32 = 16;
/// Seed of these ways.
const SEED: u64 = 1;
/// Largest number of samples along each side of a pixel.
pub const MOST_SAMPLES: u32 = 64;

/// Settings of a spectral rendering.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'environment> {
    /// Width of the whole image in pixels, 1 to [`LARGEST_SIDE`].
    pub width: u32,
    /// Height of the whole image in pixels, 1 to [`LARGEST_SIDE`].
    pub height: u32,
    /// Window to render; `None` renders the whole image.
    pub window: Option<Window>,
    /// Number of wavelengths from 400 to 700 nm, [`spectrum::FEWEST`] to [`MOST_WAVELENGTHS`].
    pub wavelengths: usize,
    /// Samples along each side of a pixel, 1 to [`MOST_SAMPLES`].
    pub samples: u32,
    /// Share of a camera ray's energy that may be dropped, above 0 and below 1.
    pub energy_bound: f64,
    /// Environment that lights the scene.
    pub environment: &'environment Environment,
    /// Whether the environment lights matte bodies too, and not only the stones.
    pub lit_by_environment: bool,
    /// Whether the discs of lights are seen in and through clear bodies.
    pub lights: bool,
    /// Representation of bodies for ray intersection.
    pub geometry: Geometry,
    /// By the scene's bodies, those that scatter light; a body that is not named is matte or clear by its material.
    pub scatterers: &'environment [Option<&'environment dyn Scatterer>],
}

impl Settings<'static> {
    /// The whole image in the studio, with 31 wavelengths, the renderer's 4 × 4 samples and an
    /// energy bound of 1e-4.
    #[must_use]
    pub fn of_size(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            window: None,
            wavelengths: WAVELENGTHS,
            samples: SAMPLES,
            energy_bound: ENERGY_BOUND,
            environment: &Environment::Studio,
            lit_by_environment: true,
            lights: false,
            geometry: Geometry::Planes,
            scatterers: &[],
        }
    }
}

/// A rectangle of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Columns to the left of the window.
    pub left: u32,
    /// Rows above the window.
    pub top: u32,
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
}

/// A rendered image, or a window of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Width of the window in pixels.
    pub width: u32,
    /// Height of the window in pixels.
    pub height: u32,
    /// Linear radiance and coverage, row by row from the top; transparent black where there is no
    /// body.
    pub linear: Vec<[f32; 4]>,
    /// Energy that was dropped.
    pub lost: Lost,
}

/// Shares of the energy of camera rays that were not followed to their ends. A share of `x` changes
/// the radiance at a wavelength by at most x times the greatest radiance of the environment and of
/// all matte bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lost {
    /// Largest share of any sample that meets a body, at any wavelength. It exceeds the energy
    /// bound only if a ray was trapped by total reflection for 20,000 hits, a surface is not
    /// closed, or more than twelve bodies lie within one another.
    pub max: f64,
    /// Mean share over all these samples and wavelengths.
    pub mean: f64,
}

/// Why an image cannot be rendered.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// Width or height out of range.
    #[error("size {width}x{height} is out of range; each side must be 1 to {LARGEST_SIDE} pixels")]
    Size {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
    },
    /// A window that is empty or does not lie within the image.
    #[error("the window {window:?} does not lie within the picture's {width}x{height} pixels")]
    Window {
        /// Requested window.
        window: Window,
        /// Width of the image in pixels.
        width: u32,
        /// Height of the image in pixels.
        height: u32,
    },
    /// Too few or too many wavelengths.
    #[error("{0} wavelengths are out of range; take {least} to {MOST_WAVELENGTHS}", least = spectrum::FEWEST)]
    Wavelengths(usize),
    /// Too few or too many samples.
    #[error("{0} samples a side are out of range; take 1 to {MOST_SAMPLES}")]
    Samples(u32),
    /// An energy bound that is not above 0 and below 1.
    #[error("an energy bound of {0} is out of range; it must be above 0 and below 1")]
    EnergyBound(f64),
}

impl Settings<'_> {
    /// Returns the window to render, or an error if a setting is out of range.
    fn checked(&self) -> Result<Window, ReferenceError> {
        let &Self { width, height, .. } = self;
        if !(1..=LARGEST_SIDE).contains(&width) || !(1..=LARGEST_SIDE).contains(&height) {
            return Err(ReferenceError::Size { width, height });
        }
        let window = self.window.unwrap_or(Window { left: 0, top: 0, width, height });
        let within = |start: u32, size: u32, whole: u32| size > 0 && start <= whole && size <= whole - start;
        if !within(window.left, window.width, width) || !within(window.top, window.height, height) {
            return Err(ReferenceError::Window { window, width, height });
        }
        if !(spectrum::FEWEST..=MOST_WAVELENGTHS).contains(&self.wavelengths) {
            return Err(ReferenceError::Wavelengths(self.wavelengths));
        }
        if !(1..=MOST_SAMPLES).contains(&self.samples) {
            return Err(ReferenceError::Samples(self.samples));
        }
        // Written so that NaN fails too.
        if !(self.energy_bound > 0.0 && self.energy_bound < 1.0) {
            return Err(ReferenceError::EnergyBound(self.energy_bound));
        }
        Ok(window)
    }
}

/// Renders `scene` on all cores; after each row, calls `progress` with the numbers of finished rows
/// and of all rows.
///
/// # Errors
/// Returns a [`ReferenceError`] if a setting is out of range.
pub fn render(
    scene: &Scene,
    settings: &Settings<'_>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Rendering, ReferenceError> {
    let (window, rows) = rows(scene, settings, progress, |job, pixel| {
        let mut sum = Pixel::default();
        job.samples(pixel).for_each(|sample| sum.add(&sample));
        sum
    })?;
    let pixels: Vec<Pixel> = rows.into_iter().flatten().collect();
    Ok(Rendering::of(window, settings, &pixels))
}

/// Renders like [`render`] and also returns the samples, row by row: linear radiance and coverage.
///
/// # Errors
/// Returns a [`ReferenceError`] if a setting is out of range.
pub fn render_samples(
    scene: &Scene,
    settings: &Settings<'_>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<(Rendering, Vec<[f32; 4]>), ReferenceError> {
    let (window, rows) = rows(scene, settings, progress, |job, pixel| {
        let samples: Vec<Pixel> = job.samples(pixel).collect();
        let mut sum = Pixel::default();
        samples.iter().for_each(|sample| sum.add(sample));
        (sum, samples.iter().map(|sample| sample.mean(1.0)).collect::<Vec<_>>())
    })?;
    let side = settings.samples as usize;
    let mut samples = Vec::with_capacity(window.width as usize * window.height as usize * side * side);
    for row in &rows {
        for line in 0..side {
            samples.extend(row.iter().flat_map(|(_, taken)| &taken[line * side..][..side]));
        }
    }
    let pixels: Vec<Pixel> = rows.into_iter().flatten().map(|(pixel, _)| pixel).collect();
    Ok((Rendering::of(window, settings, &pixels), samples))
}

/// Calls `of_pixel` for each column and row of the window and returns the results, row by row.
fn rows<'scene, Found: Send>(
    scene: &'scene Scene,
    settings: &Settings<'scene>,
    progress: &(dyn Fn(u64, u64) + Sync),
    of_pixel: impl Fn(&Job<'scene>, (u32, u32)) -> Found + Sync,
) -> Result<(Window, Vec<Vec<Found>>), ReferenceError> {
    let window = settings.checked()?;
    let job = Job::new(scene, settings);
    let done = AtomicU64::new(0);
    let row = |y: u32| {
        let row: Vec<Found> = (window.left..window.left + window.width).map(|x| of_pixel(&job, (x, y))).collect();
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, window.height.into());
        row
    };
    Ok((window, (window.top..window.top + window.height).into_par_iter().map(row).collect()))
}

impl Rendering {
    /// Turns sums over the pixels' samples into means.
    fn of(window: Window, settings: &Settings<'_>, pixels: &[Pixel]) -> Self {
        let covered: u64 = pixels.iter().map(|pixel| u64::from(pixel.covered)).sum();
        let lost_sum: f64 = pixels.iter().map(|pixel| pixel.lost_sum).sum();
        let lost = Lost {
            max: pixels.iter().map(|pixel| pixel.lost_max).fold(0.0, f64::max),
            mean: lost_sum / (covered.max(1) as f64 * settings.wavelengths as f64),
        };
        let share = 1.0 / f64::from(settings.samples * settings.samples);
        let linear = pixels.iter().map(|pixel| pixel.mean(share)).collect();
        Self { width: window.width, height: window.height, linear, lost }
    }
}

/// Sums over the samples of a pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    radiance: DVec3,
    /// Number of samples that meet a body.
    covered: u32,
    lost_sum: f64,
    lost_max: f64,
}

/// Data shared by all pixels.
struct Job<'scene> {
    view: View,
    surroundings: Surroundings<'scene>,
    spectrum: Vec<Band>,
    samples: u32,
}

/// Wavelengths beside one another at which all bodies have the same optics.
struct Band {
    /// Sum of the wavelengths' weights.
    weights: DMat3,
    /// Number of wavelengths.
    count: u32,
    /// The optics of every body.
    optics: Vec<Optics>,
}

impl<'scene> Job<'scene> {
    fn new(scene: &Scene, settings: &Settings<'scene>) -> Self {
        let mut spectrum: Vec<Band> = Vec::new();
        for wavelength in spectrum::weights(settings.wavelengths) {
            let optics: Vec<Optics> = scene.objects.iter().map(|object| optics(object, &wavelength)).collect();
            match spectrum.last_mut().filter(|band| band.optics == optics) {
                Some(band) => {
                    band.weights += wavelength.weights;
                    band.count += 1;
                }
                None => spectrum.push(Band { weights: wavelength.weights, count: 1, optics }),
            }
        }
        let mattes = Mattes::new(scene, settings.lit_by_environment.then_some(settings.environment));
        let view = View::new(&scene.camera, settings.width, settings.height);
        let bodies = Bodies::with_mattes(&scene.objects, settings.geometry, mattes);
        let around_eye = Within::around(scene.camera.eye, &scene.objects);
        let surfaces: Vec<Surface> = scene.objects.iter().map(surface).collect();
        Self {
            view,
            surroundings: Surroundings {
                around_eye,
                bodies,
                order: Order::of(&scene.objects),
                lights: if settings.lights { lights(scene) } else { Vec::new() },
                is_random: surfaces.iter().any(Surface::is_rough) || settings.scatterers.iter().any(Option::is_some),
                scatterers: settings.scatterers,
                surfaces,
                environment: settings.environment,
                energy_bound: settings.energy_bound,
            },
            spectrum,
            samples: settings.samples,
        }
    }

    /// Yields each sample of a pixel, row by row.
    fn samples(&self, (x, y): (u32, u32)) -> impl Iterator<Item = Pixel> {
        let place =
            move |index: u32, sample: u32| f64::from(index) + (f64::from(sample) + 0.5) / f64::from(self.samples);
        (0..self.samples * self.samples).map(move |sample| {
            let (row, column) = (sample / self.samples, sample % self.samples);
            // The same numbers on any number of threads.
            let counter =
                (u64::from(y) << 32 | u64::from(x)) * u64::from(self.samples * self.samples) + u64::from(sample);
            self.sample(self.view.direction(place(x, column), place(y, row)), counter)
        })
    }

    fn sample(&self, direction: DVec3, counter: u64) -> Pixel {
        let mut sample = Pixel::default();
        let Some(primary) = self.surroundings.primary(self.view.eye, direction) else { return sample };
        sample.covered = 1;
        if let Primary::Matte(radiance) = primary {
            // The same at all wavelengths, whose weights add up to the identity.
            sample.radiance = radiance;
            return sample;
        }
        let paths = if self.surroundings.is_random { ROUGH_PATHS } else { 1 };
        let share = f64::from(paths).recip();
        let mut random = generator(SEED, counter);
        for Band { weights, count, optics } in &self.spectrum {
            for _ in 0..paths {
                let outcome = self.surroundings.follow(&primary, optics, &mut random);
                sample.radiance += share * *weights * outcome.radiance;
                sample.lost_sum += share * f64::from(*count) * outcome.lost;
                sample.lost_max = sample.lost_max.max(outcome.lost);
            }
        }
        sample
    }
}

impl Pixel {
    fn add(&mut self, sample: &Self) {
        self.radiance += sample.radiance;
        self.covered += sample.covered;
        self.lost_sum += sample.lost_sum;
        self.lost_max = self.lost_max.max(sample.lost_max);
    }

    /// Linear radiance and coverage times `share`, which is one over the number of samples.
    fn mean(&self, share: f64) -> [f32; 4] {
        let [red, green, blue] = (self.radiance * share).as_vec3().to_array();
        [red, green, blue, (f64::from(self.covered) * share) as f32]
    }
}

/// Returns the lights with the radii of their discs.
fn lights(scene: &Scene) -> Vec<(Light, f64)> {
    scene.lights.iter().enumerate().map(|(number, light)| (*light, scene.light_radius(number).into())).collect()
}

/// Returns the properties of a body's surface.
fn surface(object: &Object) -> Surface {
    let material = &object.material;
    Surface {
        // What an opaque body does not cover, goes straight on, as through a thin wall of index 1.
        is_thin: material.is_opaque() || material.is_thin_wall(),
        is_opaque: material.is_opaque(),
        alpha: f64::from(material.facet_slope()),
        painted: Painted::of(material),
        is_partly_clear: is_partly_clear(object),
        f0: if material.is_metal() { material.base_color.as_dvec3() } else { DVec3::ZERO },
    }
}

/// Returns the optical properties of a body at one wavelength.
fn optics(object: &Object, wavelength: &Wavelength) -> Optics {
    let material = &object.material;
    if material.is_opaque() {
        return Optics { index: 1.0, absorption: DVec3::ZERO, base_color: DVec3::ONE };
    }
    Optics {
        index: material.index_at(wavelength.nanometres),
        absorption: absorption::coefficient(
            material.attenuation_color.as_dvec3(),
            f64::from(material.attenuation_distance),
        ),
        base_color: material.base_color.as_dvec3(),
    }
}

#[cfg(test)]
mod tests;
