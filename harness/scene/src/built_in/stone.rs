//! Translucent stone lit from behind or from the side: the bunny, the dragon and the figure.
//! Lengths are in millimetres.

use glam::Vec3;
use std::f32::consts::PI;

use super::framing::framed;
use super::translucent::{jade, scattering, sized};
use crate::camera::direction;
use crate::{Averaging, Density, Light, Material, Medium, Mesh, Object, Scene, SceneError, gltf};
use lapidary_veins::VeinsPattern;

/// The bunny of the Stanford 3D Scanning Repository, decimated and closed.
pub(super) const BUNNY: &[u8] = include_bytes!("../../../assets/bunny.glb");

/// The dragon of the Stanford 3D Scanning Repository, the coarsest of its four meshes.
const DRAGON: &[u8] = include_bytes!("../../../assets/dragon.glb");

/// A winged figure, made by the program in `harness/assets/`.
const FIGURE: &[u8] = include_bytes!("../../../assets/figure.glb");

/// Marble, from Jensen, Marschner, Levoy and Hanrahan, "A Practical Model for Subsurface Light
/// Transport" (2001).
pub(super) fn marble() -> Material {
    scattering(
        "marble",
        Medium::isotropic(Vec3::new(2.19, 2.62, 3.0), Vec3::new(0.0021, 0.0041, 0.0071)),
        Vec3::new(0.931, 0.913, 0.894),
        (1.5, 0.3),
    )
}

/// Cloudy veins through clearer stone, some 10 mm apart.
const VEINS: VeinsPattern =
    VeinsPattern { frequency: 0.1, width: 0.08, least: 0.5, greatest: 4.0, octaves: 3, seed: 7 };

/// Builds the Stanford bunny, 60 mm high, with parallel light from the left.
pub(super) fn bunny(name: &str) -> Result<Scene, SceneError> {
    let mesh = sized(stored(BUNNY)?, 60.0);
    Ok(stone(name, mesh, marble(), sun(Vec3::new(-1.0, 0.3, 0.0), 1.0), (80.0, 10.0)))
}

/// Builds the Stanford dragon, 50 mm high and 71 mm long, with parallel light from behind.
pub(super) fn dragon(name: &str) -> Result<Scene, SceneError> {
    let unfolded = stored(DRAGON)?.without_folds();
    // The removed triangles contributed to the file's normals.
    let mesh = Mesh::with_shared_normals(unfolded.positions, unfolded.indices, Averaging::Angle);
    let mesh = sized(mesh, 50.0);
    let jade = jade();
    let veined = |medium| Medium { density: Density::Veins(VEINS), ..medium };
    let jade = Material { name: "veined jade".to_owned(), medium: jade.medium.clone().map(veined), ..jade };
    Ok(stone(name, mesh, jade, sun(Vec3::new(0.3, 0.5, -1.0), 2.0), (80.0, 15.0)))
}

/// Builds the winged figure, 117 mm high, with parallel light from behind on the left.
pub(super) fn figure(name: &str) -> Result<Scene, SceneError> {
    Ok(stone(name, stored(FIGURE)?, marble(), sun(Vec3::new(-0.8, 0.35, -0.7), 2.0), (82.0, 12.0)))
}

/// Builds a scene of one body and one light, seen from `polar` degrees off the vertical and
/// `azimuth` degrees from +z towards +x.
fn stone(name: &str, mesh: Mesh, material: Material, light: Light, (polar, azimuth): (f32, f32)) -> Scene {
    let object = Object::new(name, mesh, material);
    Scene { lights: vec![light], ..framed(name, vec![object], direction(polar, azimuth)) }
}

/// Returns the bodies of a stored file as one mesh.
fn stored(file: &[u8]) -> Result<Mesh, SceneError> {
    let mut all = Mesh::default();
    gltf::parse(file, None)?.objects.iter().for_each(|object| all.append(&object.mesh));
    Ok(all)
}

/// Returns a directional light under which a white surface facing it has this radiance.
pub(super) fn sun(toward: Vec3, radiance: f32) -> Light {
    Light::Directional { toward: toward.normalize(), irradiance: Vec3::splat(radiance * PI) }
}
