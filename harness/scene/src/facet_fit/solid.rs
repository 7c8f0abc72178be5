//! The solid between planes, as the hull of the points that are dual to them: n / d for the plane n · x = d.

use std::collections::HashMap;

use glam::{DMat3, DVec3};

use crate::hull::Hull;
use crate::normals::Averaging;
use crate::polyhedron::Plane;
use crate::{Bounds, Mesh};

/// Returns the surface of the solid between planes about the origin, which lies within it, moved by `centre`; `None` if they enclose
/// nothing. Planes that bound no facet are passed over.
///
/// The hull is exact, so that the surface is closed even where many planes nearly meet in a point. Corners nearer one another than
/// f32 rounds are one.
pub(super) fn between(planes: &[Plane], centre: DVec3) -> Option<Mesh> {
    let dual: Vec<_> = planes.iter().map(|plane| (plane.normal / plane.distance).as_vec3()).collect();
    if planes.iter().any(|plane| plane.distance <= 0.0) {
        return None;
    }
    let hull = Hull::of(&dual)?;
    let corner = |three: &[usize; 3]| {
        let [a, b, c] = three.map(|number| &planes[number]);
        let rows = DMat3::from_cols(a.normal, b.normal, c.normal).transpose();
        Some(rows.inverse() * DVec3::new(a.distance, b.distance, c.distance)).filter(|corner| corner.is_finite())
    };
    let corners: Vec<DVec3> = hull.triangles.iter().map(corner).collect::<Option<_>>()?;
    let size = f64::from(Bounds::of(corners.iter().map(|corner| corner.as_vec3())).radius());
    let merged = merged(&corners, (size + centre.abs().max_element()) * f64::from(f32::EPSILON));

    // The next of a facet's corners, counter-clockwise, follows from the hull's triangle across its side.
    let mut next: HashMap<(usize, usize), (usize, usize)> = HashMap::new();
    for (number, [a, b, c]) in hull.triangles.iter().enumerate() {
        for (facet, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            next.insert((*facet, *from), (*to, number));
        }
    }
    let mut mesh =
        Mesh { positions: corners.iter().map(|corner| (*corner + centre).as_vec3()).collect(), ..Mesh::default() };
    let mut firsts: HashMap<usize, usize> = HashMap::new();
    for [a, b, c] in &hull.triangles {
        for (facet, from) in [(a, b), (b, c), (c, a)] {
            firsts.entry(*facet).or_insert(*from);
        }
    }
    let mut facets: Vec<(usize, usize)> = firsts.into_iter().collect();
    facets.sort_unstable();
    for (facet, first) in facets {
        let (mut ring, mut from) = (Vec::new(), first);
        loop {
            let &(to, number) = next.get(&(facet, from))?;
            if ring.last() != Some(&merged[number]) {
                ring.push(merged[number]);
            }
            from = to;
            if from == first {
                break;
            }
        }
        if ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        for pair in ring.get(1..).unwrap_or_default().windows(2) {
            mesh.indices.extend([ring[0], pair[0], pair[1]].map(|corner| corner as u32));
        }
    }
    Some(used(mesh))
}

/// Returns for each corner the first one within `tolerance` of it.
fn merged(corners: &[DVec3], tolerance: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_by(|&a, &b| corners[a].x.total_cmp(&corners[b].x));
    let mut first: Vec<usize> = (0..corners.len()).collect();
    for (place, &corner) in order.iter().enumerate() {
        let near = order[..place].iter().rev().take_while(|&&other| corners[corner].x - corners[other].x <= tolerance);
        let same = near.filter(|&&other| corners[other].distance(corners[corner]) <= tolerance);
        if let Some(&other) = same.last() {
            first[corner] = first[other];
        }
    }
    first
}

/// Returns a mesh without the corners that no triangle has, with normals.
fn used(mesh: Mesh) -> Mesh {
    let mut number = HashMap::new();
    let mut positions = Vec::new();
    let indices = mesh.indices.iter().map(|&index| {
        *number.entry(index).or_insert_with(|| {
            positions.push(mesh.positions[index as usize]);
            positions.len() as u32 - 1
        })
    });
    let indices = indices.collect();
    Mesh::with_shared_normals(positions, indices, Averaging::Angle)
}
