//! Errors in glTF files.

use thiserror::Error;

use super::limits::{MAX_COORDINATE, MAX_OBJECTS, MAX_SCENE_BYTES, MAX_TRIANGLES};

/// Error in a glTF file, described in one line. Indices count from 0, as in the file itself.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GltfError {
    /// The file, or an external buffer or image, cannot be read.
    #[error("{what} cannot be read: {reason}; check its name and whether it may be read")]
    Unreadable {
        /// `the file`, or the buffer or image and its file.
        what: String,
        /// Reason given by the operating system.
        reason: String,
    },
    /// The file, its buffers or an image exceed the size limit.
    #[error("{what} has {bytes} bytes, but at most {limit} are read; decimate or split it")]
    TooLarge {
        /// The file, its buffers or the image.
        what: String,
        /// Size in bytes.
        bytes: u64,
        /// Limit in bytes.
        limit: u64,
    },
    /// The file is neither a .glb nor JSON.
    #[error("this is not glTF: it starts neither as a .glb nor as JSON; give a glTF 2.0 file")]
    NotGltf,
    /// The parts of a .glb are inconsistent.
    #[error("this .glb is damaged: {problem}; export or download it again")]
    Container {
        /// Description of the inconsistency.
        problem: String,
    },
    /// Unsupported version of glTF.
    #[error(
        "it is of glTF version {version}, but only 2.0 is read; export it as glTF 2.0, or convert it (`gltf-pipeline` does)"
    )]
    Version {
        /// Version that the file requires.
        version: String,
    },
    /// The JSON is malformed, or does not match glTF's schema.
    #[error("its JSON is not valid glTF: {message}; export it again")]
    Json {
        /// Message of the parser, with line and column.
        message: String,
    },
    /// The file requires extensions that are not supported.
    #[error(
        "it requires extensions that are not supported: {extensions}; export it without them (docs/scene_files.md names those that are)"
    )]
    RequiredExtensions {
        /// Names of the extensions.
        extensions: String,
    },
    /// Reference to an item that is not in the file.
    #[error("{from} refers to {what} {index}, but the file has {count}; export it again")]
    Dangling {
        /// Item that holds the reference.
        from: String,
        /// Kind of the missing item.
        what: &'static str,
        /// Index of the missing item.
        index: usize,
        /// Number of items of that kind.
        count: usize,
    },
    /// A part of the file breaks a rule of glTF or uses an unsupported feature.
    #[error("{part}: {problem}")]
    Part {
        /// The part, such as `accessor 3` or `material 0 "glass"`.
        part: String,
        /// Problem and how to fix it.
        problem: String,
    },
    /// A world position that is not finite, or too far out.
    #[error(
        "{primitive}: vertex {vertex} lies at ({}, {}, {}), but coordinates must be finite and at most \
         {MAX_COORDINATE:e}; mend or remove the vertex",
        position[0], position[1], position[2]
    )]
    Position {
        /// Designation of the primitive.
        primitive: String,
        /// Index of the vertex.
        vertex: usize,
        /// World position of the vertex.
        position: [f32; 3],
    },
    /// A triangle refers to a vertex that does not exist.
    #[error("{primitive}: index {place} is {index}, but it has {vertices} vertices; export it again")]
    IndexOutOfRange {
        /// Designation of the primitive.
        primitive: String,
        /// Position in the list of indices.
        place: usize,
        /// Value of the index.
        index: u32,
        /// Number of vertices.
        vertices: u64,
    },
    /// No camera of the scene has the name or number that was asked for.
    #[error("its scene has no camera `{which}`; {}", if known.is_empty() { "it has none: leave the camera out".to_owned() } else { format!("it has {known}") })]
    NoCamera {
        /// Name or number that was asked for.
        which: String,
        /// The scene's cameras.
        known: String,
    },
    /// The scene shows no triangles.
    #[error("its scene shows no triangles; put a mesh of triangles into the scene")]
    NoTriangles,
    /// The scene exceeds the limit on triangles or vertices.
    #[error(
        "its scene shows more than {MAX_TRIANGLES} triangles or three times as many vertices, each \
         instance counted; decimate it or show fewer instances"
    )]
    TooManyTriangles,
    /// The bodies exceed the memory limit of a scene.
    #[error(
        "its scene takes more than {} MiB of memory, each instance counted; decimate its meshes or show fewer instances",
        MAX_SCENE_BYTES >> 20
    )]
    TooMuchMemory,
    /// The scene exceeds the limit on bodies.
    #[error(
        "its scene shows more than {MAX_OBJECTS} bodies; join them, or show fewer instances (those of one node by \
         EXT_mesh_gpu_instancing count as one)"
    )]
    TooManyObjects,
}

impl GltfError {
    pub(super) fn json(error: ::gltf::json::Error) -> Self {
        Self::Json { message: shortened([error.to_string()]) }
    }

    pub(super) fn part(part: String, problem: impl Into<String>) -> Self {
        let problem = problem.into();
        Self::Part { part, problem }
    }
}

/// Returns item `index` of `list`, or an error that names the user of the reference, `from`.
pub(super) fn item<'a, T>(
    list: &'a [T],
    what: &'static str,
    index: usize,
    from: impl FnOnce() -> String,
) -> Result<&'a T, GltfError> {
    list.get(index).ok_or_else(|| GltfError::Dangling { from: from(), what, index, count: list.len() })
}

/// Formats `mesh 2`, or with a name `mesh 2 "bunny"`.
pub(super) fn designation(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {index} {:?}", excerpt(name)),
        None => format!("{kind} {index}"),
    }
}

/// Maximum number of characters of a file's text in a message or a scene: a name may be as long as
/// the file, and an instance of its mesh may cost only a few bytes.
const EXCERPT: usize = 64;

/// Beginning of `text`, without control characters.
pub(super) fn excerpt(text: &str) -> String {
    let mut rest = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut short: String = rest.by_ref().take(EXCERPT).collect();
    if rest.next().is_some() {
        short.push('…');
    }
    short
}

/// Formats a list on one line, cut to a length that a terminal can show.
pub(super) fn shortened(list: impl IntoIterator<Item = String>) -> String {
    let list: Vec<String> = list.into_iter().take(EXCERPT).collect();
    let line = list.join(", ").replace(char::is_control, " ");
    match line.char_indices().nth(4 * EXCERPT) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}
