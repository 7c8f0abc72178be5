//! Tiles of a grid that hold matter: what is dispatched over a body's cells alone.

use crate::frame::{Buffer, Builder, Pass, Workgroups};
use crate::volume::density::Where;

/// Cells along an edge of a tile.
pub(super) const TILE: u32 = 4;

/// The list of a grid's tiles.
#[derive(Clone, Copy)]
pub(super) struct Tiles {
    /// Numbers of the tiles that hold matter.
    pub(super) list: Buffer,
    /// Their count, as arguments of an indirect dispatch.
    pub(super) workgroups: Buffer,
    /// What `workgroups` begins as.
    none: Buffer,
}

impl Tiles {
    /// Creates the list of the grid of this level, with this number of cells along an edge.
    pub(super) fn new(builder: &mut Builder<'_>, cells: u32, level: usize) -> Self {
        use wgpu::BufferUsages as Usage;
        let copied = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
        let list = builder.buffer(&format!("tiles of level {level}"), 4 * u64::from(count(cells)), copied);
        let workgroups = builder.buffer(&format!("tile count of level {level}"), 12, copied | Usage::INDIRECT);
        let none = bytemuck::cast_slice(&[0u32, 1, 1]).to_vec();
        Self { list, workgroups, none: builder.filled("no tiles", none, Usage::COPY_SRC) }
    }

    /// Encodes that the list begins without tiles.
    pub(super) fn encode_none(&self, builder: &mut Builder<'_>) {
        builder.pass(Pass::Copy { from: self.none, to: self.workgroups, bytes: 12 });
    }

    /// Returns a workgroup for each listed tile.
    pub(super) fn dispatched(&self) -> Workgroups {
        Workgroups::Indirect(self.workgroups)
    }

    /// Returns the listed tiles as places of densities.
    pub(super) fn places(&self) -> Where {
        Where::Listed { tiles: self.list, workgroups: self.workgroups }
    }

    /// The buffers.
    pub(super) fn buffers(&self) -> [Buffer; 3] {
        [self.list, self.workgroups, self.none]
    }
}

/// Returns the number of tiles of a grid with this number of cells along an edge.
pub(super) fn count(cells: u32) -> u32 {
    cells.div_ceil(TILE).pow(3)
}
