//! A live scene as data: the frames of its rungs with each choice of effects, and what its sliders move.

use super::again::again;
use super::copying;
use super::error::LiveError;
use super::fields::{self, Fields, Place};
use super::scenes::{LiveScene, SAMPLES, SIDE, TIMED_SAMPLES, Toggle};
use super::slider::{Moves, Slider};
use super::store::Store;
use lapidary_plan::{Decisions, ladder::Ladder};
use lapidary_render::Settings;
use lapidary_render::frame::Frame;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Environment, Scene};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Name of the effect that a picture as environment switches on.
const MAP: &str = "environment_map";

/// What `data/live/SCENE.js` holds.
#[derive(Debug, Serialize)]
pub struct Manifest {
    scene: &'static str,
    side: u32,
    samples: u32,
    /// The frames to time: their width and height, and samples along each side of a pixel, as in the ladder.
    timed: Value,
    /// The version that exported it.
    version: &'static str,
    /// The rung to begin with.
    rung: &'static str,
    /// Name of the plot.
    ladder: &'static str,
    /// The texture that a picture replaces, and the effect that it switches on; null if it lights nothing there.
    environment: Option<Value>,
    /// The start of the camera's way around the scene.
    orbit: Value,
    toggles: BTreeMap<&'static str, Value>,
    sliders: BTreeMap<&'static str, Value>,
    /// The rungs by name.
    pub rungs: BTreeMap<&'static str, Rung>,
}

/// A rung of a live scene.
#[derive(Debug, Serialize)]
pub struct Rung {
    /// Mean error and time in the ladder; null if it has no such rung.
    error: Option<f64>,
    ms: Option<f64>,
    /// The recipe that draws the scene.
    recipe: String,
    /// The effects that can be switched with it.
    toggles: Vec<&'static str>,
    /// The frame of each choice of effects: those that are on, joined by `+`.
    pub frames: BTreeMap<String, String>,
    /// The frame to time, with the effects that are on at first.
    pub timed: String,
    /// What the sliders move.
    pub moves: Vec<Move>,
}

/// A field that a slider moves, with its value at each step.
#[derive(Clone, Debug, Serialize)]
pub struct Move {
    /// Name of the slider.
    pub slider: &'static str,
    /// Where the field stands.
    pub at: Vec<Place>,
    /// Its value at each step.
    pub nodes: Vec<Vec<f32>>,
}

/// A frame and its shaders' texts.
struct Made {
    frame: Frame,
    document: Value,
    texts: Vec<String>,
}

/// Tables of moves that were found, by slider, field, and values at the start and some steps.
type Found = HashMap<(&'static str, String, Vec<u32>), Vec<Vec<f32>>>;

/// Writes the frames of a live scene to the store, and returns what the page needs to know of them.
pub fn manifest(live: &LiveScene, store: &mut Store) -> Result<Manifest, LiveError> {
    let scene = Scene::named(live.scene)?;
    let mut found = Found::new();
    let mut rungs = BTreeMap::new();
    for name in live.rungs {
        rungs.insert(*name, rung(live, &scene, name, store, &mut found)?);
    }
    let sliders = live.sliders.iter().map(|slider| {
        let (values, start) = slider.values(&scene);
        // With the digits of an f32.
        let values: Vec<f64> = values.iter().filter_map(|value| value.to_string().parse().ok()).collect();
        (slider.name, json!({"values": values, "start": start, "unit": slider.unit, "option": slider.option}))
    });
    let toggles = live.toggles.iter().map(|toggle| {
        let [on, off] = toggle.options();
        (toggle.effect.name(), json!({"on": toggle.on, "options": {"on": on, "off": off}}))
    });
    Ok(Manifest {
        scene: live.scene,
        side: SIDE,
        samples: SAMPLES,
        timed: json!({"side": live.timed_side, "samples": TIMED_SAMPLES}),
        version: env!("CARGO_PKG_VERSION"),
        rung: live.rungs[0],
        ladder: live.ladder,
        environment: live.environment.then(|| json!({"effect": MAP, "texture": "environment map"})),
        orbit: orbit(&scene),
        toggles: toggles.collect(),
        sliders: sliders.collect(),
        rungs,
    })
}

/// The camera: where it looks, from where, and the ball that its depth encloses.
fn orbit(scene: &Scene) -> Value {
    let camera = &scene.camera;
    let back = (camera.eye - camera.target).as_dvec3();
    let (distance, back) = (back.length(), back.normalize());
    let bounds = scene.bounds();
    json!({
        "buffer": "view", "clip": "clip_from_world", "eye": "eye",
        "target": camera.target.to_array(),
        "distance": distance,
        "polar": back.y.acos().to_degrees(),
        "azimuth": back.x.atan2(back.z).to_degrees(),
        "scale": 1.0 / (0.5 * f64::from(camera.vertical_fov)).tan(),
        "centre": bounds.centre().to_array(),
        "radius": bounds.radius(),
    })
}

/// Returns the settings of a rung, with effects switched.
pub fn settings(live: &LiveScene, rung: &str, is_on: impl Fn(&Toggle) -> bool) -> Result<Settings, LiveError> {
    let rung = rung.parse().map_err(|_| LiveError::Rung(rung.to_owned()))?;
    let mut settings = Settings { rung, samples: SAMPLES, ..Settings::of_size(SIDE, SIDE) };
    for toggle in live.toggles {
        toggle.set(&mut settings, is_on(toggle));
    }
    Ok(settings)
}

/// Returns the effects whose switch changes what is drawn.
fn applicable(live: &'static LiveScene, scene: &Scene, rung: &str) -> Result<Vec<&'static Toggle>, LiveError> {
    let mut applicable = Vec::new();
    for toggle in live.toggles {
        let decided = |on: bool| -> Result<_, LiveError> {
            let switched = |other: &Toggle| if other.effect == toggle.effect { on } else { other.on };
            let settings = settings(live, rung, switched)?;
            Ok(Decisions::all(scene, &settings.request()).iter().map(Decisions::on).collect::<Vec<_>>())
        };
        if decided(true)? != decided(false)? {
            applicable.push(toggle);
        }
    }
    Ok(applicable)
}

fn rung(
    live: &LiveScene,
    scene: &Scene,
    name: &'static str,
    store: &mut Store,
    found: &mut Found,
) -> Result<Rung, LiveError> {
    let live =
        super::SCENES.iter().find(|known| known.scene == live.scene).ok_or_else(|| LiveError::Rung(name.to_owned()))?;
    let toggles = applicable(live, scene, name)?;
    let base_settings = settings(live, name, |toggle| toggle.on)?;
    let base = make(scene, &base_settings)?;
    let moves = moves(live, scene, &base_settings, &base, found)?;
    let mut moved: BTreeSet<&str> =
        moves.iter().flat_map(|movement| &movement.at).map(|place| place.buffer.as_str()).collect();
    moved.extend(["view", "environment map"]);
    let choices: Vec<(usize, bool)> = (0..1 << toggles.len())
        .flat_map(|set| [(set, false), (set, true)])
        .filter(|(_, map)| live.environment || !map)
        .collect();
    let made: Vec<(String, Made)> = choices
        .into_par_iter()
        .map(|(set, map)| {
            let has = |toggle: &Toggle| {
                toggles.iter().position(|other| other.effect == toggle.effect).map(|place| set >> place & 1 == 1)
            };
            let mut settings = settings(live, name, |toggle| has(toggle).unwrap_or(toggle.on))?;
            if map {
                settings.environment = gray();
            }
            let on = toggles.iter().filter(|toggle| has(toggle) == Some(true)).map(|toggle| toggle.effect.name());
            let key = on.chain(map.then_some(MAP)).collect::<Vec<_>>().join("+");
            Ok((key, make(scene, &settings)?))
        })
        .collect::<Result<_, LiveError>>()?;
    let mut frames = BTreeMap::new();
    for (key, made) in made {
        frames.insert(key, store_frame(store, made, &moved)?);
    }
    let timed = Settings { width: live.timed_side, height: live.timed_side, samples: TIMED_SAMPLES, ..base_settings };
    let timed = store_frame(store, make(scene, &timed)?, &BTreeSet::new())?;
    let step = Ladder::committed(live.technique).and_then(|ladder| ladder.step(name));
    Ok(Rung {
        error: step.map(|step| step.error),
        ms: step.map(|step| step.ms),
        recipe: recipe(&base.document),
        toggles: toggles.iter().map(|toggle| toggle.effect.name()).collect(),
        frames,
        timed,
        moves,
    })
}

/// An environment of one gray, in whose place a page puts another.
fn gray() -> Environment {
    Environment::Map(EnvironmentMap { width: 2, height: 2, pixels: vec![[0.5, 0.5, 0.5, 1.0]; 4] })
}

fn make(scene: &Scene, settings: &Settings) -> Result<Made, LiveError> {
    let frame = lapidary_render::frame(None, scene, settings)?;
    let texts: Result<Vec<String>, _> = frame.pipelines.iter().map(|pipeline| pipeline.shader.wgsl()).collect();
    let document = serde_json::to_value(frame.document())?;
    Ok(Made { texts: texts?, document, frame })
}

/// The places of the pipelines of the pass that draws the scene, in the order of its draws.
fn drawing(document: &Value) -> Vec<usize> {
    let passes = document["passes"].as_array().into_iter().flatten();
    let draws = passes.filter(|pass| pass["name"] == "scene").filter_map(|pass| pass["draws"].as_array()).flatten();
    draws.filter_map(|draw| usize::try_from(draw["pipeline"].as_u64()?).ok()).collect()
}

/// The recipe of the first draw of the pass that draws the scene.
fn recipe(document: &Value) -> String {
    let pipeline = drawing(document).first().map_or(&Value::Null, |place| &document["pipelines"][*place]);
    pipeline["recipe"].as_str().unwrap_or_default().to_owned()
}

/// Stores a frame's shaders and contents, and then its description, which names them.
fn store_frame(store: &mut Store, made: Made, moved: &BTreeSet<&str>) -> Result<String, LiveError> {
    let Made { frame, mut document, texts } = made;
    let is_moved = |place: &usize| moved.contains(frame.resources[*place].name.as_str());
    let places = (0..frame.resources.len()).filter(is_moved).map(|place| place as u64);
    document["again"] = serde_json::to_value(again(&document, &texts, places))?;
    for place in drawing(&document) {
        document["pipelines"][place]["copy"] = copying::command(&document["pipelines"][place]).into();
    }
    for (place, text) in texts.iter().enumerate() {
        document["pipelines"][place]["wgsl"] = store.put(text.as_bytes())?.into();
    }
    for (place, resource) in frame.resources.iter().enumerate() {
        if resource.is_left_out() {
            return Err(LiveError::LeftOut(resource.name.clone()));
        }
        if let Some(bytes) = fields::contents(resource) {
            document["resources"][place]["contents"] = store.put(bytes)?.into();
        }
        // The renderer makes these once for each frame; a page writes them.
        if is_moved(&place)
            && let Some(usage) = document["resources"][place]["usage"].as_array_mut()
            && !usage.iter().any(|flag| flag == "COPY_DST")
        {
            usage.push("COPY_DST".into());
        }
    }
    Ok(store.put(serde_json::to_string(&document)?.as_bytes())?)
}

/// Finds what each slider moves in a rung's frame.
fn moves(
    live: &LiveScene,
    scene: &Scene,
    settings: &Settings,
    base: &Made,
    found: &mut Found,
) -> Result<Vec<Move>, LiveError> {
    let mut all = Vec::new();
    for slider in live.sliders {
        let (values, start) = slider.values(scene);
        let sliding = Sliding { slider, values: &values, start, scene, settings, base };
        let tables = match slider.moves {
            Moves::Fields(rule) => sliding.by_fields(rule),
            Moves::Scene(change) => sliding.by_frames(change, found)?,
        };
        // Buffers of all bodies often hold the same.
        let mut grouped: Vec<Move> = Vec::new();
        for (place, nodes) in tables {
            let is_read = || fields::is_read(&base.frame, &base.texts, &base.document, &place);
            if !moves_at_all(&nodes, &nodes[start]) || !is_read() {
                continue;
            }
            match grouped.iter_mut().find(|group| group.nodes == nodes && group.at[0].field == place.field) {
                Some(group) => group.at.push(place),
                None => grouped.push(Move { slider: slider.name, at: vec![place], nodes }),
            }
        }
        all.extend(grouped);
    }
    Ok(all)
}

/// Whether values differ from those at the start by more than their rounding.
fn moves_at_all(nodes: &[Vec<f32>], start: &[f32]) -> bool {
    let size = start.iter().fold(0.0f32, |most, value| most.max(value.abs()));
    nodes.iter().any(|node| node.iter().zip(start).any(|(now, start)| (now - start).abs() > 1e-4 * size))
}

/// The values of fields at each step of a slider.
type Tables = BTreeMap<Place, Vec<Vec<f32>>>;

struct Sliding<'a> {
    slider: &'a Slider,
    values: &'a [f32],
    start: usize,
    scene: &'a Scene,
    settings: &'a Settings,
    base: &'a Made,
}

impl Sliding<'_> {
    fn by_fields(&self, rule: fn(&mut Fields<'_>, f32, f32)) -> Tables {
        let mut tables = Tables::new();
        for (step, value) in self.values.iter().enumerate() {
            let mut fields = Fields::of(&self.base.frame);
            rule(&mut fields, self.values[self.start], *value);
            for (place, value) in fields.changed {
                let value = if step == self.start { fields::value(&self.base.frame, &place) } else { value };
                tables.entry(place).or_default().push(value);
            }
        }
        tables
    }

    /// The fields that differ in the frame of a step.
    fn frame(
        &self,
        change: fn(&mut Scene, &mut Settings, f32),
        step: usize,
    ) -> Result<Vec<(Place, Vec<f32>)>, LiveError> {
        let (mut scene, mut settings) = (self.scene.clone(), self.settings.clone());
        change(&mut scene, &mut settings, self.values[step]);
        let next = lapidary_render::frame(None, &scene, &settings)?;
        let refused = || LiveError::Structure {
            slider: self.slider.name,
            value: self.values[step],
            what: fields::difference(&self.base.frame, &next).unwrap_or_else(|| "bytes outside of fields".to_owned()),
        };
        fields::changed(&self.base.frame, &next).ok_or_else(refused)
    }

    fn by_frames(&self, change: fn(&mut Scene, &mut Settings, f32), found: &mut Found) -> Result<Tables, LiveError> {
        let steps = self.values.len();
        let base = |place: &Place| fields::value(&self.base.frame, place);
        let probes: Vec<BTreeMap<Place, Vec<f32>>> = [0, steps / 3, steps - 1]
            .into_par_iter()
            .map(|step| Ok(self.frame(change, step)?.into_iter().collect()))
            .collect::<Result<_, LiveError>>()?;
        let places: BTreeSet<Place> = probes.iter().flat_map(BTreeMap::keys).cloned().collect();
        let key = |place: &Place| {
            let probed = probes.iter().flat_map(|probe| probe.get(place).cloned().unwrap_or_else(|| base(place)));
            let bits = probed.chain(base(place)).map(f32::to_bits).collect();
            (self.slider.name, place.field.clone(), bits)
        };
        if !places.iter().all(|place| found.contains_key(&key(place))) {
            let frames: Vec<BTreeMap<Place, Vec<f32>>> = (0..steps)
                .into_par_iter()
                .map(|step| {
                    let frame = if step == self.start { Vec::new() } else { self.frame(change, step)? };
                    Ok(frame.into_iter().collect())
                })
                .collect::<Result<_, LiveError>>()?;
            let all: BTreeSet<&Place> = frames.iter().flat_map(BTreeMap::keys).collect();
            for place in &all {
                let nodes = frames.iter().map(|frame| frame.get(*place).cloned().unwrap_or_else(|| base(place)));
                found.insert(key(place), nodes.collect());
            }
        }
        let table = |place: &Place| Some((place.clone(), found.get(&key(place))?.clone()));
        Ok(places.iter().filter_map(table).collect())
    }
}
