//! Each material drawn with its own variant of the recipe, compared with one variant that has every
//! effect and serves all materials.

use lapidary_assay::extremum::larger;
use lapidary_gpu::Gpu;
use lapidary_ladders::timing::{self, Timed};
use lapidary_ladders::{CostError, Options, Report, Row};
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_render::plan::Plan;
use lapidary_scene::{Dispersion, Material, Object, Scene};

/// A scene with three clear stones: one disperses, one absorbs, one does neither.
const SCENE: &str = "vitrine";
/// The rung that draws all the stones.
const VARIED: Rung = Rung::Inside { geometry: Geometry::Proxy, hits: 4, spectrum: Spectrum::Tracker };
/// A dispersion and an attenuation distance that enable the effects without a visible change.
const FAINT: (f32, f32) = (1e-6, 1e12);

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

/// Adds the stones drawn in each way: the largest difference of radiance times exposure from the
/// first way's picture, the time, and the fragment and vertex instructions of each pipeline for
/// stones.
pub(super) fn measure(
    gpu: &Gpu,
    options: &Options,
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let separate = stones()?;
    let every = |object: &Object| Object { material: with_every_effect(&object.material), ..object.clone() };
    let shared = Scene { objects: separate.objects.iter().map(every).collect(), ..separate.clone() };
    // With this rung a single recipe draws all the stones, so that only the variants differ.
    let settings = Settings { rung: VARIED, samples: 1, ..Settings::of_size(options.frame[0], options.frame[1]) };
    let scenes = [("its own for each material", &separate), ("one with every effect for all", &shared)];
    let timed = scenes.map(|(_, scene)| Timed::new(scene, settings.clone()));
    let timings = timing::time(gpu, &timed, options.rounds, progress)?;
    let first = render::render(gpu, &separate, &settings)?.linear;
    for ((way, scene), timing) in scenes.into_iter().zip(timings) {
        let picture = render::render(gpu, scene, &settings)?.linear;
        let differences = picture.iter().flatten().zip(first.iter().flatten()).map(|(a, b)| f64::from((a - b).abs()));
        let largest = differences.fold(0.0, larger);
        let pipelines = Plan::of(scene, &settings)?.listing.pipelines;
        let of_stones = pipelines.iter().filter(|pipeline| pipeline.recipe == "gem");
        let row = Row::new(&format!("{VARIED}, {way}"), SCENE, "variant", largest, "");
        report.rows.push(Row {
            instructions: of_stones.map(|pipeline| pipeline.instructions as u32).collect(),
            ..row.timed(timing.map(|timing| timing.ms))
        });
    }
    Ok(())
}
