//! The recipe `environment_harmonics`: against sums in f64 over the same samples, closed forms and the product's own
//! harmonics; and the buffer that it makes, bound where `cdrf_shading` binds its harmonics.

use glam::{DVec2, DVec3, UVec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use lapidary_environment::oracle;
use lapidary_plan::Effects;
use lapidary_render::frame::{Buffer, Builder, Contents, Executor, ResourceKind, Workgroups};
use lapidary_render::{Settings, frame};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::harmonics::{self, COUNT};
use lapidary_scene::{Environment, Scene};
use lapidary_testing::gpu;
use lapidary_testing::pixels::furthest;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::time::Instant;
use wgpu::BufferUsages as Usage;

const RECIPE: &str = "environment_harmonics";
/// `ENVIRONMENT_HARMONICS_LEAST`.
const LEAST: UVec2 = UVec2::new(512, 256);
/// `ENVIRONMENT_HARMONICS_GROUP`.
const GROUP: u32 = 32;
/// Size of the coefficients in bytes.
const BYTES: u64 = 16 * COUNT as u64;

/// Adds the recipe, from this text, as many times as it shall run; returns the buffer of coefficients.
fn encode(builder: &mut Builder<'_>, source: &str, map: &EnvironmentMap, times: u32) -> Buffer {
    let format = (wgpu::TextureDimension::D2, wgpu::TextureFormat::Rgba32Float);
    let texels = Contents::Bytes(bytemuck::cast_slice(&map.pixels).to_vec());
    let texture = builder.texture("environment map", format, [map.width, map.height, 1], texels);
    let groups = map.height.max(512);
    let row_sums = builder.buffer("row sums", BYTES * u64::from(groups), Usage::STORAGE);
    let harmonics = builder.buffer("harmonics", BYTES, Usage::STORAGE | Usage::UNIFORM | Usage::COPY_SRC);
    let resources = [(0, texture.into()), (1, row_sums.into()), (2, harmonics.into())];
    let dispatches = [("rows", groups), ("sum", COUNT as u32)].map(|(entry, groups)| {
        let entry = format!("{RECIPE}_{entry}");
        let pipeline = builder.compute_pipeline(RECIPE, source, &entry, &[]).expect("the recipe");
        let bound = vec![builder.bind(pipeline, 0, &resources)];
        builder.dispatch(pipeline, bound, Workgroups::Count([groups, 1, 1]))
    });
    builder.compute(RECIPE, dispatches.into(), times);
    harmonics
}

fn recipe() -> String {
    lapidary_wgsl::recipe_source(RECIPE)
}

/// Returns the words that a text of the recipe makes of a map.
fn words(source: &str, map: &EnvironmentMap) -> Vec<u32> {
    let mut builder = Builder::new(Some(gpu()));
    let harmonics = encode(&mut builder, source, map, 1);
    let executor = Executor::new(gpu(), builder.finish()).expect("a device");
    executor.run(|_, _| {}).expect("run");
    executor.words(harmonics).expect("read")
}

/// Returns the coefficients that a text of the recipe makes of a map.
fn found(source: &str, map: &EnvironmentMap) -> [DVec3; COUNT] {
    let words = words(source, map);
    let rows: Vec<[f32; 4]> = words.chunks(4).map(|row| [0, 1, 2, 3].map(|place| f32::from_bits(row[place]))).collect();
    assert!(rows.iter().all(|row| row[3] == 0.0), "the fourth is unused");
    std::array::from_fn(|k| Vec3::from_slice(&rows[k][..3]).as_dvec3())
}

/// Returns the oracle's harmonics of a direction, by angles.
fn basis(direction: DVec3) -> [f64; COUNT] {
    let values = oracle::harmonics(direction);
    let mut all = [values.zeroth].into_iter().chain(values.first.to_array()).chain(values.second).chain(values.fourth);
    std::array::from_fn(|_| all.next().expect("18"))
}

/// Columns and rows at which the recipe samples a map.
fn grid(map: &EnvironmentMap) -> UVec2 {
    let size = UVec2::new(map.width, map.height);
    size * ((LEAST + size - 1) / size)
}

/// Sums in f64.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// The coefficients.
    coefficients: [DVec3; COUNT],
    /// The same, of the magnitudes of all terms.
    magnitudes: [DVec3; COUNT],
    /// The light from all around.
    light: DVec3,
}

impl Sums {
    /// Returns the sums over the samples that the recipe takes of the map.
    fn of(map: &EnvironmentMap) -> Self {
        let (size, grid) = (UVec2::new(map.width, map.height), grid(map));
        let texel =
            |column: u32, row: u32| Vec3::from_slice(&map.pixels[(row * map.width + column) as usize][..3]).as_dvec3();
        let row = |row: u32| {
            let mut sums = Self::default();
            let edge = |edge: u32| (PI * f64::from(edge) / f64::from(grid.y)).cos();
            let solid_angle = (edge(row) - edge(row + 1)) * 2.0 * PI / f64::from(grid.x);
            for column in 0..grid.x {
                let uv = (DVec2::new(column.into(), row.into()) + 0.5) / grid.as_dvec2();
                let lookup = oracle::texels(uv, size);
                let along = |row: u32| texel(lookup.lower.x, row).lerp(texel(lookup.upper.x, row), lookup.weight.x);
                let arriving = solid_angle * along(lookup.lower.y).lerp(along(lookup.upper.y), lookup.weight.y);
                sums.light += arriving;
                for (k, value) in basis(oracle::direction_from_uv(uv)).into_iter().enumerate() {
                    sums.coefficients[k] += value * arriving;
                    sums.magnitudes[k] += value.abs() * arriving;
                }
            }
            sums
        };
        (0..grid.y).into_par_iter().map(row).reduce(Self::default, |one, other| Self {
            coefficients: std::array::from_fn(|k| one.coefficients[k] + other.coefficients[k]),
            magnitudes: std::array::from_fn(|k| one.magnitudes[k] + other.magnitudes[k]),
            light: one.light + other.light,
        })
    }

    /// Returns the largest error of `found`, as a share of what is allowed and of the light from all around.
    fn shares(&self, found: &[DVec3; COUNT], map: &EnvironmentMap) -> [f64; 2] {
        let shares = |k: usize| {
            let off = (found[k] - self.coefficients[k]).abs();
            [allowed(self.magnitudes[k], self.light, map), self.light].map(|whole| (off / whole).max_element())
        };
        (0..COUNT).map(shares).fold([0.0; 2], |most, next| [0, 1].map(|place| larger(most[place], next[place])))
    }
}

/// Returns the error that a coefficient may have, given the sum of the magnitudes of its terms and the light from all
/// around.
///
/// A sum rounds once for each number that is added: those of a lane, those of a workgroup, of the rows and again of the
/// lanes. A rounding is 2^-24 of the sum so far, or 2^-23 on devices that round up or down. A term itself is off by the
/// harmonics' error (2e-6; on any device 3e-6); their slope, at most 3.8 for degree 4, times the direction's (4.8e-7 and the
/// coordinates' 3.7e-7; on any device 3 times that); and .85 times the solid angle's (two sines, 5 ulp each, and three
/// products; on any device 8 and a quotient more).
fn allowed(magnitudes: DVec3, light: DVec3, map: &EnvironmentMap) -> DVec3 {
    let grid = grid(map);
    let added = f64::from(grid.x.div_ceil(GROUP) + GROUP + grid.y.div_ceil(GROUP) + GROUP);
    let (rounding, term) = if gpu().is_lavapipe() { (2f64.powi(-24), 7e-6) } else { (2f64.powi(-23), 1.5e-5) };
    added * rounding * magnitudes + term * light
}

fn map(width: u32, height: u32, mut radiance: impl FnMut(u32, u32) -> Vec3) -> EnvironmentMap {
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let pixels = places.map(|(column, row)| radiance(column, row).extend(1.0).to_array()).collect();
    EnvironmentMap { width, height, pixels }
}

/// Light of random texels, with a sun of 1e4 in this column of a row a quarter down from the zenith.
fn sunny(width: u32, height: u32, column: u32) -> EnvironmentMap {
    let mut draws = Draws::of_row(lapidary_testing::seed(), (u64::from(width) << 32) | u64::from(height));
    let sun = (column, height / 4);
    map(width, height, |column, row| {
        let [red, green, blue] = [0; 3].map(|_| draws.unit() as f32);
        if (column, row) == sun { Vec3::new(1e4, 9e3, 8e3) } else { Vec3::new(red, green, blue) }
    })
}

const SIZES: [(u32, u32); 4] = [(1, 1), (7, 3), (64, 32), (1024, 512)];
/// The widest and the highest that WebGPU grants everywhere.
const LONG: [(u32, u32); 2] = [(8192, 1), (3, 8192)];

#[test]
fn maps_of_any_size_give_the_sums() {
    for (width, height) in SIZES.into_iter().chain(lapidary_testing::sampled(LONG, 2)) {
        let map = sunny(width, height, 2 * width / 3);
        let [share, of_light] = Sums::of(&map).shares(&found(&recipe(), &map), &map);
        println!("{width} x {height}: off by {share:.3} of what is allowed, {of_light:.1e} of the light");
        assert!(share < 1.0, "{width} x {height}: {share}");
    }
}

/// The check above notices an error in every part of the recipe.
#[test]
fn errors_that_are_planted_are_found() {
    let source = recipe();
    for (what, from, to) in [
        ("rows flipped", "/ vec2f(grid)));", "/ vec2f(grid) * vec2f(1.0f, -1.0f) + vec2f(0.0f, 1.0f)));"),
        ("columns turned", "/ vec2f(grid)));", "/ vec2f(grid) + vec2f(0.25f, 0.0f)));"),
        ("no cosine of the latitude", "* environment_sine(0.5f * middle) *", "*"),
        ("a row left out", "if (row >= grid.y) {", "if (row == grid.y / 2u || row >= grid.y) {"),
        ("a lane that takes another's columns", "for (var column = lane;", "for (var column = lane + lane / 31u;"),
        ("the first rows left out", "for (var row = lane;", "for (var row = lane + ENVIRONMENT_HARMONICS_GROUP;"),
        ("corners of texels", "2u * cell + 1u + fineness", "2u * cell + fineness"),
        ("columns that do not wrap", "vec2u(upper.x + size.x - 1u,", "vec2u(max(upper.x, 1u) - 1u,"),
    ] {
        assert!(source.contains(from), "{what}");
        let wrong = source.replace(from, to);
        // One map with a sample per texel, and one with samples in between. The sun is at the border, where columns wrap.
        let share = |(width, height)| {
            let map = sunny(width, height, 0);
            Sums::of(&map).shares(&found(&wrong, &map), &map)[0]
        };
        let shares = [(512, 256), (16, 8)].map(share);
        println!("{what}: {shares:.1?} of what is allowed");
        assert!(shares.into_iter().fold(0.0, larger) > 2.0, "{what}: {shares:?}");
    }
}

#[test]
fn a_map_gives_the_same_bits_again() {
    let map = sunny(300, 200, 7);
    assert_eq!(words(&recipe(), &map), words(&recipe(), &map));
}

/// What taking the middles of rows leaves of an integral over the sphere: by the Euler-Maclaurin formula, and since it is
/// exact along a row, h²/24 of the integral of the function less 2π times its values at both poles. The next term is
/// smaller by h².
fn of_middles(rows: u32, most: f64) -> f64 {
    let height = PI / f64::from(rows);
    1.05 * height * height / 24.0 * 8.0 * PI * most
}

#[test]
fn white_light_has_the_first_harmonic_alone() {
    for (width, height) in SIZES {
        let white = map(width, height, |_, _| Vec3::new(1.0, 0.5, 2.0));
        let found = found(&recipe(), &white);
        let light = 4.0 * PI * DVec3::new(1.0, 0.5, 2.0);
        let allowed = allowed(light * 0.85, light, &white) + light / (4.0 * PI) * of_middles(grid(&white).y, 0.85);
        for (k, found) in found.into_iter().enumerate() {
            let expected = if k == 0 { light / (4.0 * PI).sqrt() } else { DVec3::ZERO };
            assert!((found - expected).abs().cmplt(allowed).all(), "{width} x {height}, {k}: {found} {allowed}");
        }
    }
}

/// Light of 1 and a harmonic, which is nowhere below 0, has the coefficients √4π and 1.
#[test]
fn each_harmonic_is_found_alone() {
    let (width, height) = (1024, 512);
    for first in (0..COUNT).step_by(3) {
        let three = map(width, height, |column, row| {
            let uv = (DVec2::new(column.into(), row.into()) + 0.5) / DVec2::new(width.into(), height.into());
            let values = basis(oracle::direction_from_uv(uv));
            Vec3::ONE + DVec3::new(values[first], values[first + 1], values[first + 2]).as_vec3()
        });
        let found = found(&recipe(), &three);
        // The light adds up to 4 pi and, of the first harmonic, its root.
        let light = DVec3::splat(4.0 * PI + (4.0 * PI).sqrt());
        let allowed = allowed(light * 0.85, light, &three).x + of_middles(height, 1.85 * 0.85);
        for (channel, harmonic) in (first..).enumerate().take(3) {
            for (k, found) in found.iter().enumerate() {
                let expected = f64::from(u8::from(k == 0)) * (4.0 * PI).sqrt() + f64::from(u8::from(k == harmonic));
                let off = (found[channel] - expected).abs();
                assert!(off < allowed, "harmonic {harmonic}, coefficient {k}: {} {allowed}", found[channel]);
            }
        }
    }
}

/// The product's own harmonics, which take the same samples.
#[test]
fn the_products_own_harmonics_are_the_same() {
    for (width, height) in SIZES {
        let map = sunny(width, height, 2 * width / 3);
        let (found, sums) = (found(&recipe(), &map), Sums::of(&map));
        let projected = harmonics::project(&Environment::Map(map.clone()));
        let mut worst = 0.0;
        for k in 0..COUNT {
            // Its harmonics are those of the mirror, in f32.
            let allowed = allowed(sums.magnitudes[k], sums.light, &map) + 5e-6 * sums.light;
            let off = (found[k] - projected[k]).abs();
            worst = larger(worst, (off / sums.light).max_element());
            assert!(off.cmplt(allowed).all(), "{width} x {height}, {k}: {} {}", found[k], projected[k]);
        }
        println!("{width} x {height}: off by {worst:.1e} of the light");
    }
}

/// The part harmonics reads the buffer that the recipe wrote, in one frame.
#[test]
fn the_buffer_is_bound_as_a_uniform() {
    const NORMALS: usize = 64;
    let part = lapidary_wgsl::PARTS.iter().find(|part| part.name == "harmonics").expect("a part").source;
    let probe = format!(
        "{part}
        @group(0) @binding(0) var<storage, read> normals: array<vec4f>;
        @group(0) @binding(1) var<storage, read_write> found: array<vec4f>;
        @compute @workgroup_size({NORMALS})
        fn probe(@builtin(local_invocation_index) lane: u32) {{
            let weights = vec4f(3.1415927f, 2.0943952f, 0.78539819f, -0.13089969f);
            let around = harmonics_around(normals[lane].xyz);
            found[lane] = vec4f(harmonics_irradiance(around, weights, weights, weights), 0.0f);
        }}"
    );
    let map = sunny(64, 32, 40);
    let mut draws = Draws::of_row(lapidary_testing::seed(), 0);
    let normals: Vec<[f32; 4]> = (0..NORMALS).map(|_| draws.unit_vector().extend(0.0).to_array()).collect();
    let mut builder = Builder::new(Some(gpu()));
    let harmonics = encode(&mut builder, &recipe(), &map, 1);
    let given = builder.storage("normals", bytemuck::cast_slice(&normals));
    let result = builder.buffer("found", 16 * NORMALS as u64, Usage::STORAGE | Usage::COPY_SRC);
    let source = lapidary_wgsl::compose(&["environment"], &probe);
    let pipeline = builder.compute_pipeline("probe", &source, "probe", &[]).expect("the probe");
    let bound = vec![builder.bind(pipeline, 0, &[(0, given.into()), (1, result.into()), (3, harmonics.into())])];
    let dispatch = builder.dispatch(pipeline, bound, Workgroups::Count([1, 1, 1]));
    builder.compute("probe", vec![dispatch], 1);
    let executor = Executor::new(gpu(), builder.finish()).expect("a device");
    executor.run(|_, _| {}).expect("run");
    let found: Vec<f32> = executor.words(result).expect("read").into_iter().map(f32::from_bits).collect();
    let Sums { coefficients, light, .. } = Sums::of(&map);
    for (found, normal) in found.chunks(4).zip(normals) {
        let found = Vec3::from_slice(&found[..3]).as_dvec3();
        let expected = harmonics::irradiance(&coefficients, Vec3::from_slice(&normal[..3]).as_dvec3());
        // Weights and harmonics of all degrees add up to at most 1.1 for each unit of light.
        assert!((found - expected).abs().cmplt(2e-5 * light).all(), "{normal:?}: {found} {expected}");
    }
}

/// A body that the environment alone lights looks the same under the recipe's coefficients as under the renderer's, and
/// otherwise under those of the map upside down.
#[test]
fn cdrf_shading_draws_with_the_buffer() {
    let map = sunny(64, 32, 40);
    let scene = Scene { lights: Vec::new(), ..Scene::named("skin").expect("built in") };
    let settings = Settings {
        rung: "accurate".parse().expect("a rung"),
        without: Effects::SHEEN,
        environment: Environment::Map(map.clone()),
        ..Settings::of_size(96, 96)
    };
    let drawn = |coefficients: Option<Vec<u32>>| {
        let mut frame = frame(Some(gpu()), &scene, &settings).expect("a frame");
        let record = frame.resources.iter_mut().find(|it| it.name == "harmonics").expect("the environment's record");
        let ResourceKind::Buffer { size: BYTES, contents, layout: Some(("Harmonics", _)), .. } = &mut record.kind
        else {
            panic!("{record:?}")
        };
        if let Some(words) = coefficients {
            *contents = Contents::Bytes(bytemuck::cast_slice(&words).to_vec());
        }
        let mut picture: Vec<[f32; 4]> = Vec::new();
        let executor = Executor::new(gpu(), frame).expect("a device");
        let take = |read: &lapidary_render::frame::Read, rows: &[u8]| {
            if read.picture == "linear picture" {
                picture.extend(bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(rows));
            }
        };
        executor.run(take).expect("run");
        picture
    };
    let unchanged = drawn(None);
    let brightest = unchanged.iter().map(|pixel| pixel[0]).fold(0.0, f32::max);
    let covered = unchanged.iter().filter(|pixel| pixel[3] > 0.0).count();
    assert!(covered > unchanged.len() / 10 && brightest > 0.1, "{covered} pixels, {brightest}");
    let difference = |map: &EnvironmentMap| furthest(&drawn(Some(words(&recipe(), map))), &unchanged) / brightest;
    let mut flipped = map.clone();
    flipped.pixels = map.pixels.chunks(64).rev().flatten().copied().collect();
    let [same, other] = [difference(&map), difference(&flipped)];
    println!("off by {same:.1e} of the brightest, {other:.2} with the map upside down");
    assert!(same < 2e-5 && other > 0.1, "{same} {other}");
}

/// How long a map takes on the adapter, passes of both kinds together.
#[test]
#[ignore = "measures for a minute"]
fn times() {
    for (width, height) in [(64, 32), (512, 256), (1024, 512), (2048, 1024), (8192, 4096)] {
        let map = map(width, height, |_, _| Vec3::ONE);
        let run = |times: u32| {
            let mut builder = Builder::new(Some(gpu()));
            let harmonics = encode(&mut builder, &recipe(), &map, times);
            let executor = Executor::new(gpu(), builder.finish()).expect("a device");
            let timed = || {
                let start = Instant::now();
                executor.run(|_, _| {}).expect("run");
                executor.words(harmonics).expect("read");
                start.elapsed().as_secs_f64()
            };
            (0..5).map(|_| timed()).fold(f64::INFINITY, f64::min)
        };
        let milliseconds = 1e3 * (run(21) - run(1)) / 20.0;
        println!("{}, {width} x {height}: {milliseconds:.3} ms", gpu().info.name);
    }
}
