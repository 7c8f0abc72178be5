//! `wgsl/optical_path.wgsl`.
use crate::formula::Formula;
pub(super) fn formulas() -> Vec<Formula> {
    vec![]
}
