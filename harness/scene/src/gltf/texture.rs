//! Textures of materials: their images, samplers and `KHR_texture_transform`.
//!
//! A texture is read when a material that is drawn calls for it, and an image is decoded when the
//! first such texture uses it. The lists of textures, samplers and images are taken from the file's
//! text, element by element, so that what nothing calls for can be neither slow nor wrong.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use ::gltf::json::Root;
use ::gltf::json::texture::{MagFilter, Sampler, WrappingMode};
use ::gltf::json::validation::Checked;
use glam::Vec2;
use serde::Deserialize;
use serde_json::value::RawValue;
use serde_json::{Map, Value};

use super::budget::ImageBudget;
use super::buffers::Buffers;
use super::decode::{Decoded, decode};
use super::error::{GltfError, designation, excerpt, item};
use super::extension::Extension;
use super::limits::MAX_FILE_BYTES;
use super::uri;
use crate::{Texels, Texture, TextureSlot, TextureTransform, Wrap};

/// Name of the extension that maps texture coordinates.
pub(crate) const TRANSFORM: &str = "KHR_texture_transform";

/// Names of the extensions of textures in other formats, the better one first.
const IMAGES: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

/// A material's reference to a texture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reference<'a> {
    pub(super) slot: TextureSlot,
    pub(super) index: usize,
    /// Number of the set of texture coordinates.
    pub(super) set: u32,
    pub(super) extensions: Option<&'a Map<String, Value>>,
}

/// Something about a texture that is not drawn: what it is, and what is drawn instead.
pub(super) type Shortfall = (String, &'static str);

/// Instead of a texture.
pub(super) const FACTOR: &str = "a factor is drawn alone";

/// Textures of a file.
#[derive(Debug)]
pub(super) struct Textures<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    base: Option<&'a Path>,
    json: &'a [u8],
    lists: Option<Lists<'a>>,
    images: BTreeMap<usize, Decoded<Arc<Texels>>>,
    budget: ImageBudget,
}

/// The lists of the file, whose elements are not yet read.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Lists<'a> {
    #[serde(borrow)]
    textures: Vec<&'a RawValue>,
    #[serde(borrow)]
    samplers: Vec<&'a RawValue>,
    #[serde(borrow)]
    images: Vec<&'a RawValue>,
}

/// An element of the file's `textures`.
#[derive(Deserialize)]
struct JsonTexture {
    name: Option<String>,
    source: Option<usize>,
    sampler: Option<usize>,
    extensions: Option<Map<String, Value>>,
}

/// An element of the file's `images`. Its `mimeType` is not read: the data tell their format.
#[derive(Deserialize)]
struct JsonImage<'a> {
    name: Option<String>,
    #[serde(borrow)]
    uri: Option<Cow<'a, str>>,
    #[serde(rename = "bufferView")]
    buffer_view: Option<usize>,
}

impl<'a> Textures<'a> {
    /// Returns the textures of the file with this text, none of them read yet. Images in files of
    /// their own are looked up in the folder `base`.
    pub(super) fn new(root: &'a Root, json: &'a [u8], buffers: &'a Buffers<'a>, base: Option<&'a Path>) -> Self {
        Self { root, buffers, base, json, lists: None, images: BTreeMap::new(), budget: ImageBudget::new() }
    }

    /// Returns the texture that `material` refers to; `None` if it cannot be drawn, for a reason
    /// added to `lacking`.
    pub(super) fn get(
        &mut self,
        reference: Reference<'_>,
        material: &str,
        lacking: &mut Vec<Shortfall>,
    ) -> Result<Option<Texture>, GltfError> {
        let slot = reference.slot.name();
        let user = format!("{material}, {slot}");
        let wrong = |problem: String| GltfError::part(user.clone(), problem);
        let extension = Extension::of(reference.extensions, TRANSFORM).map_err(wrong)?;
        let transform = transform(extension).map_err(wrong)?;
        let set = extension.index("texCoord").map_err(wrong)?.unwrap_or(reference.set as usize);
        if set != 0 {
            lacking.push((format!("`{slot}` with `texCoord` {set}"), FACTOR));
            return Ok(None);
        }
        let lists = self.lists()?;
        let json: JsonTexture = element(&lists.textures, "texture", reference.index, || user.clone())?;
        let name = designation("texture", reference.index, json.name.as_deref());
        let sampler = match json.sampler {
            Some(index) => element(&lists.samplers, "sampler", index, || name.clone())?,
            None => Sampler::default(),
        };
        let wrap = wrap(&sampler)
            .map_err(|problem| GltfError::part(format!("sampler {}", json.sampler.unwrap_or_default()), problem))?;
        let of_extension =
            |name: &str| json.extensions.as_ref().map(|all| Extension::of(Some(all), name)?.index("source"));
        let mut sources = IMAGES.into_iter().filter_map(of_extension);
        // Of a texture in two formats, the one that every reader knows.
        let source = match json.source {
            Some(source) => Some(source),
            None => sources
                .find_map(Result::transpose)
                .transpose()
                .map_err(|problem| GltfError::part(name.clone(), problem))?,
        };
        let Some(image) = source else {
            let other = json.extensions.iter().flatten().find(|(_, extension)| extension.get("source").is_some());
            let Some((extension, _)) = other else {
                return Err(GltfError::part(name, "it has no image: give it a source, or remove it"));
            };
            lacking.push((format!("`{slot}` of `{}`", excerpt(extension)), FACTOR));
            return Ok(None);
        };
        match self.image(image, &name)? {
            Decoded::Texels(texels) => {
                if sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)) {
                    lacking.push((format!("`magFilter` NEAREST of `{slot}`"), "texels are interpolated"));
                }
                Ok(Some(Texture { texels, encoding: reference.slot.encoding(), wrap, transform }))
            }
            Decoded::Format(format) => {
                lacking.push((format!("`{slot}` in {format}"), FACTOR));
                Ok(None)
            }
        }
    }

    fn lists(&mut self) -> Result<&Lists<'a>, GltfError> {
        match &mut self.lists {
            Some(lists) => Ok(lists),
            empty => {
                let lists = serde_json::from_slice(self.json).map_err(GltfError::json)?;
                Ok(empty.insert(lists))
            }
        }
    }

    /// Returns image `index` of the file, which `texture` refers to.
    fn image(&mut self, index: usize, texture: &str) -> Result<Decoded<Arc<Texels>>, GltfError> {
        if let Some(image) = self.images.get(&index) {
            return Ok(image.clone());
        }
        let json: JsonImage<'a> = element(&self.lists()?.images, "image", index, || texture.to_owned())?;
        let name = designation("image", index, json.name.as_deref());
        let wrong = |problem: String| GltfError::part(name.clone(), problem);
        let bytes = match (json.uri, json.buffer_view) {
            (Some(uri), None) => Cow::Owned(file_or_base64(&uri, self.base, &name)?),
            (None, Some(view)) => Cow::Borrowed(self.buffers.view(self.root, view, || name.clone())?),
            (Some(_), Some(_)) => {
                return Err(wrong("it has both a uri and a bufferView; remove one of them".to_owned()));
            }
            (None, None) => {
                return Err(wrong("it has neither a uri nor a bufferView, so no data; export it again".to_owned()));
            }
        };
        let image = match decode(&bytes, &mut self.budget).map_err(wrong)? {
            Decoded::Texels(texels) => Decoded::Texels(Arc::new(texels)),
            Decoded::Format(format) => Decoded::Format(format),
        };
        self.images.insert(index, image.clone());
        Ok(image)
    }
}

/// Reads element `index` of a list.
fn element<'a, T: Deserialize<'a>>(
    list: &[&'a RawValue],
    what: &'static str,
    index: usize,
    user: impl FnOnce() -> String,
) -> Result<T, GltfError> {
    let text = item(list, what, index, user)?.get();
    serde_json::from_str(text).map_err(|error| {
        let problem = format!("its JSON is not valid glTF: {}; export it again", excerpt(&error.to_string()));
        GltfError::part(format!("{what} {index}"), problem)
    })
}

/// Data of an image outside of the buffers.
fn file_or_base64(uri: &str, base: Option<&Path>, image: &str) -> Result<Vec<u8>, GltfError> {
    let bytes = uri::contents(uri, base, image, MAX_FILE_BYTES + 1)?;
    let length = bytes.len() as u64;
    if length > MAX_FILE_BYTES {
        return Err(GltfError::TooLarge { what: image.to_owned(), bytes: length, limit: MAX_FILE_BYTES });
    }
    Ok(bytes)
}

fn wrap(sampler: &Sampler) -> Result<[Wrap; 2], String> {
    let wrap_of = |name: &str, mode: Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::MirroredRepeat),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::ClampToEdge),
        Checked::Invalid => Err(format!("its {name} is not one of glTF's, 10497, 33071 and 33648")),
    };
    Ok([wrap_of("wrapS", sampler.wrap_s)?, wrap_of("wrapT", sampler.wrap_t)?])
}

fn transform(extension: Extension<'_>) -> Result<TextureTransform, String> {
    let pair = |key: &str, default: Vec2| -> Result<Vec2, String> {
        let Some([u, v]) = extension.two_numbers(key)? else { return Ok(default) };
        Ok(Vec2::new(single(key, u)?, single(key, v)?))
    };
    let TextureTransform { offset, rotation, scale } = TextureTransform::IDENTITY;
    let rotation = extension.number("rotation")?.map_or(Ok(rotation), |number| single("rotation", number))?;
    Ok(TextureTransform { offset: pair("offset", offset)?, rotation, scale: pair("scale", scale)? })
}

fn single(key: &str, number: f64) -> Result<f32, String> {
    let single = number as f32;
    let fault = || format!("its {key} has the number {number:?}, but must be finite in single precision");
    single.is_finite().then_some(single).ok_or_else(fault)
}
