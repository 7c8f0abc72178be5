//! Reference pictures, computed on the CPU in f64: [`spectral`] for clear stones, [`random_walk`] for what scatters light.

pub mod random_walk;
pub mod spectral;
