//! The cookbook as data: its modules, what their comments promise, the marks of recipes.

pub mod header;
pub mod marks;
pub mod repository;

use header::{FunctionDoc, Header};
use std::sync::OnceLock;

include!(concat!(env!("OUT_DIR"), "/pages.rs"));

/// WGSL module of one technique.
#[derive(Clone, Debug)]
pub struct Module {
    /// Name, the same in `wgsl/`, `crates/`, `docs/` and `snapshots/`.
    pub name: &'static str,
    /// WGSL text, as it is pasted.
    pub source: &'static str,
    /// Naive forms, which follow the module.
    pub naive: &'static str,
    /// Module and naive forms together, as they are tested.
    pub whole: &'static str,
    /// Doc page in Markdown.
    pub page: &'static str,
    /// Parsed header.
    pub header: Header,
    /// Parsed comments of the functions, in the order of the files; line numbers refer to `whole`.
    pub functions: Vec<FunctionDoc>,
}

impl Module {
    /// Returns the function of that WGSL name, with or without the module's prefix.
    pub fn function(&self, name: &str) -> Option<&FunctionDoc> {
        let prefixed = format!("{}_{name}", self.name);
        self.functions.iter().find(|function| function.name == name || function.name == prefixed)
    }
}

/// Returns all modules, sorted by name.
///
/// # Panics
/// If a module's comments break the contract, with the line and what is expected: the sources are
/// compiled in, so only an edit of the cookbook itself can cause this.
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
                naive: module.naive,
                whole: module.whole,
                page: page(module.name),
                header: header::parse_header(module.source).unwrap_or_else(|e| fault(module.name, e)),
                functions: header::parse_functions(module.whole).unwrap_or_else(|e| fault(module.name, e)),
            })
            .collect()
    })
}

/// Returns the module of that name, or `None`.
pub fn module(name: &str) -> Option<&'static Module> {
    modules().iter().find(|module| module.name == name)
}
