//! The lines along three vertex normals, and the point nearest to them.

use super::plane::{Oblique, at};
use super::scene::{Anchor, DIM, INK, Paint, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3, vec3};
use lapidary_closest_point::{centre, direction, fallback};

pub const DIAGRAM: Diagram = Diagram {
    name: "closest_point",
    module: "closest_point",
    title: "The centre of a gem's proxy sphere",
    caption: "A line runs inwards from each vertex of a facet, along its normal. On a sphere the three lines meet in \
              the centre. On a cut stone they pass one another; o is the point with the least squared distance from \
              all three, drawn a little towards p, which depends on the facet alone.",
    draw,
};

/// The facet.
pub const CORNERS: [Vec3; 3] = [vec3(-0.95, -0.55, 0.0), vec3(0.95, -0.45, 0.0), vec3(0.05, 1.05, 0.0)];
/// Middle of the sphere on the left.
const MIDDLE: Vec3 = vec3(0.0, 0.0, -1.9);

/// Returns the normals of a sphere.
fn of_sphere() -> [Vec3; 3] {
    CORNERS.map(|corner| direction(corner - MIDDLE))
}

/// Returns normals as of a cut stone: each averaged from other facets than its neighbours.
pub fn of_stone() -> [Vec3; 3] {
    [vec3(-0.4, -0.5, 1.0), vec3(0.72, -0.02, 1.0), vec3(-0.3, 0.56, 1.0)].map(direction)
}

/// Returns the centre by the module.
pub fn found(normals: [Vec3; 3]) -> Vec3 {
    let ([a, b, c], [p, q, r]) = (CORNERS, normals);
    centre(a, p, b, q, c, r)
}

/// Returns the point of a line that is nearest to another point.
fn foot(corner: Vec3, normal: Vec3, point: Vec3) -> Vec3 {
    corner + normal.dot(point - corner) * normal
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 414);
    let depth = DVec2::new(0.42, -0.34);
    let left = Oblique { origin: at(196.0, 168.0), scale: 100.0, depth };
    let right = Oblique { origin: at(548.0, 168.0), scale: 100.0, depth };
    scene.note(at(196.0, 24.0), Anchor::Middle, Paint::Ink, "on a sphere");
    scene.note(at(556.0, 24.0), Anchor::Middle, Paint::Ink, "on a cut stone");
    scene.line(&[at(358.0, 20.0), at(358.0, 394.0)], DIM.thin());
    panel(&mut scene, &left, of_sphere(), false);
    panel(&mut scene, &right, of_stone(), true);
    scene.note(at(548.0, 392.0), Anchor::Middle, Paint::Warm, "least $d_0^2$ + $d_1^2$ + $d_2^2$");
    scene
}

fn panel(scene: &mut Scene, view: &Oblique, normals: [Vec3; 3], stone: bool) {
    let point = found(normals);
    let facet = view.all(&CORNERS);
    scene.area(&facet, Paint::Accent, 0.16).outline(&facet, INK);
    for (corner, normal) in CORNERS.into_iter().zip(normals) {
        let foot = foot(corner, normal, point);
        let end = foot - if stone { 0.42 } else { 0.0 } * normal;
        scene.line(&[view.at(corner), view.at(end)], SECOND);
        scene.arrow(&[view.at(corner), view.at(corner + 0.5 * normal)], INK);
        if stone {
            scene.line(&[view.at(foot), view.at(point)], WARM.thin()).named("distance");
            scene.dot(view.at(foot), 3.0, Paint::Warm);
        }
    }
    let [a, b, c] = view.all(&CORNERS).try_into().unwrap_or_default();
    scene.symbol(a + at(-20.0, 4.0), Anchor::Middle, Paint::Ink, "'x_0");
    scene.symbol(b + at(26.0, 6.0), Anchor::Middle, Paint::Ink, "'x_1");
    scene.symbol(c + at(-26.0, -14.0), Anchor::Middle, Paint::Ink, "'x_2");
    let tip = view.at(CORNERS[0] + 0.5 * normals[0]);
    scene.symbol(tip + at(-22.0, -2.0), Anchor::Middle, Paint::Ink, "'n_0");
    if stone {
        let [a, b, c] = CORNERS;
        let away = fallback(a, b, c);
        scene.line(&[view.at((a + b + c) / 3.0), view.at(away)], DIM.thin().dashed());
        scene.ring(view.at(away), 6.0, DIM);
        scene.symbol(view.at(away) + at(26.0, 0.0), Anchor::Middle, Paint::Dim, "'p");
    }
    scene.dot(view.at(point), 6.5, Paint::Accent).named(if stone { "centre" } else { "meet" });
    scene.symbol(view.at(point) + at(24.0, 10.0), Anchor::Middle, Paint::Accent, "'o");
}
