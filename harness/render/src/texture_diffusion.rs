//! The recipe `texture_diffusion`: its textures, and its passes from drawn irradiance to what shading looks up.

use super::RenderError;
use super::device::{self, Pipeline, PipelineSource};
use crate::record::Record;
use glam::{Vec2, Vec3, Vec4};
use lapidary_gpu::{Encoder, Gpu};
use lapidary_texture_diffusion as mirror;

/// The recipe's name.
const RECIPE: &str = "texture_diffusion";
/// Of the irradiance: times coverage, which is in alpha.
pub const IRRADIANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Of the world lengths of a texel along u and along v.
pub const STRETCH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
/// The most pairs of taps that the recipe's uniform holds.
pub const MOST_PAIRS: u32 = 23;
/// A chart's bound along a direction that repeats.
const UNBOUNDED: f32 = 1e9;

/// A chart's rectangle, in texels from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    /// Its upper left corner.
    pub low: [u32; 2],
    /// Its lower right corner.
    pub high: [u32; 2],
}

/// Taps for a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Taps {
    /// Of the widest channel, in units of length.
    sigma0: f32,
    /// Offset and weights of each pair.
    pairs: Vec<Vec4>,
}

impl Taps {
    /// As many as the material needs. `sigma0` is each channel's standard deviation on the surface, in units of length.
    pub fn new(sigma0: Vec3) -> Taps {
        Taps::with_pairs(sigma0, mirror::pairs(sigma0))
    }

    /// As many pairs as asked for, up to [`MOST_PAIRS`].
    pub fn with_pairs(sigma0: Vec3, pairs: u32) -> Taps {
        let pairs = pairs.clamp(1, MOST_PAIRS);
        let tap = |index| {
            let tap = mirror::tap(index, pairs, sigma0);
            Vec4::new(tap.offset, tap.weight.x, tap.weight.y, tap.weight.z)
        };
        Taps { sigma0: mirror::sigma(sigma0).max_element(), pairs: (1..=pairs).map(tap).collect() }
    }

    /// The uniform of a pass.
    fn uniform(&self, direction: Vec2, low: Vec2, high: Vec2) -> Vec<u8> {
        let mut taps = [Vec4::ZERO; MOST_PAIRS as usize];
        taps[..self.pairs.len()].copy_from_slice(&self.pairs);
        let record = Record::new("TextureDiffusionBlur").with("direction", direction).with("sigma0", self.sigma0);
        let record =
            record.with("pairs", self.pairs.len() as u32).with("chart", Vec4::new(low.x, low.y, high.x, high.y));
        record.with("taps", &taps[..]).bytes()
    }
}

/// Textures and pipelines for a surface's texture of one size.
#[derive(Debug)]
pub struct TextureDiffusion<'gpu> {
    gpu: &'gpu Gpu,
    size: [u32; 2],
    repeats: [bool; 2],
    blur: Pipeline,
    dilate: Pipeline,
    sampler: wgpu::Sampler,
    /// The pass that lights the surface draws the irradiance here. The blur overwrites it.
    pub irradiance: wgpu::Texture,
    /// And here how much surface lies under a texel.
    pub stretch: wgpu::Texture,
    /// What shading looks up: irradiance, and 1 where there is any.
    pub diffused: wgpu::Texture,
}

impl<'gpu> TextureDiffusion<'gpu> {
    /// For a texture of `size` texels that repeats along the directions given, u and v.
    ///
    /// # Errors
    /// Where the device refuses the recipe or the textures.
    pub fn new(gpu: &'gpu Gpu, size: [u32; 2], repeats: [bool; 2]) -> Result<Self, RenderError> {
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let pipeline = |entry| {
            let entries = ["texture_diffusion_vertex", entry];
            let formats = &[IRRADIANCE_FORMAT];
            let source =
                PipelineSource { recipe: RECIPE, source: &source, entries, constants: &[], formats, depth: None };
            device::pipeline(gpu, &source)
        };
        let blur = pipeline("texture_diffusion_blur")?;
        let dilate = pipeline("texture_diffusion_dilate")?;
        let (sampler, [irradiance, stretch, diffused]) =
            gpu.guarded("allocating textures for diffusion", |device| {
                let address =
                    |repeats| if repeats { wgpu::AddressMode::Repeat } else { wgpu::AddressMode::ClampToEdge };
                let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
                    label: Some("texture sampler"),
                    address_mode_u: address(repeats[0]),
                    address_mode_v: address(repeats[1]),
                    mag_filter: wgpu::FilterMode::Linear,
                    min_filter: wgpu::FilterMode::Linear,
                    ..wgpu::SamplerDescriptor::default()
                });
                use wgpu::TextureUsages as Usage;
                let usage = Usage::TEXTURE_BINDING | Usage::COPY_SRC | Usage::COPY_DST;
                let textures = [
                    ("irradiance", IRRADIANCE_FORMAT),
                    ("stretch", STRETCH_FORMAT),
                    ("diffused irradiance", IRRADIANCE_FORMAT),
                ];
                (sampler, textures.map(|(what, format)| device::target(device, what, size, format, usage)))
            })?;
        Ok(Self { gpu, size, repeats, blur, dilate, sampler, irradiance, stretch, diffused })
    }

    /// Blurs the irradiance along u and v, chart by chart, and fills the gutters.
    ///
    /// # Errors
    /// Where the device refuses a pass: a chart that is not inside the texture.
    pub fn encode(&self, encoder: &mut Encoder, taps: &Taps, charts: &[Chart]) -> Result<(), RenderError> {
        let views = [&self.irradiance, &self.diffused, &self.irradiance].map(device::view);
        let stretch = device::view(&self.stretch);
        self.gpu.guarded("blurring irradiance", |device| {
            for (direction, textures) in [Vec2::X, Vec2::Y].into_iter().zip(views.windows(2)) {
                let groups: Vec<(Option<wgpu::BindGroup>, Chart)> = charts
                    .iter()
                    .map(|chart| {
                        let bound = |corner: [u32; 2], unbounded: f32| {
                            let along = |axis: usize| if self.repeats[axis] { unbounded } else { corner[axis] as f32 };
                            Vec2::new(along(0), along(1))
                        };
                        let uniform =
                            taps.uniform(direction, bound(chart.low, -UNBOUNDED), bound(chart.high, UNBOUNDED));
                        let uniform = device::uniform(device, "taps", &uniform);
                        let resources = [
                            (0, wgpu::BindingResource::TextureView(&textures[0])),
                            (1, uniform.as_entire_binding()),
                            (2, wgpu::BindingResource::Sampler(&self.sampler)),
                            (3, wgpu::BindingResource::TextureView(&stretch)),
                        ];
                        (self.blur.bind(device, 0, &resources), *chart)
                    })
                    .collect();
                draw(encoder, &textures[1], &self.blur, &groups);
            }
            let resources = [(0, wgpu::BindingResource::TextureView(&views[0]))];
            let whole = Chart { low: [0, 0], high: self.size };
            draw(encoder, &views[1], &self.dilate, &[(self.dilate.bind(device, 0, &resources), whole)]);
        })?;
        Ok(())
    }
}

/// A pass over the charts' rectangles.
fn draw(
    encoder: &mut Encoder,
    target: &wgpu::TextureView,
    pipeline: &Pipeline,
    groups: &[(Option<wgpu::BindGroup>, Chart)],
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(RECIPE),
        color_attachments: &[device::cleared(target)],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(&pipeline.raw);
    for (group, Chart { low, high }) in groups {
        pass.set_scissor_rect([low[0], low[1], high[0].saturating_sub(low[0]), high[1].saturating_sub(low[1])]);
        pass.set_bind_group(0, group.as_ref());
        pass.draw(0..3, 0..1);
    }
}
