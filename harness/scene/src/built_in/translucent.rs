//! Skin, wax and jade: spheres of decreasing radius, a torus and the bunny. Lengths are in
//! millimetres.

use glam::{DQuat, DVec3, Vec3};
use std::f32::consts::PI;

use super::framing::framed;
use crate::camera::direction;
use crate::surfaces::{sphere, torus};
use crate::{Bounds, Camera, Light, Lobe, Material, Medium, Mesh, Object, Scene, SceneError, gltf};

/// Skin: skin1 of Jensen, Marschner, Levoy and Hanrahan, "A Practical Model for Subsurface Light
/// Transport" (2001).
fn skin() -> Material {
    scattering(
        "skin",
        Medium::isotropic(Vec3::new(0.74, 0.88, 1.01), Vec3::new(0.032, 0.17, 0.48)),
        Vec3::new(0.625, 0.385, 0.241),
        (1.4, 0.45),
    )
}

/// Bleached wax. Its coefficients are chosen by eye, between Jensen's marble and whole milk.
fn wax() -> Material {
    scattering(
        "wax",
        Medium::isotropic(Vec3::new(1.2, 1.2, 1.1), Vec3::new(0.003, 0.006, 0.02)),
        Vec3::new(0.891, 0.850, 0.735),
        (1.44, 0.35),
    )
}

/// Green jade (jadeite), polished. Its coefficients are chosen by eye.
pub(super) fn jade() -> Material {
    scattering(
        "jade",
        Medium::isotropic(Vec3::new(0.8, 1.2, 0.9), Vec3::new(0.12, 0.02, 0.08)),
        Vec3::new(0.428, 0.745, 0.515),
        (1.66, 0.0),
    )
}

/// Builds a scattering material; `base_color` is the diffuse reflectance of a half space of the
/// medium.
pub(super) fn scattering(name: &str, medium: Medium, base_color: Vec3, (ior, roughness): (f32, f32)) -> Material {
    Material { name: name.to_owned(), base_color, ior, roughness, medium: Some(medium), ..Material::standard() }
}

/// Radii of the spheres, and the gap between two.
const RADII: [f64; 5] = [40.0, 24.0, 14.0, 8.0, 5.0];
const GAP: f64 = 3.0;

/// Returns the material that a scene's name begins with. Its `sigma0` is the width that random
/// walks through spheres of ten mean free paths give: docs/cdrf.md.
pub(super) fn material(name: &str) -> Material {
    let (material, sigma0) = match name.split('_').next() {
        Some("skin") => (skin(), Vec3::new(5.8, 3.8, 2.3)),
        Some("wax") => (wax(), Vec3::new(4.0, 4.0, 4.1)),
        _ => (jade(), Vec3::new(4.6, 3.9, 4.5)),
    };
    Material { sigma0: Some(sigma0), ..material }
}

/// Builds the paper's picture: spheres of decreasing radius in a descending row, lit from the upper
/// left.
pub(super) fn spheres(name: &str) -> Scene {
    // Along a line perpendicular to the light, so that none shadows another.
    let line = DVec3::new(1.0, 1.0, 0.0).normalize();
    let mut along = 0.0;
    let objects = RADII.map(|radius| {
        let centre = (along + radius) * line;
        along += 2.0 * radius + GAP;
        object(&format!("{radius} mm"), sphere(radius, 128).placed(DQuat::IDENTITY, centre), name)
    });
    Scene { lights: vec![sun(Vec3::new(-1.0, 1.0, 0.35))], ..framed(name, objects.into(), direction(90.0, 0.0)) }
}

/// Builds a ring with a sun, a warm lamp near its inner side and a cool one behind.
pub(super) fn ring(name: &str) -> Scene {
    let lights = vec![
        sun(Vec3::new(-0.7, 0.6, 0.2)),
        Light::Point { position: Vec3::new(4.0, 14.0, 0.0), intensity: 120.0 * Vec3::new(1.0, 0.75, 0.5) },
        Light::Point { position: Vec3::new(45.0, 15.0, -40.0), intensity: 2000.0 * Vec3::new(0.5, 0.7, 1.0) },
    ];
    let mesh = torus(20.0, 7.0, 160, 64);
    Scene { lights, ..framed(name, vec![object("ring", mesh, name)], direction(48.0, 0.0)) }
}

/// The bunny, 60 mm high, with texture coordinates in an atlas and halos around its charts: made by
/// the program in `harness/assets/`.
const BUNNY_ATLAS: &[u8] = include_bytes!("../../../assets/bunny_atlas.glb");
/// Number of the bunny's triangles; the file's other triangles are halos.
const TRIANGLES: usize = 3674;

/// Builds the Stanford bunny, 60 mm high, with one light.
pub(super) fn bunny(name: &str) -> Result<Scene, SceneError> {
    let parsed = gltf::parse(BUNNY_ATLAS, None)?;
    let meshes = parsed.objects.into_iter().map(|mut found| {
        let halo = found.mesh.indices.split_off((3 * TRIANGLES).min(found.mesh.indices.len()));
        Mesh { halo, ..found.mesh }
    });
    let objects = meshes.map(|mesh| object("bunny", mesh, name)).collect();
    Ok(Scene { lights: vec![sun(Vec3::new(-0.85, 0.45, 0.1))], ..framed(name, objects, direction(80.0, 10.0)) })
}

/// Lee Perry-Smith's head, with its colour and its slopes as images.
const HEAD: &[u8] = include_bytes!("../../../assets/head.glb");
/// Height of the bust in millimetres.
const HEAD_HEIGHT: f32 = 380.0;

/// Builds the head, lit from the side, so that the terminator runs over the face, with a weaker cool light from
/// behind: as `head` with its images, as `skin_head` of skin that is the same everywhere.
pub(super) fn head(name: &str) -> Result<Scene, SceneError> {
    let parsed = gltf::parse(HEAD, None)?;
    let objects = parsed.objects.into_iter().map(|found| {
        let of_file = found.material;
        let material = match name {
            // The image holds the diffuse reflectance.
            "head" => Material {
                base_color: of_file.base_color,
                base_color_texture: of_file.base_color_texture,
                normal_texture: of_file.normal_texture,
                normal_scale: of_file.normal_scale,
                // A film of oil over rougher skin; chosen by eye.
                second_lobe: Some(Lobe { roughness: 0.33, weight: 0.3 }),
                ..material("skin")
            },
            _ => material("skin"),
        };
        Object::new("head", sized(found.mesh, HEAD_HEIGHT), material)
    });
    let rim = Light::Directional {
        toward: Vec3::new(-0.7, 0.35, -0.6).normalize(),
        irradiance: 0.5 * PI * Vec3::new(0.7, 0.85, 1.0),
    };
    let key = Light::Directional {
        toward: Vec3::new(0.85, 0.45, 0.35).normalize(),
        irradiance: 1.2 * PI * Vec3::new(1.0, 0.95, 0.88),
    };
    // The face, and not the whole bust.
    let middle = Vec3::new(0.0, 70.0, 10.0);
    let camera = Camera::upright(middle + 1000.0 * direction(86.0, 22.0), middle, 0.28);
    Ok(Scene { lights: vec![key, rim], camera, ..framed(name, objects.collect(), direction(86.0, 22.0)) })
}

/// Returns a directional light under which a white surface facing it has radiance 0.6.
fn sun(toward: Vec3) -> Light {
    Light::Directional { toward: toward.normalize(), irradiance: Vec3::splat(0.6 * PI) }
}

fn object(name: &str, mesh: Mesh, scene: &str) -> Object {
    Object::new(name, mesh, material(scene))
}

/// Scales the mesh to this height.
pub(super) fn sized(mut mesh: Mesh, height: f32) -> Mesh {
    let bounds = Bounds::of(mesh.positions.iter().copied());
    let scale = height / (bounds.max.y - bounds.min.y);
    for position in &mut mesh.positions {
        *position = scale * (*position - bounds.centre());
    }
    mesh
}
