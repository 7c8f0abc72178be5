//! How lists of vertices form triangles.

use ::gltf::json::mesh::Mode;
use ::gltf::json::validation::Checked;

/// How a list of vertices forms triangles.
#[derive(Debug, Clone, Copy)]
pub(super) enum Arrangement {
    List,
    Strip,
    Fan,
}

impl Arrangement {
    /// Returns `None` for points and lines, and for modes that glTF does not define.
    pub(super) fn of(mode: Checked<Mode>) -> Option<Self> {
        match mode {
            Checked::Valid(Mode::Triangles) => Some(Self::List),
            Checked::Valid(Mode::TriangleStrip) => Some(Self::Strip),
            Checked::Valid(Mode::TriangleFan) => Some(Self::Fan),
            _ => None,
        }
    }

    /// Number of complete triangles; glTF requires readers to ignore leftover vertices.
    pub(super) fn triangles(self, corners: usize) -> usize {
        match self {
            Self::List => corners / 3,
            Self::Strip | Self::Fan => corners.saturating_sub(2),
        }
    }

    /// Positions of the corners of triangle `k` in the list, in glTF's winding order.
    fn corners(self, k: usize) -> [usize; 3] {
        match self {
            Self::List => [3 * k, 3 * k + 1, 3 * k + 2],
            Self::Strip => [k, k + 1 + k % 2, k + 2 - k % 2],
            Self::Fan => [k + 1, k + 2, 0],
        }
    }
}

/// Builds a triangle list. Triangles with a repeated corner, which strips use to turn, are dropped,
/// and the winding is reversed if a reflection has turned the triangles inside out.
pub(super) fn assemble(corners: &[u32], arrangement: Arrangement, mirrored: bool) -> Vec<u32> {
    let count = arrangement.triangles(corners.len());
    let mut indices = Vec::with_capacity(3 * count);
    for triangle in 0..count {
        let [a, b, c] = arrangement.corners(triangle).map(|place| corners[place]);
        if a == b || b == c || c == a {
            continue;
        }
        indices.extend(if mirrored { [a, c, b] } else { [a, b, c] });
    }
    indices
}
