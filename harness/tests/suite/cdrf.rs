//! The curvature-dependent reflectance's rungs beside each other, and its lookup table: baked by the shader, baked by the mirror, in
//! the formats that a texture may have, against the oracle.

use glam::{UVec2, Vec3};
use lapidary_cdrf::{self as mirror, oracle};
use lapidary_harness::cdrf::table::{self, Format, Table};
use std::sync::OnceLock;

/// A cosine, a sigma, and the exact reflectance.
type Sample = (f32, f32, f64);

/// Angles from 0 to 180° by sigmas from 0 to 3, both uniform: what the root mean square is over.
fn everywhere() -> &'static [Sample] {
    static SAMPLES: OnceLock<Vec<Sample>> = OnceLock::new();
    SAMPLES.get_or_init(|| {
        let angles = (0..=360).map(|index| (f64::from(index) * 0.5).to_radians().cos() as f32);
        angles.flat_map(|cosine| (0..=300).map(move |index| sample(cosine, index as f32 * 0.01))).collect()
    })
}

/// Beside the terminator at small sigmas, where tables do worst: looked at closely for the largest error.
fn at_the_kink() -> &'static [Sample] {
    static SAMPLES: OnceLock<Vec<Sample>> = OnceLock::new();
    SAMPLES.get_or_init(|| {
        let cosines = (-150..=150).map(|index| index as f32 * 0.0002);
        cosines.flat_map(|cosine| (0..=100).map(move |index| sample(cosine, index as f32 * 0.0005))).collect()
    })
}

fn sample(cosine: f32, sigma: f32) -> Sample {
    (cosine, sigma, oracle::accurate(cosine.into(), sigma.into()))
}

/// Largest and root mean square error of a rung.
fn errors(rung: impl Fn(f32, f32) -> f32) -> (f64, f64) {
    let error = |(cosine, sigma, exact): &Sample| (f64::from(rung(*cosine, *sigma)) - exact).abs();
    let most = everywhere().iter().chain(at_the_kink()).map(error).fold(0.0, f64::max);
    let squares: f64 = everywhere().iter().map(|sample| error(sample).powi(2)).sum();
    (most, (squares / everywhere().len() as f64).sqrt())
}

fn baked(width: u32, height: u32, format: Format) -> Table {
    let size = UVec2::new(width, height);
    let texels = table::bake(super::gpu(), size, Vec3::ONE).unwrap_or_else(|error| panic!("{error}"));
    Table::new(size, format, &texels)
}

#[test]
fn shader_and_mirror_bake_the_same_table() {
    // Skin's channels, about as its scattering lengths stand to each other.
    for tint in [Vec3::ONE, Vec3::new(1.0, 0.4, 0.2)] {
        for (size, format, step) in [
            (UVec2::new(256, 256), Format::Rgba8, 1.0f32 / 255.0),
            (UVec2::new(257, 128), Format::Rgba16Float, 1.0 / 2048.0),
            (UVec2::new(129, 65), Format::R32Float, 0.0),
        ] {
            let shader = table::bake(super::gpu(), size, tint).unwrap_or_else(|error| panic!("{error}"));
            let wanted = mirror::table(size, tint);
            assert_eq!(shader.len(), wanted.len());
            let mut moved = 0;
            for (index, (shader, mirror)) in shader.iter().zip(&wanted).enumerate() {
                let apart = (*shader - *mirror).abs().max_element();
                // Twice what the accuracy line allows either on lavapipe; a NaN fails.
                assert!(apart <= 1.6e-6, "texel {index} of {size}: {shader} and {mirror}");
                for channel in 0..3 {
                    let kept = [shader[channel], mirror[channel]].map(|value| format.round(value));
                    assert!((kept[0] - kept[1]).abs() <= step.max(1.6e-6), "texel {index} of {size}: {kept:?}");
                    // In deep shadow half floats are as fine as the shader's rounding.
                    moved += usize::from(kept[0] != kept[1] && kept[0] > 0.1);
                }
            }
            if format != Format::R32Float {
                // Only a value at the middle of two steps may round either way.
                assert!(moved * 500 <= shader.len(), "{moved} texels of {size} differ in {format:?}");
            }
        }
    }
}

#[test]
fn first_and_last_row_are_the_limits() {
    let size = UVec2::new(257, 33);
    let texels = table::bake(super::gpu(), size, Vec3::ONE).unwrap_or_else(|error| panic!("{error}"));
    for column in 0..257usize {
        let lambert = (2.0 * column as f32 - 256.0).max(0.0) / 256.0;
        assert_eq!(texels[column].x, lambert, "column {column}");
        assert!((texels[32 * 257 + column].x - std::f32::consts::FRAC_1_PI).abs() < 1e-7);
    }
}

#[test]
fn lookup_by_hand_is_the_samplers() {
    let table = baked(65, 65, Format::R32Float);
    for (cosine, sigma, _) in everywhere() {
        let apart = (table.lookup(*cosine, *sigma) - table.sampled(*cosine, *sigma)).abs().max_element();
        // Coordinates that are rounded at 65 texels.
        assert!(apart < 2e-5, "{cosine} {sigma}: {apart:e}");
    }
}

/// The claims of docs/cdrf.md about widths and texel centres.
#[test]
fn an_odd_width_wins_and_the_half_texel_counts() {
    let worst = |table: &Table| errors(|c, s| table.sampled(c, s).x).0;
    let worst_naive = |table: &Table| errors(|c, s| table.sampled_naive(c, s).x).0;
    let paper = baked(256, 256, Format::Rgba8);
    let even = baked(256, 256, Format::Rgba16Float);
    let odd = baked(257, 257, Format::Rgba16Float);
    let narrow = baked(65, 65, Format::Rgba16Float);
    let ratio = worst(&even) / worst(&odd);
    assert!((3.7..4.2).contains(&ratio), "256 wide is {ratio} times as bad as 257");
    let ratio = worst(&narrow) / worst(&even);
    assert!((0.95..1.05).contains(&ratio), "65 wide is {ratio} times as bad as 256");
    for (table, stated) in [(&paper, 3.0), (&even, 2.3), (&odd, 9.0)] {
        let ratio = worst_naive(table) / worst(table);
        assert!((ratio - stated).abs() < 0.1 * stated, "{ratio} times as bad without the half texel, not {stated}");
    }
}

/// The table of docs/cdrf.md.
#[test]
fn rungs_are_as_the_page_says() {
    let mut rows = String::new();
    let mut add = |name: &str, (most, rms): (f64, f64)| rows += &format!("| {name} | {most:.1e} | {rms:.1e} |\n");
    add("`cdrf_lambert`", errors(|c, _| mirror::lambert(c)));
    add("`cdrf_wrap`", errors(mirror::wrap));
    for (name, width, height, format) in [
        ("table 256 × 256, RGBA8 (the paper's)", 256, 256, Format::Rgba8),
        ("table 257 × 257, RGBA8", 257, 257, Format::Rgba8),
        ("table 65 × 65, RGBA16F", 65, 65, Format::Rgba16Float),
        ("table 256 × 256, RGBA16F", 256, 256, Format::Rgba16Float),
        ("table 257 × 257, RGBA16F", 257, 257, Format::Rgba16Float),
        ("table 257 × 257, R32F", 257, 257, Format::R32Float),
        ("table 1025 × 1025, R32F", 1025, 1025, Format::R32Float),
    ] {
        let table = baked(width, height, format);
        add(name, errors(|c, s| table.lookup(c, s).x));
        if name.contains("paper") {
            add("the same, half a texel left out", errors(|c, s| table.sampled_naive(c, s).x));
        }
    }
    add("`cdrf_cheap`", errors(mirror::cheap));
    add("`cdrf_accurate`", errors(mirror::accurate));
    add("`cdrf_quadrature`", errors(mirror::quadrature));
    let page = include_str!("../../../docs/cdrf.md");
    assert!(page.contains(&rows), "docs/cdrf.md should hold:\n{rows}");
}
