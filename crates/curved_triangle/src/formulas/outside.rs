//! The clauses of the `Outside:` lines.

use super::{case, corners};
use crate::CurvedTriangle;
use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, finite, nothing, vector_up_to};

pub(super) fn promises() -> Vec<Promise> {
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
