//! Materials of a file: base colour, roughness, `KHR_materials_ior`, `KHR_materials_transmission`,
//! `KHR_materials_volume`, `KHR_materials_dispersion`, `KHR_materials_diffuse_transmission`, the archived
//! `KHR_materials_pbrSpecularGlossiness`, `WEBGI_materials_diamond` (`gltf/diamond.rs`), and
//! `extras.lapidary` for properties that glTF cannot express (`gltf/extras.rs`). Textures are read by
//! `gltf/texture.rs`. All other properties of a material are listed by `gltf/survey.rs`.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use ::gltf::json::Root;
use ::gltf::json::material::{AlphaMode, Material as JsonMaterial};
use ::gltf::json::texture::Info;
use ::gltf::json::validation::Checked;
use glam::Vec3;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::diamond::Diamond;
use super::error::{GltfError, designation, excerpt, item};
use super::extension::Extension;
use super::extras;
use super::medium;
use super::specular_glossiness::{self, Factors};
use super::texture::{Reference, Shortfall, Textures};
use crate::{Coverage, Dispersion, Material, TextureSlot};

/// Extensions whose specifications forbid combining them with any of [`OF_PHYSICAL_SHADING`].
const OF_OTHER_SHADING: [&str; 2] = ["KHR_materials_unlit", specular_glossiness::NAME];

/// Extensions of the metallic-roughness material.
const OF_PHYSICAL_SHADING: [&str; 11] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
];

/// Materials of a file. Each is read once, when a primitive first uses it: a small file may refer
/// very often to a material with large extras.
#[derive(Debug)]
pub(super) struct Materials<'a> {
    root: &'a Root,
    textures: Textures<'a>,
    known: BTreeMap<usize, Known>,
}

/// A material that a primitive uses.
#[derive(Debug)]
pub(super) struct Known {
    /// The material without textures.
    pub(super) plain: Material,
    /// The material with its textures; `None` until a primitive with texture coordinates uses it.
    pub(super) textured: Option<Material>,
    /// What is not drawn of its textures.
    pub(super) lacking: Vec<Shortfall>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(root: &'a Root, textures: Textures<'a>) -> Self {
        Self { root, textures, known: BTreeMap::new() }
    }

    /// Returns material `index` of the file, which `user` refers to; for `None`, glTF's default
    /// material. It comes with its textures if the user has texture coordinates.
    pub(super) fn get(
        &mut self,
        index: Option<usize>,
        has_coordinates: bool,
        user: &str,
    ) -> Result<Material, GltfError> {
        let Some(index) = index else {
            return Ok(Material { metallic: 1.0, ..Material::standard() });
        };
        let json = item(&self.root.materials, "material", index, || user.to_owned())?;
        let part = || designation("material", index, json.name.as_deref());
        let wrong = |problem: String| GltfError::part(part(), problem);
        let known = match self.known.entry(index) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => {
                let mut plain = read(json).map_err(wrong)?;
                plain.name = json.name.as_deref().map_or_else(|| format!("material {index}"), excerpt);
                place.insert(Known { plain, textured: None, lacking: Vec::new() })
            }
        };
        if !has_coordinates {
            return Ok(known.plain.clone());
        }
        if let Some(material) = &known.textured {
            return Ok(material.clone());
        }
        let mut material = known.plain.clone();
        for reference in references(json).map_err(wrong)? {
            if material.calls_for(reference.slot) {
                *material.texture_mut(reference.slot) = self.textures.get(reference, &part(), &mut known.lacking)?;
            }
        }
        Ok(known.textured.insert(material).clone())
    }

    /// Returns what a vendor's mark says of the stone of material `index`, which was read.
    pub(super) fn diamond(&self, index: Option<usize>) -> Option<Diamond> {
        let json = index.and_then(|index| self.root.materials.get(index))?;
        Diamond::of(extensions(json)).ok().flatten()
    }

    /// Materials read so far, with their index and JSON.
    pub(super) fn read(&self) -> impl Iterator<Item = (usize, &'a JsonMaterial, &Known)> {
        let root = self.root;
        self.known.iter().map(move |(&index, known)| (index, &root.materials[index], known))
    }
}

/// References of a material to textures that are read.
fn references(json: &JsonMaterial) -> Result<Vec<Reference<'_>>, String> {
    let mut found = Vec::new();
    if Diamond::of(extensions(json))?.is_some() {
        return Ok(found);
    }
    let archived = Extension::of(extensions(json), specular_glossiness::NAME)?;
    if let Some(value) = archived.member(specular_glossiness::DIFFUSE_TEXTURE) {
        found.push(reference(TextureSlot::BaseColor, specular_glossiness::DIFFUSE_TEXTURE, value)?);
    } else if let (Some(info), false) = (&json.pbr_metallic_roughness.base_color_texture, archived.is_there()) {
        found.push(of_core(TextureSlot::BaseColor, info));
    }
    if let (Some(info), false) = (&json.pbr_metallic_roughness.metallic_roughness_texture, archived.is_there()) {
        found.push(of_core(TextureSlot::MetallicRoughness, info));
    }
    if let Some(info) = &json.normal_texture {
        let extensions = info.extensions.as_ref().map(|all| &all.others);
        found.push(Reference { slot: TextureSlot::Normal, index: info.index.value(), set: info.tex_coord, extensions });
    }
    for (name, slot) in [
        ("KHR_materials_volume", TextureSlot::Thickness),
        ("KHR_materials_transmission", TextureSlot::Transmission),
        ("KHR_materials_diffuse_transmission", TextureSlot::DiffuseTransmission),
    ] {
        let Some(value) = Extension::of(extensions(json), name)?.member(slot.name()) else { continue };
        found.push(reference(slot, slot.name(), value)?);
    }
    Ok(found)
}

/// Returns core glTF's reference to a texture.
fn of_core(slot: TextureSlot, info: &Info) -> Reference<'_> {
    let extensions = info.extensions.as_ref().map(|all| &all.others);
    Reference { slot, index: info.index.value(), set: info.tex_coord, extensions }
}

/// Reads an extension's reference to a texture from its member `name`.
fn reference<'a>(slot: TextureSlot, name: &str, value: &'a Value) -> Result<Reference<'a>, String> {
    let info = Info::deserialize(value)
        .map_err(|error| format!("its {name} is not valid glTF: {}; export it again", excerpt(&error.to_string())))?;
    let extensions = value.get("extensions").and_then(Value::as_object);
    Ok(Reference { slot, index: info.index.value(), set: info.tex_coord, extensions })
}

/// Extensions of a material, by name.
pub(super) fn extensions(json: &JsonMaterial) -> Option<&Map<String, Value>> {
    json.extensions.as_ref().map(|all| &all.others)
}

/// Reads a material, without its name; the error describes the problem.
fn read(json: &JsonMaterial) -> Result<Material, String> {
    let all = extensions(json);
    exclusive(all)?;
    let mut material = surface(json)?;

    let ior = Extension::of(all, "KHR_materials_ior")?.number("ior")?;
    material.transmission =
        Extension::of(all, "KHR_materials_transmission")?.share("transmissionFactor")?.unwrap_or(0.0);
    let diffuse = Extension::of(all, "KHR_materials_diffuse_transmission")?;
    material.diffuse_transmission = diffuse.share("diffuseTransmissionFactor")?.unwrap_or(0.0);
    if let Some(color) = diffuse.color("diffuseTransmissionColorFactor")? {
        material.diffuse_transmission_color = color;
    }
    volume(Extension::of(all, "KHR_materials_volume")?, &mut material)?;

    if let Some(ior) = ior {
        material.ior = nearest_index(ior);
    }
    let dispersion = Extension::of(all, "KHR_materials_dispersion")?.number("dispersion")?;
    if let Some(dispersion) = dispersion {
        let single = dispersion as f32;
        if !(dispersion >= 0.0 && single.is_finite()) {
            return Err(format!("its dispersion is {dispersion:?}, but must be at least 0 and finite: 20/V_d"));
        }
        if single > 0.0 {
            material.dispersion = Dispersion::Abbe(single);
        }
    }
    if let Some(extras) = extras::lapidary(json)? {
        extras.apply(&mut material, ior, dispersion)?;
    }
    if let Some(diamond) = Diamond::of(all)? {
        diamond.apply(&mut material);
        return Ok(material);
    }
    if material.medium.is_none() {
        material.medium = medium::derived(&material)?;
    }
    if !material.is_opaque() || material.diffuse_transmission > 0.0 {
        // glTF's default is 1, and files of clear bodies leave it out.
        material.metallic = 0.0;
    }
    Ok(material)
}

/// Returns the factors of core glTF, or those that its archived form of a material amounts to.
pub(super) fn factors(json: &JsonMaterial) -> Result<Factors, String> {
    let archived = Extension::of(extensions(json), specular_glossiness::NAME)?;
    if archived.is_there() {
        return specular_glossiness::factors(archived);
    }
    let core = &json.pbr_metallic_roughness;
    let (metallic, roughness) = (core.metallic_factor.0, core.roughness_factor.0);
    Ok(Factors { base_color: core.base_color_factor.0, metallic, roughness })
}

/// Reads the surface properties of core glTF, without extensions.
fn surface(json: &JsonMaterial) -> Result<Material, String> {
    let Factors { base_color: [red, green, blue, alpha], metallic, roughness } = factors(json)?;
    for (name, factor) in [("roughnessFactor", roughness), ("metallicFactor", metallic)] {
        if !(0.0..=1.0).contains(&factor) {
            return Err(format!("its {name} is {factor:?}, but must lie from 0 to 1"));
        }
    }
    let color = [red, green, blue];
    if !color.iter().all(|part| (0.0..=1.0).contains(part)) {
        return Err(format!("its baseColorFactor is {color:?}, but each part must lie from 0 to 1"));
    }
    let cutoff = json.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
    let coverage = match json.alpha_mode {
        Checked::Invalid => return Err("its alphaMode is not one of glTF's, OPAQUE, MASK and BLEND".to_owned()),
        Checked::Valid(AlphaMode::Opaque) => None,
        Checked::Valid(AlphaMode::Mask) => Some(Coverage { share: alpha, cutoff: Some(cutoff) }),
        Checked::Valid(AlphaMode::Blend) => Some(Coverage { share: alpha, cutoff: None }),
    };
    if coverage.is_some_and(|coverage| !coverage.is_sound()) {
        return Err(format!("its alpha is {alpha:?} and its alphaCutoff {cutoff:?}; give 0 to 1, and at least 0"));
    }
    let normal_scale = json.normal_texture.as_ref().map_or(1.0, |texture| texture.scale);
    if !normal_scale.is_finite() {
        return Err("the scale of its normalTexture is not finite in single precision; mend it".to_owned());
    }
    let double_sided = json.double_sided;
    let base_color = Vec3::from_array(color);
    Ok(Material { base_color, metallic, coverage, normal_scale, roughness, double_sided, ..Material::standard() })
}

fn volume(volume: Extension<'_>, material: &mut Material) -> Result<(), String> {
    if let Some(thickness) = volume.number("thicknessFactor")? {
        let single = thickness as f32;
        if !(thickness >= 0.0 && single.is_finite()) {
            return Err(format!(
                "its thicknessFactor is {thickness:?}, but must be at least 0 (a thin wall) and finite in single precision"
            ));
        }
        material.thickness = single;
    }
    if let Some(color) = volume.color("attenuationColor")? {
        material.attenuation_color = color;
    }
    if let Some(distance) = volume.number_or_null("attenuationDistance")? {
        // A GPU may flush a subnormal distance to 0.
        let single = distance as f32;
        if !(single.is_finite() && single >= f32::MIN_POSITIVE) {
            return Err(format!(
                "its attenuationDistance is {distance:?}, but must be above 0 and finite in single precision; \
                 leave it out if the body absorbs nothing"
            ));
        }
        material.attenuation_distance = single;
    }
    Ok(())
}

/// Refuses extensions that exclude one another.
fn exclusive(all: Option<&Map<String, Value>>) -> Result<(), String> {
    let first =
        |names: &[&'static str]| names.iter().copied().find(|name| all.is_some_and(|all| all.contains_key(*name)));
    match (first(&OF_OTHER_SHADING), first(&OF_PHYSICAL_SHADING)) {
        (Some(other), Some(physical)) => {
            Err(format!("its {other} excludes its {physical}, by glTF's rules; remove one of them"))
        }
        _ => Ok(()),
    }
}

/// Returns the nearest index that can be drawn. glTF's 0 stands for a surface that reflects all light, as an infinite index does.
pub(super) fn nearest_index(ior: f64) -> f32 {
    if ior == 0.0 { Material::LARGEST_INDEX } else { (ior as f32).clamp(1.0, Material::LARGEST_INDEX) }
}
