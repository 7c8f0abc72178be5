//! The cookbook's WGSL and its composition, for the harness and for Rust engines.
//! Each module is a constant, such as [`REFRACTION`], to be pasted as it is; [`compose`] puts several
//! before a shader of one's own. [`Recipe::compose`] returns the whole shader of a recipe, such as
//! `recipe("gem")`.
//!
//! ```
//! let own = lapidary_wgsl::compose(&["refraction", "fresnel"], "@fragment fn main() {}");
//! assert!(own.starts_with(lapidary_wgsl::REFRACTION));
//! let shader = lapidary_wgsl::recipe("gem").expect("a recipe").compose();
//! assert!(shader.contains("fn gem_fragment"));
//! let module = lapidary_wgsl::module("refraction").expect("a module");
//! assert!(module.source.contains("fn refraction_refract(") && module.naive.contains("fn refraction_refract_naive("));
//! ```

include!(concat!(env!("OUT_DIR"), "/folder.rs"));

/// A technique: pure functions, without bindings and entry points.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    /// The technique's name, which prefixes every name in `source`.
    pub name: &'static str,
    /// WGSL, valid on its own.
    pub source: &'static str,
    /// The naive forms, which fail; they follow `source`. Empty if there are none.
    pub naive: &'static str,
    /// `source` and `naive`.
    pub whole: &'static str,
}

/// A complete shader, written with the functions of the modules that its `// requires:` lines
/// name, after the parts that its `// parts:` lines name.
#[derive(Clone, Copy, Debug)]
pub struct Recipe {
    /// The recipe's name.
    pub name: &'static str,
    /// WGSL with entry points and bindings, without the modules and the parts: not valid on its
    /// own.
    pub source: &'static str,
}

/// WGSL shared by several recipes: overrides, bindings and functions that belong to no module. Not
/// valid on its own.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The part's name.
    pub name: &'static str,
    /// WGSL without entry points.
    pub source: &'static str,
}

/// Returns the module with this name.
#[must_use]
pub fn module(name: &str) -> Option<&'static Module> {
    MODULES.iter().find(|module| module.name == name)
}

/// Returns the recipe with this name.
#[must_use]
pub fn recipe(name: &str) -> Option<&'static Recipe> {
    RECIPES.iter().find(|recipe| recipe.name == name)
}

/// Returns the whole shader of a recipe that is known to exist.
///
/// # Panics
/// If there is no such recipe.
#[must_use]
pub fn recipe_source(name: &str) -> String {
    recipe(name).unwrap_or_else(|| panic!("no recipe `{name}`")).compose()
}

impl Recipe {
    /// Returns the modules that it requires, in order.
    #[must_use]
    pub fn requires(&self) -> Vec<&'static str> {
        named(self.source, "// requires:")
    }

    /// Returns the parts that it shares with other recipes, in order.
    ///
    /// # Panics
    /// If there is no such part, which is a bug in the cookbook.
    #[must_use]
    pub fn parts(&self) -> Vec<&'static Part> {
        let part = |name: &str| {
            let found = PARTS.iter().find(|part| part.name == name);
            found.unwrap_or_else(|| panic!("no part `{name}` in wgsl/recipes/parts"))
        };
        named(self.source, "// parts:").into_iter().map(part).collect()
    }

    /// Returns the modules whose naive form the recipe or one of its parts also draws, for
    /// comparison.
    ///
    /// # Panics
    /// If a part is unknown, which is a bug in the cookbook.
    #[must_use]
    pub fn compares(&self) -> Vec<&'static str> {
        let mut names: Vec<&str> = self.own_text().into_iter().flat_map(|text| named(text, "// compares:")).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Returns the whole shader: the modules, the naive forms for comparison, the parts, then the
    /// recipe.
    ///
    /// # Panics
    /// If a module or part is unknown, which is a bug in the cookbook.
    #[must_use]
    pub fn compose(&self) -> String {
        let naive = self.compares().into_iter().map(|name| known(name).naive);
        compose(&self.requires(), &naive.chain(self.own_text()).collect::<Vec<_>>().join("\n"))
    }

    /// Returns the recipe's own texts: the parts, then the recipe, without the modules.
    ///
    /// # Panics
    /// If a part is unknown, which is a bug in the cookbook.
    #[must_use]
    pub fn own_text(&self) -> Vec<&'static str> {
        self.parts().iter().map(|part| part.source).chain([self.source]).collect()
    }
}

/// Joins the modules in the order of `names`, then `last`.
///
/// # Panics
/// If a module is unknown.
#[must_use]
pub fn compose(names: &[&str], last: &str) -> String {
    let mut texts: Vec<&str> = names.iter().map(|name| known(name).source).collect();
    if !last.is_empty() {
        texts.push(last);
    }
    texts.join("\n")
}

fn known(name: &str) -> &'static Module {
    module(name).unwrap_or_else(|| panic!("no module `{name}`"))
}

/// Returns the prefixes of the names of a module's functions, structs and consts.
#[must_use]
pub fn prefixes(module: &str) -> [String; 3] {
    let camel = module
        .split('_')
        .map(|part| part.chars().next().map_or(String::new(), |c| c.to_uppercase().collect::<String>() + &part[1..]))
        .collect();
    [format!("{module}_"), camel, format!("{}_", module.to_uppercase())]
}

/// Returns the names on the lines that start with `tag`.
fn named(source: &'static str, tag: &str) -> Vec<&'static str> {
    let lines = source.lines().filter_map(|line| line.strip_prefix(tag));
    lines.flat_map(|line| line.split(',')).map(str::trim).filter(|name| !name.is_empty()).collect()
}
