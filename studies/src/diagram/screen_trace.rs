//! A ray followed over a picture, by equal steps on the screen.

use super::plane::{Section, at};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, Scene};
use super::sheet::Diagram;
use glam::DVec2;
use lapidary_screen_trace::{crossing, distance, meets};

pub const DIAGRAM: Diagram = Diagram {
    name: "screen_trace",
    module: "screen_trace",
    title: "A ray in steps of equal length on the screen",
    caption: "Steps that are equal on the screen grow along the ray with its distance from the eye. The ray goes on \
              until a step ends behind what the depth buffer shows. Where on that step it goes through the surface \
              follows from both ends in 1/w, exactly if the surface is flat.",
    draw,
};

/// Ends of the ray, in units of the section; the eye is the origin and looks along x.
pub const RAY: [DVec2; 2] = [at(2.3, -1.12), at(9.6, 1.5)];
/// A wall that the depth buffer shows.
pub const WALL: [DVec2; 2] = [at(6.7, -1.5), at(7.6, 1.75)];
/// Steps on the screen.
pub const STEPS: u32 = 8;
/// Distance of the screen.
const SCREEN: f64 = 1.15;

/// Returns the point at a fraction of the ray's way on the screen, by the module.
pub fn point(fraction: f64) -> DVec2 {
    let [from, to] = RAY;
    let reach = (to - from).length();
    let gone = distance(from.x as f32, to.x as f32, reach as f32, fraction as f32);
    from + f64::from(gone) / reach * (to - from)
}

/// Returns 1 / w of the wall in the direction of a point.
fn wall(point: DVec2) -> f32 {
    let [from, to] = WALL;
    let way = to - from;
    (point.perp_dot(way) / point.x / from.perp_dot(way)) as f32
}

/// Returns the first step that meets the wall, and the fraction of the whole way at which it does.
pub fn found() -> Option<(u32, f64)> {
    let place_of = |k: u32| point(f64::from(k) / f64::from(STEPS));
    let inverse = |k: u32| (1.0 / place_of(k).x) as f32;
    let step = (1..=STEPS).find(|k| meets(inverse(k - 1), inverse(*k), wall(place_of(*k)), 2.0))?;
    let part = crossing(inverse(step - 1), wall(place_of(step - 1)), inverse(step), wall(place_of(step)));
    Some((step, (f64::from(step - 1) + f64::from(part)) / f64::from(STEPS)))
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 316);
    let view = Section::new(30.0, 178.0, 67.0);
    let last = found().map_or(STEPS, |found| found.0);
    for k in 0..=last {
        let point = point(f64::from(k) / f64::from(STEPS));
        scene.line(&view.all(&[DVec2::ZERO, point]), DIM.thin());
        scene.dot(view.at(SCREEN / point.x * point), 3.6, Paint::Ink).named("on the screen");
    }
    scene.line(&view.all(&[at(SCREEN, -0.85), at(SCREEN, 0.5)]), INK);
    scene.line(&view.all(&WALL), INK.wide());
    scene.line(&view.all(&RAY), ACCENT.thin().dashed());
    let end = point(f64::from(last) / f64::from(STEPS));
    scene.arrow(&view.all(&[RAY[0], end]), ACCENT.wide());
    for k in 0..=last {
        scene.dot(view.at(point(f64::from(k) / f64::from(STEPS))), 5.0, Paint::Accent).named("step");
    }
    if let Some((_, fraction)) = found() {
        let place = view.at(point(fraction));
        scene.dot(place, 6.5, Paint::Warm).named("through");
        scene.symbol(place + at(-20.0, -20.0), Anchor::Middle, Paint::Warm, "s^*");
    }
    scene.dot(view.at(DVec2::ZERO), 6.0, Paint::Ink);
    scene.note(view.at(DVec2::ZERO) + at(-6.0, -24.0), Anchor::Start, Paint::Ink, "eye");
    scene.note(view.at(at(SCREEN, 0.5)) + at(0.0, -20.0), Anchor::Middle, Paint::Ink, "screen");
    scene.note(view.at(WALL[1]) + at(-16.0, 8.0), Anchor::End, Paint::Ink, "depth buffer");
    scene.symbol(view.at(RAY[0]) + at(4.0, 26.0), Anchor::Middle, Paint::Accent, "w_0");
    scene.symbol(view.at(RAY[1]) + at(10.0, 28.0), Anchor::Middle, Paint::Accent, "w_1");
    scene
}
