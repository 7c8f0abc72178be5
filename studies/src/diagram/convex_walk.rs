//! A walk over the map of a brilliant's facets.

use super::plane::{Section, at};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, DVec3, DVec4, Vec3, Vec4, Vec4Swizzles as _};
use lapidary_convex_trace::{ConvexTraceHit, step};
use lapidary_convex_walk::{FacetMap, exit, facet_corners, square};
use lapidary_scene::cuts::{BrilliantParameters, round_brilliant};

pub const DIAGRAM: Diagram = Diagram {
    name: "convex_walk",
    module: "convex_walk",
    title: "A walk over the map of a stone's facets",
    caption: "Left, a brilliant cut along its axis, with a ray inside. Right, the map: all directions from O, \
              unfolded into a square, with the facets that are seen there. The walk starts where the ray leaves the \
              box, asks the cell in whose direction that point lies for its facets, goes back to the nearest of their \
              planes, and asks again, until nothing is nearer.",
    draw,
};

/// Cells along a side of the map.
const SIDE: u32 = 20;
/// A cell on the sheet.
const CELL: f64 = 15.5;
/// The map's upper left corner.
const CORNER: DVec2 = at(404.0, 52.0);
/// The angle by which the cut is turned about the axis.
const TURN: f64 = 0.33;
/// Where the ray starts in the cut, and its direction.
pub const RAY: (DVec2, DVec2) = (at(-0.8, -0.1), at(0.6055, -0.7958));

/// Returns the planes of the stone, z up.
pub fn planes() -> Vec<Vec4> {
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY).map(|stone| stone.planes().to_vec());
    let stone = stone.unwrap_or_else(|error| panic!("Tolkowsky's proportions: {error}"));
    stone.iter().map(|plane| plane.normal.as_vec3().extend(plane.distance as f32)).collect()
}

/// A point of the cut in space.
fn space(point: DVec2) -> Vec3 {
    DVec3::new(point.x * TURN.cos(), point.x * TURN.sin(), point.y).as_vec3()
}

/// A point of space in the cut.
fn cut(point: Vec3) -> DVec2 {
    let point = point.as_dvec3();
    at(point.x * TURN.cos() + point.y * TURN.sin(), point.z)
}

/// A walk: the ray, and the distances at which it stands, from the box on.
pub struct Walk {
    /// Where the ray starts.
    pub origin: Vec3,
    /// Its direction.
    pub direction: Vec3,
    /// The distances.
    pub distances: Vec<f32>,
    /// The facet it ends at.
    pub face: u32,
}

/// Walks as the recipes do: the least distance over the candidates of a cell, until nothing is nearer.
pub fn walk(map: &FacetMap, planes: &[Vec4], ray: (DVec2, DVec2)) -> Walk {
    let (origin, direction) = (space(ray.0), space(ray.1).normalize());
    let mut hit = ConvexTraceHit { distance: exit(origin, direction, map.lower, map.upper), face: u32::MAX };
    let mut distances = vec![hit.distance];
    loop {
        let candidates = map.candidates(origin + hit.distance * direction);
        let nearer =
            candidates.fold(hit, |hit, face| step(hit, origin, direction, planes[face as usize], face, u32::MAX));
        if nearer == hit {
            return Walk { origin, direction, distances, face: hit.face };
        }
        hit = nearer;
        distances.push(hit.distance);
    }
}

/// Returns the outline of the cut, counter-clockwise: the half-planes' intersection.
fn outline(planes: &[Vec4]) -> Vec<DVec2> {
    let mut corners = vec![at(-2.0, -2.0), at(2.0, -2.0), at(2.0, 2.0), at(-2.0, 2.0)];
    for plane in planes {
        let (normal, distance) = (cut(plane.xyz()), f64::from(plane.w));
        let height = |point: DVec2| normal.dot(point) - distance;
        let mut left = Vec::new();
        for (index, from) in corners.iter().enumerate() {
            let to = corners[(index + 1) % corners.len()];
            let (start, end) = (height(*from), height(to));
            if start <= 0.0 {
                left.push(*from);
            }
            if start.min(end) < 0.0 && start.max(end) > 0.0 {
                left.push(from.lerp(to, start / (start - end)));
            }
        }
        corners = left;
    }
    corners
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 384);
    let planes = planes();
    let map = FacetMap::of_planes(&planes, SIDE).unwrap_or_else(|error| panic!("a brilliant's map: {error}"));
    let walk = walk(&map, &planes, RAY);
    stone(&mut scene, &planes, &map, &walk);
    cells(&mut scene, &planes, &walk);
    scene
}

/// The cut, the box and the ray.
fn stone(scene: &mut Scene, planes: &[Vec4], map: &FacetMap, walk: &Walk) {
    let view = Section::new(188.0, 176.0, 160.0);
    let outline = view.all(&outline(planes));
    scene.area(&outline, Paint::Accent, 0.12).outline(&outline, INK);
    let wide = (f64::from(map.upper.x) / TURN.cos()).min(f64::from(map.upper.y) / TURN.sin());
    let (low, high) = (f64::from(map.lower.z), f64::from(map.upper.z));
    let corners = [at(-wide, low), at(wide, low), at(wide, high), at(-wide, high)];
    scene.outline(&view.all(&corners), DIM.thin().dashed());
    let points: Vec<DVec2> = walk.distances.iter().map(|t| cut(walk.origin + *t * walk.direction)).collect();
    let end = points[points.len() - 1];
    scene.line(&view.all(&[points[0], end]), WARM.thin().dashed());
    for point in &points {
        scene.line(&view.all(&[DVec2::ZERO, *point]), DIM.thin());
    }
    scene.arrow(&view.all(&[cut(walk.origin), end]), ACCENT).named("ray");
    scene.dot(view.at(DVec2::ZERO), 4.5, Paint::Ink);
    scene.symbol(view.at(DVec2::ZERO) + at(0.0, -18.0), Anchor::Middle, Paint::Ink, "O");
    scene.symbol(view.at(cut(walk.origin)) + at(20.0, -10.0), Anchor::Middle, Paint::Accent, "'x");
    for (k, point) in points.iter().enumerate() {
        let last = k + 1 == points.len();
        scene.dot(view.at(*point), 5.5, if last { Paint::Accent } else { Paint::Warm });
        let aside = [at(22.0, 10.0), at(-16.0, 27.0), at(-28.0, 5.0)][k.min(2)];
        let paint = if last { Paint::Accent } else { Paint::Warm };
        scene.symbol(view.at(*point) + aside, Anchor::Middle, paint, &format!("t_{k}"));
    }
}

/// Where a place of the square lies on the sheet.
fn on_map(square: DVec2) -> DVec2 {
    CORNER + 0.5 * f64::from(SIDE) * CELL * at(1.0 + square.x, 1.0 - square.y)
}

/// The map, and the walk on it.
fn cells(scene: &mut Scene, planes: &[Vec4], walk: &Walk) {
    let points = walk.distances.iter().map(|t| square(walk.origin + *t * walk.direction));
    let points: Vec<DVec2> = points.map(|point| point.as_dvec2()).collect();
    for point in &points {
        let corner = (*point * 0.5 * f64::from(SIDE)).floor() * 2.0 / f64::from(SIDE);
        scene.cell(on_map(corner), on_map(corner + 2.0 / f64::from(SIDE)), Paint::Warm, 0.35);
    }
    let wide = f64::from(SIDE) * CELL;
    for k in 0..=SIDE {
        let along = f64::from(k) * CELL;
        scene.line(&[CORNER + at(along, 0.0), CORNER + at(along, wide)], DIM.thin());
        scene.line(&[CORNER + at(0.0, along), CORNER + at(wide, along)], DIM.thin());
    }
    let found = pieces(&rim(planes, walk.face));
    for piece in &found {
        scene.area(piece, Paint::Accent, 0.4).named("found");
    }
    for edge in edges(planes) {
        scene.line(&edge, INK);
    }
    let points: Vec<DVec2> = points.into_iter().map(on_map).collect();
    scene.line(&points, WARM);
    for (k, point) in points.iter().enumerate() {
        let paint = if k + 1 == points.len() { Paint::Accent } else { Paint::Warm };
        scene.dot(*point, 4.5, paint).named("place");
        // The last two places are close together.
        let beside = at(CORNER.x - 20.0, point.y + [0.0, 14.0, -8.0][k.min(2)]);
        scene.symbol(beside, Anchor::Middle, paint, &format!("t_{k}"));
    }
    scene.note(CORNER + at(150.0, -26.0), Anchor::Middle, Paint::Ink, "facets by direction");
}

/// Returns the rim of a facet on the square, closed.
fn rim(planes: &[Vec4], face: u32) -> Vec<DVec2> {
    let planes: Vec<DVec4> = planes.iter().map(|plane| plane.as_dvec4()).collect();
    let corners = facet_corners(&planes, face as usize);
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let places = sides.flat_map(|(from, to)| (0..=10).map(|k| from.lerp(*to, f64::from(k) / 10.0)));
    places.map(|place| square(place.as_vec3()).as_dvec2()).collect()
}

/// Returns the facets' edges on the map, each once, cut where the square's rim cuts them.
fn edges(planes: &[Vec4]) -> Vec<Vec<DVec2>> {
    let planes: Vec<DVec4> = planes.iter().map(|plane| plane.as_dvec4()).collect();
    let mut edges = Vec::new();
    for face in 0..planes.len() {
        let corners = facet_corners(&planes, face);
        for (index, from) in corners.iter().enumerate() {
            let to = corners[(index + 1) % corners.len()];
            // The facet on the other side has the same edge, the other way round.
            if (from.x, from.y, from.z) > (to.x, to.y, to.z) {
                continue;
            }
            let places = (0..=10).map(|k| square(from.lerp(to, f64::from(k) / 10.0).as_vec3()).as_dvec2());
            edges.extend(pieces(&places.collect::<Vec<DVec2>>()));
        }
    }
    edges
}

/// Cuts a line where it leaves the square on one side and comes back on another.
fn pieces(places: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut pieces = vec![Vec::new()];
    for (k, place) in places.iter().enumerate() {
        if k > 0 && place.distance(places[k - 1]) > 0.5 {
            pieces.push(Vec::new());
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(on_map(*place));
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}
