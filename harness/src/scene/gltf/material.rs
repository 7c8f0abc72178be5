//! Materials of a file.

use ::gltf::json::Root;
use glam::Vec3;

use super::error::{GltfError, designation, excerpt, item};
use crate::scene::Material;

/// Material `index` of the file, which `user` refers to; glTF's default material without a number.
pub(super) fn read(root: &Root, index: Option<usize>, user: &str) -> Result<Material, GltfError> {
    let Some(index) = index else {
        return Ok(Material::standard());
    };
    let material = item(&root.materials, "material", index, || user.to_owned())?;
    let wrong = |problem: String| {
        let part = designation("material", index, material.name.as_deref());
        GltfError::part(part, problem)
    };

    let [red, green, blue, _] = material.pbr_metallic_roughness.base_color_factor.0;
    let color = [red, green, blue];
    if !color.iter().all(|part| (0.0..=1.0).contains(part)) {
        return Err(wrong(format!("its baseColorFactor is {color:?}, but each part must lie from 0 to 1")));
    }
    let extension = material.extensions.as_ref().and_then(|all| all.ior.as_ref());
    let ior = extension.map_or(Material::standard().ior, |ior| ior.ior.0);
    if ior == 0.0 {
        return Err(wrong(
            "its ior is 0, glTF's sign for a surface that reflects like a metal; a stone needs a \
             real refractive index, at least 1"
                .to_owned(),
        ));
    }
    if !(ior.is_finite() && ior >= 1.0) {
        return Err(wrong(format!("its ior is {ior}, but a refractive index must be finite and at least 1")));
    }
    Ok(Material {
        name: material.name.as_deref().map_or_else(|| format!("material {index}"), excerpt),
        base_color: Vec3::from_array(color),
        ior,
        ..Material::standard()
    })
}
