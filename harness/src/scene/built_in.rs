//! The scenes that come with the program.

use glam::Vec3;

use super::cuts::{
    BrilliantParameters, PrismParameters, StepCutParameters, octahedron, prism, round_brilliant, step_cut,
};
use super::polyhedron::Polyhedron;
use super::{Averaging, Camera, Material, Object, Scene, SceneError, gltf, vertices};

/// A scene that needs no file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// What a user calls it.
    pub name: &'static str,
    /// What it is and what it is for, in one paragraph.
    pub description: &'static str,
}

/// All built-in scenes.
pub const BUILT_IN: [BuiltIn; 5] = [
    BuiltIn {
        name: "brilliant",
        description: "A diamond in the round brilliant cut with Tolkowsky's proportions: 73 facets with \
            the girdle's 16. Seen from 27° off the table's axis, so that pavilion facets show through \
            the table. The stone to judge internal reflection and fire by.",
    },
    BuiltIn {
        name: "octahedron",
        description: "A regular octahedron of diamond, the form of the rough crystal. Eight facets and \
            parallel opposite sides make every path inside easy to follow by hand.",
    },
    BuiltIn {
        name: "step_cut",
        description: "An emerald (beryl) in the step cut with cut corners: length to width 1.4, three \
            crown steps, three pavilion steps to a keel, 57 facets. Long parallel facets show the \
            straight flashes that a brilliant breaks up.",
    },
    BuiltIn {
        name: "prism",
        description: "A closed pentagonal prism of quartz with a pyramid at each end. No side has a \
            parallel opposite one, and at this low index much light leaves at the first hit.",
    },
    BuiltIn {
        name: "bunny_stone",
        description: "The Stanford bunny as a solid of glass with refractive index 1.5, 3674 triangles. \
            Concave: light leaves and enters again, which no convex method can follow.",
    },
];

/// Refractive index of diamond at the sodium D line, 589.3 nm (Peter 1923).
const DIAMOND: f32 = 2.41749;
/// Refractive index of beryl's ordinary ray, in the middle of what emeralds have.
const BERYL: f32 = 1.577;
/// Refractive index of quartz's ordinary ray at the sodium D line.
const QUARTZ: f32 = 1.54428;
/// Refractive index of crown glass, and glTF's default.
const GLASS: f32 = 1.5;

/// What light through an emerald is multiplied by, linear RGB: a vivid bluish green, by eye.
const EMERALD_GREEN: Vec3 = Vec3::new(0.16, 0.72, 0.42);

/// A short portrait lens: about 27° from edge to edge.
const VERTICAL_FOV: f32 = 0.47;

/// The bunny of the Stanford 3D Scanning Repository, decimated and closed.
const BUNNY: &[u8] = include_bytes!("../../assets/bunny.glb");

/// The scene called `name`.
pub(super) fn build(name: &str) -> Result<Scene, SceneError> {
    match name {
        "brilliant" => {
            let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
            Ok(stone_scene(name, &stone, clear("diamond", DIAMOND), (27.0, 11.0)))
        }
        "octahedron" => Ok(stone_scene(name, &octahedron()?, clear("diamond", DIAMOND), (65.0, 25.0))),
        "step_cut" => {
            let stone = step_cut(&StepCutParameters::EMERALD)?;
            let emerald = Material { base_color: EMERALD_GREEN, ..clear("beryl", BERYL) };
            Ok(stone_scene(name, &stone, emerald, (35.0, 20.0)))
        }
        "prism" => {
            let stone = prism(&PrismParameters::PENTAGONAL)?;
            Ok(stone_scene(name, &stone, clear("quartz", QUARTZ), (70.0, 10.0)))
        }
        "bunny_stone" => bunny(name),
        _ => Err(SceneError::UnknownName { name: name.to_owned(), nearest: nearest(name) }),
    }
}

/// One cut stone, seen from `polar` degrees off the vertical and `azimuth` degrees from +z towards +x.
fn stone_scene(name: &str, stone: &Polyhedron, material: Material, (polar, azimuth): (f32, f32)) -> Scene {
    let object = Object { name: name.to_owned(), mesh: stone.to_mesh(Averaging::default()), material };
    framed(name, vec![object], direction(polar, azimuth))
}

/// A colourless material.
fn clear(name: &str, ior: f32) -> Material {
    Material { name: name.to_owned(), ior, ..Material::standard() }
}

fn bunny(name: &str) -> Result<Scene, SceneError> {
    let mut scene = gltf::parse(BUNNY, None)?;
    for object in &mut scene.objects {
        object.material = clear("glass", GLASS);
    }
    Ok(framed(name, scene.objects, direction(75.0, 15.0)))
}

fn framed(name: &str, objects: Vec<Object>, toward_eye: Vec3) -> Scene {
    let camera = Camera::framing(vertices(&objects), toward_eye, VERTICAL_FOV);
    Scene { name: name.to_owned(), objects, camera }
}

pub(super) fn direction(polar: f32, azimuth: f32) -> Vec3 {
    let (across, along) = polar.to_radians().sin_cos();
    let (x, z) = azimuth.to_radians().sin_cos();
    Vec3::new(across * x, along, across * z)
}

/// The built-in name most like `name`.
fn nearest(name: &str) -> &'static str {
    crate::nearest::nearest(name, BUILT_IN.iter().map(|scene| scene.name)).map_or("", |(_, name)| name)
}
