//! Pictures that are drawn in tiles.

use lapidary_plan::Outside;
use lapidary_render::{GemOptions, Picture, Settings, render};
use lapidary_scene::Scene;
use lapidary_testing::gpu;

/// Wider than a tile of 8 × 8 samples a pixel, and not than one of 4 × 4.
const SIDE: u32 = 272;

/// Rays over the picture of the other bodies do not end at the borders of tiles: in four tiles a stone shows what it shows in one.
#[test]
fn rays_over_the_picture_cross_tiles() {
    let scene = Scene::named("tray").expect("built in");
    let drawn = |samples, outside| {
        let gem = GemOptions { outside: Some(outside), ..GemOptions::default() };
        render(gpu(), &scene, &Settings { samples, gem, ..Settings::of_size(SIDE, SIDE) }).expect("rendered")
    };
    let apart = |one: &Picture, other: &Picture| {
        let channels = one.linear.iter().zip(&other.linear).flat_map(|(one, other)| (0..3).map(|c| one[c] - other[c]));
        (channels.map(|difference| f64::from(difference * difference)).sum::<f64>() / one.linear.len() as f64).sqrt()
    };
    let by = |way| [4, 8].map(|samples| drawn(samples, way));
    let ([one, four], [alone, alone_in_four]) = (by(Outside::Screen), by(Outside::Environment));
    // Four samples a side are not eight, with other bodies or without.
    let (error, of_samples) = (apart(&one, &four), apart(&alone, &alone_in_four));
    assert!(error < 1.2 * of_samples && error < 0.15 * apart(&four, &alone), "{error}, of samples {of_samples}");
}
