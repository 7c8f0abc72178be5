//! Test inputs, edges, invariants and hard cases of `wgsl/curved_triangle.wgsl`.

use crate::{
    self as mirror, CURVED_TRIANGLE_CANCELLED, CURVED_TRIANGLE_GRAZING, CurvedTriangle, CurvedTriangleHit, oracle,
};
use glam::{DVec3, Vec2, Vec3, vec2, vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use lapidary_assay::outside::{Promise, finite, nothing, vector_up_to};

mirror_struct!(crate, CurvedTriangle { a, b, c, normal_a, normal_b, normal_c });
mirror_struct!(crate, CurvedTriangleHit { position, normal });

const M: &str = "curved_triangle";

/// Error of a unit vector's length: the sum of three squares, the reciprocal root and a product, with room for the
/// portable bounds.
const UNIT: f64 = 32.0 / (1 << 24) as f64;

/// Factor on a bound of heights: a plane far from the origin tilts by up to 2⁻¹⁰ if a corner moves by an ulp.
const TILTED: f64 = 1.01;

/// Triangle, weights and normal.
type Above = (CurvedTriangle, Vec2, Vec3);

/// Triangle, weights, position, direction and normal.
type Case = (CurvedTriangle, Vec2, Vec3, Vec3, Vec3);

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), promises())
}

/// The clauses of the `Outside:` lines.
fn promises() -> Vec<Promise> {
    const AREA: &str = "a triangle without area divides by 0";
    vec![
        finite("curved_triangle_height", "finite for corners up to 2^40 and other arguments up to 2^10", |draws| {
            let [a, b, c] = any_three(draws, 40);
            let [normal_a, normal_b, normal_c] = any_three(draws, 10);
            let weights = Vec2::new(draws.signed(-20, 9), draws.signed(-20, 9));
            (CurvedTriangle { a, b, c, normal_a, normal_b, normal_c }, weights, vector_up_to(draws, 10))
        }),
        finite("curved_triangle_weights", "finite for offsets up to 2^20", |draws| {
            (corners(draws), vector_up_to(draws, 20))
        }),
        nothing("curved_triangle_weights", AREA),
        finite("curved_triangle_meet", "finite for positions up to 2^60 and directions up to 2^10", |draws| {
            let (triangle, barycentrics, _, _, outward) = case(draws);
            (triangle, barycentrics, vector_up_to(draws, 60), vector_up_to(draws, 10), outward)
        }),
        nothing("curved_triangle_meet", AREA),
    ]
}

fn any_three(draws: &mut Draws<'_>, high: i32) -> [Vec3; 3] {
    [vector_up_to(draws, high), vector_up_to(draws, high), vector_up_to(draws, high)]
}

fn triangle_of([a, b, c]: [Vec3; 3], [normal_a, normal_b, normal_c]: [Vec3; 3]) -> CurvedTriangle {
    CurvedTriangle { a, b, c, normal_a, normal_b, normal_c }
}

fn normals_of(triangle: &CurvedTriangle) -> [Vec3; 3] {
    [triangle.normal_a, triangle.normal_b, triangle.normal_c]
}

fn edges(triangle: &CurvedTriangle) -> (DVec3, DVec3) {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|corner| corner.as_dvec3());
    (b - a, c - a)
}

/// Returns the longest edge and the altitude on it.
fn extent(triangle: &CurvedTriangle) -> (f64, f64) {
    let (edge_b, edge_c) = edges(triangle);
    let longest = edge_b.length().max(edge_c.length()).max((edge_c - edge_b).length());
    (longest, edge_b.cross(edge_c).length() / longest)
}

/// Returns the largest coordinate.
fn farthest(triangle: &CurvedTriangle) -> f64 {
    f64::from(triangle.a.abs().max(triangle.b.abs()).max(triangle.c.abs()).max_element())
}

/// Returns the point of a triangle with these weights.
fn point(triangle: &CurvedTriangle, barycentrics: Vec2) -> Vec3 {
    let (edge_b, edge_c) = edges(triangle);
    let foot = f64::from(barycentrics.x) * edge_b + f64::from(barycentrics.y) * edge_c;
    (triangle.a.as_dvec3() + foot).as_vec3()
}

/// Draws corners: a fat or a thin triangle of any size, around the origin or far from it, without normals.
fn corners(draws: &mut Draws<'_>) -> CurvedTriangle {
    let size = if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-11, 10) };
    let along = draws.unit_vector().as_dvec3().normalize();
    let across = draws.perpendicular(along);
    let altitude = match draws.below(4) {
        0 => f64::from(draws.magnitude(-9, -1)),
        _ => draws.between_f64(0.3, 1.0),
    };
    let third = draws.between_f64(-1.0, 2.0) * along + altitude * across;
    let centre = match draws.below(4) {
        0 => f64::from(draws.magnitude(0, 11)) * draws.in_cube().as_dvec3(),
        1 => draws.in_cube().as_dvec3(),
        _ => DVec3::ZERO,
    };
    let mut corners = [centre, centre + along, centre + third].map(|corner| (f64::from(size) * corner).as_vec3());
    corners.rotate_left(draws.below(3) as usize);
    let triangle = triangle_of(corners, [Vec3::ZERO; 3]);
    let (longest, altitude) = extent(&triangle);
    // Far from the origin rounding may flatten a thin triangle.
    if altitude * 1024.0 < longest || altitude * 8192.0 < farthest(&triangle) {
        return triangle_of([Vec3::ZERO, size * Vec3::X, size * Vec3::Y], [Vec3::ZERO; 3]);
    }
    triangle
}

/// Draws normals: that of the triangle, equal, tilted a little or far, opposite, missing, any, or those of a ball or a
/// bowl.
fn normals(draws: &mut Draws<'_>, flat: &CurvedTriangle, outward: DVec3) -> [Vec3; 3] {
    let tilted = |draws: &mut Draws<'_>, most: f64| {
        let angle = most * draws.unit();
        (angle.cos() * outward + angle.sin() * draws.perpendicular(outward)).as_vec3()
    };
    match draws.below(10) {
        0 => [outward.as_vec3(); 3],
        1 => [tilted(draws, 1.2); 3],
        2 | 3 => {
            let normal = tilted(draws, 1.2);
            [normal, -normal, normal]
        }
        4 => [draws.unit_vector(), draws.unit_vector(), draws.unit_vector()],
        5 => {
            let most = f64::from(draws.magnitude(-20, -2));
            [tilted(draws, most), tilted(draws, most), tilted(draws, most)]
        }
        6 => {
            let normal = tilted(draws, 0.5);
            draws.pick(&[[Vec3::ZERO; 3], [normal, Vec3::ZERO, normal], [Vec3::ZERO, normal, Vec3::ZERO]])
        }
        7 => [tilted(draws, 1.2), tilted(draws, 1.2), tilted(draws, 1.2)],
        _ => {
            let corners = [flat.a, flat.b, flat.c].map(|corner| corner.as_dvec3());
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let lean = draws.between_f64(-1.5, 1.5) / extent(flat).0;
            corners.map(|corner| (outward + lean * (corner - middle)).normalize().as_vec3())
        }
    }
}

/// Draws a triangle with normals, and the normal of its plane to either side.
fn triangle(draws: &mut Draws<'_>) -> (CurvedTriangle, DVec3) {
    let flat = corners(draws);
    let (edge_b, edge_c) = edges(&flat);
    let outward = edge_b.cross(edge_c).normalize();
    let outward = if draws.below(4) == 0 { -outward } else { outward };
    (triangle_of([flat.a, flat.b, flat.c], normals(draws, &flat, outward)), outward)
}

/// Draws weights: anywhere, a corner, on an edge, or where opposite normals nearly cancel.
fn barycentrics(draws: &mut Draws<'_>) -> Vec2 {
    let (x, y) = (draws.between(0.0, 1.0), draws.between(0.0, 1.0));
    let (x, y) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
    match draws.below(8) {
        0 => draws.pick(&[Vec2::ZERO, Vec2::X, Vec2::Y]),
        1 => vec2(x, 0.0),
        2 => vec2(0.0, y),
        3 => vec2(0.5, 0.5 * y),
        4 => vec2(0.5 + draws.signed(-16, -3), 0.25 * y),
        _ => vec2(x, y),
    }
}

/// Draws a unit vector at any angle to a direction: along it, grazing, at the least cosine, or perpendicular.
fn heading(draws: &mut Draws<'_>, outward: DVec3) -> Vec3 {
    let slope = match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0, -1.0]),
        1 => draws.signed(-30, -3),
        2 => {
            let least = draws.nudged(CURVED_TRIANGLE_GRAZING, 8);
            draws.pick(&[least, -least])
        }
        _ => draws.between(-1.0, 1.0),
    };
    let slope = f64::from(slope);
    (slope * outward + ((1.0 - slope) * (1.0 + slope)).sqrt() * draws.perpendicular(outward)).as_vec3()
}

fn above(draws: &mut Draws<'_>) -> Above {
    let (triangle, outward) = triangle(draws);
    (triangle, barycentrics(draws), outward.as_vec3())
}

fn case(draws: &mut Draws<'_>) -> Case {
    let (triangle, outward) = triangle(draws);
    let barycentrics = barycentrics(draws);
    let direction = heading(draws, outward);
    (triangle, barycentrics, point(&triangle, barycentrics), direction, outward.as_vec3())
}

/// Draws a triangle near the origin that bulges like part of a ball, where the naive forms hold. The normals lean by
/// 1/4 to 1/3.
fn bulge(draws: &mut Draws<'_>) -> (CurvedTriangle, Vec2, DVec3) {
    let outward = draws.direction();
    let along = draws.perpendicular(outward);
    let across = outward.cross(along);
    let lean = draws.between_f64(0.25, 0.33);
    let ways = [along, 0.9 * across - 0.4 * along, -0.4 * along - 0.9 * across];
    let centre = 1.5 * outward;
    let corners = ways.map(|way| (centre + 0.6 * way).as_vec3());
    let normals = ways.map(|way| (outward + lean * way).normalize().as_vec3());
    let barycentrics = vec2(draws.between(0.2, 0.4), draws.between(0.2, 0.4));
    (triangle_of(corners, normals), barycentrics, outward)
}

/// Draws a ray that meets such a triangle at a cosine of at least 0.5, from either side.
fn met_bulge(draws: &mut Draws<'_>) -> Case {
    let (triangle, barycentrics, outward) = bulge(draws);
    let slope = draws.between_f64(0.5, 1.0) * if draws.below(2) == 0 { -1.0 } else { 1.0 };
    let direction = slope * outward + ((1.0 - slope) * (1.0 + slope)).sqrt() * draws.perpendicular(outward);
    (triangle, barycentrics, point(&triangle, barycentrics), direction.as_vec3(), outward.as_vec3())
}

/// Corners of edges around 1, far from the origin, in a plane of normal (0.6, 0, 0.8).
const FAR: [Vec3; 3] =
    [vec3(4097.5, -2050.25, 1027.75), vec3(4098.5, -2050.25, 1027.0), vec3(4097.5, -2049.25, 1027.75)];
const FAR_NORMAL: Vec3 = vec3(0.6, 0.0, 0.8);

/// Normals that lean outwards over the corners 0, x and y.
const LEANING: [Vec3; 3] = [vec3(-0.48, -0.36, 0.8), vec3(0.6, 0.0, 0.8), vec3(0.0, 0.6, 0.8)];

fn functions() -> Vec<Formula> {
    let all = [height_formulas(), weights_formulas(), vec![meet_formula(), meet_naive_formula(), meet_phong_formula()]];
    all.into_iter().flatten().collect()
}

fn height_formulas() -> Vec<Formula> {
    const NAIVE: &str = "curved_triangle_height_naive";
    let corner = vec3(2048.75, 1025.5, -4099.25);
    let far: Above = (triangle_of([corner, corner + Vec3::X, corner + Vec3::Y], LEANING), Vec2::splat(0.3), Vec3::Z);
    let flat: Above = (triangle_of(FAR, [FAR_NORMAL; 3]), vec2(0.25, 0.5), FAR_NORMAL);
    vec![
        formula(M, "curved_triangle_height", mirror::height, oracle::height, above)
            .edge("flat", |(triangle, _, outward)| normals_of(&triangle) == [outward; 3])
            .edge("nearly flat", |(triangle, _, outward)| {
                normals_of(&triangle).iter().all(|normal| *normal != outward && normal.distance(outward) < 1e-3)
            })
            .edge("bulging", |(triangle, barycentrics, outward)| {
                f64::from(mirror::height(triangle, barycentrics, outward)) > 0.1 * extent(&triangle).0
            })
            .edge("hollow", |(triangle, barycentrics, outward)| {
                f64::from(mirror::height(triangle, barycentrics, outward)) < -0.1 * extent(&triangle).0
            })
            .edge("without normals", |(triangle, ..)| normals_of(&triangle) == [Vec3::ZERO; 3])
            .edge("a sliver", |(triangle, ..)| extent(&triangle).0 > 400.0 * extent(&triangle).1)
            .edge("far from the origin", |(triangle, ..)| farthest(&triangle) > 500.0 * extent(&triangle).0)
            .edge("small", |(triangle, ..)| extent(&triangle).0 < 1e-3)
            .edge("large", |(triangle, ..)| extent(&triangle).0 > 1e3)
            .invariant("at most a quarter of an edge", |(triangle, ..), height: f32| {
                let (edge_b, edge_c) = edges(&triangle);
                let most = 0.25 * TILTED * edge_b.length().max(edge_c.length());
                near("height", height.into(), 0.0, most)
            })
            .invariant_at_nearest("equal normals leave the triangle flat", |(triangle, ..), height: f32| {
                let [a, b, c] = normals_of(&triangle);
                if a == b && b == c && height != 0.0 { Err(format!("height {height}")) } else { Ok(()) }
            })
            .pair(
                "the triangle's other side",
                |(triangle, barycentrics, outward)| (triangle, barycentrics, -outward),
                |_, height: f32, other: f32| near("sum", f64::from(height) + f64::from(other), 0.0, 0.0),
            )
            .pair(
                "b and c may change places",
                |(triangle, barycentrics, outward)| {
                    let CurvedTriangle { a, b, c, normal_a, normal_b, normal_c } = triangle;
                    (
                        triangle_of([a, c, b], [normal_a, normal_c, normal_b]),
                        vec2(barycentrics.y, barycentrics.x),
                        outward,
                    )
                },
                |_, height: f32, other: f32| near("height", other.into(), height.into(), 0.0),
            )
            .hard_case("far from the origin", far, (&[0.141_120_007_767_677_33], 1e-6), (NAIVE, 3e-5))
            .hard_case("flat and far from the origin", flat, (&[0.0], 0.0), (NAIVE, 3e-5))
            .build(),
        formula(M, NAIVE, mirror::height_naive, oracle::height, |draws| {
            let (triangle, barycentrics, outward) = bulge(draws);
            (triangle, barycentrics, outward.as_vec3())
        })
        .benign(1e-4)
        .build(),
    ]
}

fn weights_formulas() -> Vec<Formula> {
    const NAIVE: &str = "curved_triangle_weights_naive";
    let sliver = triangle_of(
        [
            vec3(0.3125, 0.1875, 0.125),
            vec3(1.0625, 0.6875, 0.4375),
            vec3(0.755_976_557_731_628_4, 0.480_546_861_886_978_15, 0.309_619_128_704_071_04),
        ],
        [Vec3::ZERO; 3],
    );
    // A tenth of one edge and three tenths of the other.
    let offset = vec3(0.208_042_964_339_256_3, 0.137_914_061_546_325_68, 0.086_635_738_611_221_31);
    let of_sliver = [0.100_001_089_606_906, 0.299_998_151_243_257];
    vec![
        formula(M, "curved_triangle_weights", mirror::weights, oracle::weights, |draws| {
            let (triangle, outward) = triangle(draws);
            let (edge_b, edge_c) = edges(&triangle);
            let size = extent(&triangle).0;
            let offset = match draws.below(6) {
                0 => DVec3::ZERO,
                1 => draws.pick(&[edge_b, edge_c]),
                2 => size * outward,
                3 => draws.between_f64(-1.0, 1.0) * edge_b + draws.between_f64(-1.0, 1.0) * edge_c,
                _ => size * f64::from(draws.magnitude(-10, 0)) * draws.direction(),
            };
            // Anything shorter is rounding.
            let offset = if offset.length() < 2f64.powi(-20) * size { DVec3::ZERO } else { offset };
            (triangle, offset.as_vec3())
        })
        .edge("no offset", |(_, offset)| offset == Vec3::ZERO)
        .edge("to b", |(triangle, offset)| offset == (triangle.b - triangle.a))
        .edge("to c", |(triangle, offset)| offset == (triangle.c - triangle.a))
        .edge("perpendicular to the triangle", |(triangle, offset)| {
            let (edge_b, edge_c) = edges(&triangle);
            let across = edge_b.cross(edge_c).normalize();
            offset != Vec3::ZERO && offset.as_dvec3().normalize().dot(across).abs() > 0.999_999
        })
        .edge("a sliver, its third edge short", |(triangle, _)| {
            let (edge_b, edge_c) = edges(&triangle);
            (edge_c - edge_b).length() * 8.0 < edge_b.length().min(edge_c.length())
        })
        .edge("a sliver, its corner a flat angle", |(triangle, _)| {
            let (edge_b, edge_c) = edges(&triangle);
            edge_b.normalize().dot(edge_c.normalize()) < -0.999
        })
        .edge("far from the origin", |(triangle, _)| farthest(&triangle) > 500.0 * extent(&triangle).0)
        .pair(
            "an offset twice as long",
            |(triangle, offset)| (triangle, 2.0 * offset),
            |_, weights: Vec2, other: Vec2| near("difference", (2.0 * weights - other).length().into(), 0.0, 0.0),
        )
        .hard_case("a sliver", (sliver, offset), (&of_sliver, 1e-5), (NAIVE, 3e-4))
        .build(),
        formula(M, NAIVE, mirror::weights_naive, oracle::weights, |draws| {
            let (triangle, ..) = bulge(draws);
            let (edge_b, edge_c) = edges(&triangle);
            let offset = draws.between_f64(0.2, 1.0) * edge_b + draws.between_f64(0.2, 1.0) * edge_c;
            (triangle, offset.as_vec3())
        })
        .benign(1e-5)
        .build(),
    ]
}

fn meet_formula() -> Formula {
    const NAIVE: &str = "curved_triangle_meet_naive";
    const PHONG: &str = "curved_triangle_meet_phong";
    let unit = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let along: Case = (triangle_of(unit, LEANING), vec2(0.25, 0.5), vec3(0.25, 0.5, 0.0), Vec3::X, Vec3::Z);
    let of_along = [0.925_000_023, 0.5, 0.0, 0.636_649_545_8, 0.379_976_607_2, 0.671_040_337_0];
    let opposite: Case = (
        triangle_of(unit, [Vec3::Z, -Vec3::Z, Vec3::Z]),
        vec2(0.5, 0.25),
        vec3(0.5, 0.25, 0.0),
        vec3(0.0, 0.6, -0.8),
        Vec3::Z,
    );
    let of_opposite = [0.5, 0.25, 0.0, 0.0, 0.0, 1.0];
    let flat: Case = (
        triangle_of(FAR, [FAR_NORMAL; 3]),
        vec2(0.25, 0.5),
        vec3(4097.75, -2049.75, 1027.5625),
        vec3(0.0, 0.6, -0.8),
        FAR_NORMAL,
    );
    let of_flat = [4097.75, -2049.75, 1027.5625, 0.6, 0.0, 0.8];
    // Corners on the unit ball, up to 0.68 apart, and a ray that meets the flat triangle at a cosine of 0.457. The
    // limit is where it meets the ball.
    let on_ball = [vec3(0.48, 0.6, 0.64), vec3(0.8, 0.0, 0.6), vec3(0.6, 0.0, 0.8)];
    let outward = vec3(0.671_492_2, 0.313_363_08, 0.671_492_2);
    let (barycentrics, position) = (vec2(0.25, 0.5), vec3(0.62, 0.15, 0.71));
    let ball: Case = (triangle_of(on_ball, on_ball), barycentrics, position, vec3(0.96, 0.0, -0.28), outward);
    let of_ball = [0.715_729_12, 0.150_000_01, 0.682_079_05, 0.715_729_12, 0.150_000_01, 0.682_079_05];
    let phong = (ball.0, barycentrics, position);
    formula(M, "curved_triangle_meet", mirror::meet, oracle::meet, case)
        .edge("along the triangle", |(_, _, _, direction, outward)| direction.dot(outward).abs() < 1e-6)
        .edge("grazing, from above", |(_, _, _, direction, outward)| (-0.19..-0.01).contains(&direction.dot(outward)))
        .edge("grazing, from below", |(_, _, _, direction, outward)| (0.01..0.19).contains(&direction.dot(outward)))
        .edge("straight down", |(_, _, _, direction, outward)| direction.dot(outward) < -0.999_999)
        .edge("straight up", |(_, _, _, direction, outward)| direction.dot(outward) > 0.999_999)
        .edge("normals that cancel", |(triangle, barycentrics, ..)| {
            triangle.normal_a != Vec3::ZERO && triangle.normal_b == -triangle.normal_a && barycentrics.x == 0.5
        })
        .edge("normals that nearly cancel", |(triangle, barycentrics, ..)| {
            triangle.normal_b == -triangle.normal_a
                && ((1.0 - 2.0 * barycentrics.x).powi(2) / CURVED_TRIANGLE_CANCELLED - 1.5).abs() < 0.5
        })
        .edge("flat", |(triangle, .., outward): Case| normals_of(&triangle) == [outward; 3])
        .edge("without normals", |(triangle, ..): Case| normals_of(&triangle) == [Vec3::ZERO; 3])
        .edge("moved by an edge", |(triangle, barycentrics, position, direction, outward)| {
            let met = mirror::meet(triangle, barycentrics, position, direction, outward).position;
            f64::from(met.distance(position)) > 0.5 * extent(&triangle).0
        })
        .edge("a sliver", |(triangle, ..): Case| extent(&triangle).0 > 400.0 * extent(&triangle).1)
        .edge("far from the origin", |(triangle, ..): Case| farthest(&triangle) > 500.0 * extent(&triangle).0)
        .invariant("a unit normal", |_, hit: CurvedTriangleHit| {
            near("length", hit.normal.as_dvec3().length(), 1.0, UNIT)
        })
        .invariant(
            "it moves along the ray, by 5/4 of an edge at most",
            |(triangle, _, position, direction, _), hit: CurvedTriangleHit| {
                let moved = hit.position.as_dvec3() - position.as_dvec3();
                let (edge_b, edge_c) = edges(&triangle);
                let most = 1.25 * TILTED * edge_b.length().max(edge_c.length());
                let give = 1e-6 * (farthest(&triangle) + most);
                near("way", moved.length(), 0.0, most + give)?;
                near("way aside", moved.cross(direction.as_dvec3()).length(), 0.0, give)
            },
        )
        .invariant_at_nearest(
            "equal normals leave the hit where it is",
            |(triangle, _, position, ..), hit: CurvedTriangleHit| {
                let [a, b, c] = normals_of(&triangle);
                if a != b || b != c || a == Vec3::ZERO {
                    return Ok(());
                }
                near("way", hit.position.distance(position).into(), 0.0, 0.0)?;
                near("turn", hit.normal.distance(a).into(), 0.0, UNIT)
            },
        )
        .pair(
            "the ray reversed",
            |(triangle, barycentrics, position, direction, outward)| {
                (triangle, barycentrics, position, -direction, outward)
            },
            |(_, _, _, direction, outward), hit: CurvedTriangleHit, other: CurvedTriangleHit| {
                if direction.dot(outward).abs() < 1e-6 {
                    // A ray along the triangle is followed forwards, either way.
                    return Ok(());
                }
                near("way", hit.position.distance(other.position).into(), 0.0, 0.0)?;
                near("turn", hit.normal.distance(other.normal).into(), 0.0, 0.0)
            },
        )
        .hard_case("a ray along the triangle", along, (&of_along, 1e-6), (NAIVE, f64::INFINITY))
        .hard_case("normals that cancel", opposite, (&of_opposite, 1e-6), (NAIVE, f64::INFINITY))
        .hard_case("flat and far from the origin", flat, (&of_flat, 1e-6), (NAIVE, 4e-5))
        .hard_case_with("a slanting ray onto a ball", ball, (&of_ball, 0.01), (PHONG, phong, 0.08))
        .build()
}

fn meet_naive_formula() -> Formula {
    formula(M, "curved_triangle_meet_naive", mirror::meet_naive, oracle::meet, met_bulge).benign(1e-4).build()
}

fn meet_phong_formula() -> Formula {
    formula(M, "curved_triangle_meet_phong", mirror::meet_phong, oracle::meet_phong, |draws| {
        let (triangle, barycentrics, ..) = bulge(draws);
        (triangle, barycentrics, point(&triangle, barycentrics))
    })
    .benign(1e-5)
    .build()
}
