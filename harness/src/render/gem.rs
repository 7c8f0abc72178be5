//! The gem recipes' pass.

use super::device::{self, PipelineSource};
use super::pass::{Body, DEPTH_FORMAT, ScenePass, Shared};
use super::{Environment, Geometry, RenderError, Rung, Settings, Spectrum, restraint, stone};
use crate::gpu::Gpu;
use crate::scene::Scene;

/// The overrides of the gem recipes for these settings.
pub(crate) fn constants(scene: &Scene, settings: &Settings) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| if on { 1.0 } else { 0.0 };
    let rung = settings.rung;
    let inside = flag(rung != Rung::Surface);
    let absorbs = settings.absorption && scene.objects.iter().any(|object| object.material.absorbs());
    let (disperses, form, wavelengths) = match rung.spectrum() {
        Spectrum::One => (false, 1, 3),
        Spectrum::Paper => (true, 0, 3),
        Spectrum::Tracker => (true, 1, 3),
        Spectrum::Separate(count) => (true, 2, count),
    };
    vec![
        ("EFFECT_PROXY_GEOMETRY", inside),
        ("EFFECT_CONVEX_TRACE", inside),
        ("EFFECT_BVH_TRACE", inside),
        ("TRAVERSAL_LOOP", flag(rung.geometry() == Geometry::Triangles)),
        ("EFFECT_ENVIRONMENT_MAP", flag(matches!(settings.environment, Environment::Map(_)))),
        ("EFFECT_ABSORPTION", flag(absorbs)),
        ("EFFECT_DISPERSION", flag(disperses)),
        ("DISPERSION_FORM", f64::from(form)),
        ("WAVELENGTHS", f64::from(wavelengths)),
        ("BOUNCES", f64::from(rung.hits())),
        ("REST_FROM_ENVIRONMENT", flag(settings.rest_from_environment)),
        ("LIMIT_DISTANCE", flag(settings.distance_limit.is_some())),
        ("LIMIT_THROUGHPUT", flag(restraint::limits_throughput(settings))),
        ("CENTRE_PAPER", flag(settings.paper_centre)),
    ]
}

/// Compiles `source`, the rung's composed recipe, with the fragment entry point `fragment`, and uploads the scene's stones.
pub(super) fn pass<'gpu>(
    gpu: &'gpu Gpu,
    scene: &Scene,
    settings: &Settings,
    source: &str,
    fragment: &str,
    formats: &[wgpu::TextureFormat],
) -> Result<ScenePass<'gpu>, RenderError> {
    let pipeline = device::pipeline(
        gpu,
        &PipelineSource {
            recipe: settings.rung.recipe(),
            source,
            entries: ["gem_vertex", fragment],
            constants: &constants(scene, settings),
            formats,
            depth: Some(DEPTH_FORMAT),
        },
    )?;
    let shared = vec![Shared::Texture(super::environment::texture(gpu, &settings.environment)?)];
    let bodies: Result<Vec<Body>, RenderError> =
        scene.objects.iter().map(|object| stone::upload(gpu, &pipeline, object, settings)).collect();
    Ok(ScenePass { gpu, pipeline, shared, bodies: bodies?, before: Vec::new() })
}
