use super::*;
use lapidary_scene::{Encoding, TextureTransform};
use std::sync::Arc;

/// Returns an image of normals that tilt along u as a wave with this many texels.
fn waves(side: u32, length: f32) -> Texture {
    let code = |value: f32| ((0.5 * value + 0.5) * 255.0).round() as u8;
    let texel = |column: u32| {
        let tilt = 0.5 * (std::f32::consts::TAU * (column as f32 + 0.5) / length).sin();
        [code(tilt), code(0.0), code((1.0 - tilt * tilt).sqrt()), 255]
    };
    let bytes = (0..side * side).flat_map(|place| texel(place % side)).collect();
    Texture::new(Arc::new(Texels::new(side, side, bytes).expect("an image")), Encoding::Linear)
}

/// The Gaussian leaves exp(-(2 pi s / l)^2 / 2) of a wave of length l; the image's 8 bits are the tolerance.
#[test]
fn a_blur_leaves_of_a_wave_what_a_gaussian_leaves() {
    let texture = waves(64, 16.0);
    let normals = Normals::of(&texture, 1.0);
    let wrap = [Wrap::Repeat; 2];
    let amplitude = |normals: &[Vec3]| normals.iter().map(|normal| normal.x).fold(0.0, f32::max);
    let sharp = amplitude(&normals.blurred(wrap, 0.0));
    for width in [0.5f32, 1.0, 2.0, 4.0] {
        let expected = (-0.5 * (std::f32::consts::TAU * width / 16.0).powi(2)).exp();
        let found = amplitude(&normals.blurred(wrap, width)) / sharp;
        println!("{width}: {found} of {expected}");
        // A mean of unit vectors is shorter, so that its direction tilts a little more.
        assert!(found > expected - 0.01 && found < expected / (1.0 - 0.13) + 0.01, "{width}: {found} {expected}");
    }
    // Without an extent on the body nothing is blurred.
    assert_eq!(normals.blurred(wrap, f32::NAN), normals.normals);
}

#[test]
fn layers_are_the_image_and_a_blur_for_each_colour() {
    let texture = waves(32, 8.0);
    let layers = Normals::of(&texture, 1.0).layers(texture.wrap, Vec3::new(4.0, 1.0, 0.0));
    assert_eq!((layers.size, layers.layers.len()), ([32, 32], 4));
    let amplitude = |layer: usize| layers.layers[layer].iter().map(|slopes| slopes.x).fold(0.0, f32::max);
    let [sharp, red, green, blue] = [0, 1, 2, 3].map(amplitude);
    assert!(red < green && green < blue && blue == sharp && sharp > 0.45, "{red} {green} {blue} {sharp}");
}

#[test]
fn slopes_are_scaled_before_they_are_normals() {
    let texture = waves(32, 8.0);
    let scaled = |scale: f32| Normals::of(&texture, scale).normals;
    assert!(scaled(0.0).iter().all(|normal| normal.distance(Vec3::Z) < 1e-6));
    for (one, twice) in scaled(1.0).iter().zip(scaled(2.0)) {
        assert!((twice.x / twice.z - 2.0 * one.x / one.z).abs() < 1e-4, "{one} {twice}");
    }
}

#[test]
fn a_texels_length_is_that_of_its_side_on_the_body() {
    // A square of 3 units with the image twice along each edge.
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mesh = Mesh {
        positions: corners.iter().map(|[x, y]| 3.0 * Vec3::new(*x, *y, 0.0)).collect(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.iter().map(|corner| 2.0 * Vec2::from_array(*corner)).collect(),
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    };
    let texture = waves(64, 8.0);
    assert!((texel_length(&mesh, &texture) - 3.0 / 128.0).abs() < 1e-6);
    let turned = TextureTransform { rotation: 1.0, scale: Vec2::splat(0.5), ..TextureTransform::IDENTITY };
    assert!((texel_length(&mesh, &Texture { transform: turned, ..texture }) - 3.0 / 64.0).abs() < 1e-6);
}
