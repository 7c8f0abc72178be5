//! The harness of the Lapidary cookbook: it runs every WGSL function on a GPU, tests it against its Rust mirror and
//! its f64 oracle, renders the recipes and builds the gallery. `cook` is its command line.

pub mod cdrf;
pub mod check;
pub mod compute;
pub mod cookbook;
pub mod cost;
pub mod dispatch;
pub mod extremum;
pub mod formula;
pub mod formulas;
pub mod gallery;
pub mod golden_section;
pub mod gpu;
pub mod interpreter;
pub mod mutation;
pub mod nearest;
pub mod optical_path;
pub mod outside;
pub mod pixel;
pub mod plan;
pub mod property;
pub mod random_walk;
pub mod reference;
pub mod render;
pub mod scene;
pub mod shader;
pub mod snapshot;
pub mod specialise;
pub mod spirv_counts;
pub mod text_file;
pub mod tokens;
pub mod voxel_grid;
pub mod voxelization;
