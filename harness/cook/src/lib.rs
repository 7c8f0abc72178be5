//! The Lapidary cookbook's command line, `cook`: it checks every WGSL function against its mirror
//! and its f64 oracle, measures the ladders, compares the pictures and builds the gallery.

pub mod builtins;
pub mod check;
pub mod compare;
pub mod cookbook;
pub mod cost;
pub mod diagram;
pub mod dist;
pub mod exposure;
pub mod folder;
pub mod formulas;
pub mod gallery;
pub mod host;
pub mod motion;
pub mod repository;
pub mod seed;
pub mod snapshot;
pub mod text_file;
