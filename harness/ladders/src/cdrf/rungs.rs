//! The rungs of the ladder of reflectances, their views and measures.

use crate::options::Options;
use lapidary_plan::Rung;
use lapidary_scene::solver::Reflectance;

/// The ladder's name.
pub(super) const NAME: &str = "cdrf";
/// The rungs: no technique, the cheapest, tables, closed forms, the definition, another function,
/// and the blur that the others replace.
pub const RUNGS: [&str; 10] =
    [LAMBERT, "wrap", PAPER, "table-257-rgba16f", "table-257-r32f", "cheap", "accurate", "quadrature", SPHERICAL, BLUR];
/// The baseline that costs are compared with.
pub(super) const LAMBERT: &str = "lambert";
/// The paper's rung.
pub(super) const PAPER: &str = "table-256-rgba8";
/// The rung that approximates a different function from the others and is compared with its own
/// definition.
pub const SPHERICAL: &str = "spherical";
/// The blur in texture space, which the technique replaces.
pub(super) const BLUR: &str = "blur";
/// The rungs without a table that approximate the convolution.
pub(super) const ANALYTIC: [&str; 3] = ["cheap", "accurate", "quadrature"];

/// The views: the lit part alone and a whole frame, each with curvature from screen-space
/// derivatives and from vertices.
pub const VIEWS: [&str; 4] = [SCREEN, "lit+vertex", "whole+screen", "whole+vertex"];
/// The view by which errors are looked up, which are those of a function and equal in all views.
pub const SCREEN: &str = "lit+screen";
/// The measures of a row: the largest and the RMS distance from the convolution, and the residuals
/// against random walks through spheres with a free and with a fixed scale.
pub const MEASURES: [&str; 4] = ["largest", "rms", "scale free", "scale fixed"];
/// The view of lookup tables, whose errors alone are measured.
pub const TABLE: &str = "lookup table";
/// The view of the spherical form compared with the others' definition.
pub const CIRCULAR: &str = "circular";

/// Returns what to measure by default.
pub fn options() -> Options<Reflectance> {
    let rung = |name: &&str| if let Ok(Rung::Diffuse(rung)) = name.parse() { Some(rung) } else { None };
    Options { rounds: 7, frame: [1920, 1080], rungs: RUNGS.iter().filter_map(rung).collect() }
}
