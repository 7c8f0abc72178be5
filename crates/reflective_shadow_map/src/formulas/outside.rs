//! Promises of the functions outside their domains, for each clause of their `Outside:` lines.

use crate::{REFLECTIVE_SHADOW_MAP_NOTHING, ReflectiveShadowMapView};
use glam::{Vec2, Vec3, Vec4};
use lapidary_assay::outside::{Promise, finite, finite_values, holds, nothing, of_length, that, vector_up_to};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const TEXEL: &str = "reflective_shadow_map_texel";
    const SQUARED: &str = "finite as long as the squared length of the normal is";
    vec![
        finite("reflective_shadow_map_basis", "finite for a length up to 1e18", |draws| (of_length(draws, -126, 59),)),
        nothing("reflective_shadow_map_basis", "the vectors are neither unit nor square"),
        finite("reflective_shadow_map_clip", "finite as long as products of coordinates and 1 / extent are", |draws| {
            let near = draws.magnitude(-10, 10);
            let view = ReflectiveShadowMapView {
                origin: vector_up_to(draws, 60),
                lamp: draws.below(2),
                axis: draws.unit_vector(),
                extent: draws.magnitude(-40, 40),
                near,
                far: near * draws.between(1.5, 1e4),
            };
            (view, vector_up_to(draws, 60))
        }),
        holds(
            TEXEL,
            "beside the map for points that the map does not cover",
            |draws| {
                let w = draws.magnitude(-30, 30);
                let outside = draws.pick(&[1.0, -1.0]) * draws.between(1.001, 1e6);
                let inside = draws.between(-1.0, 1.0);
                let (x, y) = if draws.below(2) == 0 { (outside, inside) } else { (inside, outside) };
                let w = if draws.below(4) == 0 { -w } else { w };
                (Vec4::new(x * w, y * w, 0.5 * w, w), 1.0 + draws.below(4096) as f32)
            },
            |(clip, size): (Vec4, f32), texel: Vec2| {
                if clip.w <= 0.0 {
                    return that(texel == Vec2::splat(REFLECTIVE_SHADOW_MAP_NOTHING), || {
                        format!("the texel is {texel}")
                    });
                }
                let beside = texel.cmplt(Vec2::ZERO).any() || texel.cmpgt(Vec2::splat(size)).any();
                that(beside && texel.is_finite(), || format!("the texel is {texel} of {size}"))
            },
        ),
        holds(
            "reflective_shadow_map_cosine",
            SQUARED,
            |draws| (of_length(draws, -126, 62), draws.unit_vector()),
            |_: (Vec3, Vec3), cosine: f32| that((0.0..=1.0).contains(&cosine), || format!("the cosine is {cosine}")),
        ),
        holds(
            "reflective_shadow_map_height",
            SQUARED,
            |draws| (1e6 * draws.in_cube(), 1e6 * draws.in_cube(), of_length(draws, -126, 62)),
            |_: (Vec3, Vec3, Vec3), height: f32| finite_values(&[height]),
        ),
    ]
}
