//! Stones and metals by their colours.

use std::sync::LazyLock;

use glam::{Mat3, Vec3};

use crate::Object;
use crate::material::Metal;

/// Least share of its brightest part by which a colour is one: less is grey.
const SATURATION: f32 = 0.5;

/// Returns the preset of a stone's colour, which its base colour or its attenuation tells.
pub(super) fn stone_of(object: &Object) -> &'static str {
    let material = &object.material;
    let color = material.base_color * if material.absorbs() { material.attenuation_color } else { Vec3::ONE };
    let [red, green, blue] = color.to_array();
    let most = color.max_element();
    if most <= 0.0 || most - color.min_element() < SATURATION * most {
        return "diamond";
    }
    // Yellow, pink and turquoise stones have no preset.
    let is_alone = |part: f32, others: [f32; 2]| others.iter().all(|other| *other <= (1.0 - SATURATION) * part);
    match () {
        () if is_alone(red, [green, blue]) => "ruby",
        () if is_alone(green, [red, blue]) => "emerald",
        () if is_alone(blue, [red, green]) => "sapphire",
        () => "diamond",
    }
}

/// How much a difference of lightness counts beside one of chroma: it tells grey metals apart, and a quarter of it
/// leaves gold at a tenth of its light nearer to gold than to steel.
const LIGHTNESS: f32 = 0.25;

/// Returns the metal whose base colour is nearest to a colour in linear RGB, by lightness and by chroma over lightness.
pub(super) fn nearest_metal(color: Vec3) -> Metal {
    static COLORS: LazyLock<[(Metal, Vec3); Metal::ALL.len()]> =
        LazyLock::new(|| Metal::ALL.map(|metal| (metal, relative(metal.base_color()))));
    let of = relative(color);
    let nearest = COLORS.iter().min_by(|(_, one), (_, other)| one.distance(of).total_cmp(&other.distance(of)));
    nearest.map_or(Metal::Steel, |(metal, _)| *metal)
}

/// Returns a quarter of a colour's lightness, and its chroma over the lightness, which does not change as it gets darker.
fn relative(color: Vec3) -> Vec3 {
    let [lightness, a, b] = oklab(color).to_array();
    let chroma = |part: f32| if lightness > 0.0 { part / lightness } else { 0.0 };
    Vec3::new(LIGHTNESS * lightness, chroma(a), chroma(b))
}

/// Returns a colour in OKLab: lightness, green to red, blue to yellow (Ottosson, A perceptual color space for image processing,
/// 2020).
fn oklab(color: Vec3) -> Vec3 {
    let cones = Mat3::from_cols_array(&[
        0.412_221_46,
        0.211_903_5,
        0.088_302_46,
        0.536_332_54,
        0.680_699_55,
        0.281_718_84,
        0.051_445_995,
        0.107_396_96,
        0.629_978_7,
    ]);
    let opponents = Mat3::from_cols_array(&[
        0.210_454_26,
        1.977_998_5,
        0.025_904_037,
        0.793_617_8,
        -2.428_592_2,
        0.782_771_77,
        -0.004_072_047,
        0.450_593_7,
        -0.808_675_77,
    ]);
    opponents * (cones * color).map(f32::cbrt)
}
