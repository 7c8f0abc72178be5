//! Charts: connected triangles that do not overlap when seen along one axis.
//!
//! Charts grow from seeds, all at once, in order of how well a triangle faces its chart's axis, as
//! in variational shape approximation (Cohen-Steiner, Alliez and Desbrun 2004). Between two
//! growths, each chart takes the mean normal of its triangles as its axis; if triangles are left
//! over, another chart starts. A chart takes no triangle that leans too far away and, in the last
//! growths, none that would overlap another, so no repair is needed later.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap, HashMap};

use lapidary_scene::Mesh;
use sheet::Sheet;
use surface::{Seed, Surface, patches};

mod chart;
mod halos;
mod sheet;
pub(super) mod surface;

pub(super) use chart::Chart;

/// Number of growths between two rounds of new charts; with more the axes hardly move.
const GROWTHS: usize = 4;

/// Number of rounds in which charts start and all axes move; in any further rounds the axes stay
/// fixed.
const ROUNDS: usize = 32;

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
