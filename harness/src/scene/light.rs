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

impl Light {
    /// Which of its fields' promises is broken, and what to do; nothing for a sound light.
    #[must_use]
    pub fn problem(&self) -> Option<&'static str> {
        let is_light = |light: Vec3| light.is_finite() && light.cmpge(Vec3::ZERO).all();
        match *self {
            Self::Directional { toward, .. } if !toward.is_normalized() => {
                Some("its direction has not unit length; normalise it")
            }
            Self::Point { position, .. } if !position.is_finite() => Some("its position is not finite; mend it"),
            Self::Directional { irradiance: light, .. } | Self::Point { intensity: light, .. } if !is_light(light) => {
                Some("its light is not finite and at least 0; mend it")
            }
            _ => None,
        }
    }
}
