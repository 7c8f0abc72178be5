//! An effect that is off costs nothing: a specialised recipe equals its specialised text without
//! the effect's lines.
//!
//! The lines are cut by their marks (`docs/contract.md`), without knowledge of WGSL. Both shaders
//! then become SPIR-V, which is compared instruction for instruction. `specialise` applies the
//! overrides that the cut text still has. A separate test shows that it leaves no more than naga
//! alone leaves of a text without any effect's lines.

mod canonical;

use canonical::{Canonical, canonical};
use lapidary_assay::dispatch;
use lapidary_cookbook::marks::{self, override_of};
use lapidary_specialise::specialise;
use lapidary_specialise::spirv_counts::spirv_counts;
use lapidary_translate::fitted::with_constants;
use lapidary_wgsl::{RECIPES, Recipe};
use naga::back::pipeline_constants::process_overrides;
use naga::compact::{KeepUnused, compact};
use naga::valid::ModuleInfo;
use naga::{Literal, Module, ShaderStage};

/// Returns the text without the lines for any effect of `off`, and with the lines that replace
/// them.
fn cut(source: &str, off: &[&str]) -> String {
    marks::cut(source, off).unwrap_or_else(|fault| panic!("line {}: {}", fault.line, fault.message))
}

fn parse(source: &str) -> Module {
    dispatch::parse(source, "recipe").unwrap_or_else(|error| panic!("{error}")).0
}

/// Returns the entry points that run together: each fragment entry point with the vertex entry
/// point, each compute entry point alone.
fn passes(module: &Module) -> Vec<Vec<String>> {
    let entries = |stage| module.entry_points.iter().filter(move |entry| entry.stage == stage);
    let fragments = entries(ShaderStage::Fragment).flat_map(|fragment| {
        entries(ShaderStage::Vertex).map(|vertex| vec![vertex.name.clone(), fragment.name.clone()]).collect::<Vec<_>>()
    });
    fragments.chain(entries(ShaderStage::Compute).map(|kernel| vec![kernel.name.clone()])).collect()
}

/// Values of overrides that enumerate forms.
const FORMS: [(&str, &[f64]); 6] = [
    ("DISPERSION_FORM", &[0.0, 1.0, 2.0, 3.0]),
    ("CDRF_FORM", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
    ("SPREAD_FORM", &[0.0, 1.0, 2.0]),
    ("CURVATURE_FORM", &[0.0, 1.0, 2.0, 3.0]),
    ("SHADOW_FORM", &[0.0, 1.0, 2.0]),
    ("OPTICAL_PATH_STENCIL", &[6.0, 18.0, 26.0]),
];

/// Unless the suite is run whole, one choice in this many besides defaults, all off and all on.
const ONE_IN: u64 = 3;

/// Returns values for a recipe's overrides; unnamed ones keep their defaults. The choices are: all
/// defaults; all effects off; all on; and, with all effects on, each form, and each non-effect
/// switch inverted.
fn choices(module: &Module) -> Vec<Vec<(String, f64)>> {
    let named = || module.overrides.iter().filter_map(|(_, over)| Some((over.name.clone()?, over.init)));
    let effects = |value| named().filter(|(name, _)| name.starts_with("EFFECT_")).map(move |(name, _)| (name, value));
    let on = || effects(1.0).collect::<Vec<_>>();
    let mut choices = vec![Vec::new(), effects(0.0).collect(), on()];
    for (name, init) in named() {
        let forms = FORMS.iter().find(|(form, _)| *form == name).map(|(_, values)| values.to_vec());
        let turned = match init.map(|init| &module.global_expressions[init]) {
            Some(naga::Expression::Literal(Literal::Bool(default))) if !name.starts_with("EFFECT_") => {
                Some(vec![f64::from(u8::from(!default))])
            }
            _ => None,
        };
        let values = forms.or(turned).unwrap_or_default();
        choices.extend(values.into_iter().map(|value| [on(), vec![(name.clone(), value)]].concat()));
    }
    choices
}

/// The remainder of some entry points: the bindings, and the SPIR-V of each.
#[derive(Debug)]
struct Left {
    bindings: Vec<(u32, u32)>,
    entries: Vec<Canonical>,
}

impl Left {
    fn of(module: &Module, info: &ModuleInfo) -> Left {
        let places = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
        let mut bindings: Vec<_> = places.map(|place| (place.group, place.binding)).collect();
        bindings.sort_unstable();
        let entries = module.entry_points.iter().map(|entry| canonical(module, info, entry.stage, &entry.name));
        Left { bindings, entries: entries.collect() }
    }

    fn specialised(module: &Module, values: &[(String, f64)], pass: &[String]) -> Left {
        let (module, info) = specialised(module, values, pass);
        Left::of(&module, &info)
    }

    fn difference(&self, other: &Left) -> Option<String> {
        if self.bindings != other.bindings {
            return Some(format!("bindings {:?} and {:?}", self.bindings, other.bindings));
        }
        assert_eq!(self.entries.len(), other.entries.len());
        self.entries.iter().zip(&other.entries).find_map(|(left, right)| left.difference(right))
    }
}

/// Specialises the shader by those of `values` that it declares.
fn specialised(module: &Module, values: &[(String, f64)], pass: &[String]) -> (Module, ModuleInfo) {
    let values: Vec<(&str, f64)> = values.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    let values = lapidary_specialise::declared(module, &values);
    let pass: Vec<&str> = pass.iter().map(String::as_str).collect();
    specialise(module.clone(), &values, &pass).unwrap_or_else(|error| panic!("{pass:?} with {values:?}: {error}"))
}

/// Returns `values` with the override of an effect set to off.
fn with_off(values: &[(String, f64)], effect: &str) -> Vec<(String, f64)> {
    let name = override_of(effect);
    let others = values.iter().filter(|(other, _)| *other != name).cloned();
    others.chain([(name.clone(), 0.0)]).collect()
}

/// Returns the differences, for some values, between a recipe with an effect off and its text without the effect.
fn differences(whole: &Module, without: &str, effect: &str, choices: &[Vec<(String, f64)>]) -> Vec<String> {
    let without = parse(without);
    let mut found = Vec::new();
    for pass in passes(whole) {
        for values in choices {
            let values = with_off(values, effect);
            let [off, cut] = [whole, &without].map(|module| Left::specialised(module, &values, &pass));
            found.extend(off.difference(&cut).map(|difference| format!("{pass:?} with {values:?}: {difference}")));
        }
    }
    found
}

/// Returns each recipe with the effects that it declares.
fn recipes_with_effects() -> impl Iterator<Item = (&'static Recipe, String, Vec<String>)> {
    RECIPES.iter().filter_map(|recipe| {
        let source = recipe.compose();
        let effects = marks::effects(&source);
        (!effects.is_empty()).then_some((recipe, source, effects))
    })
}

#[test]
fn an_effect_that_is_off_leaves_the_recipe_without_it() {
    let recipes: Vec<_> = recipes_with_effects().collect();
    assert!(recipes.len() >= 11, "{}", recipes.len());
    let check = |(recipe, source, effects): &(&Recipe, String, Vec<String>)| -> Vec<String> {
        let whole = parse(source);
        let mut tried = choices(&whole);
        let others = tried.split_off(3);
        tried.extend(lapidary_testing::sampled(others, ONE_IN));
        let differences_without = |effect: &String| differences(&whole, &cut(source, &[effect]), effect, &tried);
        let found =
            lapidary_testing::sampled(effects, 3).into_iter().map(|effect| (effect, differences_without(effect)));
        found
            .flat_map(|(effect, found)| {
                found.into_iter().map(move |it| format!("{} without {effect}: {it}", recipe.name))
            })
            .collect()
    };
    let found: Vec<String> = recipes.iter().flat_map(check).collect();
    assert!(found.is_empty(), "{} differences, the first:\n{}", found.len(), found[..found.len().min(8)].join("\n"));
}

/// What `cook copy --effects` writes is what specialising to these effects leaves, without the modules that
/// it does not use.
#[test]
fn a_copy_holds_only_the_modules_that_its_effects_use() {
    for (recipe, source, effects) in recipes_with_effects() {
        for kept in std::iter::once(None).chain(effects.iter().map(Some)) {
            let off: Vec<&str> = effects.iter().filter(|effect| Some(*effect) != kept).map(String::as_str).collect();
            let copied = marks::without(recipe, &off).unwrap_or_else(|fault| panic!("{}", fault.message));
            assert!(!copied.contains("//+") && !copied.contains("//-"), "{}", recipe.name);
            let words: Vec<&str> = copied.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
            assert!(off.iter().all(|effect| !words.contains(&&*override_of(effect))), "{} {kept:?}", recipe.name);
            // The whole recipe, specialised to these effects, is the same to the instruction.
            let values: Vec<(String, f64)> =
                effects.iter().map(|effect| (override_of(effect), f64::from(u8::from(Some(effect) == kept)))).collect();
            let [copied, whole] = [&copied, &source].map(|text| parse(text));
            for pass in passes(&whole) {
                let [copied, whole] = [&copied, &whole].map(|module| Left::specialised(module, &values, &pass));
                assert_eq!(copied.difference(&whole), None, "{} {kept:?} {pass:?}", recipe.name);
            }
        }
    }
    let bare = |name: &str| {
        let recipe = lapidary_wgsl::recipe(name).expect(name);
        let effects = marks::effects(&recipe.compose());
        let off: Vec<&str> = effects.iter().map(String::as_str).collect();
        marks::without(recipe, &off).unwrap_or_else(|fault| panic!("{}", fault.message))
    };
    let surface = bare("gem");
    assert!(surface.contains("fn fresnel_dielectric(") && !surface.contains("fn dispersion_"), "{surface}");
    assert!(surface.lines().count() < lapidary_wgsl::recipe_source("gem").lines().count() / 2);
}

/// What `cook copy --set` writes is what specialising to these values leaves, to the instruction for switches and
/// forms.
#[test]
fn a_copy_with_values_set_is_what_specialising_leaves() {
    let mut shorter = 0;
    for recipe in lapidary_wgsl::RECIPES {
        let source = marks::without(recipe, &[]).unwrap_or_else(|fault| panic!("{}", fault.message));
        let whole = parse(&source);
        let overrides: Vec<(String, naga::ScalarKind)> = whole
            .overrides
            .iter()
            .filter_map(|(_, it)| Some((it.name.clone()?, whole.types[it.ty].inner.scalar_kind()?)))
            .collect();
        for (name, kind) in &overrides {
            let form = FORMS.iter().find(|(form, _)| form == name).map(|(_, values)| *values);
            let is_choice = form.is_some() || *kind == naga::ScalarKind::Bool;
            let values = match kind {
                naga::ScalarKind::Bool => &[0.0, 1.0],
                naga::ScalarKind::Float => &[0.5][..],
                _ => form.unwrap_or(&[1.0, 3.0]),
            };
            for value in values {
                let written = match kind {
                    naga::ScalarKind::Bool => (*value == 1.0).to_string(),
                    _ => value.to_string(),
                };
                let text = with_constants(&source, &[(name, &written)], &[]).unwrap_or_else(|error| panic!("{error}"));
                assert!(!text.contains(&format!("override {name}:")), "{}", recipe.name);
                shorter += usize::from(text.lines().count() + 1 < source.lines().count());
                let set = parse(&text);
                for pass in passes(&whole) {
                    let set = Left::specialised(&set, &[], &pass);
                    let whole = Left::specialised(&whole, &[(name.clone(), *value)], &pass);
                    let what = format!("{} {name}={written} {pass:?}", recipe.name);
                    assert_eq!(set.bindings, whole.bindings, "{what}");
                    // With other constants naga's front end computes, further than specialising goes.
                    if is_choice {
                        assert_eq!(set.difference(&whole), None, "{what}");
                    }
                }
            }
        }
    }
    assert!(shorter > 50, "{shorter} copies are shorter");
}

/// Returns the text as naga alone compacts it, with the defaults of its overrides.
fn by_naga(source: &str, pass: &[String]) -> (Module, ModuleInfo) {
    let mut module = parse(source);
    module.entry_points.retain(|entry| pass.contains(&entry.name));
    let info = lapidary_specialise::validate(&module).expect("valid");
    let (module, _) =
        process_overrides(&module, &info, None, &Default::default()).expect("every override has a default");
    let mut module = module.into_owned();
    compact(&mut module, KeepUnused::No);
    let info = lapidary_specialise::validate(&module).expect("valid");
    (module, info)
}

/// With every effect's lines cut, `specialise` has nothing to remove for an effect.
#[test]
fn with_all_effects_off_no_more_is_left_than_of_the_text_without_any() {
    for (recipe, source, effects) in recipes_with_effects() {
        let effects: Vec<&str> = effects.iter().map(String::as_str).collect();
        let bare = cut(&source, &effects);
        assert!(!bare.contains("EFFECT_"), "{}", recipe.name);
        let off: Vec<(String, f64)> = effects.iter().map(|effect| (override_of(effect), 0.0)).collect();
        for pass in passes(&parse(&source)) {
            let (module, info) = specialised(&parse(&source), &off, &pass);
            let (plain, plain_info) = by_naga(&bare, &pass);
            let [left, plain_left] = [Left::of(&module, &info), Left::of(&plain, &plain_info)];
            let name = format!("{} {pass:?}", recipe.name);
            let has = |place| plain_left.bindings.contains(place);
            assert!(left.bindings.iter().all(has), "{name}: {:?} and {:?}", left.bindings, plain_left.bindings);
            for (left, plain) in left.entries.iter().zip(&plain_left.entries) {
                assert!(left.body.len() <= plain.body.len(), "{name}: {} and {}", left.body.len(), plain.body.len());
            }
            let [Some(vertex), Some(fragment)] = [pass.first(), pass.get(1)] else { continue };
            let [left, plain] = [(&module, &info), (&plain, &plain_info)]
                .map(|(module, info)| spirv_counts(module, info, vertex, fragment).expect("counts"));
            assert!(
                left.vertex_instructions <= plain.vertex_instructions
                    && left.fragment_instructions <= plain.fragment_instructions
                    && left.constant_bytes <= plain.constant_bytes
                    && left.storage_bindings <= plain.storage_bindings,
                "{name}: {left:?} and {plain:?}"
            );
        }
    }
}

/// A comparison that passes on any remainder checks nothing.
#[test]
fn what_is_left_of_an_effect_is_seen() {
    let source = lapidary_wgsl::recipe_source("texture_irradiance");
    let without = cut(&source, &["spot"]);
    let whole = parse(&source);
    let differences = |without: &str| differences(&whole, without, "spot", &choices(&whole));
    assert_eq!(differences(&without), Vec::<String>::new());
    // A range of lines without marks.
    let unmarked = |line: &str| {
        let line = line.replace("if (EFFECT_SPOT) {", "{");
        if line.contains("override") { line } else { line.replace("  //+spot", "") }
    };
    let planted: String = source.lines().flat_map(|line| [unmarked(line), "\n".to_owned()]).collect();
    let kept = cut(&planted, &["spot"]);
    assert!(kept.contains("power *= share * share;") && !kept.contains("EFFECT_SPOT"));
    assert!(!differences(&kept).is_empty());
    // Another constant, another operation, and an extra operation.
    for (right, wrong) in [
        ("squared < 1.1754944e-38f", "squared < 1.1754942e-38f"),
        ("received += part", "received -= part"),
        (
            "return LightArrival(direction, light_power(light, direction) /",
            "return LightArrival(direction, (light_power(light, direction) + 0.0f) /",
        ),
    ] {
        let planted = without.replace(right, wrong);
        assert_ne!(planted, without, "{right}");
        assert!(!differences(&planted).is_empty(), "{wrong}");
    }
}

/// A binding that nothing reads is absent from the SPIR-V, but present in the layout that a
/// renderer takes from the module.
#[test]
fn a_binding_that_is_kept_is_seen() {
    let source = lapidary_wgsl::recipe_source("gem");
    let values = vec![("EFFECT_ENVIRONMENT_MAP".to_owned(), 0.0)];
    let pass = ["gem_vertex", "gem_fragment"].map(str::to_owned);
    let cut = Left::specialised(&parse(&cut(&source, &["environment_map"])), &values, &pass);
    let (mut module, info) = specialised(&parse(&source), &values, &pass);
    assert_eq!(Left::of(&module, &info).difference(&cut), None);
    let (whole, _) = specialised(&parse(&source), &[("EFFECT_ENVIRONMENT_MAP".to_owned(), 1.0)], &pass);
    let is_map = |variable: &&naga::GlobalVariable| variable.name.as_deref() == Some("environment_map");
    let map = whole.global_variables.iter().map(|(_, variable)| variable).find(is_map).expect("the map's binding");
    let ty = module.types.insert(whole.types[map.ty].clone(), naga::Span::UNDEFINED);
    module.global_variables.append(naga::GlobalVariable { ty, ..map.clone() }, naga::Span::UNDEFINED);
    let info = lapidary_specialise::validate(&module).expect("valid");
    let difference = Left::of(&module, &info).difference(&cut).expect("one binding more");
    assert!(difference.starts_with("bindings"), "{difference}");
}

/// Ids and the order of declarations do not matter; everything else does.
#[test]
fn the_canonical_form_forgets_the_order_of_declarations_alone() {
    let left = |source: &str| Left::specialised(&parse(source), &[], &["main".to_owned()]);
    let parts =
        ["struct A { x: f32, y: u32 }", "struct B { z: vec3f, a: A }", "const T = array<f32, 3>(1.0, 2.0, 4.0);"];
    let body = "
        @group(0) @binding(0) var<storage, read> given: array<B>;
        @group(0) @binding(1) var<storage, read_write> made: array<f32>;
        fn first(i: u32) -> f32 { return T[i % 3u] * given[i].a.x; }
        fn second(i: u32) -> f32 { switch i { case 1u, 4u: { return 2.0; } default: { return first(i) + given[i].z.y; } } }
        @compute @workgroup_size(4) fn main(@builtin(global_invocation_id) at: vec3u) {
            for (var i = 0u; i < 3u; i++) { made[at.x] += second(at.x + i) - first(i); }
        }";
    let forwards = format!("{}\n{body}", parts.join("\n"));
    let backwards = format!("{body}\n{}", parts.iter().rev().copied().collect::<Vec<_>>().join("\n"));
    assert_eq!(left(&forwards).difference(&left(&backwards)), None);
    for (right, wrong) in [
        ("x: f32, y: u32", "y: u32, x: f32"),
        ("2.0, 4.0", "2.0, 5.0"),
        ("case 1u, 4u", "case 1u, 5u"),
        ("second(at.x + i) - first(i)", "first(at.x + i) - second(i)"),
        ("workgroup_size(4)", "workgroup_size(8)"),
        ("made[at.x] +=", "made[at.y] +="),
        ("i < 3u", "i <= 3u"),
    ] {
        let planted = forwards.replace(right, wrong);
        assert_ne!(planted, forwards, "{right}");
        assert!(left(&forwards).difference(&left(&planted)).is_some(), "{wrong}");
    }
}
