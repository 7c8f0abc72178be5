//! How places of a technique's own space come onto the sheet.

use glam::{DVec2, DVec3, Vec3};

/// A section: coordinates in its plane, y up.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Where the plane's origin lies on the sheet.
    pub origin: DVec2,
    /// Units of the sheet for a unit of the plane.
    pub scale: f64,
}

impl Section {
    /// A section about a place of the sheet.
    pub const fn new(x: f64, y: f64, scale: f64) -> Self {
        Self { origin: DVec2::new(x, y), scale }
    }

    /// Where a point of the plane lies on the sheet.
    pub fn at(&self, point: DVec2) -> DVec2 {
        self.origin + self.scale * DVec2::new(point.x, -point.y)
    }

    /// Where these points lie on the sheet.
    pub fn all(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|point| self.at(*point)).collect()
    }

    /// What a direction of the plane is on the sheet.
    pub fn along(&self, direction: DVec2) -> DVec2 {
        DVec2::new(direction.x, -direction.y)
    }
}

/// An oblique view of space: x to the right, y into the depth, z up.
#[derive(Clone, Copy, Debug)]
pub struct Oblique {
    /// Where the origin lies on the sheet.
    pub origin: DVec2,
    /// Units of the sheet for a unit of space.
    pub scale: f64,
    /// What a step into the depth is on the sheet, in units of `scale`.
    pub depth: DVec2,
}

impl Oblique {
    /// Where a point of space lies on the sheet.
    pub fn at(&self, point: Vec3) -> DVec2 {
        let DVec3 { x, y, z } = point.as_dvec3();
        self.origin + self.scale * (DVec2::new(x, -z) + y * self.depth)
    }

    /// Where these points lie on the sheet.
    pub fn all(&self, points: &[Vec3]) -> Vec<DVec2> {
        points.iter().map(|point| self.at(*point)).collect()
    }
}

/// A vector of the section in space, z = 0.
pub fn flat(point: DVec2) -> Vec3 {
    point.as_vec2().extend(0.0)
}

/// What of a vector lies in the section.
pub fn section(point: Vec3) -> DVec2 {
    point.truncate().as_dvec2()
}

/// A place on the sheet.
pub const fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}
