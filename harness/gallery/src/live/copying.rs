//! The command that writes the text of a recipe as a pipeline draws with it.

use super::super::take::fitted;
use serde_json::Value;

/// Returns the `cook copy` command for a pipeline of a frame's description; `None` if it has no recipe of the cookbook.
#[must_use]
pub fn command(pipeline: &Value) -> Option<String> {
    let recipe = lapidary_wgsl::recipe(pipeline["recipe"].as_str()?)?;
    let overrides = pipeline["overrides"].as_object()?.iter();
    let overrides: Vec<(String, f64)> =
        overrides.filter_map(|(name, value)| Some((name.clone(), value.as_f64()?))).collect();
    Some(fitted(recipe, &overrides).ok()?.command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_command_names_what_is_on_and_the_constants_that_are_not_the_defaults() {
        let overrides =
            json!({"BOUNCES": 8.0, "END_AT_FIRST_EXIT": 0.0, "EFFECT_CONVEX_TRACE": 1.0, "EFFECT_DISPERSION": 0.0});
        let found = command(&json!({"recipe": "gem_walk", "overrides": overrides}));
        assert_eq!(found.as_deref(), Some("./cook copy gem_walk --effects convex_trace --set BOUNCES=8"));
        assert_eq!(command(&json!({"recipe": "none", "overrides": {}})), None);
    }
}
