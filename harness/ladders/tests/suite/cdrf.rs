//! The curvature-dependent reflectance's rungs beside each other, and its lookup table: baked by the shader, baked by the mirror, in
//! the formats that a texture may have, against the oracle.

use glam::{UVec2, Vec3};
use lapidary_assay::extremum::largest;
use lapidary_cdrf as mirror;
use lapidary_ladders::Report;
use lapidary_ladders::cdrf::error::{self, Distance, Samples};
use lapidary_ladders::cdrf::{CIRCULAR, SCREEN, SPHERICAL, TABLE, options};
use lapidary_render::cdrf::table::{self, Table};
use lapidary_scene::solver::Format;
use std::sync::OnceLock;

fn convolution() -> &'static Samples {
    static SAMPLES: OnceLock<Samples> = OnceLock::new();
    SAMPLES.get_or_init(Samples::of_the_convolution)
}

fn baked(side: u32, format: Format) -> Table {
    error::baked(lapidary_testing::gpu(), side, format).unwrap_or_else(|error| panic!("{error}"))
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
            let shader = table::bake(lapidary_testing::gpu(), size, tint).unwrap_or_else(|error| panic!("{error}"));
            let wanted = mirror::table(size, tint);
            assert_eq!(shader.len(), wanted.len());
            let mut moved = 0;
            for (index, (shader, mirror)) in shader.iter().zip(&wanted).enumerate() {
                let difference = largest((*shader - *mirror).abs().to_array());
                // Twice what the accuracy line allows either on lavapipe; a NaN fails.
                assert!(difference <= 1.6e-6, "texel {index} of {size}: {shader} and {mirror}");
                for channel in 0..3 {
                    let kept = [shader[channel], mirror[channel]].map(|value| table::round(format, value));
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
    let texels = table::bake(lapidary_testing::gpu(), size, Vec3::ONE).unwrap_or_else(|error| panic!("{error}"));
    for column in 0..257usize {
        let lambert = (2.0 * column as f32 - 256.0).max(0.0) / 256.0;
        assert_eq!(texels[column].x, lambert, "column {column}");
        assert!((texels[32 * 257 + column].x - std::f32::consts::FRAC_1_PI).abs() < 1e-7);
    }
}

#[test]
fn lookup_by_hand_is_the_samplers() {
    let table = baked(65, Format::R32Float);
    for half_degree in 0..=360u16 {
        let cosine = (0.5 * f32::from(half_degree)).to_radians().cos();
        for sigma in (0..=300u16).map(|index| 0.01 * f32::from(index)) {
            let difference = largest((table.lookup(cosine, sigma) - table.sampled(cosine, sigma)).abs().to_array());
            // Coordinates that are rounded at 65 texels.
            assert!(difference < 2e-5, "{cosine} {sigma}: {difference:e}");
        }
    }
}

/// The claims of docs/cdrf.md about widths and texel centres.
#[test]
fn an_odd_width_wins_and_the_half_texel_counts() {
    let worst = |table: &Table| convolution().distance(|c, s| table.sampled(c, s).x).largest;
    let worst_naive = |table: &Table| convolution().distance(|c, s| table.sampled_naive(c, s).x).largest;
    let paper = baked(256, Format::Rgba8);
    let even = baked(256, Format::Rgba16Float);
    let odd = baked(257, Format::Rgba16Float);
    let narrow = baked(65, Format::Rgba16Float);
    let ratio = worst(&even) / worst(&odd);
    assert!((3.7..4.2).contains(&ratio), "256 wide is {ratio} times as bad as 257");
    let ratio = worst(&narrow) / worst(&even);
    assert!((0.95..1.05).contains(&ratio), "65 wide is {ratio} times as bad as 256");
    for (table, stated) in [(&paper, 3.0), (&even, 2.3), (&odd, 9.0)] {
        let ratio = worst_naive(table) / worst(table);
        assert!((ratio - stated).abs() < 0.1 * stated, "{ratio} times as bad without the half texel, not {stated}");
    }
}

/// The record's errors, which the pages show, are those of this code, as far as the pages show them.
#[test]
fn the_record_has_the_rungs_errors() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/measurements/lavapipe/cdrf.json");
    let record = std::fs::read_to_string(file).expect("the record");
    let record = Report::from_json("cdrf", &record).unwrap_or_else(|error| panic!("{error}"));
    let again = "./cook cost cdrf --out docs/measurements/lavapipe";
    let same = |name: &str, view: &str, found: Option<Distance>| {
        let shown = |value: Option<f64>| value.map(|value| format!("{value:.1e}"));
        for (measure, found) in [("largest", found.map(|found| found.largest)), ("rms", found.map(|found| found.rms))] {
            let recorded = record.value(name, view, measure);
            let message = "the record is not of this code; measure anew";
            assert_eq!(shown(recorded), shown(found), "{name}, {measure}: {message}: {again}");
        }
    };
    let spherical = Samples::of(mirror::oracle::spherical);
    for reflectance in options().rungs {
        let name = reflectance.name();
        let function = error::function(lapidary_testing::gpu(), reflectance).unwrap_or_else(|error| panic!("{error}"));
        let definition = if name == SPHERICAL { &spherical } else { convolution() };
        same(name, SCREEN, function.map(|function| definition.distance(function)));
    }
    let tables = error::tables(lapidary_testing::gpu(), convolution()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(record.rows.iter().filter(|row| row.view == TABLE).count(), 2 * tables.len());
    for (name, found) in tables {
        same(&name, TABLE, Some(found));
    }
    same(SPHERICAL, CIRCULAR, Some(convolution().distance(mirror::spherical)));
}
