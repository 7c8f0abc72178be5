//! The recipe `blur_texture`: its textures, and its passes from the drawn irradiance to the
//! texture that shading looks up.

use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{BindGroupId, Bound, Builder, Draw, PipelineId, PipelineSource, Sampler, Texture};
use glam::{Vec2, Vec3, Vec4};
use lapidary_texture_diffusion as mirror;

/// Name of the recipe.
const RECIPE: &str = "blur_texture";
/// Format of the irradiance: irradiance times coverage, with the coverage in alpha.
pub const IRRADIANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of the world lengths of a texel along u and along v.
pub const STRETCH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
/// Maximum number of pairs of taps that the recipe's uniform holds.
pub const MOST_PAIRS: u32 = 23;
/// A chart's bound along a direction that repeats.
const UNBOUNDED: f32 = 1e9;

/// A chart's rectangle, in texels from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    /// Upper left corner.
    pub low: [u32; 2],
    /// Lower right corner.
    pub high: [u32; 2],
}

/// Taps for a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Taps {
    /// Standard deviation of the widest channel, in units of length.
    sigma0: f32,
    /// Offset and weights of each pair.
    pairs: Vec<Vec4>,
}

impl Taps {
    /// Creates as many taps as the material needs. `sigma0` is each channel's standard deviation on
    /// the surface, in units of length.
    pub fn new(sigma0: Vec3) -> Taps {
        Taps::with_pairs(sigma0, mirror::pairs(sigma0))
    }

    /// Creates as many pairs as requested, up to [`MOST_PAIRS`].
    pub fn with_pairs(sigma0: Vec3, pairs: u32) -> Taps {
        let pairs = pairs.clamp(1, MOST_PAIRS);
        let tap = |index| {
            let tap = mirror::tap(index, pairs, sigma0);
            Vec4::new(tap.offset, tap.weight.x, tap.weight.y, tap.weight.z)
        };
        Taps { sigma0: mirror::sigma(sigma0).max_element(), pairs: (1..=pairs).map(tap).collect() }
    }

    /// Fills the uniform of a pass.
    fn record(&self, direction: Vec2, low: Vec2, high: Vec2) -> Record {
        let mut taps = [Vec4::ZERO; MOST_PAIRS as usize];
        taps[..self.pairs.len()].copy_from_slice(&self.pairs);
        let record = Record::new("BlurTextureChart").with("direction", direction).with("sigma0", self.sigma0);
        let record =
            record.with("pairs", self.pairs.len() as u32).with("chart", Vec4::new(low.x, low.y, high.x, high.y));
        record.with("taps", &taps[..])
    }
}

/// Textures and pipelines for a surface's texture of one size.
#[derive(Debug)]
pub struct TextureDiffusion {
    size: [u32; 2],
    repeats: [bool; 2],
    blur: PipelineId,
    dilate: PipelineId,
    sampler: Sampler,
    /// Target of the irradiance for the pass that lights the surface. The blur overwrites it.
    pub irradiance: Texture,
    /// Target of the same pass for the extent of the surface under a texel.
    pub stretch: Texture,
    /// Texture that shading looks up: irradiance, and 1 in alpha where there is any.
    pub diffused: Texture,
}

impl TextureDiffusion {
    /// Creates the textures and pipelines for a texture of `size` texels; `repeats` says whether it
    /// repeats along u and along v.
    ///
    /// # Errors
    /// If the recipe is not valid.
    pub fn new(builder: &mut Builder<'_>, size: [u32; 2], repeats: [bool; 2]) -> Result<Self, RenderError> {
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut pipeline = |entry| {
            let entries = ["blur_texture_vertex", entry];
            let formats = &[IRRADIANCE_FORMAT];
            let source =
                PipelineSource { recipe: RECIPE, source: &source, entries, constants: &[], formats, depth: None };
            builder.render_pipeline(&source)
        };
        let [blur, dilate] = [pipeline("blur_texture_along")?, pipeline("blur_texture_dilate")?];
        let address = |repeats| if repeats { wgpu::AddressMode::Repeat } else { wgpu::AddressMode::ClampToEdge };
        let sampler = builder.sampler("texture sampler", repeats.map(address));
        use wgpu::TextureUsages as Usage;
        let usage = Usage::TEXTURE_BINDING | Usage::COPY_SRC | Usage::COPY_DST;
        let [irradiance, stretch, diffused] = [
            ("irradiance", IRRADIANCE_FORMAT),
            ("stretch", STRETCH_FORMAT),
            ("diffused irradiance", IRRADIANCE_FORMAT),
        ]
        .map(|(what, format)| builder.target(what, [size[0], size[1], 1], format, usage));
        Ok(Self { size, repeats, blur, dilate, sampler, irradiance, stretch, diffused })
    }

    /// Blurs the irradiance along u and v, chart by chart, and fills the gutters.
    pub fn encode(&self, builder: &mut Builder<'_>, taps: &Taps, charts: &[Chart]) {
        let textures = [self.irradiance, self.diffused, self.irradiance];
        for (direction, textures) in [Vec2::X, Vec2::Y].into_iter().zip(textures.windows(2)) {
            let mut draws = Vec::new();
            for chart in charts {
                let bound = |corner: [u32; 2], unbounded: f32| {
                    let along = |axis: usize| if self.repeats[axis] { unbounded } else { corner[axis] as f32 };
                    Vec2::new(along(0), along(1))
                };
                let record = taps.record(direction, bound(chart.low, -UNBOUNDED), bound(chart.high, UNBOUNDED));
                let uniform = builder.uniform("taps", record);
                let resources =
                    [(0, textures[0].into()), (1, uniform.into()), (2, self.sampler.into()), (3, self.stretch.into())];
                let group = builder.bind(self.blur, 0, &resources);
                draws.push((group, *chart));
            }
            draw(builder, textures[1], self.blur, &draws);
        }
        let group = builder.bind(self.dilate, 0, &[(0, Bound::from(self.irradiance))]);
        draw(builder, self.diffused, self.dilate, &[(group, Chart { low: [0, 0], high: self.size })]);
    }
}

/// Encodes a pass over the charts' rectangles.
fn draw(builder: &mut Builder<'_>, target: Texture, pipeline: PipelineId, charts: &[(Option<BindGroupId>, Chart)]) {
    let of_chart = |(group, Chart { low, high }): &(Option<BindGroupId>, Chart)| {
        let scissor = [low[0], low[1], high[0].saturating_sub(low[0]), high[1].saturating_sub(low[1])];
        Draw { scissor: Some(scissor), ..builder.draw(pipeline, vec![*group], 3) }
    };
    let draws = charts.iter().map(of_chart).collect();
    builder.draw_to(RECIPE, &[target], None, draws);
}
