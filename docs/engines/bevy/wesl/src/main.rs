//! Compiles gem_material.wesl with the recipe that `cook copy` wrote and the package that `cook dist`
//! wrote, and validates what comes out. Bevy 0.20 needs a newer Rust, so what the stages import of it
//! is declared here.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::borrow::Cow;
use std::path::Path;
use std::process::ExitCode;
use wesl::syntax::PathOrigin;
use wesl::{Feature, ModulePath, ResolveError, Resolver, Wesl};

const STAGES: &str = include_str!("../gem_material.wesl");

/// What the stages import of Bevy: names, types and signatures of bevy_pbr 0.20.1.
const BEVY: [(&str, &str); 4] = [
    (
        "mesh_bindings",
        "struct Mesh { world_from_local: mat3x4<f32> }
         @group(2) @binding(0) var<storage> mesh: array<Mesh>;",
    ),
    (
        "mesh_functions",
        "import package::render::mesh_bindings::mesh;
         fn get_world_from_local(instance: u32) -> mat4x4<f32> {
             let rows = mesh[instance].world_from_local;
             return transpose(mat4x4<f32>(rows[0], rows[1], rows[2], vec4<f32>(0.0, 0.0, 0.0, 1.0)));
         }
         fn mesh_position_local_to_world(world_from_local: mat4x4<f32>, position: vec4<f32>) -> vec4<f32> {
             return world_from_local * position;
         }",
    ),
    (
        "mesh_view_bindings",
        "struct View { clip_from_world: mat4x4<f32>, world_position: vec3<f32> }
         @group(0) @binding(0) var<uniform> view: View;",
    ),
    (
        "view_transformations",
        "import package::render::mesh_view_bindings::view;
         fn position_world_to_clip(position: vec3<f32>) -> vec4<f32> {
             return view.clip_from_world * vec4<f32>(position, 1.0);
         }",
    ),
];

/// Finds modules where Bevy's asset server would.
struct Modules<'a> {
    /// `wesl/shaders` of `cook dist`.
    package: &'a Path,
    /// The recipe of `cook copy`.
    recipe: &'a Path,
}

impl Resolver for Modules<'_> {
    fn resolve_source<'a>(&'a self, path: &ModulePath) -> Result<Cow<'a, str>, ResolveError> {
        let missing = |reason: String| ResolveError::ModuleNotFound(path.clone(), reason);
        let read = |file: &Path| {
            std::fs::read_to_string(file).map_err(|error| missing(format!("{}: {error}", file.display())))
        };
        let package = match &path.origin {
            PathOrigin::Package(name) => name.as_str(),
            _ => "",
        };
        let names: Vec<&str> = path.components.iter().map(String::as_str).collect();
        match (package, &names[..]) {
            // Bevy makes this module of a pipeline's shader definitions.
            ("constants", []) => Ok("const MATERIAL_BIND_GROUP = 3u;".into()),
            ("lapidary", [module]) => Ok(read(&self.package.join(format!("{module}.wesl")))?.into()),
            ("bevy_pbr", ["render", module]) => {
                let found = BEVY.iter().find(|(name, _)| name == module);
                found.map(|(_, source)| (*source).into()).ok_or_else(|| missing("not declared here".to_owned()))
            }
            ("", ["gem_material"]) => Ok(STAGES.into()),
            ("", ["gem_walk"]) => Ok(read(self.recipe)?.into()),
            _ => Err(missing("no such module".to_owned())),
        }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [package, recipe] = &arguments[..] else {
        eprintln!("Usage: lapidary-in-wesl DIST/wesl/shaders gem_walk.wesl");
        return ExitCode::from(2);
    };
    for tone in [false, true] {
        match lines(Path::new(package), Path::new(recipe), tone) {
            Ok(lines) => println!("gem_material.wesl with TONEMAP_IN_SHADER {tone}: {lines} lines of valid WGSL"),
            Err(error) => {
                eprintln!("lapidary-in-wesl: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// Compiles and validates the stages; returns the number of lines.
fn lines(package: &Path, recipe: &Path, tone: bool) -> Result<usize, String> {
    let mut compiler = Wesl::new("").set_custom_resolver(Modules { package, recipe });
    compiler.set_feature("TONEMAP_IN_SHADER", tone).set_missing_feature_behavior(Feature::Error);
    let stages: ModulePath = "package::gem_material".parse().map_err(|error| format!("{error}"))?;
    let text = compiler.compile(&stages).map_err(|error| error.to_string())?.to_string();
    let module = naga::front::wgsl::parse_str(&text).map_err(|error| error.emit_to_string(&text))?;
    let valid = Validator::new(ValidationFlags::all(), Capabilities::default()).validate(&module);
    valid.map_err(|error| error.emit_to_string(&text))?;
    let stages: Vec<&str> = module.entry_points.iter().map(|point| point.name.as_str()).collect();
    if stages != ["vertex", "fragment"] {
        return Err(format!("entry points are {stages:?}, not vertex and fragment"));
    }
    if text.contains("srgb_tone_curve(") != tone {
        return Err("TONEMAP_IN_SHADER does not decide whether the tone curve is there".to_owned());
    }
    Ok(text.lines().count())
}
