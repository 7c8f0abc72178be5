//! From JSON to its types. The gltf crate asks for members that glTF lets be left out, or that nothing here reads; where that is all that it
//! misses, they are put in or taken out.

use ::gltf::json::Root;
use serde_json::{Value, json};

use super::error::GltfError;

/// Longer JSON is not mended: as values it takes some ten times its bytes.
const MENDED_BYTES: usize = 64 << 20;

/// Members of the file that nothing drawn here needs. A node's skin is reported by its number alone.
const NOT_DRAWN: [&str; 4] = ["images", "samplers", "skins", "textures"];

/// The file's JSON as types.
pub(super) fn root(json: &[u8]) -> Result<Root, GltfError> {
    let first = match ::gltf::json::deserialize::from_slice(json) {
        Ok(root) => return Ok(root),
        Err(error) => GltfError::json(error),
    };
    if json.len() > MENDED_BYTES {
        return Err(first);
    }
    // The first message has the line and the column of what is wrong in the text.
    let mended = serde_json::from_slice(json).ok().and_then(|value| serde_json::from_value(mended(value)).ok());
    mended.ok_or(first)
}

fn mended(mut value: Value) -> Value {
    let Some(members) = value.as_object_mut() else { return value };
    for name in NOT_DRAWN {
        members.remove(name);
    }
    // Their number is reported, and nothing else of them read.
    for animation in members.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten() {
        *animation = json!({"channels": [], "samplers": []});
    }
    // A scene may be empty.
    for scene in members.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| json!([]));
        }
    }
    value
}
