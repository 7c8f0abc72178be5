//! Scattering bodies compared with random walks: a row for each scene with each way of drawing it, the walks,
//! and what is between the last way and the walks.

use super::frames::{halved, side_by_side};
use super::label::label;
use super::shots::LIGHTS_ALONE;
use super::{EXR_SIDE, SnapshotError, WalkedReference};
use crate::exposure::best_exposure;
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::Scene;
use serde::Deserialize;

/// A comparison of several scenes.
#[derive(Debug)]
pub struct BesideWalks {
    /// Name of the picture's files.
    pub name: &'static str,
    /// Title in the gallery.
    pub title: &'static str,
    /// Description in the gallery.
    pub paragraph: &'static str,
    /// The technique whose folder holds the files.
    pub technique: &'static str,
    /// The scenes, row by row.
    scenes: &'static [&'static str],
    /// The ways of drawing, column by column; the difference of the last one is shown after the walks.
    looks: &'static [Look],
    /// A ladder's committed report, and the measure whose distances and times the labels give. After it was measured
    /// again, the picture is out of date, and is compared as such.
    record: (&'static str, &'static str),
}

/// A way of drawing.
#[derive(Debug)]
struct Look {
    /// The rung.
    rung: &'static str,
    /// Whether the law of a half space is on.
    law: bool,
    /// The label.
    label: &'static str,
    /// Name of the report's row.
    row: &'static str,
}

/// Translucent stone and wax.
pub const STONE: BesideWalks = BesideWalks {
    name: "beside_walks",
    title: "Translucent stone beside random walks",
    paragraph: "Lambert's law with the shadows that bodies cast, light along the cheapest ways, light that diffuses, random walks, and what is \
        between these last two: the absolute difference of the linear radiance, shown as bright as the pictures. Each picture has the one \
        exposure that brings it nearest to the walks. Below each name: the distance from the walks, and the time of 512 by 512 pixels.",
    technique: "optical_path",
    scenes: &["bunny", "dragon", "figure", "wax_bunny"],
    looks: &[plain("lambert-shadowed"), plain("godunov-128"), plain("diffusion-128")],
    record: (include_str!("../../../../docs/measurements/lavapipe/translucent.json"), "walks"),
};

/// A head of skin that is the same everywhere.
pub const HEAD: BesideWalks = BesideWalks {
    name: "head_beside_walks",
    title: "A head beside random walks",
    paragraph: "Lambert's law with shadows, a blur of the irradiance in the scan's texture, the reflectance by curvature with its shadows, random \
        walks, and what is between these last two. Each picture has the one exposure that brings it nearest to the walks. Below each \
        name: the distance from the walks, and the time of 512 by 512 pixels.",
    technique: "cdrf",
    scenes: &["skin_head"],
    looks: &[
        Look { row: "`lambert-shadowed`", ..plain("lambert-shadowed") },
        Look { row: "`blur --with shadow`", label: "blur, shadow", ..plain("blur") },
        Look { row: "`drift --with half_space,shadow`", label: "drift, law, shadow", law: true, ..plain("drift") },
    ],
    record: (include_str!("../../../../docs/measurements/lavapipe/cdrf.json"), "head"),
};

/// All comparisons.
pub const ALL: [&BesideWalks; 2] = [&STONE, &HEAD];

/// Returns the look of a rung alone.
const fn plain(rung: &'static str) -> Look {
    Look { rung, law: false, label: rung, row: rung }
}

impl BesideWalks {
    /// Renders the picture: encoded, and at half that size for its linear radiance.
    ///
    /// # Errors
    /// Returns an error if a reference, a scene or the report does not load, or if the device fails.
    pub fn render(&self, gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
        let record = self.record()?;
        let mut frames = Vec::new();
        for scene_name in self.scenes {
            let Some(reference) = WalkedReference::of_scene(scene_name) else { continue };
            let walks = reference.picture(gpu)?;
            let scene = Scene::named(scene_name)?;
            let mut difference = walks.clone();
            for look in self.looks {
                let mut frame = exposed(gpu, &scene, &look.settings(), &walks)?;
                difference = apart(gpu, &frame, &walks)?;
                let figures = self.figures(&record, look, scene_name);
                let figures = figures.map(|[distance, ms]| format!("{distance:.2}, {ms:.0} ms"));
                label(&mut frame, &[look.label, figures.as_deref().unwrap_or_default()]);
                frames.push(frame);
            }
            let mut walks = walks;
            label(&mut walks, &["random walks", &format!("{} a pixel", reference.walks)]);
            label(&mut difference, &["difference"]);
            frames.extend([walks, difference]);
        }
        let seen = side_by_side(&frames, self.looks.len() as u32 + 2);
        let half = halved(&seen);
        Ok([seen, half])
    }
}

/// What is read of a ladder's report.
#[derive(Debug, Deserialize)]
struct Record {
    rows: Vec<Row>,
}

/// A measurement.
#[derive(Debug, Deserialize)]
struct Row {
    rung: String,
    view: String,
    measure: String,
    value: Option<f64>,
    ms: Option<f64>,
}

impl BesideWalks {
    fn record(&self) -> Result<Record, SnapshotError> {
        serde_json::from_str(self.record.0).map_err(|error| SnapshotError::Record(error.to_string()))
    }

    /// Returns the distance from the walks and the milliseconds.
    fn figures(&self, record: &Record, look: &Look, scene: &str) -> Option<[f64; 2]> {
        let is_it = |row: &&Row| row.rung == look.row && row.view == scene && row.measure == self.record.1;
        let row = record.rows.iter().find(is_it)?;
        Some([row.value?, row.ms?])
    }
}

impl Look {
    fn settings(&self) -> Settings {
        let shadows = self.law || self.rung == "blur";
        Settings { half_space: self.law, shadows, ..settings(self.rung) }
    }
}

/// Returns the settings of a rung, limited to the effects that the walks account for.
///
/// # Panics
/// If no rung has the name `rung`; the names are compiled in.
#[must_use]
pub fn settings(rung: &str) -> Settings {
    Settings {
        rung: rung.parse::<Rung>().unwrap_or_else(|error| panic!("{rung}: {error}")),
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        exposure: LIGHTS_ALONE,
        ..Settings::of_size(EXR_SIDE, EXR_SIDE)
    }
}

/// Renders the picture and multiplies it by the exposure that brings it closest to `truth`.
fn exposed(gpu: &Gpu, scene: &Scene, settings: &Settings, truth: &Picture) -> Result<Picture, SnapshotError> {
    let mut picture = render::render(gpu, scene, settings)?;
    let exposure = best_exposure(&picture.linear, &truth.linear) as f32;
    picture.linear.iter_mut().flat_map(|pixel| &mut pixel[..3]).for_each(|value| *value *= exposure);
    render::encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Returns the absolute difference of two pictures' radiance.
fn apart(gpu: &Gpu, one: &Picture, other: &Picture) -> Result<Picture, SnapshotError> {
    let apart = |(one, other): (&[f32; 4], &[f32; 4])| {
        let [red, green, blue] = [0, 1, 2].map(|channel| (one[channel] - other[channel]).abs());
        [red, green, blue, one[3].max(other[3])]
    };
    let linear = one.linear.iter().zip(&other.linear).map(apart).collect();
    let mut picture = Picture { linear, notes: Vec::new(), ..one.clone() };
    render::encode(gpu, &settings("lambert"), &mut picture)?;
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every label has its figures: the rows are there, timed.
    #[test]
    fn every_look_is_in_its_record() {
        for of in ALL {
            let record = of.record().expect("a report");
            for (look, scene) in of.looks.iter().flat_map(|look| of.scenes.iter().map(move |scene| (look, scene))) {
                assert!(of.figures(&record, look, scene).is_some(), "{scene}, {}", look.row);
                assert!(WalkedReference::of_scene(scene).is_some());
            }
        }
    }
}
