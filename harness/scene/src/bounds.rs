//! Axis-aligned boxes.

use glam::Vec3;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// Returns the smallest box around `points`, or a box of zero size at the origin if there are
    /// none.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        let grow = |bounds: Self, point: Vec3| Self { min: bounds.min.min(point), max: bounds.max.max(point) };
        let box_of = |point| Self { min: point, max: point };
        let mut points = points.into_iter();
        let first = points.next().map_or(box_of(Vec3::ZERO), box_of);
        points.fold(first, grow)
    }

    /// Returns the smallest box around both.
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the centre of the box.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Returns half the diagonal: the radius of the bounding sphere about the centre.
    #[must_use]
    pub fn radius(&self) -> f32 {
        0.5 * self.min.distance(self.max)
    }
}
