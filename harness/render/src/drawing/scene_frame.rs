//! A scene as a frame: the rung's recipe over tiles, supersampled, then the display recipe.

use super::camera;
use super::copies::with_copies_apart;
use super::layers::Layers;
use super::scene_pass::{ScenePass, scene_pass};
use crate::error::RenderError;
use crate::frame::{Builder, Frame};
use crate::light::lighting::Lighting;
use crate::light::screen;
use crate::picture::Tile;
use crate::picture::display::DisplayPass;
use crate::settings::{MOST_SAMPLES, Settings};
use crate::stone::deferred::{self, DeferredPass};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::{LARGEST_SIDE, Scene};
use std::borrow::Cow;

/// Source texts that replace the cookbook's recipes, for the rung and for the lighting pass; `None`
/// keeps the cookbook's.
#[derive(Clone, Copy, Default)]
pub(crate) struct Texts<'a> {
    pub(crate) rung: Option<&'a str>,
    pub(crate) composite: Option<&'a str>,
}

/// A picture's frame, and the passes that are queried after it has run.
pub(crate) struct Drawing {
    pub(crate) frame: Frame,
    pub(crate) pass: ScenePass,
}

impl Drawing {
    /// Creates the frame of any rung except the reference, which is computed on the CPU.
    pub(crate) fn new(
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
        let scene = &*with_copies_apart(scene, settings);
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
        let mut layers = Layers::new(builder, &lighting, settings, display.samples, [columns, rows])?;
        pass.prepare(builder);
        if let Some(size) = screen::size_of_whole(settings) {
            // Rays over the picture would end at the borders of a tile.
            let matrix = lapidary_scene::clip_from_world(scene, width, height);
            layers.draw_whole(builder, &pass.variants, (matrix, scene.camera.eye), size);
        }
        for tile in Tile::all(width, height, settings.samples) {
            let view = (camera::clip_from_world(scene, width, height, tile), scene.camera.eye);
            let size = [tile.width * settings.samples, tile.height * settings.samples];
            if let Some(deferred) = &deferred {
                deferred.draw(builder, &pass.variants, view, display.samples, size);
            } else {
                layers.draw(builder, &pass.variants, view, size);
            }
            display.encode(builder, tile, settings);
        }
        Ok(pass)
    }
}

/// Returns everything that is created and run on a device to draw `scene`; empty for the reference.
///
/// `gpu` computes the tables; if it is `None`, they are left out.
///
/// # Errors
/// If the scene cannot be drawn with these settings.
pub fn frame(gpu: Option<&Gpu>, scene: &Scene, settings: &Settings) -> Result<Frame, RenderError> {
    check_size(settings)?;
    if settings.rung == Rung::Reference {
        return Ok(Frame::default());
    }
    Ok(Drawing::new(gpu, scene, settings, Texts::default())?.frame)
}

/// Rejects sizes that no device supports, and numbers of samples out of range.
pub(crate) fn check_size(settings: &Settings) -> Result<(), RenderError> {
    let (width, height) = (settings.width, settings.height);
    let largest = LARGEST_SIDE.min(wgpu::Limits::default().max_texture_dimension_2d);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(RenderError::Size { width, height, largest });
    }
    if !(1..=MOST_SAMPLES).contains(&settings.samples) {
        return Err(RenderError::Samples(settings.samples));
    }
    Ok(())
}
