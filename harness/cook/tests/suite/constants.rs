//! Every `const` of every module has its mirror's value to the bit, even if no function reads it.
//! Constants of measured quantities are near published values.

use lapidary_assay::dispatch;
use lapidary_assay::value::Value;
use lapidary_cookbook as cookbook;
use naga::{Expression, Handle, Literal, Module};
use std::collections::BTreeMap;

/// The mirrors' consts, by module and name.
macro_rules! mirrored {
    ($($module:ident, $krate:ident: $($name:ident)*;)*) => {
        /// Returns the words of each mirror's consts, by module and name.
        fn mirrors() -> BTreeMap<(&'static str, &'static str), Vec<u32>> {
            let mut found = BTreeMap::new();
            $($({
                let mut words = Vec::new();
                $krate::$name.write(&mut words);
                found.insert((stringify!($module), stringify!($name)), words);
            })*)*
            found
        }
    };
}

mirrored! {
    absorption, lapidary_absorption: ABSORPTION_DARKEST ABSORPTION_FARTHEST ABSORPTION_NEAREST;
    bvh_trace, lapidary_bvh_trace: BVH_TRACE_MARGIN_REACH BVH_TRACE_MARGIN_ORIGIN BVH_TRACE_NAIVE_EPSILON BVH_TRACE_NONE;
    cdrf, lapidary_cdrf: CDRF_SWITCH CDRF_CHEAP_SWITCH CDRF_SPHERICAL_SWITCH CDRF_WIDEST CDRF_SMALLEST;
    closest_point, lapidary_closest_point: CLOSEST_POINT_REGULARISATION CLOSEST_POINT_SLIVER;
    convex_trace, lapidary_convex_trace: CONVEX_TRACE_NONE CONVEX_TRACE_FAR;
    bounds_trace, lapidary_bounds_trace: BOUNDS_TRACE_NONE BOUNDS_TRACE_PARALLEL;
    screen_trace, lapidary_screen_trace: SCREEN_TRACE_FAR SCREEN_TRACE_PARALLEL;
    diffusion, lapidary_diffusion: DIFFUSION_MILNE DIFFUSION_THINNEST DIFFUSION_LEAST_DEPTH DIFFUSION_LEAST_DISTANCE DIFFUSION_LEAST_WEIGHT DIFFUSION_LEAST_VARIANCE DIFFUSION_LEAST_STEP DIFFUSION_STEEPEST
        DIFFUSION_DENSEST DIFFUSION_GRAZING DIFFUSION_OPAQUE DIFFUSION_NEAREST DIFFUSION_OUTERMOST DIFFUSION_LEAST_GAMMA DIFFUSION_DEEPEST DIFFUSION_THINNEST_FACE DIFFUSION_STEEP DIFFUSION_FARTHEST;
    half_space, lapidary_half_space: HALF_SPACE_GRAZING HALF_SPACE_NO_LIGHT HALF_SPACE_LEAST_TURNED HALF_SPACE_DENSEST HALF_SPACE_LAST_EDGE;
    convex_walk, lapidary_convex_walk: CONVEX_WALK_FACE CONVEX_WALK_SHIFT CONVEX_WALK_PLACE CONVEX_WALK_MORE
        CONVEX_WALK_STEPS CONVEX_WALK_PARALLEL;
    curvature, lapidary_curvature: CURVATURE_SMALLEST CURVATURE_EDGE_ON CURVATURE_ZENITH;
    curved_triangle, lapidary_curved_triangle: CURVED_TRIANGLE_GRAZING CURVED_TRIANGLE_CANCELLED;
    dispersion, lapidary_dispersion: DISPERSION_DIAMOND DISPERSION_CORUNDUM DISPERSION_QUARTZ DISPERSION_CROWN_GLASS
        DISPERSION_CUBIC_ZIRCONIA DISPERSION_RUTILE DISPERSION_STRONTIUM_TITANATE DISPERSION_LINE_B DISPERSION_LINE_C DISPERSION_LINE_D DISPERSION_LINE_F DISPERSION_LINE_G
        DISPERSION_RED DISPERSION_GREEN DISPERSION_BLUE DISPERSION_PAPER_GREEN DISPERSION_PAPER_BLUE
        DISPERSION_PAPER_EPSILON DISPERSION_PAPER_CHORD DISPERSION_CRITICAL;
    microfacet, lapidary_microfacet: MICROFACET_SMOOTHEST MICROFACET_GRAZING MICROFACET_OPPOSITE;
    optical_path, lapidary_optical_path: OPTICAL_PATH_UNREACHED OPTICAL_PATH_DARKEST OPTICAL_PATH_DEEPEST;
    proxy_geometry, lapidary_proxy_geometry: PROXY_GEOMETRY_PARALLEL;
    random_walk, lapidary_random_walk: RANDOM_WALK_SCATTERED RANDOM_WALK_ABSORBED RANDOM_WALK_PASSED RANDOM_WALK_THINNEST RANDOM_WALK_DENSEST
        RANDOM_WALK_STRAIGHTEST;
    reflective_shadow_map, lapidary_reflective_shadow_map: REFLECTIVE_SHADOW_MAP_NOTHING;
    split_sum, lapidary_split_sum: SPLIT_SUM_SMOOTHEST SPLIT_SUM_GRAZING SPLIT_SUM_LEAST SPLIT_SUM_STAYING;
    texture_diffusion, lapidary_texture_diffusion: TEXTURE_DIFFUSION_REACH TEXTURE_DIFFUSION_LEAST_RATIO
        TEXTURE_DIFFUSION_NARROWEST TEXTURE_DIFFUSION_SMALLEST;
    veins, lapidary_veins: VEINS_FARTHEST VEINS_NARROWEST VEINS_WIDEST VEINS_MOST_OCTAVES;
    voxelization, lapidary_voxelization: VOXELIZATION_LATTICE VOXELIZATION_REACH VOXELIZATION_MARGIN VOXELIZATION_STEEPEST;
}

/// Appends the words of a global expression, as naga has evaluated it.
fn words(module: &Module, expression: Handle<Expression>, out: &mut Vec<u32>) {
    match &module.global_expressions[expression] {
        Expression::Literal(Literal::F32(value)) => out.push(value.to_bits()),
        Expression::Literal(Literal::U32(value)) => out.push(*value),
        Expression::Literal(Literal::I32(value)) => out.push(value.cast_unsigned()),
        Expression::Literal(Literal::Bool(value)) => out.push(u32::from(*value)),
        Expression::Constant(constant) => words(module, module.constants[*constant].init, out),
        Expression::Compose { components, .. } => components.iter().for_each(|part| words(module, *part, out)),
        Expression::Splat { size, value } => (0..*size as usize).for_each(|_| words(module, *value, out)),
        other => panic!("{other:?}: teach this test to read it"),
    }
}

/// Lists the consts of a module's text that differ from the mirror's or are missing there.
fn differences(name: &str, source: &str) -> Vec<String> {
    let (module, _) = dispatch::parse(source, name).unwrap_or_else(|error| panic!("{error}"));
    let mirrors = mirrors();
    let mut faults = Vec::new();
    for (_, constant) in module.constants.iter() {
        let Some(constant_name) = constant.name.as_deref() else { continue };
        let mut found = Vec::new();
        words(&module, constant.init, &mut found);
        match mirrors.iter().find(|((module, constant), _)| (*module, *constant) == (name, constant_name)) {
            None => faults.push(format!("{constant_name}: no twin; add it to this test's list and to the mirror")),
            Some((_, wanted)) if *wanted != found => {
                faults.push(format!("{constant_name}: {found:x?}, the mirror's {wanted:x?}"))
            }
            Some(_) => {}
        }
    }
    let has = |wanted: &str| module.constants.iter().any(|(_, constant)| constant.name.as_deref() == Some(wanted));
    for (_, constant) in mirrors.keys().filter(|(module, constant)| *module == name && !has(constant)) {
        faults.push(format!("{constant}: in the mirror alone"));
    }
    faults
}

#[test]
fn every_const_has_its_mirrors_value() {
    let mut count = 0;
    for module in cookbook::modules() {
        let faults = differences(module.name, module.whole);
        assert!(faults.is_empty(), "wgsl/{}.wgsl:\n{}", module.name, faults.join("\n"));
        count += module.whole.lines().filter(|line| line.starts_with("const ")).count();
    }
    assert_eq!(count, mirrors().len());
}

#[test]
fn a_changed_const_is_noticed_though_no_function_reads_it() {
    let dispersion = cookbook::module("dispersion").expect("a module").source;
    for (before, after, name) in [
        ("vec3f(0.3306f, 4.3356f, 0.0f)", "vec3f(0.3306f, 4.3357f, 0.0f)", "DISPERSION_DIAMOND"),
        ("DISPERSION_LINE_G: f32 = 430.8f", "DISPERSION_LINE_G: f32 = 430.9f", "DISPERSION_LINE_G"),
        ("DISPERSION_PAPER_EPSILON: f32 = 2e-4f", "DISPERSION_PAPER_EPSILON: f32 = 3e-4f", "DISPERSION_PAPER_EPSILON"),
        ("const DISPERSION_LINE_B:", "const DISPERSION_LINE_X:", "DISPERSION_LINE_X"),
    ] {
        let changed = dispersion.replacen(before, after, 1);
        assert_ne!(changed, dispersion, "{before}");
        let faults = differences("dispersion", &changed);
        assert!(faults.iter().any(|fault| fault.starts_with(name)), "{name}: {faults:?}");
    }
}

/// Compares with measurements by others that do not rest on these coefficients: gemmologists'
/// tables of the refractive index at D and of dispersion, n_G - n_B (Webster, "Gems"; Read,
/// "Gemmology": to two digits, and of the ordinary ray), and Schott's catalogue for the glass.
#[test]
fn materials_have_the_published_index_and_dispersion() {
    use lapidary_dispersion as mirror;
    let index_at = |material, line: f64| f64::from(mirror::sellmeier(material, line as f32));
    for (name, material, index, spread) in [
        ("diamond", mirror::DISPERSION_DIAMOND, (2.417, 0.002), (0.044, 0.001)),
        ("corundum", mirror::DISPERSION_CORUNDUM, (1.769, 0.002), (0.018, 0.001)),
        ("quartz", mirror::DISPERSION_QUARTZ, (1.544, 0.001), (0.013, 0.001)),
        ("cubic zirconia", mirror::DISPERSION_CUBIC_ZIRCONIA, (2.165, 0.015), (0.060, 0.006)),
    ] {
        // Fraunhofer's lines themselves, in nm.
        let [b, d, g] = [686.72, 589.3, 430.79].map(|line| index_at(material, line));
        println!("{name}: n_D {d:.4}, n_G - n_B {:.4}", g - b);
        assert!((d - index.0).abs() < index.1, "{name}: n_D {d}, published {index:?}");
        assert!((g - b - spread.0).abs() < spread.1, "{name}: n_G - n_B {}, published {spread:?}", g - b);
    }
    let [d, f, c] = [587.562, 486.134, 656.281].map(|line| index_at(mirror::DISPERSION_CROWN_GLASS, line));
    assert!((d - 1.51680).abs() < 2e-5, "N-BK7: n_d {d}, in the catalogue 1.51680");
    let abbe = (d - 1.0) / (f - c);
    assert!((abbe - 64.17).abs() < 0.03, "N-BK7: V_d {abbe}, in the catalogue 64.17");
    for (line, name, published) in [
        (mirror::DISPERSION_LINE_B, "B", 686.719),
        (mirror::DISPERSION_LINE_C, "C", 656.281),
        (mirror::DISPERSION_LINE_D, "d", 587.562),
        (mirror::DISPERSION_LINE_F, "F", 486.134),
        (mirror::DISPERSION_LINE_G, "G", 430.790),
    ] {
        assert!((f64::from(line) - published).abs() < 0.05, "{name}: {line} nm, {published} nm");
    }
}
