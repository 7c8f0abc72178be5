//! Tests of the repository: its structure, contract, pages and examples.

mod contract;
mod defects;
mod engines;
mod host;
mod languages;
mod structure;
mod structure_files;
mod technique;
mod text;
