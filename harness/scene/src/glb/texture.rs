//! Textures as glTF: images as PNG, samplers, and `KHR_texture_transform`.

use std::sync::Arc;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Value, json};

use crate::gltf::TEXTURE_TRANSFORM;
use crate::{Texels, Texture, TextureTransform, Wrap};

/// Textures of a file and what they refer to, each once.
#[derive(Debug, Default)]
pub(super) struct Textures {
    images: Vec<Arc<Texels>>,
    /// Wrap modes along u and v.
    samplers: Vec<[Wrap; 2]>,
    /// Numbers of an image and a sampler.
    textures: Vec<(usize, Option<usize>)>,
    is_transformed: bool,
}

impl Textures {
    /// Adds a texture and returns a material's reference to it.
    pub(super) fn reference(&mut self, texture: &Texture) -> Value {
        let image = place(&mut self.images, &texture.texels, |image| Arc::ptr_eq(image, &texture.texels));
        let repeats = texture.wrap == [Wrap::Repeat; 2];
        let sampler = (!repeats).then(|| place(&mut self.samplers, &texture.wrap, |wrap| *wrap == texture.wrap));
        let pair = (image, sampler);
        let mut reference = json!({"index": place(&mut self.textures, &pair, |other| *other == pair)});
        if let Some(transform) = transform(&texture.transform) {
            self.is_transformed = true;
            reference["extensions"] = json!({TEXTURE_TRANSFORM: transform});
        }
        reference
    }

    /// Images of the file, in order.
    pub(super) fn images(&self) -> &[Arc<Texels>] {
        &self.images
    }

    /// Whether a texture has a transform.
    pub(super) const fn is_transformed(&self) -> bool {
        self.is_transformed
    }

    /// Adds the lists of samplers and textures to a file.
    pub(super) fn write(&self, file: &mut Value) {
        let texture = |(image, sampler): &(usize, Option<usize>)| match sampler {
            Some(sampler) => json!({"source": image, "sampler": sampler}),
            None => json!({"source": image}),
        };
        let sampler = |[s, t]: &[Wrap; 2]| json!({"wrapS": code(*s), "wrapT": code(*t)});
        if !self.textures.is_empty() {
            file["textures"] = self.textures.iter().map(texture).collect();
        }
        if !self.samplers.is_empty() {
            file["samplers"] = self.samplers.iter().map(sampler).collect();
        }
    }
}

/// Returns an image as PNG, without alpha if it is opaque; `None` if it cannot be encoded.
pub(super) fn png(texels: &Texels) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new(&mut bytes);
    let (width, height) = (texels.width(), texels.height());
    let written = if texels.is_opaque() {
        let colors: Vec<u8> = texels.bytes().chunks_exact(4).flat_map(|texel| &texel[..3]).copied().collect();
        encoder.write_image(&colors, width, height, ExtendedColorType::Rgb8)
    } else {
        encoder.write_image(texels.bytes(), width, height, ExtendedColorType::Rgba8)
    };
    written.is_ok().then_some(bytes)
}

/// Returns the number of the wanted element, which is added if it is not there.
fn place<T: Clone>(list: &mut Vec<T>, wanted: &T, is_wanted: impl Fn(&T) -> bool) -> usize {
    list.iter().position(is_wanted).unwrap_or_else(|| {
        list.push(wanted.clone());
        list.len() - 1
    })
}

/// Members of a transform that differ from glTF's defaults; `None` if there are none.
fn transform(texture_transform: &TextureTransform) -> Option<Value> {
    let identity = TextureTransform::IDENTITY;
    let mut members = json!({});
    if texture_transform.offset != identity.offset {
        members["offset"] = json!(texture_transform.offset.to_array());
    }
    if texture_transform.rotation != identity.rotation {
        members["rotation"] = json!(texture_transform.rotation);
    }
    if texture_transform.scale != identity.scale {
        members["scale"] = json!(texture_transform.scale.to_array());
    }
    (members != json!({})).then_some(members)
}

/// glTF's number of a wrap mode.
const fn code(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 10497,
        Wrap::MirroredRepeat => 33648,
        Wrap::ClampToEdge => 33071,
    }
}
