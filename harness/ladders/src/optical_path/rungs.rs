//! The rungs of the ladder of optical paths, and their measures.

use crate::options::Options;

/// The ladder's name.
pub(super) const NAME: &str = "optical_path";
/// The rungs: no path through the body, the paper's solver, stencils on growing grids with two
/// solvers, the Eikonal equation, and random walks.
pub const RUNGS: [&str; 22] = [
    LAMBERT,
    LAMBERT_SHADOWED,
    "paper-64",
    "ping-pong-6-64",
    "ping-pong-18-64",
    "ping-pong-26-16",
    "ping-pong-26-32",
    "ping-pong-26-64",
    "ping-pong-26-128",
    "tiled-6-64",
    "tiled-18-64",
    "tiled-26-16",
    "tiled-26-32",
    "tiled-26-64",
    "tiled-26-128",
    "tiled-26-256",
    "godunov-16",
    "godunov-32",
    "godunov-64",
    "godunov-128",
    FINEST,
    REFERENCE,
];
/// The baseline without paths through the body.
pub(super) const LAMBERT: &str = "lambert";
/// The same baseline with cast shadows: what one would use without optical paths, and therefore
/// what they are compared with.
pub(super) const LAMBERT_SHADOWED: &str = "lambert-shadowed";
/// The paper's own form: its solver with the full extinction.
pub(super) const UNSCALED: &str = "paper-64-unscaled";
/// The rung that serves as the converged costs of a body without a closed form.
pub(super) const FINEST: &str = "godunov-256";
/// Random walks.
pub(super) const REFERENCE: &str = "reference";
/// The default rung of a scene.
pub(super) const USUAL: &str = "godunov-64";
/// The solvers whose time is measured from the coarsest grid to the finest.
pub(super) const GROWING: [&str; 3] = ["ping-pong-26", "tiled-26", "godunov"];
/// Voxels along an edge of those grids.
pub(super) const CELLS: [u32; 5] = [16, 32, 64, 128, 256];

/// The measures of a row: the RMS error of the cost in nats, that of the luminance, and the distance
/// from random walks.
pub const MEASURES: [&str; 3] = ["nats", "luminance", "walks"];
/// The measure that is the median time of the frame in white, with one extinction for all channels.
pub(super) const GREY: &str = "grey";
/// The measure that is the median time of the frame in the view's own colours.
pub(super) const RGB: &str = "rgb";
/// The view whose stages are timed separately, in white.
pub(super) const STAGED: &str = "bunny";

/// Returns what to measure by default; slow rungs have fewer rounds.
pub fn options() -> Options {
    Options { rounds: 5, frame: [512, 512], rungs: RUNGS.iter().filter_map(|name| name.parse().ok()).collect() }
}
