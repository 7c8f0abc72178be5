//! Time by the number of a stone's facets, which a study adds to the ladder's report: how it grows is a goal of the ladder.

use crate::report::Report;

/// The measure of the study's rows.
pub const GROWTH: &str = "growth";

/// Returns the numbers of facets and the milliseconds of a rung's frames.
pub fn grown(report: &Report, rung: &str) -> Vec<(f64, f64)> {
    let facets = |view: &str| view.split(' ').next()?.parse().ok();
    let ms = |view| Some((facets(view)?, report.ms(rung, view, GROWTH)?));
    report.views(GROWTH).into_iter().filter_map(ms).collect()
}

/// Returns the power of the number of facets with which a rung's time grows: the slope of the least
/// squares through the logarithms.
pub fn power_of(report: &Report, rung: &str) -> Option<f64> {
    let points: Vec<(f64, f64)> = grown(report, rung).into_iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = points.len() as f64;
    let [x, y] = [0, 1].map(|part| points.iter().map(|point| [point.0, point.1][part]).sum::<f64>() / count);
    let across = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum::<f64>();
    let along = points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>();
    (points.len() > 2).then_some(across / along)
}
