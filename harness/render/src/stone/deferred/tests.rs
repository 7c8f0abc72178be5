use super::COMPOSITE;
use crate::drawing::scene_frame::Texts;
use crate::pixel::Viewer;
use crate::render::render_from;
use crate::settings::{GemOptions, Settings};
use glam::Vec3;
use lapidary_assay::extremum::larger;
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_scene::Scene;

/// The paper's section 4.3.1 with a real depth buffer: its 32-bit values are off by 2^-24 of
/// the range from near to far; the interpolation of clip coordinates and the product with the
/// inverse matrix add a few units in the last place of the distance.
#[test]
fn positions_come_back_from_the_depth_buffer() {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
    let shown =
        "return vec4f(textureLoad(reflectance, texel, 0).rgb * surroundings_radiance(reflected) + inside.rgb, 1.0f);";
    let source = lapidary_wgsl::recipe_source(COMPOSITE);
    assert!(source.contains(shown));
    // Every binding stays in use, and the output is the position.
    let planted = source.replace(shown, &format!("if (inside.r < 0.0f) {{ {shown} }}\n    return vec4f(world, 1.0f);"));
    for name in ["brilliant", "prism", "bunny_stone"] {
        let scene = Scene::named(name).expect("built in");
        let rung = "proxy-1".parse().expect("a rung");
        let settings = Settings {
            rung,
            samples: 1,
            gem: GemOptions { deferred: true, ..GemOptions::default() },
            ..Settings::of_size(128, 128)
        };
        let gem = lapidary_wgsl::recipe_source(rung.recipe());
        let texts = Texts { rung: Some(&gem), composite: Some(&planted) };
        let picture = render_from(gpu, &scene, &settings, texts, &mut |_, _| {}).expect("rendered");
        let viewer = Viewer::new(&scene, 128, 128);
        let (mut worst, mut seen) = (0f32, 0);
        for (index, &[x, y, z, alpha]) in (0..).zip(&picture.linear) {
            let (row, column): (u32, u32) = (index / 128, index % 128);
            let point = viewer.see(&scene.objects[0].mesh, f64::from(column) + 0.5, f64::from(row) + 0.5);
            let (Some(point), true) = (point, alpha > 0.0) else { continue };
            let eye = scene.camera.eye;
            // Perpendicular to the ray, no accuracy is lost. Along the ray, the error depends
            // on the depth and grows with the slant of the facet: if it is seen edge-on, the
            // two points differ by which point of the pixel is meant.
            let (direction, from_eye) = ((point.position - eye).normalize(), Vec3::new(x, y, z) - eye);
            worst = larger(worst, from_eye.cross(direction).length() / point.position.distance(eye));
            let along = (from_eye.dot(direction) - point.position.distance(eye)).abs();
            worst = larger(worst, along / point.position.distance(eye));
            seen += 1;
        }
        println!("{name}: {seen} pixels, off by {worst:e} of the distance at most");
        assert!(seen > 1000 && worst <= 16.0 * f32::EPSILON, "{name}: {seen} pixels, {worst:e}");
    }
}
