//! Charts: connected triangles that do not overlap when seen along one axis.
//!
//! Charts grow from seeds, all at once, in order of how well a triangle faces its chart's axis, as
//! in variational shape approximation (Cohen-Steiner, Alliez and Desbrun 2004). Between two
//! growths, each chart takes the mean normal of its triangles as its axis; if triangles are left
//! over, another chart starts. A chart takes no triangle that leans too far away and, in the last
//! growths, none that would overlap another, so no repair is needed later.

use glam::{DVec2, DVec3};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap, HashMap};

use lapidary_scene::normals::weld;
use lapidary_scene::{Bounds, Mesh};

mod halos;

/// Smallest cosine between a triangle's normal and its chart's axis: that of 85°. A triangle that
/// leans further is drawn too thin for texels to represent, and at 90° it turns over.
pub(super) const LEAST_COSINE: f64 = 0.087_155_742_747_658_17;

/// Number of growths between two rounds of new charts; with more the axes hardly move.
const GROWTHS: usize = 4;

/// Number of rounds in which charts start and all axes move; in any further rounds the axes stay
/// fixed.
const ROUNDS: usize = 32;

/// Largest number of squares along a body's diagonal in which triangles are looked up: a bound on
/// how many one triangle touches.
const MOST_SQUARES: f64 = 512.0;

/// A viewing direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    toward_eye: DVec3,
    right: DVec3,
    down: DVec3,
}

impl Axis {
    fn new(toward_eye: DVec3) -> Self {
        let (right, up) = toward_eye.any_orthonormal_pair();
        Self { toward_eye, right, down: -up }
    }

    /// Projects a point to its place to the right and down.
    pub(super) fn draw(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.down))
    }
}

/// Triangles of a mesh, by number, and the axis along which they are projected.
#[derive(Debug)]
pub(super) struct Chart {
    pub(super) axis: Axis,
    pub(super) triangles: Vec<u32>,
    /// Triangles of other charts that are drawn around this one.
    pub(super) halo: Vec<u32>,
}

impl Chart {
    /// Returns the chart's triangles and those of its halo, as drawn.
    pub(super) fn drawn(&self, mesh: &Mesh) -> Vec<[DVec2; 3]> {
        let corner = |index: usize| self.axis.draw(mesh.positions[mesh.indices[index] as usize].as_dvec3());
        let triangle = |&number: &u32| [0, 1, 2].map(|k| corner(3 * number as usize + k));
        self.triangles.iter().chain(&self.halo).map(triangle).collect()
    }
}

/// Start of a chart: a triangle, and the axis along which the chart is projected.
type Seed = (u32, DVec3);

/// Mesh data for growing charts.
#[derive(Debug)]
struct Surface {
    /// Corners of each triangle, relative to the middle of the mesh.
    corners: Vec<[DVec3; 3]>,
    /// Unit normal of each triangle; zero for a triangle without area.
    normals: Vec<DVec3>,
    areas: Vec<f64>,
    /// Vertices of each triangle; vertices at the same position count as one.
    vertices: Vec<[usize; 3]>,
    neighbours: Vec<Vec<u32>>,
    /// Number of the connected body that each triangle belongs to.
    bodies: Vec<u32>,
    /// Side of the squares in which triangles are looked up.
    square: f64,
}

impl Surface {
    fn of(mesh: &Mesh) -> Self {
        let bounds = Bounds::of(mesh.positions.iter().copied());
        let middle = bounds.centre().as_dvec3();
        let corners = mesh.triangles().map(|corners| corners.map(|corner| corner.as_dvec3() - middle));
        let corners: Vec<[DVec3; 3]> = corners.collect();
        let crosses = corners.iter().map(|[a, b, c]| (b - a).cross(c - a));
        let areas: Vec<f64> = crosses.clone().map(|cross| 0.5 * cross.length()).collect();
        let normals = crosses.map(DVec3::normalize_or_zero).collect();
        let (welded, _) = weld(&mesh.positions);
        let vertices = mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k| welded[corners[k] as usize]));
        let vertices: Vec<[usize; 3]> = vertices.collect();
        let neighbours = neighbours(&vertices);
        let bodies = patches(&neighbours, |_| true);
        // Twice the side of a triangle of mean size.
        let side = 2.0 * (areas.iter().sum::<f64>() / areas.len() as f64).sqrt();
        let square = side.max(2.0 * f64::from(bounds.radius()) / MOST_SQUARES).max(f64::MIN_POSITIVE);
        Self { corners, normals, areas, vertices, neighbours, bodies, square }
    }

    /// Returns a seed for growing these triangles again: the one that best faces their mean normal.
    fn seed(&self, triangles: &[u32]) -> Seed {
        let axis = self.mean_normal(triangles);
        let cosine = |triangle: u32| self.normals[triangle as usize].dot(axis);
        let nearest = triangles.iter().copied().max_by(|&a, &b| cosine(a).total_cmp(&cosine(b)));
        (nearest.unwrap_or(0), axis)
    }

    fn mean_normal(&self, triangles: &[u32]) -> DVec3 {
        let weighted =
            triangles.iter().map(|&triangle| self.areas[triangle as usize] * self.normals[triangle as usize]);
        weighted.sum::<DVec3>().normalize_or(DVec3::Y)
    }

    /// Whether a triangle leans away from the axis by no more than the limit.
    fn faces(&self, triangle: u32, axis: DVec3) -> bool {
        let normal = self.normals[triangle as usize];
        normal == DVec3::ZERO || normal.dot(axis) >= LEAST_COSINE
    }
}

/// Returns, for each triangle given by its vertices, the triangles that share an edge with it.
fn neighbours(triangles: &[[usize; 3]]) -> Vec<Vec<u32>> {
    let mut edges: Vec<([usize; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (corners, number) in triangles.iter().zip(0..) {
        for (k, l) in [(0, 1), (1, 2), (2, 0)] {
            let mut edge = [corners[k], corners[l]];
            edge.sort_unstable();
            edges.push((edge, number));
        }
    }
    edges.sort_unstable();
    let mut neighbours = vec![Vec::new(); triangles.len()];
    for pair in edges.windows(2) {
        let [(edge, a), (other, b)] = [pair[0], pair[1]];
        if edge == other && a != b {
            neighbours[a as usize].push(b);
            neighbours[b as usize].push(a);
        }
    }
    neighbours
}

/// Returns, for each `wanted` triangle, the number of its connected patch of such triangles;
/// `u32::MAX` for the others.
fn patches(neighbours: &[Vec<u32>], wanted: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut patch_of = vec![u32::MAX; neighbours.len()];
    let mut count = 0;
    for first in 0..neighbours.len() as u32 {
        let mut waiting = vec![first];
        let mut found = false;
        while let Some(triangle) = waiting.pop() {
            if patch_of[triangle as usize] == u32::MAX && wanted(triangle) {
                patch_of[triangle as usize] = count;
                found = true;
                waiting.extend(&neighbours[triangle as usize]);
            }
        }
        count += u32::from(found);
    }
    patch_of
}

/// A chart that takes no triangle that would overlap another.
#[derive(Debug)]
struct Sheet {
    axis: Axis,
    triangles: Vec<u32>,
    drawn: Vec<[DVec2; 3]>,
    /// Indices into `drawn` of the triangles that touch each square.
    squares: HashMap<[i32; 2], Vec<u32>>,
}

impl Sheet {
    fn new(toward_eye: DVec3) -> Self {
        Self { axis: Axis::new(toward_eye), triangles: Vec::new(), drawn: Vec::new(), squares: HashMap::new() }
    }

    /// Takes a triangle, unless it leans too far away or would overlap another.
    fn take(&mut self, surface: &Surface, triangle: u32) -> bool {
        if !surface.faces(triangle, self.axis.toward_eye) {
            return false;
        }
        let corners = surface.corners[triangle as usize].map(|corner| self.axis.draw(corner));
        let [a, b, c] = corners.map(|corner| (corner / surface.square).floor().as_ivec2());
        let (lower, upper) = (a.min(b).min(c), a.max(b).max(c));
        let touched = || (lower.y..=upper.y).flat_map(move |y| (lower.x..=upper.x).map(move |x| [x, y]));
        let mut near = touched().filter_map(|square| self.squares.get(&square)).flatten();
        if near.any(|&other| overlap(&corners, &self.drawn[other as usize])) {
            return false;
        }
        for square in touched() {
            self.squares.entry(square).or_default().push(self.drawn.len() as u32);
        }
        self.triangles.push(triangle);
        self.drawn.push(corners);
        true
    }
}

/// Whether the interiors of two triangles have a point in common. Both are drawn clockwise with the
/// second axis down. A triangle that only touches an edge, up to f64 rounding, does not overlap.
fn overlap(a: &[DVec2; 3], b: &[DVec2; 3]) -> bool {
    let apart = |a: &[DVec2; 3], b: &[DVec2; 3]| {
        [(0, 1), (1, 2), (2, 0)].into_iter().any(|(k, l)| {
            let along = a[l] - a[k];
            b.iter().all(|&point| {
                let across = point - a[k];
                along.perp_dot(across) >= -1e-12 * along.length() * across.length()
            })
        })
    };
    !apart(a, b) && !apart(b, a)
}

/// Cuts a mesh into charts; every triangle is in one, and in the halos of others up to `reach` away
/// along the surface.
pub(super) fn charts(mesh: &Mesh, reach: f64) -> Vec<Chart> {
    let surface = Surface::of(mesh);
    let mut seeds: Vec<Seed> = Vec::new();
    let mut left_over = vec![true; surface.areas.len()];
    // By angle alone, which is cheap, to find the axes.
    for _ in 0..ROUNDS {
        if !left_over.contains(&true) {
            break;
        }
        seeds.extend(further_seeds(&surface, &left_over));
        for _ in 0..GROWTHS {
            let grown = grow(&surface, &seeds, |chart, triangle| surface.faces(triangle, seeds[chart].1));
            left_over = in_none(&grown, left_over.len());
            seeds = grown.iter().map(|triangles| surface.seed(triangles)).collect();
        }
    }
    // This terminates: the axes stay fixed, and each round gives its own chart to a triangle left
    // over.
    loop {
        let mut sheets: Vec<Sheet> = seeds.iter().map(|&(_, axis)| Sheet::new(axis)).collect();
        let grown = grow(&surface, &seeds, |chart, triangle| sheets[chart].take(&surface, triangle));
        left_over = in_none(&grown, left_over.len());
        if !left_over.contains(&true) {
            return halos::surrounded(&surface, joined(&surface, sheets), reach);
        }
        seeds.extend(further_seeds(&surface, &left_over));
    }
}

/// Returns, for each of `count` triangles, whether it is in none of the charts.
fn in_none(charts: &[Vec<u32>], count: usize) -> Vec<bool> {
    let mut left_over = vec![true; count];
    charts.iter().flatten().for_each(|&triangle| left_over[triangle as usize] = false);
    left_over
}

/// Connected triangles that are left over.
#[derive(Debug)]
struct Patch {
    area: f64,
    largest: u32,
}

/// Returns the largest triangle, with its own axis, of each patch that is at least half as large as
/// its body's largest patch.
fn further_seeds(surface: &Surface, left_over: &[bool]) -> Vec<Seed> {
    let patch_of = patches(&surface.neighbours, |triangle| left_over[triangle as usize]);
    let mut patches: BTreeMap<u32, Patch> = BTreeMap::new();
    for (triangle, &number) in patch_of.iter().enumerate().filter(|(triangle, _)| left_over[*triangle]) {
        let patch = patches.entry(number).or_insert(Patch { area: 0.0, largest: triangle as u32 });
        patch.area += surface.areas[triangle];
        if surface.areas[triangle] > surface.areas[patch.largest as usize] {
            patch.largest = triangle as u32;
        }
    }
    let body = |patch: &Patch| surface.bodies[patch.largest as usize];
    let mut most: HashMap<u32, f64> = HashMap::new();
    for patch in patches.values() {
        let area = most.entry(body(patch)).or_default();
        *area = area.max(patch.area);
    }
    let large = patches.into_values().filter(|patch| patch.area >= 0.5 * most[&body(patch)]);
    large.map(|patch| surface.seed(&[patch.largest])).collect()
}

/// Grows a chart from each seed until none `takes` another triangle.
fn grow(surface: &Surface, seeds: &[Seed], mut takes: impl FnMut(usize, u32) -> bool) -> Vec<Vec<u32>> {
    let mut charts = vec![Vec::new(); seeds.len()];
    let mut taken = vec![false; surface.areas.len()];
    // Ties go to the first. Non-negative floats order like their bits.
    let lean = |triangle: u32, chart: usize| {
        let cosine = surface.normals[triangle as usize].dot(seeds[chart].1);
        (1.0 - cosine).max(0.0).to_bits()
    };
    let mut first = seeds.iter().enumerate().map(|(chart, &(triangle, _))| (triangle, chart));
    let mut waiting = BinaryHeap::new();
    let mut next = |waiting: &mut BinaryHeap<Reverse<(u64, u32, usize)>>| {
        first.next().or_else(|| waiting.pop().map(|Reverse((_, triangle, chart))| (triangle, chart)))
    };
    while let Some((triangle, chart)) = next(&mut waiting) {
        if taken[triangle as usize] || !takes(chart, triangle) {
            continue;
        }
        taken[triangle as usize] = true;
        charts[chart].push(triangle);
        let near = surface.neighbours[triangle as usize].iter().filter(|&&near| !taken[near as usize]);
        waiting.extend(near.map(|&near| Reverse((lean(near, chart), near, chart))));
    }
    charts
}

/// Joins charts with their neighbours, the smallest first, wherever both can be projected along one
/// axis.
fn joined(surface: &Surface, mut sheets: Vec<Sheet>) -> Vec<Sheet> {
    let mut chart_of = vec![0; surface.areas.len()];
    for (number, sheet) in sheets.iter().enumerate() {
        sheet.triangles.iter().for_each(|&triangle| chart_of[triangle as usize] = number);
    }
    let mut changed = true;
    while changed {
        changed = false;
        let mut order: Vec<usize> = (0..sheets.len()).collect();
        order.sort_by_key(|&number| sheets[number].triangles.len());
        for small in order {
            let near = sheets[small].triangles.iter().flat_map(|&triangle| &surface.neighbours[triangle as usize]);
            let near = near.map(|&triangle| chart_of[triangle as usize]).filter(|&chart| chart != small);
            let near: BTreeSet<usize> = near.collect();
            let both = |large: usize| Some((large, join(surface, &sheets[small], &sheets[large])?));
            if let Some((large, sheet)) = near.into_iter().find_map(both) {
                sheet.triangles.iter().for_each(|&triangle| chart_of[triangle as usize] = large);
                sheets[large] = sheet;
                sheets[small].triangles.clear();
                changed = true;
            }
        }
    }
    sheets.retain(|sheet| !sheet.triangles.is_empty());
    sheets
}

/// Returns both charts as one, or `None` if they cannot be joined.
fn join(surface: &Surface, small: &Sheet, large: &Sheet) -> Option<Sheet> {
    let triangles: Vec<u32> = large.triangles.iter().chain(&small.triangles).copied().collect();
    let axis = surface.mean_normal(&triangles);
    // Most fail by angle, which is quicker to check.
    let face = triangles.iter().all(|&triangle| surface.faces(triangle, axis));
    let mut sheet = Sheet::new(axis);
    (face && triangles.iter().all(|&triangle| sheet.take(surface, triangle))).then_some(sheet)
}
