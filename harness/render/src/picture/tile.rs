//! The tiles in which a picture is drawn.

/// Largest side of a tile in pixels.
const TILE: u32 = 512;
/// Largest side of a tile in samples: well within every device's texture limit, and 80 MiB of
/// colour and depth.
const TILE_SAMPLES: u32 = 2048;

/// A rectangle of the picture in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tile {
    pub(crate) left: u32,
    pub(crate) top: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Tile {
    /// Returns the largest side of a tile in pixels for `samples` along each side of a pixel.
    pub(crate) fn side(samples: u32) -> u32 {
        TILE.min(TILE_SAMPLES / samples)
    }

    /// Returns the tiles of a picture, row by row.
    pub(crate) fn all(width: u32, height: u32, samples: u32) -> impl Iterator<Item = Self> {
        let side = Self::side(samples);
        let lefts = move || (0..width).step_by(side as usize);
        (0..height).step_by(side as usize).flat_map(move |top| {
            lefts().map(move |left| Self { left, top, width: side.min(width - left), height: side.min(height - top) })
        })
    }
}
