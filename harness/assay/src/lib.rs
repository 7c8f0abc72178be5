//! Property tests of WGSL functions and kernels on a GPU, in a plain `cargo test`. Any function is
//! reflected, run as a compute kernel and compared with a Rust function on random, hard and shrunk
//! inputs, within a tolerance in ulp, absolute, relative or backward error.
//!
//! A function: [`wgsl`] → `mirror` → optional `oracle` → `inputs` or `draws` → [settings](Test) →
//! [`run`](Test::run) or [`mutate`](Test::mutate).
//!
//! ```no_run
//! use lapidary_assay::{Outcome, wgsl};
//!
//! const FADE: &str = "fn fade(t: f32) -> f32 { return t * t * (3.0 - 2.0 * t); }";
//!
//! # #[cfg(feature = "gpu")]
//! fn fades() -> Outcome {
//!     wgsl(FADE, "fade")
//!         .mirror(|t: f32| t * t * (3.0 - 2.0 * t))
//!         .draws(|draws| (draws.between(0.0, 1.0),))
//!         .edge("near an end", |(t,)| t < 0.001)
//!         .within("4 ulp")
//!         .run()
//! }
//! ```
//!
//! A compute entry point, compared buffer by buffer: [`kernel`] → optional `constant` → `mirror` →
//! `inputs` or `draws` → [settings](KernelTest) → [`run`](KernelTest::run).
//!
//! ```no_run
//! use lapidary_assay::{Outcome, kernel};
//!
//! const DOUBLE: &str = "
//! @group(0) @binding(0) var<storage, read_write> values: array<f32>;
//! @compute @workgroup_size(64)
//! fn double(@builtin(global_invocation_id) id: vec3u) {
//!     if (id.x < arrayLength(&values)) { values[id.x] *= 2.0; }
//! }";
//!
//! # #[cfg(feature = "gpu")]
//! fn doubles() -> Outcome {
//!     kernel(DOUBLE, "double")
//!         .mirror(|(values,): &mut (Vec<f32>,)| values.iter_mut().for_each(|value| *value *= 2.0))
//!         .draws(|draws| ((0..=draws.below(200)).map(|_| draws.between(-1.0, 1.0)).collect(),))
//!         .workgroups(|(values,)| [values.len().div_ceil(64) as u32, 1, 1])
//!         .run()
//! }
//! ```
//!
//! Without the feature `gpu`, only the parts that need no device remain: random inputs ([`draws`]),
//! shapes, values and tolerances; with `reflect` alone also signatures, and kernels as text.

pub mod accuracy_line;
#[cfg(feature = "reflect")]
pub mod dispatch;
pub mod draws;
#[cfg(feature = "gpu")]
pub mod environment;
#[cfg(feature = "gpu")]
pub mod examination;
pub mod extremum;
#[cfg(feature = "gpu")]
pub mod failure;
pub mod formula;
pub mod golden_section;
#[cfg(feature = "gpu")]
pub mod interpreter;
#[cfg(feature = "gpu")]
mod kernel;
pub mod literal;
#[cfg(feature = "gpu")]
pub mod mutate;
mod near;
mod order;
pub mod outside;
#[cfg(feature = "gpu")]
pub mod property;
#[cfg(feature = "gpu")]
pub mod runner;
pub mod shape;
#[cfg(feature = "gpu")]
pub mod slack;
#[cfg(feature = "reflect")]
pub mod tokens;
pub mod tolerance;
pub mod value;
#[cfg(feature = "gpu")]
mod wgsl;

#[cfg(feature = "gpu")]
pub use environment::{SEED_VARIABLE, WITHOUT_ADAPTER_VARIABLE};
#[cfg(feature = "gpu")]
pub use kernel::{Buffer, Buffers, KernelMirror, KernelSource, KernelTest, Type, kernel};
#[cfg(feature = "gpu")]
pub use wgsl::{Failure, Mirrored, Outcome, Source, Test, wgsl};
