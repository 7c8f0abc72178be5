//! What is measured on a mesh is measured once in a process: a scene is planned several times for one picture, and again
//! for other settings.

use lapidary_scene::Mesh;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::{Mutex, PoisonError};

/// Results of one measure, by a hash of the mesh.
pub(crate) struct Remembered<T>(Mutex<BTreeMap<u64, T>>);

impl<T: Copy> Remembered<T> {
    pub(crate) const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// Returns the measure of a mesh, which must follow from its positions, normals and triangles alone.
    pub(crate) fn of(&self, mesh: &Mesh, measure: impl FnOnce(&Mesh) -> T) -> T {
        self.by_key(key(&[mesh]), || measure(mesh))
    }

    /// Returns a measure of two meshes in their order.
    pub(crate) fn of_both(&self, one: &Mesh, other: &Mesh, measure: impl FnOnce(&Mesh, &Mesh) -> T) -> T {
        self.by_key(key(&[one, other]), || measure(one, other))
    }

    fn by_key(&self, key: u64, measure: impl FnOnce() -> T) -> T {
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&key).copied() {
            return found;
        }
        // Not under the lock: others may measure other meshes meanwhile.
        let found = measure();
        known().insert(key, found);
        found
    }
}

fn key(meshes: &[&Mesh]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for mesh in meshes {
        mesh.indices.hash(&mut hasher);
        let vectors = mesh.positions.iter().chain(&mesh.normals);
        vectors.for_each(|vector| vector.to_array().map(f32::to_bits).hash(&mut hasher));
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_mesh_is_measured_once_and_a_changed_one_again() {
        let remembered = Remembered::new();
        let mut mesh =
            Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], indices: vec![0, 1, 2], ..Mesh::default() };
        assert_eq!(remembered.of(&mesh, |_| 1), 1);
        assert_eq!(remembered.of(&mesh.clone(), |_| 2), 1);
        mesh.positions[2].z = f32::MIN_POSITIVE;
        assert_eq!(remembered.of(&mesh, |_| 3), 3);
        mesh.indices.swap(0, 1);
        assert_eq!(remembered.of(&mesh, |_| 4), 4);
    }
}
