//! Cut stones, and stones of other forms, alone in the picture.

use super::framing::framed;
use super::{materials, stone};
use crate::camera::direction;
use crate::cuts::{
    BrilliantParameters, PrismParameters, StepCutParameters, octahedron, prism, round_brilliant, step_cut,
};
use crate::normals::Normals;
use crate::polyhedron::{Polyhedron, Triangulation};
use crate::{Averaging, Material, Mesh, Object, Scene, SceneError, gltf};

/// Viewing angles of brilliants, see [`seen`].
const BRILLIANT_ANGLES: (f32, f32) = (27.0, 11.0);

pub(super) fn brilliant(name: &str, material: Material) -> Result<Scene, SceneError> {
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    Ok(stone_scene(name, &stone, material, BRILLIANT_ANGLES))
}

/// Builds the diamond brilliant from another mesh of the same surface.
pub(super) fn diamond(name: &str, averaging: Averaging, triangulation: Triangulation) -> Result<Scene, SceneError> {
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY)?;
    Ok(seen(name, stone.to_mesh_with(averaging, triangulation), materials::diamond(), BRILLIANT_ANGLES))
}

fn stone_scene(name: &str, stone: &Polyhedron, material: Material, angles: (f32, f32)) -> Scene {
    seen(name, stone.to_mesh(Averaging::default()), material, angles)
}

/// Builds a scene of one body, seen from `polar` degrees off the vertical and `azimuth` degrees
/// from +z towards +x.
pub(super) fn seen(name: &str, mesh: Mesh, material: Material, (polar, azimuth): (f32, f32)) -> Scene {
    let object = Object::new(name, mesh, material);
    framed(name, vec![object], direction(polar, azimuth))
}

pub(super) fn bunny_stone(name: &str) -> Result<Scene, SceneError> {
    let mut scene = gltf::parse(stone::BUNNY, None)?;
    for object in &mut scene.objects {
        // Of its facets, so that ways to find them can be judged by it.
        object.material = Material { normals: Normals::Facets, ..materials::crown_glass() };
    }
    Ok(framed(name, scene.objects, direction(75.0, 15.0)))
}

pub(super) fn octahedron_of_diamond(name: &str) -> Result<Scene, SceneError> {
    Ok(stone_scene(name, &octahedron()?, materials::diamond(), (65.0, 25.0)))
}

pub(super) fn step_cut_emerald(name: &str) -> Result<Scene, SceneError> {
    Ok(stone_scene(name, &step_cut(&StepCutParameters::EMERALD)?, materials::emerald(), (35.0, 20.0)))
}

pub(super) fn pentagonal_prism(name: &str) -> Result<Scene, SceneError> {
    Ok(stone_scene(name, &prism(&PrismParameters::PENTAGONAL)?, materials::quartz(), (70.0, 10.0)))
}
