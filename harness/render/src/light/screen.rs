//! The picture of all bodies but clear stones, which what leaves a stone may meet.

use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, Depth, Pass, PipelineId, PipelineSource, RenderPass, Target, Texture};
use crate::picture::Tile;
use crate::picture::formats::{DEPTH_FORMAT, SAMPLE_FORMAT};
use crate::settings::Settings;
use glam::{Mat4, UVec2};
use lapidary_scene::{Bounds, Scene};

/// Bindings of the part `screen` in group 0.
pub(crate) const VIEW: u32 = 6;
pub(crate) const RADIANCE: u32 = 7;
pub(crate) const DEPTH: u32 = 8;

/// Largest side in samples of the picture of a frame that is drawn in tiles, unless one for each pixel is more: 330 MB of colour
/// and depth.
const LARGEST_WHOLE: u32 = 4096;

/// Returns the size in samples of the picture of a whole frame, if it is drawn in tiles.
pub(crate) fn size_of_whole(settings: &Settings) -> Option<[u32; 2]> {
    let Settings { width, height, samples, .. } = *settings;
    let of_pixel = (LARGEST_WHOLE / width.max(height)).clamp(1, samples);
    (Tile::all(width, height, samples).count() > 1).then(|| [width, height].map(|side| side * of_pixel))
}

/// Recipe that draws the picture into the stones' target.
const COPY: &str = "screen_copy";

/// The picture's colour and depth.
#[derive(Clone, Copy)]
pub(crate) struct Picture {
    pipeline: PipelineId,
    pub(crate) radiance: Texture,
    pub(crate) depth: Texture,
}

impl Picture {
    /// Creates the textures for pictures of up to this size in samples.
    pub(crate) fn new(builder: &mut Builder<'_>, [width, height]: [u32; 2]) -> Result<Self, RenderError> {
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: COPY,
            source: &lapidary_wgsl::recipe_source(COPY),
            entries: ["screen_copy_vertex", "screen_copy_fragment"],
            constants: &[],
            formats: &[SAMPLE_FORMAT],
            depth: Some(DEPTH_FORMAT),
        })?;
        let [radiance, depth] =
            [("screen's radiance", SAMPLE_FORMAT), ("screen's depth", DEPTH_FORMAT)].map(|(what, format)| {
                builder.target(what, [width, height, 1], format, wgpu::TextureUsages::TEXTURE_BINDING)
            });
        Ok(Self { pipeline, radiance, depth })
    }

    /// Draws the picture into a target, which is cleared before, and its depth, which is kept.
    pub(crate) fn copy(&self, builder: &mut Builder<'_>, target: Texture, depth: Texture, size: [u32; 2]) {
        let view = Record::new("ScreenCopyView").with("size", UVec2::from(size));
        let uniform = builder.uniform("copy's view", view);
        let resources: [(u32, Bound); 3] = [(0, uniform.into()), (1, self.radiance.into()), (2, self.depth.into())];
        let group = builder.bind(self.pipeline, 0, &resources);
        let draw = builder.draw(self.pipeline, vec![group], 3);
        let [width, height] = size;
        builder.pass(Pass::Render(RenderPass {
            name: COPY.to_owned(),
            targets: vec![Target::from(target)],
            depth: Some(Depth { keep: true, ..depth.into() }),
            viewport: Some([0, 0, width, height]),
            draws: vec![draw],
        }));
    }
}

/// Returns the struct `ScreenView` of the recipes, for a picture of this size in samples.
pub(crate) fn view(builder: &mut Builder<'_>, clip_from_world: Mat4, size: [u32; 2], thickness: f32) -> Buffer {
    // The third row is the fourth times the scale, but for the last column.
    let (third, fourth) = (clip_from_world.row(2).as_dvec4(), clip_from_world.row(3).as_dvec4());
    let axis = fourth.truncate();
    let scale = third.truncate().dot(axis) / axis.length_squared();
    let offset = third.w - scale * fourth.w;
    let record = Record::new("ScreenView").with("clip_from_world", clip_from_world);
    let record = record.with("size", UVec2::from(size).as_vec2());
    let record = record.with("scale", scale as f32).with("offset", offset as f32).with("thickness", thickness);
    builder.uniform("screen's view", record)
}

/// Returns how far bodies reach behind their front: as asked for, or half the mean diagonal of the
/// opaque bodies' bounds.
pub(crate) fn thickness(scene: &Scene, settings: &Settings) -> f32 {
    let diagonal = |bounds: Bounds| (bounds.max - bounds.min).length();
    let others = scene.beside_stones().map(|object| diagonal(Bounds::of(object.mesh.positions.iter().copied())));
    let diagonals: Vec<f32> = others.collect();
    let mean = diagonals.iter().sum::<f32>() / diagonals.len().max(1) as f32;
    settings.gem.thickness.unwrap_or(0.5 * mean)
}
