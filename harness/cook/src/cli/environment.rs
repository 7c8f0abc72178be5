//! `--environment`: a built-in environment by its name, or an image.

use super::Failure;
use clap::builder::{OsStringValueParser, TypedValueParser};
use lapidary_files::nearest;
use lapidary_plan::Note;
use lapidary_scene::environment_map::{Clamped, EnvironmentMap};
use lapidary_scene::{BuiltInEnvironment, Environment};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Light from far away, as it is asked for.
#[derive(Clone)]
pub(super) enum EnvironmentAsked {
    BuiltIn(BuiltInEnvironment),
    File(Arc<ImageFile>),
}

/// An image, which is read once however often it is asked for.
pub(super) struct ImageFile {
    path: PathBuf,
    read: OnceLock<(EnvironmentMap, Clamped)>,
}

impl EnvironmentAsked {
    /// The parser of the option: a path need not be Unicode.
    pub(super) fn parser() -> impl TypedValueParser<Value = Self> {
        OsStringValueParser::new().try_map(Self::parse)
    }

    /// Reads what a user types. A name is no file, whatever the folder holds: `./jeweller` is one.
    fn parse(asked: OsString) -> Result<Self, String> {
        if let Some(environment) = BuiltInEnvironment::ALL.into_iter().find(|one| asked == one.name()) {
            return Ok(Self::BuiltIn(environment));
        }
        let text = asked.to_string_lossy();
        if !text.contains(['/', '\\', '.']) && !Path::new(&asked).exists() {
            let known = BuiltInEnvironment::ALL.map(BuiltInEnvironment::name);
            return Err(format!(
                "no environment has this name, and no file is there{}",
                nearest::suggest(&text, &known)
            ));
        }
        Ok(Self::File(Arc::new(ImageFile { path: asked.into(), read: OnceLock::new() })))
    }

    /// Returns the file that is read.
    pub(super) fn file(&self) -> Option<&Path> {
        match self {
            Self::BuiltIn(_) => None,
            Self::File(file) => Some(&file.path),
        }
    }

    /// Makes or reads the environment; with a note if radiance in the file is negative.
    pub(super) fn make(&self) -> Result<(Environment, Option<Note>), Failure> {
        let ImageFile { path, read } = match self {
            Self::BuiltIn(environment) => return Ok((environment.make(), None)),
            Self::File(file) => &**file,
        };
        let (map, Clamped { pixels, least }) = match read.get() {
            Some(read) => read,
            None => {
                let loaded = EnvironmentMap::load_counting(path)?;
                read.get_or_init(|| loaded)
            }
        };
        let file = || path.display().to_string();
        let note = (*pixels > 0).then(|| Note::NegativeRadiance { file: file(), pixels: *pixels, least: *least });
        Ok((Environment::Map(map.clone()), note))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_name_a_path_a_path_and_anything_else_is_refused() {
        let file = |text: &str| EnvironmentAsked::parse(text.into()).expect("known").file().map(Path::to_path_buf);
        assert_eq!(file("jeweller"), None);
        for path in ["./jeweller", "jeweller.hdr", "a/b", "Cargo.toml"] {
            assert_eq!(file(path), Some(PathBuf::from(path)));
        }
        let refused = |text: &str| EnvironmentAsked::parse(text.into()).err().unwrap_or_default();
        assert!(refused("jeweler").ends_with("; did you mean `jeweller`?"), "{}", refused("jeweler"));
        assert!(refused("zzz").ends_with("; there are studio, jeweller"), "{}", refused("zzz"));
    }
}
