//! The pass of the gem recipes.

use super::{body, restraint};
use crate::error::RenderError;
use crate::frame::{Builder, PipelineSource};
use crate::light::lighting::Lighting;
use crate::light::screen;
use crate::objects::draws::Variant;
use crate::objects::part::Part;
use crate::picture::formats::DEPTH_FORMAT;
use crate::settings::Settings;
use lapidary_plan::{Decisions, Geometry, Rung, Spectrum};
use lapidary_scene::Scene;

/// Returns the overrides of the gem recipes for an object.
fn constants(decisions: &Decisions, rung: Rung, settings: &Settings) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let (form, wavelengths) = match rung.spectrum() {
        Spectrum::One if rung.geometry() == Geometry::Scene => (1, 1),
        Spectrum::One | Spectrum::Tracker => (1, 3),
        Spectrum::Paper => (0, 3),
        Spectrum::Split => (3, 3),
        Spectrum::Separate(count) => (2, count),
    };
    let mut constants = decisions.constants();
    constants.extend([
        ("TRAVERSAL_TWO_SIDED", flag(rung.geometry() == Geometry::Scene)),
        ("TRAVERSAL_LOOP", flag(rung.geometry() == Geometry::Triangles)),
        ("DISPERSION_FORM", f64::from(form)),
        ("WAVELENGTHS", f64::from(wavelengths)),
        ("BOUNCES", f64::from(rung.hits())),
        ("REST_FROM_ENVIRONMENT", flag(settings.gem.rest_from_environment)),
        ("END_AT_FIRST_EXIT", flag(settings.gem.end_at_first_exit)),
        ("SCREEN_STEPS", f64::from(settings.gem.screen_steps)),
        ("LIMIT_DISTANCE", flag(settings.gem.distance_limit.is_some())),
        ("LIMIT_THROUGHPUT", flag(restraint::limits_throughput(rung, settings))),
        ("CENTRE_PAPER", flag(settings.gem.paper_centre)),
    ]);
    constants
}

/// Returns the overrides of the gem recipes for a scene's first object.
pub fn gem_constants(scene: &Scene, settings: &Settings) -> Vec<(&'static str, f64)> {
    let decisions = scene.objects.first().map(|object| Decisions::of(object, scene, &settings.request()));
    decisions.map_or_else(Vec::new, |decisions| constants(&decisions, decisions.rung, settings))
}

/// Compiles `source`, the rung's composed recipe, with the fragment entry point `fragment` for the
/// effects of each stone, and adds the stones.
pub(crate) fn pass(
    builder: &mut Builder<'_>,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    source: &str,
    (fragment, formats): (&str, &[wgpu::TextureFormat]),
) -> Result<Vec<Variant>, RenderError> {
    let mut variants = Vec::new();
    for (constants, objects) in part.variants(|drawn| constants(&drawn.decisions, part.rung, part.settings)) {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["gem_vertex", fragment],
            constants: &constants,
            formats,
            depth: Some(DEPTH_FORMAT),
        })?;
        let mut bodies = Vec::new();
        for drawn in objects {
            bodies.push(if part.rung.geometry() == Geometry::Scene {
                let hierarchy = lighting.hierarchy(builder)?;
                body::add_among(builder, pipeline, drawn, (hierarchy, lighting.number_of(drawn.object)), part.rung)?
            } else {
                body::add(builder, pipeline, drawn, part.rung, part.settings)?
            });
        }
        variants.push(Variant {
            shared: lighting.shared(builder, pipeline)?,
            targets: formats.len(),
            reads_screen: builder.binds(pipeline, 0, screen::RADIANCE),
            pipeline,
            bodies,
        });
    }
    Ok(variants)
}
