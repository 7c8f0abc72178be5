//! The scenes that come with the program.

use super::camera::direction;
use super::cuts::{
    BrilliantParameters, PrismParameters, StepCutParameters, octahedron, prism, round_brilliant, step_cut,
};
use super::polyhedron::{Polyhedron, Triangulation};
use super::{Averaging, Material, Mesh, Object, Scene, SceneError, gltf};
use framing::framed;
use list::{ALIASES, BUILT_IN, named};

mod framing;
pub(crate) mod list;
mod materials;
mod pave;
pub mod presets;
mod prisms;
mod stone;
mod translucent;
mod tray;
mod vitrine;

/// Viewing angles of brilliants, see [`scene`].
const BRILLIANT_ANGLES: (f32, f32) = (27.0, 11.0);

/// Builds the scene called `name`.
pub(super) fn build(name: &str) -> Result<Scene, SceneError> {
    let name = named(name).map_or(name, |scene| scene.name);
    match name {
        "brilliant" => brilliant(name, materials::diamond()),
        "sapphire" => brilliant(name, materials::sapphire()),
        "ruby" => brilliant(name, materials::ruby()),
        "quartz" => brilliant(name, materials::quartz()),
        "octahedron" => Ok(stone_scene(name, &octahedron()?, materials::diamond(), (65.0, 25.0))),
        "step_cut" => {
            let stone = step_cut(&StepCutParameters::EMERALD)?;
            Ok(stone_scene(name, &stone, materials::emerald(), (35.0, 20.0)))
        }
        "prism" => {
            let stone = prism(&PrismParameters::PENTAGONAL)?;
            Ok(stone_scene(name, &stone, materials::quartz(), (70.0, 10.0)))
        }
        "prism_chain" => Ok(scene(name, prisms::chain()?, materials::quartz(), (78.0, 12.0))),
        // From a little below, as one looks up at it, so that the inner rings show below the outer.
        "chandelier" => Ok(scene(name, prisms::chandelier()?, materials::flint_glass(), (105.0, 9.0))),
        "pave_ring" => pave::ring(name),
        "tray" => tray::tray(name),
        "solitaire" => tray::solitaire(name),
        "bunny_stone" => bunny_stone(name),
        "brilliant_fan" => diamond(name, Averaging::default(), Triangulation::Fan),
        "brilliant_strip" => diamond(name, Averaging::default(), Triangulation::Strip),
        "brilliant_sliver" => diamond(name, Averaging::default(), Triangulation::Sliver),
        "brilliant_area" => diamond(name, Averaging::Area, Triangulation::Centroid),
        "skin" | "wax" | "jade" => Ok(translucent::spheres(name)),
        "skin_ring" | "wax_ring" | "jade_ring" => Ok(translucent::ring(name)),
        "skin_bunny" | "wax_bunny" | "jade_bunny" => translucent::bunny(name),
        "head" | "skin_head" => translucent::head(name),
        "bunny" => stone::bunny(name),
        "dragon" => stone::dragon(name),
        "figure" => stone::figure(name),
        "vitrine" => vitrine::stored(name),
        "brilliant_plain" => diamond(name, Averaging::Plain, Triangulation::Centroid),
        _ => Err(SceneError::UnknownName { name: name.to_owned(), hint: hint(name) }),
    }
}

fn brilliant(name: &str, material: Material) -> Result<Scene, SceneError> {
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    Ok(stone_scene(name, &stone, material, BRILLIANT_ANGLES))
}

/// Builds the diamond brilliant from another mesh of the same surface.
fn diamond(name: &str, averaging: Averaging, triangulation: Triangulation) -> Result<Scene, SceneError> {
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    Ok(scene(name, stone.to_mesh_with(averaging, triangulation), materials::diamond(), BRILLIANT_ANGLES))
}

fn stone_scene(name: &str, stone: &Polyhedron, material: Material, angles: (f32, f32)) -> Scene {
    scene(name, stone.to_mesh(Averaging::default()), material, angles)
}

/// Builds a scene of one body, seen from `polar` degrees off the vertical and `azimuth` degrees
/// from +z towards +x.
fn scene(name: &str, mesh: Mesh, material: Material, (polar, azimuth): (f32, f32)) -> Scene {
    let object = Object::new(name, mesh, material);
    framed(name, vec![object], direction(polar, azimuth))
}

fn bunny_stone(name: &str) -> Result<Scene, SceneError> {
    let mut scene = gltf::parse(stone::BUNNY, None)?;
    for object in &mut scene.objects {
        object.material = materials::crown_glass();
    }
    Ok(framed(name, scene.objects, direction(75.0, 15.0)))
}

/// Returns the built-in whose name, or alias, is most like `name`.
fn hint(name: &str) -> String {
    let known = BUILT_IN.iter().map(|scene| scene.name).chain(ALIASES.iter().map(|(alias, _)| *alias));
    let near = crate::nearest::close(name, known).and_then(named);
    near.map_or(String::new(), |scene| format!(" (did you mean `{}`?)", scene.name))
}
