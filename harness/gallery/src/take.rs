//! The shader of each rung to choose, to paste: what `cook copy` writes for the values that the renderer
//! gives it, below a line that names the rung and the command.

use super::choices::{self, Choice, Heading};
use super::ladder::Kind;
use super::live;
use lapidary_cookbook::marks;
use lapidary_plan::Rung;
use lapidary_render::Settings;
use lapidary_scene::Scene;
use lapidary_translate::fitted::with_constants;
use lapidary_wgsl::Recipe;
use serde::Serialize;

/// A shader to take.
#[derive(Clone, Debug, Serialize)]
pub struct Take {
    /// The ladder, rung and qualities.
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
    /// The id of its row.
    pub id: String,
    /// The page that draws it live, from the site's folder; `None` if none does.
    pub live: Option<String>,
}

/// The shaders of a ladder, under what its figures are of.
#[derive(Debug, Serialize)]
pub struct Group<'a> {
    heading: Heading,
    takes: Vec<&'a Take>,
}

/// Returns the shaders by ladder, in order.
pub fn groups<'a>(takes: impl IntoIterator<Item = &'a Take>) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for take in takes {
        match groups.iter_mut().find(|group| group.takes[0].choice.ladder == take.choice.ladder) {
            Some(group) => group.takes.push(take),
            None => {
                let Some(kind) = Kind::named(take.choice.ladder) else { continue };
                groups.push(Group { heading: choices::heading(kind), takes: vec![take] });
            }
        }
    }
    groups
}

/// Why a choice has no shader to take.
#[derive(Debug, thiserror::Error)]
#[error("the shader of `{rung}` cannot be copied: {what}")]
pub struct TakeError {
    rung: String,
    what: String,
}

/// A recipe fitted to a frame's values.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The text to paste.
    pub text: String,
    /// The `cook copy` command that writes it, to stdout.
    pub command: String,
}

/// Returns a recipe as a frame draws with it: effects that are off are cut out, and overrides that don't have their
/// default are constants.
///
/// # Errors
/// Returns an error, in words, if the recipe is not well formed.
pub fn fitted(recipe: &Recipe, overrides: &[(String, f64)]) -> Result<Fitted, String> {
    let is_on = |effect: &String| value_of(overrides, &marks::override_of(effect)).is_some_and(|value| value != 0.0);
    let effects: Vec<String> = marks::effects(&recipe.compose()).into_iter().filter(is_on).collect();
    let wanted: Vec<&str> = effects.iter().map(String::as_str).collect();
    let cut = marks::with_effects(recipe, Some(&wanted), &[]).map_err(|fault| fault.message)?;
    let set = set(&cut, overrides);
    let values: Vec<(&str, &str)> = set.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
    let text = with_constants(&cut, &values, &[]).map_err(|error| error.to_string())?;
    // Without a name all effects are cut; without the option all would be kept.
    let effects = if effects.is_empty() { "\"\"".to_owned() } else { effects.join(",") };
    let given: Vec<String> = set.iter().map(|(name, value)| [name, "=", value].concat()).collect();
    let given = if given.is_empty() { String::new() } else { [" --set ", &given.join(",")].concat() };
    Ok(Fitted { text, command: ["./cook copy ", recipe.name, " --effects ", &effects, &given].concat() })
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
    let drawn = drawn.ok_or_else(|| fault("its frame does not run it".to_owned()))?;
    let Fitted { text, command } = fitted(recipe, drawn.shader.overrides()).map_err(fault)?;
    // The text itself begins with a module's header, which is the same for many rungs.
    let text = ["// The rung ", &choice.rung, ", by ", &command, "\n\n", &text].concat();
    let id = ["rung_", choice.ladder, "_", &choice.rung.replace('+', "_")].concat();
    Ok(Take {
        recipe: recipe.name,
        command: [&command, " --out ", recipe.name, ".wgsl"].concat(),
        source: ["source/", &id].concat(),
        lines: text.lines().count(),
        id,
        live: live::page_of(choice.ladder, &choice.rung),
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
    let setting_of = |line: &str| {
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
    text.lines().filter_map(setting_of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::choices;
    use super::*;

    #[test]
    fn a_rung_is_taken_with_its_values() {
        let all = choices::all();
        let take = |quality: &str| {
            let choice = all.iter().find(|choice| choice.ladder == "convex" && choice.qualities[0].name == quality);
            take(choice.expect("there")).expect("taken")
        };
        let good = take("good");
        assert_eq!(good.recipe, "gem_walk");
        let command = good.command.strip_suffix(" --out gem_walk.wgsl").expect("a file");
        assert_eq!(good.text.lines().next(), Some(["// The rung walk-8+tracker, by ", command].concat().as_str()));
        assert_eq!(good.source, "source/rung_convex_walk-8_tracker");
        assert!(good.text.contains("const BOUNCES: u32 = 8u;"), "{}", good.command);
        assert!(good.text.contains("override EFFECT_DISPERSION: bool = true;"), "{}", good.command);
        assert!(good.command.contains("dispersion") && good.command.contains("BOUNCES=8"), "{}", good.command);
        assert_eq!(good.live.as_deref(), Some("live/brilliant.html"));
        let fast = take("fast");
        assert_eq!(fast.live.as_deref(), Some("live/brilliant.html#rung=walk-4"));
        assert!(!fast.text.contains("dispersion_tracker") && fast.command.contains("BOUNCES=4"), "{}", fast.command);
    }

    #[test]
    fn a_recipe_without_effects_says_so() {
        let recipe = lapidary_wgsl::recipe("gem_walk").expect("there");
        let overrides = [("BOUNCES".to_owned(), 8.0), ("EFFECT_DISPERSION".to_owned(), 0.0)];
        let fitted = fitted(recipe, &overrides).expect("fitted");
        // Its number of bounces goes with them.
        assert_eq!(fitted.command, "./cook copy gem_walk --effects \"\"");
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
