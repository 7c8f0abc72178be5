//! What a user chooses of a file: the camera, and the time of its animations.

/// What is shown of a scene. By default its first camera, and its bodies at rest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Opening {
    /// The camera: its name, its node's name, or its number in the file, from 0.
    pub camera: Option<String>,
    /// Time at which all animations of the file are evaluated, in seconds of at least 0.
    pub time: Option<f32>,
}
