//! Images and colours of vertices, on clear bodies and on others seen through them.

use super::*;
use glam::{Vec2, Vec4};
use lapidary_scene::{Coverage, Encoding, Texels, Texture, TextureTransform, Wrap};
use std::sync::Arc;

/// A block whose texture coordinates run from 0 to 1 over the picture.
fn block(half: f64, material: Material) -> Object {
    let mesh = cube(half);
    let uv = |position: &Vec3| Vec2::new(0.5, 0.5) + 0.5 * Vec2::new(position.x, -position.y) / half as f32;
    let uvs = mesh.positions.iter().map(uv).collect();
    Object::new("block", Mesh { uvs, ..mesh }, material)
}

/// An image of these columns, each as high as wide, which ends at its edges.
fn image(columns: &[[u8; 4]], encoding: Encoding) -> Option<Texture> {
    let side = columns.len() as u32;
    let bytes = (0..side).flat_map(|_| columns.iter().flatten().copied()).collect();
    let texels = Texels::new(side, side, bytes).expect("an image");
    Some(Texture { wrap: [Wrap::ClampToEdge; 2], ..Texture::new(Arc::new(texels), encoding) })
}

/// Returns the column of the picture that shows this x at the block's front, at a distance of 4.5.
fn column(x: f64) -> u32 {
    ((x / (9.0 * f64::tan(0.25)) + 0.5) * f64::from(SIDE)) as u32
}

/// The colours in the middles of the left and of the right half of a block of half its size.
fn halves(picture: &Picture) -> [DVec3; 2] {
    [-0.25, 0.25].map(|x| {
        let place = picture.width * (picture.height / 2) + column(x);
        colors(picture).nth(place as usize).expect("a pixel")
    })
}

fn expect(objects: Vec<Object>, expected: [DVec3; 2], what: &str) {
    for rung in ["by-material", "reference"] {
        let picture = drawn(&scene(objects.clone()), &of_rung(rung));
        for (seen, expected) in halves(&picture).into_iter().zip(expected) {
            assert!((seen - expected).abs().max_element() < 3e-3, "{what}, {rung}: {seen} for {expected}");
        }
        assert!(picture.notes.is_empty(), "{what}, {rung}: {:?}", picture.notes);
    }
}

const RED: [u8; 4] = [188, 0, 0, 255];
const GREEN: [u8; 4] = [0, 188, 0, 255];
/// The light of the sRGB code 188.
const LIT: f64 = 0.502_886;

/// Light through a block of index 1 has the colour that its image has where it came in, in front; through a thin wall, too.
#[test]
fn an_image_colors_what_comes_through() {
    for thickness in [0.0, 1.0] {
        let base_color_texture = image(&[RED, GREEN], Encoding::Srgb);
        let tinted = Material { base_color_texture, thickness, base_color: Vec3::new(0.5, 1.0, 1.0), ..glass(1.0) };
        expect(vec![block(0.5, tinted)], [DVec3::X * 0.5 * LIT, DVec3::Y * LIT], "a block");
    }
}

/// Where its image lets less light in, a block of index 1 is that much matt.
#[test]
fn an_image_says_where_light_enters() {
    let transmission_texture = image(&[[51, 0, 0, 255], [204, 0, 0, 255]], Encoding::Linear);
    let partly = Material { transmission_texture, base_color: Vec3::new(1.0, 0.5, 1.0), ..glass(1.0) };
    let within = ball(0.4, DVec3::ZERO, matte(Vec3::splat(0.25)));
    let mix = |share: f64| DVec3::new(1.0, 0.5, 1.0) * (share * 0.25 + 1.0 - share);
    expect(vec![block(0.5, partly), within], [mix(0.2), mix(0.8)], "a block");
}

#[test]
fn colors_of_vertices_color_what_comes_through() {
    let mut tinted = block(0.5, glass(1.0));
    tinted.mesh.colors = tinted.mesh.positions.iter().map(|at| Vec3::new(0.5 + at.x, 1.0, 0.5 - at.x)).collect();
    let at = |x: f64| DVec3::new(0.5 + x, 1.0, 0.5 - x);
    // Of the pixels, whose middles are not quite those of the halves.
    let seen = |x: f64| 9.0 * f64::tan(0.25) * ((f64::from(column(x)) + 0.5) / f64::from(SIDE) - 0.5);
    expect(vec![tinted], [-0.25, 0.25].map(|x| at(seen(x))), "a block");
}

/// A card behind a pane of index 1 shows its image, and a hole where its alpha is below the cutoff.
#[test]
fn an_image_behind_a_pane_is_seen() {
    let pane = Object::new("pane", cube(0.9), Material { thickness: 0.0, ..glass(1.0) });
    let card = |columns: &[[u8; 4]], coverage| {
        let base_color_texture = image(columns, Encoding::Srgb);
        block(0.5, Material { base_color_texture, coverage, ..matte(Vec3::ONE) })
    };
    let whole = card(&[RED, GREEN], None);
    expect(vec![pane.clone(), whole], [DVec3::X * LIT, DVec3::Y * LIT], "a card");
    let mask = Some(Coverage { share: 1.0, cutoff: Some(0.5) });
    let holed = card(&[RED, [0, 188, 0, 0]], mask);
    expect(vec![pane, holed], [DVec3::X * LIT, DVec3::ONE], "a card with a hole");
}

/// An opaque body stays whole whatever the alpha of its image, beside one that is not.
#[test]
fn alpha_counts_where_the_material_says_so() {
    let pane = Object::new("pane", cube(0.9), Material { thickness: 0.0, ..glass(1.0) });
    let clear_image = image(&[[188, 0, 0, 0], [0, 188, 0, 0]], Encoding::Srgb);
    let whole = block(0.5, Material { base_color_texture: clear_image, ..matte(Vec3::ONE) });
    let coverage = Some(Coverage { share: 0.5, cutoff: None });
    let sheer = ball(0.1, DVec3::new(0.0, 0.6, 0.0), Material { coverage, ..matte(Vec3::ONE) });
    expect(vec![pane, whole, sheer], [DVec3::X * LIT, DVec3::Y * LIT], "an opaque card");
}

/// Images that repeat or are mirrored, moved and turned, of several sizes and in all slots, with colours of vertices, on smooth,
/// flat, clear and matte bodies: beside the reference.
#[test]
fn images_go_on_as_their_samplers_say() {
    let textured = |size: [u32; 2], encoding, wrap, place: usize| {
        let wave =
            |x: u32, y: u32, axis: u32| (110.0 + 70.0 * f32::sin(0.5 * (x + axis * y) as f32 + place as f32)) as u8;
        let texel = |y: u32, x: u32| [wave(x, y, 0), wave(x, y, 1), 230, wave(y, x, 2)];
        let bytes = (0..size[1]).flat_map(|y| (0..size[0]).flat_map(move |x| texel(y, x))).collect();
        let texels = Arc::new(Texels::new(size[0], size[1], bytes).expect("an image"));
        let (offset, scale) = (Vec2::new(0.3, -1.2), Vec2::new(1.7, 1.1));
        let transform = TextureTransform { offset, rotation: 0.4, scale };
        Some(Texture { wrap, transform, ..Texture::new(texels, encoding) })
    };
    let wraps = [[Wrap::Repeat, Wrap::MirroredRepeat], [Wrap::MirroredRepeat, Wrap::ClampToEdge], [Wrap::Repeat; 2]];
    let painted = |material: Material, place: usize| Material {
        base_color_texture: textured([13, 7], Encoding::Srgb, wraps[place % 3], place),
        normal_texture: textured([16, 11], Encoding::Linear, wraps[(place + 1) % 3], place + 1),
        normal_scale: 0.2,
        transmission_texture: textured([5, 12], Encoding::Linear, wraps[(place + 2) % 3], place + 2),
        ..material
    };
    let colored = |mut object: Object| {
        object.mesh.colors =
            object.mesh.positions.iter().map(|at| (0.6 + 0.4 * *at).clamp(Vec3::ZERO, Vec3::ONE)).collect();
        object
    };
    let smooth = Material { normals: Normals::File, ..glass(1.3) };
    let objects = vec![
        colored(block(0.5, painted(glass(1.4), 0))),
        ball(0.4, DVec3::new(0.75, 0.1, 0.2), painted(smooth, 1)),
        colored(ball(0.6, DVec3::new(0.1, -0.3, -1.6), painted(matte(Vec3::new(1.0, 0.8, 0.6)), 2))),
    ];
    let settings = |rung| Settings { environment: Environment::Studio, ..of_rung(rung) };
    let [rung, reference] = ["scene-64", "reference"].map(|rung| drawn(&scene(objects.clone()), &settings(rung)));
    let most = difference(&rung, &reference, 20).1;
    assert!(most < 0.01, "{most}");
}

/// Of an image whose texels are smaller than the rays' distance, a level is read: the mean of black and white, not one of them.
#[test]
fn fine_images_are_read_by_their_levels() {
    let columns: Vec<[u8; 4]> = (0..512).map(|x| if x % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }).collect();
    let pane = Object::new("pane", cube(0.9), Material { thickness: 0.0, ..glass(1.0) });
    let card = block(0.5, Material { base_color_texture: image(&columns, Encoding::Linear), ..matte(Vec3::ONE) });
    let picture = drawn(&scene(vec![pane, card]), &of_rung("by-material"));
    for seen in halves(&picture) {
        assert!((seen - 0.5).abs().max_element() < 5e-3, "{seen}");
    }
}

/// Slopes by an image turn reflection and refraction as the surface's own would: beside the reference.
#[test]
fn slopes_by_an_image_refract() {
    let waves: Vec<[u8; 4]> =
        (0..16).map(|x| [(128.0 + 60.0 * f32::sin(0.8 * x as f32)) as u8, 128, 230, 255]).collect();
    let normal_texture = image(&waves, Encoding::Linear);
    let lamps = |u: f32| Vec4::new(0.2 + u, 0.4, 1.0 - u, 1.0).to_array();
    let pixels = (0..64 * 32).map(|place| lamps((place % 64) as f32 / 64.0)).collect();
    let environment = Environment::Map(EnvironmentMap { width: 64, height: 32, pixels });
    for thickness in [0.0, 1.0] {
        let wavy = Material { normal_texture: normal_texture.clone(), thickness, ..glass(1.5) };
        let objects = vec![block(0.7, wavy), ball(0.5, DVec3::new(0.0, 0.0, -2.0), matte(Vec3::new(0.9, 0.2, 0.1)))];
        let [rung, reference] = ["scene-64", "reference"].map(|rung| {
            drawn(&scene(objects.clone()), &Settings { environment: environment.clone(), ..of_rung(rung) })
        });
        // Of all but the pixels at edges.
        let most = difference(&rung, &reference, 20).1;
        assert!(most < 0.01, "thickness {thickness}: {most}");
        let flat = drawn(
            &scene(
                objects
                    .iter()
                    .map(|object| Object {
                        material: Material { normal_texture: None, ..object.material.clone() },
                        ..object.clone()
                    })
                    .collect(),
            ),
            &Settings { environment: environment.clone(), ..of_rung("scene-64") },
        );
        let without = difference(&flat, &reference, 20).1;
        assert!(without > 4.0 * most, "thickness {thickness}: {without} without the image, {most} with it");
    }
}
