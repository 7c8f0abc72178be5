//! `cook dist`: the modules and recipes in every language, as files to take along.

pub mod command;
mod error;
pub mod npm;
mod whole;

pub use error::DistError;
pub use whole::Whole;

use lapidary_cookbook::modules;
use lapidary_files::folder::{self, FolderError, Owner};
use lapidary_translate::{Language, library, shader, spirv};
use lapidary_wgsl::RECIPES;
use naga::ShaderStage;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Whose folder it is.
const OWNER: Owner = Owner { command: "cook dist", marker: ".lapidary-dist" };

/// The manifest of the WESL package.
const WESL: &str = "\
[package]
edition = \"unstable_2025\"
root = \"./shaders\"
";

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Path of the folder.
    pub folder: PathBuf,
    /// Number of files, besides the list of them.
    pub files: usize,
}

/// Writes every module and every recipe in every language into the folder `out`, which is either
/// complete or unchanged. The same cookbook gives the same bytes.
///
/// # Errors
/// Returns an error if the file system fails, or if `out` contains anything that an earlier call did
/// not write.
pub fn write(out: &Path) -> Result<Written, DistError> {
    let recipes = RECIPES.iter().map(Whole::of).collect::<Result<Vec<_>, _>>()?;
    let mut files = texts(&recipes)?;
    files.extend(npm::files(&recipes)?.into_iter().map(|(name, bytes)| (format!("npm/{name}"), bytes)));
    files.push(("README.md".to_owned(), readme(&files).into_bytes()));
    for (name, text) in [
        ("LICENSE-MIT-0", include_str!("../../../../LICENSE-MIT-0")),
        ("LICENSE-APACHE", include_str!("../../../../LICENSE-APACHE")),
    ] {
        for folder in ["", "npm/"] {
            files.push((format!("{folder}{name}"), text.as_bytes().to_vec()));
        }
    }
    let folder = folder::replace(out, OWNER, |folder| -> Result<(), DistError> {
        for (name, bytes) in &files {
            let path = folder.join(name);
            let failed = |source: io::Error| FolderError::Write { path: path.clone(), source };
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent).map_err(failed)?;
            }
            fs::write(&path, bytes).map_err(failed)?;
        }
        Ok(())
    })?;
    Ok(Written { folder, files: files.len() })
}

/// Name of a language's folder, as `cook copy --to` has it.
#[must_use]
pub const fn folder_of(language: Language) -> &'static str {
    match language {
        Language::Glsl => "glsl",
        Language::GlslEs => "glsl-es",
        Language::Hlsl => "hlsl",
        Language::Msl => "msl",
    }
}

/// Returns the extension of an entry point's file, as glslang has it.
const fn extension_of(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vert",
        ShaderStage::Compute => "comp",
        _ => "frag",
    }
}

/// Returns every text with its path.
fn texts(recipes: &[Whole]) -> Result<Vec<(String, Vec<u8>)>, DistError> {
    let mut files = Vec::new();
    files.push(("wesl/wesl.toml".to_owned(), WESL.as_bytes().to_vec()));
    for module in modules() {
        for path in [format!("wgsl/{}.wgsl", module.name), format!("wesl/shaders/{}.wesl", module.name)] {
            files.push((path, module.source.as_bytes().to_vec()));
        }
        for language in Language::ALL {
            let path = format!("{}/{}.{}", folder_of(language), module.name, language.extension());
            files.push((path, library(module.source, module.name, language)?.into_bytes()));
        }
    }
    for Whole { recipe, source, ir, glsl_es } in recipes {
        let name = recipe.name;
        files.push((format!("wgsl/recipes/{name}.wgsl"), source.as_bytes().to_vec()));
        for language in [Language::Hlsl, Language::Msl] {
            let path = format!("{}/recipes/{name}.{}", folder_of(language), language.extension());
            files.push((path, shader(source, name, language, None)?.into_bytes()));
        }
        for point in &ir.entry_points {
            let path = format!("glsl/recipes/{name}.{}.{}", point.name, extension_of(point.stage));
            files.push((path, shader(source, name, Language::Glsl, Some(&point.name))?.into_bytes()));
        }
        for (entry, stage, text) in glsl_es {
            let path = format!("glsl-es/recipes/{name}.{entry}.{}", extension_of(*stage));
            files.push((path, text.as_bytes().to_vec()));
        }
        let binary = spirv(ir).map_err(|message| DistError::Recipe { recipe: name, message })?;
        files.push((format!("spirv/recipes/{name}.spv"), binary));
    }
    Ok(files)
}

/// Returns the index of the files.
fn readme(files: &[(String, Vec<u8>)]) -> String {
    let mut text = "\
# Lapidary, as text

Every module and every recipe of the cookbook in each language, written by `cook dist`. A module is
functions, structs and constants to paste or include, with its promises in its comments; texts of several
modules stand in one file. A recipe is a whole shader; its first comment tells where its bindings are, and
what was set. Clip space is WebGPU's everywhere: y up, depth from 0 to 1.

- `wgsl`: the sources
- `glsl`: GLSL 4.50; `glsl-es`: GLSL ES 3.00, of WebGL 2
- `hlsl`: HLSL, shader model 5.1 and later
- `msl`: the Metal Shading Language 2.0
- `npm`: a package with the WGSL and the GLSL ES as strings, recipes with their bindings and layouts, and what
  runs a frame; `npm pack` makes it
- `wesl`: a package of the modules for WESL: `import lapidary::refraction::refraction_refract;`
- `spirv`: recipes alone; sets and bindings are WGSL's groups and bindings

"
    .to_owned();
    text.push_str("| module | what it computes |\n|---|---|\n");
    for module in modules() {
        text.push_str(&format!("| {} | {} |\n", module.name, module.header.purpose.trim_end_matches('.')));
    }
    text.push_str("\n| recipe | entry points in GLSL ES 3.00 |\n|---|---|\n");
    for recipe in RECIPES {
        let start = format!("glsl-es/recipes/{}.", recipe.name);
        let found = files.iter().filter_map(|(name, _)| name.strip_prefix(&start)?.rsplit_once('.'));
        let found: Vec<&str> = found.map(|(entry, _)| entry).collect();
        let found =
            if found.is_empty() { "none: it needs storage buffers or compute".to_owned() } else { found.join(", ") };
        text.push_str(&format!("| {} | {found} |\n", recipe.name));
    }
    text.push_str("\nLicence: MIT-0 or Apache-2.0, at your choice.\n");
    text
}
