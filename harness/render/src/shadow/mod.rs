//! What keeps light from a body: the lights' views of the scene, drawn as maps.

pub(crate) mod casters;
pub(crate) mod colored_shadow;
pub(crate) mod light_views;
pub(crate) mod reflective_shadow_map;
pub(crate) mod shadows;
