//! Writer for scenes as binary glTF 2.0.

use std::collections::BTreeSet;

use glam::{Mat3, Quat, Vec2, Vec3};
use serde_json::{Value, json};
use thiserror::Error;

use super::gltf::{COLORING, INSTANCING, TEXTURE_TRANSFORM};
use super::{Bounds, BuiltInEnvironment, Camera, Copies, Material, Object, Place, Scene};

mod light;
mod material;
mod problem;
mod texture;

/// Reason why a scene cannot be written. In that case no bytes are produced.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GlbError {
    /// The scene is empty, which glTF cannot represent.
    #[error("the scene has no objects, which glTF cannot say; add one")]
    Empty,
    /// The camera's position, direction or field of view is invalid.
    #[error("the camera is not finite, or its field of view not above 0 and below 180°; mend it")]
    Camera,
    /// The lists of a mesh are inconsistent, or contain values that glTF forbids.
    #[error("object {object:?} cannot be written as glTF: {problem}")]
    Object {
        /// Name of the object.
        object: String,
        /// Problem and how to fix it.
        problem: &'static str,
    },
    /// An image cannot be encoded.
    #[error("an image of {width} x {height} texels cannot be encoded as PNG; scale it down")]
    Image {
        /// Texels in a row.
        width: u32,
        /// Number of rows.
        height: u32,
    },
    /// A light violates the invariants of [`Light`](super::Light).
    #[error("light {light} cannot be written as glTF: {problem}")]
    Light {
        /// Index into the scene's lights, from 0.
        light: usize,
        /// Problem and how to fix it.
        problem: &'static str,
    },
    /// The file would be too large: a .glb stores its length in 32 bits.
    #[error("the scene needs {bytes} bytes, but a .glb holds at most {}; split it", u32::MAX)]
    TooLarge {
        /// Size in bytes that the file would need.
        bytes: u64,
    },
}

/// glTF component type of 32-bit floats.
const FLOAT: u32 = 5126;
/// glTF component type of 32-bit unsigned integers.
const UNSIGNED_INT: u32 = 5125;
/// Buffer view target for vertex attributes.
const ARRAY_BUFFER: u32 = 34_962;
/// Buffer view target for indices.
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;

/// Returns the bytes of a .glb with the scene's objects, materials (see below), lights and camera.
///
/// Transmission is written as `KHR_materials_transmission` and
/// `KHR_materials_diffuse_transmission`, the refractive index as `KHR_materials_ior`, thickness and
/// attenuation as `KHR_materials_volume`, and dispersion as `KHR_materials_dispersion`. glTF has no
/// Sellmeier equation: its name goes into `extras.lapidary.sellmeier`, together with an approximate
/// dispersion for other programs. A medium, a `sigma0`, a solver and the environment go into `extras.lapidary`;
/// other programs show the base colour. Lights are written as `KHR_lights_punctual`, images as
/// embedded PNG, each once.
///
/// The same scene always yields the same bytes. [`super::gltf::parse`] returns the same meshes
/// (without [`Mesh::halo`](super::Mesh::halo)), materials and lights, and a camera with the same view up to rounding.
/// A material with diffuse transmission and attenuation but no medium comes back with the medium
/// that the loader derives. Textures whose factor is 0 are left out.
///
/// # Errors
/// Returns a [`GlbError`] if a mesh or light is malformed or the file would exceed 4 GiB.
pub fn write(scene: &Scene) -> Result<Vec<u8>, GlbError> {
    if scene.objects.is_empty() {
        return Err(GlbError::Empty);
    }
    let camera = &scene.camera;
    let placed = camera.eye.is_finite() && camera.target.is_finite() && camera.up.is_finite();
    let opens = camera.vertical_fov > 0.0 && camera.vertical_fov < std::f32::consts::PI;
    if !placed || !opens {
        return Err(GlbError::Camera);
    }
    let mut document = Document::default();
    for object in &scene.objects {
        document.add(object)?;
    }
    let broken = scene.lights.iter().enumerate().find_map(|(k, light)| Some((k, light.problem()?)));
    if let Some((light, problem)) = broken {
        return Err(GlbError::Light { light, problem });
    }
    let images = document.images()?;
    let mut json = document.json(scene);
    if !images.is_empty() {
        json["images"] = images.into();
    }
    let json = json.to_string();
    container(json.as_bytes(), &document.binary)
}

/// Returns a .glb container with a JSON and a binary chunk, each padded to a multiple of four
/// bytes.
///
/// # Errors
/// [`GlbError::TooLarge`] from 4 GiB on.
pub fn container(json: &[u8], binary: &[u8]) -> Result<Vec<u8>, GlbError> {
    let padded = |length: usize| length.next_multiple_of(4);
    let total = 12 + 8 + padded(json.len()) + 8 + padded(binary.len());
    let length = u32::try_from(total).map_err(|_| GlbError::TooLarge { bytes: total as u64 })?;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(b"glTF");
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    for (kind, padding, data) in [(b"JSON", b' ', json), (b"BIN\0", 0, binary)] {
        // At most `total`, which fits.
        bytes.extend((padded(data.len()) as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(4), padding);
    }
    Ok(bytes)
}

#[derive(Debug, Default)]
struct Document {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    textures: texture::Textures,
}

impl Document {
    fn add(&mut self, object: &Object) -> Result<(), GlbError> {
        let problem = |problem| GlbError::Object { object: object.name.clone(), problem };
        for mesh in [&object.mesh, object.shape()] {
            problem::of(mesh, &object.material).map_or(Ok(()), |wrong| Err(problem(wrong)))?;
        }
        let mesh = object.shape();
        // glTF has no invisible triangles.
        let mesh = &mesh.without_halo();
        let bounds = Bounds::of(mesh.positions.iter().copied());
        let position = self.vectors(mesh.positions.iter().map(Vec3::to_array));
        self.accessors[position]["min"] = json!(bounds.min.to_array());
        self.accessors[position]["max"] = json!(bounds.max.to_array());
        let normal = self.vectors(mesh.normals.iter().map(Vec3::to_array));
        let mut attributes = json!({"POSITION": position, "NORMAL": normal});
        if !mesh.uvs.is_empty() {
            attributes["TEXCOORD_0"] = json!(self.vectors(mesh.uvs.iter().map(Vec2::to_array)));
        }
        if !mesh.colors.is_empty() {
            attributes["COLOR_0"] = json!(self.vectors(mesh.colors.iter().map(Vec3::to_array)));
        }
        let indices = mesh.indices.iter().flat_map(|k| k.to_le_bytes());
        let indices = self.accessor(
            indices,
            json!({"componentType": UNSIGNED_INT, "count": mesh.indices.len(), "type": "SCALAR"}),
            ELEMENT_ARRAY_BUFFER,
        );
        let mut node = json!({"name": object.name, "mesh": self.meshes.len()});
        let mut material = object.material.clone();
        if let Some(copies) = &object.copies {
            node["extensions"] = json!({INSTANCING: {"attributes": self.places(copies, &object.material)}});
            // glTF states the thickness in the mesh's space.
            material.thickness /= copies.places.iter().map(|place| place.scale).fold(0.0, f32::max);
        }
        self.nodes.push(node);
        self.meshes.push(json!({
            "name": object.name,
            "primitives": [{
                "attributes": attributes,
                "indices": indices,
                "material": self.materials.len(),
                "mode": 4,
            }],
        }));
        self.materials.push(material::material(&material, &mut self.textures));
        Ok(())
    }

    /// Appends the attributes of copies and returns their accessors by name.
    fn places(&mut self, copies: &Copies, material: &Material) -> Value {
        let places = &copies.places;
        let mut attributes = json!({
            "TRANSLATION": self.vectors(places.iter().map(|place| place.translation.to_array())),
            "ROTATION": self.vectors(places.iter().map(|place| place.rotation.to_array())),
            "SCALE": self.vectors(places.iter().map(|place| [place.scale; 3])),
        });
        if copies.is_coloured() {
            let [base_color, attenuation_color] = COLORING;
            attributes[base_color] = json!(self.vectors(places.iter().map(|place| place.base_color.to_array())));
            // glTF has no attribute that some copies lack.
            if places.iter().any(|place| place.attenuation_color.is_some()) {
                let color = |place: &Place| place.attenuation_color.unwrap_or(material.attenuation_color).to_array();
                attributes[attenuation_color] = json!(self.vectors(places.iter().map(color)));
            }
        }
        attributes
    }

    /// Appends an accessor of vectors with `N` components and returns its index.
    fn vectors<const N: usize>(&mut self, vectors: impl ExactSizeIterator<Item = [f32; N]>) -> usize {
        let accessor = json!({"componentType": FLOAT, "count": vectors.len(), "type": format!("VEC{N}")});
        self.accessor(vectors.flatten().flat_map(f32::to_le_bytes), accessor, ARRAY_BUFFER)
    }

    /// Appends an accessor with its own buffer view and returns its index. All elements consist of
    /// four-byte numbers, and images follow them, so every view is aligned.
    fn accessor(&mut self, data: impl Iterator<Item = u8>, mut accessor: Value, target: u32) -> usize {
        let view = self.view(data);
        self.views[view]["target"] = json!(target);
        accessor["bufferView"] = json!(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Appends a buffer view and returns its index.
    fn view(&mut self, data: impl Iterator<Item = u8>) -> usize {
        let start = self.binary.len();
        self.binary.extend(data);
        self.views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": self.binary.len() - start}));
        self.views.len() - 1
    }

    /// Appends the images of all textures and returns their list.
    fn images(&mut self) -> Result<Vec<Value>, GlbError> {
        let images = self.textures.images().to_vec();
        let written = images.iter().map(|texels| {
            let (width, height) = (texels.width(), texels.height());
            let png = texture::png(texels).ok_or(GlbError::Image { width, height })?;
            Ok(json!({"bufferView": self.view(png.into_iter()), "mimeType": "image/png"}))
        });
        written.collect()
    }

    /// Names of the extensions that the materials and nodes use, sorted and without duplicates.
    fn extensions_used(&self) -> BTreeSet<&str> {
        let nodes = self.nodes.iter().filter_map(|node| node["extensions"].as_object());
        let extensions = self.materials.iter().filter_map(|material| material["extensions"].as_object());
        extensions.chain(nodes).flat_map(|extensions| extensions.keys().map(String::as_str)).collect()
    }

    fn json(&self, scene: &Scene) -> Value {
        let mut nodes = self.nodes.clone();
        nodes.push(camera_pose(&scene.camera));
        nodes.extend(scene.lights.iter().enumerate().map(|(number, light)| light::node(light, number)));
        let mut extensions_used = self.extensions_used();
        if !scene.lights.is_empty() {
            extensions_used.insert(light::EXTENSION);
        }
        if self.textures.is_transformed() {
            extensions_used.insert(TEXTURE_TRANSFORM);
        }
        let mut of_scene = json!({"name": scene.name, "nodes": (0..nodes.len()).collect::<Vec<_>>()});
        if scene.environment != BuiltInEnvironment::default() {
            of_scene["extras"] = json!({"lapidary": {"environment": scene.environment.name()}});
        }
        let mut written = json!({
            "asset": {"version": "2.0", "generator": "Lapidary"},
            "extensionsUsed": extensions_used,
            "scene": 0,
            "scenes": [of_scene],
            "nodes": nodes,
            "cameras": [{
                "type": "perspective",
                "perspective": {"yfov": scene.camera.vertical_fov, "znear": 0.01},
            }],
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.binary.len()}],
        });
        if !scene.lights.is_empty() {
            let lights: Vec<Value> = scene
                .lights
                .iter()
                .enumerate()
                .map(|(number, one)| light::light(one, scene.light_radii.get(number).copied().flatten()))
                .collect();
            written["extensions"] = json!({light::EXTENSION: {"lights": lights}});
        }
        self.textures.write(&mut written);
        written
    }
}

/// Camera node. A glTF camera looks along its node's -z with +y up.
fn camera_pose(camera: &Camera) -> Value {
    let back = (camera.eye - camera.target).normalize_or(Vec3::Z);
    let right = camera.up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    let rotation = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
    json!({
        "name": "camera",
        "camera": 0,
        "translation": camera.eye.to_array(),
        "rotation": rotation.to_array(),
    })
}

#[cfg(test)]
mod tests;
