//! A chart: triangles that are projected along one axis.

use glam::{DVec2, DVec3};
use lapidary_scene::Mesh;

/// A viewing direction.
#[derive(Debug, Clone, Copy)]
pub(in crate::atlas) struct Axis {
    pub(super) toward_eye: DVec3,
    right: DVec3,
    down: DVec3,
}

impl Axis {
    pub(super) fn new(toward_eye: DVec3) -> Self {
        let (right, up) = toward_eye.any_orthonormal_pair();
        Self { toward_eye, right, down: -up }
    }

    /// Projects a point to its place to the right and down.
    pub(in crate::atlas) fn draw(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.down))
    }
}

/// Triangles of a mesh, by number, and the axis along which they are projected.
#[derive(Debug)]
pub(in crate::atlas) struct Chart {
    pub(in crate::atlas) axis: Axis,
    pub(in crate::atlas) triangles: Vec<u32>,
    /// Triangles of other charts that are drawn around this one.
    pub(in crate::atlas) halo: Vec<u32>,
}

impl Chart {
    /// Returns the chart's triangles and those of its halo, as drawn.
    pub(in crate::atlas) fn drawn(&self, mesh: &Mesh) -> Vec<[DVec2; 3]> {
        let corner = |index: usize| self.axis.draw(mesh.positions[mesh.indices[index] as usize].as_dvec3());
        let triangle = |&number: &u32| [0, 1, 2].map(|k| corner(3 * number as usize + k));
        self.triangles.iter().chain(&self.halo).map(triangle).collect()
    }
}
