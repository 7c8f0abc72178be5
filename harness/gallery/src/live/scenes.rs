//! The scenes of the live pages: their rungs, what can be switched and what can be moved.

use super::slider::{
    ABSORPTION, DISPERSION_STRENGTH, EXPOSURE, FREE_PATH, INDEX, LIGHT_POWER, LIGHT_TURN, ROUGHNESS, Slider,
};
use lapidary_plan::quality::{Quality, Technique};
use lapidary_plan::{Effect, Effects};
use lapidary_render::Settings;
use std::cmp::Ordering;

/// Width and height of a live picture in pixels: the largest that is drawn without tiles.
pub const SIDE: u32 = 512;
/// Samples along each side of a pixel.
pub const SAMPLES: u32 = 3;
/// Those of the frames that the ladder timed.
pub const TIMED_SAMPLES: u32 = 1;

/// A scene that a page draws live.
#[derive(Debug)]
pub struct LiveScene {
    /// Name of the built-in scene; its page is `live/NAME.html`.
    pub scene: &'static str,
    /// Title of the page.
    pub title: &'static str,
    /// What one can try there, in plain words.
    pub summary: &'static str,
    /// The rungs to choose from; the first is drawn at first.
    pub rungs: &'static [&'static str],
    /// Name of the plot that a measured time is drawn into.
    pub ladder: &'static str,
    /// The ladder that holds the rungs' errors and times.
    pub technique: Technique,
    /// Width and height in pixels of the frames that the ladder timed.
    pub timed_side: u32,
    /// Effects to switch.
    pub toggles: &'static [Toggle],
    /// What can be moved.
    pub sliders: &'static [&'static Slider],
    /// Whether a picture can be given as the environment.
    pub environment: bool,
}

impl LiveScene {
    /// Returns the rungs as a menu lists them, each with the qualities that choose it: the one that is drawn at first,
    /// the other defaults, and the rest by their times.
    #[must_use]
    pub fn menu(&self) -> Vec<(&'static str, String)> {
        let qualities = |rung: &str| {
            let chosen = Quality::ALL.into_iter().filter(|quality| self.technique.rung(*quality).to_string() == rung);
            chosen.map(|quality| quality.to_string()).collect::<Vec<_>>().join(", ")
        };
        let ladder = self.technique.ladder();
        let time = |rung: &str| ladder.and_then(|ladder| ladder.step(rung)).map_or(f64::INFINITY, |step| step.ms);
        let mut menu: Vec<_> = self.rungs.iter().map(|rung| (*rung, qualities(rung))).collect();
        menu[1..].sort_by(|(a, a_chosen), (b, b_chosen)| {
            (a_chosen.is_empty(), time(a)).partial_cmp(&(b_chosen.is_empty(), time(b))).unwrap_or(Ordering::Equal)
        });
        menu
    }
}

/// An effect that can be switched.
#[derive(Debug)]
pub struct Toggle {
    /// The effect.
    pub effect: Effect,
    /// What it does, in a few words.
    pub label: &'static str,
    /// Whether it is on at first.
    pub on: bool,
}

impl Toggle {
    /// Switches the effect.
    pub fn set(&self, settings: &mut Settings, on: bool) {
        match self.effect {
            Effect::Footprint => settings.gem.footprint = on,
            Effect::Shadow => settings.shadows = on,
            Effect::HalfSpace => settings.half_space = on,
            effect if !on => settings.without = settings.without.and(Effects::of(&[effect])),
            _ => {}
        }
    }

    /// The option of `cook render` for the effect when it is on, and when it is off; empty if none is needed.
    #[must_use]
    pub fn options(&self) -> [String; 2] {
        match self.effect {
            Effect::Footprint => ["--footprint".to_owned(), String::new()],
            Effect::Shadow | Effect::HalfSpace => [format!("--with {}", self.effect), String::new()],
            effect => [String::new(), format!("--without {effect}")],
        }
    }
}

const fn toggle(effect: Effect, label: &'static str, on: bool) -> Toggle {
    Toggle { effect, label, on }
}

const STONE_RUNGS: &[&str] = &[
    "walk-8+tracker",
    "walk-4",
    "walk-8",
    "walk-16+tracker",
    "walk-4+tracker",
    "walk-2+tracker",
    "convex-8+tracker",
    "bvh-8+tracker",
    "proxy-4+tracker",
    "proxy-1+tracker",
    "surface",
];

const DISPERSION: Toggle = toggle(Effect::Dispersion, "dispersion: an index for each colour", true);
const FOOTPRINT: Toggle = toggle(Effect::Footprint, "facets’ edges inside smoothed", false);
const AROUND: Toggle = toggle(Effect::Environment, "light from all around", true);
const HIGHLIGHTS: Toggle = toggle(Effect::Microfacet, "highlights of the rough surface", true);

/// Returns the page that draws a rung of a ladder live, from the site's folder: that which begins with it, or else the
/// first that can be switched to it.
#[must_use]
pub fn page_of(ladder: &str, rung: &str) -> Option<String> {
    let mut scenes: Vec<&LiveScene> =
        SCENES.iter().filter(|live| live.ladder == ladder && live.rungs.contains(&rung)).collect();
    scenes.sort_by_key(|live| live.rungs[0] != rung);
    let live = scenes.first()?;
    let state = if live.rungs[0] == rung { String::new() } else { format!("#rung={}", rung.replace('+', "%2B")) };
    Some(format!("live/{}.html{state}", live.scene))
}

/// Every live scene.
pub const SCENES: [LiveScene; 5] = [
    LiveScene {
        scene: "brilliant",
        title: "A diamond, live",
        summary: "Turn the stone, move its index of refraction from water’s to beyond diamond’s, and see what each rung of the ladder \
            leaves out: choose a second one beside it and move the wipe.",
        rungs: STONE_RUNGS,
        ladder: "convex",
        timed_side: 256,
        technique: Technique::Convex,
        toggles: &[DISPERSION, FOOTPRINT],
        sliders: &[&INDEX, &DISPERSION_STRENGTH, &EXPOSURE],
        environment: true,
    },
    LiveScene {
        scene: "ruby",
        title: "A ruby, live",
        summary: "The same cut in corundum, whose colour is absorbed on the way inside: long ways are darker than short ones.",
        rungs: STONE_RUNGS,
        ladder: "convex",
        timed_side: 256,
        technique: Technique::Convex,
        toggles: &[DISPERSION, toggle(Effect::Absorption, "absorption inside", true), FOOTPRINT],
        sliders: &[&INDEX, &ABSORPTION, &DISPERSION_STRENGTH, &EXPOSURE],
        environment: true,
    },
    LiveScene {
        scene: "skin_ring",
        title: "A ring of skin, live",
        summary: "Light creeps round what is curved: make the free path longer and watch the shadow’s edge soften, red first. Choose \
            lambert beside it and move the wipe: that law knows none of it.",
        rungs: &["drift", "accurate", "cheap", "wrap", "lambert"],
        ladder: "cdrf",
        timed_side: 512,
        technique: Technique::Cdrf,
        toggles: &[
            toggle(Effect::HalfSpace, "the law of a half space", true),
            toggle(Effect::Shadow, "shadows", true),
            HIGHLIGHTS,
        ],
        sliders: &[&FREE_PATH, &ROUGHNESS, &LIGHT_TURN, &LIGHT_POWER, &EXPOSURE],
        environment: false,
    },
    LiveScene {
        scene: "bunny",
        title: "A marble bunny by paths of light, live",
        summary: "Light takes the cheapest way from the sun to each voxel, and is found anew whenever the sun or the stone changes; turning \
            the bunny needs none of it.",
        rungs: &["godunov-64", "godunov-32", "diffusion-64", "lambert-shadowed", "lambert"],
        ladder: "translucent",
        timed_side: 512,
        technique: Technique::Translucent,
        toggles: &[AROUND, HIGHLIGHTS],
        sliders: &[&FREE_PATH, &ROUGHNESS, &LIGHT_TURN, &LIGHT_POWER, &EXPOSURE],
        environment: false,
    },
    LiveScene {
        scene: "dragon",
        title: "A jade dragon by diffusion, live",
        summary: "Light diffuses through veined jade on a grid, solved anew whenever the sun or the stone changes: turn the sun behind the \
            dragon and let it shine through claws and crest.",
        rungs: &["diffusion-64", "diffusion-32", "godunov-64", "lambert-shadowed"],
        ladder: "translucent",
        timed_side: 512,
        technique: Technique::Diffusion,
        toggles: &[AROUND],
        sliders: &[&FREE_PATH, &LIGHT_TURN, &LIGHT_POWER, &EXPOSURE],
        environment: false,
    },
];
