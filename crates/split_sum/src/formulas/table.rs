//! Points of the low-discrepancy set, and texels of the table.

use super::draw::{alpha, cosine};
use super::shared::{M, ROUNDED};
use crate::{self as mirror, oracle};
use glam::{UVec2, Vec2};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near};

/// Draws the size of a table.
fn size(draws: &mut Draws<'_>) -> UVec2 {
    match draws.below(3) {
        0 => draws.pick(&[UVec2::splat(2), UVec2::splat(32), UVec2::new(4096, 2)]),
        _ => UVec2::new(2 + draws.below(4095), 2 + draws.below(128)),
    }
}

pub(super) fn formulas() -> Vec<Formula> {
    vec![
        formula(M, "split_sum_point", mirror::point, oracle::point, |draws| {
            let count = match draws.below(3) {
                0 => draws.pick(&[1, 16, 1024, 1 << 24]),
                1 => 1 + draws.below(1 << 24),
                _ => 1 + draws.below(4096),
            };
            let index = if draws.below(4) == 0 { draws.pick(&[0, count - 1]) } else { draws.below(count) };
            (index, count)
        })
        .edge("the first of several", |(index, count)| index == 0 && count > 1)
        .edge("the last of most", |(index, count)| index == count - 1 && count == 1 << 24)
        .invariant("in [0, 1)", |_, point: Vec2| {
            let inside = point.min_element() >= 0.0 && point.max_element() < 1.0;
            if inside { Ok(()) } else { Err(format!("{point}")) }
        })
        .build(),
        formula(M, "split_sum_texel", mirror::texel, oracle::texel, |draws| {
            let size = size(draws);
            let texel = match draws.below(4) {
                0 => draws.pick(&[UVec2::ZERO, size - 1]),
                _ => UVec2::new(draws.below(size.x), draws.below(size.y)),
            };
            (texel, size)
        })
        .edge("the first texel", |(texel, _)| texel == UVec2::ZERO)
        .edge("the last texel", |(texel, size)| texel == size - 1)
        .edge("the smallest table", |(_, size)| size == UVec2::splat(2))
        .invariant_at_nearest("0 and 1 at the ends", |(texel, size), value: Vec2| {
            for axis in 0..2 {
                let end = if texel[axis] == 0 { 0.0 } else { 1.0 };
                if texel[axis] == 0 || texel[axis] == size[axis] - 1 {
                    near("end", value[axis].into(), end, 0.0)?;
                }
            }
            Ok(())
        })
        .build(),
        formula(M, "split_sum_place", mirror::place, oracle::place, |draws| (cosine(draws), alpha(draws), size(draws)))
            .edge("grazing", |(cosine, ..)| cosine == 0.0)
            .edge("head on", |(cosine, ..)| cosine == 1.0)
            .edge("a cosine below 0", |(cosine, ..)| cosine < 0.0)
            .edge("a cosine above 1", |(cosine, ..)| cosine > 1.0)
            .edge("alpha below its least", |(_, alpha, _)| alpha < 0.001)
            .edge("alpha above its greatest", |(_, alpha, _)| alpha > 1.0)
            .edge("the smallest table", |(.., size)| size == UVec2::splat(2))
            .invariant("between the middles of the first and the last texel", |(.., size), place: Vec2| {
                let size = size.as_dvec2();
                for axis in 0..2 {
                    near("place", place[axis].into(), 0.5, 0.5 - 0.5 / size[axis] + ROUNDED / size[axis] * size[axis])?;
                }
                Ok(())
            })
            .build(),
    ]
}
