//! `cook copy`.

use super::{Failure, Outcome, output};
use lapidary_assay::dispatch::{self, KernelModule};
use lapidary_cook::cookbook::marks::{self, effect_of, effects, override_of};
use lapidary_cook::cookbook::{self, Module};
use lapidary_render::file;
use lapidary_scene::nearest;
use lapidary_translate::declarations::of_function;
use lapidary_translate::{Language, library, shader, spirv};
use lapidary_wgsl::Recipe;
use std::path::PathBuf;

/// Prints one self-contained file to paste: modules, or a recipe with everything that it requires.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook copy refraction fresnel --out optics.wgsl\n  ./cook copy fresnel --to glsl-es --out fresnel.glsl\n  ./cook copy gem --effects proxy_geometry --to hlsl --out gem.hlsl\n  ./cook copy refraction::refract --to spirv --out refract.spv"
)]
pub(super) struct Arguments {
    /// Modules, or one recipe. MODULE::FUNCTION is one function with what it needs; in SPIR-V it is
    /// wrapped in a compute kernel. RECIPE::ENTRY is one entry point, of which a recipe's GLSL holds
    /// no more.
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

/// Output language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Target {
    /// The cookbook's own text.
    Wgsl,
    /// SPIR-V binary, little endian.
    Spirv,
    /// HLSL, shader model 5.1.
    Hlsl,
    /// Metal Shading Language 2.0.
    Msl,
    /// GLSL 4.50.
    Glsl,
    /// GLSL ES 3.00.
    GlslEs,
}

impl Target {
    /// Returns the language of a translated text; `None` for WGSL itself and for SPIR-V.
    fn language(self) -> Option<Language> {
        match self {
            Self::Wgsl | Self::Spirv => None,
            Self::Hlsl => Some(Language::Hlsl),
            Self::Msl => Some(Language::Msl),
            Self::Glsl => Some(Language::Glsl),
            Self::GlslEs => Some(Language::GlslEs),
        }
    }
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
        Selection::Function(module, function) => of_one_function(module, function, arguments.to)?,
        Selection::Recipe(recipe, entry) => {
            let source = with_effects(recipe, arguments.effects.as_deref())?;
            of_recipe(&source, recipe.name, arguments.to, entry.as_deref())?
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
    if to == Target::Spirv {
        let (module, function) = (modules[0].name, &modules[0].functions[0].name);
        let message = format!(
            "SPIR-V holds entry points, so that a function is wrapped in one; name a function, such as {module}::{function}"
        );
        return Err(Failure(message));
    }
    let texts: Vec<String> = match to.language() {
        None => modules.iter().map(|module| module.source.to_owned()).collect(),
        Some(language) => {
            modules.iter().map(|module| library(module.source, module.name, language)).collect::<Result<_, _>>()?
        }
    };
    Ok(texts.join("\n").into_bytes())
}

fn of_one_function(module: &Module, function: &str, to: Target) -> Result<Vec<u8>, Failure> {
    if to == Target::Spirv {
        let kernel = KernelModule::reflect(module.whole, module.name, function)?;
        let mut ir = kernel.module;
        naga::compact::compact(&mut ir, naga::compact::KeepUnused::No);
        return spirv(&ir).map_err(Failure);
    }
    // The module's own functions stand in `whole` as well, below the naive forms' own comment.
    let text = of_function(module.whole, function).unwrap_or_else(|| module.whole.to_owned());
    Ok(match to.language() {
        None => text,
        Some(language) => library(&text, module.name, language)?,
    }
    .into_bytes())
}

fn of_recipe(source: &str, name: &str, to: Target, entry: Option<&str>) -> Result<Vec<u8>, Failure> {
    let (mut ir, _) = dispatch::parse(source, name)?;
    if let Some(entry) = entry
        && !ir.entry_points.iter().any(|point| point.name == entry)
    {
        let points: Vec<&str> = ir.entry_points.iter().map(|point| point.name.as_str()).collect();
        let suggestion = nearest::suggest_function(name, entry, &points);
        return Err(Failure(format!("`{name}` has no entry point `{entry}`{suggestion}")));
    }
    if let Some(language) = to.language() {
        return Ok(shader(source, name, language, entry)?.into_bytes());
    }
    if to == Target::Wgsl {
        let alone = entry.and_then(|entry| of_function(source, entry));
        return Ok(alone.unwrap_or_else(|| source.to_owned()).into_bytes());
    }
    if let Some(entry) = entry {
        ir.entry_points.retain(|point| point.name == entry);
    }
    spirv(&ir).map_err(Failure)
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
