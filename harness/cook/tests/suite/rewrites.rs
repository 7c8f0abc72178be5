//! Rewrites that are equal on paper, but lose a property that a comment promises. A user's copy
//! with one of them fails its check, although the tolerance of backward error alone would forgive
//! most.

use lapidary_assay::property::Settings;
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;

/// Function, its expression, and a naive replacement.
const REWRITES: &[(&str, &str, &str)] = &[
    ("refraction_radicand", PRODUCT, SQUARE),
    ("refraction_refract", PRODUCT, SQUARE),
    ("fresnel_dielectric", PRODUCT, SQUARE),
    ("fresnel_dielectric", "(1.0f - c) * (1.0f + c)", "1.0f - c * c"),
    (
        "fresnel_dielectric",
        "let s = m / max(s_root * s_root, abs(m));",
        "let s = clamp((c - g) / s_root, -1.0f, 1.0f);",
    ),
    ("fresnel_dielectric", "nc_squared + m * sine_squared", "m + c * c"),
    ("dispersion_refract", PRODUCT, SQUARE),
    (
        "random_walk_phase",
        "let rest = 1.0f - a;\n    let squared = rest * rest + 2.0f * a * (1.0f - c);",
        "let rest = 1.0f - a;\n    let squared = 1.0f + a * a - 2.0f * a * c;",
    ),
    ("random_walk_phase", "rest * (1.0f + a)", "(1.0f - a * a)"),
    ("random_walk_deflection", "(1.0f - a) * (1.0f + a)", "(1.0f - a * a)"),
    ("closest_point_parameters", "cross(normal_i + normal_j, normal_j - normal_i)", "2.0f * cross(normal_i, normal_j)"),
    ("closest_point_fallback", "select(c, bc, dot(bc, bc) < dot(c, c))", "c"),
];

const PRODUCT: &str = "(relative_index - 1.0f) * (relative_index + 1.0f)";
const SQUARE: &str = "(relative_index * relative_index - 1.0f)";

/// Returns the module's text with one function rewritten.
fn rewritten(function: &str, before: &str, after: &str) -> String {
    let formula = formulas::of_function(function).unwrap_or_else(|| panic!("no formula of `{function}`"));
    let source = cookbook::module(formula.module).expect("a module").whole;
    let start = source.find(&format!("fn {function}(")).unwrap_or_else(|| panic!("no function `{function}`"));
    let end = start + source[start..].find("\n}\n").expect("a function ends");
    let body = source[start..end].replacen(before, after, 1);
    assert_ne!(body, source[start..end], "{function}: `{before}` is not there");
    format!("{}{body}{}", &source[..start], &source[end..])
}

#[test]
fn a_copy_with_a_naive_rewrite_fails_its_check() {
    if !lapidary_testing::on_lavapipe("the bounds of other devices forgive more") {
        return;
    }
    let gpu = lapidary_testing::gpu();
    let mut passed = Vec::new();
    for (function, before, after) in REWRITES {
        let formula = formulas::of_function(function).expect("a formula");
        let text = rewritten(function, before, after);
        let settings = Settings { cases: 4_096, seed: lapidary_testing::seed() };
        let row = check::run(gpu, formula, Source::Copy("mine.wgsl", &text), settings).expect("the check runs");
        println!("{function}: {after}: {} failed, {:?}", row.failed, row.broken_hard_cases);
        // A failing random input is not enough: the hard case made for the rewrite must fail.
        if row.broken_hard_cases.is_empty() {
            passed.push(format!("{function}: `{after}` instead of `{before}` breaks no hard case"));
        }
    }
    assert!(passed.is_empty(), "\n{}", passed.join("\n"));
}
