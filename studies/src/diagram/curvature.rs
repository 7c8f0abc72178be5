//! Curvature from neighbouring pixels: how far the normal turns over a step along the surface.

use super::plane::{Section, at, flat};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, Pen, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3};
use lapidary_curvature::towards;

pub const DIAGRAM: Diagram = Diagram {
    name: "curvature",
    module: "curvature",
    title: "Curvature from position and normal",
    caption: "From one pixel to the next the position moves by the derivative pₓ and the unit normal turns by nₓ. \
              Their quotient is the curvature κ, the inverse of the radius R of the circle that fits the surface: \
              positive on a bump, negative in a dent.",
    draw,
};

/// Half a step between two pixels, in units of the section.
const STEP: f64 = 0.2;
/// Length of a unit normal on the sheet, in units of the section.
const UNIT: f64 = 0.72;
/// The same in the dent, where normals meet.
const SHORT: f64 = 0.45;

/// The surface's height at x, its slope and the slope's slope.
fn surface(x: f64) -> [f64; 3] {
    let (height, often) = (0.62, 1.45);
    let (s, c) = (often * x).sin_cos();
    [height * s, height * often * c, -height * often * often * s]
}

fn place(x: f64) -> DVec2 {
    at(x, surface(x)[0])
}

/// Returns the unit normal.
fn normal(x: f64) -> DVec2 {
    at(-surface(x)[1], 1.0).normalize()
}

/// Returns the module's curvature along the section, from the derivatives of a pixel a step wide. Across the section
/// nothing bends.
pub fn kappa(x: f64) -> f64 {
    let [_, slope, bend] = surface(x);
    let tangent = at(1.0, slope);
    let turn = -bend / (1.0 + slope * slope).powf(1.5) * tangent;
    let (p, n) = (flat(STEP * tangent), flat(STEP * turn));
    f64::from(towards(p, Vec3::Z * STEP as f32, n, Vec3::ZERO, flat(tangent)))
}

/// Places of the bump and of the dent.
pub const PLACES: [f64; 2] = [1.083, -1.083];

fn draw() -> Scene {
    let mut scene = Scene::new(720, 430);
    let view = Section::new(360.0, 226.0, 138.0);
    let curve: Vec<DVec2> = (-100..=100).map(|k| place(f64::from(k) * 0.0253)).collect();
    let mut body = curve.clone();
    body.extend([at(2.53, -1.48), at(-2.53, -1.48)]);
    scene.area(&view.all(&body), Paint::Accent, 0.12);
    circle(&mut scene, &view, PLACES[0], ACCENT);
    circle(&mut scene, &view, PLACES[1], SECOND);
    scene.line(&view.all(&curve), INK.wide());
    pixels(&mut scene, &view, PLACES[0], UNIT);
    pixels(&mut scene, &view, PLACES[1], SHORT);
    let (bump, dent) = (view.at(place(PLACES[0])), view.at(place(PLACES[1])));
    scene.symbol(bump + at(0.0, 24.0), Anchor::Middle, Paint::Ink, "'p_x");
    scene.symbol(bump + at(84.0, -100.0), Anchor::Middle, Paint::Warm, "'n_x");
    scene.symbol(bump + at(-74.0, -86.0), Anchor::Middle, Paint::Ink, "'n");
    scene.note(bump + at(112.0, -18.0), Anchor::Middle, Paint::Accent, "$κ$ > 0");
    scene.note(dent + at(0.0, 34.0), Anchor::Middle, Paint::Second, "$κ$ < 0");
    scene
}

/// The circle that fits the surface, and its radius.
fn circle(scene: &mut Scene, view: &Section, x: f64, pen: Pen) {
    let kappa = kappa(x);
    let middle = place(x) - normal(x) / kappa;
    scene.ring(view.at(middle), (view.scale / kappa).abs(), pen.dashed());
    scene.named(if kappa > 0.0 { "bump" } else { "dent" });
    scene.dot(view.at(middle), 4.0, pen.paint);
    let rim = middle + at(-0.8, if kappa > 0.0 { -0.6 } else { 0.6 }) / kappa.abs();
    scene.line(&view.all(&[middle, rim]), pen.thin());
    let aside = if kappa > 0.0 { at(18.0, 30.0) } else { at(26.0, -28.0) };
    scene.note(view.at(middle) + aside, Anchor::Middle, pen.paint, "$R$ = 1/|$κ$|");
}

/// Normals of two neighbouring pixels, and what they differ by.
fn pixels(scene: &mut Scene, view: &Section, x: f64, unit: f64) {
    let [one, other] = [x - STEP, x + STEP];
    let tips = [place(other) + unit * normal(one), place(other) + unit * normal(other)];
    scene.line(&view.all(&[place(other), tips[0]]), DIM.thin().dashed());
    for x in [one, other] {
        scene.arrow(&view.all(&[place(x), place(x) + unit * normal(x)]), INK);
    }
    scene.arrow(&view.all(&tips), WARM).named("turn");
    scene.arrow(&view.all(&[place(one), place(other)]), INK).named("step");
    scene.dot(view.at(place(one)), 4.5, Paint::Ink).dot(view.at(place(other)), 4.5, Paint::Ink);
}
