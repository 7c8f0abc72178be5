//! Defects that keep a mesh from being the surface of a solid: one diagnosis for the notes, for the
//! choice of a rung and for the random walks.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::weld::{TOLERANCE, weld};
use super::{Bounds, Mesh};

/// Defects of a mesh as the surface of a solid. All counts are 0 for a sound one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MeshDiagnosis {
    /// Number of edges with an odd number of triangles: the rim of a hole, or a fin.
    pub open_edges: usize,
    /// Number of edges with an even number of triangles that do not run against each other:
    /// neighbours of opposite winding.
    pub turned_edges: usize,
    /// Number of connected parts that enclose a negative volume and, unlike a cavity, do not lie
    /// inside another part: their triangles run clockwise seen from outside.
    pub inverted_parts: usize,
    /// Number of triangles beyond the first with the same three corners, in either winding.
    pub doubled: usize,
    /// Number of triangles without area.
    pub degenerate: usize,
    /// Whether all corners lie in one plane, so that nothing is enclosed. Also true if no triangle
    /// of the mesh has area.
    pub is_flat: bool,
}

impl MeshDiagnosis {
    /// Diagnoses a mesh in any state, skipping indices past its positions, in time linear in its
    /// size.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        let welded = Welded::of(mesh);
        let (open_edges, turned_edges) = welded.unbalanced_edges();
        let proper = || welded.triangles.iter().filter(|triangle| triangle.has_area());
        let mut seen = HashSet::new();
        let sorted = |triangle: &Triangle| {
            let mut corners = triangle.corners;
            corners.sort_unstable();
            corners
        };
        Self {
            open_edges,
            turned_edges,
            inverted_parts: welded.inverted_parts(),
            doubled: proper().filter(|triangle| !seen.insert(sorted(triangle))).count(),
            degenerate: welded.triangles.len() - proper().count(),
            is_flat: welded.is_flat(),
        }
    }

    /// Whether the surface has no hole, no fin and no turned neighbours, and encloses something.
    #[must_use]
    pub fn is_closed(self) -> bool {
        self.open_edges == 0 && self.turned_edges == 0 && !self.is_flat
    }

    /// Whether rays inside can be traced reliably: closed, facing outwards, and nothing doubled.
    #[must_use]
    pub fn is_solid(self) -> bool {
        self.is_closed() && self.inverted_parts == 0 && self.doubled == 0
    }

    /// Returns the defects as clauses for a message; empty for a sound solid.
    #[must_use]
    pub fn clauses(self) -> Vec<String> {
        let counted = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {many}")),
        };
        let flat = self.is_flat.then(|| "all corners lie in one plane".to_owned());
        // A flat sheet is open all around, so its open edges add no information.
        let open = if self.is_flat { 0 } else { self.open_edges };
        [
            flat,
            counted(open, "edge is open", "edges are open"),
            counted(
                self.turned_edges,
                "edge joins triangles of opposite winding",
                "edges join triangles of opposite winding",
            ),
            counted(self.inverted_parts, "part is inside out", "parts are inside out"),
            counted(self.doubled, "triangle is there twice", "triangles are there twice"),
            counted(self.degenerate, "triangle has no area", "triangles have no area"),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

/// Returns the number of edges with more triangles on one side than on the other, of both kinds
/// that [`MeshDiagnosis`] tells apart; 0 for a closed mesh.
#[must_use]
pub fn open_edges(mesh: &Mesh) -> usize {
    let (open, turned) = Welded::of(mesh).unbalanced_edges();
    open + turned
}

/// Depth of a dent that still counts as convex, as a share of the radius: the width of a texel of a shadow
/// map with 1,024 texels, in which smaller ones do not show.
const DENT: f64 = 2.0 / 1024.0;

/// Whether light outside can meet a mesh twice: false for a flat sheet and for a single closed surface that
/// is convex but for dents of 1/512 of its radius.
#[must_use]
pub fn shades_itself(mesh: &Mesh) -> bool {
    let welded = Welded::of(mesh);
    !welded.is_flat() && !welded.is_convex()
}

/// A triangle by the numbers of its places.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corners: [usize; 3],
    /// Area vector times two; zero if its direction would be only rounding error.
    across: DVec3,
}

impl Triangle {
    fn has_area(&self) -> bool {
        self.across != DVec3::ZERO
    }

    /// Returns the edges from corner to corner, without those of zero length.
    fn edges(&self) -> impl Iterator<Item = (usize, usize)> {
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to)
    }
}

/// A welded mesh: each place stands for all vertices at that position.
struct Welded {
    places: Vec<DVec3>,
    triangles: Vec<Triangle>,
    tolerance: f64,
}

impl Welded {
    fn of(mesh: &Mesh) -> Self {
        let positions = || mesh.positions.iter().map(|position| position.as_dvec3());
        let tolerance = TOLERANCE * positions().fold(0.0, |most: f64, position| most.max(position.abs().max_element()));
        let (places, numbers) = weld(positions(), tolerance);
        let triangle = |triangle: &[u32]| {
            let corner = |k: usize| numbers.get(triangle[k] as usize).copied();
            let corners = [corner(0)?, corner(1)?, corner(2)?];
            let [a, b, c] = corners.map(|corner| places[corner]);
            let (u, v) = (b - a, c - a);
            let across = u.cross(v);
            // Differences of f32 are exact to 1e-16 in f64, so a sine below 1e-12 has no direction
            // left.
            let has_area = across.length() > 1e-12 * u.length() * v.length();
            Some(Triangle { corners, across: if has_area { across } else { DVec3::ZERO } })
        };
        let triangles = mesh.indices.chunks_exact(3).filter_map(triangle).collect();
        Self { places, triangles, tolerance }
    }

    /// Returns the number of edges with an odd number of triangles, and of others with more
    /// triangles on one side than on the other.
    fn unbalanced_edges(&self) -> (usize, usize) {
        // Number of triangles, and how many more of them run from the lower number to the higher
        // than back.
        let mut edges: HashMap<(usize, usize), (u32, i32)> = HashMap::new();
        for (from, to) in self.triangles.iter().flat_map(Triangle::edges) {
            let (count, balance) = edges.entry((from.min(to), from.max(to))).or_default();
            *count += 1;
            *balance += if from < to { 1 } else { -1 };
        }
        let unbalanced = edges.values().filter(|(_, balance)| *balance != 0);
        let odd = unbalanced.clone().filter(|(count, _)| count % 2 == 1).count();
        (odd, unbalanced.count() - odd)
    }

    /// Returns the number of parts with negative volume that are not cavities. The volume of a part
    /// is taken about one of its own corners, so that a hole far from the origin weighs little.
    fn inverted_parts(&self) -> usize {
        let parts = self.parts();
        let volume = |part: &[usize]| -> f64 {
            let middle = self.places[self.triangles[part[0]].corners[0]];
            let tetrahedron = |&triangle: &usize| {
                let Triangle { corners, across } = self.triangles[triangle];
                across.dot(self.places[corners[0]] - middle) / 6.0
            };
            part.iter().map(tetrahedron).sum()
        };
        let bounds = |part: &[usize]| {
            let corners = part.iter().flat_map(|&triangle| self.triangles[triangle].corners);
            Bounds::of(corners.map(|corner| self.places[corner].as_vec3()))
        };
        let measured: Vec<(f64, Bounds)> = parts.iter().map(|part| (volume(part), bounds(part))).collect();
        // An open or flat part encloses no more than rounding error.
        let least = |bounds: &Bounds| self.tolerance * f64::from(bounds.radius()).powi(2);
        let (inverted, others): (Vec<_>, Vec<_>) =
            measured.into_iter().partition(|(volume, bounds)| *volume < -least(bounds));
        let is_cavity = |bounds: &Bounds| {
            others.iter().any(|(_, outer)| outer.min.cmple(bounds.min).all() && outer.max.cmpge(bounds.max).all())
        };
        inverted.iter().filter(|(_, bounds)| !is_cavity(bounds)).count()
    }

    /// Returns the triangles, by number, of each part that is connected through its places.
    fn parts(&self) -> Vec<Vec<usize>> {
        let mut parents: Vec<usize> = (0..self.places.len()).collect();
        fn root(parents: &mut [usize], mut place: usize) -> usize {
            while parents[place] != place {
                parents[place] = parents[parents[place]];
                place = parents[place];
            }
            place
        }
        for (from, to) in self.triangles.iter().flat_map(Triangle::edges) {
            let (from, to) = (root(&mut parents, from), root(&mut parents, to));
            parents[from.max(to)] = from.min(to);
        }
        let mut number_of_root: HashMap<usize, usize> = HashMap::new();
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for (number, triangle) in self.triangles.iter().enumerate() {
            let root = root(&mut parents, triangle.corners[0]);
            let part = *number_of_root.entry(root).or_insert_with(|| {
                parts.push(Vec::new());
                parts.len() - 1
            });
            parts[part].push(number);
        }
        parts
    }

    /// Whether the surface is closed, connected, and nowhere lies behind its own tangent plane by more
    /// than [`DENT`], as far as its outermost vertices tell.
    fn is_convex(&self) -> bool {
        if self.unbalanced_edges() != (0, 0) || self.parts().len() != 1 {
            return false;
        }
        let mut normals = vec![DVec3::ZERO; self.places.len()];
        for triangle in &self.triangles {
            triangle.corners.iter().for_each(|corner| normals[*corner] += triangle.across);
        }
        let outermost = self.outermost();
        let size = self.places.iter().copied().reduce(DVec3::max).zip(self.places.iter().copied().reduce(DVec3::min));
        let tolerance = DENT * size.map_or(0.0, |(most, least)| 0.5 * (most - least).length());
        self.places.iter().zip(normals).all(|(place, normal)| {
            let normal = normal.normalize_or_zero();
            outermost.iter().all(|other| normal.dot(other - place) <= tolerance)
        })
    }

    /// Returns the outermost vertices in directions that spread evenly over the sphere, or all of few.
    fn outermost(&self) -> Vec<DVec3> {
        const DIRECTIONS: usize = 256;
        if self.places.len() <= DIRECTIONS {
            return self.places.clone();
        }
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let directions = (0..DIRECTIONS).map(|number| {
            let height = 1.0 - (2.0 * number as f64 + 1.0) / DIRECTIONS as f64;
            let (sine, cosine) = (golden * number as f64).sin_cos();
            (DVec3::new(cosine, sine, 0.0) * (1.0 - height * height).sqrt()).with_z(height)
        });
        let farthest = |direction: DVec3| {
            self.places.iter().copied().max_by(|a, b| direction.dot(*a).total_cmp(&direction.dot(*b)))
        };
        directions.filter_map(farthest).collect()
    }

    fn is_flat(&self) -> bool {
        let largest =
            self.triangles.iter().max_by(|a, b| a.across.length_squared().total_cmp(&b.across.length_squared()));
        let Some(largest) = largest.filter(|triangle| triangle.has_area()) else { return true };
        let (normal, origin) = (largest.across.normalize(), self.places[largest.corners[0]]);
        let height = |corner: usize| normal.dot(self.places[corner] - origin).abs();
        // The largest triangle's corners carry their rounding errors on to the rest, at most
        // eightfold: that is if it is an eighth as wide as the mesh.
        self.triangles.iter().flat_map(|triangle| triangle.corners).all(|corner| height(corner) <= 8.0 * self.tolerance)
    }
}

#[cfg(test)]
mod tests;
