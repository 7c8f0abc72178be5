//! `cook copy`.

use super::{Failure, Outcome, output};
use lapidary_assay::accuracy_line::Accuracy;
use lapidary_assay::dispatch::{self, ENTRY_POINT, KernelModule};
use lapidary_cook::cookbook::marks::{self, effect_of, effects, override_of};
use lapidary_cook::cookbook::translate::{Target, translate};
use lapidary_cook::cookbook::{self, Module};
use lapidary_render::file;
use lapidary_scene::nearest;
use lapidary_wgsl::Recipe;
use std::path::PathBuf;

/// Prints one self-contained file to paste: modules, or a recipe with everything that it requires.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook copy refraction fresnel --out optics.wgsl\n  ./cook copy gem --effects proxy_geometry --to hlsl --out gem.hlsl\n  ./cook copy refraction::refract --to spirv --out refract.spv"
)]
pub(super) struct Arguments {
    /// Modules, or one recipe. SPIR-V and GLSL need entry points. For these, name one function as
    /// MODULE::FUNCTION (it is wrapped in a compute kernel); for GLSL also one entry point of a
    /// recipe, such as gem::gem_fragment.
    #[arg(required = true, value_name = "MODULE|RECIPE")]
    names: Vec<String>,
    /// Effects of a recipe to keep, switched on; the others are cut out of the text, with the modules
    /// that only they use. If omitted, all are kept, with the recipe's own defaults.
    #[arg(long, value_delimiter = ',', value_name = "a,b")]
    effects: Option<Vec<String>>,
    /// Shading language.
    #[arg(long, value_enum, default_value = "wgsl")]
    to: Target,
    /// Output file; stdout by default.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Meaning of the names on the command line.
enum Selection {
    Modules(Vec<&'static Module>),
    Function(&'static Module, String),
    Recipe(&'static Recipe, Option<String>),
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let selection = select(&arguments.names)?;
    if arguments.effects.is_some() && !matches!(selection, Selection::Recipe(..)) {
        return Err(Failure("--effects is for a recipe; a module has none".to_owned()));
    }
    let bytes = match &selection {
        Selection::Modules(modules) => of_modules(modules, arguments.to)?,
        Selection::Function(module, function) => of_function(module, function, arguments.to)?,
        Selection::Recipe(recipe, entry) => {
            let source = with_effects(recipe, arguments.effects.as_deref())?;
            of_source(&source, recipe.name, arguments.to, entry.as_deref())?
        }
    };
    match &arguments.out {
        Some(path) => {
            file::replace(path, &bytes)?;
            output::line(&path.display().to_string())?;
        }
        None => output::bytes(&bytes)?,
    }
    Ok(Outcome::Passed)
}

fn select(names: &[String]) -> Result<Selection, Failure> {
    let mut modules: Vec<&'static Module> = Vec::new();
    for name in names {
        let (name, part) = name.split_once("::").map_or((name.as_str(), None), |(name, part)| (name, Some(part)));
        let alone = names.len() == 1;
        // No recipe has a module's name; `recipes_keep_the_contract` sees to it.
        let Some(module) = cookbook::module(name) else {
            let Some(recipe) = lapidary_wgsl::recipe(name) else {
                let known: Vec<&str> = cookbook::modules()
                    .iter()
                    .map(|module| module.name)
                    .chain(lapidary_wgsl::RECIPES.iter().map(|recipe| recipe.name))
                    .collect();
                return Err(Failure(format!("no module or recipe `{name}`{}", nearest::suggest(name, &known))));
            };
            if !alone {
                return Err(Failure(format!("`{name}` is a recipe, which holds its modules already; copy it alone")));
            }
            return Ok(Selection::Recipe(recipe, part.map(str::to_owned)));
        };
        if let Some(function) = part {
            let Some(found) = module.function(function) else {
                let known: Vec<&str> = module.functions.iter().map(|function| function.name.as_str()).collect();
                return Err(Failure(format!(
                    "module `{name}` has no function `{function}`{}",
                    nearest::suggest_function(name, function, &known)
                )));
            };
            if !alone {
                return Err(Failure(format!("`{name}::{function}` is one function; copy it alone")));
            }
            return Ok(Selection::Function(module, found.name.clone()));
        }
        if !modules.iter().any(|known| known.name == module.name) {
            modules.push(module);
        }
    }
    Ok(Selection::Modules(modules))
}

fn of_modules(modules: &[&Module], to: Target) -> Result<Vec<u8>, Failure> {
    let names: Vec<&str> = modules.iter().map(|module| module.name).collect();
    if to.needs_entry_point() {
        let first = &modules[0].functions[0].name;
        let message = format!(
            "SPIR-V and GLSL hold entry points, so that a function is wrapped in one; name a function, such as {}::{first}",
            names[0]
        );
        return Err(Failure(message));
    }
    of_source(&lapidary_wgsl::compose(&names, ""), &names.join("+"), to, None)
}

fn of_function(module: &Module, function: &str, to: Target) -> Result<Vec<u8>, Failure> {
    if to == Target::Wgsl {
        // A function may call others of its module, and WGSL needs no entry point, so the whole
        // module is copied.
        let is_naive = module.function(function).is_some_and(|function| function.accuracy == Accuracy::Naive);
        return Ok(if is_naive { module.whole } else { module.source }.as_bytes().to_vec());
    }
    let kernel = KernelModule::reflect(module.whole, module.name, function)?;
    let mut ir = kernel.module;
    naga::compact::compact(&mut ir, naga::compact::KeepUnused::No);
    let info = lapidary_specialise::validate(&ir).map_err(|error| Failure(error.to_string()))?;
    translate(&ir, &info, to, Some((ENTRY_POINT, naga::ShaderStage::Compute))).map_err(Failure)
}

fn of_source(source: &str, name: &str, to: Target, entry: Option<&str>) -> Result<Vec<u8>, Failure> {
    if to == Target::Wgsl {
        return Ok(source.as_bytes().to_vec());
    }
    let (ir, info) = dispatch::parse(source, name)?;
    let points: Vec<String> = ir.entry_points.iter().map(|point| format!("{name}::{}", point.name)).collect();
    let entry = match entry {
        None => None,
        Some(entry) => match ir.entry_points.iter().find(|point| point.name == entry) {
            Some(point) => Some((entry, point.stage)),
            None => {
                return Err(Failure(format!("`{name}` has no entry point `{entry}`; there are {}", points.join(", "))));
            }
        },
    };
    if to == Target::Glsl && entry.is_none() {
        return Err(Failure(format!("GLSL holds one entry point; name one of {}", points.join(", "))));
    }
    // The writers do not support overrides: each is replaced by its default here.
    let constants = naga::back::PipelineConstants::default();
    let (ir, info) = naga::back::pipeline_constants::process_overrides(
        &ir,
        &info,
        entry.map(|(name, stage)| (stage, name)),
        &constants,
    )
    .map_err(|error| Failure(error.to_string()))?;
    translate(&ir, &info, to, entry).map_err(Failure)
}

/// Returns the recipe to paste, without marks. If effects are named, the lines of all others are cut,
/// and modules that nothing uses any more are left out.
fn with_effects(recipe: &Recipe, wanted: Option<&[String]>) -> Result<String, Failure> {
    let source = recipe.compose();
    let known = effects(&source);
    // `--effects ""` switches all effects off.
    let wanted = wanted.map(|wanted| wanted.iter().filter(|effect| !effect.is_empty()).collect::<Vec<_>>());
    if let Some(unknown) = wanted.iter().flatten().find(|effect| !known.contains(effect)) {
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        return Err(Failure(format!(
            "recipe `{}` has no effect `{unknown}`{}",
            recipe.name,
            nearest::suggest(unknown, &names)
        )));
    }
    let off = known.iter().filter(|effect| wanted.as_ref().is_some_and(|wanted| !wanted.contains(effect)));
    let off: Vec<&str> = off.map(String::as_str).collect();
    let text = marks::without(recipe, &off).map_err(|fault| Failure(format!("{}: {}", recipe.name, fault.message)))?;
    let switched = text.lines().map(|line| match effect_of(line) {
        Some(effect) if wanted.is_some() => format!("override {}: bool = true;", override_of(&effect)),
        _ => line.to_owned(),
    });
    Ok(switched.collect::<Vec<_>>().join("\n") + "\n")
}
