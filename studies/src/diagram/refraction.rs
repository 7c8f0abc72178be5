//! Refraction into a stone and out of it, and where no light gets out.

use super::plane::{at, flat, section};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, Pen, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3};
use lapidary_refraction::{RefractionHit, reflect, refract, relative_index};

pub const DIAGRAM: Diagram = Diagram {
    name: "refraction",
    module: "refraction",
    title: "Refraction at a facet, and total internal reflection",
    caption: "Light bends towards the normal where it enters a diamond, and away from it where it leaves. At the \
              critical angle it grazes the facet; beyond that angle, all of it stays inside.",
    draw,
};

/// Refractive index of diamond.
pub const INDEX: f32 = 2.42;
/// Angle of incidence of the ray that enters, in degrees.
pub const ENTERS: f64 = 52.0;
/// The facet on the sheet.
const FACET: f64 = 180.0;
/// Lengths of the rays outside and inside.
const LENGTHS: (f64, f64) = (148.0, 158.0);

/// Returns a direction in the section, by its angle from straight down.
fn falling(degrees: f64) -> DVec2 {
    DVec2::new(degrees.to_radians().sin(), -degrees.to_radians().cos())
}

/// Returns a direction in the section, by its angle from straight up.
fn rising(degrees: f64) -> DVec2 {
    DVec2::new(degrees.to_radians().sin(), degrees.to_radians().cos())
}

/// From diamond into air, below the facet.
fn leave(degrees: f64) -> RefractionHit {
    refract(flat(rising(degrees)), Vec3::NEG_Y, relative_index(INDEX, 1.0))
}

/// Returns the largest angle of incidence, in degrees, at which light still leaves: found by halving.
pub fn critical() -> f64 {
    let (mut leaves, mut stays) = (0.0, 90.0);
    for _ in 0..40 {
        let middle = 0.5 * (leaves + stays);
        *(if leave(middle).total { &mut stays } else { &mut leaves }) = middle;
    }
    leaves
}

/// What a direction of the section is on the sheet.
fn down(direction: DVec2) -> DVec2 {
    DVec2::new(direction.x, -direction.y)
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 372);
    scene.cell(at(0.0, FACET), at(720.0, 372.0), Paint::Accent, 0.1);
    for place in [150.0, 322.0, 442.0, 596.0] {
        scene.line(&[at(place, 74.0), at(place, 298.0)], DIM.thin().dashed());
    }
    scene.line(&[at(0.0, FACET), at(720.0, FACET)], INK);
    scene.note(at(150.0, 30.0), Anchor::Middle, Paint::Ink, "on the way in");
    scene.note(at(460.0, 30.0), Anchor::Middle, Paint::Ink, "on the way out");
    scene.note(at(16.0, 156.0), Anchor::Start, Paint::Dim, "air");
    scene.note(at(16.0, 204.0), Anchor::Start, Paint::Dim, "diamond");
    scene.note(at(16.0, 230.0), Anchor::Start, Paint::Dim, &format!("$n$ = {INDEX}"));
    enters(&mut scene, at(150.0, FACET));
    let critical = critical();
    exits(&mut scene, at(322.0, FACET), 15.0, ACCENT, "leaves");
    exits(&mut scene, at(442.0, FACET), critical, ACCENT, "grazes");
    exits(&mut scene, at(596.0, FACET), 42.0, WARM, "stays");
    let written = format!("$θ_c$ = {critical:.1}°");
    scene.note(at(462.0, 152.0), Anchor::Start, Paint::Ink, &written);
    scene.note(at(334.0, 330.0), Anchor::Middle, Paint::Dim, "$θ$ < $θ_c$");
    scene.note(at(446.0, 330.0), Anchor::Middle, Paint::Dim, "$θ$ = $θ_c$");
    scene.note(at(596.0, 330.0), Anchor::Middle, Paint::Dim, "$θ$ > $θ_c$");
    scene
}

/// A ray from the air, its refracted ray and, faintly, its reflection.
fn enters(scene: &mut Scene, place: DVec2) {
    let (outside, inside) = LENGTHS;
    let incident = falling(ENTERS);
    let refracted = section(refract(flat(incident), Vec3::Y, relative_index(1.0, INDEX)).direction);
    let mirrored = section(reflect(flat(incident), Vec3::Y));
    scene.arrow(&[place, place + 0.55 * outside * down(mirrored)], DIM);
    scene.arrow(&[place - outside * down(incident), place], ACCENT.wide()).named("incident");
    scene.arrow(&[place, place + inside * down(refracted)], ACCENT.wide()).named("refracted");
    scene.angle(place, 52.0, -down(incident), at(0.0, -1.0), INK.thin());
    scene.angle(place, 84.0, down(refracted), at(0.0, 1.0), INK.thin());
    scene.symbol(place + 74.0 * -down(falling(0.5 * ENTERS)), Anchor::Middle, Paint::Ink, "θ_i");
    scene.symbol(place + at(17.0, 104.0), Anchor::Middle, Paint::Ink, "θ_t");
    scene.symbol(place - outside * down(incident) + at(2.0, -20.0), Anchor::Middle, Paint::Accent, "'r");
    scene.symbol(place + inside * down(refracted) + at(24.0, -6.0), Anchor::Middle, Paint::Accent, "'r^t");
    scene.symbol(place + at(0.0, -122.0), Anchor::Middle, Paint::Dim, "'n");
}

/// A ray from inside, and what becomes of it.
fn exits(scene: &mut Scene, place: DVec2, degrees: f64, pen: Pen, name: &'static str) {
    let (outside, inside) = LENGTHS;
    let incident = down(rising(degrees));
    let hit = leave(degrees);
    let length = if hit.total { inside } else { 0.8 * outside };
    scene.arrow(&[place - inside * incident, place], pen.wide());
    scene.arrow(&[place, place + length * down(section(hit.direction))], pen.wide()).named(name);
    scene.angle(place, 62.0, -incident, at(0.0, 1.0), INK.thin());
}
