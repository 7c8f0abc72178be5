//! Deserialisation of the JSON. The gltf crate requires members that glTF makes optional, and
//! members that this loader does not use. If these are the only problem, they are inserted or
//! removed.

use ::gltf::json::Root;
use serde_json::{Map, Value, json};

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
    let Ok(value) = serde_json::from_slice(json).map(mended) else { return Err(first) };
    let root = |value| serde_json::from_value(value).ok();
    root(value.clone()).or_else(|| root(without_animations(value))).ok_or(first)
}

fn mended(mut value: Value) -> Value {
    let Some(members) = value.as_object_mut() else { return value };
    for name in NOT_TAKEN {
        members.remove(name);
    }
    // A channel without a node moves something else, by an extension.
    for channels in animations(members).filter_map(|animation| animation.get_mut("channels")?.as_array_mut()) {
        channels.retain(|channel| channel.pointer("/target/node").is_some());
    }
    // A scene may be empty.
    for scene in members.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| json!([]));
        }
    }
    value
}

/// Leaves the number of animations alone, so that it can be reported.
fn without_animations(mut value: Value) -> Value {
    for animation in value.as_object_mut().into_iter().flat_map(animations) {
        *animation = json!({"channels": [], "samplers": []});
    }
    value
}

fn animations(members: &mut Map<String, Value>) -> impl Iterator<Item = &mut Value> {
    members.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten()
}
