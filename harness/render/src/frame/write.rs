//! A frame as files for another host: `frame.json`, a WGSL file for each pipeline, and a binary
//! file for the contents of each resource. docs/frame.md defines each field.

use super::document::{contents_file, shader_file};
use super::resource::{Contents, ResourceKind};
use super::whole::Frame;
use std::path::{Path, PathBuf};

/// Reason why a frame could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// A folder that is not empty.
    #[error("{path}: is there and not empty; name a new folder")]
    Taken {
        /// The folder.
        path: PathBuf,
    },
    /// An error of the file system.
    #[error("{path}: cannot be written: {error}")]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        error: std::io::Error,
    },
    /// An error of naga.
    #[error("recipe {recipe} cannot be written as WGSL: {error}")]
    Wgsl {
        /// Name of the recipe.
        recipe: String,
        /// naga's error.
        error: naga::back::wgsl::Error,
    },
    /// A frame made only for inspection.
    #[error("`{resource}` was left out: the frame was made without a device")]
    LeftOut {
        /// Name of the resource.
        resource: String,
    },
}

impl Frame {
    /// Whether the folder is there already, and empty.
    ///
    /// # Errors
    /// If something is in it, or it cannot be read.
    pub fn check_folder(folder: &Path) -> Result<bool, WriteError> {
        match std::fs::read_dir(folder) {
            Ok(mut entries) => match entries.next() {
                Some(_) => Err(WriteError::Taken { path: folder.to_owned() }),
                None => Ok(true),
            },
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(WriteError::File { path: folder.to_owned(), error }),
        }
    }

    /// Writes the frame to a new or empty folder: a new one is complete or absent, in an empty one
    /// `frame.json` comes last.
    ///
    /// # Errors
    /// If the folder is not empty or cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), WriteError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |error| WriteError::File { path, error }
        };
        let is_there = Self::check_folder(folder)?;
        // In an empty folder it is made inside and moved up at the end; otherwise it is made beside
        // its place and moved there whole.
        let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let place = if is_there { folder } else { parent };
        std::fs::create_dir_all(place).map_err(failed(place))?;
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            // The process's umask limits who else may read it.
            builder.permissions(std::fs::Permissions::from_mode(0o777));
        }
        let aside = builder.prefix(".frame-").tempdir_in(place).map_err(failed(folder))?;
        let write = |name: &str, contents: &[u8]| {
            let path = aside.path().join(name);
            std::fs::write(&path, contents).map_err(failed(&folder.join(name)))
        };
        for inner in ["resources", "pipelines"] {
            std::fs::create_dir(aside.path().join(inner)).map_err(failed(&folder.join(inner)))?;
        }
        for (place, resource) in self.resources.iter().enumerate() {
            let (ResourceKind::Buffer { contents, .. } | ResourceKind::Texture { contents, .. }) = &resource.kind
            else {
                continue;
            };
            match contents {
                Contents::Zeros => {}
                Contents::Bytes(bytes) => write(&contents_file(place, resource), bytes)?,
                Contents::LeftOut => return Err(WriteError::LeftOut { resource: resource.name.clone() }),
            }
        }
        for (place, pipeline) in self.pipelines.iter().enumerate() {
            let recipe = || pipeline.shader.recipe().to_owned();
            let text = pipeline.shader.wgsl().map_err(|error| WriteError::Wgsl { recipe: recipe(), error })?;
            write(&shader_file(place, pipeline), text.as_bytes())?;
        }
        let json = serde_json::to_string_pretty(&self.document());
        let json = json.map_err(std::io::Error::from).map_err(failed(&folder.join("frame.json")))?;
        write("frame.json", format!("{json}\n").as_bytes())?;
        if !is_there {
            return std::fs::rename(aside.path(), folder).map_err(failed(folder));
        }
        // frame.json last: where it is, all is.
        ["resources", "pipelines", "frame.json"].into_iter().try_for_each(|name| {
            std::fs::rename(aside.path().join(name), folder.join(name)).map_err(failed(&folder.join(name)))
        })
    }
}
