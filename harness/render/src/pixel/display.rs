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

/// Returns the code values and alpha, from 0 to 1, of a pixel with these samples, each linear radiance and coverage. In front of
/// `behind`, a linear colour, it is opaque; before nothing, its alpha is straight.
pub fn shown(samples: &[Vec4], exposure: f32, behind: Option<Vec3>) -> Vec4 {
    let light = |sample: &Vec4| match behind {
        Some(behind) => srgb::tone_curve(exposure * sample.truncate() + (1.0 - sample.w) * behind).extend(1.0),
        None if sample.w > 0.0 => sample.w * srgb::tone_curve(exposure * sample.truncate() / sample.w).extend(1.0),
        None => Vec4::ZERO,
    };
    let light: Vec4 = samples.iter().map(light).sum();
    let mean = light.truncate() / if light.w > 0.0 { light.w } else { 1.0 };
    srgb::encode_color(mean).extend(light.w / samples.len() as f32)
}
