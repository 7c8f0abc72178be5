//! Required extensions of a file: those that are supported, those that do not affect what is drawn,
//! and those that cause the file to be refused.

use ::gltf::json::Root;
use serde_json::{Map, Value};

use super::error::{self, GltfError};
use super::limits::{KNOWN_EXTENSIONS, NOT_DRAWN};

/// Extensions of images, animations and descriptions: nothing that is drawn here needs them. A
/// texture in another format than PNG and JPEG is replaced by its factor.
const OF_WHAT_IS_NOT_DRAWN: [&str; 8] = [
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_materials_variants",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Extensions that compress the numbers of a mesh.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";
pub(super) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
pub(super) const QUANTIZATION: &str = "KHR_mesh_quantization";

/// Refuses a file that requires an unsupported extension.
pub(super) fn check(root: &Root) -> Result<(), GltfError> {
    let required = || root.extensions_required.iter().map(String::as_str);
    if let Some(name) = required().find(|name| is_compressed_by(root, name)) {
        return Err(GltfError::Compressed { extension: name.to_owned() });
    }
    // Extensions of storage were checked above at the meshes that use them, or are checked when the
    // data is read.
    let of_storage = |name: &str| name == DRACO || name == QUANTIZATION || MESHOPT.contains(&name);
    let is_known = |name: &str| KNOWN_EXTENSIONS.contains(&name) || NOT_DRAWN.iter().any(|(known, _)| *known == name);
    let stops = |name: &&str| !(is_known(name) || OF_WHAT_IS_NOT_DRAWN.contains(name) || of_storage(name));
    let unknown: Vec<String> = required().filter(stops).map(error::excerpt).collect();
    if unknown.is_empty() {
        Ok(())
    } else {
        Err(GltfError::RequiredExtensions { extensions: error::shortened(unknown) })
    }
}

/// Whether a mesh of the file is stored compressed by this extension.
fn is_compressed_by(root: &Root, name: &str) -> bool {
    let has = |all: Option<&Map<String, Value>>| all.is_some_and(|all| all.contains_key(name));
    if name == DRACO {
        let mut primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        return primitives.any(|primitive| has(primitive.extensions.as_ref().map(|all| &all.others)));
    }
    MESHOPT.contains(&name) && root.buffer_views.iter().any(|view| has(view.extensions.as_ref().map(|all| &all.others)))
}
