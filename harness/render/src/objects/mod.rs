//! A scene's objects in a frame: by which technique each is drawn, its mesh in buffers, its draws.

pub(crate) mod draws;
pub(crate) mod mesh_buffers;
pub(crate) mod part;
