//! The scanned head of `harness/assets`: a file with photographs as its textures.

use glam::{Vec2, Vec4};

use super::*;
use crate::{Encoding, Mesh, Texture, TextureTransform};

fn head() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/head.glb");
    load(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the texture's value at the vertex nearest to a place, seen from the front.
fn seen(mesh: &Mesh, texture: &Texture, [x, y]: [f32; 2]) -> Vec4 {
    let distance = |vertex: &usize| {
        let position = mesh.positions[*vertex];
        // The face, and not the back of the head behind it.
        if position.z > 0.0 { position.truncate().distance(Vec2::new(x, y)) } else { f32::INFINITY }
    };
    let nearest = (0..mesh.positions.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
    texture.at(mesh.uvs[nearest])
}

#[test]
fn the_head_has_its_face_the_right_way_up() {
    let scene = head();
    let mesh = only_mesh(&scene);
    assert_eq!((mesh.triangle_count(), mesh.uvs.len()), (17_684, mesh.positions.len()));
    let material = &scene.objects[0].material;
    let [color, normal] = [&material.base_color_texture, &material.normal_texture].map(|t| t.as_ref().unwrap());
    assert_eq!((color.encoding, normal.encoding), (Encoding::Srgb, Encoding::Linear));
    assert_eq!([color, normal].map(|t| (t.texels.width(), t.texels.height())), [(1024, 1024); 2]);
    // Red lips and dark brows on skin, and none of it if the picture stood on its head.
    let is_right = |texture: &Texture| {
        let color_at = |place| seen(mesh, texture, place);
        let [lips, brow, forehead, cheek] = [[-0.1, 0.45], [0.79, 2.03], [-0.1, 2.86], [-0.9, 0.9]].map(color_at);
        let skin = [forehead, cheek].iter().all(|color| color.x < 2.0 * color.y && color.y > 0.3);
        [skin, lips.x > 3.0 * lips.y, brow.y < 0.4 * forehead.y]
    };
    assert_eq!(is_right(color), [true; 3]);
    let below = TextureTransform { offset: Vec2::Y, rotation: 0.0, scale: Vec2::new(1.0, -1.0) };
    assert_eq!(is_right(&Texture { transform: below, ..color.clone() })[1..], [false; 2]);
    // Most of the skin is smooth: its normals in tangent space point out of it.
    let smooth = seen(mesh, normal, [-0.1, 2.86]);
    assert!(smooth.truncate().distance(glam::Vec3::new(0.5, 0.5, 1.0)) < 0.05, "{smooth}");
}
