//! What the canvas shows is what the renderer draws on lavapipe: read back from the GPU's texture and compared
//! over the covered pixels by FLIP.

use super::{Shown, running, set, shown};
use glam::Vec3;
use lapidary_gallery::live::{LiveScene, SCENES, SIDE, settings};
use lapidary_render::{Picture, render};
use lapidary_scene::Scene;
use lapidary_testing::gpu;

/// Largest mean FLIP of the covered pixels.
const MOST_MEAN: f32 = 0.01;
/// Largest FLIP of all covered pixels but a thousandth.
const MOST_HIGH: f32 = 0.1;

/// Mean FLIP of the covered pixels, and the one that a thousandth of them exceed.
#[derive(Clone, Copy, Debug)]
struct Apart {
    mean: f32,
    high: f32,
}

impl Apart {
    fn holds(self) -> bool {
        self.mean <= MOST_MEAN && self.high <= MOST_HIGH
    }
}

fn apart(seen: &Shown, drawn: &Picture) -> Apart {
    assert_eq!(seen.len(), 4 * drawn.encoded.len());
    let seen: Vec<u8> = seen.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let expected: Vec<u8> = drawn.encoded.iter().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let map = lapidary_flip::flip((drawn.width, drawn.height), &expected, &seen);
    let covered = map.iter().zip(&drawn.linear).filter(|(_, pixel)| pixel[3] > 0.0);
    let mut values: Vec<f32> = covered.map(|(value, _)| *value).collect();
    assert!(values.len() > drawn.linear.len() / 20, "{} pixels are covered", values.len());
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    values.sort_by(f32::total_cmp);
    Apart { mean, high: values[values.len() - 1 - values.len() / 1000] }
}

/// The renderer's picture of a rung, with the effects that are on at first.
fn drawn(live: &LiveScene, rung: &str, scene: &Scene) -> Picture {
    let settings = settings(live, rung, |toggle| toggle.on).expect("a rung");
    assert_eq!((settings.width, settings.height), (SIDE, SIDE));
    render(gpu(), scene, &settings).expect("rendered")
}

fn live(name: &str) -> &'static LiveScene {
    SCENES.iter().find(|live| live.scene == name).expect("a live scene")
}

#[test]
fn the_canvas_shows_what_the_renderer_draws() {
    // Unless the suite is run whole, the first rung of the first scene alone: others compile for half a minute each.
    let all = SCENES.iter().flat_map(|live| live.rungs.iter().map(move |rung| (live, *rung)));
    let chosen = all.take(if lapidary_testing::whole() { usize::MAX } else { 1 });
    let mut wrong = Vec::new();
    for (live, rung) in chosen {
        let scene = Scene::named(live.scene).expect("built in");
        let Some(mut page) = running(live.scene, &format!("rung={}", rung.replace('+', "%2B"))) else { return };
        assert_eq!(page.evaluate("gallery.live.state.rung").expect("a state"), rung, "{}", live.scene);
        let difference = apart(&shown(&mut page), &drawn(live, rung, &scene));
        println!("{:10} {rung:20} {difference:?}", live.scene);
        if !difference.holds() {
            wrong.push(format!("{} {rung}: {difference:?}", live.scene));
        }
        let problems = page.problems().expect("a list");
        wrong.extend(problems.iter().map(|problem| format!("{} {rung}: {problem}", live.scene)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The bounds see an index of refraction that is wrong by one step, and an eye that is wrong by half a degree.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_wrong_uniform_is_seen() {
    let Some(mut page) = running("brilliant", "") else { return };
    let live = live("brilliant");
    let scene = Scene::named("brilliant").expect("built in");
    let right = drawn(live, live.rungs[0], &scene);
    let before = apart(&shown(&mut page), &right);
    for change in ["state.steps.index -= 1", "state.azimuth += 0.5"] {
        let undo = page.evaluate("JSON.stringify(gallery.live.state)").expect("a state");
        set(&mut page, change);
        let wrong = apart(&shown(&mut page), &right);
        println!("{change}: {wrong:?}, before {before:?}");
        assert!(before.holds() && !wrong.holds(), "{change}: {wrong:?}, before {before:?}");
        set(&mut page, &format!("Object.assign(state, JSON.parse({undo}))"));
    }
    assert!(apart(&shown(&mut page), &right).holds(), "not as before");
}

/// A turned stone is the renderer's, seen from there.
#[test]
#[ignore = "long; .ci/full runs it"]
fn the_eye_goes_where_the_renderer_puts_it() {
    let Some(mut page) = running("brilliant", "") else { return };
    let live = live("brilliant");
    let scene = Scene::named("brilliant").expect("built in");
    let usual = scene.camera.eye.distance(scene.camera.target);
    for (polar, azimuth, share) in [(60.0f32, 0.0f32, 1.0), (90.0, -120.0, 0.7), (5.0, 40.0, 2.0)] {
        let distance = share * usual;
        set(
            &mut page,
            &format!("Object.assign(state, {{ polar: {polar}, azimuth: {azimuth}, distance: {distance} }})"),
        );
        let (across, up) = polar.to_radians().sin_cos();
        let (right, front) = azimuth.to_radians().sin_cos();
        let mut turned = scene.clone();
        turned.camera.up = Vec3::Y;
        turned.camera.eye = scene.camera.target + distance * Vec3::new(across * right, up, across * front);
        let difference = apart(&shown(&mut page), &drawn(live, live.rungs[0], &turned));
        println!("{polar} {azimuth} {share}: {difference:?}");
        assert!(difference.holds(), "{polar} {azimuth} {share}: {difference:?}");
    }
}
