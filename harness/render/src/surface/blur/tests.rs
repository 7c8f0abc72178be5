use super::*;
use crate::drawing::scene_pass::Before;
use crate::drawing::scene_pass::scene_pass;
use crate::frame::Executor;
use crate::light::lighting::Lighting;
use crate::settings::Settings;
use glam::{Vec2, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_assets::atlas;
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_scene::solver::Reflectance;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Light, Mesh, Scene};
use std::collections::HashMap;

type Half = exr::prelude::f16;

/// Values at the vertices of each position, by the position's bits.
type ByPosition = HashMap<[u32; 3], Vec<f32>>;

/// Width coefficient of the Gaussian, as a fraction of the sphere's radius.
const SIGMA0: f32 = 1.0 / 6.0;

/// Returns a sphere of radius 1, cut into charts.
fn charted(halo: f32) -> Mesh {
    atlas::unwrap(&Mesh { uvs: Vec::new(), ..sphere(1.0, 128) }, halo)
}

/// Returns the values that shading reads from the texture at the vertices of `mesh`, in white light
/// from `toward`.
fn looked_up(mesh: &Mesh, toward: Vec3) -> Vec<f32> {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
    let mut scene = Scene::named("skin").expect("built in");
    scene.objects.truncate(1);
    scene.objects[0].mesh = mesh.clone();
    scene.objects[0].material.sigma0 = Some(Vec3::splat(SIGMA0));
    scene.lights = vec![Light::Directional { toward, irradiance: Vec3::ONE }];
    let rung = Rung::Diffuse(Reflectance::Blur);
    let settings = Settings { rung, without: Effects::of(&[Effect::Environment]), ..Settings::of_size(8, 8) };
    let mut builder = Builder::new(Some(gpu));
    let lighting = Lighting::new(&scene, &settings, [settings.width, settings.height]);
    let pass = scene_pass(&mut builder, &lighting, &scene, &settings, None).expect("the recipe");
    pass.prepare(&mut builder);
    let Before::Blur(diffusion) = &pass.before[0] else { panic!("a blur") };
    builder.read_whole("diffused", diffusion.textures.diffused);
    let red = |texel: &[u8]| Half::from_bits(u16::from_le_bytes([texel[0], texel[1]])).to_f32();
    let mut texels: Vec<f32> = Vec::new();
    let executor = Executor::new(gpu, builder.finish()).expect("made");
    executor.run(|_, bytes| texels.extend(bytes.chunks_exact(8).map(red))).expect("run");
    // Bilinear filtering of a repeating texture.
    let texel_at = |place: Vec2| {
        let place = place.as_ivec2().rem_euclid(glam::IVec2::splat(SIDE as i32));
        texels[(place.y * SIDE as i32 + place.x) as usize]
    };
    let sample = |uv: &Vec2| {
        let place = uv * SIDE as f32 - 0.5;
        let (corner, share) = (place.floor(), place - place.floor());
        let row = |y: f32| {
            let [left, right] = [0.0, 1.0].map(|x| texel_at(corner + Vec2::new(x, y)));
            left + share.x * (right - left)
        };
        row(0.0) + share.y * (row(1.0) - row(0.0))
    };
    mesh.uvs.iter().map(sample).collect()
}

/// Groups the values by position, without the vertices that belong only to halos.
fn by_position(mesh: &Mesh, values: &[f32]) -> ByPosition {
    let mut found = ByPosition::new();
    let mut seen = vec![false; mesh.positions.len()];
    for &vertex in &mesh.indices {
        if !std::mem::replace(&mut seen[vertex as usize], true) {
            let position = mesh.positions[vertex as usize].to_array().map(|x| (x + 0.0).to_bits());
            found.entry(position).or_default().push(values[vertex as usize]);
        }
    }
    found
}

/// Returns the largest differences of `mesh`'s values in three lights: first between two charts at
/// the same point of their border, then from `unrolled` up to 30° from the equator. `unrolled` is
/// the same sphere parametrised by longitude and latitude, with a repeating texture.
fn differences(mesh: &Mesh, unrolled: &[(Vec3, ByPosition)]) -> [f32; 2] {
    let mut most = [0.0f32; 2];
    for (toward, wanted) in unrolled {
        for (position, values) in by_position(mesh, &looked_up(mesh, *toward)) {
            for value in &values {
                most[0] = values.iter().map(|other| value - other).fold(most[0], larger);
                if f32::from_bits(position[1]).abs() < 0.5 {
                    most[1] = larger(most[1], (value - wanted[&position][0]).abs());
                }
            }
        }
    }
    most
}

/// The remaining difference is the cost of drawing along an axis: the stretch is not constant
/// within the reach of a Gaussian.
#[test]
fn halos_close_the_borders_of_charts() {
    let unrolled = sphere(1.0, 128);
    let lights = [Vec3::X, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.48, 0.6, 0.64)];
    let unrolled = lights.map(|toward| (toward, by_position(&unrolled, &looked_up(&unrolled, toward))));
    let [without, narrow, wide] = [0.0, 1.0, 3.0].map(|reach| differences(&charted(reach * SIGMA0), &unrolled));
    println!(
        "at borders, from the unrolled sphere: {without:?} without halos, {narrow:?} of sigma0, {wide:?} of three"
    );
    assert!(without[0] > 0.2 && narrow[0] < without[0] / 2.0 && wide[0] < without[0] / 7.0);
    assert!(without[1] > 0.1 && narrow[1] < without[1] / 2.0 && wide[1] < without[1] / 6.0);
}

#[test]
fn constant_light_stays_constant_with_halos() {
    let mut mesh = charted(2.0 * SIGMA0);
    mesh.normals.iter_mut().for_each(|normal| *normal = Vec3::Y);
    let values = looked_up(&mesh, Vec3::Y);
    assert!(!mesh.halo.is_empty());
    for (_, values) in by_position(&mesh, &values) {
        assert!(values.iter().all(|value| *value == 1.0), "{values:?}");
    }
}

#[test]
fn boxes_that_touch_are_one() {
    let chart = |low, high| Chart { low, high };
    let apart_already = [chart([0, 0], [4, 4]), chart([6, 0], [9, 9])];
    assert_eq!(merged(apart_already.to_vec()).len(), 2);
    let chained = vec![chart([0, 0], [4, 4]), chart([8, 0], [12, 4]), chart([4, 2], [8, 9])];
    assert_eq!(merged(chained), [chart([0, 0], [12, 9])]);
}

#[test]
fn a_box_covers_the_texels_that_it_touches() {
    let found = texels([Vec2::new(0.5 / 1024.0, -1.0), Vec2::new(2.5 / 1024.0, 1.0)]);
    assert_eq!(found, Chart { low: [0, 0], high: [3, 1024] });
}
