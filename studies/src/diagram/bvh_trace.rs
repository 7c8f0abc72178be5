//! A ray inside a body that is not convex, and the boxes that it opens.

use super::plane::{Section, at, section};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3, Vec4Swizzles as _, vec3};
use lapidary_bvh_trace::traversal::{BVH_TRACE_FAR, BVH_TRACE_LEAF, trace};
use lapidary_bvh_trace::{
    BVH_TRACE_NONE, Bvh, BvhTraceExtent, BvhTraceHit, BvhTraceRay, bounds, r#box, child_box, ray, start, triangle,
};

pub const DIAGRAM: Diagram = Diagram {
    name: "bvh_trace",
    module: "bvh_trace",
    title: "A ray and the boxes of a hierarchy",
    caption: "Nested boxes hold the triangles of a body that is not convex, here a prism seen along its axis. The ray \
              opens only the boxes that it meets before its nearest hit, and tests only the triangles in them, drawn \
              thick. All others are skipped with their box.",
    draw,
};

/// Where the ray starts and where it goes.
pub const RAY: (Vec3, Vec3) = (vec3(-1.62, 0.2, 0.11), vec3(1.0, 0.17, 0.0));

/// Returns the outline of the body, counter-clockwise.
pub fn outline() -> Vec<DVec2> {
    let radius = |angle: f64| 1.0 + 0.3 * (2.0 * angle - 0.25).cos() - 0.42 * (3.0 * angle + 1.45).cos();
    let turns = (0..44).map(|k| f64::from(k) * std::f64::consts::TAU / 44.0);
    turns.map(|angle| radius(angle) * at(1.75 * angle.cos(), 1.08 * angle.sin())).collect()
}

/// Returns the hierarchy over the prism with that outline.
pub fn hierarchy() -> Bvh {
    let outline = outline();
    let count = outline.len() as u32;
    let ring = |z: f32| outline.iter().map(move |point| point.as_vec2().extend(z));
    let positions: Vec<Vec3> = ring(-0.5).chain(ring(0.5)).collect();
    let sides = (0..count).flat_map(|from| {
        let to = (from + 1) % count;
        [from, to, to + count, from, to + count, from + count]
    });
    Bvh::build(&positions, &sides.collect::<Vec<u32>>())
}

/// What a traversal does, in its order.
#[derive(Default)]
pub struct Visited {
    /// Boxes that are opened.
    pub opened: Vec<BvhTraceExtent>,
    /// Boxes that are passed by.
    pub passed: Vec<BvhTraceExtent>,
    /// Triangles that are tested.
    pub tested: Vec<u32>,
    /// The nearest hit.
    pub hit: Option<BvhTraceHit>,
}

/// Follows the ray through the hierarchy, the nearest box first, as `traversal::trace` does.
pub fn visit(bvh: &Bvh) -> Visited {
    let whole = bounds(bvh.nodes[0]);
    let ray = ray(RAY.0, RAY.1.normalize(), whole.lower, whole.upper);
    let mut visited = Visited { hit: Some(start(BVH_TRACE_FAR)), ..Visited::default() };
    open(bvh, ray, 0, &mut visited);
    visited
}

fn open(bvh: &Bvh, ray: BvhTraceRay, node: u32, visited: &mut Visited) {
    let node = bvh.nodes[node as usize];
    let nearest = |visited: &Visited| visited.hit.map_or(BVH_TRACE_FAR, |hit| hit.distance);
    let mut children: Vec<(f32, u32, BvhTraceExtent)> = Vec::new();
    for place in 0..4 {
        let (child, extent) = (node.children[place as usize], child_box(node, place));
        let met = r#box(ray, extent.lower, extent.upper, nearest(visited));
        match (child, met.hit) {
            (BVH_TRACE_NONE, _) => {}
            (_, false) => visited.passed.push(extent),
            (_, true) => children.push((met.entry, child, extent)),
        }
    }
    children.sort_by(|one, other| one.0.total_cmp(&other.0));
    for (_, child, extent) in children {
        visited.opened.push(extent);
        if child < BVH_TRACE_LEAF {
            open(bvh, ray, child, visited);
            continue;
        }
        let first = child & (BVH_TRACE_LEAF - 1);
        for number in first..first + (child >> 30) {
            let [a, b, c] = [0, 1, 2].map(|k| bvh.corners[3 * number as usize + k].xyz());
            visited.hit = visited.hit.map(|hit| triangle(hit, ray, a, b, c, number, BVH_TRACE_NONE));
            visited.tested.push(number);
        }
    }
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 420);
    let view = Section::new(356.0, 190.0, 130.0);
    let bvh = hierarchy();
    let visited = visit(&bvh);
    let rectangle = |extent: &BvhTraceExtent| {
        let (lower, upper) = (section(extent.lower), section(extent.upper));
        view.all(&[lower, at(upper.x, lower.y), upper, at(lower.x, upper.y)])
    };
    scene.area(&view.all(&outline()), Paint::Ink, 0.06);
    for extent in &visited.passed {
        scene.outline(&rectangle(extent), DIM.thin().dashed());
    }
    for extent in &visited.opened {
        let corners = rectangle(extent);
        scene.area(&corners, Paint::Accent, 0.1).outline(&corners, ACCENT.thin());
    }
    scene.outline(&view.all(&outline()), INK);
    for number in &visited.tested {
        let [a, b, c] = [0, 1, 2].map(|k| bvh.corners[3 * *number as usize + k].xyz());
        scene.line(&view.all(&[section(a), section(b), section(c)]), WARM.wide()).named("tested");
    }
    let hit = trace(&bvh.nodes, &bvh.corners, RAY.0, RAY.1.normalize(), BVH_TRACE_NONE);
    let end = RAY.0 + hit.distance * RAY.1.normalize();
    scene.arrow(&view.all(&[section(RAY.0), section(end)]), ACCENT.wide()).named("ray");
    scene.line(&view.all(&[section(end), section(RAY.0 + 3.4 * RAY.1.normalize())]), WARM.thin().dashed());
    scene.dot(view.at(section(RAY.0)), 5.0, Paint::Accent);
    scene.symbol(view.at(section(RAY.0)) + at(-18.0, -4.0), Anchor::Middle, Paint::Accent, "'o");
    let way = view.at(section(0.5 * (RAY.0 + end)));
    scene.symbol(way + at(4.0, 22.0), Anchor::Middle, Paint::Accent, "'d");
    let all = bvh.order.len();
    let count = format!("{} of {all} triangles tested", visited.tested.len());
    scene.cell(at(366.0, 387.0), at(390.0, 409.0), Paint::Accent, 0.2);
    scene.note(at(400.0, 398.0), Anchor::Start, Paint::Ink, "opened");
    scene.outline(&[at(520.0, 387.0), at(544.0, 387.0), at(544.0, 409.0), at(520.0, 409.0)], DIM.thin().dashed());
    scene.note(at(554.0, 398.0), Anchor::Start, Paint::Ink, "passed by");
    scene.line(&[at(24.0, 398.0), at(54.0, 398.0)], WARM.wide());
    scene.note(at(64.0, 398.0), Anchor::Start, Paint::Ink, &count);
    scene
}
