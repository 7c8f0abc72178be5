//! A scene as a frame: all its objects under their recipes, over tiles, then the display.

mod camera;
pub(crate) mod copies;
pub(crate) mod layers;
pub(crate) mod scene_frame;
pub(crate) mod scene_pass;
