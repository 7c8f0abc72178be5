//! A scene as a frame: the rung's recipe over tiles, supersampled, then the display recipe.

use super::deferred::{self, DeferredPass};
use super::display::DisplayPass;
use super::footprint;
use super::layers::Layers;
use super::lighting::Lighting;
use super::pass::{Before, SAMPLE_FORMAT, ScenePass};
use super::shadows::Shadows;
use super::variant::Part;
use super::{RenderError, Settings, Tile, camera, diffusion, gem, optical_path, translucent};
use crate::frame::{Builder, Frame};
use lapidary_gpu::Gpu;
use lapidary_plan::{Decisions, Effect, Rung};
use lapidary_scene::{Copies, Object, Scene};
use std::borrow::Cow;

/// Source texts that replace the cookbook's recipes, for the rung and for the lighting pass; `None`
/// keeps the cookbook's.
#[derive(Clone, Copy, Default)]
pub(super) struct Texts<'a> {
    pub(super) rung: Option<&'a str>,
    pub(super) composite: Option<&'a str>,
}

/// A picture's frame, and the passes that are queried after it has run.
pub(super) struct Drawing {
    pub(super) frame: Frame,
    pub(super) pass: ScenePass,
}

impl Drawing {
    /// Creates the frame of any rung except the reference, which is computed on the CPU.
    pub(super) fn new(
        gpu: Option<&Gpu>,
        scene: &Scene,
        settings: &Settings,
        texts: Texts<'_>,
    ) -> Result<Self, RenderError> {
        let mut builder = Builder::new(gpu);
        let pass = Self::build(&mut builder, scene, settings, texts)?;
        Ok(Self { frame: builder.finish(), pass })
    }

    /// Adds all resources and passes.
    fn build(
        builder: &mut Builder<'_>,
        scene: &Scene,
        settings: &Settings,
        texts: Texts<'_>,
    ) -> Result<ScenePass, RenderError> {
        let scene = &*apart(scene, settings);
        let (width, height) = (settings.width, settings.height);
        let display = DisplayPass::new(builder, settings)?;
        let [columns, rows] = [width, height].map(|side| settings.samples * side.min(Tile::side(settings.samples)));
        let lighting = Lighting::new(scene, settings, [columns, rows]);
        let deferred = if settings.gem.deferred {
            let composed = || Cow::Owned(lapidary_wgsl::recipe_source(deferred::COMPOSITE));
            let composite = texts.composite.map_or_else(composed, Cow::Borrowed);
            Some(DeferredPass::new(builder, &lighting, settings, &composite)?)
        } else {
            None
        };
        let pass = scene_pass(builder, &lighting, scene, settings, texts.rung)?;
        let layers = Layers::new(builder, &lighting, settings, display.samples, [columns, rows])?;
        if layers.follows_screen() && Tile::all(width, height, settings.samples).count() > 1 {
            return Err(RenderError::ScreenTiles { largest: Tile::side(settings.samples) });
        }
        pass.prepare(builder);
        for tile in Tile::all(width, height, settings.samples) {
            let view = (camera::clip_from_world(scene, width, height, tile), scene.camera.eye);
            let size = [tile.width * settings.samples, tile.height * settings.samples];
            if let Some(deferred) = &deferred {
                deferred.draw(builder, &pass, view, display.samples, size);
            } else {
                layers.draw(builder, &pass, view, size);
            }
            display.encode(builder, tile, settings);
        }
        Ok(pass)
    }
}

/// Returns the scene with copies as objects of their own wherever they differ in colour and are not
/// drawn by instances.
pub(super) fn apart<'a>(scene: &'a Scene, settings: &Settings) -> Cow<'a, Scene> {
    let request = settings.request();
    let differs = |object: &Object| {
        object.copies.as_ref().is_some_and(Copies::is_coloured)
            && !Decisions::of(object, scene, &request).has(Effect::Instances)
    };
    if !scene.objects.iter().any(differs) {
        return Cow::Borrowed(scene);
    }
    let bodies = |object: &Object| if differs(object) { object.apart() } else { vec![object.clone()] };
    Cow::Owned(Scene { objects: scene.objects.iter().flat_map(bodies).collect(), ..scene.clone() })
}

/// Creates the passes that draw the scene's objects, each by its rung; `source` replaces the text
/// of the settings' rung's recipe, or of all.
pub(super) fn scene_pass(
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
        let deferred = &[deferred::GEOMETRY_FORMAT; deferred::TARGETS][..];
        let forward = &[SAMPLE_FORMAT][..];
        all.append(match part.rung {
            Rung::Diffuse(_) | Rung::OpticalPath(_) | Rung::Diffusion(_) if settings.gem.deferred => {
                return Err(RenderError::NotDeferred { object: part.objects[0].object.name.clone(), rung: part.rung });
            }
            Rung::Diffuse(reflectance) => {
                translucent::pass(builder, (lighting, shadows.as_ref()), part, reflectance, source)?
            }
            Rung::OpticalPath(paths) => optical_path::pass(builder, lighting, part, paths, source)?,
            Rung::Diffusion(diffusion) => diffusion::pass(builder, lighting, part, diffusion, source)?,
            _ if settings.gem.deferred => {
                gem::pass(builder, lighting, part, source, ("gem_deferred_fragment", deferred))?
            }
            _ if is_smoothed(part) => {
                gem::pass(builder, lighting, part, source, ("gem_footprint_fragment", &footprint::FORMATS))?
            }
            _ => gem::pass(builder, lighting, part, source, ("gem_fragment", forward))?,
        });
    }
    if footprint::is_on(settings) && !parts.iter().any(is_smoothed) {
        return Err(RenderError::NoFootprint { rung: settings.rung });
    }
    // Irradiance that is blurred in a texture is shadowed there, so the shadow maps come first.
    all.before.splice(0..0, shadows.map(Before::Shadows));
    Ok(all)
}
