//! The views, and the errors of a rung's costs in them, pixel by pixel.

use super::measured::Measured;
use super::rungs::FINEST;
use crate::error::CostError;
use glam::{DVec3, Vec3};
use lapidary_gpu::Gpu;
use lapidary_optical_path::oracle;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{Picture, RenderError, Settings};
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Light, Material, Medium, Object, Scene, SceneError};
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_PI, PI};

/// Names of the views: a ball with a radius of eight optical depths, lit from the side; the bunny;
/// the dragon, whose density varies; wax; and thin marble.
pub const VIEWS: [&str; 5] = [BALL, "bunny", "dragon", "wax_bunny", "figure"];
/// The views in which costs are compared with the closed form or the finest grid.
pub const COMPARED: [&str; 3] = [BALL, "bunny", "dragon"];
/// The views with a committed picture by random walks.
pub const WALKED: [&str; 4] = ["bunny", "dragon", "wax_bunny", "figure"];
/// The view that has a closed form.
pub const BALL: &str = "ball";
/// Width and height of a compared picture in pixels.
pub(super) const SIDE: u32 = 512;
/// Radius of the ball, such that a voxel's edge is 1 with 64 cells: the paper's solver assumes this
/// length for every edge.
const RADIUS: f64 = 31.0;
/// Optical depths along the radius.
const DEPTH: f64 = 8.0;
/// Columns of the ball's mesh: flat triangles lie up to (π / 256)² / 2 of the radius inside the
/// sphere, 6e-4 optical depths.
const COLUMNS: u32 = 256;
/// Fraction of the radius within which pixels are compared; closer to the silhouette they show the
/// mesh's outline.
const INSIDE: f64 = 0.99;
/// Number of angles at which the exact cost is computed; it is interpolated between them.
const ANGLES: u32 = 4096;
/// Largest true cost in nats that is compared: beyond it no light is visible.
pub(super) const DEEPEST: f64 = 12.0;
/// Upper limit of a rung's cost in nats, which is also the cost of a black pixel.
pub(super) const BLACK: f64 = 24.0;

/// A scene with one extinction, and the expected cost of each pixel.
pub(super) struct View {
    name: &'static str,
    scene: Scene,
    /// Expected costs; `None` for a pixel that is not compared.
    truth: Vec<Option<f64>>,
    /// The rung that computed the truth; `None` if no rung did.
    maker: Option<Rung>,
}

impl View {
    pub(super) fn new(gpu: &Gpu, name: &'static str) -> Result<Self, CostError> {
        let scene = grey(scene(name)?);
        if name == BALL {
            let truth = exact(&scene);
            return Ok(Self { name, scene, truth, maker: None });
        }
        let maker = FINEST.parse().ok().filter(|_| COMPARED.contains(&name));
        let mut view = Self { name, scene, truth: Vec::new(), maker };
        view.truth = maker.map(|rung| view.costs(gpu, rung)).transpose()?.unwrap_or_default();
        Ok(view)
    }

    /// Returns the errors except those against random walks. The rung that computed the truth has
    /// none; nor has a rung whose extinction differs from the truth's.
    pub(super) fn distance(&self, gpu: &Gpu, Measured { rung, unscaled }: Measured) -> Result<Errors, CostError> {
        if self.maker == Some(rung) || self.truth.is_empty() || unscaled && self.name != BALL {
            return Ok([None; 2]);
        }
        Ok(between(&self.costs(gpu, rung)?, &self.truth))
    }

    fn costs(&self, gpu: &Gpu, rung: Rung) -> Result<Vec<Option<f64>>, RenderError> {
        let settings = settings(self.name, Measured { rung, unscaled: false }, [SIDE; 2]);
        Ok(costs(&self.scene, &render::render(gpu, &self.scene, &settings)?))
    }
}

/// Returns settings for one sample per pixel, lit by the scene's lights alone, without reflections.
/// The ball has the extinction of its closed form.
pub(crate) fn settings(view: &str, Measured { rung, unscaled }: Measured, [width, height]: [u32; 2]) -> Settings {
    Settings {
        rung,
        samples: 1,
        optical_path: render::OpticalPathOptions {
            extinction_scale: if unscaled || view == BALL { 1.0 } else { render::EXTINCTION_SCALE },
        },
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        ..Settings::of_size(width, height)
    }
}

/// Returns the scene of a view in its own colours.
pub(super) fn scene(view: &str) -> Result<Scene, SceneError> {
    if view == BALL { ball() } else { Scene::named(view) }
}

/// Returns the scene in white, with the green channel's extinction for all channels.
pub(super) fn grey(mut scene: Scene) -> Scene {
    for object in &mut scene.objects {
        object.material.base_color = Vec3::ONE;
        if let Some(medium) = &mut object.material.medium {
            medium.scattering = Vec3::splat(medium.scattering.y);
            medium.absorption = Vec3::splat(medium.absorption.y);
        }
    }
    scene
}

/// Returns the ball under parallel light from the right, seen at right angles to the light.
fn ball() -> Result<Scene, SceneError> {
    let mut scene = Scene::named("bunny")?;
    let medium = Medium::isotropic(Vec3::splat((DEPTH / RADIUS) as f32), Vec3::ZERO);
    let material = Material { base_color: Vec3::ONE, medium: Some(medium), ..scene.objects[0].material.clone() };
    scene.objects = vec![Object::new(BALL, sphere(RADIUS, COLUMNS), material)];
    scene.lights = vec![Light::Directional { toward: Vec3::X, irradiance: Vec3::ONE }];
    Ok(scene.seen_from(90.0, 0.0))
}

/// Returns the ball's exact costs in closed form, where a ray through the pixel's centre meets the
/// sphere.
fn exact(scene: &Scene) -> Vec<Option<f64>> {
    let by_angle: Vec<f64> = (0..=ANGLES)
        .into_par_iter()
        .map(|step| oracle::ball(DEPTH, DEPTH, PI * f64::from(step) / f64::from(ANGLES)))
        .collect();
    let cost = |angle: f64| {
        let place = (angle / PI).clamp(0.0, 1.0) * f64::from(ANGLES);
        let lower = (place.floor() as usize).min(ANGLES as usize - 1);
        by_angle[lower] + (place - lower as f64) * (by_angle[lower + 1] - by_angle[lower])
    };
    let world_from_clip = lapidary_scene::clip_from_world(scene, SIDE, SIDE).as_dmat4().inverse();
    let eye = scene.camera.eye.as_dvec3();
    let of_pixel = |index: u32| {
        let clip = |pixel: u32| 2.0 * (f64::from(pixel) + 0.5) / f64::from(SIDE) - 1.0;
        let far = world_from_clip.project_point3(DVec3::new(clip(index % SIDE), -clip(index / SIDE), 1.0));
        let direction = (far - eye).normalize();
        let (along, beside) = (-eye.dot(direction), eye.cross(direction).length());
        (beside < INSIDE * RADIUS).then(|| {
            let place = eye + (along - (RADIUS * RADIUS - beside * beside).sqrt()) * direction;
            cost(place.angle_between(DVec3::X))
        })
    };
    (0..SIDE * SIDE).map(of_pixel).collect()
}

/// Returns the cost of each pixel that a body covers, for a white scene lit by one sun.
fn costs(scene: &Scene, picture: &Picture) -> Vec<Option<f64>> {
    let irradiance = scene.lights.iter().find_map(|light| match light {
        Light::Directional { irradiance, .. } => Some(f64::from(irradiance.x)),
        _ => None,
    });
    let largest = FRAC_1_PI * irradiance.unwrap_or(1.0);
    let cost = |pixel: &[f32; 4]| (pixel[3] == 1.0).then(|| (-(f64::from(pixel[0]) / largest).ln()).min(BLACK));
    picture.linear.iter().map(cost).collect()
}

/// RMS errors of the costs in nats, and of luminance, e to the minus cost, relative to the brightest
/// possible; `None` if no costs are compared.
type Errors = [Option<f64>; 2];

/// Returns the errors over the pixels with visible light.
fn between(found: &[Option<f64>], truth: &[Option<f64>]) -> Errors {
    let (mut nats, mut luminance, mut count) = (0.0, 0.0, 0u32);
    for (found, truth) in found.iter().zip(truth).filter_map(|(found, truth)| (*found).zip(*truth)) {
        if truth < DEEPEST {
            nats += (found - truth).powi(2);
            luminance += ((-found).exp() - (-truth).exp()).powi(2);
            count += 1;
        }
    }
    let mean = |sum: f64| (count > 0).then(|| (sum / f64::from(count)).sqrt());
    [mean(nats), mean(luminance)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_assay::extremum::larger;
    use lapidary_gpu::AdapterChoice;

    #[test]
    fn black_and_the_unseen_count_as_they_should() {
        let truth = [Some(0.0), Some(DEEPEST), None, Some(1.0)];
        let found = between(&[Some(1.0), Some(0.0), Some(0.0), Some(1.0)], &truth);
        let half = 0.5f64.sqrt();
        let [nats, luminance] = found.map(|error| error.expect("seen"));
        assert!((nats - half).abs() < 1e-12 && (luminance - half * (1.0 - (-1f64).exp())).abs() < 1e-12);
        assert_eq!(between(&[None; 4], &truth), [None; 2]);
    }

    /// On its lit side the ball's costs match Lambert's law pixel by pixel except near the
    /// terminator: the pixels' angles are right.
    #[test]
    fn the_balls_bright_side_is_lamberts() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let view = View::new(gpu, BALL).expect("made");
        let lambert = view.costs(gpu, "lambert".parse().expect("a rung")).expect("rendered");
        let (mut bright, mut dark, mut worst) = (0, 0, 0.0f64);
        for (found, truth) in lambert.iter().zip(&view.truth) {
            let Some((found, truth)) = (*found).zip(*truth) else { continue };
            if truth < 0.7 {
                bright += 1;
                worst = larger(worst, (found - truth).abs());
            }
            dark += usize::from(found == BLACK && truth > 3.0);
        }
        println!("{bright} bright pixels, off by {worst:.1e} nats at most; {dark} dark ones");
        // The bright part is a sixth of the visible disc, the dark part almost half of it.
        let seen = view.truth.iter().flatten().count();
        assert!(seen > 80_000 && bright > seen / 8 && dark > 2 * seen / 5, "{bright} and {dark} of {seen}");
        // Within a flat triangle the interpolated normal is that of a point up to (2π / 256)² / 8
        // of the radius away; the error is this times the slope of the cost.
        assert!(worst < 1e-3, "{worst}");
    }
}
