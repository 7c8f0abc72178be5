//! The same for the functions of the cookbook's recipes. Those that depend on an override, read no
//! binding and take no derivative run on the device by themselves. They are few; the others are
//! tested through their cut texts and pictures (`effects_off`).

use super::{ROWS, SEED, outcomes, specialised};

use lapidary_assay::dispatch::signature::Signature;
use lapidary_assay::dispatch::{self, KernelModule};
use lapidary_assay::draws::Draws;
use lapidary_assay::runner::Runner;
use lapidary_specialise::specialise;
use lapidary_wgsl::{RECIPES, Recipe};
use naga::{Expression, Function, Handle, Literal, Module, Statement, back};
use std::collections::BTreeSet;
use std::sync::OnceLock;

/// References of a function and of the functions that it calls.
#[derive(Default)]
struct Reach {
    overrides: BTreeSet<String>,
    /// Whether it reads a binding, or takes a derivative, which only a fragment shader can do.
    needs_more: bool,
}

impl Reach {
    fn of(module: &Module, function: Handle<Function>) -> Reach {
        let mut reach = Reach::default();
        let mut pending = vec![function];
        let mut seen = BTreeSet::new();
        while let Some(function) = pending.pop() {
            if seen.insert(function) {
                let function = &module.functions[function];
                reach.add(module, function);
                called(&function.body, &mut pending);
            }
        }
        reach
    }

    fn add(&mut self, module: &Module, function: &Function) {
        for (_, expression) in function.expressions.iter() {
            match expression {
                Expression::Override(over) => self.overrides.extend(module.overrides[*over].name.clone()),
                Expression::GlobalVariable(_) | Expression::Derivative { .. } => self.needs_more = true,
                _ => {}
            }
        }
    }
}

fn called(block: &naga::Block, calls: &mut Vec<Handle<Function>>) {
    for statement in block.iter() {
        match statement {
            Statement::Call { function, .. } => calls.push(*function),
            Statement::Block(block) => called(block, calls),
            Statement::If { accept, reject, .. } => {
                called(accept, calls);
                called(reject, calls);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| called(&case.body, calls)),
            Statement::Loop { body, continuing, .. } => {
                called(body, calls);
                called(continuing, calls);
            }
            _ => {}
        }
    }
}

/// Returns the override's default and another value.
fn values(module: &Module, name: &str) -> [f64; 2] {
    let (_, over) = module.overrides.iter().find(|(_, over)| over.name.as_deref() == Some(name)).expect("declared");
    match over.init.map(|init| &module.global_expressions[init]) {
        Some(Expression::Literal(Literal::Bool(value))) => [f64::from(u8::from(*value)), f64::from(u8::from(!value))],
        // An override of the stencils.
        Some(Expression::Literal(Literal::U32(value))) => [f64::from(*value), 18.0],
        other => panic!("{name}: {other:?}"),
    }
}

#[test]
fn a_recipes_function_gives_the_same_bits_specialised() {
    let mut run = BTreeSet::new();
    for recipe in RECIPES {
        let source = recipe.compose();
        let (module, _) = dispatch::parse(&source, recipe.name).unwrap_or_else(|error| panic!("{error}"));
        for (handle, function) in module.functions.iter() {
            let Reach { overrides, needs_more } = Reach::of(&module, handle);
            let name = function.name.clone().unwrap_or_default();
            let dispatches = Signature::reflect(&module, &name).is_ok();
            // Several recipes share parts.
            if overrides.is_empty() || needs_more || !dispatches || !run.insert(name.clone()) {
                continue;
            }
            let kernel = KernelModule::reflect(&source, recipe.name, &name).unwrap_or_else(|error| panic!("{error}"));
            let words =
                dispatch::Kernel::new(lapidary_testing::gpu(), kernel.clone()).expect("compiles").argument_words();
            let mut draws = Draws::of_row(SEED ^ lapidary_testing::seed(), run.len() as u64);
            // Rows alternate between floats and single bits: any other pattern sets every flag.
            let mut word = |place: usize| match place / words % 2 {
                0 => draws.between(-2.0, 2.0).to_bits(),
                _ => draws.pick(&[0, 1]) << draws.below(32),
            };
            let arguments: Vec<u32> = (0..ROWS * words).map(&mut word).collect();
            for choice in 0..1 << overrides.len() {
                let value = |(place, name): (usize, &String)| values(&module, name)[choice >> place & 1];
                let constants: Vec<(&str, f64)> =
                    overrides.iter().enumerate().map(|(place, name)| (name.as_str(), value((place, name)))).collect();
                let whole = outcomes(kernel.clone(), &constants, &arguments);
                let special = outcomes(specialised(&kernel, &constants), &[], &arguments);
                assert_eq!(whole, special, "{}: {name} with {constants:?}", recipe.name);
                let rows: BTreeSet<&[u32]> = whole.chunks(whole.len() / ROWS).collect();
                assert!(rows.len() > 4, "{}: {name} with {constants:?} hardly depends on its arguments", recipe.name);
            }
        }
    }
    println!("{run:?}");
    assert!(run.contains("light_arrival") && run.contains("optical_path_affected"), "{run:?}");
}

/// Specialised recipe as WGSL.
pub(crate) struct SpecialisedText {
    /// Recipe, entry points and override values.
    pub(crate) name: String,
    pub(crate) text: String,
    entry_points: usize,
}

/// Returns each recipe with its effects as they are, all off and all on, for all entry points
/// together and for each by itself; and with each effect alone.
pub(crate) fn specialised_texts() -> &'static [SpecialisedText] {
    static TEXTS: OnceLock<Vec<SpecialisedText>> = OnceLock::new();
    TEXTS.get_or_init(|| RECIPES.iter().flat_map(texts_of).collect())
}

fn texts_of(recipe: &Recipe) -> Vec<SpecialisedText> {
    let (module, _) = dispatch::parse(&recipe.compose(), recipe.name).unwrap_or_else(|error| panic!("{error}"));
    let effects: Vec<String> = module.overrides.iter().filter_map(|(_, over)| over.name.clone()).collect();
    let effects = || effects.iter().map(String::as_str).filter(|name| name.starts_with("EFFECT_"));
    let entries: Vec<&str> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
    let choices =
        [Vec::new(), effects().map(|name| (name, 0.0)).collect(), effects().map(|name| (name, 1.0)).collect()];
    let passes = std::iter::once(entries.clone()).chain(entries.iter().map(|entry| vec![*entry]));
    let text = |pass: &[&str], constants: &[(&str, f64)]| {
        let name = format!("{} {pass:?} with {constants:?}", recipe.name);
        let (special, info) =
            specialise(module.clone(), constants, pass).unwrap_or_else(|error| panic!("{name}: {error}"));
        let text = back::wgsl::write_string(&special, &info, back::wgsl::WriterFlags::empty())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        SpecialisedText { name, text, entry_points: pass.len() }
    };
    let alone = |effect: &str| effects().map(|name| (name, f64::from(u8::from(name == effect)))).collect::<Vec<_>>();
    let passes = passes.flat_map(|pass| choices.iter().map(|choice| text(&pass, choice)).collect::<Vec<_>>());
    passes.chain(effects().map(|effect| text(&entries, &alone(effect)))).collect()
}

/// The module `chromium` tests the same texts in Chromium.
#[test]
fn specialised_recipes_are_valid_text() {
    for SpecialisedText { name, text, entry_points } in specialised_texts() {
        let (again, _) = dispatch::parse(text, name).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(again.entry_points.len(), *entry_points, "{name}");
        assert!(again.overrides.is_empty(), "{name}");
    }
}
