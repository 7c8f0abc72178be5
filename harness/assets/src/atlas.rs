//! Texture coordinates for a mesh that has none: an atlas of charts.
//!
//! The mesh is cut into charts (`atlas/charts.rs`), each projected along its own axis, and these
//! are packed into the unit square (`atlas/packing.rs`). The scale is the same for all. The cost is
//! foreshortening: a triangle that leans away from its chart's axis is narrowed by the cosine of
//! the angle. Charts can be surrounded by their neighbours on the mesh (`atlas/charts/halos.rs`),
//! for blurs in texture space.
//!
//! Written here because no crate fits: bindings of xatlas build its C++, and crates that pack boxes
//! of given sizes (rectangle-pack, guillotiere) do not search for the common scale or turn the
//! boxes.

use std::collections::HashMap;

use lapidary_scene::Mesh;

mod charts;
mod packing;

use charts::Chart;

/// Returns the same triangles in the same order, with texture coordinates in the unit square.
/// Vertices on the borders of charts are repeated once per chart, with the same position and
/// normal; vertices of no triangle are dropped.
///
/// A triangle is drawn clockwise with v down, so that nothing is mirrored as seen from outside. No
/// two triangles overlap, up to f32 rounding. Charts are at least 8 texels apart in a texture of
/// 1024², also across its edges if it repeats. A mesh with so many charts that these gutters fill
/// the square, more than 4096, gets no texture coordinates.
///
/// `halo` is a length in the mesh's unit, 0 for none. Each chart is surrounded by its neighbours'
/// triangles up to that far away along edges; they go into [`Mesh::halo`] and are drawn like the
/// chart. The halo ends at a triangle that leans too far away or would overlap another.
#[must_use]
pub fn unwrap(mesh: &Mesh, halo: f32) -> Mesh {
    let charts = charts::charts(mesh, halo.into());
    let drawings: Vec<packing::Drawing> = charts.iter().map(|chart| packing::Drawing::new(chart.drawn(mesh))).collect();
    let Some(placements) = packing::pack(&drawings) else {
        return Mesh { uvs: Vec::new(), ..mesh.clone() };
    };
    let mut chart_of = vec![0; mesh.triangle_count()];
    for (number, chart) in charts.iter().enumerate() {
        chart.triangles.iter().for_each(|&triangle| chart_of[triangle as usize] = number);
    }
    let mut unwrapped = Mesh::default();
    let mut places: HashMap<(u32, usize), u32> = HashMap::with_capacity(mesh.positions.len());
    let mut place = |vertex: u32, chart: usize| {
        let next = unwrapped.positions.len() as u32;
        let place = *places.entry((vertex, chart)).or_insert(next);
        if place == next {
            let position = mesh.positions[vertex as usize];
            let uv = placements[chart].apply(charts[chart].axis.draw(position.as_dvec3()));
            unwrapped.positions.push(position);
            unwrapped.normals.push(mesh.normals[vertex as usize]);
            unwrapped.uvs.push(uv.as_vec2());
            unwrapped.colors.extend(mesh.colors.get(vertex as usize));
        }
        place
    };
    let corners = |triangle: u32, chart: usize| {
        mesh.indices[3 * triangle as usize..][..3].iter().map(move |&vertex| (vertex, chart))
    };
    let chart_corners = (0..).zip(&chart_of).flat_map(|(triangle, &chart)| corners(triangle, chart));
    let indices = chart_corners.map(|(vertex, chart)| place(vertex, chart)).collect();
    // The halos follow all other triangles, and share the chart's vertices where they can.
    let halos = charts
        .iter()
        .enumerate()
        .flat_map(|(chart, Chart { halo, .. })| halo.iter().flat_map(move |&triangle| corners(triangle, chart)));
    let halo = halos.map(|(vertex, chart)| place(vertex, chart)).collect();
    Mesh { indices, halo, ..unwrapped }
}

#[cfg(test)]
mod tests;
