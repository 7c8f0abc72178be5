//! Scattering bodies compared with random walks: a row for each scene with each way of drawing it, the walks,
//! and what is between the last way and the walks.

use super::error::SnapshotError;
use super::frames::{halved, side_by_side};
use super::label::label;
use super::shots::LIGHTS_ALONE;
use super::sizes::EXR_SIDE;
use super::walked::WalkedReference;
use crate::exposure::best_exposure;
use lapidary_gpu::Gpu;
use lapidary_plan::ladder::Record;
use lapidary_plan::{Effect, Effects, Rung, Technique};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::Scene;

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
    /// The technique whose committed report the labels take their figures from, and the measure. After it was measured
    /// again, the picture is out of date, and is compared as such.
    record: (Technique, &'static str),
}

/// A way of drawing.
#[derive(Debug)]
struct Look {
    /// The rung.
    rung: &'static str,
    /// Whether the law of a half space is on.
    law: bool,
    /// Whether shadows are on that the rung has not by itself.
    shadows: bool,
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
    record: (Technique::Diffusion, "walks"),
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
        Look { row: "`blur --with shadow`", label: "blur, shadow", shadows: true, ..plain("blur") },
        Look {
            row: "`drift --with half_space,shadow`",
            label: "drift, law, shadow",
            law: true,
            shadows: true,
            ..plain("drift")
        },
    ],
    record: (Technique::Cdrf, "head"),
};

/// All comparisons.
pub const ALL: [&BesideWalks; 2] = [&STONE, &HEAD];

/// Returns the look of a rung alone.
const fn plain(rung: &'static str) -> Look {
    Look { rung, law: false, shadows: false, label: rung, row: rung }
}

impl BesideWalks {
    /// Renders the picture: encoded, and at half that size for its linear radiance.
    ///
    /// # Errors
    /// Returns an error if a reference or a scene does not load or if the device fails.
    pub fn render(&self, gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
        let (technique, measure) = self.record;
        let record = Record::committed(technique);
        let mut frames = Vec::new();
        for scene_name in self.scenes {
            let Some(reference) = WalkedReference::of_scene(scene_name) else { continue };
            let mut walks = reference.picture(gpu)?;
            let scene = Scene::named(scene_name)?;
            for look in self.looks {
                let mut frame = exposed(gpu, &scene, &look.settings(), &walks)?;
                let figures = record.as_ref().and_then(|record| record.timed(look.row, scene_name, measure));
                let figures = figures.map(|(distance, ms)| format!("{distance:.2}, {ms:.0} ms"));
                label(&mut frame, &[look.label, figures.as_deref().unwrap_or_default()]);
                frames.push(frame);
            }
            let mut difference = apart(gpu, &frames[frames.len() - 1], &walks)?;
            label(&mut walks, &["random walks", &format!("{} a pixel", reference.walks)]);
            label(&mut difference, &["difference"]);
            frames.extend([walks, difference]);
        }
        let seen = side_by_side(&frames, self.looks.len() as u32 + 2);
        let half = halved(&seen);
        Ok([seen, half])
    }
}

impl Look {
    fn settings(&self) -> Settings {
        Settings { half_space: self.law, shadows: self.shadows, ..settings(self.rung) }
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
    let difference = |(one, other): (&[f32; 4], &[f32; 4])| {
        let [red, green, blue] = [0, 1, 2].map(|channel| (one[channel] - other[channel]).abs());
        [red, green, blue, one[3].max(other[3])]
    };
    let linear = one.linear.iter().zip(&other.linear).map(difference).collect();
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
        for beside in ALL {
            let (technique, measure) = beside.record;
            let record = Record::committed(technique).expect("a report");
            for (look, scene) in
                beside.looks.iter().flat_map(|look| beside.scenes.iter().map(move |scene| (look, scene)))
            {
                assert!(record.timed(look.row, scene, measure).is_some(), "{scene}, {}", look.row);
                assert!(WalkedReference::of_scene(scene).is_some());
            }
        }
    }
}
