//! The cookbook as data: what the modules' comments promise, the contract that modules and recipes keep, and how they are written for other
//! shading languages.

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
    /// Its WGSL, as it is pasted.
    pub source: &'static str,
    /// The forms that fail, which follow it.
    pub naive: &'static str,
    /// Both, as they are tested.
    pub whole: &'static str,
    /// Its doc page, Markdown.
    pub page: &'static str,
    /// What its header says.
    pub header: Header,
    /// What its functions' comments say, in order of the files: lines are those of `whole`.
    pub functions: Vec<FunctionDoc>,
}

impl Module {
    /// The function of that WGSL name, with or without the module's prefix.
    pub fn function(&self, name: &str) -> Option<&FunctionDoc> {
        let prefixed = format!("{}_{name}", self.name);
        self.functions.iter().find(|function| function.name == name || function.name == prefixed)
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
                naive: module.naive,
                whole: module.whole,
                page: module.page,
                header: header::parse_header(module.source).unwrap_or_else(|e| fault(module.name, e)),
                functions: header::parse_functions(module.whole).unwrap_or_else(|e| fault(module.name, e)),
            })
            .collect()
    })
}

/// The module of that name.
pub fn module(name: &str) -> Option<&'static Module> {
    modules().iter().find(|module| module.name == name)
}
