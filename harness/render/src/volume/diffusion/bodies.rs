//! The bodies through which light diffuses, and the passes that compute their fluence.

use super::cells::Cells;
use super::levels::Levels;
use super::source::Source;
use crate::frame::{Buffer, Builder, Frame};
use crate::shadow::reflective_shadow_map::ReflectiveShadowMaps;
use crate::volume::density::Densities;
use crate::volume::stage::Stage;
use std::ops::Range;

/// The passes of a frame before the bodies are drawn.
pub(crate) struct Diffusions {
    pub(super) maps: ReflectiveShadowMaps,
    pub(super) bodies: Vec<BodyDiffusion>,
}

/// Buffers and passes of one body.
pub(super) struct BodyDiffusion {
    /// Name of its object.
    pub(super) name: String,
    pub(super) cells: Cells,
    pub(super) densities: Option<Densities>,
    pub(super) source: Source,
    pub(super) levels: Levels,
}

impl Diffusions {
    /// Encodes the passes that compute all that the frame's picture looks up, from the meshes and
    /// lights alone. Returns the range of passes of each stage except [`Stage::Shade`].
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) -> [Range<usize>; Stage::ALL.len() - 1] {
        Stage::before_shading(
            builder,
            |builder| self.maps.encode(builder),
            &self.bodies,
            |body| &body.name,
            BodyDiffusion::encode,
        )
    }

    /// The fluence of each body's finest level.
    pub(crate) fn fluences(&self) -> impl Iterator<Item = Buffer> {
        self.bodies.iter().map(|body| body.levels.fluence())
    }

    /// Size in bytes of the maps and of each body's cells, densities, source and levels.
    pub(crate) fn bytes(&self, frame: &Frame) -> u64 {
        let of_body = |body: &BodyDiffusion| {
            let densities = body.densities.as_ref().map_or(0, |densities| densities.bytes(frame));
            body.cells.bytes(frame) + densities + body.source.bytes(frame) + body.levels.bytes(frame)
        };
        self.maps.bytes(frame) + self.bodies.iter().map(of_body).sum::<u64>()
    }
}

impl BodyDiffusion {
    /// Encodes this body's part of a stage.
    fn encode(&self, builder: &mut Builder<'_>, stage: Stage) {
        match stage {
            Stage::Voxels => {
                self.cells.encode_voxels(builder);
                if let Some(densities) = &self.densities {
                    densities.encode(builder);
                }
                self.cells.encode(builder);
                self.levels.encode_equations(builder);
            }
            Stage::Seeds => self.source.encode(builder),
            Stage::Solve => self.levels.encode(builder),
            Stage::Maps | Stage::Shade => {}
        }
    }
}
