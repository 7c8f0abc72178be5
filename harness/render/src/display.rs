//! The display recipe's pass, and reading a tile back.

use super::device::{self, Pipeline, PipelineSource};
use super::pass::SAMPLE_FORMAT;
use super::{Picture, RenderError, Settings, Tile};
use crate::record::Record;
use glam::{UVec2, Vec2};
use lapidary_gpu::{Encoder, Gpu};

const ENCODED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Averages samples, and what the tone curve makes of them, and brings both pictures back.
pub(super) struct DisplayPass<'gpu> {
    gpu: &'gpu Gpu,
    pipeline: Pipeline,
    /// Along each side of a pixel.
    count: u32,
    /// Samples of one tile.
    samples: wgpu::Texture,
    samples_view: wgpu::TextureView,
    linear: wgpu::Texture,
    encoded: wgpu::Texture,
}

impl<'gpu> DisplayPass<'gpu> {
    /// With `count` samples along each side of a pixel, for tiles of a picture of this size.
    pub(super) fn new(gpu: &'gpu Gpu, count: u32, [width, height]: [u32; 2]) -> Result<Self, RenderError> {
        let pipeline = device::pipeline(
            gpu,
            &PipelineSource {
                recipe: "display",
                source: &lapidary_wgsl::recipe_source("display"),
                entries: ["display_vertex", "display_fragment"],
                constants: &[("SAMPLES", f64::from(count))],
                formats: &[SAMPLE_FORMAT, ENCODED_FORMAT],
                depth: None,
            },
        )?;
        use wgpu::TextureUsages as Usage;
        let [samples, linear, encoded] = gpu.guarded("allocating a tile", |device| {
            [
                ("samples", count, SAMPLE_FORMAT, Usage::TEXTURE_BINDING | Usage::COPY_DST),
                ("linear picture", 1, SAMPLE_FORMAT, Usage::COPY_SRC),
                ("encoded picture", 1, ENCODED_FORMAT, Usage::COPY_SRC),
            ]
            .map(|(what, times, format, usage)| {
                device::target(
                    device,
                    what,
                    [width, height].map(|side| times * side.min(Tile::side(count))),
                    format,
                    usage,
                )
            })
        })?;
        let samples_view = device::view(&samples);
        Ok(Self { gpu, pipeline, count, samples, samples_view, linear, encoded })
    }

    /// What the scene's pass draws to.
    pub(super) fn samples(&self) -> &wgpu::TextureView {
        &self.samples_view
    }

    /// Fills a tile with samples that were made elsewhere, row by row.
    pub(super) fn write(&self, tile: Tile, samples: &[[f32; 4]]) {
        let [width, height] = [tile.width, tile.height].map(|side| side * self.count);
        self.gpu.queue.write_texture(
            self.samples.as_image_copy(),
            bytemuck::cast_slice(samples),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: Some(height) },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    }

    /// Ends a tile: from the samples to the picture.
    pub(super) fn finish(
        &self,
        mut encoder: Encoder,
        tile: Tile,
        settings: &Settings,
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let [corner, size] =
            [[tile.left, tile.top], [settings.width, settings.height]].map(|of| UVec2::from(of).as_vec2());
        let contents = frame(corner, size, settings.exposure);
        let [linear, encoded] = self.gpu.guarded("displaying a tile", |device| {
            let uniform = device::uniform(device, "frame", &contents);
            let samples = wgpu::BindingResource::TextureView(&self.samples_view);
            let group = self.pipeline.bind(device, 0, &[(0, uniform.as_entire_binding()), (1, samples)]);
            self.draw(&mut encoder, tile, group.as_ref());
            let linear = self.copy_out(&mut encoder, "linear picture to read", &self.linear, 16, tile);
            let encoded = self.copy_out(&mut encoder, "encoded picture to read", &self.encoded, 4, tile);
            self.gpu.queue.submit([encoder.finish()]);
            [linear, encoded]
        })?;
        let width = picture.width as usize;
        linear.read(self.gpu, tile, |row, bytes| {
            let start = (tile.top as usize + row) * width + tile.left as usize;
            for (pixel, bytes) in picture.linear[start..].iter_mut().zip(bytes.chunks_exact(16)) {
                *pixel = bytemuck::pod_read_unaligned(bytes);
            }
        })?;
        encoded.read(self.gpu, tile, |row, bytes| {
            let start = (tile.top as usize + row) * width + tile.left as usize;
            for (pixel, bytes) in picture.encoded[start..].iter_mut().zip(bytes.chunks_exact(4)) {
                *pixel = bytemuck::pod_read_unaligned(bytes);
            }
        })
    }

    fn draw(&self, encoder: &mut Encoder, tile: Tile, group: Option<&wgpu::BindGroup>) {
        let (linear, encoded) = (device::view(&self.linear), device::view(&self.encoded));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[device::cleared(&linear), device::cleared(&encoded)],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_viewport([0.0, 0.0, tile.width as f32, tile.height as f32], 0.0..1.0);
        pass.set_pipeline(&self.pipeline.raw);
        pass.set_bind_group(0, group);
        pass.draw(0..3, 0..1);
    }

    /// Copies the tile's part of `texture` to a new buffer that can be mapped.
    fn copy_out(
        &self,
        encoder: &mut Encoder,
        what: &str,
        texture: &wgpu::Texture,
        pixel_bytes: u32,
        tile: Tile,
    ) -> Readback {
        let row_bytes = (tile.width * pixel_bytes).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size: u64::from(row_bytes) * u64::from(tile.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row_bytes),
                    rows_per_image: Some(tile.height),
                },
            },
            wgpu::Extent3d { width: tile.width, height: tile.height, depth_or_array_layers: 1 },
        );
        Readback { buffer, row_bytes: row_bytes as usize, used_bytes: (tile.width * pixel_bytes) as usize }
    }
}

/// A tile's rows on their way back.
struct Readback {
    buffer: wgpu::Buffer,
    row_bytes: usize,
    used_bytes: usize,
}

impl Readback {
    fn read(&self, gpu: &Gpu, tile: Tile, mut row: impl FnMut(usize, &[u8])) -> Result<(), RenderError> {
        let size = self.row_bytes as u64 * u64::from(tile.height);
        gpu.read_back(&self.buffer, size, |bytes| {
            for (index, bytes) in bytes.chunks_exact(self.row_bytes).enumerate() {
                row(index, &bytes[..self.used_bytes]);
            }
        })?;
        Ok(())
    }
}

/// `DisplayFrame` of the recipe: the corner of a tile and the picture's size, in pixels.
pub(super) fn frame(tile: Vec2, size: Vec2, exposure: f32) -> Vec<u8> {
    Record::new("DisplayFrame").with("tile", tile).with("size", size).with("exposure", exposure).bytes()
}

#[cfg(test)]
mod tests;
