//! Texture-space diffusion on the device, against the exact convolution on a cylinder: the number
//! of taps that it needs, charts with empty space between them, and seams.

use glam::Vec3;
use lapidary_assay::extremum::larger;
use lapidary_cdrf::oracle as exact;
use lapidary_gpu::Gpu;
use lapidary_render::frame::{Builder, Executor};
use lapidary_render::texture_diffusion::{Chart, Taps, TextureDiffusion};
use lapidary_texture_diffusion as mirror;
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::sync::{Arc, LazyLock, Mutex};

type Half = exr::prelude::f16;

/// Texels around the cylinder.
const AROUND: u32 = 1024;
/// Largest error that the page promises.
const BOUND: f64 = 1e-3;
/// Angle of a texel on a cylinder of radius 1, in radians.
const TEXEL: f64 = TAU / AROUND as f64;
/// Width of the narrowest Gaussian, in radians, that a bilinear lookup of 1024 texels shows to
/// 1e-3.
const RESOLVED: f64 = 0.005;

/// Returns a texture filled by `f`, row by row.
fn filled<T>(size: [u32; 2], f: impl Fn(u32, u32) -> T) -> Vec<T> {
    (0..size[1])
        .flat_map(|row| (0..size[0]).map(move |column| (column, row)))
        .map(|(column, row)| f(column, row))
        .collect()
}

/// Blurs `irradiance` (red, green, blue and coverage) on the device and returns the result in the
/// same form.
fn diffuse(
    gpu: &Gpu,
    size: [u32; 2],
    repeats: [bool; 2],
    (irradiance, stretch): (&[[f32; 4]], &[[f32; 2]]),
    taps: &Taps,
    charts: &[Chart],
) -> Vec<[f32; 4]> {
    let mut builder = Builder::new(Some(gpu));
    let diffusion = TextureDiffusion::new(&mut builder, size, repeats).expect("the recipe");
    diffusion.encode(&mut builder, taps, charts);
    builder.read_whole("diffused", diffusion.diffused);
    let executor = Executor::new(gpu, builder.finish()).expect("made");
    let halves: Vec<u8> =
        irradiance.iter().flatten().flat_map(|value| Half::from_f32(*value).to_bits().to_le_bytes()).collect();
    executor.write_texture(diffusion.irradiance, size, &halves);
    executor.write_texture(diffusion.stretch, size, bytemuck::cast_slice(stretch));
    let mut found = Vec::new();
    executor
        .run(|_, texels| {
            found.extend(texels.chunks_exact(8).map(|texel| {
                let half = |channel: usize| {
                    Half::from_bits(u16::from_le_bytes([texel[2 * channel], texel[2 * channel + 1]])).to_f32()
                };
                [half(0), half(1), half(2), half(3)]
            }));
        })
        .expect("run");
    found
}

/// Returns the light on a cylinder at a texel's centre.
fn lit(column: u32) -> f32 {
    (TAU * (f64::from(column) + 0.5) / f64::from(AROUND)).cos().max(0.0) as f32
}

/// Returns the convolution at every half texel from the lit side to the side away from the light.
/// The edge of each texel comes before its centre.
fn wanted(sigma: f64) -> Arc<Vec<f64>> {
    // Cached, because every number of taps needs the same values.
    static KNOWN: LazyLock<Mutex<HashMap<u64, Arc<Vec<f64>>>>> = LazyLock::new(Mutex::default);
    if let Some(known) = KNOWN.lock().expect("no panic inside").get(&sigma.to_bits()) {
        return known.clone();
    }
    let place = |half: u32| (0.5 * f64::from(half) * TEXEL).cos();
    let found = Arc::new((0..AROUND).map(|half| exact::accurate(place(half), sigma)).collect::<Vec<f64>>());
    KNOWN.lock().expect("no panic inside").insert(sigma.to_bits(), found.clone());
    found
}

/// Returns the largest errors of a row of texels under a bilinear lookup: at the texels' centres
/// alone, and at their edges too.
fn errors(texels: &[f64], sigma: f64) -> [f64; 2] {
    let wanted = wanted(sigma);
    let mut most = [0.0f64; 2];
    for (half, wanted) in wanted.iter().enumerate() {
        let texel = half / 2;
        if half % 2 == 1 {
            most[0] = larger(most[0], (texels[texel] - wanted).abs());
        } else {
            let before = (texel + AROUND as usize - 1) % AROUND as usize;
            most[1] = larger(most[1], (0.5 * (texels[before] + texels[texel]) - wanted).abs());
        }
    }
    [most[0], most[0].max(most[1])]
}

/// Offset, in standard deviations of the widest channel, and weights of a pair of taps. Index 0 is
/// the centre tap.
type Placement = fn(u32, u32, Vec3) -> mirror::TextureDiffusionTap;

/// Runs a pass as in the recipe, in f32 with results kept in halves, along a row of a cylinder lit
/// by `light`. `width` is the widest channel's, in texels.
fn blurred(placement: Placement, pairs: u32, channels: Vec3, width: f32, light: &[f32]) -> Vec<Vec3> {
    let light: Vec<f32> = light.iter().map(|value| Half::from_f32(*value).to_f32()).collect();
    let count = light.len() as i32;
    let bilinear = |place: f32| {
        let lower = (place - 0.5).floor();
        let share = place - 0.5 - lower;
        let texel = |index: i32| light[index.rem_euclid(count) as usize];
        texel(lower as i32) * (1.0 - share) + texel(lower as i32 + 1) * share
    };
    let taps: Vec<_> = (1..=pairs).map(|index| placement(index, pairs, channels)).collect();
    (0..count)
        .map(|texel| {
            let place = texel as f32 + 0.5;
            let (mut sum, mut coverage) = (Vec3::splat(bilinear(place)), Vec3::ONE);
            for tap in &taps {
                let step = tap.offset * width;
                sum += tap.weight * (bilinear(place + step) + bilinear(place - step));
                coverage += 2.0 * tap.weight;
            }
            let mean = mirror::normalize(sum, coverage);
            Vec3::from(mean.to_array().map(|value| Half::from_f32(value).to_f32()))
        })
        .collect()
}

/// Returns the channels of a ratio: the widest, one of two intermediate ones, and the narrowest.
fn materials(ratio: f32) -> Vec<Vec3> {
    [0.35, 0.7].map(|share: f32| Vec3::new(1.0, ratio.powf(share), ratio)).to_vec()
}

/// Returns widths of the widest channel in radians, most of them near the largest errors.
fn sigmas() -> Vec<f64> {
    [0.05, 0.1, 0.2, 0.4, 0.6, 0.7].into_iter().chain((150..=200).map(|k| f64::from(k) * 0.005)).collect()
}

/// Returns the largest error over the materials of a ratio and the given widths.
fn worst(placement: Placement, pairs: u32, ratio: f32, sigmas: &[f64]) -> f64 {
    let light: Vec<f32> = (0..AROUND).map(lit).collect();
    let cases: Vec<(f64, Vec3)> =
        sigmas.iter().flat_map(|sigma| materials(ratio).into_iter().map(|channels| (*sigma, channels))).collect();
    cases
        .into_par_iter()
        .map(|(sigma, channels)| {
            let row = blurred(placement, pairs, channels, (sigma / TEXEL) as f32, &light);
            let error_of = |channel: usize| {
                let texels: Vec<f64> = row.iter().map(|texel| f64::from(texel[channel])).collect();
                let sigma = sigma * f64::from(channels[channel]);
                if sigma < RESOLVED { 0.0 } else { errors(&texels, sigma)[1] }
            };
            error_of(0).max(error_of(1)).max(error_of(2))
        })
        .reduce(|| 0.0, larger)
}

/// Like [`worst`], but at the edge of a shadow: the light is 1 on one half of the circle and 0 on
/// the other, and is blurred over 0.5 radians.
fn worst_at_an_edge(pairs: u32, ratio: f32) -> f64 {
    let light: Vec<f32> = (0..AROUND).map(|column| if column < AROUND / 2 { 1.0 } else { 0.0 }).collect();
    let sigma = 0.5;
    let mut most = 0.0f64;
    for channels in materials(ratio) {
        let row = blurred(mirror::tap, pairs, channels, (sigma / TEXEL) as f32, &light);
        for (column, texel) in row.iter().enumerate().take(AROUND as usize / 4) {
            let x = (column as f64 + 0.5) * TEXEL;
            for channel in 0..3 {
                let sigma = sigma * f64::from(channels[channel]);
                let share = |edge: f64| lapidary_cdrf::oracle::normal_share(((x - edge) / sigma).clamp(-12.0, 12.0));
                most =
                    larger(most, (share(0.0) - share(PI) + share(-TAU) - share(-PI) - f64::from(texel[channel])).abs());
            }
        }
    }
    most
}

/// Checks the table of docs/texture_diffusion.md, and that the number of taps is minimal.
#[test]
fn taps_are_as_few_as_the_error_allows() {
    let mut rows = String::new();
    for (name, ratio) in [("1", 1.0), ("1/2", 0.5), ("1/4", 0.25), ("1/8", 0.125), ("1/16", 0.0625)] {
        let pairs = mirror::pairs(Vec3::new(1.0, 1.0, ratio));
        let [error, fewer] = [pairs, pairs - 1].map(|pairs| worst(mirror::tap, pairs, ratio, &sigmas()));
        let is_even_enough = |pairs: &u32| {
            // The first width alone rejects most numbers.
            [&[1.0], sigmas().as_slice()]
                .into_iter()
                .all(|sigmas| worst(mirror::tap_naive, *pairs, ratio, sigmas) < BOUND)
        };
        let even = (pairs..).find(is_even_enough).expect("enough at last");
        let edge = worst_at_an_edge(pairs, ratio);
        assert!(error < BOUND, "{ratio}: {error:e} with {pairs} pairs");
        assert!(fewer > BOUND, "{ratio}: {fewer:e} with one pair fewer than {pairs}");
        let taps = 2 * pairs + 1;
        let _ = writeln!(
            rows,
            "| {name} | {taps} | {} | {:.2} | {:.2} | {} | {edge:.3} |",
            2 * taps,
            1e3 * error,
            1e3 * fewer,
            2 * even + 1
        );
    }
    println!("{rows}");
    let page = include_str!("../../../../docs/texture_diffusion.md");
    assert!(page.contains(&rows), "docs/texture_diffusion.md should hold:\n{rows}");
}

/// Tests the lower end of every step of the ladder, which is the hardest for the step's number of
/// taps.
#[test]
fn every_ratio_has_enough_taps() {
    for ratio in [0.8, 0.695, 0.6, 0.42, 0.345, 0.3, 0.248, 0.198, 0.17, 0.149, 0.124, 0.104, 0.087, 0.073] {
        let pairs = mirror::pairs(Vec3::new(1.0, 1.0, ratio));
        let error = worst(mirror::tap, pairs, ratio, &sigmas());
        println!("{ratio}: {pairs} pairs, {error:e}");
        assert!(error < BOUND, "{ratio}: {error:e} with {pairs} pairs");
    }
}

/// Blurs a cylinder of radius 1, unrolled along u or along v, with three channels on the device.
/// Returns one line around it.
fn cylinder(gpu: &Gpu, axis: usize, taps: &Taps) -> Vec<[f32; 4]> {
    let size = if axis == 0 { [AROUND, 8] } else { [8, AROUND] };
    let irradiance = filled(size, |column, row| {
        let light = lit([column, row][axis]);
        [light, light, light, 1.0]
    });
    let stretch = vec![[TEXEL as f32; 2]; irradiance.len()];
    let chart = Chart { low: [0, 0], high: size };
    let texels = diffuse(gpu, size, [axis == 0, axis == 1], (&irradiance, &stretch), taps, &[chart]);
    // One line around the cylinder, at half its height.
    let line =
        |place: u32| if axis == 0 { texels[(4 * AROUND + place) as usize] } else { texels[(8 * place + 4) as usize] };
    (0..AROUND).map(line).collect()
}

#[test]
fn a_cylinder_gets_the_exact_convolution() {
    let gpu = lapidary_testing::gpu();
    let channels = Vec3::new(1.0, 0.5, 0.25);
    let pairs = mirror::pairs(channels);
    let (mut shown, mut at_texels, mut fewer) = (0.0f64, 0.0f64, 0.0f64);
    let sigmas =
        [0.005, 0.0075, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.98, 1.0];
    for sigma in sigmas {
        for axis in 0..2 {
            let sigma0 = sigma as f32 * channels;
            let [line, short] = [pairs, pairs - 1].map(|pairs| cylinder(gpu, axis, &Taps::with_pairs(sigma0, pairs)));
            for channel in 0..3 {
                let values =
                    |line: &[[f32; 4]]| line.iter().map(|texel| f64::from(texel[channel])).collect::<Vec<f64>>();
                let width = sigma * f64::from(channels[channel]);
                let [at_middles, anywhere] = errors(&values(&line), width);
                println!("sigma {width:.5} along {axis}: {at_middles:.2e} at texels, {anywhere:.2e} between them");
                at_texels = larger(at_texels, at_middles);
                if width >= RESOLVED {
                    shown = larger(shown, anywhere);
                    fewer = larger(fewer, errors(&values(&short), width)[1]);
                }
            }
        }
    }
    println!("{pairs} pairs: {at_texels:.2e} at texels, {shown:.2e} as looked up; {fewer:.2e} with one pair fewer");
    assert!(at_texels < BOUND && shown < BOUND, "{at_texels:e} {shown:e}");
    assert!(fewer > BOUND, "{fewer:e} with one pair fewer");
}

/// Below [`RESOLVED`] the error is the lookup's, not the blur's: 1024 texels show an unblurred
/// terminator to π / 2048.
#[test]
fn what_is_narrower_than_a_texel_is_lost_in_the_lookup() {
    let line: Vec<f64> = (0..AROUND).map(|column| f64::from(lit(column))).collect();
    for sigma in [0.0, 0.001, 0.002, 0.004] {
        let perfect: Vec<f64> = wanted(sigma).iter().copied().skip(1).step_by(2).collect();
        let mirrored: Vec<f64> = perfect.iter().chain(perfect.iter().rev()).copied().collect();
        let [_, lookup] = errors(&mirrored, sigma);
        let [_, unblurred] = errors(&line, sigma);
        println!("sigma {sigma}: an exact blur {lookup:.2e}, none at all {unblurred:.2e}");
        assert!(lookup <= PI / 2048.0 + 1e-6, "{sigma}: {lookup:e}");
    }
    let line = cylinder(lapidary_testing::gpu(), 0, &Taps::new(Vec3::ZERO));
    assert!(
        (0..AROUND).all(|column| line[column as usize][0] == Half::from_f32(lit(column)).to_f32()),
        "no blur is none"
    );
}

/// A cone: rows of different radius, each an unrolled circle.
#[test]
fn stretch_makes_the_width_right_on_every_circle() {
    let size = [AROUND, 32];
    let radius = |row: u32| 0.2 + 0.05 * f64::from(row);
    let irradiance = filled(size, |column, _| [lit(column), lit(column), lit(column), 1.0]);
    // Each circle is tested by itself: there is no diffusion from one to the next.
    let along = f32::INFINITY;
    let chart = Chart { low: [0, 0], high: size };
    let taps = Taps::new(Vec3::new(0.2, 0.1, 0.05));
    let mut most = [0.0f64; 2];
    for (most, fixed) in most.iter_mut().zip([false, true]) {
        let stretch = filled(size, |_, row| [(if fixed { 1.0 } else { radius(row) } * TEXEL) as f32, along]);
        let texels = diffuse(lapidary_testing::gpu(), size, [true, false], (&irradiance, &stretch), &taps, &[chart]);
        for row in 0..size[1] {
            for (channel, sigma0) in [0.2, 0.1, 0.05].into_iter().enumerate() {
                let circle = &texels[(row * AROUND) as usize..][..AROUND as usize];
                let circle: Vec<f64> = circle.iter().map(|texel| f64::from(texel[channel])).collect();
                *most = larger(*most, errors(&circle, sigma0 / radius(row))[1]);
            }
        }
    }
    println!("with the stretch {:.2e}, with one width for all circles {:.2e}", most[0], most[1]);
    assert!(most[0] < BOUND && most[1] > 0.05, "{most:?}");
}

/// Chart with empty space around and in it: the rectangle, whether a texel's centre is covered, and
/// its light.
struct Patch {
    chart: Chart,
    covers: fn(f32, f32) -> bool,
    light: [f32; 3],
}

const PATCHES: [Patch; 3] = [
    Patch {
        chart: Chart { low: [4, 4], high: [60, 60] },
        covers: |x, y| (x - 32.0).hypot(y - 32.0) < 28.0,
        light: [0.75, 0.5, 0.25],
    },
    // A triangle with its long side oblique to the texels.
    Patch {
        chart: Chart { low: [64, 8], high: [124, 58] },
        covers: |x, y| x > 64.0 && y > 8.0 && 5.0 * (x - 64.0) + 6.0 * (y - 8.0) < 300.0,
        light: [0.0625, 0.125, 1.0],
    },
    // A ring with a hole.
    Patch {
        chart: Chart { low: [5, 62], high: [123, 124] },
        covers: |x, y| (0.5..1.0).contains(&((x - 64.0) / 59.0).hypot((y - 93.0) / 31.0)),
        light: [3.0, 2.0, 0.001],
    },
];

fn patch_of(column: u32, row: u32) -> Option<&'static Patch> {
    PATCHES.iter().find(|Patch { chart, covers, .. }| {
        let inside = (0..2).all(|axis| (chart.low[axis]..chart.high[axis]).contains(&[column, row][axis]));
        inside && covers(column as f32 + 0.5, row as f32 + 0.5)
    })
}

#[test]
fn charts_neither_darken_at_their_edges_nor_leak() {
    let size = [128, 128];
    let irradiance = filled(size, |column, row| match patch_of(column, row) {
        Some(Patch { light: [r, g, b], .. }) => [*r, *g, *b, 1.0],
        None => [0.0; 4],
    });
    let stretch = vec![[0.01; 2]; irradiance.len()];
    // Standard deviations of up to 40 texels: the taps reach beyond the charts.
    for sigma0 in [Vec3::new(0.4, 0.2, 0.1), Vec3::splat(0.02), Vec3::new(0.005, 0.0, 0.05)] {
        let taps = Taps::new(sigma0);
        let charts = PATCHES.each_ref().map(|patch| patch.chart);
        let texels = diffuse(lapidary_testing::gpu(), size, [false; 2], (&irradiance, &stretch), &taps, &charts);
        let texel = |column: u32, row: u32| texels[(row * 128 + column) as usize];
        let (mut covered, mut gutter) = (0, 0);
        for row in 0..128 {
            for column in 0..128 {
                if let Some(patch) = patch_of(column, row) {
                    covered += 1;
                    let light = patch.light.map(|value| Half::from_f32(value).to_f32());
                    let [r, g, b] = light;
                    assert_eq!(texel(column, row), [r, g, b, 1.0], "{sigma0}: texel {column}, {row}");
                    // All texels that a bilinear lookup may read here are filled: between close
                    // charts, with the value of one of them or with a mean.
                    let near = (-1..=1i32).flat_map(|y| (-1..=1i32).map(move |x| (x, y)));
                    for (x, y) in near {
                        let next = texel(column.wrapping_add_signed(x), row.wrapping_add_signed(y));
                        gutter += u32::from(next[3] == 1.0 && next != [r, g, b, 1.0]);
                        assert_eq!(next[3], 1.0, "texel {column}, {row} beside {x}, {y}");
                    }
                }
            }
        }
        assert!(covered > 5000 && texel(2, 1) == [0.0; 4], "{covered}");
        assert_eq!(gutter, 0, "charts are four texels apart");
        if sigma0.x > 0.1 {
            // One rectangle around all charts: the wide Gaussian reaches across the gap.
            let whole = Chart { low: [0, 0], high: size };
            let leaking = diffuse(lapidary_testing::gpu(), size, [false; 2], (&irradiance, &stretch), &taps, &[whole]);
            let most = leaking.iter().zip(&texels).map(|(one, other)| (one[0] - other[0]).abs()).fold(0.0, larger);
            println!("without rectangles light leaks by {most}");
            assert!(most > 0.5, "{most}");
        }
    }
}

/// Without coverage, a texel keeps only a part of its light: half of it at a straight edge.
#[test]
fn without_coverage_edges_darken() {
    let light: Vec<f32> = (0..AROUND).map(|column| if column < AROUND / 2 { 1.0 } else { 0.0 }).collect();
    let colour = blurred(mirror::tap, 17, Vec3::new(1.0, 0.5, 0.25), 40.0, &light);
    let darkest = colour[..AROUND as usize / 2].iter().map(|texel| texel.x).fold(1.0, f32::min);
    assert!((0.49..0.52).contains(&darkest), "{darkest}");
}

#[test]
fn a_texture_that_repeats_has_no_seam() {
    let (size, turn) = ([AROUND, 4], 300);
    let chart = Chart { low: [0, 0], high: size };
    let stretch = vec![[TEXEL as f32; 2]; (AROUND * 4) as usize];
    let taps = Taps::new(Vec3::new(0.6, 0.3, 0.15));
    let turned = |turn: u32, repeats: bool| {
        let irradiance = filled(size, |column, _| {
            let light = lit((column + turn) % AROUND);
            [light, light, light, 1.0]
        });
        diffuse(lapidary_testing::gpu(), size, [repeats, false], (&irradiance, &stretch), &taps, &[chart])
    };
    // The seam lies where the texture begins. In the turned texture it lies elsewhere on the
    // cylinder, so a visible seam makes the two differ. Coordinates round differently there, which
    // may round a half float the other way.
    let difference = |repeats| {
        let [one, other] = [turned(0, repeats), turned(turn, repeats)];
        let pairs = (0..AROUND).map(|column| (one[((column + turn) % AROUND) as usize], other[column as usize]));
        pairs.map(|(one, other)| (one[0] - other[0]).abs()).fold(0.0, larger)
    };
    let [repeated, bounded] = [true, false].map(difference);
    println!("a seam of {repeated:.1e} where it repeats, of {bounded:.3} where it does not");
    assert!(repeated <= 2.0f32.powi(-11) && bounded > 0.05, "{repeated} {bounded}");
}
