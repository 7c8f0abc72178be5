//! The recipe `diffusion_source`: where light is scattered for the first time.

use super::cells::unit;
use super::matter::Matter;
use super::tiles::Tiles;
use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{Bound, Buffer, Builder, Dispatch, Frame, Workgroups};
use crate::volume::light_maps::Lit;
use crate::volume::voxel_grid::VoxelGrid;
use glam::Vec3;
use lapidary_scene::Light;
use std::f32::consts::PI;

const RECIPE: &str = "diffusion_source";
/// Invocations of a workgroup along each side of a map.
const GROUP: u32 = 8;

/// Pipelines and buffers for a body's source.
pub(super) struct Source {
    loads: Buffer,
    dispatches: Vec<Dispatch>,
}

/// Buffers that the recipe reads and writes.
pub(super) struct Buffers {
    /// The nodes of the cells.
    pub(super) nodes: Buffer,
    /// Voxels of half the spacing.
    pub(super) fine: Buffer,
    /// Density of each voxel; `None` if it is uniform.
    pub(super) density: Option<Buffer>,
    /// The right side of the equations.
    pub(super) right: Buffer,
    /// What the light from all around adds to it; `None` if none enters.
    pub(super) entering: Option<Buffer>,
    /// Which of the lights are lamps inside the body, and their number; `None` if none is.
    pub(super) enclosed: Option<(Buffer, u32)>,
    /// Tiles that hold matter.
    pub(super) tiles: Tiles,
}

/// Returns the irradiance to be counted as 1 for a lamp inside: all of its light then fills the sides of a voxel sixteen times,
/// which the loads hold.
pub(super) fn of_lamp(lamp: &Light, grid: VoxelGrid) -> Vec3 {
    let (intensity, solid_angle) = match *lamp {
        Light::Directional { .. } => return Vec3::ZERO,
        Light::Point { intensity, .. } => (intensity, 4.0 * PI),
        Light::Spot { intensity, outer_angle, .. } => (intensity, 4.0 * PI * (0.5 * outer_angle).sin().powi(2)),
    };
    intensity * (solid_angle / (16.0 * grid.spacing * grid.spacing))
}

impl Source {
    /// Creates the pipelines and buffers; `constants` are values of the recipe's overrides.
    pub(super) fn new(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        (lit, largest): (&Lit, Vec3),
        matter: Matter,
        buffers: &Buffers,
        constants: &[(&str, f64)],
    ) -> Result<Self, ShaderError> {
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut kernel =
            |entry: &str| builder.compute_pipeline(RECIPE, &source, &format!("{RECIPE}_{entry}"), constants);
        let mut kernels = vec![kernel("texel")?];
        if buffers.enclosed.is_some() {
            kernels.push(kernel("lamp")?);
        }
        kernels.push(kernel("finish")?);
        use wgpu::BufferUsages as Usage;
        let loads = builder.buffer("loads", 12 * grid.count() as u64, Usage::STORAGE | Usage::COPY_DST);
        let record = Record::new("DiffusionSource").within("grid", |record| grid.fill(record));
        let record = record.with("extinction", matter.extinction).with("milne", matter.milne());
        let record = record.with("gamma", matter.gamma).with("largest", unit(largest)).with("index", matter.index);
        let uniform = builder.uniform("source", record);
        let of_lights = [(0, uniform.into()), (2, lit.lights.into()), (4, lit.views.into()), (5, lit.maps)];
        let Buffers { nodes, fine, density, right, entering, enclosed, tiles } = *buffers;
        let mut of_body: Vec<(u32, Bound)> =
            vec![(0, loads.into()), (1, nodes.into()), (2, fine.into()), (4, right.into()), (6, tiles.list.into())];
        of_body.extend(density.map(|density| (3, density.into())));
        of_body.extend(entering.map(|entering| (5, entering.into())));
        of_body.extend(enclosed.map(|(flags, _)| (7, flags.into())));
        let [width, height, layers] = lit.size;
        let texels = Workgroups::Count([width.div_ceil(GROUP), height.div_ceil(GROUP), layers]);
        let rays = (2 * grid.cells * grid.cells).div_ceil(GROUP * GROUP);
        let lamps = enclosed.map(|(_, lights)| Workgroups::Count([rays, lights, 1]));
        let counts = [Some(texels), lamps, Some(tiles.dispatched())].into_iter().flatten();
        let dispatch = |(kernel, workgroups)| {
            let groups = vec![builder.bind(kernel, 0, &of_lights), builder.bind(kernel, 1, &of_body)];
            builder.dispatch(kernel, groups, workgroups)
        };
        Ok(Self { loads, dispatches: kernels.into_iter().zip(counts).map(dispatch).collect() })
    }

    /// Encodes the source, once the maps are drawn.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) {
        builder.clear(self.loads);
        builder.compute(RECIPE, self.dispatches.clone(), 1);
    }

    /// Size of the buffers in bytes.
    pub(super) fn bytes(&self, frame: &Frame) -> u64 {
        frame.bytes_of([self.loads])
    }
}
