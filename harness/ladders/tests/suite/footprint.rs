//! Facets' edges smoothed from one sample per pixel: what the second pass mixes, and what it gives.

use glam::Vec4;
use lapidary_assay::extremum::larger;
use lapidary_ladders::gem::{change, views};
use lapidary_plan::Effects;
use lapidary_render as render;
use lapidary_render::{GemOptions, Picture, Settings};
use lapidary_scene::{Copies, Object, Place, Scene};

fn settings(rung: &str, samples: u32, footprint: bool) -> Settings {
    let gem = GemOptions { footprint, ..GemOptions::default() };
    Settings { rung: rung.parse().expect(rung), samples, gem, ..Settings::of_size(256, 256) }
}

fn picture(scene: &Scene, rung: &str, samples: u32, footprint: bool) -> Picture {
    render::render(lapidary_testing::gpu(), scene, &settings(rung, samples, footprint)).expect("rendered")
}

/// One sample per pixel is about half as far from the picture of 64, and changes about half as much
/// from frame to frame, with copies too. With two rays, green's edges stand for blue's, and the step
/// cut's long facets are thinner than a pixel: there it is a little more than half.
#[test]
fn smoothed_edges_halve_error_and_change() {
    for (name, rung, most) in
        [("brilliant", "walk-8+tracker", 0.5), ("brilliant", "walk-8+split", 0.6), ("step_cut", "walk-8", 0.55)]
    {
        check(&Scene::named(name).expect("built in"), rung, most);
    }
    let mut copied = Scene::named("brilliant").expect("built in");
    let Object { name, mesh, material, .. } = copied.objects.remove(0);
    let copies = Copies { shape: mesh, places: vec![Place::IDENTITY] };
    copied.objects.push(Object::of_copies(name, copies, material));
    check(&copied, "walk-8+tracker", 0.5);
}

fn check(scene: &Scene, rung: &str, most: f64) {
    let converged = picture(scene, rung, 8, false);
    let [plain, smooth] = [false, true].map(|footprint| {
        let now = picture(scene, rung, 1, footprint);
        let steady = change(&now, &picture(&views::turned(scene), rung, 1, footprint), &converged);
        (change(&now, &converged, &converged), steady)
    });
    println!("{} {rung}: error {} to {}, change {} to {}", scene.name, plain.0, smooth.0, plain.1, smooth.1);
    assert!(smooth.0 <= most * plain.0 && smooth.1 <= most * plain.1, "{}: {plain:?}, {smooth:?}", scene.name);
}

/// The second pass, with radiance and shares that are known: each pixel takes from the neighbour that
/// its share names, at the border from itself, and a share of 0 takes nothing.
#[test]
fn the_second_pass_takes_each_share_from_its_neighbour() {
    let shown = "    return GemFootprintTargets(radiance, neighbours);";
    let source = lapidary_wgsl::recipe_source("gem_walk");
    assert!(source.contains(shown));
    // Shares are multiples of 1/255, so that eight bits hold them.
    let planted = source.replace(
        shown,
        "    let x = u32(input.clip.x);
    let y = u32(input.clip.y);
    let known = vec4f(f32(x), f32(y), f32((x * 7u + y * 13u) % 31u), radiance.a);
    let shares = vec4f(f32(x % 5u), f32(y % 4u), f32((x + y) % 6u), f32((x + 2u * y) % 3u)) * (10.0f / 255.0f);
    return GemFootprintTargets(known + 1e-20f * neighbours, select(vec4f(0.0f), shares, (x / 8u) % 2u == 0u));",
    );
    let mut scene = Scene::named("brilliant").expect("built in");
    // So near that the stone fills the picture to its border.
    scene.camera.eye = scene.camera.target + 0.45 * (scene.camera.eye - scene.camera.target);
    let side = 96u32;
    let settings = Settings { width: side, height: side, ..settings("walk-1", 1, true) };
    let found = render::render_with(lapidary_testing::gpu(), &scene, &settings, &planted).expect("rendered");
    let known = |x: u32, y: u32| Vec4::new(x as f32, y as f32, ((x * 7 + y * 13) % 31) as f32, 1.0);
    let (mut worst, mut mixed) = (0f32, 0);
    for y in 0..side {
        for x in 0..side {
            let pixel = Vec4::from_array(found.linear[(y * side + x) as usize]);
            let shares = Vec4::new((x % 5) as f32, (y % 4) as f32, ((x + y) % 6) as f32, ((x + 2 * y) % 3) as f32);
            let shares = if (x / 8) % 2 == 0 { shares * (10.0 / 255.0) } else { Vec4::ZERO };
            let last = side - 1;
            let around = [
                known((x + 1).min(last), y),
                known(x.saturating_sub(1), y),
                known(x, (y + 1).min(last)),
                known(x, y.saturating_sub(1)),
            ];
            let taken: f32 = shares.to_array().iter().sum();
            let sum: Vec4 = shares.to_array().into_iter().zip(around).map(|(share, neighbour)| share * neighbour).sum();
            let expected = (1.0 - taken) * known(x, y) + sum;
            worst = larger(worst, (pixel - expected).abs().max_element() / side as f32);
            mixed += usize::from(taken > 0.0);
        }
    }
    println!("{mixed} pixels mixed, off by {worst:e} of the range");
    // Nine products and sums; a share as 8 bits comes back to half a last place.
    assert!(mixed > 3000 && worst <= 16.0 * f32::EPSILON, "{mixed} pixels, {worst:e}");
}

/// In a scene of several techniques, stones by walk are smoothed and all else stays as it was, as far as
/// two pictures of the figure agree, whose ways of light are found in any order.
#[test]
fn other_bodies_stay_as_they_are() {
    let scene = Scene::named("vitrine").expect("built in");
    let by = |footprint| {
        let settings = Settings { rung: lapidary_plan::Rung::ByMaterial, ..settings("walk-1", 1, footprint) };
        render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered").linear
    };
    let [plain, smooth] = [by(false), by(true)];
    let alone =
        Scene { objects: scene.objects.iter().filter(|object| is_walked(object)).cloned().collect(), ..scene.clone() };
    let stones = picture(&alone, "walk-1", 1, false).linear;
    let (mut others, mut changed) = (0, 0);
    for (pixel, (plain, smooth)) in plain.iter().zip(&smooth).enumerate() {
        if stones[pixel][3] == 0.0 {
            let difference = (Vec4::from_array(*plain) - Vec4::from_array(*smooth)).abs().max_element();
            assert!(difference <= 1e-3, "pixel {pixel}: {plain:?}, {smooth:?}");
            others += usize::from(plain[3] > 0.0);
        } else {
            changed += usize::from(plain != smooth);
        }
    }
    println!("{others} pixels of other bodies, {changed} of stones changed");
    assert!(others > 5000 && changed > 500, "{others}, {changed}");
}

fn is_walked(object: &Object) -> bool {
    ["diamond", "ruby"].contains(&&*object.name)
}

/// Left out, the effect leaves nothing behind: the picture is that without it, bit for bit.
#[test]
fn left_out_it_changes_nothing() {
    let scene = Scene::named("brilliant").expect("built in");
    let without = Effects::of(&[lapidary_plan::Effect::Footprint]);
    let left_out = Settings { without, ..settings("walk-4", 1, true) };
    let left_out = render::render(lapidary_testing::gpu(), &scene, &left_out).expect("rendered");
    assert!(left_out == picture(&scene, "walk-4", 1, false));
}
