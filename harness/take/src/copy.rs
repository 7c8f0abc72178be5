//! `cook copy`.

use lapidary_assay::dispatch::{self, KernelModule};
use lapidary_command::{Failure, Outcome, output};
use lapidary_cookbook::marks::{self, effects};
use lapidary_cookbook::{self as cookbook, Module};
use lapidary_files::nearest;
use lapidary_translate::declarations::{declarations, functions, of_functions};
use lapidary_translate::fitted::{in_group, with_constants, with_private};
use lapidary_translate::{Language, TranslateError, library, shader, spirv};
use lapidary_wgsl::Recipe;
use std::path::PathBuf;

/// Prints one self-contained file to paste: modules, or a recipe with everything that it requires.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook copy refraction fresnel --out optics.wgsl\n  ./cook copy fresnel --to glsl-es --out fresnel.glsl\n  ./cook copy gem --effects proxy_geometry --to hlsl --out gem.hlsl\n  ./cook copy gem_walk::gem_radiance --effects convex_trace --set BOUNCES=8 --private view --group 3\n  ./cook copy refraction::refract --to spirv --out refract.spv"
)]
pub struct Arguments {
    /// Modules, or one recipe. MODULE::FUNCTION is one function with what it needs, and so is
    /// RECIPE::FUNCTION, where an entry point is a function too. In SPIR-V a module's function is
    /// wrapped in a compute kernel. A recipe's GLSL holds one entry point.
    #[arg(required = true, value_name = "MODULE|RECIPE")]
    names: Vec<String>,
    /// Effects of a recipe to keep, switched on; the others are cut out of the text, with the modules
    /// that only they use. If omitted, all are kept, with the recipe's own defaults.
    #[arg(long, value_delimiter = ',', value_name = "a,b")]
    effects: Option<Vec<String>>,
    /// Overrides of a recipe to write as constants, without the branches that they rule out.
    #[arg(long, value_delimiter = ',', value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Bindings of a recipe to declare as private variables instead: your own stage sets them, from what
    /// it has already, before it calls a function. `BINDING[LENGTH]` for an array without a length.
    #[arg(long, value_delimiter = ',', value_name = "BINDING")]
    private: Vec<String>,
    /// Puts all bindings of a recipe into this group, numbered from 0: a number, a constant's name, or what
    /// a preprocessor replaces, such as #{MATERIAL_BIND_GROUP}.
    #[arg(long)]
    group: Option<String>,
    /// Shading language.
    #[arg(long, value_enum, default_value = "wgsl")]
    to: Target,
    /// Output file; stdout by default.
    #[arg(short, long, value_name = "FILE")]
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

/// A module or recipe, and the functions of it that are wanted; all if none are named.
struct Wanted<T: 'static> {
    of: &'static T,
    functions: Vec<String>,
}

/// Meaning of the names on the command line.
enum Selection {
    Modules(Vec<Wanted<Module>>),
    Recipe(Wanted<Recipe>),
}

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let bytes = match select(&arguments.names)? {
        Selection::Modules(modules) => {
            let for_recipes = [
                ("--effects", arguments.effects.is_some()),
                ("--set", !arguments.set.is_empty()),
                ("--private", !arguments.private.is_empty()),
                ("--group", arguments.group.is_some()),
            ];
            if let Some((option, _)) = for_recipes.iter().find(|(_, is_given)| *is_given) {
                return Err(Failure(format!(
                    "{option} is for a recipe; a module has no effects, overrides or bindings"
                )));
            }
            of_modules(&modules, arguments.to)?
        }
        Selection::Recipe(recipe) => of_recipe(&recipe, arguments)?,
    };
    match &arguments.out {
        Some(path) => {
            lapidary_files::replace(path, &bytes)?;
            output::line(&path.display().to_string())?;
        }
        None => output::bytes(&bytes)?,
    }
    Ok(Outcome::Passed)
}

fn select(names: &[String]) -> Result<Selection, Failure> {
    let mut modules: Vec<Wanted<Module>> = Vec::new();
    let mut recipes: Vec<Wanted<Recipe>> = Vec::new();
    for name in names {
        let (name, part) = name.split_once("::").map_or((name.as_str(), None), |(name, part)| (name, Some(part)));
        // No recipe has a module's name; `recipes_keep_the_contract` sees to it.
        if let Some(module) = cookbook::module(name) {
            let known: Vec<&str> = module.functions.iter().map(|function| function.name.as_str()).collect();
            let function = part.map(|part| match module.function(part) {
                Some(found) => Ok(found.name.clone()),
                None => {
                    let suggestion = nearest::suggest_function(name, part, &known);
                    Err(Failure(format!("module `{name}` has no function `{part}`{suggestion}")))
                }
            });
            add(&mut modules, module, |it| it.name, function.transpose()?);
        } else if let Some(recipe) = lapidary_wgsl::recipe(name) {
            let function = part.map(|part| function_of(recipe, part)).transpose()?;
            add(&mut recipes, recipe, |it| it.name, function);
        } else {
            let modules = cookbook::modules().iter().map(|module| module.name);
            let known: Vec<&str> = modules.chain(lapidary_wgsl::RECIPES.iter().map(|recipe| recipe.name)).collect();
            return Err(Failure(format!("no module or recipe `{name}`{}", nearest::suggest(name, &known))));
        }
    }
    match (recipes.pop(), recipes.is_empty() && modules.is_empty()) {
        (None, _) => Ok(Selection::Modules(modules)),
        (Some(recipe), true) => Ok(Selection::Recipe(recipe)),
        (Some(recipe), false) => {
            let name = recipe.of.name;
            Err(Failure(format!("`{name}` is a recipe, which holds its modules already; copy it alone")))
        }
    }
}

/// Adds a name to those that came before; one without a function stands for all functions.
fn add<T: 'static>(
    wanted: &mut Vec<Wanted<T>>,
    item: &'static T,
    name: impl Fn(&'static T) -> &'static str,
    function: Option<String>,
) {
    match (wanted.iter_mut().find(|other| name(other.of) == name(item)), function) {
        (None, function) => wanted.push(Wanted { of: item, functions: function.into_iter().collect() }),
        (Some(other), None) => other.functions.clear(),
        (Some(other), Some(_)) if other.functions.is_empty() => {}
        (Some(other), Some(function)) => other.functions.push(function),
    }
}

/// Returns the whole name of a recipe's function, which may be given without the recipe's own.
fn function_of(recipe: &Recipe, part: &str) -> Result<String, Failure> {
    let source = recipe.compose();
    let known = functions(&source);
    let whole = format!("{}_{part}", recipe.name);
    if let Some(found) = known.iter().find(|known| **known == part || **known == whole) {
        return Ok((*found).to_owned());
    }
    // Those of modules have pages of their own.
    let modules: Vec<String> = recipe.requires().into_iter().map(|module| format!("{module}_")).collect();
    let candidates = known.into_iter().filter(|name| !modules.iter().any(|start| name.starts_with(start)));
    let suggestion = nearest::suggest(part, &candidates.collect::<Vec<_>>());
    Err(Failure(format!("recipe `{}` has no function `{part}`{suggestion}", recipe.name)))
}

fn of_modules(modules: &[Wanted<Module>], to: Target) -> Result<Vec<u8>, Failure> {
    if to == Target::Spirv {
        return match modules {
            [Wanted { of: item, functions }] if functions.len() == 1 => kernel(item, &functions[0]),
            _ => {
                let (module, function) = (modules[0].of.name, &modules[0].of.functions[0].name);
                Err(Failure(format!(
                    "SPIR-V holds entry points, so that a function is wrapped in one; name one function, such as {module}::{function}"
                )))
            }
        };
    }
    let texts = modules.iter().map(|Wanted { of: item, functions }| {
        let wanted: Vec<&str> = functions.iter().map(String::as_str).collect();
        // The module's own functions stand in `whole` as well, below the naive forms' own comment.
        let some = of_functions(item.whole, &wanted).filter(|_| !wanted.is_empty());
        let text = some.unwrap_or_else(|| item.source.to_owned());
        match to.language() {
            None => Ok(text),
            Some(language) => library(&text, item.name, language),
        }
    });
    Ok(texts.collect::<Result<Vec<_>, _>>()?.join("\n").into_bytes())
}

/// Returns the SPIR-V of a module's function, wrapped in a compute kernel.
fn kernel(module: &Module, function: &str) -> Result<Vec<u8>, Failure> {
    let mut ir = KernelModule::reflect(module.whole, module.name, function)?.module;
    naga::compact::compact(&mut ir, naga::compact::KeepUnused::No);
    spirv(&ir).map_err(Failure)
}

fn of_recipe(recipe: &Wanted<Recipe>, arguments: &Arguments) -> Result<Vec<u8>, Failure> {
    let (name, to) = (recipe.of.name, arguments.to);
    let fitting = [("--private", !arguments.private.is_empty()), ("--group", arguments.group.is_some())];
    if let Some((option, _)) = fitting.iter().find(|(_, is_given)| *is_given && to != Target::Wgsl) {
        return Err(Failure(format!("{option} is for WGSL; leave it or --to out")));
    }
    let in_recipe = |error: TranslateError| match error {
        TranslateError::NoSuch { what, name: unknown, known } if !known.is_empty() => {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            Failure(format!("recipe `{name}` has no {what} `{unknown}`{}", nearest::suggest(&unknown, &known)))
        }
        error => Failure(format!("recipe `{name}`: {error}")),
    };
    let values = arguments.set.iter().map(|set| set.split_once('=').filter(|(name, _)| !name.is_empty()).ok_or(set));
    let values = values.collect::<Result<Vec<_>, _>>();
    let values = values.map_err(|set| Failure(format!("--set {set}: give a name and a value, such as BOUNCES=8")))?;
    if let (Some(_), Some((effect, _))) =
        (&arguments.effects, values.iter().find(|(name, _)| name.starts_with("EFFECT_")))
    {
        return Err(Failure(format!("--set {effect}: --effects says which effects are on; leave one out")));
    }
    let wanted: Vec<&str> = recipe.functions.iter().map(String::as_str).collect();
    let with_effects = with_effects(recipe.of, arguments.effects.as_deref(), &wanted)?;
    let source = with_constants(&with_effects, &values, &wanted).map_err(in_recipe)?;
    if to == Target::Wgsl {
        let some = match wanted.as_slice() {
            [] => source,
            wanted => of_functions(&source, wanted).ok_or_else(|| {
                let known = functions(&source);
                let gone = wanted.iter().find(|function| !known.contains(function)).unwrap_or(&wanted[0]);
                Failure(format!("`{name}::{gone}` goes with an effect that --effects leaves out"))
            })?,
        };
        let private: Vec<&str> = arguments.private.iter().map(String::as_str).collect();
        if let Some(entry) = entry_of(&some).filter(|_| !private.is_empty()) {
            return Err(Failure(format!(
                "--private: the entry point `{entry}` would read what nobody has set; name functions, such as {name}::FUNCTION"
            )));
        }
        let text = with_private(&some, &private).map_err(in_recipe)?;
        let Some(group) = &arguments.group else { return Ok(text.into_bytes()) };
        if !is_group(group) {
            return Err(Failure(format!(
                "--group {group}: give a number, a constant's name, or a preprocessor's name such as #{{MATERIAL_BIND_GROUP}}"
            )));
        }
        return Ok(in_group(&text, group).into_bytes());
    }
    let (mut ir, _) = dispatch::parse(&source, name)?;
    let points: Vec<&str> = ir.entry_points.iter().map(|point| point.name.as_str()).collect();
    let entry = match wanted.as_slice() {
        [] => None,
        [entry] if points.contains(entry) => Some(*entry),
        _ => {
            let known: Vec<String> = points.iter().map(|point| format!("{name}::{point}")).collect();
            return Err(Failure(format!(
                "in other languages than WGSL a recipe's bindings belong to an entry point; name one of {}",
                known.join(", ")
            )));
        }
    };
    if let Some(language) = to.language() {
        return Ok(shader(&source, name, language, entry)?.into_bytes());
    }
    if let Some(entry) = entry {
        let entry = entry.to_owned();
        ir.entry_points.retain(|point| point.name == entry);
    }
    spirv(&ir).map_err(Failure)
}

/// Returns the name of an entry point in a text, if there is one.
fn entry_of(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().collect();
    let found = declarations(&lines).into_iter().find(|declaration| declaration.is_entry)?;
    found.name.map(str::to_owned)
}

/// Whether it is a group's number, a constant's name, or a name that a preprocessor replaces.
fn is_group(text: &str) -> bool {
    let is_plain = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    // Neither a number nor a word of WGSL.
    let is_name = |name: &str| is_plain(name) && dispatch::parse(&format!("const {name}: u32 = 0u;"), "group").is_ok();
    match text.strip_prefix("#{").and_then(|rest| rest.strip_suffix('}')) {
        Some(name) => is_plain(name),
        None => text.parse::<u8>().is_ok_and(|number| number.to_string() == text) || text.split("::").all(is_name),
    }
}

/// Returns the recipe to paste, without marks. If effects are named, the lines of all others are cut,
/// and modules that nothing uses any more, these functions included, are left out.
fn with_effects(recipe: &Recipe, wanted: Option<&[String]>, functions: &[&str]) -> Result<String, Failure> {
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
    let wanted: Option<Vec<&str>> = wanted.map(|wanted| wanted.iter().map(|effect| effect.as_str()).collect());
    marks::with_effects(recipe, wanted.as_deref(), functions)
        .map_err(|fault| Failure(format!("{}: {}", recipe.name, fault.message)))
}
