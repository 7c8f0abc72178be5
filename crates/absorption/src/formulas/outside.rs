//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{self as absorption};
use glam::Vec3;
use lapidary_assay::outside::{Promise, accurate, any_finite, close, holds, nothing, that};

/// Returns all promises of the module.
pub(super) fn promises() -> Vec<Promise> {
    vec![
        accurate("absorption_optical_depth", "nothing", |draws| (any_finite(draws),)),
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
