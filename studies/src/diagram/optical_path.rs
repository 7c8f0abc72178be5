//! The path of least optical depth through a body with a dense vein, voxel by voxel.

use super::plane::at;
use super::scene::{ACCENT, Anchor, Paint, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, IVec3};
use lapidary_optical_path::kernels::{Body, pull, seeded};
use lapidary_optical_path::{edge, luminance, seed};

pub const DIAGRAM: Diagram = Diagram {
    name: "optical_path",
    module: "optical_path",
    title: "Paths of least optical depth through a body",
    caption: "Light enters where the surface is lit, and each voxel is as bright as the path of least optical depth \
              lets it be: the stronger the colour, the more light. Paths go round the dense vein if that costs less \
              than to cross it. A single layer of voxels, with paths along the edges between neighbours.",
    draw,
};

/// Voxels along an edge of the grid, and how many rows of them are drawn.
pub const CELLS: u32 = 34;
const ROWS: u32 = 19;
/// The layer with matter.
const LAYER: u32 = 17;
/// A voxel on the sheet.
const SIDE: f64 = 20.0;
/// Towards the light.
const LIGHT: DVec2 = at(-0.6, 0.8);
/// Where paths are followed back from.
pub const TARGETS: [(u32, u32); 3] = [(29, 12), (22, 3), (13, 3)];

/// Below 0 inside the body.
fn body(point: DVec2) -> f64 {
    let way = (point - at(17.0, 9.4)) / at(14.6, 8.0);
    let angle = way.to_angle();
    way.length() - (1.0 - 0.1 * (2.0 * angle).cos() + 0.12 * (3.0 * angle - 1.2).cos())
}

/// Whether a point lies in the vein.
fn is_vein(point: DVec2) -> bool {
    let along = at(0.86, 0.5);
    let way = point - at(17.0, 9.6);
    let bend = 0.022 * way.dot(along).powi(2);
    (way.perp_dot(along) + bend - 1.0).abs() < 1.05 && way.dot(along).abs() < 9.5
}

/// The solved layer.
pub struct Solved {
    /// Whether a voxel holds matter.
    pub matter: Vec<bool>,
    /// Its extinction, for a voxel's edge of 1.
    pub extinction: Vec<f32>,
    /// The cost at which light enters it, or unreached.
    pub seeds: Vec<f32>,
    /// Its cost.
    pub costs: Vec<f32>,
}

impl Solved {
    /// The body for the module's kernels.
    pub fn body(&self) -> Body<'_> {
        Body { cells: CELLS, spacing: 1.0, matter: &self.matter, extinction: &self.extinction }
    }

    /// Returns the way from a voxel to where the light enters: each time to the neighbour that the cost came from.
    pub fn path(&self, from: (u32, u32)) -> Vec<IVec3> {
        let body = self.body();
        let mut node = (from.0 + CELLS * (from.1 + CELLS * LAYER)) as usize;
        let mut path = vec![body.voxel(node)];
        while self.costs[node] < self.seeds[node] {
            let through = |(next, length): (usize, f32)| {
                (next, self.costs[next] + edge(self.extinction[node], self.extinction[next], length))
            };
            let offers = body.neighbours(node, 26).map(through);
            let Some((next, cost)) = offers.min_by(|one, other| one.1.total_cmp(&other.1)) else { break };
            if cost > self.costs[node] + 1e-4 {
                break;
            }
            node = next;
            path.push(body.voxel(node));
        }
        path
    }
}

/// Solves the layer by the module's pass until nothing changes.
pub fn solve() -> Solved {
    let places = (0..CELLS * CELLS * CELLS).map(|index| (index % CELLS, index / CELLS % CELLS, index / CELLS / CELLS));
    let middle = |x: u32, y: u32| at(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let cells: Vec<(DVec2, bool)> =
        places.map(|(x, y, z)| (middle(x, y), z == LAYER && body(middle(x, y)) < 0.0)).collect();
    let matter: Vec<bool> = cells.iter().map(|cell| cell.1).collect();
    let extinction = cells.iter().map(|(point, _)| if is_vein(*point) { 2.2 } else { 0.13 }).collect::<Vec<f32>>();
    let seeds = cells.iter().zip(&extinction).map(|((point, _), extinction)| seed(lit(*point), *extinction, 0.5));
    let seeds: Vec<f32> = seeds.collect();
    let mut solved = Solved { matter, extinction, seeds, costs: Vec::new() };
    let mut costs = seeded(&solved.body(), &solved.seeds);
    loop {
        let next = pull(&solved.body(), 26, &costs);
        if next == costs {
            break;
        }
        costs = next;
    }
    solved.costs = costs;
    solved
}

/// Returns N·L at a voxel on the surface that the light sees; 0 elsewhere.
fn lit(point: DVec2) -> f32 {
    let is_lit = body(point) < 0.0 && (1..40).all(|k| body(point + f64::from(k) * 0.5 * LIGHT) > 0.0 || k < 3);
    let step = 1e-3;
    let slope = |way: DVec2| body(point + step * way) - body(point - step * way);
    let normal = at(slope(DVec2::X), slope(DVec2::Y)).normalize();
    if is_lit { normal.dot(LIGHT).max(0.0) as f32 } else { 0.0 }
}

fn sheet(x: f64, y: f64) -> DVec2 {
    at(20.0 + SIDE * x, 26.0 + SIDE * (f64::from(ROWS) - y))
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 416);
    let solved = solve();
    for (x, y) in (0..ROWS).flat_map(|y| (0..CELLS).map(move |x| (x, y))) {
        let index = (x + CELLS * (y + CELLS * LAYER)) as usize;
        if !solved.matter[index] {
            continue;
        }
        let corner = (f64::from(x), f64::from(y));
        let light = f64::from(luminance(solved.costs[index]));
        let opacity = 0.06 + 0.7 * (light * 14.0).round() / 14.0;
        let (one, other) = (sheet(corner.0 + 0.04, corner.1 + 0.04), sheet(corner.0 + 0.96, corner.1 + 0.96));
        scene.cell(one, other, Paint::Accent, opacity).named("voxel");
        if solved.extinction[index] > 1.0 {
            scene.cell(one, other, Paint::Second, 0.45);
        }
    }
    for target in TARGETS {
        path(&mut scene, &solved, target);
    }
    light(&mut scene);
    scene
}

/// The path to a voxel, with the arrow's tip there.
fn path(scene: &mut Scene, solved: &Solved, target: (u32, u32)) {
    let mut path = solved.path(target);
    path.reverse();
    let points: Vec<DVec2> =
        path.iter().map(|voxel| sheet(f64::from(voxel.x) + 0.5, f64::from(voxel.y) + 0.5)).collect();
    scene.dot(points[0], 5.0, Paint::Warm);
    scene.arrow(&points, WARM.wide()).named("path");
}

fn light(scene: &mut Scene) {
    for start in [at(30.0, 92.0), at(84.0, 50.0), at(138.0, 8.0)] {
        scene.arrow(&[start, start + 62.0 * at(-LIGHT.x, LIGHT.y)], ACCENT);
    }
    scene.note(at(20.0, 60.0), Anchor::Start, Paint::Accent, "light");
    scene.cell(at(508.0, 16.0), at(530.0, 38.0), Paint::Second, 0.45);
    scene.note(at(542.0, 27.0), Anchor::Start, Paint::Ink, "dense vein");
    scene.line(&[at(506.0, 58.0), at(532.0, 58.0)], WARM.wide());
    scene.note(at(542.0, 58.0), Anchor::Start, Paint::Ink, "least cost");
    scene.note(at(20.0, 396.0), Anchor::Start, Paint::Ink, "$T$ = min Σ $σℓ$");
}
