//! Whether a clear body's normals say that its surface is smooth, or were averaged over the facets of a cut stone.

use super::{plane_of, weld};
use crate::Mesh;
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Cosine of the angle up to which a normal is that of its triangle, and two triangles are one facet: half a degree.
const FLAT: f64 = 0.999_962;
/// Cosine of the angle above which no smooth surface is turned from one triangle to the next: 35°.
const SHARP: f64 = 0.819;
/// Share of the edges between facets, by length, that are sharp in a cut stone; on a smooth body normals part there.
const SHARE: f64 = 0.05;
/// Number of facets of a connected part up to which they are few, each counted by its share of the area.
const FEW: f64 = 128.0;

/// Which normals refract and reflect in a clear body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Those of [`is_smooth`]: the mesh's, unless it is a cut stone's.
    #[default]
    Decided,
    /// Those of the mesh, between a triangle's corners.
    File,
    /// Those of the triangles.
    Facets,
}

impl Normals {
    /// Returns the name in a file and on the command line; `None` if the mesh decides.
    #[must_use]
    pub const fn name(self) -> Option<&'static str> {
        match self {
            Self::Decided => None,
            Self::File => Some("file"),
            Self::Facets => Some("facets"),
        }
    }

    /// Whether the mesh's normals are interpolated.
    #[must_use]
    pub fn are_smooth(self, mesh: &Mesh) -> bool {
        match self {
            Self::Decided => is_smooth(mesh),
            Self::File => !mesh.normals.is_empty(),
            Self::Facets => false,
        }
    }

    /// Returns the normals of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [Self::File, Self::Facets].into_iter().find(|normals| normals.name() == Some(name))
    }
}

/// Whether light is refracted by the interpolated normals of a mesh: if any of them differs from its triangle's, unless
/// the facets are few and wide and normals are averaged over sharp edges, as exporters do with cut stones.
#[must_use]
pub fn is_smooth(mesh: &Mesh) -> bool {
    let triangles: Vec<Triangle> = triangles(mesh);
    triangles.iter().any(Triangle::is_bent) && !is_cut(mesh, &triangles)
}

/// Whether any normal of a mesh differs from its triangle's.
#[must_use]
pub fn is_bent(mesh: &Mesh) -> bool {
    triangles(mesh).iter().any(Triangle::is_bent)
}

/// A triangle with an area.
struct Triangle {
    corners: [usize; 3],
    normal: DVec3,
    area: f64,
    /// Normals at the corners.
    normals: [DVec3; 3],
}

impl Triangle {
    /// Whether a normal differs from that of the plane.
    fn is_bent(&self) -> bool {
        self.normals.iter().any(|normal| normal.dot(self.normal) < FLAT)
    }
}

fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    let (welded, _) = weld(&mesh.positions);
    let triangle = |corners: &[u32]| {
        let corners = [0, 1, 2].map(|corner| corners[corner] as usize);
        let position = |corner: usize| mesh.positions.get(corner).map(|position| position.as_dvec3());
        let positions = [position(corners[0])?, position(corners[1])?, position(corners[2])?];
        let (normal, area) = plane_of(positions)?;
        let of_corner = |corner: usize| {
            let given = mesh.normals.get(corner).copied().unwrap_or(Vec3::ZERO).as_dvec3();
            given.normalize_or(normal)
        };
        Some(Triangle { corners: corners.map(|corner| welded[corner]), normal, area, normals: corners.map(of_corner) })
    };
    mesh.indices.chunks_exact(3).filter_map(triangle).collect()
}

/// Whether the facets are few and wide, and normals are averaged over sharp edges.
fn is_cut(mesh: &Mesh, triangles: &[Triangle]) -> bool {
    let (welded, count) = weld(&mesh.positions);
    let mut places = vec![DVec3::ZERO; count];
    for (position, place) in mesh.positions.iter().zip(&welded) {
        places[*place] = position.as_dvec3();
    }
    // The triangle on the one side of each edge, and the place of the edge's first corner there.
    let mut first: HashMap<[usize; 2], (usize, usize)> = HashMap::new();
    let mut facets: Vec<usize> = (0..triangles.len()).collect();
    let mut parts = facets.clone();
    let (mut between, mut sharp) = (0.0, 0.0);
    for (number, triangle) in triangles.iter().enumerate() {
        for corner in 0..3 {
            let [a, b] = [triangle.corners[corner], triangle.corners[(corner + 1) % 3]];
            let Some((other, of_other)) = first.insert([a.min(b), a.max(b)], (number, corner)) else { continue };
            let other = (&triangles[other], other, of_other);
            let cosine = triangle.normal.dot(other.0.normal);
            join(&mut parts, number, other.1);
            if cosine > FLAT {
                join(&mut facets, number, other.1);
                continue;
            }
            let length = places[a].distance(places[b]);
            between += length;
            if cosine < SHARP && is_averaged((triangle, corner), (other.0, other.2)) {
                sharp += length;
            }
        }
    }
    let mut areas: HashMap<usize, f64> = HashMap::new();
    for (number, triangle) in triangles.iter().enumerate() {
        *areas.entry(root(&mut facets, number)).or_default() += triangle.area;
    }
    let whole: f64 = areas.values().sum();
    let squares: f64 = areas.values().map(|area| area * area).sum();
    let parts = (0..triangles.len()).filter(|number| parts[*number] == *number).count() as f64;
    sharp >= SHARE * between && whole * whole <= FEW * parts * squares
}

/// Whether two triangles have the same normals at the ends of the edge between them, given with its first corner in each.
fn is_averaged((one, corner): (&Triangle, usize), (other, of_other): (&Triangle, usize)) -> bool {
    let ends = |triangle: &Triangle, corner: usize| {
        [corner, (corner + 1) % 3].map(|corner| (triangle.corners[corner], triangle.normals[corner]))
    };
    ends(one, corner).iter().all(|(end, normal)| {
        ends(other, of_other).iter().any(|(of_other, known)| end == of_other && normal.dot(*known) > FLAT)
    })
}

/// Makes one of the facets, or parts, that two triangles belong to.
fn join(facets: &mut [usize], one: usize, two: usize) {
    let [one, two] = [root(facets, one), root(facets, two)];
    facets[one.max(two)] = one.min(two);
}

/// Returns the lowest number of the facet that a triangle belongs to.
fn root(facets: &mut [usize], mut number: usize) -> usize {
    while facets[number] != number {
        facets[number] = facets[facets[number]];
        number = facets[number];
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use crate::normals::{Averaging, shared_normals};
    use crate::surfaces::{rounded_box, sphere, torus};

    #[test]
    fn cut_stones_stay_cut_and_round_bodies_smooth() {
        let round = ["bunny_stone", "tumbler"];
        let cut = crate::BUILT_IN.iter().filter(|built_in| !round.contains(&built_in.name));
        for scene in cut.map(|built_in| Scene::open(built_in.name).expect(built_in.name)) {
            for object in scene.objects.iter().filter(|object| object.material.is_clear()) {
                let mut mesh = object.shape().clone();
                mesh.normals = shared_normals(&mesh.positions, &mesh.indices, Averaging::default());
                assert!(!is_smooth(&mesh), "{} of {}", object.name, scene.objects[0].name);
            }
        }
        let round = [sphere(1.0, 12), sphere(1.0, 24), sphere(1.0, 96), torus(2.0, 0.5, 48, 24)];
        for mesh in round.iter().chain(&[rounded_box(DVec3::ONE, 0.2, 8)]) {
            assert!(is_smooth(mesh), "{} triangles", mesh.triangle_count());
            let mut flat = mesh.clone();
            flat.normals.clear();
            assert!(!is_smooth(&flat));
        }
    }
}
