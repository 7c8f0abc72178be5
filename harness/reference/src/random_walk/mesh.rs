//! Path tracing of translucent bodies: the reference image for the translucent techniques.
//!
//! Bodies are closed triangle meshes that do not overlap, each of one
//! [`Medium`](lapidary_scene::Medium). By default their surfaces neither refract nor reflect light,
//! so that a ray from the eye goes straight in. At each scattering, the light arriving from every
//! light source is attenuated by all media on its way, including other bodies and the same one
//! again. Environment light arrives along the walk's last direction. Light that shows through
//! without being scattered belongs to the background and is left out.
//!
//! Walks start from the eye or from the lights; both give the same image in the mean.
//!
//! The eye and the lights must lie outside the bodies; a point light inside gives the right mean,
//! but its error has no bound.

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

/// Starting point of walks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// From the eye, with a number of walks for each pixel.
    #[default]
    Eye,
    /// From the lights: less noise for the same time, least in the brightest pixels. Only for the
    /// scene's own lights, and only with matched boundaries.
    Lights,
}

impl Origin {
    /// All origins.
    pub const ALL: [Self; 2] = [Self::Eye, Self::Lights];

    /// Returns the usual name in the field.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Eye => "eye",
            Self::Lights => "lights",
        }
    }
}

/// How a body's surface acts on light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// Light passes unchanged.
    #[default]
    Matched,
    /// Light is refracted by the material's refractive index and reflected by the Fresnel
    /// reflectance, from outside and from inside, as at a polished surface. Mirror reflections of
    /// the surroundings were not scattered and are left out.
    ///
    /// Light is then found only by walks that leave the bodies: from the environment, and from
    /// directional lights as discs of radius 0.1 rad around their direction, which takes very many
    /// walks. Point lights and spots are not allowed.
    Dielectric,
}

/// A rendered image.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Linear radiance and coverage, row by row from the top: means over a pixel, so that its
    /// uncovered part counts as black.
    pub linear: Vec<[f32; 4]>,
    /// Standard error of each pixel's red, green and blue.
    ///
    /// From the eye, it is computed as for independent samples. Since they are spread evenly over
    /// the pixel, the true error is no greater, and less where the pixel's brightness varies. From
    /// the lights, it is computed from the spread of 64 batches.
    pub standard_error: Vec<[f32; 3]>,
    /// Number of walks that met a body.
    pub walks: u64,
    /// Number of scatterings of all walks together.
    pub scatterings: u64,
    /// Number of walks that slipped through a surface by rounding and were followed no further.
    pub lost: u64,
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
    /// A point light or spot, which no walk through a dielectric boundary would meet.
    #[error(
        "light {light} has no size, so that no walk through a dielectric boundary meets it; take it out or match the boundary"
    )]
    Point {
        /// Index among the scene's lights, from 0.
        light: usize,
    },
    /// An environment, which walks from the lights do not include.
    #[error(
        "walks from the lights follow the scene's own lights alone; leave the environment out or walk from the eye"
    )]
    Environment,
    /// A dielectric boundary, behind which walks from the lights find no eye.
    #[error("walks from the lights find no eye behind a dielectric boundary; match the boundary or walk from the eye")]
    Dielectric,
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

/// Prepares the bodies of a scene for walks; returns an error if a body or light is unsuitable.
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

/// Samples a point of the unit square for one of `samples` samples: the largest square number of
/// them get one cell of a grid each, the rest lie anywhere.
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
    /// `stream` selects the pixel's generator: the image's seed and the pixel's number.
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
        // Rounding may make the difference slightly negative.
        let variance = (self.squares / count - mean * mean).max(DVec3::ZERO) / (count - 1.0);
        variance.map(f64::sqrt).as_vec3().to_array()
    }
}

#[cfg(test)]
mod tests;
