//! What each effect costs in time, SPIR-V instructions and bytes of resources: frames with the
//! effect alone, without any effect, and with all of them.

mod tables;

use super::timing::{self, Timed, Timing};
use super::{CostError, Row};
use lapidary_gpu::Gpu;
use lapidary_plan::{Decisions, Effect, Effects, Rung};
use lapidary_render::plan::Plan;
use lapidary_render::{Curvature, DiffuseOptions, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Environment, Light, Scene};
use serde::{Deserialize, Serialize};

/// The ladder's name.
pub const TECHNIQUE: &str = "effects";

/// How thoroughly to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
}

impl Default for Options {
    fn default() -> Self {
        Self { rounds: 7, frame: [480, 270] }
    }
}

/// A frame with some of a study's effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// `none`, `all`, or the one effect that is on (with its prerequisite, if it has one).
    pub effects: String,
    /// SPIR-V instructions of all pipelines together.
    pub instructions: usize,
    /// Number of pipelines.
    pub pipelines: usize,
    /// Number of draws and dispatches.
    pub steps: u32,
    /// Bytes of all resources for a picture of the timed size.
    pub bytes: u64,
    /// The frame's times; `None` if timing was skipped.
    pub timing: Option<Timing>,
}

/// One scene drawn with one rung, whose effects are switched on and off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// Name of the scene.
    pub scene: String,
    /// Name of the rung.
    pub rung: String,
    /// The frames without any effect, with each effect alone, and with all.
    pub frames: Vec<Frame>,
}

/// The results of all studies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectsReport {
    /// The device and its driver.
    pub adapter: String,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// Rounds of timing.
    pub rounds: u32,
    /// The studies in the order of measurement.
    pub studies: Vec<Study>,
}

/// A scene and settings in which every listed effect is on.
struct Case {
    name: &'static str,
    scene: Scene,
    settings: Settings,
    /// The effects that are switched one by one.
    effects: &'static [Effect],
    /// Pairs of an effect and its prerequisite, without which it would be off itself.
    stands_on: &'static [(Effect, Effect)],
}

/// Returns a small sky; its size is not meant to be typical.
fn sky() -> Environment {
    let pixel = |index: u32| {
        let height = 1.0 - (index / 64) as f32 / 32.0;
        [0.2 + 0.3 * height, 0.3 + 0.4 * height, 0.5 + 0.5 * height, 1.0]
    };
    Environment::Map(EnvironmentMap { width: 64, height: 32, pixels: (0..64 * 32).map(pixel).collect() })
}

/// Returns the scene with only its first object.
fn one(name: &str) -> Result<Scene, CostError> {
    let scene = Scene::named(name).map_err(CostError::from)?;
    Ok(Scene { objects: scene.objects.into_iter().take(1).collect(), ..scene })
}

/// Returns the scene with only its first object, and a spot in place of each sun.
fn spotlit(name: &str) -> Result<Scene, CostError> {
    let scene = one(name)?;
    let bounds = scene.bounds();
    let spot = |light: &Light| match *light {
        Light::Directional { toward, irradiance } => {
            let distance = 4.0 * bounds.radius();
            Light::Spot {
                position: bounds.centre() + distance * toward,
                direction: -toward,
                intensity: distance * distance * irradiance,
                inner_angle: 0.3,
                outer_angle: 0.5,
            }
        }
        other => other,
    };
    Ok(Scene { lights: scene.lights.iter().map(spot).collect(), ..scene })
}

fn cases(frame: [u32; 2]) -> Result<Vec<Case>, CostError> {
    let settings = |rung: &str| {
        let rung: Rung = rung.parse().unwrap_or(Rung::ByMaterial);
        Settings { samples: 1, rung, environment: sky(), ..Settings::of_size(frame[0], frame[1]) }
    };
    let mut thin = one("ruby")?;
    for object in &mut thin.objects {
        object.material.thickness = 0.0;
    }
    let mut veined = spotlit("dragon")?;
    for object in &mut veined.objects {
        object.material.roughness = 0.3;
    }
    Ok(vec![
        Case {
            name: "ruby",
            scene: one("ruby")?,
            settings: settings("proxy-4+tracker"),
            effects: &[Effect::ProxyGeometry, Effect::Absorption, Effect::Dispersion, Effect::EnvironmentMap],
            stands_on: &[(Effect::Absorption, Effect::ProxyGeometry), (Effect::Dispersion, Effect::ProxyGeometry)],
        },
        Case {
            name: "ruby",
            scene: one("ruby")?,
            settings: settings("convex-4+tracker"),
            effects: &[Effect::ConvexTrace, Effect::Absorption, Effect::Dispersion, Effect::EnvironmentMap],
            stands_on: &[(Effect::Absorption, Effect::ConvexTrace), (Effect::Dispersion, Effect::ConvexTrace)],
        },
        Case {
            name: "ruby",
            scene: one("ruby")?,
            settings: settings("bvh-4+tracker"),
            effects: &[Effect::BvhTrace, Effect::Absorption, Effect::Dispersion, Effect::EnvironmentMap],
            stands_on: &[(Effect::Absorption, Effect::BvhTrace), (Effect::Dispersion, Effect::BvhTrace)],
        },
        Case {
            name: "ruby, a thin wall",
            scene: thin,
            settings: settings("by-material"),
            effects: &[Effect::ThinWall, Effect::EnvironmentMap],
            stands_on: &[],
        },
        Case {
            name: "wax_ring, spots for suns",
            scene: spotlit("wax_ring")?,
            settings: settings("accurate"),
            effects: &[Effect::Cdrf, Effect::Environment, Effect::Microfacet, Effect::Spot],
            stands_on: &[],
        },
        Case {
            name: "jade_ring",
            scene: one("jade_ring")?,
            settings: Settings {
                diffuse: DiffuseOptions { curvature: Curvature::Vertex, ..DiffuseOptions::default() },
                ..settings("table-256-rgba8")
            },
            effects: &[Effect::Cdrf, Effect::Environment, Effect::Reflection, Effect::EnvironmentMap],
            stands_on: &[(Effect::EnvironmentMap, Effect::Reflection)],
        },
        Case {
            name: "wax_bunny",
            scene: one("wax_bunny")?,
            settings: settings("lambert-shadowed"),
            effects: &[Effect::Shadow, Effect::Environment, Effect::Microfacet],
            stands_on: &[],
        },
        Case {
            name: "wax_ring",
            scene: one("wax_ring")?,
            settings: settings("blur"),
            effects: &[Effect::TextureDiffusion, Effect::Environment, Effect::Microfacet],
            stands_on: &[],
        },
        Case {
            name: "dragon, rough, spots for suns",
            scene: veined,
            settings: settings("godunov-64"),
            effects: &[
                Effect::OpticalPath,
                Effect::Surface,
                Effect::Color,
                Effect::ExtinctionPerVoxel,
                Effect::Environment,
                Effect::Microfacet,
                Effect::Spot,
            ],
            stands_on: &[
                (Effect::Surface, Effect::OpticalPath),
                (Effect::Color, Effect::OpticalPath),
                (Effect::ExtinctionPerVoxel, Effect::OpticalPath),
            ],
        },
    ])
}

impl Case {
    /// Returns the names and settings of the frames.
    fn frames(&self) -> Vec<(String, Settings)> {
        let without = |kept: &[Effect]| {
            let gone = self.effects.iter().filter(|effect| !kept.contains(effect));
            let gone = gone.fold(Effects::NONE, |all, effect| all.and(Effects::of(&[*effect])));
            Settings { without: gone, ..self.settings.clone() }
        };
        let mut frames = vec![("none".to_owned(), without(&[]))];
        frames.extend(self.effects.iter().map(|effect| {
            let under = self.stands_on.iter().find(|(upper, _)| upper == effect).map(|(_, under)| *under);
            let kept: Vec<Effect> = under.into_iter().chain([*effect]).collect();
            (under.map_or_else(|| effect.to_string(), |under| format!("{effect}, on {under}")), without(&kept))
        }));
        frames.push(("all".to_owned(), without(self.effects)));
        frames
    }
}

/// Measures all studies. `progress` receives the current step, the work done and the total.
///
/// # Errors
///
/// Returns an error if a scene cannot be made or if the device fails.
pub fn run(
    gpu: &Gpu,
    options: &Options,
    progress: &mut dyn FnMut(&'static str, u64, u64),
) -> Result<EffectsReport, CostError> {
    let cases = cases(options.frame)?;
    let mut studies = Vec::new();
    let mut timed = Vec::new();
    for case in &cases {
        let mut frames = Vec::new();
        for (effects, settings) in case.frames() {
            let listing = Plan::of(&case.scene, &settings)?.listing;
            frames.push(Frame {
                effects,
                instructions: listing.pipelines.iter().map(|pipeline| pipeline.instructions).sum(),
                pipelines: listing.pipelines.len(),
                steps: listing.steps.iter().map(|step| step.times).sum(),
                bytes: listing.bytes(),
                timing: None,
            });
            timed.push(Timed { source: None, settings, scene: &case.scene, displayed: true, scales: false });
        }
        let drawn =
            case.scene.objects.iter().map(|object| Decisions::of(object, &case.scene, &case.settings.request()));
        let rung = drawn.map(|decisions| decisions.rung).next().unwrap_or(case.settings.rung).to_string();
        studies.push(Study { scene: case.name.to_owned(), rung, frames });
    }
    if options.rounds > 0 {
        let timings = timing::time(gpu, &timed, options.rounds, &mut |done, total| progress("timing", done, total))?;
        let frames = studies.iter_mut().flat_map(|study| &mut study.frames);
        for (frame, timing) in frames.zip(timings) {
            frame.timing = Some(timing);
        }
    }
    Ok(EffectsReport { adapter: gpu.describe(), frame: options.frame, rounds: options.rounds, studies })
}

impl Study {
    /// Returns the frame to compare with: the one with only the prerequisite, or else the one
    /// without effects.
    fn below(&self, frame: &Frame) -> Option<&Frame> {
        let under = frame.effects.split_once(", on ").map_or("none", |(_, under)| under);
        self.frames.iter().find(|other| other.effects == under)
    }
}

impl EffectsReport {
    /// Returns one row per frame of each study.
    pub fn rows(&self) -> Vec<EffectRow> {
        let rows = self.studies.iter().flat_map(|study| {
            study.frames.iter().map(|frame| EffectRow {
                row: Row {
                    technique: TECHNIQUE,
                    rung: study.rung.clone(),
                    view: study.scene.clone(),
                    error: None,
                    error_measure: "none",
                    ms: frame.timing.map(|timing| timing.ms),
                    dominated: false,
                    adapter: self.adapter.clone(),
                },
                effects: frame.effects.clone(),
                instructions: frame.instructions,
                pipelines: frame.pipelines,
                steps: frame.steps,
                bytes: frame.bytes,
            })
        });
        rows.collect()
    }

    /// Returns the report as text.
    pub fn text(&self) -> String {
        tables::text(self)
    }
}

/// A frame as output by `--json`.
#[derive(Clone, Debug, Serialize)]
pub struct EffectRow {
    /// The fields that rows of all ladders share.
    #[serde(flatten)]
    pub row: Row,
    /// The same as [`Frame::effects`].
    pub effects: String,
    /// The same as [`Frame::instructions`].
    pub instructions: usize,
    /// The same as [`Frame::pipelines`].
    pub pipelines: usize,
    /// The same as [`Frame::steps`].
    pub steps: u32,
    /// The same as [`Frame::bytes`].
    pub bytes: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_is_studied_where_it_is_on() {
        let mut studied = Effects::NONE;
        for case in cases([16, 16]).expect("built in") {
            let decisions = Decisions::of(&case.scene.objects[0], &case.scene, &case.settings.request());
            for effect in case.effects {
                assert!(decisions.has(*effect), "{}: {effect} is off", case.name);
                studied = studied.and(Effects::of(&[*effect]));
            }
        }
        for effect in Effect::ALL {
            assert!(studied.has(effect), "{effect} is studied nowhere");
        }
    }

    #[test]
    fn more_effects_take_more() {
        for case in cases([16, 16]).expect("built in") {
            let of = |settings: &Settings| {
                let listing = Plan::of(&case.scene, settings).expect("a plan").listing;
                let instructions: usize = listing.pipelines.iter().map(|pipeline| pipeline.instructions).sum();
                (instructions, listing.bytes())
            };
            let frames = case.frames();
            let counts: Vec<(usize, u64)> = frames.iter().map(|(_, settings)| of(settings)).collect();
            let (none, all) = (counts[0], counts[counts.len() - 1]);
            for ((name, _), (instructions, bytes)) in frames.iter().zip(&counts).skip(1) {
                assert!(*instructions > none.0 && *instructions <= all.0, "{}: {name}: {counts:?}", case.name);
                assert!(*bytes >= none.1 && *bytes <= all.1, "{}: {name}: {counts:?}", case.name);
            }
        }
    }
}
