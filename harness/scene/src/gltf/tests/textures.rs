//! Textures: where their images come from, how they are looked up, and what is left alone.

use std::sync::Arc;

use glam::{Vec2, Vec4};
use image::{ExtendedColorType, ImageEncoder};

use super::refusals::one_line;
use super::*;
use crate::{Encoding, Texture, TextureSlot, TextureTransform, Wrap};

/// A picture of two columns and two rows: red, green; blue, half white.
pub(super) const TEXELS: [[u8; 4]; 4] = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [188, 188, 188, 64]];

pub(super) fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    encoder.write_image(&TEXELS.concat(), 2, 2, ExtendedColorType::Rgba8).unwrap();
    bytes
}

/// Returns a picture of one colour, 16 texels wide and 8 high.
pub(super) fn jpeg() -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 100);
    encoder.write_image(&[200, 100, 50].repeat(128), 16, 8, ExtendedColorType::Rgb8).unwrap();
    bytes
}

pub(super) fn base64(bytes: &[u8]) -> String {
    use ::base64::Engine;
    format!("data:image/png;base64,{}", ::base64::engine::general_purpose::STANDARD.encode(bytes))
}

/// Returns a file whose triangle has texture coordinates and a base colour texture with this image
/// in a buffer view.
fn textured(image: &[u8]) -> (Value, Vec<u8>) {
    let mut document = document();
    let primitive = &mut document["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = json!(2);
    primitive["material"] = json!(0);
    document["materials"][0]["pbrMetallicRoughness"] = json!({"metallicFactor": 0, "baseColorTexture": {"index": 0}});
    let uvs = json!({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"});
    document["accessors"].as_array_mut().unwrap().push(uvs);
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": 44, "byteLength": 24}));
    views.push(json!({"buffer": 0, "byteOffset": 68, "byteLength": image.len()}));
    document["buffers"][0]["byteLength"] = json!(68 + image.len());
    document["textures"] = json!([{"source": 0}]);
    document["images"] = json!([{"bufferView": 3, "mimeType": "image/png", "name": "bark"}]);
    let uvs = [0.0f32, 0.0, 1.0, 0.0, 0.0, 1.0].into_iter().flat_map(f32::to_le_bytes).collect();
    (document, [binary(), uvs, image.to_vec()].concat())
}

pub(super) fn load_textured(image: &[u8], change: impl FnOnce(&mut Value)) -> Result<Scene, SceneError> {
    let (mut document, data) = textured(image);
    change(&mut document);
    parse(&file(&document, &data), None)
}

pub(super) fn material(image: &[u8], change: impl FnOnce(&mut Value)) -> Material {
    load_textured(image, change).unwrap().objects.remove(0).material
}

/// Asserts that a change to the file, with this image, is refused with one line.
fn refused(image: &[u8], change: impl FnOnce(&mut Value), says: &str) {
    let message = one_line(load_textured(image, change));
    assert!(message.contains(says), "{says}: {message}");
}

#[test]
fn images_come_from_views_base64_and_files_beside() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("my bark.png"), png()).unwrap();
    std::fs::write(folder.path().join("stone.bin"), textured(&[]).1).unwrap();
    for image in [json!({"bufferView": 3}), json!({"uri": base64(&png())}), json!({"uri": "my%20bark.png"})] {
        let (mut document, data) = textured(&png());
        document["images"][0] = image;
        let scene = parse(&file(&document, &data), Some(folder.path())).unwrap();
        let texture = scene.objects[0].material.base_color_texture.as_ref().unwrap();
        assert_eq!((texture.texels.bytes(), texture.encoding), (&TEXELS.concat()[..], Encoding::Srgb));
        assert_eq!((texture.wrap, texture.transform), ([Wrap::Repeat; 2], TextureTransform::IDENTITY));
        assert_eq!(texture.at(Vec2::new(0.75, 0.25)), Vec4::new(0.0, 1.0, 0.0, 1.0));
    }
}

#[test]
fn the_data_tell_the_format_whatever_the_type_says() {
    for type_ in ["image/png", "image/jpeg", "text/plain"] {
        let material = material(&jpeg(), |d| d["images"][0]["mimeType"] = json!(type_));
        let texels = material.base_color_texture.unwrap().texels;
        assert_eq!((texels.width(), texels.height()), (16, 8));
        for (found, written) in texels.at(7, 3).into_iter().zip([200, 100, 50, 255u8]) {
            assert!(found.abs_diff(written) <= 2, "{:?}", texels.at(7, 3));
        }
    }
}

#[test]
fn grey_and_sixteen_bits_become_eight_bits_of_red_green_blue_and_alpha() {
    let written = |data: &[u8], color| {
        let mut bytes = Vec::new();
        image::codecs::png::PngEncoder::new(&mut bytes).write_image(data, 1, 1, color).unwrap();
        material(&bytes, |_| ()).base_color_texture.unwrap().texels.at(0, 0)
    };
    assert_eq!(written(&[77], ExtendedColorType::L8), [77, 77, 77, 255]);
    assert_eq!(written(&[77, 5], ExtendedColorType::La8), [77, 77, 77, 5]);
    let deep: Vec<u8> = [65535u16, 257 * 200, 127, 257 * 3].into_iter().flat_map(u16::to_ne_bytes).collect();
    assert_eq!(written(&deep, ExtendedColorType::Rgba16), [255, 200, 0, 3]);
}

/// Members of a material with a texture in every slot that is read.
fn every_slot(factor: f32) -> Value {
    let texture = json!({"index": 0});
    json!({
        "name": "gem",
        "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": factor, "baseColorFactor": [factor, factor, factor, 1], "baseColorTexture": texture, "metallicRoughnessTexture": texture},
        "normalTexture": {"index": 0, "scale": factor},
        "extensions": {
            "KHR_materials_volume": {"thicknessFactor": factor, "thicknessTexture": texture},
            "KHR_materials_transmission": {"transmissionFactor": factor, "transmissionTexture": texture},
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": factor, "diffuseTransmissionTexture": texture},
        },
    })
}

#[test]
fn every_slot_shares_the_one_image() {
    let scene = load_textured(&png(), |d| {
        d["materials"] = json!([every_slot(0.5), every_slot(1.0)]);
        let primitive = d["meshes"][0]["primitives"][0].clone();
        d["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
        d["meshes"][0]["primitives"][1]["material"] = json!(1);
    });
    let scene = scene.unwrap();
    let all: Vec<(TextureSlot, &Texture)> = scene.objects.iter().flat_map(|o| o.material.textures()).collect();
    assert_eq!(all.iter().map(|(slot, _)| *slot).collect::<Vec<_>>(), [TextureSlot::ALL; 2].concat());
    for (slot, texture) in &all {
        assert!(Arc::ptr_eq(&texture.texels, &all[0].1.texels));
        assert_eq!(texture.encoding == Encoding::Srgb, *slot == TextureSlot::BaseColor);
    }
    assert_eq!(scene.objects[0].material.normal_scale, 0.5);
}

#[test]
fn what_nothing_calls_for_is_not_read() {
    // Neither an image nor a list that would be refused.
    let broken = |d: &mut Value| {
        d["images"] = json!([{"uri": "none.png"}]);
        d["textures"][0]["sampler"] = json!(7);
    };
    refused(&png(), broken, "sampler 7");
    let none = |change: &dyn Fn(&mut Value)| {
        let scene = load_textured(&png(), |d| {
            broken(d);
            change(d);
        });
        assert_eq!(scene.unwrap().objects[0].material.textures().count(), 0);
    };
    none(&|d| d["materials"][0] = every_slot(0.0));
    none(&|d| d["meshes"][0]["primitives"][0]["material"] = Value::Null);
    none(&|d| d["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0}));
    none(&|d| d["materials"][0] = json!({"occlusionTexture": {"index": 0}}));
}

#[test]
fn a_mesh_without_coordinates_gets_the_factors() {
    let scene = load_textured(&png(), |d| {
        let mut bare = d["meshes"][0]["primitives"][0].clone();
        bare["attributes"] = json!({"POSITION": 0});
        d["meshes"][0]["primitives"].as_array_mut().unwrap().push(bare);
    });
    let scene = scene.unwrap();
    let counts = scene.objects.iter().map(|object| object.material.textures().count());
    assert_eq!(counts.collect::<Vec<_>>(), [1, 0]);
    assert_eq!(scene.lacking.clauses(), ["textures: a missing `TEXCOORD_0` of mesh 0 (factors are drawn alone)"]);
}

#[test]
fn samplers_say_how_an_image_goes_on() {
    let code = |wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::MirroredRepeat => 33648,
        Wrap::ClampToEdge => 33071,
    };
    for s in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
        let material = material(&png(), |d| {
            d["textures"][0]["sampler"] = json!(1);
            d["samplers"] = json!([{}, {"wrapS": code(s), "wrapT": 33648, "magFilter": 9729, "minFilter": 9984}]);
        });
        assert_eq!(material.base_color_texture.unwrap().wrap, [s, Wrap::MirroredRepeat]);
    }
    let nearest = load_textured(&png(), |d| {
        d["textures"][0]["sampler"] = json!(0);
        d["samplers"] = json!([{"magFilter": 9728}]);
    });
    let says = "textures: `magFilter` NEAREST of `baseColorTexture` of material `gem` (texels are interpolated)";
    assert!(nearest.unwrap().lacking.clauses().contains(&says.to_owned()));
}

#[test]
fn transforms_belong_to_the_use_of_a_texture() {
    let transform =
        json!({"KHR_texture_transform": {"offset": [0.25, -1], "rotation": 0.5, "scale": [2, 0], "texCoord": 0}});
    let expected = TextureTransform { offset: Vec2::new(0.25, -1.0), rotation: 0.5, scale: Vec2::new(2.0, 0.0) };
    let material = material(&png(), |d| {
        d["extensionsRequired"] = json!(["KHR_texture_transform"]);
        d["materials"][0] = every_slot(1.0);
        // The extension's set of coordinates counts before the texture's own.
        d["materials"][0]["normalTexture"]["texCoord"] = json!(1);
        d["materials"][0]["normalTexture"]["extensions"] = transform.clone();
        d["materials"][0]["extensions"]["KHR_materials_volume"]["thicknessTexture"]["extensions"] = transform;
    });
    for (slot, texture) in material.textures() {
        let moved = [TextureSlot::Normal, TextureSlot::Thickness].contains(&slot);
        assert_eq!(texture.transform, if moved { expected } else { TextureTransform::IDENTITY }, "{slot:?}");
    }
}

#[test]
fn what_cannot_be_drawn_is_named_and_replaced_by_its_factor() {
    let named = |image: &[u8], change: &dyn Fn(&mut Value), says: &str| {
        let scene = load_textured(image, |d| change(d)).unwrap();
        assert_eq!(scene.objects[0].material.textures().count(), 0, "{says}");
        assert_eq!(scene.lacking.clauses(), [format!("textures: {says} of material `gem` (a factor is drawn alone)")]);
    };
    named(b"\xabKTX 11\xbb\r\n\x1a\n----", &|_| (), "`baseColorTexture` in KTX");
    named(b"GIF89a----", &|_| (), "`baseColorTexture` in GIF");
    for extension in ["MSFT_texture_dds", "EXT_texture_avif"] {
        let textures = json!([{"extensions": {extension: {"source": 0}}}]);
        let says = format!("`baseColorTexture` of `{extension}`");
        named(&png(), &|d| d["textures"] = textures.clone(), &says);
    }
    let base = |d: &mut Value, info: Value| d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info;
    let says = "`baseColorTexture` with `texCoord` 1";
    named(&png(), &|d| base(d, json!({"index": 0, "texCoord": 1})), says);
    let moved = json!({"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}});
    named(&png(), &|d| base(d, moved.clone()), says);
    // A fallback in a format that is read is taken.
    let both = json!([{"source": 0, "extensions": {"EXT_texture_webp": {"source": 9}}}]);
    assert!(material(&png(), |d| d["textures"] = both).base_color_texture.is_some());
}

#[test]
fn references_to_nothing() {
    refused(
        &png(),
        |d| d["textures"] = json!([]),
        "material 0 \"gem\", baseColorTexture refers to texture 0, but the file has 0",
    );
    refused(&png(), |d| d["textures"][0]["source"] = json!(3), "texture 0 refers to image 3, but the file has 1");
    refused(&png(), |d| d["textures"][0]["sampler"] = json!(0), "texture 0 refers to sampler 0, but the file has 0");
    refused(&png(), |d| d["images"][0]["bufferView"] = json!(9), "image 0 \"bark\" refers to bufferView 9");
    refused(&png(), |d| d["textures"][0] = json!({"name": "t"}), "texture 0 \"t\": it has no image: give it a source");
    refused(
        &png(),
        |d| d["images"][0] = json!({"name": "bark"}),
        "image 0 \"bark\": it has neither a uri nor a bufferView",
    );
    refused(&png(), |d| d["images"][0]["uri"] = json!("a.png"), "image 0 \"bark\": it has both a uri and a bufferView");
    refused(&png(), |d| d["bufferViews"][3]["byteLength"] = json!(1e6 as u64), "bufferView 3: it takes 1000000 bytes");
    let volume = |texture: Value| {
        move |d: &mut Value| {
            d["materials"][0]["extensions"] =
                json!({"KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": texture}});
        }
    };
    refused(&png(), volume(json!({"index": 4})), "thicknessTexture refers to texture 4");
    refused(&png(), volume(json!({})), "its thicknessTexture is not valid glTF: missing field `index`");
    refused(&png(), volume(json!(7)), "its thicknessTexture is not valid glTF");
    refused(&png(), |d| d["images"][0]["bufferView"] = json!(-1), "JSON is not valid glTF");
}

#[test]
fn images_that_are_not_there_or_out_of_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let load = |uri: &str| {
        let (mut document, data) = textured(&png());
        document["images"][0] = json!({"uri": uri});
        one_line(parse(&file(&document, &data), Some(folder.path())))
    };
    let message = load("none.png");
    assert!(
        message.starts_with("image 0's file") && message.contains("none.png") && message.contains("check its name"),
        "{message}"
    );
    for (uri, says) in [
        ("../bark.png", "image 0: its uri \"../bark.png\" leads out of the file's folder"),
        ("/etc/passwd", "not a relative path"),
        ("http://example.com/a.png", "not a relative path"),
        ("data:image/png;base64,!!!", "image 0: its base64 is damaged"),
        ("data:image/png,abc", "not base64"),
        ("", "it is a folder"),
    ] {
        let message = load(uri);
        assert!(message.contains(says), "{uri}: {message}");
    }
    refused(&png(), |d| d["images"][0] = json!({"uri": "a.png"}), "did not come from a file");
}

#[test]
fn damaged_images() {
    for whole in [png(), jpeg()] {
        for end in 0..whole.len() {
            // Nothing but the end of the file is missing from a PNG without its last chunk.
            if whole.starts_with(b"\x89PNG") && end >= whole.len() - 12 {
                continue;
            }
            let message = one_line(load_textured(&whole[..end], |_| ()));
            assert!(message.starts_with("image 0 \"bark\": it"), "cut at {end}: {message}");
        }
    }
    refused(&png()[..40], |_| (), "it cannot be decoded: ");
    refused(b"solid stone", |_| (), "image 0 \"bark\": its 11 bytes are no image; export it as PNG or JPEG");
}

#[test]
fn images_that_are_too_large() {
    let mut bytes = png();
    let large = 16384u32.to_be_bytes();
    bytes[16..24].copy_from_slice(&[large, large].concat());
    let says = "image 0 \"bark\": it has 16384 x 16384 texels, but at most 8192 on a side are read; scale it down";
    refused(&bytes, |_| (), says);
    bytes[16..24].fill(0xff);
    refused(&bytes, |_| (), "it has 4294967295 x 4294967295 texels");
    let mut bytes = jpeg();
    let frame = bytes.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    bytes[frame + 5..frame + 9].copy_from_slice(&[0x40, 0, 0x40, 0]);
    refused(&bytes, |_| (), says);
    // A header that is within the limits, with hardly any data: refused by the decoder.
    let mut bytes = png();
    bytes[16..24].copy_from_slice(&[8192u32.to_be_bytes(); 2].concat());
    refused(&bytes, |_| (), "it cannot be decoded");
}

#[test]
fn the_budget_of_images_counts_bytes() {
    use crate::gltf::budget::ImageBudget;
    let mut budget = ImageBudget::new();
    assert_eq!((budget.take([8192, 8192]), budget.take([8192, 8191])), (Ok(()), Ok(())));
    let message = budget.take([4096, 4096]).unwrap_err();
    assert!(message.contains("the images before it take 576 MiB, but at most 512 MiB"), "{message}");
    assert_eq!(budget.take([8192, 1]), Ok(()));
    assert!(budget.take([1, 1]).is_err());
}

#[test]
fn numbers_of_a_use_that_are_no_numbers() {
    let changed = |transform: Value| {
        move |d: &mut Value| {
            let info = json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
            d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info;
        }
    };
    let part = "material 0 \"gem\", baseColorTexture: ";
    for (transform, says) in [
        (json!({"offset": [null, 0]}), "its offset is an array of something else, but must be two numbers"),
        (json!({"offset": [1]}), "but must be two numbers"),
        (json!({"scale": "large"}), "its scale is a string, but must be two numbers"),
        (json!({"scale": [1, 1e39]}), "its scale has the number 1e39, but must be finite in single precision"),
        (json!({"rotation": null}), "its rotation is null, but must be a number"),
        (json!({"rotation": -1e39}), "must be finite in single precision"),
        (json!({"texCoord": -1}), "its texCoord is a number, but must be a whole number of at least 0"),
        (json!(3), "its KHR_texture_transform is a number, but must be an object"),
    ] {
        let message = one_line(load_textured(&png(), changed(transform)));
        assert!(message.starts_with(part) && message.contains(says), "{says}: {message}");
    }
    // JSON has no NaN.
    let (mut document, data) = textured(&png());
    changed(json!({"rotation": 12345.5}))(&mut document);
    let text = document.to_string().replace("12345.5", "NaN");
    let message = one_line(parse(&glb::container(text.as_bytes(), &data).unwrap(), None));
    assert!(message.starts_with("its JSON is not valid glTF"), "{message}");
    refused(
        &png(),
        |d| d["materials"][0]["normalTexture"] = json!({"index": 0, "scale": 1e39}),
        "the scale of its normalTexture is not finite",
    );
    let sampler = |d: &mut Value| {
        d["textures"][0]["sampler"] = json!(0);
        d["samplers"] = json!([{"wrapT": 10496}]);
    };
    refused(&png(), sampler, "sampler 0: its wrapT is not one of glTF's, 10497, 33071 and 33648");
}

#[test]
fn the_archived_form_of_a_material_is_read() {
    let material = material(&png(), |d| {
        let texture = d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].take();
        d["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 9}, "roughnessFactor": 1});
        let archived = json!({"diffuseFactor": [0.5, 0.25, 0.5, 1], "specularFactor": [0.04, 0.04, 0.04],
            "glossinessFactor": 0.75, "diffuseTexture": texture});
        d["materials"][0]["extensions"] = json!({"KHR_materials_pbrSpecularGlossiness": archived});
        d["extensionsRequired"] = json!(["KHR_materials_pbrSpecularGlossiness"]);
    });
    assert_eq!(material.roughness, 0.25);
    assert!(material.base_color.distance(Vec3::new(0.5, 0.25, 0.5)) < 1e-6, "{}", material.base_color);
    assert!(material.texture(TextureSlot::BaseColor).is_some());
}
