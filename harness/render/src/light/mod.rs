//! What lights a body: the scene's lights, the environment, and other bodies, by their bounds or by their picture.

pub(crate) mod beside;
pub(crate) mod blurred;
pub(crate) mod environment;
pub(crate) mod from_bodies;
pub(crate) mod hierarchy;
pub(crate) mod lighting;
pub(crate) mod paint;
pub(crate) mod screen;
