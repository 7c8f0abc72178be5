//! The display recipe's pass, tile by tile.

use super::formats::SAMPLE_FORMAT;
use super::rendered::Picture;
use super::tile::Tile;
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{BindGroupId, Bound, Builder, PipelineId, PipelineSource, Read, Readback, Texture};
use crate::settings::Settings;
use glam::{UVec2, Vec2};

const RECIPE: &str = "display";
const ENCODED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Linear radiance and coverage, f32.
const LINEAR: &str = "linear picture";
/// sRGB, opaque or with straight alpha.
pub(crate) const ENCODED: &str = "encoded picture";

/// Averages the samples, linear and tone-mapped, and reads both pictures back.
pub(crate) struct DisplayPass {
    pipeline: PipelineId,
    /// Samples along each side of a pixel.
    pub(super) count: u32,
    /// Samples of one tile: the target of the scene's pass.
    pub(crate) samples: Texture,
    pictures: [Texture; 2],
    read: [Readback; 2],
}

impl DisplayPass {
    /// Creates the pass for tiles of a picture with the settings' size and samples.
    pub(crate) fn new(builder: &mut Builder<'_>, settings: &Settings) -> Result<Self, RenderError> {
        let count = settings.samples;
        let pipeline = pipeline(builder, count, settings.backdrop, &[SAMPLE_FORMAT, ENCODED_FORMAT])?;
        let [width, height] = [settings.width, settings.height].map(|side| side.min(Tile::side(count)));
        use wgpu::TextureUsages as Usage;
        let usage = Usage::TEXTURE_BINDING | Usage::COPY_DST;
        let samples = builder.target("samples", [count * width, count * height, 1], SAMPLE_FORMAT, usage);
        let pictures = [(LINEAR, SAMPLE_FORMAT), (ENCODED, ENCODED_FORMAT)]
            .map(|(name, format)| builder.target(name, [width, height, 1], format, Usage::COPY_SRC));
        let [linear, encoded] = pictures;
        let read = [(LINEAR, linear), (ENCODED, encoded)]
            .map(|(name, texture)| builder.readback(name, texture, [width, height]));
        Ok(Self { pipeline, count, samples, pictures, read })
    }

    /// Finishes a tile: displays its samples and reads both pictures back.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>, tile: Tile, settings: &Settings) {
        let corner = UVec2::new(tile.left, tile.top).as_vec2();
        let group = group(builder, self.pipeline, self.samples, corner, settings);
        let draw = builder.draw(self.pipeline, group, 3);
        builder.draw_to(RECIPE, &self.pictures, Some([0, 0, tile.width, tile.height]), vec![draw]);
        for read in self.read {
            builder.read(read, [tile.width, tile.height], [tile.left, tile.top]);
        }
    }
}

/// Returns the display recipe for `count` samples along each side of a pixel, with the backdrop or without.
pub(crate) fn pipeline(
    builder: &mut Builder<'_>,
    count: u32,
    backdrop: bool,
    formats: &[wgpu::TextureFormat],
) -> Result<PipelineId, RenderError> {
    Ok(builder.render_pipeline(&PipelineSource {
        recipe: RECIPE,
        source: &lapidary_wgsl::recipe_source(RECIPE),
        entries: ["display_vertex", "display_fragment"],
        constants: &[("SAMPLES", f64::from(count)), ("BACKDROP", f64::from(u8::from(backdrop)))],
        formats,
        depth: None,
    })?)
}

/// Returns the resources of the pass for a tile; `corner` is its upper left corner in pixels.
pub(crate) fn group(
    builder: &mut Builder<'_>,
    pipeline: PipelineId,
    samples: Texture,
    corner: Vec2,
    settings: &Settings,
) -> Vec<Option<BindGroupId>> {
    let size = UVec2::new(settings.width, settings.height).as_vec2();
    let frame = Record::new("DisplayFrame").with("tile", corner).with("size", size);
    let uniform = builder.uniform("frame", frame.with("exposure", settings.exposure));
    let resources = [(0, Bound::from(uniform)), (1, samples.into())];
    vec![builder.bind(pipeline, 0, &resources)]
}

impl Picture {
    /// Copies in a part that was read back, without gaps between rows.
    pub(crate) fn take(&mut self, read: &Read, texels: &[u8]) {
        let ([width, _], [left, top]) = (read.size.map(|side| side as usize), read.at.map(|edge| edge as usize));
        let start = |row: usize| (top + row) * self.width as usize + left;
        if read.picture == ENCODED {
            for (row, texels) in texels.chunks_exact(4 * width).enumerate() {
                let pixels = start(row)..start(row) + width;
                self.encoded[pixels].copy_from_slice(bytemuck::cast_slice(texels));
            }
        } else {
            for (row, texels) in texels.chunks_exact(16 * width).enumerate() {
                let pixels = start(row)..start(row) + width;
                for (pixel, texel) in self.linear[pixels].iter_mut().zip(texels.chunks_exact(16)) {
                    *pixel = bytemuck::pod_read_unaligned(texel);
                }
            }
        }
    }
}
