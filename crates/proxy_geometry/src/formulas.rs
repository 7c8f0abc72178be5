//! Test inputs, edges, invariants and hard cases of `wgsl/proxy_geometry.wgsl`.

mod outside;

use crate::{
    self as mirror, PROXY_GEOMETRY_PARALLEL, ProxyGeometryCell, ProxyGeometryFacet, ProxyGeometryHit,
    ProxyGeometryPlane, oracle,
};
use glam::{DVec3, IVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, ProxyGeometryPlane { origin, edge_first, edge_second });
mirror_struct!(crate, ProxyGeometryHit { point, distance, hit });
mirror_struct!(crate, ProxyGeometryCell { steps, turned });
mirror_struct!(crate, ProxyGeometryFacet { vertex_first, vertex_second, vertex_third });

const M: &str = "proxy_geometry";

/// Error of a unit vector's length: the sum of three squares and the rounding of the inputs, 2⁻²⁴
/// each.
const UNIT: f64 = 16.0 / (1 << 24) as f64;

/// Draws the scale of a model: 1 in half of the cases, otherwise any magnitude in which positions
/// and their sums stay finite.
fn size(draws: &mut Draws<'_>, low: i32, high: i32) -> f32 {
    if draws.below(2) == 0 { 1.0 } else { draws.magnitude(low, high) }
}

/// Draws a position around the origin, of every size.
fn position(draws: &mut Draws<'_>) -> Vec3 {
    size(draws, -110, 119) * draws.in_cube()
}

/// Draws two edges from one vertex: any angle with a sine down to 2^`thinnest`, lengths up to a
/// factor of 2^`ratio` apart, sometimes along the axes.
fn edges(draws: &mut Draws<'_>, thinnest: i32, ratio: i32) -> (DVec3, DVec3) {
    let first = draws.unit_vector().as_dvec3().normalize();
    let across = draws.perpendicular(first);
    let sine = match draws.below(3) {
        0 => f64::from(draws.magnitude(thinnest, -1)),
        _ => f64::from(draws.between(0.3, 1.0)),
    };
    let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt() * if draws.below(2) == 0 { 1.0 } else { -1.0 };
    let length = if draws.below(3) == 0 { f64::from(draws.magnitude(-ratio, ratio)) } else { 1.0 };
    (first, length * (cosine * first + sine * across))
}

/// Draws a triangle of any size, thin or fat, not degenerate.
fn triangle(draws: &mut Draws<'_>) -> [Vec3; 3] {
    let size = f64::from(size(draws, -95, 95));
    let (first, second) = edges(draws, -19, 6);
    let corner = if draws.below(2) == 0 { DVec3::ZERO } else { draws.in_cube().as_dvec3() };
    let triangle_at = |corner: DVec3| [corner, corner + first, corner + second].map(|vertex| (size * vertex).as_vec3());
    // Away from the origin, rounding of the positions can turn a thin triangle about its long side,
    // or flatten it. Such a triangle is kept if it turns by less than a hundredth of a radian.
    let shifted = triangle_at(corner);
    let farthest = shifted.map(|vertex| f64::from(vertex.abs().max_element())).into_iter().fold(0.0, f64::max);
    let shortest = shifted[0]
        .as_dvec3()
        .distance(shifted[1].as_dvec3())
        .min(shifted[0].as_dvec3().distance(shifted[2].as_dvec3()));
    let turn = f64::from(f32::EPSILON) * farthest / (shortest * thinness(shifted));
    if turn < 0.01 { shifted } else { triangle_at(DVec3::ZERO) }
}

/// Draws a triangle with two corners close together and near the origin, and one far from both, in
/// any order. The rounding of the two long edges is far larger than the short edge.
fn far_corner(draws: &mut Draws<'_>) -> [Vec3; 3] {
    let size = size(draws, -60, 60);
    let close = size * draws.magnitude(-30, -2);
    let (first, second) = (draws.unit_vector(), draws.unit_vector());
    let far = if draws.below(2) == 0 { draws.in_cube() } else { draws.direction().as_vec3() };
    let turn = draws.below(3) as usize;
    let mut triangle = [size * far, close * first, close * draws.between(0.0, 1.0) * second];
    triangle.rotate_right(turn);
    // If the short edge points at the far corner or has length 0, the triangle is too thin.
    if widest_sine(triangle) > 2e-6 { triangle } else { [Vec3::ZERO, Vec3::X * size, Vec3::Y * size] }
}

/// Returns the sine of the angle between the two shortest edges, in f64.
fn widest_sine([a, b, c]: [Vec3; 3]) -> f64 {
    let sines = [[a, b, c], [b, c, a], [c, a, b]].map(|[corner, next, last]| {
        let opposite = next.as_dvec3().distance(last.as_dvec3());
        (opposite, thinness([corner, next, last]))
    });
    let [(_, sine), ..] = {
        let mut sorted = sines;
        sorted.sort_by(|one, other| other.0.total_cmp(&one.0));
        sorted
    };
    sine
}

/// Returns the shortest edge over the largest coordinate.
fn closeness([a, b, c]: [Vec3; 3]) -> f64 {
    let shortest = [(a, b), (b, c), (c, a)].map(|(one, other)| one.as_dvec3().distance(other.as_dvec3()));
    let farthest = [a, b, c].map(|corner| f64::from(corner.abs().max_element())).into_iter().fold(0.0, f64::max);
    shortest.into_iter().fold(f64::INFINITY, f64::min) / farthest
}

/// Returns the largest tilt of a triangle's plane if each component of its corners is off by `ulps`
/// of the corner's largest component: the sum of each corner's movement over its height above the
/// opposite edge.
fn tilt(corners: [Vec3; 3], ulps: f64) -> f64 {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let doubled_area = (b - a).cross(c - a).length();
    let of_corner = |corner: DVec3, from: DVec3, to: DVec3| {
        let moved = 3f64.sqrt() * ulps * 2f64.powi(-23) * corner.abs().max_element();
        moved * from.distance(to) / doubled_area
    };
    if doubled_area == 0.0 { f64::INFINITY } else { of_corner(a, b, c) + of_corner(b, c, a) + of_corner(c, a, b) }
}

/// Returns the sine of the angle at the first vertex, in f64.
fn thinness([first, second, third]: [Vec3; 3]) -> f64 {
    let [a, b, c] = [first, second, third].map(|vertex| vertex.as_dvec3());
    (b - a).cross(c - a).length() / ((b - a).length() * (c - a).length())
}

/// Draws a lattice and a point in its plane, up to a hundred cells away. In half of the cases the
/// point is on an edge or a vertex, except for thin lattices, in which its own rounding moves it by
/// more than the width of a cell.
fn lattice_point(draws: &mut Draws<'_>) -> (ProxyGeometryPlane, Vec3) {
    let size = f64::from(size(draws, -90, 90));
    let (first, second) = edges(draws, -9, 3);
    let thin = first.cross(second).length() < 0.1 * second.length();
    let origin = if draws.below(2) == 0 { DVec3::ZERO } else { draws.in_cube().as_dvec3() };
    let plane = ProxyGeometryPlane {
        origin: (size * origin).as_vec3(),
        edge_first: (size * first).as_vec3(),
        edge_second: (size * second).as_vec3(),
    };
    let cell = |draws: &mut Draws<'_>| match draws.below(3) {
        0 => f64::from(draws.below(201)) - 100.0,
        _ => f64::from(draws.below(5)) - 2.0,
    };
    let whole = (cell(draws), cell(draws));
    let within = match draws.below(6) {
        0 if !thin => (0.0, 0.0),
        1 if !thin => (f64::from(draws.between(0.0, 1.0)), 0.0),
        2 if !thin => {
            let along = f64::from(draws.between(0.0, 1.0));
            (along, 1.0 - along)
        }
        _ => (f64::from(draws.between(0.0, 1.0)), f64::from(draws.between(0.0, 1.0))),
    };
    let point = plane.origin.as_dvec3()
        + (whole.0 + within.0) * plane.edge_first.as_dvec3()
        + (whole.1 + within.1) * plane.edge_second.as_dvec3();
    (plane, point.as_vec3())
}

/// Draws a ray and a plane: ahead, behind, through the start, parallel, and at the limit of
/// parallel.
fn ray_and_plane(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3) {
    let size = size(draws, -60, 60);
    let normal = draws.unit_vector();
    let axis = normal.as_dvec3().normalize();
    let tangent = draws.perpendicular(axis);
    let slope = match draws.below(6) {
        0 => f64::from(draws.magnitude(-30, -1)),
        1 => f64::from(PROXY_GEOMETRY_PARALLEL) * f64::from(draws.between(0.9, 1.1)),
        2 => draws.pick(&[0.0, 1.0, f64::from(PROXY_GEOMETRY_PARALLEL)]),
        _ => f64::from(draws.between(0.0, 1.0)),
    };
    let slope = if draws.below(2) == 0 { slope } else { -slope };
    let direction = (((1.0 - slope) * (1.0 + slope)).max(0.0).sqrt() * tangent + slope * axis).as_vec3();
    let position = if draws.below(2) == 0 { Vec3::ZERO } else { size * draws.in_cube() };
    let plane_point = match draws.below(6) {
        0 => position,
        1 => (position.as_dvec3() + f64::from(size) * tangent).as_vec3(),
        _ => size * draws.in_cube(),
    };
    (position, direction, plane_point, normal)
}

/// Draws a stone's centre, a tile and the ray that meets it.
fn tile_and_ray(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3, Vec3) {
    let [first, second, third] = triangle(draws);
    let centroid = (first.as_dvec3() + second.as_dvec3() + third.as_dvec3()) / 3.0;
    let extent = [second - first, third - first, first]
        .map(|v| f64::from(v.abs().max_element()))
        .into_iter()
        .fold(0.0, f64::max);
    let away = if draws.below(4) == 0 { f64::from(draws.magnitude(-10, 0)) } else { 1.0 };
    let centre = (centroid + extent * away * draws.direction()).as_vec3();
    (centre, first, second, third, draws.unit_vector())
}

/// Draws a tile of ordinary size, for which the squares of the usual form stay in range.
fn ordinary_tile(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3) {
    let vertex = |draws: &mut Draws<'_>| draws.in_cube();
    let tile = (vertex(draws), vertex(draws), vertex(draws));
    let centre = (tile.0 + tile.1 + tile.2) / 3.0 + draws.direction().as_vec3() * draws.between(0.5, 2.0);
    (centre, tile.0, tile.1, tile.2)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [plane_formulas(), normal_formulas(), intersection_formulas(), lattice_formulas()].into_iter().flatten().collect()
}

fn plane_formulas() -> Vec<Formula> {
    let facet = |draws: &mut Draws<'_>| {
        let [vertex_first, vertex_second, vertex_third] = triangle(draws);
        ProxyGeometryFacet { vertex_first, vertex_second, vertex_third }
    };
    vec![
        formula(M, "proxy_geometry_image", mirror::image, oracle::image, |draws| (position(draws), position(draws)))
            .edge("centre far outside the stone", |(centre, x)| centre.length() > 1e3 * x.length())
            .pair(
                "the image of the image is the point",
                |(centre, x)| (centre, 2.0 * centre - x),
                |(centre, x), _, back: Vec3| {
                    let scale = centre.as_dvec3().length() + x.as_dvec3().length();
                    near("distance", back.as_dvec3().distance(x.as_dvec3()), 0.0, scale * UNIT)
                },
            )
            .build(),
        formula(M, "proxy_geometry_plane", mirror::plane, oracle::plane, |draws| {
            let [a, b, c] = triangle(draws);
            (draws.in_cube() * a.abs().max_element().max(b.abs().max_element()), a, b, c)
        })
        .edge("counter-clockwise from above", |(_, a, b, c)| (b - a).normalize_or_zero().cross(c - a).z > 0.0)
        .edge("clockwise from above", |(_, a, b, c)| (b - a).normalize_or_zero().cross(c - a).z < 0.0)
        // Paper, 4.2: coplanar neighbours whose centres are equal continue each other's pattern.
        .pair(
            "coplanar neighbours with an equal centre share plane P and the image of their edge",
            |(centre, a, b, c)| (centre, b, c, b + (c - a)),
            |(centre, a, b, c), plane: ProxyGeometryPlane, neighbour: ProxyGeometryPlane| {
                let scale = [centre, a, b, c].map(|v| v.as_dvec3().length()).into_iter().fold(0.0, f64::max);
                let [origin, first, second] = [plane.origin, plane.edge_first, plane.edge_second].map(Vec3::as_dvec3);
                let edge = neighbour.origin.as_dvec3() - (origin + first);
                near("image of b", edge.length(), 0.0, scale * UNIT)?;
                let other = neighbour.origin.as_dvec3() + neighbour.edge_first.as_dvec3() - (origin + second);
                near("image of c", other.length(), 0.0, scale * UNIT)?;
                let normal = first.normalize().cross(second.normalize());
                let height = (neighbour.origin.as_dvec3() + neighbour.edge_second.as_dvec3() - origin).dot(normal);
                near("height of the neighbour over plane P", height, 0.0, scale * UNIT)
            },
        )
        .build(),
        formula(M, "proxy_geometry_next_plane", mirror::next_plane, oracle::next_plane, move |draws| {
            let facet = facet(draws);
            (draws.in_cube() * facet.vertex_first.abs().max_element(), facet)
        })
        .edge("size below 1e-20", |(_, facet)| {
            facet.vertex_first.abs().max(facet.vertex_second.abs()).max_element() < 1e-20
        })
        .build(),
    ]
}

/// Computes the straightforward form of the normal of a triangle whose edges are exact in f64.
fn far_normal(a: Vec3, b: Vec3, c: Vec3) -> [f64; 3] {
    let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
    (b - a).cross(c - a).normalize().to_array()
}

fn normal_formulas() -> Vec<Formula> {
    let huge = 1e19f32;
    let tiny = 1e-20f32;
    let ray = Vec3::NEG_Z;
    let scaled = |size: f32| (Vec3::ZERO, Vec3::X * size, Vec3::Y * size);
    let tile = |size: f32| (Vec3::Z * size, Vec3::X * size, Vec3::NEG_X * size, Vec3::ZERO, ray);
    vec![
        formula(M, "proxy_geometry_face_normal", mirror::face_normal, oracle::face_normal, |draws| {
            let [a, b, c] = if draws.below(4) == 0 { far_corner(draws) } else { triangle(draws) };
            match draws.below(16) {
                0 => (a, a, c),
                1 => (a, b, a),
                2 => (a, a, a),
                3 => (Vec3::ZERO, b - a, b - a),
                _ => (a, b, c),
            }
        })
        .edge("a sliver", |(a, b, c)| (1e-6..1e-4).contains(&widest_sine([a, b, c])))
        .edge("two equal corners", |(a, b, c)| a == b && b != c)
        .edge("the first corner far from two that are close together", |(a, b, c)| {
            (1e-9..1e-6).contains(&closeness([a, b, c])) && b.distance(c) < 1e-3 * b.distance(a)
        })
        .edge("the second corner far from two that are close together", |(a, b, c)| {
            (1e-9..1e-6).contains(&closeness([a, b, c])) && c.distance(a) < 1e-3 * b.distance(a)
        })
        .edge("three equal corners", |(a, b, c)| a == b && b == c)
        .edge("size below 1e-20", |(a, b, c)| a.distance(b).max(a.distance(c)) < 1e-20 && thinness([a, b, c]) > 1e-3)
        .edge("size above 1e19", |(a, b, c)| (b - a).abs().max_element() > 1e19 && thinness([a, b, c]) > 1e-3)
        .invariant("unit length, or zero", |_, normal: Vec3| {
            if normal == Vec3::ZERO { Ok(()) } else { near("length", normal.as_dvec3().length(), 1.0, UNIT) }
        })
        .pair(
            "the other winding turns it round",
            |(a, b, c)| (a, c, b),
            // If the two longest edges are equally long, either may be left out. Each normal then
            // has its own rounding errors: 6 ulp of each corner by the accuracy line, in addition
            // to the error of its length.
            |(a, b, c), normal: Vec3, other: Vec3| {
                let mut sizes = [a - b, b - c, c - a].map(|edge| edge.abs().max_element());
                sizes.sort_by(f32::total_cmp);
                let tilt = if sizes[1] == sizes[2] { tilt([a, b, c], 6.0) } else { 0.0 };
                near("sum", (normal + other).as_dvec3().length(), 0.0, 2.0 * (UNIT + tilt))
            },
        )
        .hard_case(
            "edges of 1e-20",
            scaled(tiny),
            (&[0.0, 0.0, 1.0], 1e-6),
            ("proxy_geometry_face_normal_naive", f64::INFINITY),
        )
        .hard_case("edges of 1e19", scaled(huge), (&[0.0, 0.0, 1.0], 1e-6), ("proxy_geometry_face_normal_naive", 0.9))
        .hard_case(
            "the first corner far from two that are close together",
            (Vec3::new(1.0, 1.0, 1.0), Vec3::new(2e-8, 0.0, 0.0), Vec3::new(0.0, 3e-8, 0.0)),
            (&far_normal(Vec3::new(1.0, 1.0, 1.0), Vec3::new(2e-8, 0.0, 0.0), Vec3::new(0.0, 3e-8, 0.0)), 1e-6),
            ("proxy_geometry_face_normal_naive", 0.1),
        )
        .hard_case(
            "two equal corners",
            (Vec3::X, Vec3::X, Vec3::Y),
            (&[0.0, 0.0, 0.0], 0.0),
            ("proxy_geometry_face_normal_naive", f64::INFINITY),
        )
        .hard_case(
            "three corners in a line",
            (Vec3::ZERO, Vec3::new(1.0, 2.0, 4.0), Vec3::new(2.0, 4.0, 8.0)),
            (&[0.0, 0.0, 0.0], 0.0),
            ("proxy_geometry_face_normal_naive", f64::INFINITY),
        )
        .hard_case(
            "three equal corners",
            (Vec3::X, Vec3::X, Vec3::X),
            (&[0.0, 0.0, 0.0], 0.0),
            ("proxy_geometry_face_normal_naive", f64::INFINITY),
        )
        .build(),
        formula(M, "proxy_geometry_face_normal_naive", mirror::face_normal_naive, oracle::face_normal, |draws| {
            let (first, second) = edges(draws, -3, 2);
            let corner = draws.in_cube();
            (corner, corner + first.as_vec3(), corner + second.as_vec3())
        })
        .benign(1e-4)
        .build(),
        formula(M, "proxy_geometry_facet_normal", mirror::facet_normal, oracle::facet_normal, |draws| {
            let (centre, a, b, c, direction) = tile_and_ray(draws);
            if draws.below(16) == 0 {
                // Three times the same vertex: the only centroid that is exact in every rounding.
                (Vec3::X, Vec3::X, Vec3::X, Vec3::X, direction)
            } else {
                (centre, a, b, c, direction)
            }
        })
        .edge("centre on the tile's centroid", |(centre, a, b, c, _)| centre == a && a == b && b == c)
        .edge("seen from behind", |(centre, a, _, _, direction)| (centre - a).dot(direction) > 0.0)
        .edge("seen from the centre", |(centre, a, _, _, direction)| (centre - a).dot(direction) < 0.0)
        .edge("size below 1e-20", |(centre, a, _, _, _)| centre.distance(a) < 1e-20 && centre != a)
        .edge("size above 1e19", |(centre, a, _, _, _)| (centre - a).abs().max_element() > 1e19)
        .invariant("unit length", |_, normal: Vec3| near("length", normal.as_dvec3().length(), 1.0, UNIT))
        .invariant("faces the ray", |(_, _, _, _, direction), normal: Vec3| {
            near("cosine", normal.as_dvec3().dot(direction.as_dvec3()).max(0.0), 0.0, UNIT)
        })
        .hard_case_with(
            "a stone of size 1e-25",
            tile(1e-25),
            (&[0.0, 0.0, 1.0], 1e-6),
            (
                "proxy_geometry_facet_normal_naive",
                (tile(1e-25).0, tile(1e-25).1, tile(1e-25).2, tile(1e-25).3),
                f64::INFINITY,
            ),
        )
        .hard_case_with(
            "a stone of size 1e20",
            tile(1e20),
            (&[0.0, 0.0, 1.0], 1e-6),
            ("proxy_geometry_facet_normal_naive", (tile(1e20).0, tile(1e20).1, tile(1e20).2, tile(1e20).3), 0.9),
        )
        .hard_case_with(
            "h = 0: the centre on the tile's centroid",
            (Vec3::X, Vec3::X, Vec3::X, Vec3::X, ray),
            (&[0.0, 0.0, 1.0], 0.0),
            ("proxy_geometry_facet_normal_naive", (Vec3::X, Vec3::X, Vec3::X, Vec3::X), f64::INFINITY),
        )
        .build(),
        formula(
            M,
            "proxy_geometry_facet_normal_naive",
            mirror::facet_normal_naive,
            oracle::facet_normal_naive,
            ordinary_tile,
        )
        .benign(1e-5)
        .build(),
    ]
}

fn intersection_formulas() -> Vec<Formula> {
    let parallel = (Vec3::ZERO, Vec3::X, Vec3::NEG_Z, Vec3::Z);
    let behind = (Vec3::ZERO, Vec3::NEG_Z, Vec3::Z, Vec3::Z);
    vec![
        formula(M, "proxy_geometry_intersect", mirror::intersect, oracle::intersect, ray_and_plane)
            .edge("plane ahead", |(x, r, p, n)| (p - x).dot(n) * r.dot(n) > 0.0)
            .edge("plane behind (h < 0)", |(x, r, p, n)| (p - x).dot(n) * r.dot(n) < 0.0)
            .edge("start in the plane (h = 0)", |(x, _, p, _)| x == p)
            .edge("exactly parallel", |(_, r, _, n)| r.dot(n) == 0.0)
            .edge("just counted as parallel", |(_, r, _, n)| {
                let limit = PROXY_GEOMETRY_PARALLEL;
                (0.98 * limit..=limit).contains(&r.dot(n).abs())
            })
            .edge("just not counted as parallel", |(_, r, _, n)| {
                let limit = PROXY_GEOMETRY_PARALLEL;
                (limit.next_up()..1.015 * limit).contains(&r.dot(n).abs())
            })
            .invariant("a miss stays where it is", |(x, ..), hit: ProxyGeometryHit| {
                if hit.hit || (hit.point == x && hit.distance == 0.0) { Ok(()) } else { Err(format!("{hit:?}")) }
            })
            .invariant(
                "a hit is ahead",
                |_, hit: ProxyGeometryHit| {
                    if !hit.hit || hit.distance > 0.0 { Ok(()) } else { Err(format!("{hit:?}")) }
                },
            )
            .hard_case(
                "plane P parallel to the ray",
                parallel,
                (&[0.0, 0.0, 0.0, 0.0, 0.0], 0.0),
                ("proxy_geometry_intersect_naive", f64::INFINITY),
            )
            .hard_case(
                "h < 0: the plane behind the ray",
                behind,
                (&[0.0, 0.0, 0.0, 0.0, 0.0], 0.0),
                ("proxy_geometry_intersect_naive", 1.0),
            )
            .hard_case(
                "h = 0: the plane through the ray's start",
                (Vec3::ZERO, Vec3::NEG_Z, Vec3::X, Vec3::Z),
                (&[0.0, 0.0, 0.0, 0.0, 0.0], 0.0),
                ("proxy_geometry_intersect_naive", 1.0),
            )
            .hard_case(
                "h = 0, parallel: the ray in the plane",
                (Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z),
                (&[0.0, 0.0, 0.0, 0.0, 0.0], 0.0),
                ("proxy_geometry_intersect_naive", f64::INFINITY),
            )
            .build(),
        formula(M, "proxy_geometry_intersect_naive", mirror::intersect_naive, oracle::intersect, |draws| {
            let direction = draws.direction();
            let normal = draws.direction();
            let normal = if normal.dot(direction).abs() < 0.2 { direction } else { normal };
            let ahead = f64::from(draws.between(0.5, 2.0));
            let position = draws.in_cube();
            let plane_point = position.as_dvec3() + ahead * direction;
            (position, direction.as_vec3(), plane_point.as_vec3(), normal.as_vec3())
        })
        .benign(3e-5)
        .build(),
    ]
}

fn lattice_formulas() -> Vec<Formula> {
    // A sliver with edges (1, 0, 0) and (1, 0.002, 0), and the point at coordinates (3, -2.5).
    let thin = 0.002f32;
    let sliver = (Vec3::new(0.5, -2.5 * thin, 0.0), Vec3::ZERO, Vec3::X, Vec3::new(1.0, thin, 0.0));
    let huge = 1e19f32;
    let tiny = 1e-20f32;
    let square = |size: f32| (Vec3::new(0.25, 0.5, 0.0) * size, Vec3::ZERO, Vec3::X * size, Vec3::Y * size);
    vec![
        formula(M, "proxy_geometry_coordinates", mirror::coordinates, oracle::coordinates, |draws| {
            let (plane, point) = lattice_point(draws);
            match draws.below(16) {
                0 => (point, plane.origin, Vec3::ZERO, Vec3::ZERO),
                1 => (point, plane.origin, plane.edge_first, plane.edge_first),
                // Degenerate under every rounding of the input.
                3 => (point, plane.origin, plane.edge_first, Vec3::ZERO),
                2 => {
                    // Near the limit of degenerate triangles, |e1 × e2| = 2⁻¹⁸.
                    let thin = 2f32.powi(-18) * draws.between(0.95, 1.05);
                    (Vec3::new(0.5, 0.25 * thin, 0.0), Vec3::ZERO, Vec3::X, Vec3::new(0.0, thin, 0.0))
                }
                _ => (point, plane.origin, plane.edge_first, plane.edge_second),
            }
        })
        .edge("no triangle at all", |(_, _, e1, e2)| e1 == Vec3::ZERO && e2 == Vec3::ZERO)
        .edge("parallel edges", |(_, _, e1, e2)| e1 == e2 && e1 != Vec3::ZERO)
        .edge("one edge zero", |(_, _, e1, e2)| e1 != Vec3::ZERO && e2 == Vec3::ZERO)
        .edge("just degenerate", |(_, _, e1, e2)| (0.99..1.0).contains(&(e1.cross(e2).length() * 2f32.powi(18))))
        .edge("just not degenerate", |(_, _, e1, e2)| (1.0..1.007).contains(&(e1.cross(e2).length() * 2f32.powi(18))))
        .edge("size below 1e-20", |(_, _, e1, e2)| e1.length().max(e2.length()) < 1e-20 && e1 != e2)
        .edge("size above 1e19", |(_, _, e1, e2)| e1.abs().max(e2.abs()).max_element() > 1e19)
        .hard_case("a sliver of sine 1/500", sliver, (&[3.0, -2.5], 1e-5), ("proxy_geometry_coordinates_naive", 1e-2))
        .hard_case(
            "edges of 1e-20",
            square(tiny),
            (&[0.25, 0.5], 1e-6),
            ("proxy_geometry_coordinates_naive", f64::INFINITY),
        )
        .hard_case(
            "edges of 1e19",
            square(huge),
            (&[0.25, 0.5], 1e-6),
            ("proxy_geometry_coordinates_naive", f64::INFINITY),
        )
        .hard_case(
            "parallel edges",
            (Vec3::X, Vec3::ZERO, Vec3::X, Vec3::X),
            (&[0.0, 0.0], 0.0),
            ("proxy_geometry_coordinates_naive", f64::INFINITY),
        )
        .build(),
        formula(M, "proxy_geometry_coordinates_naive", mirror::coordinates_naive, oracle::coordinates, |draws| {
            let (first, second) = edges(draws, -1, 1);
            let weights = Vec2::new(draws.between(0.5, 3.0), draws.between(0.5, 3.0)).as_dvec2();
            let origin = draws.in_cube();
            (origin + (weights.x * first + weights.y * second).as_vec3(), origin, first.as_vec3(), second.as_vec3())
        })
        .benign(2e-4)
        .build(),
        formula(M, "proxy_geometry_cell", mirror::cell, oracle::cell, |draws| {
            let coordinate = |draws: &mut Draws<'_>| match draws.below(4) {
                0 => draws.below(1601) as f32 / 8.0 - 100.0,
                1 => draws.signed(-40, 21),
                _ => draws.between(-4.0, 4.0),
            };
            let first = coordinate(draws);
            // On the diagonal of a cell in a quarter of the cases.
            (if draws.below(4) == 0 {
                Vec2::new(first, draws.below(9) as f32 - 4.0 - first)
            } else {
                Vec2::new(first, coordinate(draws))
            },)
        })
        .invariant("a diagonal belongs to the half that is not turned", |(place,), cell: ProxyGeometryCell| {
            let is_exact = 8.0 * place == (8.0 * place).floor() && place.abs().max_element() < 1e4;
            let fails = is_exact && (place - place.floor()).element_sum() == 1.0 && cell.turned;
            if fails { Err("turned".to_owned()) } else { Ok(()) }
        })
        .edge("not turned", |(place,)| !mirror::cell(place).turned)
        .edge("turned", |(place,)| mirror::cell(place).turned)
        .edge("on a vertex", |(place,)| place == place.floor())
        .edge("on an edge", |(place,)| place.x == place.x.floor() && place.y != place.y.floor())
        .edge("on a diagonal", |(place,)| (place - place.floor()).element_sum() == 1.0)
        .edge("just below 0", |(place,)| place.x < 0.0 && place.x > -1e-6)
        .edge("negative steps", |(place,)| place.x < -1.0 && place.y < -1.0)
        .edge("a million cells away", |(place,)| place.x.abs() > 1e6)
        .hard_case(
            "beside a vertex, where a fraction rounds to 1",
            (Vec2::new(-7.450_581e-9, 1.490_116_1e-8),),
            (&[-1.0, 0.0, 1.0], 0.0),
            ("proxy_geometry_cell_naive", 1.0),
        )
        .build(),
        formula(M, "proxy_geometry_cell_naive", mirror::cell_naive, oracle::cell, |draws| {
            // Inside one half of a cell, at least a 400th of the cell from its edges, or on the
            // diagonal at points that f32 holds exactly.
            let whole = Vec2::new(draws.below(41) as f32 - 20.0, draws.below(41) as f32 - 20.0);
            let (first, share) = (draws.between(0.02, 0.95), draws.between(0.05, 0.9));
            if draws.below(8) == 0 {
                let eighths = 1.0 + draws.below(7) as f32;
                return (whole + Vec2::new(eighths, 8.0 - eighths) / 8.0,);
            }
            let below = Vec2::new(first, share * (1.0 - first));
            (whole + if draws.below(2) == 0 { below } else { Vec2::ONE - below },)
        })
        .benign(0.0)
        .build(),
        formula(M, "proxy_geometry_facet", mirror::facet, oracle::facet, |draws| {
            let (plane, _) = lattice_point(draws);
            // Next to the image in some of the cases, so that every run draws the image itself.
            let most = draws.pick(&[1, 100, 100, 100]);
            let step = |draws: &mut Draws<'_>| draws.below(2 * most + 1) as i32 - most as i32;
            (plane, ProxyGeometryCell { steps: IVec2::new(step(draws), step(draws)), turned: draws.below(2) == 1 })
        })
        .edge("not turned", |(_, cell)| !cell.turned)
        .edge("turned", |(_, cell)| cell.turned)
        .edge("the image itself", |(_, cell)| cell.steps == IVec2::ZERO && !cell.turned)
        .edge("negative steps", |(_, cell)| cell.steps.x < 0 && cell.steps.y < 0)
        // The two halves of a cell share its diagonal, so that facets meet without a gap.
        .pair(
            "the halves of a cell share their diagonal",
            |(plane, cell)| (plane, ProxyGeometryCell { turned: !cell.turned, ..cell }),
            |_, one: ProxyGeometryFacet, other: ProxyGeometryFacet| {
                let gap =
                    (one.vertex_second - other.vertex_third).abs() + (one.vertex_third - other.vertex_second).abs();
                near("gap", gap.max_element().into(), 0.0, 0.0)
            },
        )
        .build(),
    ]
}
