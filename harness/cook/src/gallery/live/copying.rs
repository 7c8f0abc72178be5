//! The command that writes the text of a recipe as a pipeline draws with it.

use crate::cookbook::marks;
use serde_json::Value;

/// The start of the names of overrides that switch effects.
const EFFECT: &str = "EFFECT_";

/// Returns the `cook copy` command for a pipeline of a frame's description: its effects, and its overrides that are
/// left without the others; `None` if it has no recipe of the cookbook.
#[must_use]
pub fn command(pipeline: &Value) -> Option<String> {
    let name = pipeline["recipe"].as_str()?;
    let recipe = lapidary_wgsl::RECIPES.iter().find(|recipe| recipe.name == name)?;
    let overrides = pipeline["overrides"].as_object()?;
    let is_on = |effect: &String| {
        let value = overrides.get(&[EFFECT, &effect.to_uppercase()].concat()).and_then(Value::as_f64);
        value.is_some_and(|value| value != 0.0)
    };
    let effects: Vec<String> = marks::effects(&recipe.compose()).into_iter().filter(is_on).collect();
    let wanted: Vec<&str> = effects.iter().map(String::as_str).collect();
    let text = marks::with_effects(recipe, Some(&wanted), &[]).ok()?;
    let mut words = vec!["./cook copy".to_owned(), name.to_owned(), "--effects".to_owned()];
    words.push(if effects.is_empty() { "\"\"".to_owned() } else { effects.join(",") });
    for (of, value) in overrides.iter().filter(|(of, _)| !of.starts_with(EFFECT)) {
        let value = value.as_f64()?;
        match type_of(&text, of) {
            None => {}
            Some("bool") => words.push(format!("--set {of}={}", value != 0.0)),
            Some(_) => words.push(format!("--set {of}={value}")),
        }
    }
    Some(words.join(" "))
}

/// The type of a text's override; `None` if it declares none of this name.
fn type_of<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let declared = text.split("override ").skip(1).filter_map(|rest| rest.split_once(':'));
    let rest = declared.filter(|(found, _)| found.trim() == name).map(|(_, rest)| rest).next()?;
    rest.split(['=', ';']).next().map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_command_names_what_is_on_and_the_constants_that_are_left() {
        let overrides = json!({"BOUNCES": 8.0, "END_AT_FIRST_EXIT": 0.0, "SCREEN_STEPS": 8.0, "EFFECT_CONVEX_TRACE": 1.0, "EFFECT_DISPERSION": 0.0});
        let found = command(&json!({"recipe": "gem_walk", "overrides": overrides}));
        assert_eq!(
            found.as_deref(),
            Some("./cook copy gem_walk --effects convex_trace --set BOUNCES=8 --set END_AT_FIRST_EXIT=false")
        );
        assert_eq!(command(&json!({"recipe": "none", "overrides": {}})), None);
    }
}
