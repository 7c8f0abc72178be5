//! The gem recipes' pass.

use super::device::{self, PipelineSource};
use super::lighting::Lighting;
use super::pass::{DEPTH_FORMAT, ScenePass, Variant};
use super::variant::{Drawn, Part};
use super::{RenderError, Settings, restraint, stone};
use lapidary_gpu::Gpu;
use lapidary_plan::{Decisions, Geometry, Rung, Spectrum};

/// The overrides of the gem recipes for an object.
pub(crate) fn constants(decisions: &Decisions, rung: Rung, settings: &Settings) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let (form, wavelengths) = match rung.spectrum() {
        Spectrum::One | Spectrum::Tracker => (1, 3),
        Spectrum::Paper => (0, 3),
        Spectrum::Separate(count) => (2, count),
    };
    let mut constants = decisions.constants();
    constants.extend([
        ("TRAVERSAL_LOOP", flag(rung.geometry() == Geometry::Triangles)),
        ("DISPERSION_FORM", f64::from(form)),
        ("WAVELENGTHS", f64::from(wavelengths)),
        ("BOUNCES", f64::from(rung.hits())),
        ("REST_FROM_ENVIRONMENT", flag(settings.rest_from_environment)),
        ("LIMIT_DISTANCE", flag(settings.distance_limit.is_some())),
        ("LIMIT_THROUGHPUT", flag(restraint::limits_throughput(rung, settings))),
        ("CENTRE_PAPER", flag(settings.paper_centre)),
    ]);
    constants
}

/// Compiles `source`, the rung's composed recipe, with the fragment entry point `fragment`, for the effects of each stone, and uploads the stones.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    lighting: &Lighting<'_>,
    part: &Part<'_>,
    source: &str,
    (fragment, formats): (&str, &[wgpu::TextureFormat]),
) -> Result<ScenePass<'gpu>, RenderError> {
    let compiled = |(constants, objects): (Vec<(&str, f64)>, Vec<&Drawn<'_>>)| {
        let from = PipelineSource {
            recipe: part.rung.recipe(),
            source,
            entries: ["gem_vertex", fragment],
            constants: &constants,
            formats,
            depth: Some(DEPTH_FORMAT),
        };
        let pipeline = device::pipeline(gpu, &from)?;
        let upload = |drawn: &Drawn<'_>| stone::upload(gpu, &pipeline, drawn, part.rung, part.settings);
        let bodies = objects.into_iter().map(upload).collect::<Result<Vec<_>, _>>()?;
        Ok(Variant { shared: lighting.shared(&pipeline)?, pipeline, bodies })
    };
    let variants = part.variants(|drawn| constants(&drawn.decisions, part.rung, part.settings));
    let variants = variants.into_iter().map(compiled).collect::<Result<_, RenderError>>()?;
    Ok(ScenePass { gpu, variants, before: Vec::new() })
}
