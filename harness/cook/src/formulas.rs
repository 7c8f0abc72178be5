//! Every formula of the cookbook, by module.

use lapidary_assay::formula::Formula;
use std::sync::OnceLock;

// `of_modules`, by the build script from the folder `crates`.
include!(concat!(env!("OUT_DIR"), "/modules.rs"));

/// All formulas, in the order of their modules' names and of each file.
pub fn all() -> &'static [Formula] {
    static FORMULAS: OnceLock<Vec<Formula>> = OnceLock::new();
    FORMULAS.get_or_init(|| of_modules().into_iter().flatten().collect())
}

/// The formula of a WGSL function.
pub fn of_function(function: &str) -> Option<&'static Formula> {
    all().iter().find(|formula| formula.function == function)
}
