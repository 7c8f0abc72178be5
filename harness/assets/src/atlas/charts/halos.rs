//! Halos: the neighbourhood of each chart on the mesh, drawn around it in the same projection.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use super::chart::Chart;
use super::sheet::Sheet;
use super::surface::Surface;

/// For each vertex, the other ends of its edges and the edges' lengths.
type Edges = Vec<Vec<(usize, f64)>>;

/// Returns the charts with their halos: triangles whose corners are no more than `reach` away from
/// the chart along edges, added nearest first, from neighbour to neighbour. Triangles that lean too
/// far away or would overlap another are left out, and so are those reachable only through them.
pub(super) fn surrounded(surface: &Surface, sheets: Vec<Sheet>, reach: f64) -> Vec<Chart> {
    // A NaN means no halo, too.
    let edges = if reach > 0.0 { edges(surface) } else { Vec::new() };
    let chart = |mut sheet: Sheet| {
        let count = sheet.triangles.len();
        if reach > 0.0 {
            surround(surface, &edges, &mut sheet, reach);
        }
        let halo = sheet.triangles.split_off(count);
        Chart { axis: sheet.axis, triangles: sheet.triangles, halo }
    };
    sheets.into_iter().map(chart).collect()
}

fn edges(surface: &Surface) -> Edges {
    let count = surface.vertices.iter().flatten().max().map_or(0, |last| last + 1);
    let mut edges = vec![Vec::new(); count];
    for (vertices, corners) in surface.vertices.iter().zip(&surface.corners) {
        for (k, l) in [(0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)] {
            edges[vertices[k]].push((vertices[l], corners[k].distance(corners[l])));
        }
    }
    edges
}

/// Returns the distances along edges, up to `reach`, from vertices to the nearest of these
/// triangles.
fn distances(surface: &Surface, edges: &Edges, triangles: &[u32], reach: f64) -> HashMap<usize, f64> {
    let mut found = HashMap::new();
    // Non-negative floats order like their bits.
    let first = triangles.iter().flat_map(|&triangle| surface.vertices[triangle as usize]);
    let mut waiting: BinaryHeap<Reverse<(u64, usize)>> = first.map(|vertex| Reverse((0, vertex))).collect();
    while let Some(Reverse((distance, vertex))) = waiting.pop() {
        let distance = f64::from_bits(distance);
        if found.contains_key(&vertex) {
            continue;
        }
        found.insert(vertex, distance);
        let further = edges[vertex].iter().map(|&(next, length)| (next, distance + length));
        let further = further.filter(|(next, length)| *length <= reach && !found.contains_key(next));
        waiting.extend(further.map(|(next, length)| Reverse((length.to_bits(), next))));
    }
    found
}

/// Adds the halo's triangles to the chart's own.
fn surround(surface: &Surface, edges: &Edges, sheet: &mut Sheet, reach: f64) {
    let distances = distances(surface, edges, &sheet.triangles, reach);
    let furthest = |triangle: u32| {
        let of_corner = |vertex| distances.get(vertex).copied().unwrap_or(f64::INFINITY);
        surface.vertices[triangle as usize].iter().map(of_corner).fold(0.0, f64::max)
    };
    let mut seen = vec![false; surface.areas.len()];
    sheet.triangles.iter().for_each(|&triangle| seen[triangle as usize] = true);
    let mut waiting = BinaryHeap::new();
    let mut spread = |waiting: &mut BinaryHeap<Reverse<(u64, u32)>>, triangle: u32| {
        for &near in &surface.neighbours[triangle as usize] {
            let distance = furthest(near);
            if !std::mem::replace(&mut seen[near as usize], true) && distance <= reach {
                waiting.push(Reverse((distance.to_bits(), near)));
            }
        }
    };
    sheet.triangles.iter().for_each(|&triangle| spread(&mut waiting, triangle));
    while let Some(Reverse((_, triangle))) = waiting.pop() {
        if sheet.take(surface, triangle) {
            spread(&mut waiting, triangle);
        }
    }
}
