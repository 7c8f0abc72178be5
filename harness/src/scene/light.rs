//! Lights that are points or far away. What surrounds the scene on all sides is its environment.

use glam::Vec3;

/// A light without size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// So far away that its rays are parallel.
    Directional {
        /// Unit, towards the light.
        toward: Vec3,
        /// What a surface square to it receives, linear RGB, at least 0.
        irradiance: Vec3,
    },
    /// A point that shines to all sides alike.
    Point {
        /// In world space.
        position: Vec3,
        /// Radiant intensity, linear RGB, at least 0: the irradiance at distance 1.
        intensity: Vec3,
    },
}
