//! One scene with a body for each technique. Lengths are in millimetres; the top of the table is at
//! 0.

use glam::Vec3;
use std::f32::consts::PI;

use super::framing::VERTICAL_FOV;
use super::{materials, stone, translucent};
use crate::{
    BuiltInEnvironment, Camera, Density, Dispersion, Lacking, Light, Material, Medium, Object, Scene, SceneError, gltf,
};
use lapidary_veins::VeinsPattern;

/// The meshes, made by the program in `harness/assets/`.
const VITRINE: &[u8] = include_bytes!("../../../assets/vitrine.glb");

/// Girdle radii of the stones.
const DIAMOND: f32 = 17.0;
const RUBY: f32 = 13.5;
/// Scale of the chain relative to the built-in one: a link is 18 mm wide.
const CHAIN: f32 = 18.0;
/// Diameter of the jade ball.
const BALL: f32 = 19.0;

/// Builds the scene.
pub(super) fn stored(name: &str) -> Result<Scene, SceneError> {
    let meshes = gltf::parse(VITRINE, None)?.objects.into_iter().map(|object| object.mesh);
    let bodies = bodies().into_iter().zip(meshes);
    let objects = bodies.map(|((name, material), mesh)| Object::new(name, mesh, material)).collect();
    Ok(Scene {
        name: name.to_owned(),
        objects,
        lights: lights(),
        light_radii: Vec::new(),
        environment: BuiltInEnvironment::Studio,
        camera: camera(),
        lacking: Lacking::default(),
    })
}

/// Returns names and materials, in the order of the file.
fn bodies() -> [(&'static str, Material); 11] {
    let ruby = Material { dispersion: Dispersion::None, ..materials::ruby() };
    [
        ("table", materials::slate()),
        ("diamond", materials::sized(materials::diamond(), DIAMOND)),
        ("ruby", materials::sized(ruby, RUBY)),
        ("candle", paraffin()),
        ("figure", veined_marble()),
        ("prism_chain", materials::sized(materials::clear_glass(), CHAIN)),
        ("ball", Material { thickness: BALL, roughness: 0.25, ..translucent::material("jade") }),
        ("foot", materials::bronze()),
        ("post", materials::bronze()),
        ("arm", materials::bronze()),
        ("hook", materials::bronze()),
    ]
}

/// Paraffin wax, clearer than bleached wax. Its coefficients are chosen by eye.
fn paraffin() -> Material {
    let medium = Medium::isotropic(Vec3::new(0.36, 0.36, 0.35), Vec3::new(0.0008, 0.0022, 0.008));
    translucent::scattering("paraffin", medium, Vec3::new(0.9, 0.84, 0.72), (1.44, 0.35))
}

/// Marble with cloudy veins some 20 mm apart, which darken it where light comes through.
fn veined_marble() -> Material {
    let marble = stone::marble();
    let veined = |medium| Medium { density: Density::Veins(VEINS), ..medium };
    Material { name: "veined marble".to_owned(), medium: marble.medium.clone().map(veined), ..marble }
}

/// The marble's veins.
const VEINS: VeinsPattern =
    VeinsPattern { frequency: 0.055, width: 0.12, least: 0.5, greatest: 3.0, octaves: 2, seed: 8 };

/// A low sun behind the bodies, which shines through wax and marble, and a weak warm lamp before them.
fn lights() -> Vec<Light> {
    let sun = Vec3::new(-0.66, 0.55, -0.8).normalize();
    let lamp = Vec3::new(60.0, 170.0, 150.0);
    vec![
        Light::Directional { toward: sun, irradiance: 9.0 * PI * Vec3::new(1.0, 0.93, 0.84) },
        Light::Point { position: lamp, intensity: 20_000.0 * Vec3::new(1.0, 0.8, 0.6) },
    ]
}

/// A camera that suits pictures of 4:3 and square ones.
fn camera() -> Camera {
    Camera::upright(Vec3::new(12.0, 133.0, 376.0), Vec3::new(12.0, 57.0, 0.0), VERTICAL_FOV)
}

#[cfg(test)]
mod tests;
