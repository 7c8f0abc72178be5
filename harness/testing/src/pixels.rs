//! Values of a picture's pixels, with the rays and places that they belong to.

use glam::DVec3;
use lapidary_assay::extremum::larger;
use lapidary_render::Picture;
use lapidary_scene::Scene;

/// Returns the largest difference of the colours of two pictures' pixels.
pub fn furthest(one: &[[f32; 4]], other: &[[f32; 4]]) -> f32 {
    let difference = |(a, b): (&[f32; 4], &[f32; 4])| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, larger);
    one.iter().zip(other).map(difference).fold(0.0, larger)
}

/// Returns, for each pixel, the unit direction of the camera ray through its centre, and its value.
pub fn rays(scene: &Scene, picture: &Picture) -> Vec<(DVec3, [f32; 4])> {
    let (width, height) = (picture.width, picture.height);
    let world_from_clip = lapidary_scene::clip_from_world(scene, width, height).as_dmat4().inverse();
    let eye = scene.camera.eye.as_dvec3();
    let ray = |(index, pixel): (u32, &[f32; 4])| {
        let clip = |place: u32, side: u32| 2.0 * (f64::from(place) + 0.5) / f64::from(side) - 1.0;
        let (column, row) = (clip(index % width, width), clip(index / width, height));
        let far = world_from_clip.project_point3(DVec3::new(column, -row, 1.0));
        ((far - eye).normalize(), *pixel)
    };
    (0..).zip(&picture.linear).map(ray).collect()
}

/// Returns the colours of the pixels that lie wholly on the ball about the origin, each with its
/// place on the ball: the intersection of the sphere with the ray through the pixel's centre.
pub fn on_the_ball(scene: &Scene, picture: &Picture) -> Vec<(DVec3, DVec3)> {
    let radius = scene.objects[0].mesh.positions[0].as_dvec3().length();
    let eye = scene.camera.eye.as_dvec3();
    let mut found = Vec::new();
    for (direction, [r, g, b, alpha]) in rays(scene, picture) {
        let (along, beside) = (-eye.dot(direction), eye.cross(direction).length());
        // Skip the silhouette, where the outlines of mesh and sphere differ.
        if beside < 0.99 * radius && alpha == 1.0 {
            let place = eye + (along - (radius * radius - beside * beside).sqrt()) * direction;
            found.push((place, DVec3::new(r.into(), g.into(), b.into())));
        }
    }
    assert!(found.len() > 5000, "{} pixels", found.len());
    found
}
