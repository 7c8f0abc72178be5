//! A specialised recipe: some of its entry points with override values, and the bindings that
//! remain.

use lapidary_gpu::GpuError;
use lapidary_specialise::spirv_counts::{self, SpirvCounts, SpirvCountsError, spirv_counts};
use lapidary_specialise::{SourceError, SpecialiseError, declared, parse, specialise};
use naga::valid::ModuleInfo;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Why a recipe was not compiled.
#[derive(Debug, thiserror::Error)]
pub enum ShaderError {
    /// The text is not valid.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The recipe cannot be specialised.
    #[error(transparent)]
    Specialise(#[from] SpecialiseError),
    /// The device refused it.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// A recipe specialised to some entry points and override values.
#[derive(Clone, Debug)]
pub struct Shader {
    recipe: String,
    entries: Vec<String>,
    overrides: Vec<(String, f64)>,
    module: naga::Module,
    info: ModuleInfo,
}

/// Texts that this process has parsed: scenes take many variants of few recipes, and parsing takes as long as the rest.
static PARSED: Mutex<BTreeMap<String, naga::Module>> = Mutex::new(BTreeMap::new());

fn parsed(recipe: &str, source: &str) -> Result<naga::Module, SourceError> {
    let known = || PARSED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(module) = known().get(source) {
        return Ok(module.clone());
    }
    // Not under the lock: others may parse other texts meanwhile.
    let (module, _) = parse(source, &format!("recipe {recipe}"))?;
    known().insert(source.to_owned(), module.clone());
    Ok(module)
}

impl Shader {
    /// Specialises the `entries` of `source`, the composed text of `recipe`, to override values:
    /// bools are 0 or 1, and values that the text does not declare are left out.
    pub fn new(recipe: &str, source: &str, entries: &[&str], constants: &[(&str, f64)]) -> Result<Self, ShaderError> {
        let module = parsed(recipe, source)?;
        let declared = declared(&module, constants);
        let (module, info) = specialise(module, &declared, entries).map_err(|error| match error {
            SpecialiseError::NoEntryPoint { .. } => {
                ShaderError::Source(SourceError(format!("recipe {recipe}: {error}")))
            }
            error => error.into(),
        })?;
        Ok(Self {
            recipe: recipe.to_owned(),
            entries: entries.iter().map(|&entry| entry.to_owned()).collect(),
            overrides: declared.iter().map(|&(name, value)| (name.to_owned(), value)).collect(),
            module,
            info,
        })
    }

    /// Name of the recipe.
    #[must_use]
    pub fn recipe(&self) -> &str {
        &self.recipe
    }

    /// The entry points, in the order in which they were requested.
    #[must_use]
    pub fn entries(&self) -> &[String] {
        &self.entries
    }

    /// The override values that the recipe is specialised to.
    #[must_use]
    pub fn overrides(&self) -> &[(String, f64)] {
        &self.overrides
    }

    /// Returns whether `other`, specialised from the same text, is identical.
    pub(crate) fn is_specialised_as(&self, other: &Self) -> bool {
        self.recipe == other.recipe && self.entries == other.entries && self.overrides == other.overrides
    }

    /// Group and number of each binding that remains.
    pub fn bindings(&self) -> impl Iterator<Item = (u32, u32)> {
        let bindings = self.module.global_variables.iter().filter_map(|(_, global)| global.binding);
        bindings.map(|binding| (binding.group, binding.binding))
    }

    /// Returns whether this binding remains.
    #[must_use]
    pub fn binds(&self, group: u32, binding: u32) -> bool {
        self.bindings().any(|remaining| remaining == (group, binding))
    }

    /// Returns the module.
    pub(super) fn module(&self) -> &naga::Module {
        &self.module
    }

    /// Returns the module as WGSL, without overrides.
    ///
    /// # Errors
    /// If naga cannot write it.
    pub fn wgsl(&self) -> Result<String, naga::back::wgsl::Error> {
        naga::back::wgsl::write_string(&self.module, &self.info, naga::back::wgsl::WriterFlags::empty())
    }

    /// Returns the SPIR-V counts of a vertex and a fragment entry point, which must be in this
    /// order.
    pub fn counts(&self) -> Result<SpirvCounts, SpirvCountsError> {
        let [vertex, fragment] = [0, 1].map(|place| self.entries.get(place).map_or("", String::as_str));
        spirv_counts(&self.module, &self.info, vertex, fragment)
    }

    /// Number of instructions of its SPIR-V.
    #[must_use]
    pub fn instructions(&self) -> usize {
        spirv_counts::instructions(&self.module, &self.info)
    }
}
