//! Texture coordinates for a mesh that has none: an atlas of charts.
//!
//! The mesh is cut into charts (`atlas/charts.rs`), each drawn as it is seen along an axis of its own, and these are
//! packed into the unit square (`atlas/packing.rs`). The scale is the same for all. What this costs is what a drawing
//! foreshortens: a triangle that leans away from its chart's axis is drawn narrower by the cosine of the angle. Charts can be
//! surrounded by what lies beside them on the mesh (`atlas/charts/halos.rs`), for what is blurred in the texture.
//!
//! Written here, since no crate serves: bindings of xatlas build C++ of their own, and the scale that charts are packed at is sought, with turned
//! boxes, which what packs boxes of given sizes (rectangle-pack, guillotiere) does not do.

use std::collections::HashMap;

use super::Mesh;

mod charts;
mod packing;

use charts::Chart;

/// The same triangles in the same order, with texture coordinates in the unit square. Vertices on the borders of charts
/// stand there once for each chart, with the same position and normal; vertices of no triangle are left out.
///
/// A triangle is drawn clockwise with v down, so that nothing is mirrored as seen from outside. To the rounding of f32 no two
/// triangles overlap. Charts are at least 8 texels apart in a texture of 1024², also where it repeats. A mesh of so many
/// charts that these gutters fill the square, more than 4096, gets no texture coordinates.
///
/// `halo` is a length in the mesh's unit, 0 for none: up to so far away along edges, each chart is surrounded by its neighbours'
/// triangles, in [`Mesh::halo`], drawn as it is. A triangle that leans too far away, or would be drawn over another, ends the halo there.
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
        }
        place
    };
    let corners = |triangle: u32, chart: usize| {
        mesh.indices[3 * triangle as usize..][..3].iter().map(move |&vertex| (vertex, chart))
    };
    let own = (0..).zip(&chart_of).flat_map(|(triangle, &chart)| corners(triangle, chart));
    let indices = own.map(|(vertex, chart)| place(vertex, chart)).collect();
    // After all others, and with the chart's own vertices where they are the same.
    let halos = charts
        .iter()
        .enumerate()
        .flat_map(|(chart, Chart { halo, .. })| halo.iter().flat_map(move |&triangle| corners(triangle, chart)));
    let halo = halos.map(|(vertex, chart)| place(vertex, chart)).collect();
    Mesh { indices, halo, ..unwrapped }
}

#[cfg(test)]
mod tests;
