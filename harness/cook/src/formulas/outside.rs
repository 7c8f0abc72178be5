//! The `Outside:` lines, clause by clause: what each function promises beyond its domain.

mod light;
mod matter;
mod rays;
mod surfaces;

use glam::Vec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::near;
use lapidary_assay::outside::{Promise, any_finite};
use std::sync::OnceLock;

/// All promises, function by function.
pub fn all() -> &'static [Promise] {
    static PROMISES: OnceLock<Vec<Promise>> = OnceLock::new();
    PROMISES.get_or_init(|| {
        [light::promises(), matter::promises(), rays::promises(), surfaces::promises()].into_iter().flatten().collect()
    })
}

/// A vector of any finite components.
fn any_vector(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(any_finite(draws), any_finite(draws), any_finite(draws))
}

/// A vector with components 0 or of magnitudes up to 2^`high`.
fn vector_up_to(draws: &mut Draws<'_>, high: i32) -> Vec3 {
    let mut component = || if draws.below(6) == 0 { 0.0 } else { draws.signed(-126, high - 1) };
    Vec3::new(component(), component(), component())
}

/// A direction of any length between 2^`low` and 2^`high`.
fn of_length(draws: &mut Draws<'_>, low: i32, high: i32) -> Vec3 {
    draws.magnitude(low, high - 1) * draws.unit_vector()
}

/// Passes where `right`; `what` says what is not.
fn that(right: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if right { Ok(()) } else { Err(what()) }
}

/// Passes where every component of `value` is within `bound` of `wanted`; a NaN never is.
fn close(value: &[f32], wanted: &[f64], bound: f64) -> Result<(), String> {
    value.iter().zip(wanted).try_for_each(|(value, wanted)| near("a component", f64::from(*value), *wanted, bound))
}

/// Passes where all are finite.
fn finite_values(values: &[f32]) -> Result<(), String> {
    that(values.iter().all(|value| value.is_finite()), || format!("the result is {values:?}"))
}
