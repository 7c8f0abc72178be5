//! The recipe `display` in Rust: from a pixel's samples to code values.

use glam::{Vec2, Vec3, Vec4};
use lapidary_srgb as srgb;

/// Linear RGB of the dark seamless paper behind the scene, at `pixel` of a picture of `size`, both
/// in pixels.
pub fn backdrop(pixel: Vec2, size: Vec2) -> Vec3 {
    let from_light = (pixel - Vec2::new(0.5, 0.55) * size) / size.min_element();
    let falloff = (-3.0 * from_light.dot(from_light)).exp();
    let (edge, middle) = (Vec3::new(0.006, 0.007, 0.010), Vec3::new(0.055, 0.062, 0.078));
    edge * (1.0 - falloff) + middle * falloff
}

/// Returns the code values, from 0 to 1, of a pixel with these samples, each linear radiance and
/// coverage, in front of `behind`.
pub fn shown(samples: &[Vec4], exposure: f32, behind: Vec3) -> Vec3 {
    let light = |sample: &Vec4| srgb::tone_curve(exposure * sample.truncate() + (1.0 - sample.w) * behind);
    srgb::encode_color(samples.iter().map(light).sum::<Vec3>() / samples.len() as f32)
}
