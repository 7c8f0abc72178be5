//! Deserialisation of the JSON. The gltf crate requires members that glTF makes optional, and
//! members that this loader does not use. If these are the only problem, they are inserted or
//! removed.

use ::gltf::json::Root;
use serde_json::{Value, json};

use super::error::GltfError;

/// Longer JSON is not repaired: as a tree of values it takes about ten times its size.
const MENDED_BYTES: usize = 64 << 20;

/// Members of the file that are not read from the deserialised root. Textures are read from the text
/// itself (`gltf/texture.rs`), and only the index of a node's skin is reported.
const NOT_TAKEN: [&str; 4] = ["images", "samplers", "skins", "textures"];

/// Deserialises the file's JSON.
pub(super) fn root(json: &[u8]) -> Result<Root, GltfError> {
    let first = match ::gltf::json::deserialize::from_slice(json) {
        Ok(root) => return Ok(root),
        Err(error) => GltfError::json(error),
    };
    if json.len() > MENDED_BYTES {
        return Err(first);
    }
    // The first message has the line and column of the problem in the original text.
    let mended = serde_json::from_slice(json).ok().and_then(|value| serde_json::from_value(mended(value)).ok());
    mended.ok_or(first)
}

fn mended(mut value: Value) -> Value {
    let Some(members) = value.as_object_mut() else { return value };
    for name in NOT_TAKEN {
        members.remove(name);
    }
    // Only the number of animations is reported; nothing else of them is read.
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
