//! The Lapidary cookbook's command line, `cook`: it hands out WGSL, checks every function against its mirror and its f64
//! oracle, plans and renders scenes, and compares pictures. As a library it serves the project's other tools.

pub mod check;
pub mod command;
pub mod compare;
pub mod formulas;
