//! What is wrong with a glTF file.

use thiserror::Error;

use super::{KNOWN_EXTENSIONS, MAX_COORDINATE, MAX_OBJECTS, MAX_SCENE_BYTES, MAX_TRIANGLES};

/// What is wrong with a glTF file, in one line. Numbers count from 0, as in the file itself.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GltfError {
    /// The file, or a buffer beside it, cannot be read.
    #[error("{what} cannot be read: {reason}; check that it exists and may be read")]
    Unreadable {
        /// `the file`, or which buffer and its file.
        what: String,
        /// The operating system's reason.
        reason: String,
    },
    /// More bytes than the loader reads.
    #[error("{what} has {bytes} bytes, but at most {limit} are read; decimate or split it")]
    TooLarge {
        /// The file, or its buffers.
        what: String,
        /// How many bytes.
        bytes: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// Neither kind of glTF.
    #[error("this is not glTF: it starts neither as a .glb nor as JSON; give a glTF 2.0 file")]
    NotGltf,
    /// A .glb whose parts do not fit.
    #[error("this .glb is damaged: {problem}; export or download it again")]
    Container {
        /// What does not fit.
        problem: String,
    },
    /// Another version of glTF.
    #[error(
        "this is glTF version {version}, but only 2.x is read; export it as glTF 2.0, or convert it (`gltf-pipeline` does)"
    )]
    Version {
        /// What the file asks for.
        version: String,
    },
    /// The JSON is not JSON, or not glTF's.
    #[error("its JSON is not valid glTF: {message}; export it again")]
    Json {
        /// The parser's words, with line and column.
        message: String,
    },
    /// The file cannot be shown without extensions that we do not know.
    #[error(
        "it requires extensions that are not supported: {extensions}; export it without them \
         (supported are {})",
        KNOWN_EXTENSIONS.join(", ")
    )]
    RequiredExtensions {
        /// Their names.
        extensions: String,
    },
    /// Meshes whose numbers are compressed.
    #[error(
        "its meshes are compressed by {extension}, which is not read; export it without compression, or unpack it (`gltf-transform copy \
         in.glb out.glb` does)"
    )]
    Compressed {
        /// The extension.
        extension: String,
    },
    /// A reference to something that is not in the file.
    #[error("{from} refers to {what} {index}, but the file has {count}; export it again")]
    Dangling {
        /// Who refers.
        from: String,
        /// What kind of thing is missing.
        what: &'static str,
        /// Its number.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A part of the file breaks a rule of glTF or needs what is not supported.
    #[error("{part}: {problem}")]
    Part {
        /// Which part, such as `accessor 3` or `material 0 "glass"`.
        part: String,
        /// What is wrong and what to do.
        problem: String,
    },
    /// A position that is not a number, infinite, or too far out, where its node puts it.
    #[error(
        "{primitive}: vertex {vertex} lies at ({}, {}, {}), but coordinates must be finite and at most \
         {MAX_COORDINATE:e}; mend or remove the vertex",
        position[0], position[1], position[2]
    )]
    Position {
        /// Which primitive.
        primitive: String,
        /// Which of its vertices.
        vertex: usize,
        /// Where the vertex lies in the world.
        position: [f32; 3],
    },
    /// A triangle of a vertex that does not exist.
    #[error("{primitive}: index {place} is {index}, but it has {vertices} vertices; export it again")]
    IndexOutOfRange {
        /// Which primitive.
        primitive: String,
        /// The place in its list of indices.
        place: usize,
        /// The index found there.
        index: u32,
        /// How many vertices there are.
        vertices: u64,
    },
    /// Nothing to show.
    #[error("its scene shows no triangles; put a mesh of triangles into the scene")]
    NoTriangles,
    /// Too much to show.
    #[error(
        "its scene shows more than {MAX_TRIANGLES} triangles or three times as many vertices, each \
         instance counted; decimate it or show fewer instances"
    )]
    TooManyTriangles,
    /// Bodies that take more memory than is given to a scene.
    #[error(
        "its scene takes more than {} MiB of memory, each instance counted; decimate its meshes or show fewer instances",
        MAX_SCENE_BYTES >> 20
    )]
    TooMuchMemory,
    /// Very many bodies.
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

/// The item of `list` with number `index`, or an error that names who asked for it.
pub(super) fn item<'a, T>(
    list: &'a [T],
    what: &'static str,
    index: usize,
    from: impl FnOnce() -> String,
) -> Result<&'a T, GltfError> {
    list.get(index).ok_or_else(|| GltfError::Dangling { from: from(), what, index, count: list.len() })
}

/// `mesh 2`, or with its name `mesh 2 "bunny"`.
pub(super) fn designation(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {index} {:?}", excerpt(name)),
        None => format!("{kind} {index}"),
    }
}

/// At most this many characters of a text from a file go into a message or a scene: a name may be as
/// long as the file, and an instance of its mesh cost a few bytes.
const EXCERPT: usize = 64;

/// The beginning of `text`, without control characters.
pub(super) fn excerpt(text: &str) -> String {
    let mut rest = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut short: String = rest.by_ref().take(EXCERPT).collect();
    if rest.next().is_some() {
        short.push('…');
    }
    short
}

/// A list on one line, cut to a length that a terminal can show.
pub(super) fn shortened(list: impl IntoIterator<Item = String>) -> String {
    let list: Vec<String> = list.into_iter().take(EXCERPT).collect();
    let line = list.join(", ").replace(char::is_control, " ");
    match line.char_indices().nth(4 * EXCERPT) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}
