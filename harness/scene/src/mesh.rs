//! A triangle mesh in world space.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DQuat, DVec3, Vec2, Vec3};

use super::Bounds;
use super::normals::{Averaging, Cofactors, shared_normals};

/// A list of triangles with shared ("soft-edge") vertex normals, in world space, y up.
///
/// The loader and the cuts of this crate always give consistent meshes: `normals` is as long as
/// `positions`, `uvs` and `colors` are as long or empty, every normal has unit length, the length of `indices` is
/// a multiple of three, and every index is below `positions.len()`. Triangles wind
/// counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Vertex positions, in the scene's own length unit.
    pub positions: Vec<Vec3>,
    /// A unit normal for each position, pointing out of the body.
    pub normals: Vec<Vec3>,
    /// Texture coordinates for each position, v down as in glTF; empty if there are none.
    pub uvs: Vec<Vec2>,
    /// Linear RGB for each position, 0 to 1, by which the material's base colour is multiplied
    /// (`COLOR_0` of glTF); empty if there are none.
    pub colors: Vec<Vec3>,
    /// Three indices into `positions` for each triangle.
    pub indices: Vec<u32>,
    /// Three indices into `positions` for each triangle that exists only in texture space: a second
    /// copy of a chart's surroundings, drawn next to it so that a blur there can cross the chart's
    /// border. Empty if there are none; only texture diffusion reads it.
    pub halo: Vec<u32>,
}

impl Mesh {
    /// Returns a mesh whose normals are averaged over the triangles around each position; see
    /// [`shared_normals`] for the treatment of degenerate triangles.
    #[must_use]
    pub fn with_shared_normals(positions: Vec<Vec3>, indices: Vec<u32>, averaging: Averaging) -> Self {
        let normals = shared_normals(&positions, &indices, averaging);
        Self { positions, normals, indices, ..Self::default() }
    }

    /// Returns the mesh rotated by `rotation`, of unit length, and then moved by `translation`.
    #[must_use]
    pub fn placed(&self, rotation: DQuat, translation: DVec3) -> Self {
        let position = |p: &Vec3| (rotation * p.as_dvec3() + translation).as_vec3();
        let normal = |n: &Vec3| (rotation * n.as_dvec3()).normalize().as_vec3();
        Self {
            positions: self.positions.iter().map(position).collect(),
            normals: self.normals.iter().map(normal).collect(),
            ..self.clone()
        }
    }

    /// Returns the mesh under an affine transform that does not mirror it.
    #[must_use]
    pub fn transformed(&self, transform: DMat4) -> Self {
        let cofactors = Cofactors::of(DMat3::from_mat4(transform));
        let position = |p: &Vec3| transform.transform_point3(p.as_dvec3()).as_vec3();
        Self {
            positions: self.positions.iter().map(position).collect(),
            normals: self.normals.iter().map(|normal| cofactors.apply(*normal).unwrap_or(*normal)).collect(),
            ..self.clone()
        }
    }

    /// Returns the mesh scaled about the origin by `factor`, above 0.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        Self { positions: self.positions.iter().map(|position| factor * *position).collect(), ..self.clone() }
    }

    /// Returns the mesh without texture coordinates.
    #[must_use]
    pub fn without_uvs(self) -> Self {
        Self { uvs: Vec::new(), ..self }
    }

    /// Returns the mesh without `halo` and without the vertices that only the halo uses.
    #[must_use]
    pub fn without_halo(&self) -> Self {
        let count = self.positions.len();
        let mut kept = vec![true; count];
        for (list, keep) in [(&self.halo, false), (&self.indices, true)] {
            list.iter().for_each(|&vertex| kept[vertex as usize] = keep);
        }
        let places = kept.iter().scan(0u32, |next, &keep| {
            let place = *next;
            *next += u32::from(keep);
            Some(place)
        });
        let places: Vec<u32> = places.collect();
        fn filtered<T: Copy>(list: &[T], kept: &[bool]) -> Vec<T> {
            list.iter().zip(kept).filter(|(_, keep)| **keep).map(|(value, _)| *value).collect()
        }
        Self {
            positions: filtered(&self.positions, &kept),
            normals: filtered(&self.normals, &kept),
            uvs: filtered(&self.uvs, &kept),
            colors: filtered(&self.colors, &kept),
            indices: self.indices.iter().map(|&vertex| places[vertex as usize]).collect(),
            halo: Vec::new(),
        }
    }

    /// Adds the triangles of `other`, so that one draw call shows both. No vertex becomes shared:
    /// each body keeps the normals that it had alone. Together they may have 2³² vertices. Texture
    /// coordinates are kept if both have them; colours if one has them, the other is then white.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        if self.uvs.len() == self.positions.len() && other.uvs.len() == other.positions.len() {
            self.uvs.extend(&other.uvs);
        } else {
            self.uvs.clear();
        }
        if !self.colors.is_empty() || !other.colors.is_empty() {
            self.colors.resize(self.positions.len(), Vec3::ONE);
            self.colors.extend(&other.colors);
            self.colors.resize(self.positions.len() + other.positions.len(), Vec3::ONE);
        }
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        for (indices, others) in [(&mut self.indices, &other.indices), (&mut self.halo, &other.halo)] {
            indices.extend(others.iter().map(|index| first + index));
        }
    }

    /// Returns the mesh without pairs of triangles that have the same three corners and face
    /// opposite ways, as in simplified scans: they enclose nothing, and a ray that hits one leaves
    /// where it enters.
    #[must_use]
    pub fn without_folds(&self) -> Self {
        // 0 and -0 are the same place.
        let place = |index: u32| (self.positions[index as usize] + 0.0).to_array().map(f32::to_bits);
        let mut waiting: HashMap<[[u32; 3]; 3], Vec<usize>> = HashMap::new();
        let mut kept = vec![true; self.indices.len() / 3];
        for (number, triangle) in self.indices.chunks_exact(3).enumerate() {
            let mut corners = [place(triangle[0]), place(triangle[1]), place(triangle[2])];
            // Rotated to start at the least corner, so that only the winding differs.
            let least = (0..3).min_by_key(|&corner| corners[corner]).unwrap_or_default();
            corners.rotate_left(least);
            let [first, second, third] = corners;
            match waiting.get_mut(&[first, third, second]).and_then(Vec::pop) {
                Some(other) => (kept[number], kept[other]) = (false, false),
                None => waiting.entry(corners).or_default().push(number),
            }
        }
        let whole = self.indices.chunks_exact(3).zip(kept).filter(|(_, kept)| *kept);
        Self { indices: whole.flat_map(|(triangle, _)| triangle).copied().collect(), ..self.clone() }
    }

    /// Returns the number of whole triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Whether a triangle has an area. None has in a body that its node scales by 0.
    #[must_use]
    pub fn has_area(&self) -> bool {
        // In f64, which loses no square of an f32.
        let across = |corners: [Vec3; 3]| {
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            (b - a).cross(c - a)
        };
        self.triangles().any(|corners| across(corners) != DVec3::ZERO)
    }

    /// Returns the corners of each triangle, in winding order. A triangle with an index past the
    /// end of `positions` is left out.
    pub fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.indices.chunks_exact(3).filter_map(|triangle| {
            let corner = |k: usize| self.positions.get(triangle[k] as usize).copied();
            Some([corner(0)?, corner(1)?, corner(2)?])
        })
    }

    /// Whether a closed surface goes around a point: by the solid angle under which its triangles are seen from there (Van
    /// Oosterom and Strackee, 1983). Of an open surface, whether it covers more than half of what the point sees. A point that
    /// is not finite is enclosed by nothing.
    #[must_use]
    pub fn encloses(&self, point: Vec3) -> bool {
        let Bounds { min, max } = Bounds::of(self.positions.iter().copied());
        if !(point.cmpge(min).all() && point.cmple(max).all()) {
            return false;
        }
        let half_angle = |corners: [Vec3; 3]| {
            let [a, b, c] = corners.map(|corner| (corner - point).as_dvec3());
            let [x, y, z] = [a, b, c].map(|way| way.length());
            a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
        };
        self.triangles().map(half_angle).sum::<f64>().abs() > std::f64::consts::PI
    }

    /// Returns the enclosed volume, positive if the triangles wind counter-clockwise seen from
    /// outside, and the area. The volume of an open mesh is meaningless.
    #[must_use]
    pub fn volume_and_area(&self) -> (f64, f64) {
        let parts = self.triangles().map(|corners| {
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            let across = (b - a).cross(c - a);
            (across.dot(a) / 6.0, 0.5 * across.length())
        });
        parts.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1))
    }

    /// Returns the size of the lists in bytes.
    #[must_use]
    pub fn byte_size(&self) -> u64 {
        let vectors = self.positions.len() + self.normals.len() + self.colors.len();
        let uvs = self.uvs.len() * size_of::<Vec2>();
        (vectors * size_of::<Vec3>() + uvs + (self.indices.len() + self.halo.len()) * size_of::<u32>()) as u64
    }
}
