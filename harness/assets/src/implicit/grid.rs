//! The grid whose corners a field is sampled at.

use glam::{DVec2, DVec3};

/// A grid of boxes around a vertical axis, finer in some places than in others: the planes
/// perpendicular to x and to z converge or diverge with height.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// x and z of the vertical axis.
    axis: DVec2,
    /// Offsets of the corners from the axis along x and along z, at scale 1.
    across: [Vec<f64>; 2],
    /// Height and scale of each layer of corners, from the lowest.
    levels: Vec<[f64; 2]>,
}

impl Grid {
    /// Returns a grid from height `low` to `high` that reaches at least `reach` along x and z on
    /// either side of `axis` where `scale` is 1. A cell's size along y and z is `width` times
    /// `scale` at its height; along x, it is also multiplied by `stretch` at its distance from the
    /// axis.
    ///
    /// # Panics
    /// If a cell's width is not above 0.
    #[must_use]
    pub fn graded(
        axis: DVec2,
        reach: DVec2,
        [low, high]: [f64; 2],
        width: f64,
        scale: impl Fn(f64) -> f64,
        stretch: impl Fn(f64) -> f64,
    ) -> Self {
        let line = |from: f64, to: f64, step: &dyn Fn(f64) -> f64| -> Vec<f64> {
            let next = |&place: &f64| {
                assert!(step(place) > 0.0, "a cell at {place} is {} wide", step(place));
                (place < to).then(|| place + step(place))
            };
            std::iter::successors(Some(from), next).collect()
        };
        let mirrored = |half: Vec<f64>| -> Vec<f64> {
            let other = half.iter().skip(1).rev().map(|place| -place);
            other.chain(half.iter().copied()).collect()
        };
        let heights = line(low, high, &|height| width * scale(height));
        Self {
            axis,
            across: [
                mirrored(line(0.0, reach.x, &|place| width * stretch(place))),
                mirrored(line(0.0, reach.y, &|_| width)),
            ],
            levels: heights.into_iter().map(|height| [height, scale(height)]).collect(),
        }
    }

    /// Returns a grid of cubes of this width that fill the box from `low` to `high`, and a little
    /// more.
    #[must_use]
    pub fn uniform(low: DVec3, high: DVec3, width: f64) -> Self {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let axis = DVec2::new(middle.x, middle.z);
        Self::graded(axis, DVec2::new(half.x, half.z), [low.y, high.y], width, |_| 1.0, |_| 1.0)
    }

    /// Returns the number of corners along x, y and z.
    pub(super) fn corners(&self) -> [usize; 3] {
        [self.across[0].len(), self.levels.len(), self.across[1].len()]
    }

    /// Returns the position of a corner.
    pub(super) fn place(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        let [height, scale] = self.levels[y];
        let [x, z] = [self.across[0][x], self.across[1][z]];
        DVec3::new(self.axis.x + scale * x, height, self.axis.y + scale * z)
    }

    /// Returns the shortest side of a cell, given its lowest corner.
    pub(super) fn width(&self, [x, y, z]: [usize; 3]) -> f64 {
        (self.place([x + 1, y + 1, z + 1]) - self.place([x, y, z]))
            .y
            .min(self.levels[y][1] * (self.across[1][z + 1] - self.across[1][z]))
    }
}
