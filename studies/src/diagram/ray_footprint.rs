//! The edge between two facets, as a ray and its pixel see it.

use super::plane::at;
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3, Vec4, vec3};
use lapidary_ray_footprint::{edge, neighbours, share};

pub const DIAGRAM: Diagram = Diagram {
    name: "ray_footprint",
    module: "ray_footprint",
    title: "The edge of a facet within a pixel",
    caption: "Left, a ray meets facet A and would have met B a little later; a step of a pixel moves the hit by the \
              offset drawn beside it. Right, the edge between the two facets is then a line in the pixel. The part \
              beyond it shows what the neighbours on that side have found, each by its share.",
    draw,
};

/// The ray: its direction, and the hit's offsets for a step of a pixel to the right and down.
pub const RAY: [Vec3; 3] = [vec3(0.0, -1.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0)];
/// Where the ray meets the section, in pixels from the edge, whose height is 0.
const HIT: f32 = -0.26;

/// Returns the outward unit normals of the facets A and B.
pub fn normals() -> [Vec3; 2] {
    [vec3(-0.52, -1.0, 0.05).normalize(), vec3(0.62, -1.0, 0.5).normalize()]
}

/// Returns the distances at which the ray, from height 3 above the edge, meets both planes.
fn distances() -> [f32; 2] {
    let origin = vec3(HIT, 3.0, 0.0);
    normals().map(|normal| -normal.dot(origin) / normal.dot(RAY[0]))
}

/// Returns the edge as a line in the pixel, by the module.
pub fn line() -> Vec3 {
    let ([direction, right, down], [a, b], [near, far]) = (RAY, normals(), distances());
    edge(direction, right, down, a, b, far - near)
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 410);
    facets(&mut scene);
    pixel(&mut scene);
    scene.line(&[at(330.0, 30.0), at(330.0, 380.0)], DIM.thin());
    scene
}

/// The section through the ray: both facets, and the two hits.
fn facets(scene: &mut Scene) {
    let place = |x: f64, y: f64| at(196.0 + 150.0 * x, 268.0 - 150.0 * y);
    let slope = normals().map(|normal| f64::from(-normal.x / normal.y));
    let on = |facet: usize, x: f64| place(x, slope[facet] * x);
    let body = [place(-1.12, 1.3), on(0, -1.12), on(0, 0.0), on(1, 0.84), place(0.84, 1.3)];
    scene.area(&body, Paint::Accent, 0.12);
    scene.line(&[on(0, 0.0), on(1, -0.62)], DIM.thin().dashed());
    scene.line(&[on(0, -1.12), on(0, 0.0), on(1, 0.84)], INK);
    let ([near, far], hit) = (distances().map(|t| 3.0 - f64::from(t)), f64::from(HIT));
    scene.line(&[place(hit, near), place(hit, far)], WARM.thin().dashed());
    for side in [-0.5, 0.5] {
        let facet = usize::from(hit + side > 0.0);
        scene.line(&[place(hit + side, 1.3), on(facet, hit + side)], ACCENT.thin());
    }
    scene.arrow(&[place(hit, 1.3), place(hit, near)], ACCENT.wide());
    scene.dot(place(hit, near), 5.5, Paint::Accent).dot(place(hit, far), 5.0, Paint::Warm);
    scene.arrow(&[place(hit, 1.12), place(hit + 1.0, 1.12)], SECOND);
    scene.symbol(place(hit + 0.62, 1.0), Anchor::Middle, Paint::Second, "∂_x'p");
    scene.symbol(on(0, -0.9) + at(-14.0, 22.0), Anchor::Middle, Paint::Ink, "A");
    scene.symbol(on(1, 0.62) + at(20.0, 14.0), Anchor::Middle, Paint::Ink, "B");
    scene.symbol(place(hit, near) + at(24.0, -14.0), Anchor::Middle, Paint::Accent, "t_A");
    scene.symbol(place(hit, far) + at(24.0, 8.0), Anchor::Middle, Paint::Warm, "t_B");
}

/// The pixel and its neighbours, with the edge and the shares.
fn pixel(scene: &mut Scene) {
    let (middle, side) = (at(530.0, 205.0), 118.0);
    let line = line();
    let place = |point: DVec2| middle + side * point;
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let corner = at(x - 0.5, y - 0.5);
        let corners = [corner, corner + at(1.0, 0.0), corner + 1.0, corner + at(0.0, 1.0)].map(place);
        scene.outline(&corners, if x == 0.0 && y == 0.0 { INK } else { DIM.thin() });
    }
    let beyond: Vec<DVec2> = beyond(line).into_iter().map(place).collect();
    scene.area(&beyond, Paint::Second, 0.35).named("beyond");
    let along = at(f64::from(-line.z), f64::from(line.y)).normalize();
    let nearest = f64::from(line.x) / f64::from(line.y * line.y + line.z * line.z);
    let foot = nearest * at(f64::from(line.y), f64::from(line.z));
    scene.line(&[place(foot - 0.84 * along), place(foot + 0.84 * along)], SECOND);
    scene.dot(place(DVec2::ZERO), 5.5, Paint::Accent);
    let area = share(line);
    let shares: Vec4 = neighbours(line, area);
    let rest = format!("${:.2}$", 1.0 - area);
    scene.note(place(at(-0.26, -0.3)), Anchor::Middle, Paint::Ink, &rest);
    for (x, y, share) in
        [(1.0_f64, 0.0_f64, shares.x), (-1.0, 0.0, shares.y), (0.0, 1.0, shares.z), (0.0, -1.0, shares.w)]
    {
        let paint = if share > 0.0 { Paint::Second } else { Paint::Dim };
        let text = format!("${share:.2}$");
        scene.note(place(at(1.05 * x, 1.12 * y)), Anchor::Middle, paint, &text);
    }
}

/// Returns the part of the pixel beyond a line, a polygon.
pub fn beyond(line: Vec3) -> Vec<DVec2> {
    let corners = [at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)];
    let height = |point: DVec2| f64::from(line.y) * point.x + f64::from(line.z) * point.y - f64::from(line.x);
    let mut left = Vec::new();
    for (index, from) in corners.into_iter().enumerate() {
        let to = corners[(index + 1) % 4];
        let (start, end) = (height(from), height(to));
        if start >= 0.0 {
            left.push(from);
        }
        if start.min(end) < 0.0 && start.max(end) > 0.0 {
            left.push(from.lerp(to, start / (start - end)));
        }
    }
    left
}
