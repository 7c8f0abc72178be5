//! Property tests of WGSL functions on a GPU: any function is reflected and run as a compute kernel, compared with a function in Rust over random,
//! hard and shrunk inputs, under a tolerance in ulp, absolute, relative or backward error.

pub mod accuracy_line;
pub mod dispatch;
pub mod draws;
pub mod extremum;
pub mod formula;
pub mod golden_section;
pub mod interpreter;
pub mod literal;
pub mod mutation;
pub mod outside;
pub mod property;
pub mod tokens;
pub mod tolerance;
