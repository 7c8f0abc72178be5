//! Of absorption, diffusion, optical paths, random walks, veins and voxels.

use super::{any_vector, close, finite_values, of_length, that, vector_up_to};
use glam::{IVec3, UVec2, UVec3, UVec4, Vec2, Vec3};
use lapidary_absorption as absorption;
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::near;
use lapidary_assay::outside::{Promise, accurate, any_bits, any_finite, finite, holds, like, nothing};
use lapidary_optical_path::OPTICAL_PATH_UNREACHED;
use lapidary_random_walk::{RANDOM_WALK_PASSED, RANDOM_WALK_THINNEST, RandomWalkCrossing};
use lapidary_texture_diffusion::TextureDiffusionTap;
use lapidary_veins::{self as veins, VeinsCell, VeinsPattern};
use lapidary_voxelization::{VoxelizationColumn, VoxelizationCrossing, VoxelizationGrid};

/// Whole numbers: small ones, the ends, any.
fn any_number(draws: &mut Draws<'_>) -> u32 {
    match draws.below(3) {
        0 => draws.pick(&[0, 1, 2, u32::MAX, u32::MAX - 1, 1 << 31]),
        1 => draws.below(100),
        _ => draws.bits(),
    }
}

fn numbers(draws: &mut Draws<'_>) -> UVec3 {
    UVec3::new(any_number(draws), any_number(draws), any_number(draws))
}

fn bits_vector(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(any_bits(draws), any_bits(draws), any_bits(draws))
}

pub(super) fn promises() -> Vec<Promise> {
    [absorptions(), textures(), paths(), walks(), patterns(), voxels()].into_iter().flatten().collect()
}

fn absorptions() -> Vec<Promise> {
    vec![
        accurate("absorption_optical_depth", "none is", |draws| (any_finite(draws),)),
        holds(
            "absorption_coefficient",
            "subnormal distances count as 1e-30 or as 0",
            |draws| {
                let distance = f32::from_bits(1 + draws.below(0x7f_ffff));
                (draws.in_cube().abs(), if draws.below(2) == 0 { distance } else { -distance })
            },
            |(color, _): (Vec3, f32), coefficient: Vec3| {
                let shortest = absorption::coefficient(color, 1e-30);
                let bound = 1e-5 * f64::from(shortest.max_element());
                let same = close(&coefficient.to_array(), &shortest.as_dvec3().to_array(), bound);
                if coefficient == Vec3::ZERO { Ok(()) } else { same }
            },
        ),
        nothing("absorption_transmittance", "overflows where the product exceeds 3e38"),
        holds(
            "absorption_transmittance",
            "1 for a negative coefficient",
            |draws| (-draws.between(0.01, 8.0) * Vec3::ONE, draws.between(0.1, 4.0)),
            |_: (Vec3, f32), left: Vec3| that(left == Vec3::ONE, || format!("the transmittance is {left}")),
        ),
    ]
}

fn textures() -> Vec<Promise> {
    const TAP: &str = "texture_diffusion_tap";
    let uv = |draws: &mut Draws<'_>| (Vec2::new(draws.signed(0, 30), draws.signed(0, 30)),);
    let width = |draws: &mut Draws<'_>| (any_bits(draws), any_bits(draws), -draws.magnitude(-60, 100));
    let scattering = |draws: &mut Draws<'_>| draws.in_cube().abs() + 0.1;
    vec![
        accurate("texture_diffusion_finite", "none is; a subnormal may count as zero", |draws| (any_bits(draws),)),
        holds("texture_diffusion_clip", "the same, less accurate", uv, |(uv,): (Vec2,), clip: glam::Vec4| {
            let uv = uv.as_dvec2();
            let bound = 1e-6 * (1.0 + uv.abs().max_element());
            close(&clip.to_array(), &[2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0], bound)
        }),
        holds(
            "texture_diffusion_stretch",
            "0 for shorter ones",
            |draws| (of_length(draws, -126, -64), of_length(draws, -126, -64)),
            |(x, y): (Vec3, Vec3), stretch: Vec2| {
                // Squares that are subnormal have few digits left, and below them is 2^-149.
                let longest = 1.5 * x.as_dvec3().length().max(y.as_dvec3().length()) + 4e-23;
                let right = stretch.min_element() >= 0.0 && f64::from(stretch.max_element()) <= longest;
                that(right, || format!("the stretch is {stretch}"))
            },
        ),
        // Width is tested for every stretch.
        nothing("texture_diffusion_stretch", "infinite for longer ones; texture_diffusion_width takes both"),
        finite("texture_diffusion_width", "a negative widest counts as 0", width),
        holds("texture_diffusion_width", "a negative widest counts as 0", width, |_: (f32, f32, f32), width: f32| {
            that(width == 0.0, || format!("the width is {width}"))
        }),
        accurate("texture_diffusion_sigma", "none is; a subnormal may count as zero", |draws| (bits_vector(draws),)),
        holds(
            "texture_diffusion_ratio",
            "less than the ratio for a widest below 2^-60",
            |draws| {
                let scale = draws.magnitude(-100, -62);
                (scale * (draws.in_cube().abs() + 0.01),)
            },
            |(sigma,): (Vec3,), ratio: f32| {
                let of_channels = sigma.as_dvec3().min_element() / sigma.as_dvec3().max_element();
                let most = of_channels.clamp(0.0625, 1.0) * 1.000_001;
                that((0.0625..=1.0).contains(&ratio) && f64::from(ratio) <= most, || format!("the ratio is {ratio}"))
            },
        ),
        holds(
            "texture_diffusion_pairs",
            "the same",
            |draws| (bits_vector(draws),),
            |_: (Vec3,), pairs: u32| that((15..=23).contains(&pairs), || format!("{pairs} pairs")),
        ),
        like(
            TAP,
            "an index beyond the last counts as the last",
            move |draws| {
                let pairs = 1 + draws.below(1024);
                (pairs.saturating_add(any_number(draws)), pairs, scattering(draws))
            },
            |(_, pairs, sigma): (u32, u32, Vec3)| (pairs, pairs, sigma),
        ),
        like(
            TAP,
            "0 pairs as 1",
            move |draws| (draws.below(3), 0, scattering(draws)),
            |(index, _, sigma): (u32, u32, Vec3)| (index, 1, sigma),
        ),
        holds(
            TAP,
            "0 pairs as 1",
            |draws| (any_number(draws), any_number(draws), bits_vector(draws)),
            |_: (u32, u32, Vec3), tap: TextureDiffusionTap| {
                let right = (0.0..=3.401).contains(&tap.offset) && tap.weight.min_element() >= 0.0;
                that(right && tap.weight.is_finite(), || format!("the tap is {tap:?}"))
            },
        ),
        holds(
            "texture_diffusion_normalize",
            "fades to 0 for smaller coverages",
            |draws| {
                let coverage = draws.magnitude(-126, -61);
                (coverage * draws.in_cube().abs(), Vec3::splat(coverage))
            },
            |(sum, coverage): (Vec3, Vec3), mean: Vec3| {
                let most = 1.000_001 * sum.as_dvec3() / coverage.as_dvec3();
                let right = mean.min_element() >= 0.0 && mean.as_dvec3().cmple(most + 1e-30).all();
                that(right, || format!("the mean is {mean}, at most {most}"))
            },
        ),
        holds(
            "texture_diffusion_half",
            "smaller values keep 11 bits too, which half floats do not have there",
            |draws| (Vec3::new(draws.signed(-120, -15), draws.signed(-120, -15), draws.signed(-120, -15)),),
            |(value,): (Vec3,), half: Vec3| {
                let off = (half - value).as_dvec3().abs();
                let bits = half.to_array().into_iter().all(|half| half.to_bits().trailing_zeros() >= 13);
                let right = off.cmple(value.as_dvec3().abs() * 2f64.powi(-11)).all() && bits;
                that(right, || format!("rounded to {half}"))
            },
        ),
        holds(
            "texture_diffusion_half",
            "the target rounds them, by less than 2^-24",
            |draws| (Vec3::splat(draws.signed(-120, -15)),),
            |(value,): (Vec3,), half: Vec3| {
                // A half float's subnormals are the multiples of 2^-24.
                let stored = (half.x * 2f32.powi(24)).round() * 2f32.powi(-24);
                near("what is stored", stored.into(), value.x.into(), 2f64.powi(-24))
            },
        ),
        holds(
            "texture_diffusion_nearness",
            "|step| below 1 counts as 1",
            |draws| (0.999 * draws.between(0.0, 1.0) * Vec2::from_angle(draws.between(0.0, 6.3)),),
            |_: (Vec2,), nearness: f32| that(nearness == 1.0, || format!("the nearness is {nearness}")),
        ),
    ]
}

fn paths() -> Vec<Promise> {
    vec![
        finite("optical_path_edge", "finite while products stay below 3e38", |draws| {
            (draws.magnitude(-126, 60), draws.magnitude(-126, 60), draws.magnitude(-126, 64))
        }),
        finite("optical_path_relax", "finite while the sum is", |draws| {
            (draws.magnitude(-126, 126), draws.magnitude(-126, 126), draws.magnitude(-126, 126))
        }),
        holds(
            "optical_path_godunov",
            "a slowness below 2^-126 counts as 0 or as itself",
            |draws| {
                let unreached =
                    |draws: &mut Draws<'_>| if draws.below(3) == 0 { 1e30 } else { draws.between(0.0, 4.0) };
                let least = Vec3::new(unreached(draws), unreached(draws), unreached(draws));
                (least, f32::from_bits(1 + draws.below(0x7f_ffff)))
            },
            |(least, _): (Vec3, f32), cost: f32| {
                let wanted = f64::from(least.min_element());
                near("the cost", cost.into(), wanted, 1e-6 * wanted + 2f64.powi(-125))
            },
        ),
        accurate("optical_path_encode", "none is", |draws| (any_bits(draws),)),
        accurate("optical_path_decode", "none is", |draws| (any_number(draws),)),
        holds(
            "optical_path_seed",
            "a negative share is no light",
            |draws| (-draws.magnitude(-120, 100), draws.magnitude(-20, 49), draws.magnitude(-20, 46)),
            |_: (f32, f32, f32), cost: f32| that(cost == OPTICAL_PATH_UNREACHED, || format!("the cost is {cost}")),
        ),
        finite("optical_path_through", "finite while the product is", |draws| {
            (draws.magnitude(-126, 125), draws.magnitude(-126, 62), draws.magnitude(-126, 62))
        }),
        holds("optical_path_luminance", "1 for a negative cost", |draws| (-draws.magnitude(-126, 127),), {
            |_: (f32,), luminance: f32| that(luminance == 1.0, || format!("the luminance is {luminance}"))
        }),
    ]
}

fn walks() -> Vec<Promise> {
    let counter = |draws: &mut Draws<'_>| (UVec4::from_array(std::array::from_fn(|_| any_number(draws))),);
    let below_one = |draws: &mut Draws<'_>| draws.between(0.0, 1.0).min(1.0f32.next_down());
    vec![
        accurate("random_walk_bits", "none is", counter),
        accurate("random_walk_random", "none is", counter),
        accurate("random_walk_free_path", "none is", |draws| (any_finite(draws), any_finite(draws))),
        holds(
            "random_walk_collision",
            "where the sum exceeds the majorant never passes: the walk is biased",
            move |draws| {
                let majorant = draws.magnitude(-20, 20);
                let scattering = majorant * draws.between(0.6, 4.0);
                (below_one(draws), scattering, majorant * draws.between(0.6, 4.0), majorant)
            },
            |_: (f32, f32, f32, f32), outcome: u32| that(outcome != RANDOM_WALK_PASSED, || "it passes".to_owned()),
        ),
        like(
            "random_walk_ratio",
            "a smaller majorant counts as 1e-30",
            |draws| {
                let smaller = if draws.below(2) == 0 { draws.magnitude(-126, -101) } else { -draws.magnitude(-99, 99) };
                (draws.between(0.0, 1.0), draws.magnitude(-126, -90), smaller)
            },
            |(transmittance, density, _): (f32, f32, f32)| (transmittance, density, RANDOM_WALK_THINNEST),
        ),
        accurate("random_walk_phase", "none is", |draws| (any_finite(draws), any_finite(draws))),
        accurate("random_walk_deflection", "none is", |draws| (any_finite(draws), any_finite(draws))),
        accurate("random_walk_azimuth", "none is", |draws| (any_finite(draws),)),
        finite("random_walk_basis", "finite, but no unit vectors", |draws| (vector_up_to(draws, 60),)),
        finite("random_walk_turn", "finite, but no unit vector", |draws| {
            (of_length(draws, -10, 10), draws.in_square(), draws.in_square())
        }),
        accurate("random_walk_isotropic", "none is", |draws| (Vec2::new(any_finite(draws), any_finite(draws)),)),
        holds(
            "random_walk_boundary",
            "a normal that faces away from the light counts as grazing: finite, but no unit vector",
            move |draws| {
                let incident = draws.unit_vector();
                let normal = draws.unit_vector();
                let away = if normal.dot(incident) < 0.0 { -normal } else { normal };
                (incident, away, draws.between(0.25, 4.0), below_one(draws))
            },
            |_: (Vec3, Vec3, f32, f32), crossing: RandomWalkCrossing| finite_values(&crossing.direction.to_array()),
        ),
    ]
}

fn patterns() -> Vec<Promise> {
    let pattern = |draws: &mut Draws<'_>, least_width: i32| VeinsPattern {
        frequency: draws.magnitude(-40, 40),
        width: if draws.below(4) == 0 { -1.0 } else { draws.magnitude(least_width, 2) },
        least: draws.between(0.0, 4.0),
        greatest: draws.between(0.0, 4.0),
        octaves: any_number(draws),
        seed: draws.bits(),
    };
    let between = |(_, pattern): (Vec3, VeinsPattern), density: f32| {
        let (low, high) = (pattern.least.min(pattern.greatest), pattern.least.max(pattern.greatest));
        that((low - 1e-5..=high + 1e-5).contains(&density), || format!("the density is {density}"))
    };
    vec![
        accurate("veins_cell", "none is", |draws| (any_vector(draws),)),
        accurate("veins_hash", "none is", |draws| {
            let corner = numbers(draws).to_array().map(u32::cast_signed);
            (IVec3::from_array(corner), any_number(draws))
        }),
        accurate("veins_gradient", "none is", |draws| (any_number(draws),)),
        holds(
            "veins_corner",
            "the plane goes on",
            |draws| {
                let cell = VeinsCell { corner: IVec3::new(1, -2, 3), offset: 16.0 * draws.in_cube() };
                let corner = IVec3::new(draws.below(8) as i32, draws.below(8) as i32, draws.below(8) as i32);
                (cell, corner, draws.bits())
            },
            |(cell, corner, seed): (VeinsCell, IVec3, u32), value: f32| {
                let gradient = veins::gradient(veins::hash(cell.corner + corner, seed)).as_dvec3();
                close(&[value], &[gradient.dot(cell.offset.as_dvec3() - corner.as_dvec3())], 1e-5)
            },
        ),
        accurate("veins_noise", "none is", |draws| (any_vector(draws), any_number(draws))),
        holds(
            "veins_fractal",
            "positions are clamped for each octave",
            |draws| (any_vector(draws), draws.below(9), draws.bits()),
            |_: (Vec3, u32, u32), sum: f32| that(sum.abs() <= 2.2, || format!("the sum is {sum}")),
        ),
        like(
            "veins_fractal",
            "more octaves count as 8",
            |draws| (100.0 * draws.in_cube(), 8u32.saturating_add(any_number(draws)), draws.bits()),
            |(position, _, seed): (Vec3, u32, u32)| (position, 8, seed),
        ),
        holds(
            "veins_fold",
            "0 where the value's square overflows",
            |draws| (draws.signed(65, 120), draws.magnitude(-20, 20)),
            |_: (f32, f32), share: f32| that(share == 0.0, || format!("the share is {share}")),
        ),
        holds(
            "veins_density",
            "as veins_fractal and veins_fold",
            move |draws| (any_vector(draws), pattern(draws, -4)),
            between,
        ),
        holds(
            "veins_density",
            "a width of less is as right as the noise, whose error it magnifies by its inverse",
            move |draws| (100.0 * draws.in_cube(), pattern(draws, -40)),
            between,
        ),
    ]
}

fn voxels() -> Vec<Promise> {
    const OVERLAPS: &str = "voxelization_overlaps";
    let grid = |draws: &mut Draws<'_>, high: i32| VoxelizationGrid {
        origin: vector_up_to(draws, high),
        spacing: draws.magnitude(-60, high),
        cells: any_number(draws).max(1),
    };
    let crossed = |a: Vec3, b: Vec3, y: f32| (a.y <= y) != (b.y <= y);
    vec![
        holds(
            "voxelization_index",
            "the same, modulo 2^32",
            move |draws| (grid(draws, 10), numbers(draws)),
            |(grid, voxel): (VoxelizationGrid, UVec3), index: u32| {
                let [x, y, z] = voxel.to_array();
                let wanted = x.wrapping_add(grid.cells.wrapping_mul(y.wrapping_add(grid.cells.wrapping_mul(z))));
                that(index == wanted, || format!("{index}, not {wanted}"))
            },
        ),
        finite("voxelization_centre", "finite as long as the centre is", move |draws| {
            (grid(draws, 90), numbers(draws))
        }),
        nothing("voxelization_local", "infinite or a NaN"),
        holds(
            "voxelization_voxel",
            "some voxel of the grid",
            move |draws| {
                let spacing = any_bits(draws);
                let wild = Vec3::new(any_bits(draws), any_bits(draws), any_bits(draws));
                (VoxelizationGrid { spacing, ..grid(draws, 100) }, wild)
            },
            |(grid, _): (VoxelizationGrid, Vec3), voxel: UVec3| {
                that(voxel.max_element() < grid.cells, || format!("the voxel is {voxel}"))
            },
        ),
        finite("voxelization_between", "finite for a sum that is not 0", |draws| {
            let (before, after) = (draws.signed(-40, 40), draws.signed(-40, 40));
            let after = if before + after == 0.0 { 2.0 * after } else { after };
            (draws.in_square(), draws.in_square(), before, after)
        }),
        holds(
            "voxelization_crossing",
            "crossed as the comparisons say",
            |draws| (any_vector(draws), any_vector(draws), any_finite(draws)),
            move |(a, b, y): (Vec3, Vec3, f32), crossing: VoxelizationCrossing| {
                that(crossing.crossed == crossed(a, b, y), || format!("crossed: {}", crossing.crossed))
            },
        ),
        holds(
            "voxelization_column",
            "as voxelization_crossing",
            |draws| {
                (
                    any_vector(draws),
                    any_vector(draws),
                    any_vector(draws),
                    Vec2::new(any_finite(draws), any_finite(draws)),
                )
            },
            move |(a, b, c, column): (Vec3, Vec3, Vec3, Vec2), found: VoxelizationColumn| {
                let edges = [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| crossed(*from, *to, column.x));
                that(!found.inside || edges.count() == 2, || "inside, though the line crosses no edge".to_owned())
            },
        ),
        accurate("voxelization_first", "none is; from 0 to cells whatever comes in", |draws| {
            (any_finite(draws), draws.below(1 << 22))
        }),
        holds(
            "voxelization_first",
            "none is; from 0 to cells whatever comes in",
            |draws| (any_bits(draws), any_number(draws)),
            |(_, cells): (f32, u32), first: u32| that(first <= cells, || format!("{first} of {cells}")),
        ),
        accurate("voxelization_prefix", "none is", |draws| (any_number(draws),)),
        nothing("voxelization_taxicab", "infinite or a NaN"),
        nothing("voxelization_margin", "infinite or a NaN"),
        holds(
            "voxelization_range",
            "none for low > high + 1",
            |draws| {
                let high = draws.signed(-10, 22);
                (1.001 * (high.max(-high) + 2.0), high, draws.below(1 << 22))
            },
            |_: (f32, f32, u32), range: UVec2| that(range.x == range.y, || format!("from {} to {}", range.x, range.y)),
        ),
        holds(
            "voxelization_range",
            "from 0 to cells whatever comes in",
            |draws| (any_bits(draws), any_bits(draws), any_number(draws)),
            |(_, _, cells): (f32, f32, u32), range: UVec2| {
                that(range.x <= range.y && range.y <= cells, || format!("from {} to {}", range.x, range.y))
            },
        ),
        finite("voxelization_span", "finite as long as products of two coordinates are", |draws| {
            let corner = Vec2::new(draws.signed(-126, 58), draws.signed(-126, 58));
            (vector_up_to(draws, 58), vector_up_to(draws, 58), vector_up_to(draws, 58), corner)
        }),
        holds(
            OVERLAPS,
            "as long as products of three coordinates are finite",
            |draws| {
                let size = draws.magnitude(0, 39);
                let (a, b, c) = (size * draws.in_cube(), size * draws.in_cube(), size * draws.in_cube());
                // The voxel that holds a corner of the triangle.
                (a, b, c, a.floor())
            },
            |_: (Vec3, Vec3, Vec3, Vec3), overlaps: bool| {
                that(overlaps, || "it misses a corner's own voxel".to_owned())
            },
        ),
    ]
}
