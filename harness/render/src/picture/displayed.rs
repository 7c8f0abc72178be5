//! Samples and means that were computed elsewhere, displayed on a device.

use super::display::DisplayPass;
use super::rendered::Picture;
use super::tile::Tile;
use crate::error::RenderError;
use crate::frame::{Builder, Executor, Texture};
use crate::settings::Settings;
use lapidary_gpu::Gpu;
use std::ops::Range;

/// Displays samples that were computed elsewhere.
pub(crate) struct Display<'gpu> {
    executor: Executor<'gpu>,
    count: u32,
    samples: Texture,
    /// Each tile and its passes.
    pub(crate) tiles: Vec<(Tile, Range<usize>)>,
}

impl<'gpu> Display<'gpu> {
    /// Creates the pass for a picture with the settings' size and samples.
    pub(crate) fn new(gpu: &'gpu Gpu, settings: &Settings) -> Result<Self, RenderError> {
        let mut builder = Builder::new(Some(gpu));
        let pass = DisplayPass::new(&mut builder, settings)?;
        let tile = |tile| {
            let start = builder.frame().passes.len();
            pass.encode(&mut builder, tile, settings);
            (tile, start..builder.frame().passes.len())
        };
        let tiles = Tile::all(settings.width, settings.height, settings.samples).map(tile).collect();
        let executor = Executor::new(gpu, builder.finish())?;
        Ok(Self { executor, count: pass.count, samples: pass.samples, tiles })
    }

    /// Fills a tile of a picture from its samples, row by row.
    pub(crate) fn show(
        &self,
        (tile, passes): &(Tile, Range<usize>),
        samples: &[[f32; 4]],
        picture: &mut Picture,
    ) -> Result<(), RenderError> {
        let size = [tile.width, tile.height].map(|side| side * self.count);
        self.executor.write_texture(self.samples, size, bytemuck::cast_slice(samples));
        Ok(self.executor.run_passes(passes.clone(), |read, texels| picture.take(read, texels))?)
    }
}

/// Fills `encoded` from `linear`: the display recipe applied to means, with one sample per pixel.
pub fn encode(gpu: &Gpu, settings: &Settings, picture: &mut Picture) -> Result<(), RenderError> {
    let settings = Settings { width: picture.width, height: picture.height, samples: 1, ..settings.clone() };
    let display = Display::new(gpu, &settings)?;
    for tile in &display.tiles {
        let Tile { left, top, width, height } = tile.0;
        let rows = (top..top + height).map(|row| (row * picture.width + left) as usize);
        let means: Vec<[f32; 4]> =
            rows.flat_map(|start| &picture.linear[start..start + width as usize]).copied().collect();
        display.show(tile, &means, picture)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
