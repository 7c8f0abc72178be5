//! The module contract: the cookbook keeps it, and each rule detects a module that breaks it.

use lapidary_assay::accuracy_line::Accuracy;
use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_cook::check;
use lapidary_cook::formulas;
use lapidary_cookbook::{marks, modules};
use lapidary_translate::declarations::{functions, of_functions};
use lapidary_translate::indentation::indented;
use lapidary_wgsl::RECIPES;
use lapidary_xtask::lint::{Finding, Rule, lint, lint_composition, lint_recipe};
use std::path::Path;

#[test]
fn every_module_keeps_the_contract() {
    let findings: Vec<Finding> =
        modules().iter().flat_map(|module| lint(module.name, module.source, module.naive)).collect();
    assert!(findings.is_empty(), "{}", spell(&findings));
}

#[test]
fn all_modules_compile_as_one() {
    let sources: Vec<(&str, &str)> = modules().iter().map(|module| (module.name, module.whole)).collect();
    let findings = lint_composition(&sources);
    assert!(findings.is_empty(), "{}", spell(&findings));
}

#[test]
fn no_line_is_wider_than_a_page() {
    let modules = modules().iter().map(|module| (module.name, module.whole.to_owned()));
    let recipes = RECIPES.iter().map(|recipe| (recipe.name, recipe.own_text().concat()));
    for (name, text) in modules.chain(recipes) {
        for line in text.lines() {
            assert!(line.chars().count() <= 120, "{name}: {line}");
        }
    }
}

#[test]
fn every_module_has_its_four_places() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for module in modules() {
        assert!(root.join("crates").join(module.name).join("src/oracle.rs").is_file(), "{}", module.name);
        assert!(root.join("docs").join(format!("{}.md", module.name)).is_file(), "{}", module.name);
    }
}

#[test]
fn every_function_has_one_formula_and_every_formula_a_function() {
    let documented: Vec<&str> =
        modules().iter().flat_map(|module| &module.functions).map(|f| f.name.as_str()).collect();
    let mut bound: Vec<&str> = formulas::all().iter().map(|formula| formula.function).collect();
    let mut wanted = documented;
    wanted.sort_unstable();
    bound.sort_unstable();
    assert_eq!(bound, wanted);
}

#[test]
fn every_signature_is_the_mirrors() {
    for module in modules() {
        let (ir, _) = dispatch::parse(module.whole, module.name).unwrap_or_else(|error| panic!("{error}"));
        for formula in formulas::all().iter().filter(|formula| formula.module == module.name) {
            let signature = Signature::reflect(&ir, formula.function).unwrap_or_else(|error| panic!("{error}"));
            signature.expect(&formula.arguments, &formula.result).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

#[test]
fn naive_forms_and_no_others_have_a_benign_domain() {
    for formula in formulas::all() {
        let naive = check::documentation(formula).accuracy == Accuracy::Naive;
        assert_eq!(naive, formula.benign.is_some(), "{}", formula.function);
    }
}

#[test]
fn every_recipe_compiles_with_the_modules_that_it_requires() {
    for recipe in RECIPES {
        for name in &recipe.requires() {
            assert!(modules().iter().any(|module| module.name == *name), "{} requires `{name}`", recipe.name);
        }
        let (ir, _) = dispatch::parse(&recipe.compose(), recipe.name).unwrap_or_else(|error| panic!("{error}"));
        assert!(!ir.entry_points.is_empty(), "{}", recipe.name);
        let own_text = recipe.own_text().concat();
        let uses_none = dispatch::parse(&own_text, recipe.name).is_ok();
        assert_eq!(uses_none, recipe.requires().is_empty(), "{} uses no module's function", recipe.name);
    }
}

/// A module that keeps the contract. Each test below breaks one thing.
const SAMPLE: &str = "\
// sample: a module for the tests of the contract's rules.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: none; 1.0 and 0x10 in a comment are no literals.

const SAMPLE_HALF: f32 = 0.5f;

struct SamplePair {
    first: f32,
    second: f32,
}

// Halves both numbers.
// Returns: SamplePair, each number
//   halved.
// Units: none.
// Domain: any.
// Outside: nothing.
// Accuracy: lavapipe first 1 ulp, second 1 ulp; portable first 1 ulp, second 1 ulp
fn sample_halved(first: f32, second: f32) -> SamplePair {
    return SamplePair(first * SAMPLE_HALF, second * SAMPLE_HALF);
}
";

/// The line of the function's body before which a statement can be inserted.
const BODY: &str = "    return SamplePair(";

fn spell(findings: &[Finding]) -> String {
    findings.iter().map(|finding| format!("{finding}\n")).collect()
}

/// Returns the sample with every `from` replaced by `to`.
fn changed(from: &str, to: &str) -> String {
    assert!(SAMPLE.contains(from), "the sample holds no `{from}`");
    SAMPLE.replace(from, to)
}

/// Asserts that the change makes findings, all by `rule`, and returns them.
fn breaks(rule: Rule, from: &str, to: &str) -> Vec<Finding> {
    let source = changed(from, to);
    let findings = lint("sample", &source, "");
    assert!(!findings.is_empty(), "nothing is found in\n{source}");
    assert!(findings.iter().all(|finding| finding.rule == rule), "{}{source}", spell(&findings));
    findings
}

/// Asserts that a statement in the function's body makes findings, all by `rule`.
fn statement_breaks(rule: Rule, statement: &str) {
    breaks(rule, BODY, &format!("    {statement}\n{BODY}"));
}

/// Asserts that a global declaration makes findings, all by `rule`.
fn declaration_breaks(rule: Rule, declaration: &str) {
    breaks(rule, "struct SamplePair", &format!("{declaration}\n\nstruct SamplePair"));
}

#[test]
fn a_correct_module_gives_no_finding() {
    let findings = lint("sample", SAMPLE, "");
    assert!(findings.is_empty(), "{}", spell(&findings));
}

#[test]
fn invalid_wgsl_is_found() {
    breaks(Rule::Valid, "second * SAMPLE_HALF", "second * missing");
    breaks(Rule::Valid, "second * SAMPLE_HALF", "second * 2u");
    breaks(Rule::Valid, "return SamplePair", "retrun SamplePair");
    // naga itself refuses two leading underscores.
    statement_breaks(Rule::Valid, "let __half = first;");
}

#[test]
fn a_wrong_header_is_found_on_its_line() {
    for (line, from, to) in [
        (1, "// sample: ", "// other: "),
        (1, "// sample: ", "// sample "),
        (2, "MIT-0 OR Apache-2.0", "GPL-3.0-only"),
        (2, "// SPDX-License-Identifier: MIT-0 OR Apache-2.0\n", ""),
        (3, "// Source: ", "// From: "),
    ] {
        let findings = breaks(Rule::Header, from, to);
        assert_eq!(findings[0].line, line, "{}", spell(&findings));
    }
}

#[test]
fn a_wrong_function_comment_is_found() {
    for (from, to) in [
        ("// Units: none.\n", ""),
        ("// Units: none.\n// Domain: any.\n", "// Domain: any.\n// Units: none.\n"),
        ("// Domain: any.\n", "// Domain: any.\n// Domain: all.\n"),
        ("// Units: none.", "// Units:"),
        ("// Halves both numbers.\n", ""),
        // A blank line separates the comment from its function.
        ("\nfn sample_halved", "\n\nfn sample_halved"),
        // A function that does not start its line is not recognised, and must not pass for that
        // reason.
        ("\nfn sample_halved", "\n@must_use fn sample_halved"),
        ("lavapipe first 1 ulp, second 1 ulp", "lavapipe first 1 cm, second 1 ulp"),
        ("lavapipe first 1 ulp, second 1 ulp; portable", "portable"),
        ("lavapipe first 1 ulp, second 1 ulp", "lavapipe first 1 ulp"),
        ("lavapipe first 1 ulp, second 1 ulp", "lavapipe second 1 ulp, first 1 ulp"),
        ("portable first 1 ulp, second 1 ulp", "portable 1 ulp"),
    ] {
        breaks(Rule::FunctionComment, from, to);
    }
}

#[test]
fn a_function_without_a_result_is_found() {
    let nothing = "// Does nothing.\n// Returns: nothing.\n// Units: none.\n// Domain: any.\n// Outside: nothing.\n\
        // Accuracy: lavapipe 1 ulp; portable 1 ulp\nfn sample_nothing(first: f32) {\n}\n\n// Halves both";
    let findings = breaks(Rule::FunctionComment, "// Halves both", nothing);
    assert!(findings[0].message.contains("`sample_nothing` returns nothing"), "{}", spell(&findings));
}

#[test]
fn anything_but_functions_structs_and_consts_is_found() {
    declaration_breaks(Rule::PureFunctions, "@group(0u) @binding(0u) var<uniform> sample_scale: f32;");
    declaration_breaks(Rule::PureFunctions, "var<private> sample_state: f32;");
    declaration_breaks(Rule::PureFunctions, "override sample_scale: f32 = 2.0f;");
    declaration_breaks(Rule::PureFunctions, "@compute @workgroup_size(64u) fn sample_main() {}");
    declaration_breaks(Rule::PureFunctions, "alias SampleScalar = f32;");
    declaration_breaks(Rule::PureFunctions, "const_assert SAMPLE_HALF < 1.0f;");
    declaration_breaks(Rule::PureFunctions, "const_assert(SAMPLE_HALF < 1.0f);");
}

#[test]
fn a_directive_is_found() {
    // Directives precede every declaration.
    for directive in [
        "requires readonly_and_readwrite_storage_textures;",
        "diagnostic(off, derivative_uniformity);",
        "diagnostic (off, derivative_uniformity);",
    ] {
        breaks(Rule::PureFunctions, "const SAMPLE_HALF", &format!("{directive}\n\nconst SAMPLE_HALF"));
    }
}

#[test]
fn a_name_without_the_modules_prefix_is_found() {
    for (from, to) in
        [("sample_halved", "halved"), ("SamplePair", "Pair"), ("SAMPLE_HALF", "HALF"), ("SAMPLE_HALF", "sample_HALF")]
    {
        let findings = breaks(Rule::Prefix, from, to);
        assert!(findings[0].message.contains(&format!("`{to}`")) && findings[0].line > 3, "{}", spell(&findings));
    }
}

#[test]
fn a_name_that_would_be_changed_is_found() {
    statement_breaks(Rule::Identifier, "let half_ = first * 2.0f;");
    statement_breaks(Rule::Identifier, "let half__way = first * 2.0f;");
    statement_breaks(Rule::Identifier, "var half_ = first;");
    breaks(Rule::Identifier, "second", "second_");
    breaks(Rule::Identifier, "SamplePair", "SamplePair_");
    breaks(Rule::Identifier, "sample_halved", "sample__halved");
    // A member that is also an argument here. The last digit matters only for the member.
    let findings = breaks(Rule::Identifier, "first", "first1");
    assert_eq!(findings.len(), 1, "{}", spell(&findings));
}

#[test]
fn a_name_lost_among_others_is_found() {
    // naga keeps one name per expression: here that of the second `let`.
    statement_breaks(Rule::Identifier, "let half_ = first * 2.0f;\n    let whole = half_;");
    // It keeps no name of a const.
    statement_breaks(Rule::Identifier, "const HALF_ = 2.0f;");
}

#[test]
fn a_literal_without_a_type_is_found() {
    // The last literal ends in a digit that looks like a suffix.
    for literal in ["1.0", "1", "1.", "0x10", "1e5", "1e-5", ".5", "0xff"] {
        statement_breaks(Rule::Literal, &format!("let number = {literal};"));
    }
    statement_breaks(Rule::Literal, "let number = vec2f(1.0, 2.0f);");
}

#[test]
fn what_only_looks_like_a_literal_is_not_found() {
    for statement in [
        "let x1 = vec3f(first);",
        "let turn = mat4x4f();",
        "let number = 1e-5f + .5f;",
        "let number = first; // 1.0 and 3",
        "let number = -3i;",
        "let number = 0x10u;",
    ] {
        let findings = lint("sample", &changed(BODY, &format!("    {statement}\n{BODY}")), "");
        assert!(findings.is_empty(), "{statement}: {}", spell(&findings));
    }
}

#[test]
fn what_fails_is_not_pasted() {
    let naive = "// Halves the first.\n// Returns: half of it.\n// Units: none.\n// Domain: any.\n// Outside: nothing.\n\
        // Accuracy: naive\nfn sample_half_naive(first: f32) -> f32 {\n    return first / 2.0f;\n}\n";
    let findings = lint("sample", SAMPLE, naive);
    assert!(findings.is_empty(), "{}", spell(&findings));
    let findings = lint("sample", &format!("{SAMPLE}\n{naive}"), "");
    assert!(matches!(&findings[..], [finding] if finding.rule == Rule::Place), "{}", spell(&findings));
    let stable = naive.replace("Accuracy: naive", "Accuracy: lavapipe 1 ulp; portable 3 ulp");
    let findings = lint("sample", SAMPLE, &stable);
    assert!(matches!(&findings[..], [finding] if finding.rule == Rule::Place), "{}", spell(&findings));
    assert!(findings[0].to_string().starts_with("wgsl/naive/sample.wgsl:7: "), "{}", findings[0]);
}

#[test]
fn a_comparison_with_itself_is_found() {
    for statement in [
        "let x = first * 2.0f;\n    let odd = x != x;",
        "let odd = first == first;",
        "let pair = SamplePair(first, second);\n    let odd = pair.second != pair.second;",
        "var x = first;\n    let odd = x != x;",
        "let v = vec3f(first);\n    let odd = v != v;",
    ] {
        statement_breaks(Rule::SelfComparison, statement);
    }
    let different = "let pair = SamplePair(first, second);\n    let odd = pair.first != pair.second;";
    assert!(lint("sample", &changed(BODY, &format!("    {different}\n{BODY}")), "").is_empty());
    // Two calls of one function.
    let calls = "\
// The same, twice.
// Returns: a quarter of the first.
// Units: none.
// Domain: any.
// Outside: nothing.
// Accuracy: lavapipe 2 ulp; portable 2 ulp
fn sample_quarter(first: f32, second: f32) -> f32 {
    let one = sample_halved(first, second);
    let other = sample_halved(second, first);
    return select(0.0f, SAMPLE_HALF * one.first, one.first != other.first);
}
";
    let findings = lint("sample", &format!("{SAMPLE}\n{calls}"), "");
    assert!(findings.is_empty(), "{}", spell(&findings));
}

#[test]
fn recipes_keep_the_contract() {
    let parts = lapidary_wgsl::PARTS.iter().map(|part| part.source);
    let effects: Vec<String> =
        parts.chain(RECIPES.iter().map(|recipe| recipe.source)).flat_map(marks::effects).collect();
    for recipe in RECIPES {
        assert!(lapidary_wgsl::module(recipe.name).is_none(), "`{}` names a module and a recipe", recipe.name);
        let lint = |text| lint_recipe(recipe.name, text, &effects);
        let findings: Vec<Finding> = recipe.own_text().into_iter().flat_map(lint).collect();
        assert!(findings.is_empty(), "{}", spell(&findings));
        assert_eq!(marks::idle_effects(&recipe.compose()), Ok(Vec::new()), "{}", recipe.name);
    }
}

/// Each function of a recipe can be copied with what it needs, and brings no binding that it does not use.
#[test]
fn every_function_of_a_recipe_can_be_copied_alone() {
    for recipe in RECIPES {
        let source = recipe.compose();
        let prefixes: Vec<String> = recipe.requires().into_iter().map(|module| format!("{module}_")).collect();
        let own_functions =
            functions(&source).into_iter().filter(|name| !prefixes.iter().any(|prefix| name.starts_with(prefix)));
        for name in own_functions {
            let text = of_functions(&source, &[name]).expect("a function of the recipe");
            let (ir, info) =
                dispatch::parse(&text, recipe.name).unwrap_or_else(|error| panic!("{}::{name}: {error}", recipe.name));
            let function = ir.functions.iter().find(|(_, function)| function.name.as_deref() == Some(name));
            let uses = match function {
                Some((handle, _)) => &info[handle],
                None => {
                    info.get_entry_point(ir.entry_points.iter().position(|it| it.name == name).expect("an entry point"))
                }
            };
            for (handle, variable) in ir.global_variables.iter().filter(|(_, variable)| variable.binding.is_some()) {
                assert!(!uses[handle].is_empty(), "{}::{name} brings {:?}", recipe.name, variable.name);
            }
        }
    }
}

/// What `indented` makes of a text is how the cookbook is written, so that a copy with lines cut looks as if written
/// so.
#[test]
fn texts_are_indented_by_their_brackets() {
    let modules = modules().iter().map(|module| module.whole);
    let texts = modules
        .chain(lapidary_wgsl::PARTS.iter().map(|part| part.source))
        .chain(RECIPES.iter().map(|recipe| recipe.source));
    for text in texts {
        for (line, written) in indented(text).lines().zip(text.lines()) {
            // Marks of effects stand where they like.
            assert!(line == written || written.trim().starts_with("//"), "{written:?}, not {line:?}");
        }
    }
}

/// A comment that says which recipe comes before or after names one that there is.
#[test]
fn recipes_named_in_comments_exist() {
    let texts = RECIPES.iter().map(|recipe| recipe.source).chain(lapidary_wgsl::PARTS.iter().map(|part| part.source));
    let mut named = 0;
    for text in texts {
        let comments: Vec<&str> = text.lines().filter_map(|line| Some(line.split_once("//")?.1.trim())).collect();
        let comments = comments.join(" ");
        for (start, word) in comments.match_indices("recipe ").chain(comments.match_indices("recipes ")) {
            for name in comments[start + word.len()..].split([' ', ',']).filter(|name| !["", "and"].contains(name)) {
                let name = name.trim_matches(['`', '.', ':', ';', ')', '\'']);
                let is_name = name.contains('_') || lapidary_wgsl::module(name).is_some();
                if !is_name {
                    break;
                }
                assert!(
                    lapidary_wgsl::recipe(name).is_some(),
                    "`{name}` is no recipe: {}",
                    text.lines().next().unwrap_or_default()
                );
                named += 1;
            }
        }
    }
    assert!(named >= 10, "{named}");
}

#[test]
fn wrong_marks_are_found() {
    let known = ["fog".to_owned()];
    assert_eq!(lint_recipe("sample", "a;  //+fog", &known), []);
    let findings = lint_recipe("sample", "a;  //+frog\nif (EFFECT_FOG) {", &known);
    assert_eq!(
        findings.iter().map(|finding| (finding.rule, finding.line)).collect::<Vec<_>>(),
        [(Rule::Mark, 1), (Rule::Mark, 2)]
    );
}

#[test]
fn modules_that_clash_are_found() {
    let other = changed("sample", "other").replace("Sample", "Other").replace("SAMPLE", "OTHER");
    assert!(lint_composition(&[("sample", SAMPLE), ("other", &other)]).is_empty());
    let clash = other.replace("OtherPair", "SamplePair");
    let findings = lint_composition(&[("sample", SAMPLE), ("other", &clash)]);
    // In this order and in the reverse one.
    assert_eq!(
        findings.iter().map(|finding| finding.rule).collect::<Vec<_>>(),
        [Rule::Composition; 2],
        "{}",
        spell(&findings)
    );
}
