//! Makes the glTF files in `harness/assets/` that this project made itself. Built-in scenes read
//! most of them, because computing their meshes takes seconds; `brilliant.glb` is an example.
//! Nothing here is in the program `cook`.
//!
//! ```
//! let candle = lapidary_assets::candle::mesh();
//! assert!(lapidary_scene::MeshDiagnosis::of(&candle).is_solid());
//! ```

use lapidary_scene::{Mesh, Object, Scene, SceneError};

pub mod atlas;
pub mod candle;
pub mod figure;
pub mod implicit;
mod vitrine;

/// Reach of the halos around the bunny's charts in millimetres: three standard deviations of red
/// light in skin, the widest blur of the built-in materials. Wider halos cost few texels: with halos
/// of 2 and of 3 standard deviations, skin's standard deviation spans 42 texels, against 51 without
/// halos.
const HALO: f32 = 3.0 * 5.8;

/// Returns the names of the files and the scenes that they hold.
///
/// # Errors
/// Returns an error if a built-in scene does not load.
pub fn files() -> Result<Vec<(&'static str, Scene)>, SceneError> {
    let bunny = Scene::named("bunny")?;
    let unwrapped = bunny.objects.iter().map(|object| {
        let mut mesh = atlas::unwrap(&object.mesh, HALO);
        // glTF has no invisible triangles; the reader splits them off again.
        mesh.indices.append(&mut mesh.halo);
        mesh
    });
    let unwrapped = unwrapped.collect();
    Ok(vec![
        ("brilliant.glb", Scene::named("brilliant")?),
        ("bunny_atlas.glb", with_meshes(bunny, unwrapped)),
        // Framed anew, since the camera depends on the mesh.
        ("figure.glb", with_meshes(Scene::named("figure")?, vec![figure::mesh()]).seen_from(82.0, 12.0)),
        ("vitrine.glb", with_meshes(Scene::named("vitrine")?, vitrine::meshes()?)),
    ])
}

/// Returns the scene with other meshes for its objects, in order.
fn with_meshes(scene: Scene, meshes: Vec<Mesh>) -> Scene {
    assert_eq!(scene.objects.len(), meshes.len(), "{}: a mesh for each object", scene.name);
    let objects = scene.objects.into_iter().zip(meshes).map(|(object, mesh)| Object { mesh, ..object }).collect();
    Scene { objects, ..scene }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use lapidary_assay::extremum::larger;
    use lapidary_scene::{glb, gltf};

    /// The scene splits the file's triangles into the bunny's own and its halos.
    #[test]
    fn the_bunny_of_skin_has_the_atlas_and_its_halos() {
        let whole = Scene::named("bunny").expect("built in").objects.remove(0).mesh;
        let unwrapped = atlas::unwrap(&whole, HALO);
        for name in ["skin_bunny", "wax_bunny", "jade_bunny"] {
            let stored = Scene::named(name).expect("built in").objects.remove(0).mesh;
            assert_eq!((&stored.indices, &stored.halo), (&unwrapped.indices, &unwrapped.halo), "{name}");
            assert_eq!(stored.triangle_count(), whole.triangle_count(), "{name}");
        }
    }

    /// The materials of the vitrine say how thick the bodies are that are made here.
    #[test]
    fn the_vitrines_ball_is_as_thick_as_its_material_says() {
        let ball = Scene::named("vitrine").expect("built in").objects.remove(6);
        assert_eq!((ball.name.as_str(), ball.material.thickness), ("ball", 2.0 * vitrine::BALL as f32));
    }

    /// `cargo run --package lapidary-assets` makes the files anew.
    #[test]
    fn the_stored_files_are_what_is_made() {
        for (name, made) in files().expect("they load") {
            let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
            let bytes = std::fs::read(path).expect(name);
            let read = |bytes: &[u8]| gltf::parse(bytes, None).expect("written here");
            let (stored, written) = (read(&bytes), read(&glb::write(&made).expect("a scene that glTF can say")));
            assert_eq!((&stored.lights, stored.camera, &stored.name), (&written.lights, written.camera, &written.name));
            assert_eq!(stored.objects.len(), made.objects.len(), "{name}");
            for ((stored, written), made) in stored.objects.iter().zip(&written.objects).zip(&made.objects) {
                assert_eq!((&stored.name, &stored.material), (&written.name, &written.material));
                let (stored, made) = (&stored.mesh, &made.mesh);
                assert_eq!((&stored.indices, stored.uvs.len()), (&made.indices, made.uvs.len()), "{name}");
                let furthest = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, larger);
                // Sines differ in their last digit between systems.
                assert!(furthest(&stored.positions, &made.positions) < 1e-3, "{name}");
                assert!(furthest(&stored.normals, &made.normals) < 1e-2, "{name}");
                assert!(stored.uvs.iter().zip(&made.uvs).all(|(a, b)| a.distance(*b) < 1e-6), "{name}");
            }
            println!("{name}: {} bytes", bytes.len());
            assert!(bytes.len() <= 1024 * 1024, "{name}: {} bytes", bytes.len());
        }
    }
}
