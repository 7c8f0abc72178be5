//! A recipe with all that its files are made of.

use super::error::DistError;
use lapidary_cookbook::marks;
use lapidary_translate::{Language, TranslateError, shader};
use lapidary_wgsl::Recipe;
use naga::{Module, ShaderStage};

/// A recipe without marks.
pub struct Whole {
    /// The recipe.
    pub recipe: &'static Recipe,
    /// Its whole text.
    pub source: String,
    /// The same for naga.
    pub ir: Module,
    /// The entry points that GLSL ES can say, each with its stage and its text.
    pub glsl_es: Vec<(String, ShaderStage, String)>,
}

impl Whole {
    /// Reads and translates a recipe.
    ///
    /// # Errors
    /// Returns an error if it cannot be written.
    pub fn of(recipe: &'static Recipe) -> Result<Self, DistError> {
        let failed = |message: String| DistError::Recipe { recipe: recipe.name, message };
        let source = marks::without(recipe, &[]).map_err(|fault| failed(fault.message))?;
        let (ir, _) = lapidary_specialise::parse(&source, recipe.name).map_err(TranslateError::from)?;
        let mut glsl_es = Vec::new();
        for point in &ir.entry_points {
            match shader(&source, recipe.name, Language::GlslEs, Some(&point.name)) {
                Ok(text) => glsl_es.push((point.name.clone(), point.stage, text)),
                // The index says so.
                Err(TranslateError::Lacks { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(Self { recipe, source, ir, glsl_es })
    }
}
