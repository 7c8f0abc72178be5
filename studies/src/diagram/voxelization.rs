//! A mesh as voxels: crossings along a column, and what lies between them.

use super::plane::at;
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec2, Vec3, vec3};
use lapidary_voxelization::{VoxelizationGrid, column, kernels, local};

pub const DIAGRAM: Diagram = Diagram {
    name: "voxelization",
    module: "voxelization",
    title: "Inside and outside along a column of voxels",
    caption: "A layer of the grid through a closed mesh. Along each column, here a row, a voxel's centre is inside if \
              an odd number of crossings lie before it. Voxels that only the surface touches are filled too, faintly \
              here, so that thin parts don't vanish.",
    draw,
};

/// The grid: its voxels are a unit wide.
pub const GRID: VoxelizationGrid = VoxelizationGrid { origin: Vec3::ZERO, spacing: 1.0, cells: 16 };
/// Rows that are drawn.
pub const ROWS: u32 = 8;
/// The layer of the grid that is drawn, along z.
pub const LAYER: u32 = 8;
/// The row whose crossings are counted.
const COUNTED: u32 = 6;
/// A voxel on the sheet.
const SIDE: f64 = 40.0;

/// Returns the outline of the mesh's section, counter-clockwise: a body with a dent and an ear.
pub fn outline() -> Vec<DVec2> {
    let radius = |angle: f64| 1.0 + 0.1 * (2.0 * angle).cos() + 0.75 * (3.0 * angle - 1.53).cos();
    let turns = (0..90).map(|k| f64::from(k) * std::f64::consts::TAU / 90.0);
    turns.map(|angle| at(7.95, 4.6) + radius(angle) * at(3.8 * angle.cos(), 2.6 * angle.sin())).collect()
}

/// Returns the mesh, a prism along z: positions and indices.
pub fn prism() -> (Vec<Vec3>, Vec<u32>) {
    let outline = outline();
    let count = outline.len() as u32;
    let ring = |z: f32| outline.iter().map(move |point| point.as_vec2().extend(z));
    let mut positions: Vec<Vec3> = ring(2.0).chain(ring(14.0)).collect();
    positions.extend([vec3(7.95, 4.6, 2.0), vec3(7.95, 4.6, 14.0)]);
    let sides = (0..count).flat_map(|from| {
        let to = (from + 1) % count;
        let (low, high) = (2 * count, 2 * count + 1);
        [from, to, to + count, from, to + count, from + count, to, from, low, from + count, to + count, high]
    });
    (positions, sides.collect())
}

/// Returns the voxels of the layer, row by row: filled by their centre, or touched by the surface.
pub fn voxels() -> Vec<(u32, u32, bool)> {
    let (positions, indices) = prism();
    let numbers: Vec<f32> = positions.iter().flat_map(|position| position.to_array()).collect();
    let [centres, all] = [false, true].map(|surface| kernels::frame(GRID, &numbers, &indices, surface).matter);
    let bit = |matter: &[u32], x: u32, y: u32| {
        let row = (y + GRID.cells * LAYER) * kernels::words(GRID);
        matter[(row + x / 32) as usize] >> (x % 32) & 1 == 1
    };
    let places = (0..ROWS).flat_map(|y| (0..GRID.cells).map(move |x| (x, y)));
    places.filter(|(x, y)| bit(&all, *x, *y)).map(|(x, y)| (x, y, bit(&centres, x, y))).collect()
}

/// Returns where a column crosses the mesh, in order.
pub fn crossings(row: u32) -> Vec<f32> {
    let (positions, indices) = prism();
    let corner = |index: u32| local(GRID, positions[index as usize]);
    let place = Vec2::new(row as f32 + 0.5, LAYER as f32 + 0.5);
    let triangles = indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k| corner(corners[k])));
    let met = triangles.map(|[a, b, c]| column(a, b, c, place)).filter(|crossing| crossing.inside);
    let mut depths: Vec<f32> = met.map(|crossing| crossing.depth).collect();
    depths.sort_by(f32::total_cmp);
    depths
}

/// Where a place of the layer lies on the sheet.
fn sheet(point: DVec2) -> DVec2 {
    at(40.0 + SIDE * point.x, 16.0 + SIDE * (f64::from(ROWS) - point.y))
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 394);
    for (x, y, inside) in voxels() {
        let corner = at(f64::from(x), f64::from(y));
        let opacity = if inside { 0.34 } else { 0.13 };
        scene.cell(sheet(corner), sheet(corner + 1.0), Paint::Accent, opacity);
        scene.named(if inside { "inside" } else { "touched" });
    }
    let (wide, high) = (f64::from(GRID.cells), f64::from(ROWS));
    for x in 0..=GRID.cells {
        let x = f64::from(x);
        scene.line(&[sheet(at(x, 0.0)), sheet(at(x, high))], DIM.thin());
    }
    for y in 0..=ROWS {
        let y = f64::from(y);
        scene.line(&[sheet(at(0.0, y)), sheet(at(wide, y))], DIM.thin());
    }
    let section: Vec<DVec2> = outline().into_iter().map(sheet).collect();
    scene.outline(&section, INK);
    counted(&mut scene);
    for (x, paint, opacity, text) in
        [(110.0, Paint::Accent, 0.34, "centre inside"), (420.0, Paint::Accent, 0.13, "only touched by the surface")]
    {
        scene.cell(at(x - 34.0, 352.0), at(x - 12.0, 374.0), paint, opacity);
        scene.note(at(x, 363.0), Anchor::Start, Paint::Ink, text);
    }
    scene
}

/// The row whose crossings are counted.
fn counted(scene: &mut Scene) {
    let y = f64::from(COUNTED) + 0.5;
    let row = |x: f64| sheet(at(x, y));
    scene.arrow(&[row(-0.7), row(f64::from(GRID.cells) + 0.6)], ACCENT);
    let crossings = crossings(COUNTED);
    for x in 0..GRID.cells {
        let centre = x as f32 + 0.5;
        scene.dot(row(f64::from(centre)), 3.2, Paint::Ink);
        // The number of crossings before the voxel's centre; none beside a crossing, where the outline rises.
        let before = crossings.iter().filter(|crossing| **crossing <= centre).count();
        let paint = if before % 2 == 1 { Paint::Accent } else { Paint::Dim };
        if crossings.iter().all(|crossing| (crossing - centre).abs() > 0.8) {
            scene.note(row(f64::from(centre)) + at(0.0, -10.5), Anchor::Middle, paint, &format!("${before}$"));
        }
    }
    for crossing in crossings {
        scene.ring(row(f64::from(crossing)), 7.5, WARM.wide()).named("crossing");
    }
}
