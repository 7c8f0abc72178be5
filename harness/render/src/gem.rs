//! The pass of the gem recipes.

use super::lighting::Lighting;
use super::pass::{DEPTH_FORMAT, ScenePass, Variant};
use super::variant::Part;
use super::{RenderError, Settings, restraint, screen, stone};
use crate::frame::{Builder, PipelineSource};
use lapidary_plan::{Decisions, Geometry, Rung, Spectrum};

/// Returns the overrides of the gem recipes for an object.
pub(crate) fn constants(decisions: &Decisions, rung: Rung, settings: &Settings) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let (form, wavelengths) = match rung.spectrum() {
        Spectrum::One | Spectrum::Tracker => (1, 3),
        Spectrum::Paper => (0, 3),
        Spectrum::Split => (3, 3),
        Spectrum::Separate(count) => (2, count),
    };
    let mut constants = decisions.constants();
    constants.extend([
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

/// Compiles `source`, the rung's composed recipe, with the fragment entry point `fragment` for the
/// effects of each stone, and adds the stones.
pub(super) fn pass(
    builder: &mut Builder<'_>,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    source: &str,
    (fragment, formats): (&str, &[wgpu::TextureFormat]),
) -> Result<ScenePass, RenderError> {
    let mut pass = ScenePass::default();
    for (constants, objects) in part.variants(|drawn| constants(&drawn.decisions, part.rung, part.settings)) {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["gem_vertex", fragment],
            constants: &constants,
            formats,
            depth: Some(DEPTH_FORMAT),
        })?;
        let add = |drawn| stone::add(builder, pipeline, drawn, part.rung, part.settings);
        let bodies = objects.into_iter().map(add).collect::<Result<Vec<_>, _>>()?;
        pass.variants.push(Variant {
            shared: lighting.shared(builder, pipeline)?,
            targets: formats.len(),
            reads_screen: builder.binds(pipeline, 0, screen::RADIANCE),
            pipeline,
            bodies,
        });
    }
    Ok(pass)
}
