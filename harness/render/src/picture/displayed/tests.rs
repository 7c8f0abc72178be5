use super::*;
use crate::pixel::display::{backdrop, shown};
use crate::render::render;
use glam::{Vec2, Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_gpu::AdapterChoice;
use lapidary_plan::Rung;
use lapidary_scene::Scene;

fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"))
}

/// Displays samples, row by row, with the display recipe.
fn displayed(samples: &[[f32; 4]], settings: &Settings) -> Picture {
    let (width, height) = (settings.width, settings.height);
    let pixels = width as usize * height as usize;
    let (linear, encoded) = (vec![[0.0; 4]; pixels], vec![[0; 4]; pixels]);
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    let display = Display::new(gpu(), settings).expect("a pass");
    display.show(&display.tiles[0], samples, &mut picture).expect("displayed");
    picture
}

/// Each pixel shows the mean of its samples, each composited over the backdrop and tone-mapped, and
/// keeps the mean of their radiance.
#[test]
fn samples_are_tone_mapped_before_they_are_averaged() {
    let (width, height) = (24, 16);
    for samples in [1, 3, 4, 8] {
        let settings = Settings { samples, exposure: 0.7, ..Settings::of_size(width, height) };
        let mut draws = Draws::of_row(7, samples.into());
        // Samples like a stone's: mostly dark, a few lights of radiance up to 20, and holes that
        // show the backdrop.
        let of_draws = |_| {
            let strength = draws.between(-9.0, 4.3).exp2();
            let colour = [0; 3].map(|_| strength * draws.between(0.5, 1.0));
            let [r, g, b] = if draws.below(4) == 0 { [0.0; 3] } else { colour };
            [r, g, b, f32::from(u8::from([r, g, b] != [0.0; 3]))]
        };
        let grid: Vec<[f32; 4]> = (0..width * height * samples * samples).map(of_draws).collect();
        let picture = displayed(&grid, &settings);
        let mut differing = 0;
        for (index, (encoded, linear)) in (0..).zip(picture.encoded.iter().zip(&picture.linear)) {
            let (column, row) = (index % width, index / width);
            let sample = |k: u32| (row * samples + k / samples) * width * samples + column * samples + k % samples;
            let pixel_samples: Vec<Vec4> =
                (0..samples * samples).map(|k| Vec4::from_array(grid[sample(k) as usize])).collect();
            let place = Vec2::new(column as f32, row as f32) + 0.5;
            let behind = backdrop(place, Vec2::new(width as f32, height as f32));
            let expected = 255.0 * shown(&pixel_samples, settings.exposure, Some(behind)).truncate();
            // Half a step of rounding, plus the difference of the formulas: 64 sums of 2^-24, 20
            // ulp of the curve and 6e-6 of the encoding, times 255.
            let found = Vec3::from_array([0, 1, 2].map(|k| f32::from(encoded[k])));
            assert!((found - expected).abs().cmple(Vec3::splat(0.503)).all(), "{column} {row}: {found} {expected}");
            let mean = pixel_samples.iter().sum::<Vec4>() / pixel_samples.len() as f32;
            let bound = 64.0 * f32::EPSILON * pixel_samples.iter().copied().fold(Vec4::ZERO, Vec4::max);
            assert!((Vec4::from_array(*linear) - mean).abs().cmple(bound).all(), "{column} {row}: {linear:?} {mean}");
            // The pixel if the mean were tone-mapped instead.
            let late = 255.0 * shown(&[mean], settings.exposure, Some(behind)).truncate();
            differing += u32::from((late - expected).abs().max_element() > 8.0);
        }
        println!("{samples}: {differing} of {} pixels would differ by more than 8 steps", width * height);
        assert_eq!(samples > 1, differing > width * height / 4, "{samples}: {differing}");
    }
}

/// Without a backdrop, alpha is the share that is covered, and the colour that of the covered samples alone: over any ground, the
/// pixel is what a compositor that mixes emitted light makes of it.
#[test]
fn without_a_backdrop_the_alpha_is_straight() {
    let settings = Settings { samples: 2, backdrop: false, exposure: 0.5, ..Settings::of_size(1, 1) };
    let (light, none) = ([0.8, 0.4, 0.2, 1.0], [0.0; 4]);
    let half = [0.2, 0.1, 0.05, 0.25];
    for (samples, alpha) in [
        ([light, light, light, light], 1.0),
        ([light, none, light, none], 0.5),
        ([none, none, half, none], 0.0625),
        ([light, half, half, none], 0.375),
        ([none, none, none, none], 0.0),
    ] {
        let [red, green, blue, found] = displayed(&samples, &settings).encoded[0].map(f32::from);
        let expected = 255.0 * shown(&samples.map(Vec4::from_array), 0.5, None);
        assert!((found - 255.0 * alpha).abs() <= 0.5, "{found} {alpha}");
        // Each sample has the same colour.
        let colour = if alpha > 0.0 { 255.0 * shown(&[Vec4::from_array(light)], 0.5, None) } else { Vec4::ZERO };
        let found = Vec4::new(red, green, blue, found);
        assert!((found - expected).abs().max_element() <= 0.503, "{found} {expected}");
        assert!((found - colour).truncate().abs().max_element() <= 0.503, "{found} {colour}");
    }
}

/// A pixel half covered by a light of radiance 20 is displayed halfway, in linear emission, between
/// the light and the area behind it, however bright the light is.
#[test]
fn an_edge_of_a_light_has_a_middle() {
    let settings = Settings { samples: 2, ..Settings::of_size(1, 1) };
    let (light, dark) = ([20.0, 20.0, 20.0, 1.0], [0.0, 0.0, 0.0, 1.0]);
    let picture = displayed(&[light, dark, light, dark], &settings);
    // The curve maps 20 to 0.997, half of which is code 187. It would map the mean, 10, to 0.994,
    // which is code 254.
    assert!(picture.encoded[0][..3].iter().all(|code| (186..=188).contains(code)), "{:?}", picture.encoded);
    assert_eq!(picture.linear, [[10.0, 10.0, 10.0, 1.0]]);
}

/// The texels of a tile fit the limits of every device, for any number of samples.
#[test]
fn tiles_are_small() {
    for samples in 1..=crate::settings::MOST_SAMPLES {
        let side = Tile::side(samples);
        assert!(side * samples <= 2048 && side >= 256, "{samples}: {side}");
        let tiles: Vec<Tile> = Tile::all(1000, 700, samples).collect();
        assert_eq!(tiles.iter().map(|tile| tile.width * tile.height).sum::<u32>(), 700_000);
        assert!(tiles.iter().all(|tile| tile.width.max(tile.height) <= side));
    }
}

/// Tiles meet without a seam. With eight samples the second tile begins at column 256; with four
/// there is only one tile.
#[test]
fn tiles_meet() {
    let scene = Scene::named("brilliant").expect("built in");
    let rung = "surface".parse().expect("a rung");
    let of_samples = |samples| Settings { rung, samples, ..Settings::of_size(320, 320) };
    let [eight, four] = [8, 4].map(|samples| render(gpu(), &scene, &of_samples(samples)).expect("rendered"));
    let difference = |place: usize| f64::from(eight.encoded[place][1].abs_diff(four.encoded[place][1]));
    let of_column = |column: usize| (0..320).map(|row| difference(320 * row + column)).sum::<f64>() / 320.0;
    let all = (0..320).map(of_column).sum::<f64>() / 320.0;
    for column in 255..=256 {
        println!("column {column}: {:.2} steps in the mean, {all:.2} everywhere", of_column(column));
        assert!(of_column(column) < 3.0 * all + 1.0, "{column}");
    }
}

/// Samples of the reference are displayed like those of a rung: a stone without transmitted light
/// reflects alike in both.
#[test]
fn the_reference_is_shown_alike() {
    let mut scene = Scene::named("brilliant").expect("built in");
    scene.objects[0].material.dispersion = lapidary_scene::Dispersion::None;
    let surface = Settings { rung: Rung::Surface, ..Settings::of_size(64, 64) };
    let drawn = render(gpu(), &scene, &surface).expect("rendered");
    scene.objects[0].material.base_color = Vec3::ZERO;
    let reference = Settings {
        rung: Rung::Reference,
        reference: crate::settings::ReferenceOptions { wavelengths: 5, ..surface.reference },
        ..surface.clone()
    };
    let followed = render(gpu(), &scene, &reference).expect("rendered");
    let differing = |one: &Picture| {
        let pairs = one.encoded.iter().zip(&drawn.encoded);
        pairs.filter(|(a, b)| (0..3).any(|k| a[k].abs_diff(b[k]) > 2)).count()
    };
    let mut means = followed.clone();
    encode(gpu(), &reference, &mut means).expect("encoded");
    let (samples, means) = (differing(&followed), differing(&means));
    println!("{samples} pixels differ, {means} where means are shown");
    // A sample on an edge may fall to either side.
    assert!(samples <= 64 && means > 4 * samples.max(8), "{samples} {means}");
}
