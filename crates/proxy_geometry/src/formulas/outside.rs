//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{ProxyGeometryCell, ProxyGeometryPlane};
use glam::{IVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, finite, holds, nothing, that};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const BEYOND: &str = "overflows beyond";
    const CELL: &str = "proxy_geometry_cell";
    let sized = |draws: &mut Draws<'_>, low: i32, high: i32| {
        let size = draws.magnitude(low, high);
        let (one, two) = (size * draws.in_cube(), size * draws.in_cube());
        // All kinds of degenerate triangles.
        match draws.below(6) {
            0 => (one, one, one),
            1 => (one, one, two),
            2 => (one, two, one),
            3 => (one, two, 0.5 * (one + two)),
            _ => (one, two, size * draws.in_cube()),
        }
    };
    vec![
        nothing("proxy_geometry_image", BEYOND),
        nothing("proxy_geometry_plane", BEYOND),
        nothing("proxy_geometry_facet_normal", BEYOND),
        nothing("proxy_geometry_next_plane", BEYOND),
        nothing("proxy_geometry_intersect", "for positions beyond, overflows"),
        finite("proxy_geometry_face_normal", "finite; zero or ill-conditioned", move |draws| sized(draws, -126, 99)),
        finite("proxy_geometry_coordinates", "finite; ill-conditioned", move |draws| {
            let (point, first, second) = sized(draws, -89, 88);
            (point, Vec3::ZERO, first, second)
        }),
        holds(
            CELL,
            "as the formula gives",
            |draws| (Vec2::new(draws.signed(23, 29), draws.signed(23, 29)),),
            |(place,): (Vec2,), cell: ProxyGeometryCell| {
                let wanted = IVec2::new(place.x.floor() as i32, place.y.floor() as i32);
                that(cell.steps == wanted, || format!("{:?}, not {wanted}", cell.steps))
            },
        ),
        holds(
            CELL,
            "cells beyond 2^31 are clamped to it",
            |draws| (Vec2::new(draws.signed(31, 126), draws.signed(31, 126)),),
            |(place,): (Vec2,), cell: ProxyGeometryCell| {
                let clamped = |coordinate: f32, step: i32| {
                    // The largest f32 that an i32 holds is 2^31 - 128.
                    if coordinate > 0.0 { step >= i32::MAX - 127 } else { step == i32::MIN }
                };
                that(clamped(place.x, cell.steps.x) && clamped(place.y, cell.steps.y), || format!("{:?}", cell.steps))
            },
        ),
        finite("proxy_geometry_facet", "exact steps up to 2^24", |draws| {
            let size = draws.magnitude(-89, 88);
            let mut vector = || size * draws.in_cube();
            let plane = ProxyGeometryPlane { origin: vector(), edge_first: vector(), edge_second: vector() };
            let mut step = || (draws.below(1 << 25) as i32) - (1 << 24);
            let steps = IVec2::new(step(), step());
            (plane, ProxyGeometryCell { steps, turned: draws.below(2) == 0 })
        }),
        nothing("proxy_geometry_facet", "overflows beyond 1e37"),
    ]
}
