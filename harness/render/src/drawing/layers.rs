//! The order in which a picture's bodies are drawn: all in one pass, or clear stones after the
//! others, if their edges are smoothed or if what leaves them meets the others.

use crate::error::RenderError;
use crate::frame::{Bound, Buffer, Builder, Depth, Target, Texture};
use crate::light::lighting::Lighting;
use crate::light::screen::{self, Picture};
use crate::objects::draws::{self, SceneTarget, Variant};
use crate::picture::formats::DEPTH_FORMAT;
use crate::settings::Settings;
use crate::stone::footprint::{self, FootprintPass};
use glam::{Mat4, Vec3};

/// The targets of a picture of one tile.
pub(crate) struct Layers {
    samples: Texture,
    depth: Texture,
    footprint: Option<FootprintPass>,
    /// The picture of the other bodies, and how far they reach behind their front.
    screen: Option<(Picture, f32)>,
    /// How it was drawn, if it is that of a whole frame that is drawn in tiles.
    whole: Option<Buffer>,
}

impl Layers {
    /// Creates the targets, apart from `samples`, once all pipelines are made.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        lighting: &Lighting<'_>,
        settings: &Settings,
        samples: Texture,
        size: [u32; 2],
    ) -> Result<Self, RenderError> {
        let footprint = FootprintPass::of(builder, settings, size)?;
        let [width, height] = size;
        let depth = builder.target("depth", [width, height, 1], DEPTH_FORMAT, wgpu::TextureUsages::empty());
        Ok(Self { samples, depth, footprint, screen: lighting.screen_in_use(), whole: None })
    }

    /// Draws the picture of the other bodies that rays are followed over, if there is one, for all tiles of a frame.
    pub(crate) fn draw_whole(
        &mut self,
        builder: &mut Builder<'_>,
        variants: &[Variant],
        (clip_from_world, eye): (Mat4, Vec3),
        size: [u32; 2],
    ) {
        let Some((picture, thickness)) = self.screen else { return };
        self.whole = Some(screen::view(builder, clip_from_world, size, thickness));
        let depth = Depth { keep: true, ..picture.depth.into() };
        let target = SceneTarget { colors: vec![picture.radiance.into()], depth, size };
        let is_other = |variant: &Variant| !is_last(variant);
        draws::draw(builder, variants, ("screen", &is_other), (clip_from_world, eye, &[]), &target);
    }

    /// Draws the bodies as seen from an eye.
    pub(crate) fn draw(
        &self,
        builder: &mut Builder<'_>,
        variants: &[Variant],
        (clip_from_world, eye): (Mat4, Vec3),
        size: [u32; 2],
    ) {
        let radiance = self.footprint.as_ref().map_or(self.samples, |footprint| footprint.radiance);
        let screen = self.screen.map(|(picture, thickness)| {
            let view = self.whole.unwrap_or_else(|| screen::view(builder, clip_from_world, size, thickness));
            (picture, [(screen::VIEW, Bound::from(view))])
        });
        let view = (clip_from_world, eye, screen.as_ref().map_or(&[][..], |(_, bound)| &bound[..]));
        if !variants.iter().any(is_last) {
            let target = SceneTarget { colors: vec![radiance.into()], depth: self.depth.into(), size };
            return draws::draw(builder, variants, ("scene", &|_| true), view, &target);
        }
        let mut is_cleared = true;
        if variants.iter().any(|variant| !is_last(variant)) {
            // The picture of a whole frame is there already.
            let screen = screen.as_ref().filter(|_| self.whole.is_none());
            let (target, depth) =
                screen.map_or((radiance, self.depth), |(picture, _)| (picture.radiance, picture.depth));
            let depth = Depth { keep: true, ..depth.into() };
            let target = SceneTarget { colors: vec![target.into()], depth, size };
            draws::draw(builder, variants, ("scene", &|variant| !is_last(variant)), view, &target);
            if let Some((picture, _)) = screen {
                picture.copy(builder, radiance, self.depth, size);
            }
            is_cleared = false;
        }
        let neighbours = self.footprint.as_ref().map(|footprint| Target::from(footprint.neighbours));
        for neighbours in [None, neighbours] {
            let count = 1 + usize::from(neighbours.is_some());
            let is_next = |variant: &Variant| is_last(variant) && variant.targets == count;
            if !variants.iter().any(is_next) {
                continue;
            }
            let target = Target::from(radiance);
            let target = Target { clear: target.clear.filter(|_| is_cleared), ..target };
            let depth = Depth { load: !is_cleared, keep: count == 1, ..self.depth.into() };
            let target = SceneTarget { colors: [target].into_iter().chain(neighbours).collect(), depth, size };
            draws::draw(builder, variants, (if is_cleared { "scene" } else { "stones" }, &is_next), view, &target);
            is_cleared = false;
        }
        if let Some(footprint) = &self.footprint {
            footprint.resolve(builder, self.samples, size);
        }
    }
}

/// Whether stones are drawn after the other bodies: what is drawn over a smoothed one would keep its shares.
fn is_last(variant: &Variant) -> bool {
    variant.reads_screen || variant.targets == footprint::FORMATS.len()
}
