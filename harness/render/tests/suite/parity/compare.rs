//! Compares a picture of the GPU with the mirrors, pixel by pixel.

use glam::{DMat4, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use lapidary_plan::Spectrum;
use lapidary_render::pixel::{Pixel, Shading, Stone, SurfacePoint, Viewer};
use lapidary_render::{Picture, RenderError, Settings};
use lapidary_scene::{Bounds, Place, Scene};

/// Largest distance in pixels between a pixel's centre and the point that a rasteriser samples.
/// Vulkan devices snap vertices to a grid: of 1/256 pixel on lavapipe and every desktop GPU (at
/// least 1/16 is guaranteed).
pub const SNAP: f64 = 1.0 / 256.0;
/// Drift of a ray at each hit, relative to the stone's size, if it starts at the GPU's point. A
/// plane's two products, the distance's quotient and the point's product and sum are five roundings
/// of 2^-24. Roundings add up as a square root, within a hit and from one hit to the next.
const DRIFT: f32 = 2.5 / 16_777_216.0;
/// Absolute rounding error of the shading. The environment's sharpest light changes by 20 over an
/// angle of 0.06, so a direction's error of 2^-20 after several bounces contributes 3e-4.
const ABSOLUTE: f32 = 3e-4;
/// Rounding error of sums and products, relative to the pixel's value.
const RELATIVE: f32 = 1.0 / 4096.0;
/// Relative error of the paper's tracker. It divides a difference by an epsilon of 2e-4, so a
/// direction is known to 2^-22 / 2e-4 = 1.2e-3. Times 0.344 (blue's share), a path of 4 and a
/// light's edge (25 of its radiance per radian), that is 4 % of the pixel's value.
const PAPER: f32 = 0.04;

/// Outcome of a comparison of pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parity {
    /// Number of pixels that show the stone in the picture and in the mirror.
    pub compared: usize,
    /// Number of compared pixels with an edge of the mesh within [`SNAP`] of their centre. The GPU
    /// may show either side.
    pub at_an_edge: usize,
    /// Share of the pixels that the mesh's edges can touch: their length in the picture times the
    /// widest band about them, over the covered area.
    pub edge_share: f64,
    /// Number of pixels away from the mesh's edges whose rays, moved by rounding, meet other facets
    /// inside and show another value.
    pub parting: usize,
    /// Number of pixels of both kinds with a value outside the span of the values around.
    pub differing_at_an_edge: usize,
    /// Other pixels beyond the tolerance.
    pub failed: Vec<Failure>,
    /// Largest difference of the pixels within the tolerance, in tolerances.
    pub worst: f32,
    /// Number of silhouette pixels, covered in the picture or in the mirror but not in both.
    pub silhouette: usize,
    /// Largest distance in pixels between a pixel's centre and the GPU's point of the surface, away
    /// from the mesh's edges.
    pub misplaced: f64,
}

/// Pixel that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Column and row.
    pub pixel: (u32, u32),
    /// The GPU's radiance.
    pub found: Vec3,
    /// The mirror's radiance.
    pub expected: Vec3,
}

/// Compares `count` random pixels of a picture with one sample per pixel. The mirror starts at the
/// GPU's points of the surface. `positions` is another picture that holds them in place of
/// radiance. Only rounding then separates a ray from its mirror.
///
/// # Errors
/// Fails if the rung does not apply to the scene's stone.
pub fn compare(
    scene: &Scene,
    settings: &Settings,
    [picture, positions]: [&Picture; 2],
    count: usize,
    seed: u64,
) -> Result<Parity, RenderError> {
    let viewer = Viewer::new(scene, settings.width, settings.height);
    // Other bodies are met by what leaves the stone, but not seen.
    let Some(object) = scene.objects.first() else { return Ok(Parity::default()) };
    // A copy is shaded in its own space.
    let place = object.copies.as_ref().map_or(Place::IDENTITY, |copies| copies.places[0]);
    let shading = match object.copies {
        Some(_) => Shading::of_copy(&object.material, &place, settings),
        None => Shading::new(&object.material, settings),
    };
    let shading = shading.among(object, scene);
    let (to_world, to_stone) = (place.transform(), place.transform().inverse());
    let moved_by = |transform: DMat4, point: Vec3| transform.transform_point3(point.as_dvec3()).as_vec3();
    let stone = Stone::new(object, settings)?;
    let eye = scene.camera.eye;
    let bounds = Bounds::of(object.mesh.positions.iter().copied());
    let size = bounds.min.abs().max(bounds.max.abs()).max_element();
    let drift = DRIFT * size / place.scale * ((1 + settings.rung.hits()) as f32).sqrt();
    let covered = picture.linear.iter().filter(|pixel| pixel[3] == 1.0).count();
    // A square of side 2 SNAP meets a line within a band about the line. The band is widest, by a
    // factor of root 2, if the line runs along the square's diagonal.
    let band = 2.0 * SNAP * 2f64.sqrt();
    let edge_share = band * viewer.edge_length(&object.mesh) / covered as f64;
    let mut parity = Parity { edge_share, ..Parity::default() };
    for row in 0..count as u64 {
        let mut draws = Draws::of_row(seed, row);
        let (column, line) = (draws.below(settings.width), draws.below(settings.height));
        let index = (line * settings.width + column) as usize;
        let [r, g, b, alpha] = picture.linear[index];
        let found = Vec3::new(r, g, b);
        let (x, y) = (f64::from(column) + 0.5, f64::from(line) + 0.5);
        let seen = viewer.see(&object.mesh, x, y);
        if seen.is_some() != (alpha == 1.0) {
            parity.silhouette += 1;
        }
        let (Some(seen), true) = (seen, alpha == 1.0) else { continue };
        parity.compared += 1;
        let corners = [(-SNAP, -SNAP), (SNAP, -SNAP), (-SNAP, SNAP), (SNAP, SNAP)];
        let beside = corners.map(|(dx, dy)| viewer.see(&object.mesh, x + dx, y + dy));
        // The GPU may show a neighbouring triangle instead.
        let at_an_edge = beside.iter().any(|other| other.is_none_or(|other| other.triangle != seen.triangle));
        let [own_x, own_y, own_z, _] = positions.linear[index];
        let in_stone = |seen: SurfacePoint| SurfacePoint { position: moved_by(to_stone, seen.position), ..seen };
        let shown = SurfacePoint { position: Vec3::new(own_x, own_y, own_z), ..seen };
        let points = if at_an_edge {
            [Some(seen)].into_iter().chain(beside).flatten().map(in_stone).collect::<Vec<_>>()
        } else {
            let place = viewer.place(moved_by(to_world, shown.position));
            // A NaN counts as far away.
            parity.misplaced = larger(parity.misplaced, (place.x - x).abs());
            parity.misplaced = larger(parity.misplaced, (place.y - y).abs());
            let (right, up) = (shown.position - moved_by(to_stone, eye)).normalize().any_orthonormal_pair();
            let moved = [right + up, right - up, up - right, -right - up];
            let points = moved.map(|by| SurfacePoint { position: shown.position + drift * by, ..shown });
            [shown].into_iter().chain(points).collect()
        };
        let around: Vec<Pixel> = points.into_iter().map(|point| shading.pixel(&stone, point, eye)).collect();
        let low = around.iter().map(|pixel| pixel.radiance).fold(Vec3::INFINITY, Vec3::min);
        let high = around.iter().map(|pixel| pixel.radiance).fold(Vec3::NEG_INFINITY, Vec3::max);
        let relative = if settings.rung.spectrum() == Spectrum::Paper { PAPER } else { RELATIVE };
        let tolerance = Vec3::splat(ABSOLUTE) + relative * high;
        // If the parting of the rays is not visible, the pixel is compared as if they had not
        // parted.
        let parts = around.iter().any(|pixel| pixel.rays != around[0].rays) && (high - low).cmpgt(tolerance).any();
        let beyond = ((low - found).max(found - high) / tolerance).to_array().into_iter().fold(f32::MIN, larger);
        // A NaN fails.
        let holds = beyond <= 1.0;
        if at_an_edge || parts {
            parity.at_an_edge += usize::from(at_an_edge);
            parity.parting += usize::from(!at_an_edge);
            parity.differing_at_an_edge += usize::from(!holds);
        } else if holds {
            parity.worst = larger(parity.worst, beyond);
        } else {
            parity.failed.push(Failure { pixel: (column, line), found, expected: around[0].radiance });
        }
    }
    Ok(parity)
}
