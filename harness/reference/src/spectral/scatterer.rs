//! Bodies inside which light scatters, as other parts of the reference follow it.

use glam::DVec3;
use rand::rngs::Xoshiro256PlusPlus;
use std::fmt;

/// A body in which light scatters.
pub trait Scatterer: fmt::Debug + Sync {
    /// Returns the radiance that the body sends against a ray from outside: right in the mean over random numbers. `None` if the
    /// ray does not meet it.
    fn sent(&self, origin: DVec3, direction: DVec3, random: &mut Xoshiro256PlusPlus) -> Option<DVec3>;
}
