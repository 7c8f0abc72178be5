//! Ways to cut a convex face into triangles.

use glam::DVec3;

/// How a face of five or more corners is cut into triangles. A face of three or four corners is
/// always a fan from its first corner.
///
/// The surface is the same in each case. What differs is the paper's proxy geometry, which treats
/// each triangle by itself; the last three variants exist to show that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Triangulation {
    /// A fan about a vertex at the face's centroid, which keeps the face's symmetry.
    #[default]
    Centroid,
    /// A fan from the face's first corner: no inner vertex, and the first corner in every triangle.
    Fan,
    /// A zigzag between the two sides of the face, like a triangle strip: no inner vertex, and no
    /// corner in more than three triangles.
    Strip,
    /// The fan, with each of its triangles cut into needles: vertices are spaced evenly along the
    /// median from the first corner, and each of the other two corners is joined to all of them.
    /// Most triangles thus have an angle of a few degrees.
    Sliver,
}

/// Number of vertices along each median of [`Triangulation::Sliver`].
pub const SLIVERS: usize = 12;

/// A face cut into triangles.
#[derive(Debug)]
pub(super) struct Cut {
    /// Vertices inside the face. None lies on its edge, because the neighbouring face would not
    /// share it.
    pub(super) inner: Vec<DVec3>,
    /// Indices into the face's ring, followed by those of `inner`; wound like the ring.
    pub(super) triangles: Vec<[usize; 3]>,
}

impl Triangulation {
    /// Triangulates the convex face with the corners `ring`, at least three.
    pub(super) fn cut(self, ring: &[DVec3], centroid: impl FnOnce() -> DVec3) -> Cut {
        let corners = ring.len();
        match self {
            Self::Centroid if corners > 4 => {
                let about = (0..corners).map(|k| [corners, k, (k + 1) % corners]);
                Cut { inner: vec![centroid()], triangles: about.collect() }
            }
            Self::Strip if corners > 4 => Cut { inner: Vec::new(), triangles: strip(corners) },
            Self::Sliver if corners > 4 => slivers(ring),
            _ => Cut { inner: Vec::new(), triangles: fan(corners).collect() },
        }
    }
}

fn fan(corners: usize) -> impl Iterator<Item = [usize; 3]> {
    (1..corners - 1).map(|k| [0, k, k + 1])
}

fn strip(corners: usize) -> Vec<[usize; 3]> {
    let (mut low, mut high) = (0, corners - 1);
    let zigzag = (0..corners - 2).map(|k| {
        if k % 2 == 0 {
            low += 1;
            [low - 1, low, high]
        } else {
            high -= 1;
            [low, high, high + 1]
        }
    });
    zigzag.collect()
}

fn slivers(ring: &[DVec3]) -> Cut {
    let mut cut = Cut { inner: Vec::new(), triangles: Vec::new() };
    for [apex, left, right] in fan(ring.len()) {
        let foot = 0.5 * (ring[left] + ring[right]);
        let mut last = apex;
        for step in 1..=SLIVERS {
            let next = ring.len() + cut.inner.len();
            cut.inner.push(ring[apex].lerp(foot, step as f64 / (SLIVERS + 1) as f64));
            cut.triangles.extend([[last, left, next], [last, next, right]]);
            last = next;
        }
        cut.triangles.push([last, left, right]);
    }
    cut
}
