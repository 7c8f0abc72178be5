//! A user's WGSL file: which of the cookbook's functions it contains, which are missing, and what
//! else is in it.

use super::{CheckError, bounds, select};
use lapidary_assay::dispatch;
use lapidary_assay::formula::Formula;
use lapidary_cookbook::{self as cookbook, Module};
use lapidary_files::nearest;
use std::collections::BTreeSet;
use std::path::Path;

/// The source file to check.
#[derive(Clone, Debug)]
pub struct UserFile {
    /// Path of the file, for messages.
    pub path: String,
    /// Text of the file.
    pub text: String,
}

/// The functions of a file to check, and remarks on the rest.
#[derive(Debug)]
pub struct Contents {
    /// The functions to check.
    pub formulas: Vec<&'static Formula>,
    /// One-line notes: functions that are missing or unknown, and other items that are not checked.
    pub notes: Vec<String>,
}

impl UserFile {
    /// Reads a file, and rejects one that no compiler could handle.
    pub fn read(path: &Path) -> Result<UserFile, CheckError> {
        let text = bounds::read(path).map_err(CheckError::File)?;
        let path = path.display().to_string();
        bounds::check(&path, &text).map_err(CheckError::File)?;
        Ok(UserFile { path, text })
    }

    /// Returns the functions in the file that `filter` selects: a module's, a single one, or all of
    /// them (`None`).
    pub fn contents(&self, filter: Option<&str>) -> Result<Contents, CheckError> {
        let in_path = |error| CheckError::Dispatch { path: self.path.clone(), error };
        let asked = select(filter)?;
        let (ir, _) = dispatch::parse(&self.text, &self.path).map_err(in_path)?;
        let held: BTreeSet<&str> = ir.functions.iter().filter_map(|(_, found)| found.name.as_deref()).collect();
        let points: BTreeSet<&str> = ir.entry_points.iter().map(|point| point.name.as_str()).collect();
        let formulas: Vec<&Formula> = asked
            .iter()
            .copied()
            .filter(|formula| held.contains(formula.function) || points.contains(formula.function))
            .collect();
        // A single function requested by name must exist.
        if let ([only], Some(true)) = (asked.as_slice(), filter.map(|filter| filter.contains("::")))
            && formulas.is_empty()
        {
            let error = dispatch::signature::SignatureError::Missing { function: only.function.to_owned() };
            return Err(in_path(error.into()));
        }
        if formulas.is_empty() {
            let scope = filter.map_or("the cookbook".to_owned(), |module| format!("module `{module}`"));
            let message =
                format!("{}: defines no function of {scope} to check; keep the names, or see `./cook list`", self.path);
            return Err(CheckError::File(message));
        }
        let by_function = filter.is_some_and(|filter| filter.contains("::"));
        let mut notes = Vec::new();
        let modules: Vec<&Module> = cookbook::modules()
            .iter()
            .filter(|module| formulas.iter().any(|formula| formula.module == module.name))
            .collect();
        if !by_function {
            for module in &modules {
                notes.extend(self.lacking(module, &asked, &held));
            }
            notes.extend(self.unknown(filter, &held));
            notes.extend(self.others(&ir));
        }
        Ok(Contents { formulas, notes })
    }

    fn lacking(&self, module: &Module, asked: &[&Formula], held: &BTreeSet<&str>) -> Option<String> {
        let lacking: Vec<String> = asked
            .iter()
            .filter(|formula| formula.module == module.name && !held.contains(formula.function))
            .map(|formula| format!("`{}`", formula.function))
            .collect();
        let lacks = lacking.join(", ");
        (!lacking.is_empty()).then(|| format!("{}: lacks {lacks} of module `{}`; not checked", self.path, module.name))
    }

    /// Returns notes on functions that have a module's prefix but do not exist in the module.
    fn unknown(&self, filter: Option<&str>, held: &BTreeSet<&str>) -> Vec<String> {
        let modules = cookbook::modules().iter().filter(|module| filter.is_none_or(|filter| filter == module.name));
        let mut notes = Vec::new();
        for module in modules {
            let prefix = format!("{}_", module.name);
            let known: Vec<&str> = module.functions.iter().map(|function| function.name.as_str()).collect();
            for name in held.iter().filter(|name| name.starts_with(&prefix) && !known.contains(name)) {
                let hint = match nearest::nearest(name, known.iter().copied()) {
                    Some((similarity, near)) if similarity > 0.95 && !held.contains(near) => {
                        format!("; did you mean `{near}`?")
                    }
                    _ => String::new(),
                };
                notes.push(format!(
                    "{}: `{name}` is no function of module `{}`, and is not checked{hint}",
                    self.path, module.name
                ));
            }
        }
        notes
    }

    /// Returns a note on items that a module does not contain; `None` if there are none.
    fn others(&self, ir: &naga::Module) -> Option<String> {
        let names = |kind: &str, names: Vec<&str>| (!names.is_empty()).then(|| format!("{kind} {}", names.join(", ")));
        let variables =
            ir.global_variables.iter().map(|(_, variable)| variable.name.as_deref().unwrap_or("_")).collect();
        let overrides = ir.overrides.iter().map(|(_, value)| value.name.as_deref().unwrap_or("_")).collect();
        let points = ir.entry_points.iter().map(|point| point.name.as_str()).collect();
        let kinds = [names("bindings", variables), names("overrides", overrides), names("entry points", points)];
        let found: Vec<String> = kinds.into_iter().flatten().collect();
        (!found.is_empty())
            .then(|| format!("{}: {} belong to no module, and take no part in the check", self.path, found.join("; ")))
    }
}
