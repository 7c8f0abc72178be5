//! What translucent bodies show, path-traced: the picture that the translucent techniques are compared with.
//!
//! Bodies are closed triangle meshes that do not overlap, each of one [`Medium`](crate::scene::Medium). Unless asked for, their surfaces do not bend
//! or reflect light, so that a ray from the eye goes straight in. At each scattering every light is asked for what arrives from it through
//! all matter on the way, also through other bodies, or the same again; light from the environment comes along the walk's last direction. What
//! shows through without being scattered is the background's and is left out.
//!
//! The eye and the lights stand outside of the bodies; a point light inside gives the right mean with an error that has no bound.

mod closed;
mod walk;

use super::generator;
use crate::reference::view::View;
use crate::render::{Environment, LARGEST_SIDE};
use crate::scene::{Light, Scene};
use closed::open_edges;
use glam::DVec3;
use rand::RngExt as _;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use walk::Matter;

/// The most samples of a pixel.
pub const MOST_SAMPLES: u32 = 1 << 20;

/// What to render.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'environment> {
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub width: u32,
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub height: u32,
    /// Walks from each pixel, 2 to [`MOST_SAMPLES`]. The largest square number of them start from a grid's cells, one each, the rest
    /// anywhere in the pixel.
    pub samples_per_pixel: u32,
    /// The same seed gives the same picture on any number of threads.
    pub seed: u64,
    /// The light around the scene beside its own lights, if any.
    pub environment: Option<&'environment Environment>,
    /// What surfaces do to light.
    pub boundary: Boundary,
}

/// What a body's surface does to light that meets it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// Nothing.
    #[default]
    Matched,
    /// It bends light by the material's refractive index and reflects Fresnel's share, from outside and from inside, as a polished surface does. What it
    /// mirrors of the surroundings was not scattered and is left out. Light then comes from walks that leave alone: from the environment, and from
    /// directional lights as discs of 0.1 rad about their direction, which takes very many walks. There may be no point light.
    Dielectric,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Linear radiance and coverage, row by row from the top: means over a pixel, so that what it does not cover is black.
    pub linear: Vec<[f32; 4]>,
    /// The standard error of each pixel's red, green and blue, as of samples that know nothing of one another. Since they are spread
    /// evenly over the pixel, the error is no greater, and less where a pixel is not of one brightness.
    pub standard_error: Vec<[f32; 3]>,
    /// Samples that met a body.
    pub walks: u64,
    /// Of all walks together.
    pub scatterings: u64,
    /// Walks that slipped through a surface by rounding, and were followed no further.
    pub lost: u64,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WalkError {
    /// Width or height out of range.
    #[error("size {width}x{height} is out of range; each side must be 1 to {LARGEST_SIDE} pixels")]
    Size {
        /// What was asked for.
        width: u32,
        /// What was asked for.
        height: u32,
    },
    /// Too few to know their error, or too many.
    #[error("{0} samples a pixel are out of range; take 2 to {MOST_SAMPLES}")]
    Samples(u32),
    /// A light that no walk would meet.
    #[error(
        "light {light} is a point, which no walk through a dielectric boundary meets; take it out or match the boundary"
    )]
    Point {
        /// Its place among the scene's lights, from 0.
        light: usize,
    },
    /// A body of unknown matter.
    #[error(
        "{object:?} has no scattering and absorption coefficients, so that no light can be followed through it; give its material a medium"
    )]
    NoMedium {
        /// Its name.
        object: String,
    },
    /// A body with holes.
    #[error("{object:?} is not closed: {edges} of its edges have a triangle on one side only; close its mesh")]
    Open {
        /// Its name.
        object: String,
        /// How many.
        edges: usize,
    },
    /// A body whose triangles face inwards, or that is flat.
    #[error(
        "{object:?} encloses nothing: its triangles must run counter-clockwise as seen from outside; turn them over"
    )]
    InsideOut {
        /// Its name.
        object: String,
    },
}

/// Renders `scene` on all cores, and says after each row how many of how many are done.
///
/// # Errors
/// [`WalkError`], where a setting is out of range or a body is none that light can be followed through.
pub fn render(
    scene: &Scene,
    settings: &Settings<'_>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Rendering, WalkError> {
    let &Settings { width, height, samples_per_pixel, seed, environment, boundary } = settings;
    if !(1..=LARGEST_SIDE).contains(&width) || !(1..=LARGEST_SIDE).contains(&height) {
        return Err(WalkError::Size { width, height });
    }
    if !(2..=MOST_SAMPLES).contains(&samples_per_pixel) {
        return Err(WalkError::Samples(samples_per_pixel));
    }
    let matter = matter(scene, boundary, environment)?;
    let view = View::new(&scene.camera, width, height);
    let done = AtomicU64::new(0);
    let row = |y: u32| {
        let pixel = |x: u32| {
            Pixel::new(
                &matter,
                &view,
                (x, y),
                samples_per_pixel,
                (seed, u64::from(y) * u64::from(width) + u64::from(x)),
            )
        };
        let row: Vec<Pixel> = (0..width).map(pixel).collect();
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, height.into());
        row
    };
    let rows: Vec<Vec<Pixel>> = (0..height).into_par_iter().map(row).collect();
    let pixels = || rows.iter().flatten();
    Ok(Rendering {
        linear: pixels().map(|pixel| pixel.linear(samples_per_pixel)).collect(),
        standard_error: pixels().map(|pixel| pixel.standard_error(samples_per_pixel)).collect(),
        walks: pixels().map(|pixel| u64::from(pixel.walks)).sum(),
        scatterings: pixels().map(|pixel| pixel.scatterings).sum(),
        lost: pixels().map(|pixel| u64::from(pixel.lost)).sum(),
    })
}

/// The bodies of a scene that are sound.
fn matter<'scene>(
    scene: &Scene,
    boundary: Boundary,
    environment: Option<&'scene Environment>,
) -> Result<Matter<'scene>, WalkError> {
    let point = scene.lights.iter().position(|light| matches!(light, Light::Point { .. }));
    if let Some(light) = point.filter(|_| boundary == Boundary::Dielectric) {
        return Err(WalkError::Point { light });
    }
    for object in &scene.objects {
        let (edges, name) = (open_edges(&object.mesh), || object.name.clone());
        if edges > 0 {
            return Err(WalkError::Open { object: name(), edges });
        }
        if object.mesh.volume_and_area().0 <= 0.0 {
            return Err(WalkError::InsideOut { object: name() });
        }
    }
    Matter::new(scene, boundary, environment)
        .map_err(|object| WalkError::NoMedium { object: scene.objects[object].name.clone() })
}

/// Sums over the samples of a pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    radiance: DVec3,
    squares: DVec3,
    walks: u32,
    scatterings: u64,
    lost: u32,
}

impl Pixel {
    /// `stream` names the pixel's generator by the picture's seed and the pixel's number.
    fn new(matter: &Matter<'_>, view: &View, (x, y): (u32, u32), samples: u32, stream: (u64, u64)) -> Self {
        let mut random = generator(stream.0, stream.1);
        let mut pixel = Self::default();
        let side = samples.isqrt();
        for sample in 0..samples {
            let (across, down) = (random.random::<f64>(), random.random::<f64>());
            let (across, down) = if sample < side * side {
                let cell = |index: u32, within: f64| (f64::from(index) + within) / f64::from(side);
                (cell(sample % side, across), cell(sample / side, down))
            } else {
                (across, down)
            };
            let direction = view.direction(f64::from(x) + across, f64::from(y) + down);
            let Some(hit) = matter.enter(view.eye, direction) else { continue };
            let outcome = matter.walk(view.eye, direction, hit, &mut random);
            pixel.radiance += outcome.radiance;
            pixel.squares += outcome.radiance * outcome.radiance;
            pixel.walks += 1;
            pixel.scatterings += u64::from(outcome.scatterings);
            pixel.lost += u32::from(outcome.lost);
        }
        pixel
    }

    fn linear(&self, samples: u32) -> [f32; 4] {
        let share = 1.0 / f64::from(samples);
        let [red, green, blue] = (self.radiance * share).as_vec3().to_array();
        [red, green, blue, (f64::from(self.walks) * share) as f32]
    }

    fn standard_error(&self, samples: u32) -> [f32; 3] {
        let count = f64::from(samples);
        let mean = self.radiance / count;
        // Rounding may leave a little less than nothing.
        let variance = (self.squares / count - mean * mean).max(DVec3::ZERO) / (count - 1.0);
        variance.map(f64::sqrt).as_vec3().to_array()
    }
}

#[cfg(test)]
mod tests;
