//! Tests of the specialisation of small shaders and of the gem recipe.

use super::{SpecialiseError, specialise};
use crate as dispatch;
use naga::{Module, TypeInner, back};

/// Declarations of every small shader: a texture and a buffer that only some branches read, and an
/// output buffer.
const COMMON: &str = "
override A: bool = true;
override B: bool = true;
override N: u32 = 0;
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var<storage, read> table: array<f32>;
@group(0) @binding(2) var<storage, read_write> result: array<f32>;
fn texel() -> f32 { return textureLoad(picture, vec2u(), 0).x; }
fn is_bright(x: f32) -> bool { return texel() > x; }
";

/// Specialises a shader whose entry point has `body`, and returns its module and its WGSL. Also
/// writes SPIR-V.
fn special(declarations: &str, body: &str, constants: &[(&str, f64)]) -> (Module, String) {
    let source = format!("{COMMON}{declarations}\n@compute @workgroup_size(1) fn main() {{ {body} }}");
    special_module(&source, constants, &["main"])
}

fn special_module(source: &str, constants: &[(&str, f64)], entry_points: &[&str]) -> (Module, String) {
    let (module, _) = dispatch::parse(source, "test").unwrap_or_else(|error| panic!("{error}"));
    let (module, info) = specialise(module, constants, entry_points).unwrap_or_else(|error| panic!("{error}"));
    back::spv::write_vec(&module, &info, &back::spv::Options::default(), None).expect("writes SPIR-V");
    let text = back::wgsl::write_string(&module, &info, back::wgsl::WriterFlags::empty()).expect("writes WGSL");
    dispatch::parse(&text, "specialised").unwrap_or_else(|error| panic!("{error}\n{text}"));
    (module, text)
}

fn functions(module: &Module) -> Vec<&str> {
    module.functions.iter().map(|(_, function)| function.name.as_deref().unwrap_or_default()).collect()
}

fn globals(module: &Module) -> Vec<&str> {
    module.global_variables.iter().map(|(_, global)| global.name.as_deref().unwrap_or_default()).collect()
}

#[test]
fn a_texture_of_a_dead_branch_goes_with_the_functions_that_read_it() {
    let body = "result[0] = 1.0; if (A) { result[1] = texel(); }";
    let (module, _) = special("", body, &[("A", 1.0)]);
    assert_eq!(globals(&module), ["picture", "result"]);
    assert_eq!(functions(&module), ["texel"]);
    let (module, text) = special("", body, &[("A", 0.0)]);
    assert_eq!(globals(&module), ["result"]);
    assert!(module.functions.is_empty() && module.constants.is_empty() && module.overrides.is_empty());
    assert!(!text.contains("if"), "{text}");
}

#[test]
fn the_other_arm_is_taken_where_the_condition_is_false() {
    let body = "if (A) { result[0] = texel(); } else if (B) { result[0] = table[0]; } else { result[0] = 3.0; }";
    assert_eq!(globals(&special("", body, &[("A", 1.0)]).0), ["picture", "result"]);
    assert_eq!(globals(&special("", body, &[("A", 0.0)]).0), ["table", "result"]);
    let (module, text) = special("", body, &[("A", 0.0), ("B", 0.0)]);
    assert_eq!(globals(&module), ["result"]);
    assert!(text.contains("result[0] = 3f") && !text.contains("if"), "{text}");
}

#[test]
fn and_is_decided_by_a_false_side() {
    for body in ["if (A && is_bright(2.0)) { result[0] = table[0]; }", "if (A & B) { result[0] = table[0] + texel(); }"]
    {
        let (module, text) = special("", body, &[("A", 0.0)]);
        assert!(globals(&module).is_empty() && module.functions.is_empty(), "{text}");
    }
    let body = "if (A && B) { result[0] = texel(); } else { result[0] = table[0]; }";
    assert_eq!(globals(&special("", body, &[]).0), ["picture", "result"]);
    assert_eq!(globals(&special("", body, &[("B", 0.0)]).0), ["table", "result"]);
    // A true side leaves the decision to the other side.
    let (module, text) = special("", "if (A && is_bright(2.0)) { result[0] = 1.0; }", &[]);
    assert_eq!(functions(&module), ["texel", "is_bright"]);
    assert!(!text.contains("    var "), "{text}");
}

/// A false right side makes the condition false, but the left side is still evaluated if it has an
/// effect.
#[test]
fn and_is_decided_by_a_false_right_side() {
    let count = "fn count() -> bool { result[9] += 1.0; return result[9] > 2.0; }";
    let (module, text) = special(count, "if (count() && A) { result[0] = texel(); }", &[("A", 0.0)]);
    assert_eq!((globals(&module), functions(&module)), (vec!["result"], vec!["count"]), "{text}");
    assert!(!text.contains("if"), "{text}");
    let (module, text) = special("", "if (is_bright(1.0) && A) { result[0] = texel(); }", &[("A", 0.0)]);
    assert!(globals(&module).is_empty(), "{text}");
}

#[test]
fn or_is_decided_by_a_true_side() {
    let body = "if (A || is_bright(2.0)) { result[0] = 1.0; } else { result[0] = table[0]; }";
    assert_eq!(globals(&special("", body, &[]).0), ["result"]);
    assert_eq!(globals(&special("", body, &[("A", 0.0)]).0), ["picture", "table", "result"]);
    let turned = "if (is_bright(2.0) || A) { result[0] = 1.0; } else { result[0] = table[0]; }";
    assert_eq!(globals(&special("", turned, &[]).0), ["result"]);
    let both = "if ((A || is_bright(2.0)) && !(B || is_bright(3.0))) { result[0] = table[0]; }";
    assert!(globals(&special("", both, &[("A", 0.0)]).0).is_empty());
}

#[test]
fn nested_branches_fold_inside_those_that_stay() {
    let body = "
        let x = table[0];
        if (x > 0.0) { if (A) { if (B) { result[0] = 1.0; } else { result[0] = texel(); } } else { result[0] = x; } }";
    let (module, text) = special("", body, &[]);
    assert_eq!(globals(&module), ["table", "result"]);
    assert_eq!(text.matches("if").count(), 1, "{text}");
    assert_eq!(globals(&special("", body, &[("B", 0.0)]).0), ["picture", "table", "result"]);
}

/// Code after a return that is now certain is unreachable.
#[test]
fn code_behind_a_certain_return_goes() {
    let choose = "fn choose() -> f32 { if (A) { return 1.0; } return texel(); }";
    let (module, text) = special(choose, "result[0] = choose();", &[]);
    assert_eq!(globals(&module), ["result"], "{text}");
    let both =
        "fn choose() -> f32 { if (A) { if (table[0] > 0.0) { return 1.0; } else { return 2.0; } } return texel(); }";
    assert_eq!(globals(&special(both, "result[0] = choose();", &[]).0), ["table", "result"]);
}

#[test]
fn an_argument_that_every_call_gives_alike_becomes_the_constant() {
    let declarations = "
        fn inner(x: f32, bright: bool) -> f32 { if (bright) { return texel() * x; } return x; }
        fn outer(bright: bool, x: f32) -> f32 { return inner(x, bright) + inner(2.0 * x, bright); }";
    let body = "result[0] = outer(A, table[0]); result[1] = outer(A, 7.0);";
    let (module, text) = special(declarations, body, &[("A", 0.0)]);
    assert_eq!(globals(&module), ["table", "result"]);
    assert!(text.contains("fn inner(x: f32) -> f32") && text.contains("fn outer(x_1: f32)"), "{text}");
    assert_eq!(globals(&special(declarations, body, &[]).0), ["picture", "table", "result"]);
    // One call with a different value keeps the argument.
    let body = "result[0] = outer(A, table[0]); result[1] = outer(true, 7.0);";
    assert_eq!(globals(&special(declarations, body, &[("A", 0.0)]).0), ["picture", "table", "result"]);
    // A dead call does not count.
    let body = "result[0] = outer(A, table[0]); if (A) { result[1] = outer(true, 7.0); }";
    assert_eq!(globals(&special(declarations, body, &[("A", 0.0)]).0), ["table", "result"]);
}

#[test]
fn a_composite_argument_is_propagated_to_the_bit() {
    let declarations = "fn scale(by: vec2f, x: f32) -> f32 { if (by.x > 0.0) { return texel(); } return by.y * x; }";
    let body = "result[0] = scale(vec2f(-1.0, 3.0), table[0]); result[1] = scale(vec2f(-1.0, 3.0), table[1]);";
    let (module, text) = special(declarations, body, &[]);
    assert_eq!(globals(&module), ["table", "result"], "{text}");
    let body = "result[0] = scale(vec2f(0.0, 3.0), table[0]); result[1] = scale(vec2f(-0.0, 3.0), table[1]);";
    let (_, text) = special(declarations, body, &[]);
    assert!(text.contains("by: vec2<f32>"), "{text}");
}

/// If an argument is no longer read, its value is not computed.
#[test]
fn an_argument_that_is_not_read_is_not_passed() {
    let declarations = "fn either(lit: f32, x: f32) -> f32 { if (A) { return lit; } return x; }";
    let (module, text) = special(declarations, "result[0] = either(texel(), table[0]);", &[("A", 0.0)]);
    assert_eq!((globals(&module), functions(&module)), (vec!["table", "result"], vec!["either"]), "{text}");
}

#[test]
fn a_loop_of_no_rounds_goes() {
    for body in [
        "for (var i = 0u; i < N; i++) { result[i] = texel(); }",
        "var i = 3u; while (i < N && is_bright(1.0)) { result[i] = texel(); i++; }",
        "while (!A) { result[0] = texel(); }",
        "loop { if (A) { break; } result[0] = texel(); }",
        "for (var i = 0u; i < 4u; i++) { if (i >= N) { break; } result[i] = texel(); }",
        "for (var i = 0u; i < 2u; i++) { for (var j = N; j > 0u; j--) { result[i] = texel(); } }",
    ] {
        let (module, text) = special("", body, &[]);
        assert!(globals(&module).is_empty() && !text.contains("loop"), "{text}");
    }
    let (module, text) = special("", "for (var i = 0u; i < N; i++) { result[i] = texel(); }", &[("N", 2.0)]);
    assert_eq!(globals(&module), ["picture", "result"]);
    assert!(text.contains("loop") && text.contains("2u"), "{text}");
}

/// A value known before a loop is unknown in the loop if the loop writes the variable.
#[test]
fn a_variable_that_a_loop_writes_is_not_constant() {
    let body = "
        var first = true; var steady = false;
        for (var i = 0u; i < 4u; i++) { if (first) { result[i] = 1.0; } else { result[i] = table[i]; } first = false;
            if (steady) { result[i] = texel(); } }";
    let (module, text) = special("", body, &[]);
    assert_eq!(globals(&module), ["table", "result"], "{text}");
    assert!(text.contains("var first") && !text.contains("steady"), "{text}");
}

/// An arm that returns says nothing about the code after the branch.
#[test]
fn an_arm_that_returns_does_not_count() {
    let body = "
        var bright = true; if (table[0] > 0.0) { bright = false; result[0] = 1.0; return; }
        if (bright) { result[1] = texel(); }";
    let (module, text) = special("", body, &[]);
    assert_eq!((globals(&module), text.matches("if").count()), (vec!["picture", "table", "result"], 1), "{text}");
    // A value computed in either arm is not available there.
    let body = "var x = 0.0; if (table[0] > 0.0) { x = table[1]; } else { return; } result[0] = x;";
    let (_, text) = special("", body, &[]);
    assert!(text.contains("var x"), "{text}");
}

#[test]
fn a_variable_that_a_case_writes_is_not_constant() {
    for body in [
        "switch (u32(table[0])) { case 1u: { bright = true; } default: {} }",
        "switch (N) { default: { if (table[0] > 0.0) { bright = true; break; } result[0] = 2.0; } }",
    ] {
        let body = format!("var bright = false; {body} if (bright) {{ result[1] = texel(); }}");
        assert_eq!(globals(&special("", &body, &[]).0), ["picture", "table", "result"]);
    }
}

#[test]
fn a_variable_that_takes_an_atomics_result_is_not_constant() {
    let count = "@group(0) @binding(3) var<storage, read_write> count: atomic<u32>;";
    let body = "var seen = 3u; seen = atomicAdd(&count, 1u); if (seen != 3u) { result[0] = texel(); }";
    assert_eq!(globals(&special(count, body, &[]).0), ["picture", "result", "count"]);
    let body = "
        var seen = 3u; if (table[0] > 0.0) { seen = atomicAdd(&count, 1u); } else { return; }
        result[seen] = 1.0;";
    assert_eq!(globals(&special(count, body, &[]).0), ["table", "result", "count"]);
}

/// A loop with an inner `break` or `continue` stays, even if it runs only once.
#[test]
fn a_loop_that_is_left_from_within_stays() {
    for (body, word) in [
        ("loop { if (table[0] > 0.0) { break; } result[0] = 1.0; break; }", "break"),
        ("for (var i = 0u; i < 4u; i++) { if (table[i] > 0.0) { continue; } result[i] = 1.0; break; }", "continue"),
        ("for (var i = 0u; i < 4u; i++) { if (table[i] > 0.0) { continue; } result[i] = 1.0; }", "continue"),
    ] {
        let (_, text) = special("", body, &[]);
        assert!(text.contains("loop") && text.contains(word), "{text}");
    }
    let (_, text) = special("", "loop { result[0] = table[0]; if (A) { break; } result[1] = 1.0; }", &[]);
    assert!(text.contains("result[0]") && !text.contains("loop") && !text.contains("result[1]"), "{text}");
}

#[test]
fn a_variable_written_through_a_pointer_is_not_constant() {
    let declarations = "fn assign(to: ptr<function, bool>) { *to = table[0] > 0.0; }";
    let body = "var bright = false; assign(&bright); if (bright) { result[0] = texel(); }";
    assert_eq!(globals(&special(declarations, body, &[]).0), ["picture", "table", "result"]);
    let body = "var bright = false; let p = &bright; *p = table[0] > 0.0; if (bright) { result[0] = texel(); }";
    assert_eq!(globals(&special("", body, &[]).0), ["picture", "table", "result"]);
}

#[test]
fn paths_that_agree_leave_a_variable_known() {
    let body = "
        var mode: u32; if (table[0] > 0.0) { mode = 2u; } else { mode = 1u + u32(A); }
        if (mode == 3u) { result[0] = texel(); }";
    assert_eq!(globals(&special("", body, &[]).0), Vec::<&str>::new());
    let (module, _) = special("", body, &[("A", 0.0)]);
    assert_eq!(globals(&module), ["picture", "table", "result"]);
}

#[test]
fn a_switch_becomes_the_case_that_is_taken() {
    let body = "
        switch (N) {
            case 0u: { result[0] = 1.0; }
            case 1u, 2u: { result[0] = texel(); if (table[0] > 0.0) { break; } result[1] = 4.0; }
            case 3u: { result[0] = 5.0; break; }
            default: { result[0] = table[0]; }
        }
        result[2] = 1.0;";
    let expected = [(0, vec!["result"]), (1, vec!["picture", "table", "result"]), (3, vec!["result"])];
    for (n, expected) in expected.into_iter().chain([(2, vec!["picture", "table", "result"])]) {
        let (module, text) = special("", body, &[("N", f64::from(n))]);
        assert_eq!(globals(&module), expected, "{text}");
        assert!(text.contains("result[2] = 1f"), "{text}");
        // Only an inner `break` needs the switch.
        assert_eq!(text.contains("switch"), n == 1 || n == 2, "{text}");
    }
    assert_eq!(globals(&special("", body, &[("N", 9.0)]).0), ["table", "result"]);
}

#[test]
fn a_switch_on_what_is_not_known_keeps_its_cases_and_folds_them() {
    let body = "
        switch (u32(table[0])) { case 1u: { if (A) { return; } result[0] = texel(); } default: { result[0] = 2.0; } }";
    let (module, text) = special("", body, &[]);
    assert_eq!(globals(&module), ["table", "result"]);
    assert!(text.contains("switch"), "{text}");
}

#[test]
fn a_select_on_a_constant_is_the_operand_it_takes() {
    let body = "let x = select(texel(), table[0], A); result[0] = x + select(x, 2.0 * x, B);";
    let (module, text) = special("", body, &[]);
    assert_eq!(globals(&module), ["table", "result"]);
    assert!(!text.contains("select"), "{text}");
    assert_eq!(globals(&special("", body, &[("A", 0.0)]).0), ["picture", "result"]);
}

/// A value prepared only for a removed branch is not computed, unless the computation has an
/// effect.
#[test]
fn what_only_a_dead_branch_uses_goes_too() {
    let declarations = "
        fn noted_first(x: f32) -> f32 { result[7] = x; return x; }
        fn noted(x: f32) -> f32 { return noted_first(x) + 1.0; }";
    let body = "
        let lit = texel(); var sum = 0.0;
        for (var i = 0u; i < 4u; i++) { if (table[i] < 0.0) { break; } sum += table[i]; }
        let seen = noted(3.0); result[0] = 1.0; if (A) { result[0] = lit + sum + seen; }";
    let (module, text) = special(declarations, body, &[("A", 0.0)]);
    assert_eq!(globals(&module), ["result"], "{text}");
    assert_eq!(functions(&module), ["noted_first", "noted"]);
    assert!(!text.contains("loop") && !text.contains("    var "), "{text}");
    assert_eq!(globals(&special(declarations, body, &[]).0), ["picture", "table", "result"]);
}

/// Calls with effects stay in their order, whether or not their results are used.
#[test]
fn calls_keep_their_order() {
    let declarations = "
        fn one() -> f32 { result[0] = result[1]; return 1.0; }
        fn two() { result[1] = 2.0; }
        fn three(x: f32) -> f32 { result[2] = result[0] + x; return x; }";
    let (_, text) = special(declarations, "let x = one(); two(); if (A) { one(); } _ = three(x); two();", &[]);
    let main = &text[text.find("fn main").expect("main")..];
    let calls: Vec<&str> = ["one()", "two()", "three("]
        .iter()
        .flat_map(|name| main.match_indices(name))
        .collect::<std::collections::BTreeMap<_, _>>()
        .into_values()
        .collect();
    assert_eq!(calls, ["one()", "two()", "one()", "three(", "two()"], "{text}");
}

/// The device rounds a sum of floats, even if both terms are known.
#[test]
fn floats_are_not_computed_here() {
    let declarations = "fn sum(a: f32, b: f32) -> f32 { return a + b; }";
    let (_, text) = special(declarations, "result[0] = sum(0.1, 0.2);", &[]);
    assert!(text.contains("0.1f + 0.2f"), "{text}");
}

/// A sum of integers wraps, as on the device.
#[test]
fn integers_are_computed_as_on_the_device() {
    let declarations = "fn sum(a: i32, b: i32) -> i32 { return a + b; }";
    let (_, text) = special(declarations, "result[0] = f32(sum(2147483647, 1));", &[]);
    assert!(text.contains("return i32(-2147483648)"), "{text}");
}

#[test]
fn the_other_entry_points_go() {
    let source = format!(
        "{COMMON}
        override UNSET: f32;
        @compute @workgroup_size(1) fn first() {{ result[0] = texel(); }}
        @compute @workgroup_size(1) fn second() {{ result[0] = table[0] * UNSET; }}"
    );
    // An override needs no value if no remaining code uses it.
    let (module, _) = special_module(&source, &[], &["first"]);
    assert_eq!(globals(&module), ["picture", "result"]);
    let (module, _) = special_module(&source, &[("UNSET", 2.0)], &["first", "second"]);
    assert_eq!(module.entry_points.len(), 2);
    let (module, _) = dispatch::parse(&source, "test").expect("valid");
    let fault = |constants, entry_points: &[&str]| specialise(module.clone(), constants, entry_points).map(|_| ());
    assert!(matches!(fault(&[], &["second"]), Err(SpecialiseError::Override(_))));
    assert!(matches!(fault(&[("NONE", 1.0)], &["first"]), Err(SpecialiseError::Override(_))));
    let error = fault(&[], &["third"]).expect_err("there is none");
    assert_eq!(error.to_string(), "no entry point `third`; the shader has `first`, `second`");
}

#[test]
fn an_override_as_an_arrays_length_is_refused() {
    let source = "
        override SIZE: u32 = 4;
        var<workgroup> shared_row: array<f32, SIZE>;
        @compute @workgroup_size(1) fn main() { shared_row[0] = 1.0; workgroupBarrier(); }";
    let (module, _) = dispatch::parse(source, "test").expect("valid");
    let error = specialise(module, &[], &["main"]).map(|_| ()).expect_err("naga cannot write it");
    assert!(error.to_string().contains("`SIZE`"), "{error}");
}

#[test]
fn the_gem_without_its_inside_is_a_mirror() {
    let source = lapidary_wgsl::recipe_source("gem");
    let entry_points = ["gem_vertex", "gem_fragment"];
    let (whole, _) = special_module(&source, &[("EFFECT_ENVIRONMENT_MAP", 1.0)], &entry_points);
    assert!(functions(&whole).iter().any(|name| name.starts_with("closest_point_")));
    assert!(globals(&whole).contains(&"environment_map"));
    let (module, text) = special_module(&source, &[("EFFECT_PROXY_GEOMETRY", 0.0)], &entry_points);
    let left = functions(&module);
    for gone in ["closest_point_", "refraction_refract", "gem_centre", "mesh_normal", "gem_internal"] {
        assert!(!left.iter().any(|name| name.starts_with(gone)), "`{gone}` in {left:?}");
    }
    for gone in ["proxy_geometry_intersect", "proxy_geometry_cell", "proxy_geometry_facet_normal"] {
        assert!(!left.contains(&gone), "`{gone}` in {left:?}");
    }
    assert!(!globals(&module).contains(&"environment_map") && !globals(&module).contains(&"normals"), "{text}");
    assert!(module.overrides.is_empty());
    assert!(!text.contains("EFFECT_"), "{text}");
}

const STAGES: &str = "
override A: bool = true;
@group(0) @binding(0) var<storage, read> table: array<vec3f>;
struct Between {
    @builtin(position) clip: vec4f,
    @location(0) first: f32,
    @location(1) second: vec3f,
    @location(2) third: f32,
}
fn third_of(between: Between) -> f32 { return between.third; }
@vertex fn vertex(@builtin(vertex_index) i: u32) -> Between {
    return Between(vec4f(0.0), f32(i), table[i], 2.0 * f32(i));
}
@fragment fn fragment(between: Between) -> @location(0) vec4f {
    var sum = third_of(between);
    if (A) { sum += between.second.x; }
    return vec4f(sum);
}
@fragment fn other(@location(0) first: f32) -> @location(0) vec4f { return vec4f(first); }
";

#[test]
fn what_no_fragment_stage_reads_is_not_handed_on() {
    let specialised = |constants: &[(&str, f64)], entries: &[&str]| special_module(STAGES, constants, entries);
    let (module, text) = specialised(&[("A", 0.0)], &["vertex", "fragment"]);
    assert!(globals(&module).is_empty(), "{text}");
    assert!(!text.contains("first") && !text.contains("second") && text.contains("@location(2) third"), "{text}");
    let (module, text) = specialised(&[], &["vertex", "fragment"]);
    assert!(globals(&module) == ["table"] && !text.contains("first") && text.contains("second"), "{text}");
    // Members move together: the remaining ones follow the position without a gap.
    let TypeInner::Struct { members, span } =
        &module.types.iter().find(|(_, ty)| ty.name.is_some()).expect("a struct").1.inner
    else {
        panic!("{text}")
    };
    let offsets: Vec<u32> = members.iter().map(|member| member.offset).collect();
    assert_eq!((offsets, *span), (vec![0, 16, 28], 32));
}

/// A stage alone does not know the reads of the other stage. Nor does it know them next to a
/// fragment stage that takes its inputs as separate parameters.
#[test]
fn what_another_stage_may_read_is_handed_on() {
    for entries in [&["vertex"][..], &["fragment"], &["vertex", "fragment", "other"]] {
        let (_, text) = special_module(STAGES, &[("A", 0.0)], entries);
        assert!(text.contains("first: f32,") && text.contains("second: vec3"), "{entries:?}: {text}");
    }
}

/// A vector that has not been written yet has its initial value.
#[test]
fn a_vector_that_was_not_written_is_its_initial_value() {
    let body = |condition: &str| {
        format!(
            "var v = vec3f(0.0, 1.0, 2.0); if ({condition}) {{ v = vec3f(table[0]); }} result[0] = dot(v, v * v.yzx);"
        )
    };
    let (module, text) = special("", &body("A"), &[("A", 0.0)]);
    assert!(globals(&module) == ["result"] && !text.contains("var v"), "{text}");
    let (_, text) = special("", &body("table[1] > 0.0"), &[]);
    assert!(text.contains("var v"), "{text}");
    let looped = "var v = vec2f(1.0); for (var i = 0u; i < 3u; i++) { result[i] = v.x; v = v * 2.0; }";
    let (_, text) = special("", looped, &[]);
    assert!(text.contains("var v"), "{text}");
}
