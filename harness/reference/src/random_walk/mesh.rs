//! What translucent bodies show, path-traced: the picture that the translucent techniques are compared with.
//!
//! Bodies are closed triangle meshes that do not overlap, each of one [`Medium`](lapidary_scene::Medium). Unless asked for, their surfaces do not bend
//! or reflect light, so that a ray from the eye goes straight in. At each scattering every light is asked for what arrives from it through
//! all matter on the way, also through other bodies, or the same again; light from the environment comes along the walk's last direction. What
//! shows through without being scattered is the background's and is left out.
//!
//! Walks set out from the eye, or from the lights: the same picture in the mean.
//!
//! The eye and the lights stand outside of the bodies; a point light inside gives the right mean with an error that has no bound.

mod from_lights;
mod walk;

use super::generator;
use glam::{DVec2, DVec3};
use lapidary_scene::mesh_diagnosis::open_edges;
use lapidary_scene::view::View;
use lapidary_scene::{Environment, LARGEST_SIDE, Light, Scene};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use walk::{Matter, Ray};

/// The most samples of a pixel.
pub const MOST_SAMPLES: u32 = 1 << 20;

/// What to render.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'environment> {
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub width: u32,
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub height: u32,
    /// Walks for each pixel, 2 to [`MOST_SAMPLES`]. From the eye, the largest square number of them start from the cells of a grid over the pixel,
    /// one each, the rest anywhere in it; from the lights, all pixels' walks together start so from a disc or a cone about all bodies.
    pub samples_per_pixel: u32,
    /// Where walks set out.
    pub origin: Origin,
    /// The same seed gives the same picture on any number of threads.
    pub seed: u64,
    /// The light around the scene beside its own lights, if any.
    pub environment: Option<&'environment Environment>,
    /// What surfaces do to light.
    pub boundary: Boundary,
}

/// Where walks set out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// From the eye, a number from each pixel.
    #[default]
    Eye,
    /// From the lights: less noise for the same time, the less the brighter a pixel is. For the scene's own lights alone, and where surfaces do
    /// nothing to light.
    Lights,
}

impl Origin {
    /// Every one.
    pub const ALL: [Self; 2] = [Self::Eye, Self::Lights];

    /// The field's usual name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Eye => "eye",
            Self::Lights => "lights",
        }
    }
}

/// What a body's surface does to light that meets it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// Nothing.
    #[default]
    Matched,
    /// It bends light by the material's refractive index and reflects Fresnel's share, from outside and from inside, as a polished surface does. What it
    /// mirrors of the surroundings was not scattered and is left out. Light then comes from walks that leave alone: from the environment, and from
    /// directional lights as discs of 0.1 rad about their direction, which takes very many walks. There may be no point light and no spot.
    Dielectric,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Linear radiance and coverage, row by row from the top: means over a pixel, so that what it does not cover is black.
    pub linear: Vec<[f32; 4]>,
    /// The standard error of each pixel's red, green and blue. From the eye, as of samples that know nothing of one another: since they are spread
    /// evenly over the pixel, the error is no greater, and less where a pixel is not of one brightness. From the lights, by the spread of 64 batches.
    pub standard_error: Vec<[f32; 3]>,
    /// Walks that met a body.
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
        "light {light} has no size, so that no walk through a dielectric boundary meets it; take it out or match the boundary"
    )]
    Point {
        /// Its place among the scene's lights, from 0.
        light: usize,
    },
    /// Light that walks from the lights do not bring.
    #[error(
        "walks from the lights follow the scene's own lights alone; leave the environment out or walk from the eye"
    )]
    Environment,
    /// A surface that walks from the lights do not know.
    #[error("walks from the lights find no eye behind a dielectric boundary; match the boundary or walk from the eye")]
    Dielectric,
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

/// Renders `scene` on all cores, and says after each part how many of how many are done.
///
/// # Errors
/// [`WalkError`], where a setting is out of range or a body is none that light can be followed through.
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
    if origin == Origin::Lights && boundary == Boundary::Dielectric {
        return Err(WalkError::Dielectric);
    }
    let matter = matter(scene, boundary, environment)?;
    let view = View::new(&scene.camera, width, height);
    if origin == Origin::Lights {
        return Ok(from_lights::render(&matter, (&scene.lights, scene.bounds()), &view, settings, progress));
    }
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
    let point = scene.lights.iter().position(|light| matches!(light, Light::Point { .. } | Light::Spot { .. }));
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

/// A point of the unit square for one of so many samples: the largest square number of them have a cell of a grid each, the rest lie anywhere.
fn stratum(sample: u64, samples: u64, random: &mut Xoshiro256PlusPlus) -> DVec2 {
    let place = DVec2::new(random.random(), random.random());
    let side = samples.isqrt();
    if sample >= side * side {
        return place;
    }
    (DVec2::new((sample % side) as f64, (sample / side) as f64) + place) / side as f64
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
        for sample in 0..samples {
            let place = stratum(sample.into(), samples.into(), &mut random);
            let direction = view.direction(f64::from(x) + place.x, f64::from(y) + place.y);
            let Some(hit) = matter.enter(view.eye, direction) else { continue };
            let outcome = matter.walk(Ray { position: view.eye, direction }, hit, &mut random);
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
