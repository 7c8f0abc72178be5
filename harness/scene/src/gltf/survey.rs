//! Survey of the visible part of a file for features that are not drawn.

use std::collections::BTreeSet;

use ::gltf::Semantic;
use ::gltf::json::Root;
use ::gltf::json::accessor::Type;
use ::gltf::json::material::{AlphaMode, Material as JsonMaterial};
use ::gltf::json::mesh::{Mode, Primitive};
use ::gltf::json::validation::Checked;
use serde_json::{Map, Value};

use super::diamond::{Diamond, NAME as DIAMOND};
use super::error::excerpt;
use super::extension::Extension;
use super::limits::{KNOWN_EXTENSIONS, NOT_DRAWN};
use super::material::{self, Known, Materials, extensions, nearest_index};
use super::nodes::ShownNode;
use super::texture::FACTOR;
use super::{animation, extras, instances, light_node, specular_glossiness};
use crate::lacking::{Lacking, Matter, User};
use crate::{Material, Opening, TextureSlot};

/// Lists all unsupported features of the file, of whose bodies each has the material `of_bodies` says. Its references are known to
/// be valid.
pub(super) fn lacking(
    root: &Root,
    nodes: &[ShownNode<'_>],
    materials: &Materials<'_>,
    of_bodies: Vec<Matter>,
    opening: &Opening,
) -> Lacking {
    let mut lacking = Lacking::in_bodies(of_bodies);
    let mut meshes = BTreeSet::new();
    for node in nodes {
        self::node(root, node, &mut lacking);
        meshes.extend(node.node.mesh.map(|mesh| mesh.value()));
    }
    for (index, mesh) in meshes.into_iter().filter_map(|index| Some((index, root.meshes.get(index)?))) {
        let user = user("mesh", index, mesh.name.as_deref());
        unknown_extensions(mesh.extensions.as_ref().map(|all| &all.others), &user, &mut lacking);
        mesh.primitives.iter().for_each(|primitive| self::primitive(root, primitive, &user, &mut lacking));
    }
    for (index, json, known) in materials.read() {
        let user = user("material", index, json.name.as_deref()).of(Some(index));
        textures(json, known, &user, &mut lacking);
        surface(json, &known.plain, &user, &mut lacking);
        inside(json, &known.plain, &user, &mut lacking);
    }
    cameras(root, nodes, opening, &mut lacking);
    if !root.animations.is_empty() && (opening.time.is_none() || !animation::moves_nodes(root)) {
        let instead = match opening.time {
            None => "bodies are drawn at rest",
            Some(_) => "none moves a node; bodies are drawn at rest",
        };
        lacking.note("animations", root.animations.len().to_string(), instead, &User::file());
    }
    let is_known = |name: &str| KNOWN_EXTENSIONS.contains(&name) || NOT_DRAWN.iter().any(|(known, _)| *known == name);
    for name in root.extensions_used.iter().filter(|name| !is_known(name)) {
        if !lacking.has(EXTENSIONS, &quoted(name)) {
            lacking.note(EXTENSIONS, quoted(name), "not known", &User::file());
        }
    }
    lacking
}

const EXTENSIONS: &str = "extensions";

/// Returns a part of the file that uses a feature.
fn user(kind: &'static str, index: usize, name: Option<&str>) -> User {
    User { kind, index, name: name.map(excerpt), of: None }
}

/// Quotes a name from the file.
fn quoted(name: &str) -> String {
    format!("`{}`", excerpt(name))
}

fn unknown_extensions(all: Option<&Map<String, Value>>, user: &User, lacking: &mut Lacking) {
    let names = all.into_iter().flat_map(Map::keys);
    for name in names.filter(|name| !KNOWN_EXTENSIONS.contains(&name.as_str())) {
        let instead = NOT_DRAWN.iter().find(|(known, _)| known == name).map_or("not known", |(_, instead)| instead);
        lacking.note(EXTENSIONS, quoted(name), instead, user);
    }
}

fn node(root: &Root, shown: &ShownNode<'_>, lacking: &mut Lacking) {
    let user = &user("node", shown.index, shown.node.name.as_deref());
    let all = shown.node.extensions.as_ref().map(|all| &all.others);
    unknown_extensions(all, user, lacking);
    if shown.node.skin.is_some() {
        lacking.note("skins", "`skin`".to_owned(), "the body is drawn at rest", user);
    }
    if shown.node.mesh.is_none() && all.is_some_and(|all| all.contains_key(instances::NAME)) {
        lacking.note("instances", quoted(instances::NAME), "the node has no mesh", user);
    }
    let attributes = instances::attributes(shown).ok().flatten();
    // A leading underscore marks application-specific attributes.
    let known = |name: &&String| instances::PLACING.contains(&name.as_str()) || name.starts_with('_');
    for name in attributes.into_iter().flat_map(Map::keys).filter(|name| !known(name)) {
        lacking.note("instances", quoted(name), "all instances look alike", user);
    }
    if let Some((index, light)) = light_node::of_node(root, shown) {
        let is_near = light.get("type").and_then(Value::as_str) != Some("directional");
        if is_near && light.get("range").is_some() {
            let user = &self::user("light", index, light.get("name").and_then(Value::as_str));
            lacking.note("lights", "`range`".to_owned(), "light falls off by the square of the distance alone", user);
        }
    }
}

const COLORS: &str = "vertex colours";

fn primitive(root: &Root, primitive: &Primitive, mesh: &User, lacking: &mut Lacking) {
    let modes = [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan];
    if !modes.into_iter().any(|mode| primitive.mode == Checked::Valid(mode)) {
        lacking.note("points and lines", "a primitive".to_owned(), "triangles alone are drawn", mesh);
        return;
    }
    unknown_extensions(primitive.extensions.as_ref().map(|all| &all.others), mesh, lacking);
    let has = |wanted: &dyn Fn(&Semantic) -> bool| {
        primitive.attributes.keys().any(|semantic| matches!(semantic, Checked::Valid(semantic) if wanted(semantic)))
    };
    if has(&|semantic| matches!(semantic, Semantic::Colors(1..))) {
        lacking.note(COLORS, "`COLOR_n` after the first".to_owned(), "the first is drawn alone", mesh);
    }
    let of_material = mesh.of(primitive.material.map(|index| index.value()));
    let material = primitive.material.and_then(|index| root.materials.get(index.value()));
    let colors = primitive.attributes.iter().find(|(semantic, _)| **semantic == Checked::Valid(Semantic::Colors(0)));
    let accessor = colors.and_then(|(_, index)| root.accessors.get(index.value()));
    let has_alpha = accessor.is_some_and(|accessor| accessor.type_ == Checked::Valid(Type::Vec4));
    if has_alpha && material.is_some_and(|material| material.alpha_mode != Checked::Valid(AlphaMode::Opaque)) {
        lacking.note("alpha", "alpha of `COLOR_0`".to_owned(), "the material's is drawn alone", &of_material);
    }
    let mut textures = material.into_iter().flat_map(texture_members);
    if !has(&|semantic| *semantic == Semantic::TexCoords(0)) && textures.any(is_read) {
        lacking.note(TEXTURES, "a missing `TEXCOORD_0`".to_owned(), "factors are drawn alone", &of_material);
    }
    if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
        lacking.note("morph targets", "`targets`".to_owned(), "the body is drawn without them", mesh);
    }
}

fn textures(json: &JsonMaterial, known: &Known, user: &User, lacking: &mut Lacking) {
    for name in texture_members(json).filter(|name| !is_read(name)) {
        lacking.note(TEXTURES, quoted(name), FACTOR, user);
    }
    for (what, instead) in &known.lacking {
        lacking.note(TEXTURES, what.clone(), instead, user);
    }
}

const TEXTURES: &str = "textures";

/// Whether textures of this member are read.
fn is_read(member: &str) -> bool {
    member == specular_glossiness::DIFFUSE_TEXTURE || TextureSlot::ALL.iter().any(|slot| slot.name() == member)
}

/// Names of the members of a material that refer to textures.
fn texture_members(json: &JsonMaterial) -> impl Iterator<Item = &str> {
    let factors = &json.pbr_metallic_roughness;
    let of_core = [
        (factors.base_color_texture.is_some(), "baseColorTexture"),
        (factors.metallic_roughness_texture.is_some(), "metallicRoughnessTexture"),
        (json.normal_texture.is_some(), "normalTexture"),
        (json.occlusion_texture.is_some(), "occlusionTexture"),
        (json.emissive_texture.is_some(), "emissiveTexture"),
    ];
    let of_core = of_core.into_iter().filter_map(|(is_there, name)| is_there.then_some(name));
    let read = extensions(json).into_iter().flatten().filter(|(name, _)| KNOWN_EXTENSIONS.contains(&name.as_str()));
    let members = read.filter_map(|(_, extension)| extension.as_object()).flat_map(Map::keys);
    of_core.chain(members.map(String::as_str).filter(|member| member.ends_with("Texture")))
}

/// Lists the properties of a surface that are not drawn.
fn surface(json: &JsonMaterial, material: &Material, user: &User, lacking: &mut Lacking) {
    unknown_extensions(extensions(json), user, lacking);
    let factors = &json.pbr_metallic_roughness;
    unknown_extensions(factors.extensions.as_ref().map(|all| &all.others), user, lacking);

    // 1 is also the default if a file omits the member, as files of clear bodies do.
    let metallic = material::factors(json).map_or(0.0, |factors| factors.metallic);
    if metallic > 0.0 && metallic < 1.0 && !material.is_metal() {
        lacking.note("metal", "`metallicFactor` above 0".to_owned(), "drawn without metal", user);
    }
    if let Ok(Some(diamond)) = Diamond::of(extensions(json))
        && material.ior != diamond.index as f32
    {
        let what = format!("`refractiveIndex` {:?}", diamond.index);
        lacking.note("index of refraction", what, if material.ior == 1.0 { "drawn as 1" } else { "drawn as 4" }, user);
    }
    let ior = Extension::of(extensions(json), "KHR_materials_ior").and_then(|ior| ior.number("ior")).ok().flatten();
    // A vendor's mark gives an index of its own.
    let is_marked = extensions(json).is_some_and(|all| all.contains_key(DIAMOND));
    let is_drawn = |ior: &f64| is_marked || nearest_index(*ior) == *ior as f32;
    if let Some(ior) = ior.filter(|ior| !is_drawn(ior)) {
        let instead = if nearest_index(ior) == 1.0 { "drawn as 1" } else { "drawn as 4" };
        lacking.note("index of refraction", format!("`ior` {ior:?}"), instead, user);
    }
    if json.emissive_factor.0.iter().any(|part| *part != 0.0) {
        lacking.note("emission", "`emissiveFactor`".to_owned(), "nothing shines by itself", user);
    }
    for name in extras::unknown(json) {
        lacking.note("extras", format!("{} in `extras.lapidary`", quoted(&name)), "not known", user);
    }
}

/// Lists the effects behind a material's surface that are not drawn.
fn inside(json: &JsonMaterial, material: &Material, user: &User, lacking: &mut Lacking) {
    let is_share = |factor: f32| factor > 0.0 && factor < 1.0;
    let &Material { transmission, diffuse_transmission, .. } = material;
    let mut note = |kind, what: &str, instead| lacking.note(kind, what.to_owned(), instead, user);
    if transmission > 0.0 && material.scatters() {
        return note(
            "transmission",
            "`transmissionFactor` beside scattering",
            "light that goes straight through is not drawn",
        );
    }
    // In a wholly clear body all light passes straight through, and glTF applies that first.
    let diffuse = "diffuse transmission";
    if diffuse_transmission > 0.0 && is_share(transmission) {
        note(diffuse, "`diffuseTransmissionFactor` beside a transmission", "not drawn");
    } else if diffuse_transmission > 0.0 && transmission == 0.0 {
        match &material.medium {
            Some(_) => {}
            None if material.thickness == 0.0 => {
                note(diffuse, "`diffuseTransmissionFactor` without a thickness", "a thin wall is drawn opaque");
            }
            None => {
                note(diffuse, "`diffuseTransmissionFactor` without an attenuation that scatters", "drawn opaque");
            }
        }
    }
    if material.absorbs() && transmission == 0.0 && diffuse_transmission == 0.0 && material.medium.is_none() {
        note("attenuation", "`KHR_materials_volume`", "no light gets in without a transmission");
    }
    let has = |name: &str| extensions(json).is_some_and(|all| all.contains_key(name));
    if material.dispersion != crate::Dispersion::None && has("KHR_materials_dispersion") && !has("KHR_materials_volume")
    {
        note("dispersion", "`KHR_materials_dispersion` without a volume", "a thin wall disperses nothing");
    }
}

fn cameras(root: &Root, nodes: &[ShownNode<'_>], opening: &Opening, lacking: &mut Lacking) {
    let of_nodes = nodes.iter().filter_map(|node| node.node.camera.map(|camera| camera.value()));
    let mut has_first = opening.camera.is_none();
    for (index, camera) in of_nodes.filter_map(|index| Some((index, root.cameras.get(index)?))) {
        let user = &user("camera", index, camera.name.as_deref());
        unknown_extensions(camera.extensions.as_ref().map(|all| &all.others), user, lacking);
        if opening.camera.is_none() && !std::mem::replace(&mut has_first, false) {
            lacking.note("cameras", "a view after the first".to_owned(), "the scene is seen through the first", user);
        }
    }
}
