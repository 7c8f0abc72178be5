//! A ray inside a cut stone, and the planes ahead of it.

use super::plane::{Section, at, flat, section};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3, Vec4, Vec4Swizzles as _};
use lapidary_convex_trace::{CONVEX_TRACE_FAR, CONVEX_TRACE_NONE, ConvexTraceHit, point, start, step, trace};
use lapidary_refraction::refract;

pub const DIAGRAM: Diagram = Diagram {
    name: "convex_trace",
    module: "convex_trace",
    title: "A ray meets the planes of a convex stone",
    caption: "Inside a convex stone a ray crosses the planes of the facets ahead of it, the facets that face its way. \
              The nearest crossing is the way out; the others lie outside the stone. Planes behind the ray, and the \
              one it starts on, don't count. In diamond this ray is totally reflected, and the next search begins.",
    draw,
};

/// Corners of a brilliant's section, counter-clockwise from the table's right end.
pub const OUTLINE: [DVec2; 7] =
    [at(0.54, 0.33), at(-0.54, 0.33), at(-1.0, 0.03), at(-1.0, -0.03), at(0.0, -0.87), at(1.0, -0.03), at(1.0, 0.03)];

/// Returns the planes of a prism with that section: outward unit normals and distances.
pub fn planes() -> Vec<Vec4> {
    let edge = |index: usize| {
        let (from, to) = (OUTLINE[index], OUTLINE[(index + 1) % OUTLINE.len()]);
        let outward = -(to - from).perp().normalize();
        flat(outward).extend(outward.dot(from) as f32)
    };
    (0..OUTLINE.len()).map(edge).collect()
}

/// A ray inside, as it starts on a facet.
#[derive(Clone, Copy, Debug)]
pub struct Inside {
    /// Where it starts.
    pub origin: Vec3,
    /// Its direction.
    pub direction: Vec3,
    /// The facet it starts on.
    pub left: u32,
}

/// Returns the ray as it enters through the table, and as the facet that it meets first reflects it.
pub fn rays(planes: &[Vec4]) -> [Inside; 2] {
    let incident = flat(at(-0.3, -0.95)).normalize();
    let enters = refract(incident, planes[0].xyz(), 2.42).direction;
    let first = Inside { origin: flat(at(0.36, 0.33)), direction: enters, left: 0 };
    let hit = trace(planes, first.origin, first.direction, first.left);
    let plane = planes[hit.face as usize];
    let origin = point(first.origin, first.direction, hit.distance, plane);
    let direction = refract(first.direction, -plane.xyz(), 1.0 / 2.42).direction;
    [first, Inside { origin, direction, left: hit.face }]
}

/// Returns where a ray crosses each plane ahead of it, by the module's own step from a fresh start.
pub fn crossings(planes: &[Vec4], ray: Inside) -> Vec<ConvexTraceHit> {
    let alone =
        |(face, plane): (u32, &Vec4)| step(start(CONVEX_TRACE_FAR), ray.origin, ray.direction, *plane, face, ray.left);
    (0..).zip(planes).map(alone).filter(|hit| hit.face != CONVEX_TRACE_NONE && hit.distance < 2.4).collect()
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 390);
    let view = Section::new(456.0, 132.0, 222.0);
    let planes = planes();
    let [first, ray] = rays(&planes);
    let hit = trace(&planes, ray.origin, ray.direction, ray.left);
    let crossings = crossings(&planes, ray);
    let along = |distance: f32| section(ray.origin + distance * ray.direction);
    scene.area(&view.all(&OUTLINE), Paint::Accent, 0.12);
    for crossing in &crossings {
        let plane = planes[crossing.face as usize];
        let (middle, way) = (section(plane.xyz()) * f64::from(plane.w), section(plane.xyz()).perp());
        scene.line(&view.all(&[middle - 3.0 * way, middle + 3.0 * way]), DIM.thin().dashed());
    }
    scene.outline(&view.all(&OUTLINE), INK);
    let farthest = crossings.iter().map(|crossing| crossing.distance).fold(0.0, f32::max);
    scene.line(&view.all(&[along(hit.distance), along(farthest)]), WARM.thin().dashed());
    for crossing in crossings.iter().filter(|crossing| crossing.face != hit.face) {
        scene.ring(view.at(along(crossing.distance)), 6.0, WARM).named("farther");
    }
    let entry = section(first.origin);
    scene.arrow(&view.all(&[entry + at(0.075, 0.2375), entry]), DIM);
    scene.arrow(&view.all(&[entry, section(ray.origin)]), DIM);
    let exit = section(point(ray.origin, ray.direction, hit.distance, planes[hit.face as usize]));
    scene.arrow(&view.all(&[section(ray.origin), exit]), ACCENT.wide()).named("ray");
    let tip = exit + 0.25 * section(planes[hit.face as usize].xyz());
    scene.arrow(&view.all(&[exit, tip]), SECOND);
    scene.dot(view.at(section(ray.origin)), 4.5, Paint::Ink);
    scene.dot(view.at(exit), 6.5, Paint::Accent).named("nearest");
    scene.symbol(view.at(tip) + at(-4.0, 24.0), Anchor::Middle, Paint::Second, "'n_f");
    scene.symbol(view.at(section(ray.origin)) + at(20.0, 16.0), Anchor::Middle, Paint::Ink, "'x");
    scene.symbol(view.at(0.5 * (section(ray.origin) + exit)) + at(0.0, -20.0), Anchor::Middle, Paint::Accent, "t");
    legend(&mut scene);
    scene
}

fn legend(scene: &mut Scene) {
    scene.dot(at(32.0, 330.0), 6.5, Paint::Accent);
    scene.note(at(50.0, 330.0), Anchor::Start, Paint::Ink, "nearest: the hit");
    scene.ring(at(32.0, 360.0), 6.0, WARM);
    scene.note(at(50.0, 360.0), Anchor::Start, Paint::Ink, "farther: outside");
}
