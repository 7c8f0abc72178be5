//! Path tracing of translucent bodies: the reference image for the translucent techniques.
//!
//! Bodies are closed triangle meshes that do not overlap, each of one
//! [`Medium`](lapidary_scene::Medium). By default their surfaces neither refract nor reflect light,
//! so that a ray from the eye goes straight in. At each scattering, the light arriving from every
//! light source is attenuated by all media on its way, including other bodies and the same one
//! again. Environment light arrives along the walk's last direction, whether it was scattered before or not: thin bodies show
//! what is behind them, and surfaces that refract reflect it. Lights themselves are not seen.
//!
//! Walks start from the eye or from the lights; both give the same image in the mean.
//!
//! The eye and the lights must lie outside the bodies; a point light inside gives the right mean,
//! but its error has no bound. Behind a [dielectric boundary](Boundary::Dielectric) it is refused.

mod boundary;
mod estimate;
mod from_lights;
mod lone;
mod pass;
mod walk;

pub use boundary::Boundary;
pub use estimate::Rendering;
pub use lone::Lone;
pub use pass::Origin;

use crate::generator::generator;
use estimate::{Estimate, Sums};
use lapidary_scene::mesh_diagnosis::open_edges;
use lapidary_scene::view::View;
use lapidary_scene::{Environment, LARGEST_SIDE, Light, Scene};
use pass::{Pass, stratum};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use walk::{Beginnings, Matter, Ray};

/// Largest number of samples per pixel.
pub const MOST_SAMPLES: u32 = 1 << 20;

/// Settings of a random-walk rendering.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'environment> {
    /// Width in pixels, 1 to [`LARGEST_SIDE`].
    pub width: u32,
    /// Height in pixels, 1 to [`LARGEST_SIDE`].
    pub height: u32,
    /// Number of walks for each pixel, 2 to [`MOST_SAMPLES`]. From the eye, the largest square
    /// number of them start from the cells of a grid over the pixel, one each, and the rest
    /// anywhere in it. From the lights, all pixels' walks together start in the same way from a
    /// disc or a cone around all bodies.
    pub samples_per_pixel: u32,
    /// Starting point of walks: the eye or the lights.
    pub origin: Origin,
    /// Random seed; the same seed gives the same image on any number of threads.
    pub seed: u64,
    /// Environment light besides the scene's own lights; `None` if there is none.
    pub environment: Option<&'environment Environment>,
    /// How surfaces act on light.
    pub boundary: Boundary,
}

/// Why an image cannot be rendered.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WalkError {
    /// Width or height out of range.
    #[error("size {width}x{height} is out of range; each side must be 1 to {LARGEST_SIDE} pixels")]
    Size {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
    },
    /// Too few samples to estimate their error, or too many.
    #[error("{0} samples a pixel are out of range; take 2 to {MOST_SAMPLES}")]
    Samples(u32),
    /// A point light or spot inside a body with a dielectric boundary, to which no path is refracted
    /// once.
    #[error(
        "light {light} lies inside a body; behind a dielectric boundary it must lie outside: move it or match the boundary"
    )]
    Inside {
        /// Index among the scene's lights, from 0.
        light: usize,
    },
    /// An environment, which walks from the lights do not include.
    #[error(
        "walks from the lights follow the scene's own lights alone; leave the environment out or walk from the eye"
    )]
    Environment,
    /// A body without a medium.
    #[error(
        "{object:?} has no scattering and absorption coefficients, so that no light can be followed through it; give its material a medium"
    )]
    NoMedium {
        /// Name of the object.
        object: String,
    },
    /// A body with holes.
    #[error("{object:?} is not closed: {edges} of its edges have a triangle on one side only; close its mesh")]
    Open {
        /// Name of the object.
        object: String,
        /// Number of edges with a triangle on one side only.
        edges: usize,
    },
    /// A flat body, or one whose triangles face inwards.
    #[error(
        "{object:?} encloses nothing: its triangles must run counter-clockwise as seen from outside; turn them over"
    )]
    InsideOut {
        /// Name of the object.
        object: String,
    },
}

/// Renders `scene` on all cores; after each part, calls `progress` with the numbers of finished
/// parts and of all parts.
///
/// # Errors
/// Returns a [`WalkError`] if a setting is out of range or light cannot be followed through a body.
pub fn render(
    scene: &Scene,
    settings: &Settings<'_>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Rendering, WalkError> {
    let &Settings { width, height, samples_per_pixel, origin, seed, environment, boundary } = settings;
    if !(1..=LARGEST_SIDE).contains(&width) || !(1..=LARGEST_SIDE).contains(&height) {
        return Err(WalkError::Size { width, height });
    }
    if !(2..=MOST_SAMPLES).contains(&samples_per_pixel) {
        return Err(WalkError::Samples(samples_per_pixel));
    }
    if origin == Origin::Lights && environment.is_some() {
        return Err(WalkError::Environment);
    }
    let matter = matter(scene, boundary, environment)?;
    let view = View::new(&scene.camera, width, height);
    let lights = (&scene.lights[..], scene.bounds());
    // Walks from the other end find what connections through a refracting surface miss.
    let first = Pass { origin, beginnings: Beginnings::All, seed };
    let second = Pass { origin: origin.other(), beginnings: Beginnings::Indirect, seed: !seed };
    let passes = if matter.refracts() { vec![first, second] } else { vec![first] };
    let parts = |pass: &Pass| match pass.origin {
        Origin::Eye => height,
        Origin::Lights => from_lights::BATCHES,
    };
    // Walks from the eye tell the coverage as well.
    let is_covered = passes.iter().any(|pass| pass.origin == Origin::Eye);
    let all = passes.iter().map(parts).sum::<u32>() + if is_covered { 0 } else { height };
    let done = AtomicU64::new(0);
    let note = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, all.into());
    let samples = samples_per_pixel;
    let estimates = passes.iter().map(|&pass| match pass.origin {
        Origin::Eye => from_eye(&matter, (&view, width, height), samples, pass, &note),
        Origin::Lights => from_lights::estimate(&matter, lights, (&view, width, height), samples, pass, &note),
    });
    let mut estimate = estimates.reduce(Estimate::plus).unwrap_or_default();
    if !is_covered {
        estimate.coverage = from_lights::coverage(&matter, (&view, width, height), &note);
    }
    Ok(estimate.rendering())
}

/// Estimates the picture by walks from the eye.
fn from_eye(
    matter: &Matter<'_>,
    (view, width, height): (&View, u32, u32),
    samples: u32,
    Pass { beginnings, seed, .. }: Pass,
    note: &(dyn Fn() + Sync),
) -> Estimate {
    let row = |y: u32| {
        let pixel = |x: u32| {
            let stream = (seed, u64::from(y) * u64::from(width) + u64::from(x));
            Pixel::new(matter, view, (x, y), (samples, beginnings), stream)
        };
        let row: Vec<Pixel> = (0..width).map(pixel).collect();
        note();
        row
    };
    let rows: Vec<Vec<Pixel>> = (0..height).into_par_iter().map(row).collect();
    let pixels = || rows.iter().flatten();
    Estimate {
        radiance: pixels().map(|pixel| pixel.sums.mean(samples)).collect(),
        variance: pixels().map(|pixel| pixel.sums.variance(samples)).collect(),
        coverage: pixels().map(|pixel| (f64::from(pixel.walks) / f64::from(samples)) as f32).collect(),
        walks: pixels().map(|pixel| u64::from(pixel.walks)).sum(),
        scatterings: pixels().map(|pixel| pixel.scatterings).sum(),
        lost: pixels().map(|pixel| u64::from(pixel.lost)).sum(),
    }
}

/// Prepares the bodies of a scene for walks; returns an error if a body or light is unsuitable.
fn matter<'scene>(
    scene: &Scene,
    boundary: Boundary,
    environment: Option<&'scene Environment>,
) -> Result<Matter<'scene>, WalkError> {
    for object in &scene.objects {
        let (edges, name) = (open_edges(&object.mesh), || object.name.clone());
        if edges > 0 {
            return Err(WalkError::Open { object: name(), edges });
        }
        if object.mesh.volume_and_area().0 <= 0.0 {
            return Err(WalkError::InsideOut { object: name() });
        }
    }
    let matter = Matter::new(scene, boundary, environment)
        .map_err(|object| WalkError::NoMedium { object: scene.objects[object].name.clone() })?;
    let is_inside = |light: &Light| match light {
        Light::Directional { .. } => false,
        Light::Point { position, .. } | Light::Spot { position, .. } => matter.contains(position.as_dvec3()),
    };
    match scene.lights.iter().position(is_inside).filter(|_| matter.refracts()) {
        Some(light) => Err(WalkError::Inside { light }),
        None => Ok(matter),
    }
}

/// Sums over the samples of a pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    sums: Sums,
    walks: u32,
    scatterings: u64,
    lost: u32,
}

impl Pixel {
    /// `stream` selects the pixel's generator: the image's seed and the pixel's number.
    fn new(
        matter: &Matter<'_>,
        view: &View,
        (x, y): (u32, u32),
        (samples, beginnings): (u32, Beginnings),
        stream: (u64, u64),
    ) -> Self {
        let mut random = generator(stream.0, stream.1);
        let mut pixel = Self::default();
        for sample in 0..samples {
            let place = stratum(sample.into(), samples.into(), &mut random);
            let direction = view.direction(f64::from(x) + place.x, f64::from(y) + place.y);
            let Some(hit) = matter.enter(view.eye, direction) else { continue };
            let outcome = matter.walk(Ray { position: view.eye, direction }, hit, beginnings, &mut random);
            pixel.sums.add(outcome.radiance);
            pixel.walks += 1;
            pixel.scatterings += u64::from(outcome.scatterings);
            pixel.lost += u32::from(outcome.lost);
        }
        pixel
    }
}

#[cfg(test)]
mod tests;
