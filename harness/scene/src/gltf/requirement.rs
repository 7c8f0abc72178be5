//! Required extensions of a file: those that are supported, those that do not affect what is drawn,
//! and those that cause the file to be refused.

use ::gltf::json::Root;

use super::error::{self, GltfError};
use super::limits::{KNOWN_EXTENSIONS, NOT_DRAWN};

/// Extensions of images, animations and descriptions: nothing that is drawn here needs them. A
/// texture in a format that is not read is replaced by its factor.
const OF_WHAT_IS_NOT_DRAWN: [&str; 6] = [
    "EXT_texture_avif",
    "KHR_animation_pointer",
    "KHR_materials_variants",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Extensions of how numbers are stored.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";
pub(super) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
pub(super) const QUANTIZATION: &str = "KHR_mesh_quantization";

/// Refuses a file that requires an unsupported extension.
pub(super) fn check(root: &Root) -> Result<(), GltfError> {
    let required = || root.extensions_required.iter().map(String::as_str);
    let is_known = |name: &str| KNOWN_EXTENSIONS.contains(&name) || NOT_DRAWN.iter().any(|(known, _)| *known == name);
    let stops = |name: &&str| !(is_known(name) || OF_WHAT_IS_NOT_DRAWN.contains(name));
    let unknown: Vec<String> = required().filter(stops).map(error::excerpt).collect();
    if unknown.is_empty() {
        Ok(())
    } else {
        Err(GltfError::RequiredExtensions { extensions: error::shortened(unknown) })
    }
}
