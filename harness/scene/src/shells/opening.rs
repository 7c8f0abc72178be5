//! An opening in a stone: closed where the facet that is missing is certain.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::Mesh;
use crate::normals::is_smooth;

use super::surface::{Face, Surface};

/// Largest number of edges around an opening.
const MOST_EDGES: usize = 1024;
/// Products of planes and vertices up to which it is asked whether a body is convex.
const MOST_PRODUCTS: usize = 1 << 24;
/// Height above a facet that is no dent, as a share of the size: what counts as slightly not convex.
const DENT: f64 = 1.0 / (1 << 12) as f64;

/// Returns an open mesh with its openings closed, and their number; `None` unless each is flat or as narrow as rounding, and
/// what results is closed, convex and without smooth normals: a bowl may be of one surface.
pub(super) fn closed(mesh: &Mesh) -> Option<(Mesh, usize)> {
    let mut surface = Surface::of(mesh);
    let size = size(&surface);
    let loops = loops(&surface)?;
    let count = loops.len();
    let mut mesh = mesh.clone();
    for rim in loops {
        close(&mut surface, &mut mesh, &rim, DENT * size)?;
    }
    if volume(&surface) < 0.0 {
        surface.faces.iter_mut().for_each(Face::turn);
    }
    let is_convex = is_convex(&surface, DENT * size)?;
    let faces: Vec<u32> = (0..surface.faces.len() as u32).collect();
    let solid = is_convex.then(|| surface.mesh(&mesh, &faces)).filter(|solid| !is_smooth(solid));
    solid.map(|solid| (solid, count))
}

fn volume(surface: &Surface) -> f64 {
    let faces = 0..surface.faces.len() as u32;
    faces.map(|face| surface.across(face).dot(surface.corners(face)[0])).sum::<f64>() / 6.0
}

fn size(surface: &Surface) -> f64 {
    let corners = || surface.faces.iter().flat_map(|face| face.places).map(|place| surface.places[place as usize]);
    let (min, max) =
        corners().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), at| (min.min(at), max.max(at)));
    (max - min).max_element()
}

/// Returns the places around each opening, in the winding of the triangles that close it; `None` if they are not plain loops.
fn loops(surface: &Surface) -> Option<Vec<Vec<u32>>> {
    let edges = surface.half_edges();
    let mut next: BTreeMap<u32, u32> = BTreeMap::new();
    for edge in edges.chunk_by(|one, other| one.ends() == other.ends()) {
        match edge {
            [half] => {
                let (from, to) = if half.forward { (half.high, half.low) } else { (half.low, half.high) };
                if next.insert(from, to).is_some() || next.len() > MOST_EDGES {
                    return None;
                }
            }
            [one, other] if one.forward != other.forward => {}
            _ => return None,
        }
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut rim = Vec::new();
        let mut place = start;
        while let Some(beyond) = next.remove(&place) {
            rim.push(place);
            place = beyond;
        }
        if place != start || rim.len() < 3 {
            return None;
        }
        loops.push(rim);
    }
    (!loops.is_empty()).then_some(loops)
}

/// Closes an opening by triangles about one of its corners; `None` if it is not flat.
fn close(surface: &mut Surface, mesh: &mut Mesh, rim: &[u32], dent: f64) -> Option<()> {
    let at = |k: usize| surface.places[rim[k % rim.len()] as usize];
    let about = at(0);
    let across: DVec3 = (1..rim.len()).map(|k| (at(k) - about).cross(at(k + 1) - about)).sum();
    let longest = (0..rim.len()).map(|k| at(k).distance(about)).fold(0.0, f64::max);
    // Of a gap along an edge only rounding is left.
    let is_narrow = across.length() <= surface.tolerance * longest;
    let normal = across.normalize_or_zero();
    let is_flat = (0..rim.len()).all(|k| normal.dot(at(k) - about).abs() <= dent);
    if !is_narrow && !is_flat {
        return None;
    }
    // The corner from which the narrowest triangle is widest.
    let count = rim.len();
    let least = |corner: usize| {
        let triangle = |k: usize| (at(corner + k) - at(corner)).cross(at(corner + k + 1) - at(corner)).dot(normal);
        (1..count - 1).map(triangle).fold(f64::INFINITY, f64::min)
    };
    let corner = (0..count).max_by(|&one, &other| least(one).total_cmp(&least(other)))?;
    // A facet of its own has its own normals.
    let first = mesh.positions.len() as u32;
    for k in 0..count {
        mesh.positions.push(at(k).as_vec3());
        mesh.normals.push(normal.as_vec3().normalize_or(glam::Vec3::Y));
    }
    if !mesh.uvs.is_empty() {
        mesh.uvs.resize(mesh.positions.len(), glam::Vec2::ZERO);
    }
    if !mesh.colors.is_empty() {
        mesh.colors.resize(mesh.positions.len(), glam::Vec3::ONE);
    }
    for k in 1..count - 1 {
        let corners = [corner, corner + k, corner + k + 1].map(|k| k % count);
        let places = corners.map(|k| rim[k]);
        surface.faces.push(Face { places, vertices: corners.map(|k| first + k as u32), turned: false });
    }
    Some(())
}

/// Whether no corner lies above a triangle's plane by more than a dent, and something is enclosed; `None` if there are too
/// many to look.
fn is_convex(surface: &Surface, dent: f64) -> Option<bool> {
    let mut corners: Vec<u32> = surface.faces.iter().flat_map(|face| face.places).collect();
    corners.sort_unstable();
    corners.dedup();
    if surface.faces.len() * corners.len() > MOST_PRODUCTS {
        return None;
    }
    let plane = |face: u32| {
        let [a, b, c] = surface.corners(face);
        let across = surface.across(face);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        // The normal of a sliver is only rounding error.
        (across.length() > dent * longest).then(|| (across.normalize(), a))
    };
    let faces = 0..surface.faces.len() as u32;
    let is_below = |(normal, about): (DVec3, DVec3)| {
        corners.iter().all(|&place| normal.dot(surface.places[place as usize] - about) <= dent)
    };
    let area: f64 = faces.clone().map(|face| 0.5 * surface.across(face).length()).sum();
    Some(volume(surface) > dent * area && faces.filter_map(plane).all(is_below))
}
