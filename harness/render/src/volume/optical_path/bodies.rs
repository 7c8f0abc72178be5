//! The bodies through which paths of light are found, and the passes that find them.

use crate::frame::{Buffer, Builder, Dispatch, Frame};
use crate::shadow::reflective_shadow_map::ReflectiveShadowMaps;
use crate::volume::density::Densities;
use crate::volume::solver::{Solved, Solver};
use crate::volume::stage::Stage;
use crate::volume::voxelization::Voxelizer;
use glam::Vec3;
use std::ops::Range;

/// The passes of a frame before the bodies are drawn.
pub(crate) struct OpticalPaths {
    pub(super) maps: ReflectiveShadowMaps,
    pub(super) bodies: Vec<BodyPaths>,
}

/// Buffers and passes of one body.
pub(super) struct BodyPaths {
    /// Name of its object.
    pub(super) name: String,
    pub(super) voxelizer: Voxelizer,
    pub(super) densities: Option<Densities>,
    pub(super) solver: Solver,
    pub(super) positions: Buffer,
    pub(super) indices: Buffer,
    pub(super) channels: Vec<Channel>,
    /// Linear radiance that the surface sends back where the cost is 0, for each channel.
    pub(super) brightest: Vec3,
}

/// Passes of one of a body's channels.
pub(super) struct Channel {
    pub(super) seeds: Vec<Dispatch>,
    pub(super) solved: Solved,
}

impl OpticalPaths {
    /// Encodes the passes that compute all the data that the frame's picture looks up, from the
    /// meshes and lights alone. Returns the range of passes of each stage except [`Stage::Shade`],
    /// which is not part of it.
    pub(crate) fn encode(&self, builder: &mut Builder<'_>) -> [Range<usize>; Stage::ALL.len() - 1] {
        Stage::before_shading(
            builder,
            |builder| self.maps.encode(builder),
            &self.bodies,
            |body| &body.name,
            BodyPaths::encode,
        )
    }

    /// Size in bytes of the maps and of each body's voxels, densities, costs and solver.
    pub(crate) fn bytes(&self, frame: &Frame) -> u64 {
        let of_body = |body: &BodyPaths| {
            let costs = frame.bytes_of(body.channels.iter().map(|channel| channel.solved.cost));
            let densities = body.densities.as_ref().map_or(0, |densities| densities.bytes(frame));
            body.voxelizer.bytes(frame) + densities + costs + body.solver.bytes(frame)
        };
        self.maps.bytes(frame) + self.bodies.iter().map(of_body).sum::<u64>()
    }
}

impl BodyPaths {
    /// Encodes this body's part of a stage.
    fn encode(&self, builder: &mut Builder<'_>, stage: Stage) {
        match stage {
            Stage::Voxels => {
                self.voxelizer.encode(builder, self.positions, self.indices);
                if let Some(densities) = &self.densities {
                    densities.encode(builder);
                }
            }
            Stage::Seeds => self.channels.iter().for_each(|channel| builder.compute("seeds", channel.seeds.clone(), 1)),
            Stage::Solve => self.channels.iter().for_each(|channel| self.solver.encode(builder, &channel.solved)),
            Stage::Maps | Stage::Shade => {}
        }
    }
}
