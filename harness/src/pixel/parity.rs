//! A picture of the GPU against the mirrors, pixel by pixel.

use super::{Pixel, Shading, Stone, Viewer};
use crate::property::draws::Draws;
use crate::render::{Picture, RenderError, Settings, Spectrum};
use crate::scene::Scene;
use glam::Vec3;

/// How far, in pixels, a rasteriser may have put a pixel's middle beside where it is: Vulkan devices snap vertices to a grid, of
/// 1/256 pixel on lavapipe and every desktop GPU (at least 1/16 is guaranteed).
const SNAP: f64 = 1.0 / 256.0;
/// Rounding of the shading itself: the environment's sharpest light changes by 20 over an angle of 0.06, so that a direction's
/// error of 2^-20 after some bounces weighs 3e-4.
const ABSOLUTE: f32 = 3e-4;
/// And of sums and products, relative to what the pixel holds.
const RELATIVE: f32 = 1.0 / 4096.0;
/// The paper's tracker takes a difference over an epsilon of 2e-4, which knows a direction to 2^-22 / 2e-4 = 1.2e-3; times 0.344, blue's
/// share, times a path of 4, and a light's edge, 25 of its radiance a radian: 4 % of what the pixel holds.
const PAPER: f32 = 0.04;

/// What became of the pixels that were compared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parity {
    /// Pixels that show the stone in the picture and to the mirror.
    pub compared: usize,
    /// Of them, those whose rays meet other facets when the pixel is moved by 1/256.
    pub at_an_edge: usize,
    /// Of those, the ones whose value lies outside of the span of the values around.
    pub differing_at_an_edge: usize,
    /// Away from edges, and beyond the tolerance.
    pub failed: Vec<Failure>,
    /// The largest difference away from edges, in tolerances.
    pub worst: f32,
    /// Pixels of the silhouette: covered for one and not for the other.
    pub silhouette: usize,
}

/// A pixel that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Column and row.
    pub pixel: (u32, u32),
    /// The GPU's radiance.
    pub found: Vec3,
    /// The mirror's.
    pub expected: Vec3,
}

/// Compares `count` random pixels of a picture that was rendered with one sample a pixel.
pub fn compare(
    scene: &Scene,
    settings: &Settings,
    picture: &Picture,
    count: usize,
    seed: u64,
) -> Result<Parity, RenderError> {
    let viewer = Viewer::new(scene, settings.width, settings.height);
    let [object] = &scene.objects[..] else { return Ok(Parity::default()) };
    let shading = Shading::new(&object.material, settings);
    let stone = Stone::new(object, settings)?;
    let mut parity = Parity::default();
    for row in 0..count as u64 {
        let mut draws = Draws::of_row(seed, row);
        let (column, line) = (draws.below(settings.width), draws.below(settings.height));
        let [r, g, b, alpha] = picture.linear[(line * settings.width + column) as usize];
        let found = Vec3::new(r, g, b);
        let (x, y) = (f64::from(column) + 0.5, f64::from(line) + 0.5);
        let seen = viewer.see(&object.mesh, x, y);
        if seen.is_some() != (alpha == 1.0) {
            parity.silhouette += 1;
        }
        let (Some(seen), true) = (seen, alpha == 1.0) else { continue };
        parity.compared += 1;
        let middle = shading.pixel(&stone, seen, scene.camera.eye);
        let mut around = vec![middle.clone()];
        let mut edge = false;
        for (dx, dy) in [(-SNAP, -SNAP), (SNAP, -SNAP), (-SNAP, SNAP), (SNAP, SNAP)] {
            // Another triangle beside it may be what the GPU shows.
            match viewer.see(&object.mesh, x + dx, y + dy) {
                Some(other) if other.triangle == seen.triangle => {
                    around.push(shading.pixel(&stone, other, scene.camera.eye));
                }
                Some(other) => {
                    edge = true;
                    around.push(shading.pixel(&stone, other, scene.camera.eye));
                }
                None => edge = true,
            }
        }
        edge |= around.iter().any(|pixel| pixel.rays != middle.rays);
        let low = around.iter().map(|pixel: &Pixel| pixel.radiance).fold(middle.radiance, Vec3::min);
        let high = around.iter().map(|pixel: &Pixel| pixel.radiance).fold(middle.radiance, Vec3::max);
        let relative = if settings.rung.spectrum() == Spectrum::Paper { PAPER } else { RELATIVE };
        let tolerance = Vec3::splat(ABSOLUTE) + relative * high;
        let beyond = ((low - found).max(found - high) / tolerance).max_element();
        // A NaN does not hold.
        let holds = beyond <= 1.0;
        if edge {
            parity.at_an_edge += 1;
            parity.differing_at_an_edge += usize::from(!holds);
        } else if holds {
            parity.worst = parity.worst.max(beyond);
        } else {
            parity.failed.push(Failure { pixel: (column, line), found, expected: middle.radiance });
        }
    }
    Ok(parity)
}
