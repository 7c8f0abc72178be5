//! The `portable` bounds, held to the worst that WGSL lets a device make of a function.

use lapidary_assay::interpreter::Program;
use lapidary_assay::property::slack;
use lapidary_assay::tolerance::Tolerance;
use lapidary_cook::{check, cookbook, formulas};

/// Functions whose portable bounds are derived from what WGSL guarantees.
const DERIVED: [&str; 12] = [
    "absorption_transmittance",
    "bvh_trace_to_object",
    "cdrf_normal_share",
    "curvature_frame",
    "curvature_gaussian",
    "curvature_towards",
    "dispersion_sellmeier",
    "proxy_geometry_face_normal",
    "random_walk_ratio",
    "refraction_reflect",
    "texture_diffusion_stretch",
    "veins_fold",
];

#[test]
fn a_device_that_errs_as_far_as_it_may_keeps_to_the_portable_bounds() {
    let named = std::env::var("LAPIDARY_SLACK").ok();
    let derived = |function: &str| match named.as_deref() {
        None => DERIVED.contains(&function),
        Some("all") => true,
        Some(name) => name == function,
    };
    let mut faults = Vec::new();
    let derived = formulas::all().iter().filter(|formula| formula.benign.is_none() && derived(formula.function));
    for formula in super::sampled(derived, if named.is_some() { 1 } else { 3 }) {
        let module = cookbook::module(formula.module).expect("a formula's module");
        let program = Program::new(module.source, module.name, formula.function).expect("valid");
        let bounds = check::documentation(formula).accuracy.bounds(false).expect("a portable bound");
        let tolerance = Tolerance::new(&formula.arguments, &formula.result, bounds);
        let worst = slack::worst(&program, formula, &tolerance, 1, 1_000).expect("the interpreter runs it");
        println!("{:<40} {:.2} of its portable bound", formula.function, worst.ratio);
        if worst.ratio > 1.0 {
            let input = check::spell(formula, &worst.arguments);
            faults.push(format!("{}: {:.2} of its portable bound at {input}", formula.function, worst.ratio));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
