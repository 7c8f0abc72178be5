//! The shader of each rung that a quality chooses, to paste: what `cook copy` writes for the values that the renderer
//! gives it.

use super::choices::Choice;
use super::ladder::Kind;
use crate::cookbook::marks;
use lapidary_plan::Rung;
use lapidary_render::Settings;
use lapidary_scene::Scene;
use lapidary_translate::fitted::with_constants;
use serde::Serialize;

/// A shader to take.
#[derive(Clone, Debug, Serialize)]
pub struct Take {
    /// The ladder, quality and rung.
    pub choice: Choice,
    /// The recipe that draws the rung.
    pub recipe: &'static str,
    /// The command that writes the text.
    pub command: String,
    /// Name of the text's data.
    pub source: String,
    /// The text.
    #[serde(skip)]
    pub text: String,
    /// Its number of lines.
    pub lines: usize,
}

/// Why a choice has no shader to take.
#[derive(Debug, thiserror::Error)]
#[error("the shader of `{rung}` cannot be copied: {what}")]
pub struct TakeError {
    rung: String,
    what: String,
}

/// Returns the shader of a choice, as the frame of its ladder's scene has it.
///
/// # Errors
/// Returns an error if the scene does not load or the recipe is not well formed.
pub fn take(choice: &Choice) -> Result<Take, TakeError> {
    let fault = |what: String| TakeError { rung: choice.rung.clone(), what };
    let kind = Kind::named(choice.ladder).ok_or_else(|| fault("no such ladder".to_owned()))?;
    let rung: Rung = choice.rung.parse().map_err(|_| fault("no such rung".to_owned()))?;
    let recipe = lapidary_wgsl::recipe(rung.recipe()).ok_or_else(|| fault("no recipe draws it".to_owned()))?;
    let scene = Scene::named(kind.scene()).map_err(|error| fault(error.to_string()))?;
    let settings = Settings { rung, ..Settings::of_size(64, 64) };
    let frame = lapidary_render::frame(None, &scene, &settings).map_err(|error| fault(error.to_string()))?;
    let drawn = frame.pipelines.iter().find(|pipeline| pipeline.shader.recipe() == recipe.name);
    let overrides = drawn.ok_or_else(|| fault("its frame does not run it".to_owned()))?.shader.overrides();
    let source = recipe.compose();
    let known = marks::effects(&source);
    let effects: Vec<&str> = known
        .iter()
        .map(String::as_str)
        .filter(|effect| value_of(overrides, &marks::override_of(effect)).is_some_and(|value| value != 0.0))
        .collect();
    let cut = marks::with_effects(recipe, Some(&effects), &[]).map_err(|error| fault(error.message))?;
    let set = set(&cut, overrides);
    let values: Vec<(&str, &str)> = set.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
    let text = with_constants(&cut, &values, &[]).map_err(|error| fault(error.to_string()))?;
    let given: Vec<String> = set.iter().map(|(name, value)| [name, "=", value].concat()).collect();
    let option = |name: &str, values: &[String]| match values {
        [] => String::new(),
        values => [" --", name, " ", &values.join(",")].concat(),
    };
    let effects: Vec<String> = effects.into_iter().map(str::to_owned).collect();
    Ok(Take {
        recipe: recipe.name,
        command: [
            "./cook copy ",
            recipe.name,
            &option("effects", &effects),
            &option("set", &given),
            " --out ",
            recipe.name,
            ".wgsl",
        ]
        .concat(),
        source: ["source/rung_", choice.ladder, "_", choice.quality].concat(),
        lines: text.lines().count(),
        text,
        choice: choice.clone(),
    })
}

fn value_of(overrides: &[(String, f64)], name: &str) -> Option<f64> {
    overrides.iter().find(|(other, _)| other == name).map(|(_, value)| *value)
}

/// Returns the overrides of a text that are no effects, with the frame's values as `--set` takes them; those that have
/// their default are left as they are.
fn set(text: &str, overrides: &[(String, f64)]) -> Vec<(String, String)> {
    let of = |line: &str| {
        let (name, rest) = line.strip_prefix("override ")?.split_once(':')?;
        let (ty, default) = rest.split_once('=')?;
        let default = default.trim().trim_end_matches(';').trim_end_matches(['u', 'f']);
        let value = value_of(overrides, name.trim())?;
        let value = match ty.trim() {
            "bool" => (value != 0.0).to_string(),
            _ => value.to_string(),
        };
        let is_effect = name.starts_with("EFFECT_");
        (!is_effect && value != default).then(|| (name.trim().to_owned(), value))
    };
    text.lines().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::choices;
    use super::*;

    #[test]
    fn a_rung_is_taken_with_its_values() {
        let all = choices::all();
        let take = |quality: &str| {
            let choice = all.iter().find(|choice| choice.ladder == "convex" && choice.quality == quality);
            take(choice.expect("there")).expect("taken")
        };
        let good = take("good");
        assert_eq!(good.recipe, "gem_walk");
        assert!(good.text.contains("const BOUNCES: u32 = 8u;"), "{}", good.command);
        assert!(good.text.contains("override EFFECT_DISPERSION: bool = true;"), "{}", good.command);
        assert!(good.command.contains("dispersion") && good.command.contains("BOUNCES=8"), "{}", good.command);
        let fast = take("fast");
        assert!(!fast.text.contains("dispersion_tracker") && fast.command.contains("BOUNCES=4"), "{}", fast.command);
    }

    #[test]
    fn every_choice_can_be_taken_and_is_valid() {
        for choice in choices::all() {
            let take = take(&choice).expect("taken");
            let module =
                naga::front::wgsl::parse_str(&take.text).unwrap_or_else(|error| panic!("{}: {error}", take.command));
            let mut validator =
                naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
            validator.validate(&module).unwrap_or_else(|error| panic!("{}: {error}", take.command));
        }
    }
}
