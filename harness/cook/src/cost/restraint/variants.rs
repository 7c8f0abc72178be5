//! Each material drawn with its own variant of the recipe, compared with one variant that has every
//! effect and serves all materials.

use crate::cost::CostError;
use crate::cost::timing::{self, Timed, Timing};
use lapidary_assay::extremum::larger;
use lapidary_gpu::Gpu;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_render::plan::Plan;
use lapidary_scene::{Dispersion, Material, Object, Scene};
use serde::{Deserialize, Serialize};

/// A scene with three clear stones: one disperses, one absorbs, one does neither.
const SCENE: &str = "vitrine";
/// The rung that draws all the stones.
const VARIED: Rung = Rung::Inside { geometry: Geometry::Proxy, hits: 4, spectrum: Spectrum::Tracker };
/// A dispersion and an attenuation distance that enable the effects without a visible change.
const FAINT: (f32, f32) = (1e-6, 1e12);

/// One way to draw the stones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantWay {
    /// Name of the way.
    pub way: String,
    /// Fragment and vertex instructions of each pipeline for stones.
    pub instructions: Vec<usize>,
    /// Largest difference of radiance times exposure from the first way's picture.
    pub largest: f64,
    /// Times of the frame.
    pub timing: Timing,
}

/// The stones of a scene, drawn in each way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variants {
    /// The scene's name.
    pub scene: String,
    /// The rung's name.
    pub rung: String,
    /// The ways: a variant for each material, then one for all.
    pub ways: Vec<VariantWay>,
}

/// Returns the scene with only its clear bodies.
fn stones() -> Result<Scene, CostError> {
    let scene = Scene::named(SCENE)?;
    let clear = |object: &Object| object.material.transmission > 0.0;
    Ok(Scene { objects: scene.objects.iter().filter(|object| clear(object)).cloned().collect(), ..scene })
}

/// Returns the material with absorption and dispersion enabled, whether or not it had them.
fn with_every_effect(material: &Material) -> Material {
    let (faint, far) = FAINT;
    let dispersion =
        if material.dispersion == Dispersion::None { Dispersion::Abbe(faint) } else { material.dispersion };
    let mut material = Material { dispersion, ..material.clone() };
    if !material.absorbs() {
        (material.attenuation_color, material.attenuation_distance) = (glam::Vec3::splat(0.5), far);
    }
    material
}

pub(super) fn measure(
    gpu: &Gpu,
    [width, height]: [u32; 2],
    rounds: u32,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Variants, CostError> {
    let own = stones()?;
    let every = |object: &Object| Object { material: with_every_effect(&object.material), ..object.clone() };
    let shared = Scene { objects: own.objects.iter().map(every).collect(), ..own.clone() };
    // With this rung a single recipe draws all the stones, so that only the variants differ.
    let settings = Settings { rung: VARIED, samples: 1, ..Settings::of_size(width, height) };
    let scenes = [("its own for each material", &own), ("one with every effect for all", &shared)];
    let timed: Vec<Timed<'_>> = scenes
        .iter()
        .map(|(_, scene)| Timed { settings: settings.clone(), scene, source: None, displayed: false, scales: false })
        .collect();
    let timings = timing::time(gpu, &timed, rounds, progress)?;
    let first = render::render(gpu, &own, &settings)?.linear;
    let mut ways = Vec::new();
    for ((way, scene), timing) in scenes.into_iter().zip(timings) {
        let picture = render::render(gpu, scene, &settings)?.linear;
        let differences = picture.iter().flatten().zip(first.iter().flatten()).map(|(a, b)| f64::from((a - b).abs()));
        let pipelines = Plan::of(scene, &settings)?.listing.pipelines;
        let of_stones = pipelines.iter().filter(|pipeline| pipeline.recipe == "gem");
        ways.push(VariantWay {
            way: way.to_owned(),
            instructions: of_stones.map(|pipeline| pipeline.instructions).collect(),
            largest: differences.fold(0.0, larger),
            timing,
        });
    }
    Ok(Variants { scene: SCENE.to_owned(), rung: settings.rung.to_string(), ways })
}
