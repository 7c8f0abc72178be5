//! A scene's objects in a frame, each under the recipe of its rung, and what is prepared for them.

use crate::error::RenderError;
use crate::frame::Builder;
use crate::light::lighting::Lighting;
use crate::objects::draws::Variant;
use crate::objects::part::Part;
use crate::picture::formats::SAMPLE_FORMAT;
use crate::settings::Settings;
use crate::shadow::shadows::Shadows;
use crate::stone::{deferred, footprint, gem};
use crate::surface::blur::Blur;
use crate::surface::translucent;
use crate::volume::diffusion::{self, Diffusions};
use crate::volume::optical_path::{self, OpticalPaths};
use crate::volume::stage::Stage;
use lapidary_plan::{Effect, Rung};
use lapidary_scene::Scene;
use std::borrow::Cow;
use std::ops::Range;

/// Compiled recipes and the scene's objects.
#[derive(Default)]
pub(crate) struct ScenePass {
    pub(crate) variants: Vec<Variant>,
    pub(crate) before: Vec<Before>,
}

/// Work done once per frame before the objects are drawn, whose results they look up.
pub(crate) enum Before {
    /// The lights' views of the scene, for shadows.
    Shadows(Shadows),
    /// Irradiance, drawn into an object's texture and blurred.
    Blur(Blur),
    /// Paths of light through the objects.
    Paths(OpticalPaths),
    /// Diffusion of light through the objects.
    Diffusions(Diffusions),
}

impl ScenePass {
    /// Encodes the preparing passes. Returns the range of passes of each stage of the paths of
    /// light, or `None` if the rung follows none.
    pub(crate) fn prepare(&self, builder: &mut Builder<'_>) -> Option<[Range<usize>; Stage::ALL.len() - 1]> {
        let mut stages = None;
        for before in &self.before {
            match before {
                Before::Shadows(shadows) => shadows.encode(builder),
                Before::Blur(blur) => blur.encode(builder),
                Before::Paths(paths) => stages = Some(paths.encode(builder)),
                Before::Diffusions(diffusions) => stages = Some(diffusions.encode(builder)),
            }
        }
        stages
    }

    /// Paths of light, of each rung that follows any.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &OpticalPaths> {
        self.before.iter().filter_map(|before| match before {
            Before::Paths(paths) => Some(paths),
            Before::Shadows(_) | Before::Blur(_) | Before::Diffusions(_) => None,
        })
    }

    /// Diffusion of light, of each rung by it.
    pub(crate) fn diffusions(&self) -> impl Iterator<Item = &Diffusions> {
        self.before
            .iter()
            .filter_map(|before| if let Before::Diffusions(diffusions) = before { Some(diffusions) } else { None })
    }
}

/// Creates the passes that draw the scene's objects, each by its rung; `source` replaces the text
/// of the settings' rung's recipe, or of all.
pub(crate) fn scene_pass(
    builder: &mut Builder<'_>,
    lighting: &Lighting<'_>,
    scene: &Scene,
    settings: &Settings,
    source: Option<&str>,
) -> Result<ScenePass, RenderError> {
    let mut all = ScenePass::default();
    let parts = Part::all(scene, settings);
    let shadows = Shadows::of(builder, lighting, &parts)?;
    let is_smoothed = |part: &Part<'_>| part.objects.iter().any(|drawn| drawn.decisions.has(Effect::Footprint));
    for part in &parts {
        let composed = || Cow::Owned(lapidary_wgsl::recipe_source(part.rung.recipe()));
        let is_named = settings.rung == Rung::ByMaterial || part.rung.recipe() == settings.rung.recipe();
        let source = &*source.filter(|_| is_named).map_or_else(composed, Cow::Borrowed);
        match part.rung {
            Rung::Diffuse(_) | Rung::OpticalPath(_) | Rung::Diffusion(_) if settings.gem.deferred => {
                return Err(RenderError::NotDeferred { object: part.objects[0].object.name.clone(), rung: part.rung });
            }
            Rung::Diffuse(reflectance) => {
                let light = (lighting, shadows.as_ref());
                let (variants, blurs) = translucent::pass(builder, light, part, reflectance, source)?;
                all.variants.extend(variants);
                all.before.extend(blurs.into_iter().map(Before::Blur));
            }
            Rung::OpticalPath(paths) => {
                let (variants, paths) = optical_path::pass(builder, lighting, part, paths, source)?;
                all.variants.extend(variants);
                all.before.push(Before::Paths(paths));
            }
            Rung::Diffusion(diffusion) => {
                let (variants, diffusions) = diffusion::pass(builder, lighting, part, diffusion, source)?;
                all.variants.extend(variants);
                all.before.push(Before::Diffusions(diffusions));
            }
            _ => {
                let output = if settings.gem.deferred {
                    ("gem_deferred_fragment", &[deferred::GEOMETRY_FORMAT; deferred::TARGETS][..])
                } else if is_smoothed(part) {
                    ("gem_footprint_fragment", &footprint::FORMATS[..])
                } else {
                    ("gem_fragment", &[SAMPLE_FORMAT][..])
                };
                all.variants.extend(gem::pass(builder, lighting, part, source, output)?);
            }
        }
    }
    if footprint::is_on(settings) && !parts.iter().any(is_smoothed) {
        return Err(RenderError::NoFootprint { rung: settings.rung });
    }
    // Irradiance that is blurred in a texture is shadowed there, so the shadow maps come first.
    all.before.splice(0..0, shadows.map(Before::Shadows));
    Ok(all)
}
