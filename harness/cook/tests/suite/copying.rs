//! `cook copy`: modules, recipes and functions for another program.

use lapidary_assay::dispatch;
use lapidary_testing::program::{folder, succeeds};

#[test]
fn copied_modules_compile_as_one_file() {
    let folder = folder();
    succeeds(folder.path(), &["copy", "refraction", "fresnel", "--out", "optics.wgsl"]);
    let text = std::fs::read_to_string(folder.path().join("optics.wgsl")).expect("the output");
    dispatch::parse(&text, "optics.wgsl").unwrap_or_else(|error| panic!("{error}"));
    assert!(text.contains("fn refraction_refract(") && text.contains("fn fresnel_dielectric("));
    // Without --out, the same text goes to stdout.
    assert_eq!(succeeds(folder.path(), &["copy", "refraction", "fresnel"]).stdout, text);
}

#[test]
fn a_copied_recipe_holds_its_modules() {
    for recipe in lapidary_wgsl::RECIPES {
        let text = succeeds(folder().path(), &["copy", recipe.name]).stdout;
        let (ir, _) = dispatch::parse(&text, recipe.name).unwrap_or_else(|error| panic!("{error}"));
        assert!(!ir.entry_points.is_empty(), "{}", recipe.name);
    }
}

/// A function comes with what it needs, and with nothing else.
#[test]
fn a_copied_function_holds_what_it_needs() {
    let text = succeeds(folder().path(), &["copy", "refraction::refract"]).stdout;
    assert!(text.starts_with("// refraction: ") && text.contains("struct RefractionHit"), "{text}");
    assert!(text.contains("// Accuracy: ") && !text.contains("fn refraction_radicand("), "{text}");
    dispatch::parse(&text, "refract.wgsl").unwrap_or_else(|error| panic!("{error}"));
    let naive = succeeds(folder().path(), &["copy", "refraction::refract_naive"]).stdout;
    dispatch::parse(&naive, "naive.wgsl").unwrap_or_else(|error| panic!("{error}"));
    assert!(naive.contains("fn refraction_refract_naive("), "{naive}");
    // Of a recipe too.
    let entry = succeeds(folder().path(), &["copy", "gem::gem_vertex", "--effects", "proxy_geometry"]).stdout;
    let (ir, _) = dispatch::parse(&entry, "gem_vertex.wgsl").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(ir.entry_points.len(), 1);
    assert!(!entry.contains("// requires:") && !entry.contains("// screen: "), "{entry}");
}

/// A function that no entry point calls, or none under these settings, comes all the same, also by its short name.
#[test]
fn any_function_of_a_recipe_can_be_copied_under_any_settings() {
    let folder = folder();
    for (name, options, holds) in [
        ("gem_walk::proxy_geometry_image", &[][..], "fn proxy_geometry_image("),
        ("cdrf_shading::fresnel_schlick", &["--set", "SHADOW_FORM=2"], "fn fresnel_schlick("),
        ("gem_walk::dispersion_sellmeier", &["--set", "BOUNCES=8,DISPERSION_FORM=1"], "fn dispersion_sellmeier("),
        ("gem_walk::dispersion_sellmeier", &["--effects", "convex_trace"], "fn dispersion_sellmeier("),
        ("voxelize::words", &[], "fn voxelize_words("),
    ] {
        let text = succeeds(folder.path(), &[&["copy", name], options].concat()).stdout;
        assert!(text.contains(holds), "{name} {options:?}: {text}");
        dispatch::parse(&text, name).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// A recipe's function takes a host's own eye, group and vertex stage, and needs nothing else of the recipe.
#[test]
fn a_copied_function_fits_a_host_of_its_own() {
    let folder = folder();
    let copy = |more: &[&str]| {
        let usual = ["copy", "gem_walk::gem_radiance", "--effects", "convex_trace,dispersion"];
        succeeds(folder.path(), &[&usual, more].concat()).stdout
    };
    let text = copy(&["--set", "BOUNCES=8,DISPERSION_FORM=1", "--private", "view", "--group", "2"]);
    assert!(text.contains("const BOUNCES: u32 = 8u;") && !text.contains("fn gem_vertex("), "{text}");
    let host = "
struct Eye {
    position: vec3f,
}

@group(0) @binding(0) var<uniform> eye: Eye;

@fragment
fn main(
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    @location(2) @interpolate(flat) face: u32,
) -> @location(0) vec4f {
    view.eye = eye.position;
    let radiance = gem_radiance(GemVertex(clip, position, normal, face), true);
    return vec4f(radiance.surface + radiance.inside, 1.0f);
}
";
    let (ir, _) = dispatch::parse(&(text.clone() + host), "host.wgsl").unwrap_or_else(|error| panic!("{error}"));
    let mut bound: Vec<(u32, u32, &str)> = ir
        .global_variables
        .iter()
        .filter_map(|(_, variable)| Some((variable.binding?, variable.name.as_deref()?)))
        .map(|(binding, name)| (binding.group, binding.binding, name))
        .collect();
    bound.sort_unstable();
    let expected = [(0, 0, "eye"), (2, 0, "material"), (2, 1, "planes"), (2, 2, "facet_map"), (2, 3, "stone")];
    assert_eq!(bound, expected);
    // A preprocessor's name stands where the number does.
    let named = copy(&["--private", "view", "--group", "#{MATERIAL}", "--set", "BOUNCES=8,DISPERSION_FORM=1"]);
    assert_eq!(named.replace("#{MATERIAL}", "2"), text);
}

#[test]
fn functions_of_several_modules_are_copied_together() {
    let text =
        succeeds(folder().path(), &["copy", "fresnel::normal_incidence", "refraction", "fresnel::schlick"]).stdout;
    let (ir, _) = dispatch::parse(&text, "optics.wgsl").unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<&str> = ir.functions.iter().filter_map(|(_, function)| function.name.as_deref()).collect();
    for name in ["fresnel_schlick", "fresnel_normal_incidence", "refraction_reflect", "refraction_refract"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(!names.contains(&"fresnel_dielectric"), "{names:?}");
}

#[test]
fn copies_are_written_in_other_languages() {
    let folder = folder();
    for (name, language, holds) in [
        ("refraction", "hlsl", "refraction_refract"),
        ("refraction", "msl", "refraction_refract"),
        ("refraction::refract", "glsl", "refraction_refract"),
        ("refraction::refract", "glsl-es", "refraction_refract"),
        ("refraction::refract", "wgsl", "refraction_refract"),
        ("voxelization", "glsl", "voxelization_column"),
        ("display::display_fragment", "glsl-es", "display_fragment"),
        ("gem", "hlsl", "refraction_refract"),
        ("gem", "msl", "refraction_refract"),
    ] {
        let text = succeeds(folder.path(), &["copy", name, "--to", language]).stdout;
        assert!(text.contains(holds), "{name} in {language}");
    }
    for name in ["refraction::refract", "gem"] {
        succeeds(folder.path(), &["copy", name, "--to", "spirv", "--out", "out.spv"]);
        let bytes = std::fs::read(folder.path().join("out.spv")).expect("the output");
        // SPIR-V's magic number, little endian.
        assert_eq!(bytes[..4], [0x03, 0x02, 0x23, 0x07], "{name}");
    }
}
