//! The wavelengths of a ray that leaves a stone, each traced alone and all from one ray and its gradient.

use super::plane::{Section, at, flat, section};
use super::scene::{Anchor, DIM, INK, Paint, Pen, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3};
use lapidary_dispersion::{
    DISPERSION_DIAMOND, DISPERSION_LINE_B, DISPERSION_LINE_D, DISPERSION_LINE_G, direction, enter, refract, sellmeier,
};
use lapidary_refraction as refraction;

pub const DIAGRAM: Diagram = Diagram {
    name: "dispersion",
    module: "dispersion",
    title: "One ray and its gradient stand for all wavelengths",
    caption: "Two facets of a diamond spread white light into a fan. Lines are wavelengths traced alone: red, yellow \
              and violet. Dots lie in the directions that the yellow ray alone gives for red and violet by its \
              gradient: right for red, a little off for violet, which is closer to total reflection.",
    draw,
};

/// Angles of the two facets' outward normals and of the light, in degrees.
const ANGLES: [f64; 3] = [193.0, 50.0, 48.0];
/// The edge between the facets, and where the ray enters.
const EDGE: DVec2 = at(0.0, 0.0);
const ENTRY: f64 = 1.35;

/// Returns a direction of the section.
fn toward(degrees: f64) -> DVec2 {
    DVec2::from_angle(degrees.to_radians())
}

/// A ray through both facets.
#[derive(Clone, Copy, Debug)]
pub struct Through {
    /// Where it leaves.
    pub exit: DVec2,
    /// Its direction outside.
    pub direction: Vec3,
    /// The derivative of that direction with respect to the index.
    pub gradient: Vec3,
}

/// Returns the index at a wavelength in nm.
pub fn index(wavelength: f32) -> f32 {
    sellmeier(DISPERSION_DIAMOND, wavelength)
}

/// Follows light of one wavelength, by the modules.
pub fn through(wavelength: f32) -> Through {
    let ([first, second], light, index) = ([ANGLES[0], ANGLES[1]].map(toward), toward(ANGLES[2]), index(wavelength));
    let entry = entry();
    let inside = refraction::refract(flat(light), flat(first), index).direction;
    let gradient = enter(flat(light), flat(first), index);
    let exit = entry + section(inside) * ((EDGE - entry).dot(second) / section(inside).dot(second));
    let outside = refraction::refract(inside, flat(-second), 1.0 / index).direction;
    Through {
        exit,
        direction: outside,
        gradient: refract(inside, gradient, flat(-second), 1.0 / index, -1.0 / (index * index)),
    }
}

/// Where the light enters.
fn entry() -> DVec2 {
    EDGE + ENTRY * toward(ANGLES[0] + 90.0)
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 372);
    let view = Section::new(206.0, 36.0, 104.0);
    let [one, other] = [ANGLES[0] + 90.0, ANGLES[1] - 90.0].map(|angle| EDGE + 3.0 * toward(angle));
    scene.area(&view.all(&[one, EDGE, other]), Paint::Accent, 0.12);
    scene.line(&view.all(&[one, EDGE, other]), INK);
    // Where the stone goes on.
    scene.line(&view.all(&[one, other]), DIM.thin().dashed());
    let entry = entry();
    scene.arrow(&view.all(&[entry - 1.9 * toward(ANGLES[2]), entry]), INK.wide());
    scene.note(view.at(entry - 1.9 * toward(ANGLES[2])) + at(-8.0, 24.0), Anchor::Middle, Paint::Ink, "white");
    let reach = 3.3;
    for (wavelength, pen) in [(DISPERSION_LINE_B, WARM), (DISPERSION_LINE_D, DIM), (DISPERSION_LINE_G, SECOND)] {
        let Through { exit, direction, .. } = through(wavelength);
        fan(&mut scene, &view, &[entry, exit, exit + reach * section(direction)], pen);
    }
    let middle = through(DISPERSION_LINE_D);
    for (wavelength, paint) in [(DISPERSION_LINE_B, Paint::Warm), (DISPERSION_LINE_G, Paint::Second)] {
        let offset = index(wavelength) - index(DISPERSION_LINE_D);
        let guessed = direction(middle.direction, middle.gradient, offset);
        for far in [1.3, 2.2, 3.1] {
            scene.dot(view.at(middle.exit + far * section(guessed)), 4.5, paint).named("guessed");
        }
    }
    let ends = [
        (DISPERSION_LINE_B, Paint::Warm, -10.0, "red"),
        (DISPERSION_LINE_D, Paint::Dim, 7.0, "yellow"),
        (DISPERSION_LINE_G, Paint::Second, 14.0, "violet"),
    ];
    for (wavelength, paint, down, name) in ends {
        let Through { exit, direction, .. } = through(wavelength);
        scene.note(view.at(exit + reach * section(direction)) + at(11.0, down), Anchor::Start, paint, name);
    }
    scene.note(view.at(other) + at(-112.0, -4.0), Anchor::Middle, Paint::Dim, "diamond");
    scene
}

fn fan(scene: &mut Scene, view: &Section, points: &[DVec2], pen: Pen) {
    scene.line(&view.all(&points[..2]), pen.thin());
    scene.line(&view.all(&points[1..]), pen).named("traced");
}
