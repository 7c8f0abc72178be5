//! The part of a page that draws a scene live: its controls, and the scripts that run them.

use super::super::templates::{self, Markup};
use super::error::LiveError;
use super::poster;
use super::scenes::{LiveScene, SAMPLES, SIDE, TIMED_SAMPLES};
use lapidary_scene::Scene;
use serde::Serialize;

/// The executor of frames, which the examples for engines use too.
const EXECUTOR: &str = include_str!("../../../../docs/engines/frame.js");
/// What draws by it.
const DRAWING: &str = include_str!("live.js");
/// The controls.
const CONTROLS: &str = include_str!("live_page.js");

#[derive(Serialize)]
struct Shown<'a> {
    scene: &'a str,
    summary: &'a str,
    side: u32,
    timed_side: u32,
    timed_samples: u32,
    samples: u32,
    poster: String,
    command: String,
    rungs: Vec<Choice>,
    toggles: Vec<ToggleRow>,
    sliders: Vec<SliderRow>,
    environment: bool,
    executor: Markup,
    drawing: Markup,
    controls: Markup,
}

/// A rung in a menu, and the qualities that choose it.
#[derive(Serialize)]
struct Choice {
    name: &'static str,
    qualities: String,
}

#[derive(Serialize)]
struct ToggleRow {
    name: &'static str,
    label: &'static str,
    on: bool,
}

#[derive(Serialize)]
struct SliderRow {
    name: &'static str,
    label: &'static str,
    unit: &'static str,
    last: usize,
    start: usize,
    value: String,
}

/// Returns the live part of a page in a folder of the site; its style is `assets/live.css`.
///
/// # Errors
/// If the scene does not load.
pub fn section(live: &LiveScene) -> Result<Markup, LiveError> {
    let scene = Scene::named(live.scene)?;
    let sliders = live.sliders.iter().map(|slider| {
        let (values, start) = slider.values(&scene);
        let (name, label, unit) = (slider.name, slider.label, slider.unit);
        SliderRow { name, label, unit, last: values.len() - 1, start, value: shown(values[start]) }
    });
    let toggle =
        |toggle: &super::scenes::Toggle| ToggleRow { name: toggle.effect.name(), label: toggle.label, on: toggle.on };
    let values = Shown {
        scene: live.scene,
        summary: live.summary,
        side: SIDE,
        timed_side: live.timed_side,
        timed_samples: TIMED_SAMPLES,
        samples: SAMPLES,
        poster: format!("../{}", poster(live)),
        command: format!("./cook render {} --rung {} --samples {SAMPLES}", live.scene, live.rungs[0]),
        rungs: live.menu().into_iter().map(|(name, qualities)| Choice { name, qualities }).collect(),
        toggles: live.toggles.iter().map(toggle).collect(),
        sliders: sliders.collect(),
        environment: live.environment,
        executor: Markup(EXECUTOR.to_owned()),
        drawing: Markup(DRAWING.to_owned()),
        controls: Markup(CONTROLS.to_owned()),
    };
    Ok(templates::render("live.html", values))
}

/// A number with three digits.
fn shown(value: f32) -> String {
    let digits = (2 - value.abs().max(1e-6).log10().floor() as i32).clamp(0, 6);
    let text = format!("{value:.*}", digits as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
