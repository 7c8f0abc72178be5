//! The cookbook's WGSL as constants, for the harness and for Rust engines: add this crate, paste `source` into your
//! shader text.

/// A technique: pure functions, no bindings, no entry points.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    /// The technique's name, which prefixes every name in `source`.
    pub name: &'static str,
    /// WGSL, valid by itself.
    pub source: &'static str,
    /// Its doc page in Markdown.
    pub page: &'static str,
}

/// A complete shader, to be pasted after the modules that its `// requires:` line names and the parts that its `// parts:`
/// line names.
#[derive(Clone, Copy, Debug)]
pub struct Recipe {
    /// The recipe's name.
    pub name: &'static str,
    /// WGSL with entry points and bindings.
    pub source: &'static str,
}

/// What several recipes share: overrides, bindings and functions that belong to none of the modules. Not valid by itself.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The part's name.
    pub name: &'static str,
    /// WGSL without entry points.
    pub source: &'static str,
}

macro_rules! modules {
    ($($name:literal),* $(,)?) => {
        &[$(Module {
            name: $name,
            source: include_str!(concat!($name, ".wgsl")),
            page: include_str!(concat!("../docs/", $name, ".md")),
        }),*]
    };
}

macro_rules! recipes {
    ($($name:literal),* $(,)?) => {
        &[$(Recipe { name: $name, source: include_str!(concat!("recipes/", $name, ".wgsl")) }),*]
    };
}

macro_rules! parts {
    ($($name:literal),* $(,)?) => {
        &[$(Part { name: $name, source: include_str!(concat!("recipes/parts/", $name, ".wgsl")) }),*]
    };
}

/// Every module, in the order of their names.
pub const MODULES: &[Module] = modules![
    "absorption",
    "bvh_trace",
    "cdrf",
    "closest_point",
    "convex_trace",
    "curvature",
    "dispersion",
    "environment",
    "fresnel",
    "microfacet",
    "optical_path",
    "proxy_geometry",
    "random_walk",
    "reflective_shadow_map",
    "refraction",
    "srgb",
    "texture_diffusion",
    "veins",
    "voxelization"
];

/// Every recipe, in the order of their names.
pub const RECIPES: &[Recipe] = recipes![
    "cdrf_shading",
    "cdrf_table",
    "display",
    "gem",
    "gem_bvh",
    "gem_composite",
    "gem_convex",
    "optical_path_density",
    "optical_path_seed",
    "optical_path_shading",
    "optical_path_sweep",
    "optical_path_tiles",
    "random_walk_slab",
    "reflective_shadow_map",
    "texture_diffusion",
    "texture_irradiance",
    "trace",
    "voxelization"
];

/// The hashes of each release's functions, the oldest first, as JSON.
pub const RELEASES: &[&str] = &[include_str!("releases/0.1.0.json"), include_str!("releases/0.2.0.json")];

/// What changed from release to release, by function.
pub const CHANGELOG: &str = include_str!("../CHANGELOG.md");

/// Every part, in the order of their names.
pub const PARTS: &[Part] = parts![
    "gem_shading",
    "harmonics",
    "light_views",
    "lights",
    "matter",
    "mesh",
    "mesh_normals",
    "optical_path_grid",
    "reflection",
    "shadow",
    "surroundings",
    "trace_nearest"
];
