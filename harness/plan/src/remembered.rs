//! What is measured on a mesh is measured once in a process: a scene is planned several times for one picture, and again
//! for other settings.

use lapidary_scene::{Mesh, Scene};
use std::cell::RefCell;
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
        self.by_key(key(mesh), || measure(mesh))
    }

    /// Returns a measure of two meshes in their order.
    pub(crate) fn of_both(&self, one: &Mesh, other: &Mesh, measure: impl FnOnce(&Mesh, &Mesh) -> T) -> T {
        let mut both = DefaultHasher::new();
        [key(one), key(other)].hash(&mut both);
        self.by_key(both.finish(), || measure(one, other))
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

thread_local! {
    /// Hashes of the meshes of a scene that is held, by where they stand; `None` until one is asked for.
    static KEYS: RefCell<BTreeMap<usize, Option<u64>>> = const { RefCell::new(BTreeMap::new()) };
}

/// Calls `decide` while the scene is held: nothing changes its meshes, and each is hashed once. A band is compared with every
/// stone in it.
pub(crate) fn holding<T>(scene: &Scene, decide: impl FnOnce() -> T) -> T {
    struct Release;
    impl Drop for Release {
        fn drop(&mut self) {
            KEYS.with_borrow_mut(BTreeMap::clear);
        }
    }
    // What is held stays so, and meshes of another scene stand elsewhere.
    if KEYS.with_borrow(|keys| !keys.is_empty()) {
        return decide();
    }
    let _release = Release;
    let meshes = scene.objects.iter().flat_map(|object| [&object.mesh, object.shape()]);
    KEYS.with_borrow_mut(|keys| keys.extend(meshes.map(|mesh| (place(mesh), None))));
    decide()
}

fn place(mesh: &Mesh) -> usize {
    std::ptr::from_ref(mesh).addr()
}

/// Returns a hash of a mesh: of its positions, normals and triangles.
pub(crate) fn key(mesh: &Mesh) -> u64 {
    let held = KEYS.with_borrow(|keys| keys.get(&place(mesh)).copied());
    if let Some(Some(known)) = held {
        return known;
    }
    let made = hashed(mesh);
    if held.is_some() {
        KEYS.with_borrow_mut(|keys| keys.insert(place(mesh), Some(made)));
    }
    made
}

fn hashed(mesh: &Mesh) -> u64 {
    let mut hasher = DefaultHasher::new();
    mesh.indices.hash(&mut hasher);
    let vectors = mesh.positions.iter().chain(&mesh.normals);
    vectors.for_each(|vector| vector.to_array().map(f32::to_bits).hash(&mut hasher));
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

    #[test]
    fn a_held_scene_is_let_go() {
        let remembered = Remembered::new();
        let mut scene = Scene::named("octahedron").unwrap();
        for expected in [1, 2] {
            let found = holding(&scene, || {
                let mesh = &scene.objects[0].mesh;
                assert_eq!(remembered.of(&mesh.clone(), |_| expected), remembered.of(mesh, |_| 3));
                remembered.of(mesh, |_| 4)
            });
            assert_eq!(found, expected);
            scene.objects[0].mesh.positions[0].x += 1.0;
        }
    }
}
