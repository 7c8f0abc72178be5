//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.
//! All arguments are clamped, so that the domains have no outside.

use lapidary_assay::outside::{Promise, accurate, any_finite, holds, that};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const NOTHING: &str = "nothing";
    let mut promises = vec![
        accurate("half_space_inside", NOTHING, |draws| {
            (any_finite(draws), any_finite(draws), any_finite(draws), any_finite(draws), any_finite(draws))
        }),
        accurate("half_space_dielectric", NOTHING, |draws| {
            (
                any_finite(draws),
                any_finite(draws),
                any_finite(draws),
                any_finite(draws),
                any_finite(draws),
                any_finite(draws),
            )
        }),
    ];
    let single =
        ["half_space_gamma_of_reflectance", "half_space_darkening", "half_space_reflectance", "half_space_edge"];
    promises.extend(single.map(|function| accurate(function, NOTHING, |draws| (any_finite(draws),))));
    let pairs = [
        "half_space_gamma",
        "half_space_escape",
        "half_space_h",
        "half_space_directional",
        "half_space_exit",
        "half_space_refract",
        "half_space_gain",
        "half_space_slant",
        "half_space_entered",
        "half_space_gamma_of_entered",
    ];
    promises.extend(pairs.map(|function| accurate(function, NOTHING, |draws| (any_finite(draws), any_finite(draws)))));
    promises.push(holds(
        "half_space_gamma_of_shares",
        "gamma in [0, 1]",
        |draws| (any_finite(draws), any_finite(draws)),
        |_, gamma: f32| that((0.0..=1.0).contains(&gamma), || format!("gamma {gamma}")),
    ));
    let triples = ["half_space_brdf", "half_space_factor"];
    promises.extend(triples.map(|function| {
        accurate(function, NOTHING, |draws| (any_finite(draws), any_finite(draws), any_finite(draws)))
    }));
    promises
}
