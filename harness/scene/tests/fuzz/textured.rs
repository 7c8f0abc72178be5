//! A file with textures, to be broken.

use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{Vec2, Vec3};
use image::{ExtendedColorType, ImageEncoder};
use lapidary_scene::{Scene, Texels, Texture, TextureSlot, TextureTransform, Wrap, glb};
use serde_json::{Value, json};

/// Returns the scene's first body as .glb with colours and a texture in every slot, with samplers
/// and transforms: three in PNG, in a buffer, and two in JPEG, as base64. Empty if the writer fails.
pub fn seed(mut scene: Scene) -> Vec<u8> {
    let object = &mut scene.objects[0];
    let positions = &object.mesh.positions;
    object.mesh.uvs = positions.iter().map(|position| position.truncate()).collect();
    object.mesh.colors = positions.iter().map(|position| position.abs() * Vec3::new(1.0, 0.5, 0.0)).collect();
    object.material.diffuse_transmission = 0.5;
    let [png, replaced] = [3, 1].map(|width| Texels::new(width, 1, vec![90; 4 * width as usize]).map(Arc::new));
    for slot in TextureSlot::ALL {
        let is_jpeg = [TextureSlot::Transmission, TextureSlot::DiffuseTransmission].contains(&slot);
        let texels = if is_jpeg { &replaced } else { &png };
        *object.material.texture_mut(slot) = texels.clone().map(|texels| Texture {
            wrap: [Wrap::MirroredRepeat, Wrap::ClampToEdge],
            transform: TextureTransform { offset: Vec2::Y, rotation: 1.5, scale: Vec2::new(2.0, -1.0) },
            ..Texture::new(texels, slot.encoding())
        });
    }
    let written = glb::write(&scene).unwrap_or_default();
    let (json, binary) = super::parts(&written);
    let mut document: Value = serde_json::from_slice(&written[json]).unwrap_or_default();
    // The image of the textures that are written first: those of the transmissions.
    document["images"][0] = json!({"uri": format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg()))});
    glb::container(document.to_string().as_bytes(), &written[binary.unwrap_or_default()]).unwrap_or_default()
}

/// Returns a picture of one colour, 16 texels wide and 8 high.
fn jpeg() -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 90);
    let written = encoder.write_image(&[200, 100, 50].repeat(128), 16, 8, ExtendedColorType::Rgb8);
    written.map(|()| bytes).unwrap_or_default()
}

/// Returns the scene's first body as .glb with this image, in a buffer, as its base colour texture. Empty if the writer fails.
pub fn with_image(scene: &Scene, image: &[u8]) -> Vec<u8> {
    let mut scene = scene.clone();
    let object = &mut scene.objects[0];
    object.mesh.uvs = object.mesh.positions.iter().map(|position| position.truncate()).collect();
    let replaced = Texels::new(1, 1, vec![90; 4]).map(Arc::new);
    object.material.base_color_texture = replaced.map(|texels| Texture::new(texels, TextureSlot::BaseColor.encoding()));
    let written = glb::write(&scene).unwrap_or_default();
    let (json, binary) = super::parts(&written);
    let mut document: Value = serde_json::from_slice(&written[json]).unwrap_or_default();
    let mut binary = written[binary.unwrap_or_default()].to_vec();
    // In place of the written image.
    let view = document["images"][0]["bufferView"].as_u64().unwrap_or_default() as usize;
    document["bufferViews"][view] = json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": image.len()});
    document["images"][0] = json!({"bufferView": view});
    binary.extend_from_slice(image);
    document["buffers"][0]["byteLength"] = json!(binary.len());
    glb::container(document.to_string().as_bytes(), &binary).unwrap_or_default()
}
