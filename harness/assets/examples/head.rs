//! Makes `head.glb` from the scan as it was converted, whose texture coordinates count v from below, as no
//! glTF file may: `cargo run --package lapidary-assets --example head -- CONVERTED OUT`.
//!
//! Nothing else of the geometry and the images changes. The scan's owners are named in `asset.copyright`.

use std::process::ExitCode;

use lapidary_scene::glb;
use serde_json::{Value, json};

const COPYRIGHT: &str = "Infinite, 3D Head Scan by Lee Perry-Smith, based on a work at www.triplegangers.com, licensed \
                         under a Creative Commons Attribution 3.0 Unported License";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [converted, out] = &arguments[..] else {
        eprintln!("usage: head CONVERTED OUT");
        return ExitCode::from(2);
    };
    let bytes = std::fs::read(converted).map_err(|error| format!("{converted}: cannot be read: {error}"));
    let upright = bytes.and_then(|bytes| upright(&bytes).map_err(|problem| format!("{converted}: {problem}")));
    let written = upright
        .and_then(|bytes| std::fs::write(out, bytes).map_err(|error| format!("{out}: cannot be written: {error}")));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(2)
        }
    }
}

/// Returns the .glb with v counted from above.
fn upright(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let damaged = || "this is no .glb with a JSON and a binary chunk; give the converted scan".to_owned();
    let word = |offset: usize| Some(u32::from_le_bytes(*bytes.get(offset..)?.first_chunk()?) as usize);
    let chunk = |offset: usize| bytes.get(offset + 8..offset + 8 + word(offset)?);
    let text = chunk(12).ok_or_else(damaged)?;
    let mut binary = chunk(20 + text.len()).ok_or_else(damaged)?.to_vec();
    let mut json: Value = serde_json::from_slice(text).map_err(|error| error.to_string())?;

    let unknown = || "its texture coordinates are not packed floats; give the converted scan".to_owned();
    let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
    let index = number(&json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]);
    let accessor = &mut json["accessors"][index];
    let turned = |v: Value| v.as_f64().map(|v| 1.0 - v as f32).ok_or_else(unknown);
    let (least, greatest) = (accessor["min"][1].take(), accessor["max"][1].take());
    accessor["min"][1] = json!(turned(greatest)?);
    accessor["max"][1] = json!(turned(least)?);
    let accessor = &json["accessors"][index];
    let view = &json["bufferViews"][number(&accessor["bufferView"])];
    if accessor["type"] != "VEC2" || accessor["componentType"] != 5126 || !view["byteStride"].is_null() {
        return Err(unknown());
    }
    let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
    let pairs = binary.get_mut(start..start + 8 * number(&accessor["count"])).ok_or_else(unknown)?;
    for pair in pairs.chunks_exact_mut(8) {
        let v = pair.last_chunk().map_or(0.0, |bytes| f32::from_le_bytes(*bytes));
        pair[4..].copy_from_slice(&(1.0 - v).to_le_bytes());
    }
    json["asset"]["copyright"] = json!(COPYRIGHT);
    let length = number(&json["buffers"][0]["byteLength"]);
    glb::container(json.to_string().as_bytes(), &binary[..length.min(binary.len())]).map_err(|error| error.to_string())
}
