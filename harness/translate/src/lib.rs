//! WGSL in other shading languages, as text to paste or to compile.
//!
//! [`library`] translates functions, structs and consts without an entry point, such as a module of
//! the cookbook: every name and comment is kept, and what naga adds for the language gets the text's
//! own prefix, so that several such texts can stand in one file. [`shader`] translates a whole shader,
//! and tells in its first comment where each binding is found. naga's writers do the translation
//! itself.

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod bindings;
pub mod declarations;
pub mod fitted;
mod hlsl;
pub mod indentation;
mod items;
mod library;
mod names;
mod overrides;
mod settled;
mod shader;

pub use bindings::{Bound, Kind as BindingKind, bindings};
pub use library::library;
pub use shader::{shader, spirv};

use naga::back::{self, glsl, msl};
use std::fmt;

/// A language that holds text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// GLSL 4.50, of OpenGL and Vulkan.
    Glsl,
    /// GLSL ES 3.00, of WebGL 2 and OpenGL ES 3.
    GlslEs,
    /// HLSL, shader model 5.1 and later.
    Hlsl,
    /// The Metal Shading Language 2.0 and later.
    Msl,
}

impl Language {
    /// All languages.
    pub const ALL: [Self; 4] = [Self::Glsl, Self::GlslEs, Self::Hlsl, Self::Msl];

    /// Returns the name as it is written.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Glsl => "GLSL 4.50",
            Self::GlslEs => "GLSL ES 3.00",
            Self::Hlsl => "HLSL, shader model 5.1",
            Self::Msl => "Metal Shading Language 2.0",
        }
    }

    /// Returns the extension of a file.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Glsl | Self::GlslEs => "glsl",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
        }
    }

    /// Whether it is a GLSL, whose texts hold one entry point, and no sampler apart from a texture.
    #[must_use]
    pub const fn is_glsl(self) -> bool {
        matches!(self, Self::Glsl | Self::GlslEs)
    }

    fn glsl_version(self) -> Option<glsl::Version> {
        match self {
            Self::Glsl => Some(glsl::Version::Desktop(450)),
            Self::GlslEs => Some(glsl::Version::Embedded { version: 300, is_webgl: true }),
            Self::Hlsl | Self::Msl => None,
        }
    }
}

impl fmt::Display for Language {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title())
    }
}

/// Why a text could not be translated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TranslateError {
    /// The source is not valid WGSL.
    #[error("{0}")]
    Source(#[from] lapidary_specialise::SourceError),
    /// The text has no entry point of this name.
    #[error("`{name}` has no entry point `{entry}`; there are {found}")]
    NoEntryPoint {
        /// The text.
        name: String,
        /// The entry point that was asked for.
        entry: String,
        /// The ones that exist.
        found: String,
    },
    /// The language's texts hold one entry point.
    #[error("{language} holds one entry point; name one of {found}")]
    WhichEntryPoint {
        /// The language.
        language: &'static str,
        /// The ones that exist.
        found: String,
    },
    /// The text declares nothing of this name.
    #[error("no {what} `{name}`; there {}", if known.is_empty() { "is none".to_owned() } else { format!("are {}", known.join(", ")) })]
    NoSuch {
        /// "override" or "binding".
        what: &'static str,
        /// The name that was asked for.
        name: String,
        /// The ones that exist.
        known: Vec<String>,
    },
    /// A value does not fit its override, or a binding cannot be private.
    #[error("{0}")]
    Fit(String),
    /// The language lacks something.
    #[error("{language} cannot say what `{what}` needs: {why}")]
    Lacks {
        /// The language.
        language: &'static str,
        /// The function or binding.
        what: String,
        /// What is missing.
        why: String,
    },
}

/// What naga's writers need to know of a shader's entry points and bindings.
struct Setting {
    entry: Option<(String, naga::ShaderStage)>,
    hlsl: back::hlsl::Options,
    msl: msl::Options,
    glsl: glsl::BindingMap,
    glsl_flags: glsl::WriterFlags,
}

impl Setting {
    /// Returns options with which a missing binding is an error, and clip space stays as it is.
    fn strict(entry: Option<(String, naga::ShaderStage)>, glsl_flags: glsl::WriterFlags) -> Self {
        Self {
            entry,
            hlsl: back::hlsl::Options { fake_missing_bindings: false, ..back::hlsl::Options::default() },
            // Instances have numbers from version 1.2 on.
            msl: msl::Options { lang_version: (2, 0), fake_missing_bindings: false, ..msl::Options::default() },
            glsl: glsl::BindingMap::default(),
            glsl_flags,
        }
    }
}

/// Translates a module by naga's writer; an error holds the writer's own message.
fn written(
    module: &naga::Module,
    info: &naga::valid::ModuleInfo,
    language: Language,
    setting: &Setting,
) -> Result<(String, Option<glsl::ReflectionInfo>), String> {
    let mut text = String::new();
    if let Some(version) = language.glsl_version() {
        let Some((entry_point, shader_stage)) = setting.entry.clone() else {
            return Err("GLSL needs an entry point".to_owned());
        };
        let options = glsl::Options {
            version,
            writer_flags: setting.glsl_flags,
            binding_map: setting.glsl.clone(),
            zero_initialize_workgroup_memory: true,
        };
        let pipeline = glsl::PipelineOptions { shader_stage, entry_point, multiview: None };
        let policies = naga::proc::BoundsCheckPolicies::default();
        let found = glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies)
            .and_then(|mut writer| writer.write())
            .map_err(|error| error.to_string())?;
        return Ok((text, Some(found)));
    }
    match language {
        Language::Hlsl => {
            let pipeline = back::hlsl::PipelineOptions::default();
            let mut writer = back::hlsl::Writer::new(&mut text, &setting.hlsl, &pipeline);
            let found = writer.write(module, info, None).map_err(|error| error.to_string())?;
            if let Some(error) = found.entry_point_names.into_iter().find_map(Result::err) {
                return Err(error.to_string());
            }
        }
        _ => {
            let (written, found) = msl::write_string(module, info, &setting.msl, &msl::PipelineOptions::default())
                .map_err(|error| error.to_string())?;
            if let Some(error) = found.entry_point_names.into_iter().find_map(Result::err) {
                return Err(error.to_string());
            }
            text = written;
        }
    }
    Ok((text, None))
}
