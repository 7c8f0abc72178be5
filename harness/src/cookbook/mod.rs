//! The cookbook as data: which modules and recipes there are, what their comments promise, how they are put together
//! and written for other shading languages.

pub mod accuracy_line;
pub mod header;
pub mod lint;
pub mod marks;
mod precedence;
pub mod release;
pub mod translate;

use header::{FunctionDoc, Header};
use std::sync::OnceLock;

/// One technique's WGSL module.
#[derive(Clone, Debug)]
pub struct Module {
    /// Its name, the same in `wgsl/`, `crates/`, `docs/` and `snapshots/`.
    pub name: &'static str,
    /// Its WGSL.
    pub source: &'static str,
    /// Its doc page, Markdown.
    pub page: &'static str,
    /// What its header says.
    pub header: Header,
    /// What its functions' comments say, in order of the file.
    pub functions: Vec<FunctionDoc>,
}

impl Module {
    /// The function of that WGSL name, with or without the module's prefix.
    pub fn function(&self, name: &str) -> Option<&FunctionDoc> {
        let prefixed = format!("{}_{name}", self.name);
        self.functions.iter().find(|function| function.name == name || function.name == prefixed)
    }
}

/// A complete shader written with the modules' functions.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// Its name.
    pub name: &'static str,
    /// Its WGSL, without the modules that it requires and the parts that it shares.
    pub source: &'static str,
    /// The modules that its `// requires:` line names, in order.
    pub requires: Vec<&'static str>,
    /// The parts that its `// parts:` line names, in order.
    pub parts: Vec<&'static lapidary_wgsl::Part>,
}

impl Recipe {
    /// The whole shader: the required modules in the order of the `// requires:` line, the parts, then the recipe.
    pub fn compose(&self) -> String {
        let parts = self.parts.iter().map(|part| part.source);
        compose(&self.requires, &parts.chain([self.source]).collect::<Vec<_>>().join("\n"))
    }

    /// The recipe's own text: the parts, then the recipe, without the modules.
    pub fn own_text(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.parts.iter().map(|part| part.source).chain([self.source])
    }
}

/// All modules, in the order of their names.
///
/// # Panics
/// Where a module's comments break the contract, with the line and what is expected: the sources are compiled in, so
/// only an edit of the cookbook itself can do this.
pub fn modules() -> &'static [Module] {
    static MODULES: OnceLock<Vec<Module>> = OnceLock::new();
    MODULES.get_or_init(|| {
        let fault = |name: &str, fault: header::HeaderFault| -> ! {
            panic!("wgsl/{name}.wgsl:{}: {}", fault.line, fault.message)
        };
        lapidary_wgsl::MODULES
            .iter()
            .map(|module| Module {
                name: module.name,
                source: module.source,
                page: module.page,
                header: header::parse_header(module.source).unwrap_or_else(|e| fault(module.name, e)),
                functions: header::parse_functions(module.source).unwrap_or_else(|e| fault(module.name, e)),
            })
            .collect()
    })
}

/// What the names of a module's functions, structs and consts start with.
pub fn prefixes(module: &str) -> [String; 3] {
    let camel = module
        .split('_')
        .map(|part| part.chars().next().map_or(String::new(), |c| c.to_uppercase().collect::<String>() + &part[1..]))
        .collect();
    [format!("{module}_"), camel, format!("{}_", module.to_uppercase())]
}

/// The module of that name.
pub fn module(name: &str) -> Option<&'static Module> {
    modules().iter().find(|module| module.name == name)
}

/// All recipes, in the order of their names.
pub fn recipes() -> &'static [Recipe] {
    static RECIPES: OnceLock<Vec<Recipe>> = OnceLock::new();
    RECIPES.get_or_init(|| {
        lapidary_wgsl::RECIPES
            .iter()
            .map(|recipe| Recipe {
                name: recipe.name,
                source: recipe.source,
                requires: named(recipe.source, "// requires:").collect(),
                parts: named(recipe.source, "// parts:").map(part).collect(),
            })
            .collect()
    })
}

/// The recipe of that name.
pub fn recipe(name: &str) -> Option<&'static Recipe> {
    recipes().iter().find(|recipe| recipe.name == name)
}

/// The names on the line that starts with `tag`.
fn named(source: &'static str, tag: &'static str) -> impl Iterator<Item = &'static str> {
    let line = source.lines().find_map(move |line| line.strip_prefix(tag)).unwrap_or_default();
    line.split(',').map(str::trim).filter(|name| !name.is_empty())
}

/// The part of that name, which a recipe's `// parts:` line holds.
fn part(name: &str) -> &'static lapidary_wgsl::Part {
    let found = lapidary_wgsl::PARTS.iter().find(|part| part.name == name);
    found.unwrap_or_else(|| panic!("no part `{name}` in wgsl/recipes/parts"))
}

/// The whole shader of a recipe that is known to exist.
///
/// # Panics
/// Where there is no such recipe: names in the harness are fixed, and a user's is looked up first.
pub fn recipe_source(name: &str) -> String {
    recipe(name).unwrap_or_else(|| panic!("no recipe `{name}`")).compose()
}

/// Modules one after another in the order of `names`, then `last`.
///
/// # Panics
/// Where a module is unknown: recipes are compiled in, and a user's names are looked up first.
pub fn compose(names: &[&str], last: &str) -> String {
    let known = |name: &&str| module(name).unwrap_or_else(|| panic!("no module `{name}`")).source;
    let mut parts: Vec<&str> = names.iter().map(known).collect();
    if !last.is_empty() {
        parts.push(last);
    }
    parts.join("\n")
}
