//! Writes a scene as binary glTF 2.0.

use std::collections::BTreeSet;

use glam::{Mat3, Quat, Vec3};
use serde_json::{Value, json};
use thiserror::Error;

use super::{Bounds, Camera, Dispersion, Material, Mesh, Object, Scene};

/// Why a scene cannot be written. Nothing is written then.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GlbError {
    /// glTF cannot hold an empty scene.
    #[error("the scene has no objects, which glTF cannot say; add one")]
    Empty,
    /// The camera has no place, direction or angle.
    #[error("the camera is not finite, or its field of view not above 0 and below 180°; mend it")]
    Camera,
    /// The lists of a mesh do not fit together, or hold what glTF forbids.
    #[error("object {object:?} cannot be written as glTF: {problem}")]
    Object {
        /// The object's name.
        object: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// A .glb counts its bytes in 32 bits.
    #[error("the scene needs {bytes} bytes, but a .glb holds at most {}; split it", u32::MAX)]
    TooLarge {
        /// What the file would need.
        bytes: u64,
    },
}

/// glTF's number for 32-bit floats.
const FLOAT: u32 = 5126;
/// glTF's number for 32-bit unsigned integers.
const UNSIGNED_INT: u32 = 5125;
/// Buffer view target of vertex attributes.
const ARRAY_BUFFER: u32 = 34_962;
/// Buffer view target of indices.
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;

/// The bytes of a .glb with the scene's objects, their materials (see below) and its camera.
///
/// A material is fully transmissive by `KHR_materials_transmission`, has its refractive index by
/// `KHR_materials_ior`, its attenuation by `KHR_materials_volume`, whose thickness also says that the body
/// is solid, and its dispersion by `KHR_materials_dispersion`. A Sellmeier equation, which glTF cannot
/// say, is named in `extras.lapidary.sellmeier`; the dispersion beside it is what others make of it.
///
/// The same scene always gives the same bytes. [`super::gltf::parse`] gives the same meshes and
/// materials back; of the camera it gives the same view, to rounding.
///
/// # Errors
/// [`GlbError`], where a mesh is not well-formed or the file would pass 4 GiB.
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
    let json = document.json(scene).to_string();
    container(json.as_bytes(), &document.binary)
}

/// A .glb container about a JSON and a binary chunk, each padded to four bytes.
pub(super) fn container(json: &[u8], binary: &[u8]) -> Result<Vec<u8>, GlbError> {
    let padded = |length: usize| length.next_multiple_of(4);
    let total = 12 + 8 + padded(json.len()) + 8 + padded(binary.len());
    let length = u32::try_from(total).map_err(|_| GlbError::TooLarge { bytes: total as u64 })?;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(b"glTF");
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    for (kind, padding, data) in [(b"JSON", b' ', json), (b"BIN\0", 0, binary)] {
        // No more than `total`, which fits.
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
}

impl Document {
    fn add(&mut self, object: &Object) -> Result<(), GlbError> {
        let mesh = &object.mesh;
        if let Some(problem) = problem_of(mesh, &object.material) {
            return Err(GlbError::Object { object: object.name.clone(), problem });
        }
        let bounds = Bounds::of(mesh.positions.iter().copied());
        let position = self.vectors(&mesh.positions);
        self.accessors[position]["min"] = json!(bounds.min.to_array());
        self.accessors[position]["max"] = json!(bounds.max.to_array());
        let normal = self.vectors(&mesh.normals);
        let indices = mesh.indices.iter().flat_map(|k| k.to_le_bytes());
        let indices = self.accessor(
            indices,
            json!({"componentType": UNSIGNED_INT, "count": mesh.indices.len(), "type": "SCALAR"}),
            ELEMENT_ARRAY_BUFFER,
        );
        self.nodes.push(json!({"name": object.name, "mesh": self.meshes.len()}));
        self.meshes.push(json!({
            "name": object.name,
            "primitives": [{
                "attributes": {"POSITION": position, "NORMAL": normal},
                "indices": indices,
                "material": self.materials.len(),
                "mode": 4,
            }],
        }));
        self.materials.push(material(&object.material, thickness(mesh)));
        Ok(())
    }

    fn vectors(&mut self, vectors: &[Vec3]) -> usize {
        let components = vectors.iter().flat_map(|v| v.to_array());
        self.accessor(
            components.flat_map(f32::to_le_bytes),
            json!({"componentType": FLOAT, "count": vectors.len(), "type": "VEC3"}),
            ARRAY_BUFFER,
        )
    }

    /// Appends an accessor with a buffer view of its own. All data is of four bytes, so that every
    /// view is aligned.
    fn accessor(&mut self, data: impl Iterator<Item = u8>, mut accessor: Value, target: u32) -> usize {
        let start = self.binary.len();
        self.binary.extend(data);
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": start,
            "byteLength": self.binary.len() - start,
            "target": target,
        }));
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The names of the materials' extensions, each once and sorted.
    fn extensions_used(&self) -> BTreeSet<&str> {
        let extensions = self.materials.iter().filter_map(|material| material["extensions"].as_object());
        extensions.flat_map(|extensions| extensions.keys().map(String::as_str)).collect()
    }

    fn json(&self, scene: &Scene) -> Value {
        let camera_node = self.nodes.len();
        let mut nodes = self.nodes.clone();
        nodes.push(camera_pose(&scene.camera));
        json!({
            "asset": {"version": "2.0", "generator": "Lapidary"},
            "extensionsUsed": self.extensions_used(),
            "scene": 0,
            "scenes": [{"name": scene.name, "nodes": (0..=camera_node).collect::<Vec<_>>()}],
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
        })
    }
}

/// What glTF forbids in an object, if anything.
fn problem_of(mesh: &Mesh, material: &Material) -> Option<&'static str> {
    let vertices = mesh.positions.len();
    let in_range = |&index: &u32| (index as usize) < vertices;
    if mesh.indices.is_empty() {
        Some("it has no triangles; remove the object")
    } else if !mesh.indices.len().is_multiple_of(3) {
        Some("its number of indices is not a multiple of three; complete the last triangle")
    } else if mesh.normals.len() != vertices {
        Some("it has not one normal for each position; compute them again")
    } else if !mesh.indices.iter().all(in_range) {
        Some("an index is past its last vertex; mend the triangles")
    } else if !mesh.positions.iter().chain(&mesh.normals).all(|v| v.is_finite()) {
        Some("a position or normal is not finite; mend or remove the vertex")
    } else {
        material.problem()
    }
}

/// The mean length of a straight way through a body, which renderers that do not trace it take as its
/// thickness: 4 V/S for a convex body (Cauchy), and for several alike that of one. A body that encloses
/// nothing gets the diagonal of its box; a 0 would call it thin-walled.
fn thickness(mesh: &Mesh) -> f32 {
    let (volume, area) = mesh.volume_and_area();
    let mean = (4.0 * volume / area) as f32;
    let across = 2.0 * Bounds::of(mesh.positions.iter().copied()).radius();
    if mean > 0.0 && mean <= across { mean } else { across }
}

fn material(material: &Material, thickness: f32) -> Value {
    let mut written = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": material.base_color.extend(1.0).to_array(),
            "metallicFactor": 0.0,
            "roughnessFactor": material.roughness,
        },
        "extensions": {
            "KHR_materials_ior": {"ior": material.ior},
            "KHR_materials_transmission": {"transmissionFactor": 1.0},
            "KHR_materials_volume": {
                "thicknessFactor": thickness,
                "attenuationColor": material.attenuation_color.to_array(),
            },
        },
    });
    // JSON has no infinity: what is left out is glTF's default, which is that.
    if material.attenuation_distance.is_finite() {
        written["extensions"]["KHR_materials_volume"]["attenuationDistance"] = json!(material.attenuation_distance);
    }
    let dispersion = match material.dispersion {
        Dispersion::None => None,
        Dispersion::Abbe(dispersion) => Some(dispersion),
        Dispersion::Sellmeier(mineral) => {
            written["extras"] = json!({"lapidary": {"sellmeier": mineral.name()}});
            Some(20.0 / mineral.abbe_number())
        }
    };
    if let Some(dispersion) = dispersion {
        written["extensions"]["KHR_materials_dispersion"] = json!({"dispersion": dispersion});
    }
    written
}

/// A glTF camera looks along its node's -z with +y up.
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
