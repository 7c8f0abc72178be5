//! How errors fall with the edges of the triangles: on a ball, where the table of docs/curved_triangle.md is made, and
//! on surfaces of second order.

use super::*;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Returns weights all over a triangle.
fn places() -> impl Iterator<Item = DVec2> {
    (0..5u32).flat_map(|x| (0..5 - x).map(move |y| DVec2::new(f64::from(x), f64::from(y)) / 4.0))
}

/// Returns the point of a triangle with these weights.
fn point(triangle: &oracle::CurvedTriangle, place: DVec2) -> DVec3 {
    triangle.a + place.x * (triangle.b - triangle.a) + place.y * (triangle.c - triangle.a)
}

/// Returns an equilateral triangle with corners on the unit ball, perpendicular to z.
fn on_ball(edge: f64) -> oracle::CurvedTriangle {
    let radius = edge / 3f64.sqrt();
    let [a, b, c] = [0.0, 1.0, 2.0f64].map(|corner| {
        let (sine, cosine) = (corner * TAU / 3.0).sin_cos();
        DVec3::new(radius * cosine, radius * sine, (1.0 - radius * radius).sqrt())
    });
    oracle::CurvedTriangle { a, b, c, normal_a: a, normal_b: b, normal_c: c }
}

/// Largest distances of hits from those on the unit ball itself.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    /// Of positions on the flat triangle.
    flat: f64,
    /// Of moved positions.
    moved: f64,
    /// Of moved positions, for rays along the normal of the triangle.
    head_on: f64,
    /// Of normals interpolated at the flat hit.
    phong: f64,
    /// Of normals at the moved hit.
    normal: f64,
    /// Of the mirror's positions and normals from the oracle's.
    rounding: f64,
}

/// Follows rays onto a triangle on the ball, at cosines from 1 to 0.5 all around.
fn errors(edge: f64) -> Errors {
    let triangle = on_ball(edge);
    let mut errors = Errors::default();
    for place in places() {
        let flat = point(&triangle, place);
        for slope in [1.0, 0.7, 0.5f64] {
            for turn in 0..6u32 {
                let (sine, cosine) = f64::from(turn).sin_cos();
                let across = ((1.0 - slope) * (1.0 + slope)).sqrt();
                let direction = DVec3::new(across * cosine, across * sine, -slope);
                let along = flat.dot(direction);
                // The flat hit lies inside the ball; the ray entered before it.
                let distance = -along - (along * along + 1.0 - flat.length_squared()).sqrt();
                let exact = flat + distance * direction;
                let hit = oracle::meet(triangle, place, flat, direction, DVec3::Z);
                let phong = oracle::meet_phong(triangle, place, flat);
                errors.flat = errors.flat.max(phong.position.distance(exact));
                errors.phong = errors.phong.max(phong.normal.distance(exact));
                errors.moved = errors.moved.max(hit.position.distance(exact));
                errors.normal = errors.normal.max(hit.normal.distance(exact));
                if slope == 1.0 {
                    errors.head_on = errors.head_on.max(hit.position.distance(exact));
                }
                let mirrored = meet(single(&triangle), place.as_vec2(), flat.as_vec3(), direction.as_vec3(), Vec3::Z);
                let off = mirrored.position.as_dvec3().distance(hit.position);
                errors.rounding = errors.rounding.max(off).max(mirrored.normal.as_dvec3().distance(hit.normal));
            }
        }
    }
    errors
}

fn single(triangle: &oracle::CurvedTriangle) -> CurvedTriangle {
    let oracle::CurvedTriangle { a, b, c, normal_a, normal_b, normal_c } = *triangle;
    let [a, b, c] = [a, b, c].map(|corner| corner.as_vec3());
    let [normal_a, normal_b, normal_c] = [normal_a, normal_b, normal_c].map(|normal| normal.as_vec3());
    CurvedTriangle { a, b, c, normal_a, normal_b, normal_c }
}

/// Half the edge leaves a quarter of the error of a flat triangle, and an eighth of the error of the curved one.
#[test]
fn on_a_ball_the_error_falls_by_the_cube_of_the_edges() {
    for edge in [0.5, 0.25, 0.125] {
        let (coarse, fine) = (errors(edge), errors(0.5 * edge));
        for (coarse, fine) in [(coarse.flat, fine.flat), (coarse.phong, fine.phong)] {
            assert!((3.8..4.4).contains(&(coarse / fine)), "{edge}: {coarse:e}, {fine:e}");
        }
        for (coarse, fine) in [(coarse.moved, fine.moved), (coarse.normal, fine.normal)] {
            assert!(coarse / fine > 8.0, "{edge}: {coarse:e}, {fine:e}");
        }
        // Rays along the normal are not moved aside.
        assert!(coarse.head_on / fine.head_on > 15.5, "{edge}: {coarse:?}, {fine:?}");
        // The corners are rounded too, and the normals by as much.
        assert!(coarse.rounding < 4e-6 && fine.rounding < 4e-6, "{edge}: {coarse:?}, {fine:?}");
    }
}

/// Checks the table of docs/curved_triangle.md.
#[test]
fn table_is_current() {
    let mut table = String::new();
    for (name, edge) in [("1/2", 0.5), ("1/4", 0.25), ("1/8", 0.125), ("1/16", 0.0625)] {
        let Errors { flat, moved, head_on, phong, normal, .. } = errors(edge);
        let _ = writeln!(table, "| {name} | {flat:.1e} | {moved:.1e} | {head_on:.1e} | {phong:.1e} | {normal:.1e} |");
    }
    let page = include_str!("../../../docs/curved_triangle.md");
    assert!(page.contains(&table), "docs/curved_triangle.md should hold:\n{table}");
}

/// The height is right to the third order for a saddle, a cylinder and a bowl, not for a ball alone.
#[test]
fn the_height_is_right_to_the_third_order_for_every_surface_of_second_order() {
    for (along_x, along_y) in [(1.0, -1.0f64), (1.0f64, 0.0), (1.0, 0.5)] {
        let surface = |x: f64, y: f64| DVec3::new(x, y, 0.5 * (along_x * x * x + along_y * y * y));
        let steepest = |at: DVec3| DVec3::new(-along_x * at.x, -along_y * at.y, 1.0);
        let error = |size: f64| {
            let [a, b, c] = [(0.8, 0.3), (-0.5, 0.7), (0.1, -0.6)].map(|(x, y)| surface(size * x, size * y));
            let [normal_a, normal_b, normal_c] = [a, b, c].map(|corner| steepest(corner).normalize());
            let triangle = oracle::CurvedTriangle { a, b, c, normal_a, normal_b, normal_c };
            let outward = (b - a).cross(c - a).normalize();
            places()
                .map(|place| {
                    // Newton's method, up from the flat triangle.
                    let flat = point(&triangle, place);
                    let exact = (0..20).fold(0.0, |height: f64, _| {
                        let at = flat + height * outward;
                        height + (surface(at.x, at.y).z - at.z) / steepest(at).dot(outward)
                    });
                    (oracle::height(triangle, place, outward) - exact).abs()
                })
                .fold(0.0, f64::max)
        };
        for size in [0.5, 0.25, 0.125] {
            assert!(error(size) / error(0.5 * size) > 14.0, "{along_x}, {along_y}, {size}");
        }
    }
}
