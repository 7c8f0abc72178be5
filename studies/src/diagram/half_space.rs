//! How bright scattering matter looks from all sides, beside Lambert's law.

use super::plane::{Section, at};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::DVec2;
use lapidary_half_space::factor;

pub const DIAGRAM: Diagram = Diagram {
    name: "half_space",
    module: "half_space",
    title: "Scattered light by direction, beside Lambert's law",
    caption: "Light falls on thick scattering matter; the distance of a curve from the point it falls on is how \
              bright that point looks from there. By Lambert's law it looks alike from everywhere, and white matter, \
              with γ = 0, nearly does. The darker the matter, the brighter it is at a grazing view; γ is 1 for black.",
    draw,
};

/// The light's angle from the normal, in degrees.
pub const LIGHT: f64 = 55.0;
/// Gamma of each curve.
pub const GAMMAS: [f32; 3] = [0.0, 0.4, 0.9];

/// Returns the law's factor on Lambert's for a view at an angle from the normal.
pub fn seen(degrees: f64, gamma: f32) -> f64 {
    let cosine = |degrees: f64| degrees.abs().to_radians().cos() as f32;
    f64::from(factor(cosine(degrees), cosine(LIGHT), gamma))
}

/// Returns a direction above the surface, by its angle from the normal.
fn above(degrees: f64) -> DVec2 {
    at(degrees.to_radians().sin(), degrees.to_radians().cos())
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 350);
    let view = Section::new(360.0, 270.0, 168.0);
    scene.cell(at(0.0, 270.0), at(720.0, 350.0), Paint::Ink, 0.08);
    scene.line(&[at(0.0, 270.0), at(720.0, 270.0)], INK);
    scene.line(&view.all(&[DVec2::ZERO, at(0.0, 1.45)]), DIM.thin().dashed());
    let curve = |law: &dyn Fn(f64) -> f64| -> Vec<DVec2> {
        let angles = (-45..=45).map(|k| f64::from(k) * 1.98);
        angles.map(|angle| view.at(law(angle) * above(angle))).collect()
    };
    scene.line(&curve(&|_| 1.0), DIM.dashed()).named("Lambert");
    for (gamma, pen) in GAMMAS.into_iter().zip([ACCENT, SECOND, WARM]) {
        scene.line(&curve(&|angle| seen(angle, gamma)), pen).named("law");
    }
    scene.arrow(&view.all(&[1.95 * above(-LIGHT), DVec2::ZERO]), INK.wide());
    scene.angle(view.at(DVec2::ZERO), 60.0, at(0.0, -1.0), at(-0.819, -0.574), INK.thin());
    scene.symbol(view.at(0.47 * above(-0.5 * LIGHT)), Anchor::Middle, Paint::Ink, "θ_0");
    scene.symbol(view.at(at(0.0, 1.45)) + at(18.0, 0.0), Anchor::Middle, Paint::Dim, "'n");
    scene.note(view.at(1.95 * above(-LIGHT)) + at(0.0, -18.0), Anchor::Middle, Paint::Ink, "light");
    for (row, (gamma, paint)) in GAMMAS.into_iter().zip([Paint::Accent, Paint::Second, Paint::Warm]).enumerate() {
        let place = at(566.0, 30.0 + 28.0 * row as f64);
        scene.note(place, Anchor::Start, paint, &format!("$γ$ = {gamma}"));
    }
    scene.note(at(566.0, 114.0), Anchor::Start, Paint::Dim, "Lambert");
    scene
}
