//! The record of random walks through spheres, which a study makes: what a rung's function is compared with.

use crate::error::CostError;
use crate::report::{Report, Row, distinct};
use lapidary_cookbook::repository;
use lapidary_reference::random_walk::{BINS, Profile};
use std::path::{Path, PathBuf};

/// Name of the study in its report.
pub const NAME: &str = "sphere";
/// Name of the walks themselves, whose measures are exitance and standard error by interval.
pub const WALKS: &str = "random walks";

/// Returns the name of a sphere; an infinite radius is the half space.
pub fn view(albedo: f64, radius: f64) -> String {
    format!("albedo {albedo}, R = {radius}")
}

/// Returns the spheres of a report that have a value for each interval.
pub fn profiles(report: &Report) -> Vec<Profile> {
    let views = distinct(report.rows.iter().filter(|row| row.rung == WALKS).map(|row| row.view.as_str()));
    let values = |view: &str, measure: &str| -> Option<[f64; BINS]> {
        let rows = report.rows.iter().filter(|row| row.rung == WALKS && row.view == view);
        let found: Vec<&Row> = rows.filter(|row| row.measure.starts_with(measure)).collect();
        let value = |bin: usize| found.iter().find(|row| row.measure == format!("{measure} {bin}"))?.value;
        let values: Option<Vec<f64>> = (0..BINS).map(value).collect();
        values?.try_into().ok()
    };
    let profile = |view: &str| {
        let (albedo, radius) = view.strip_prefix("albedo ")?.split_once(", R = ")?;
        let (albedo, radius) = (albedo.parse().ok()?, radius.parse().ok()?);
        let (exitance, standard_error) = (values(view, "exitance")?, values(view, "standard error")?);
        Some(Profile { albedo, radius, exitance, standard_error })
    };
    views.into_iter().filter_map(profile).collect()
}

/// Returns the path of the recorded spheres.
pub fn record_file() -> PathBuf {
    repository::place().join("docs/measurements/random_walk/sphere.json")
}

/// Reads the recorded spheres.
///
/// # Errors
/// Returns an error if the record is missing or damaged.
pub fn record(path: &Path) -> Result<Vec<Profile>, CostError> {
    let unfit = |what: String| CostError::Record { path: path.to_owned(), what };
    let text = std::fs::read_to_string(path).map_err(|error| unfit(format!("cannot be read: {error}")))?;
    let report = Report::from_json(NAME, &text).map_err(|error| match error {
        CostError::Unfit { what, .. } => unfit(format!("is not a sphere.json: {what}")),
        other => other,
    })?;
    let profiles = profiles(&report);
    let walked = report.rows.iter().filter(|row| row.measure.starts_with("exitance "));
    let spheres = distinct(walked.map(|row| &row.view)).len();
    if profiles.is_empty() || profiles.len() < spheres {
        return Err(unfit(format!("holds {} whole spheres of {spheres}", profiles.len())));
    }
    Ok(profiles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_that_is_not_there_or_holds_nothing_is_named() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("sphere.json");
        let said = |path: &Path| record(path).expect_err("no record").to_string();
        assert!(said(&path).contains("sphere.json: cannot be read") && said(&path).contains("./cook cost sphere"));
        std::fs::write(&path, "{}").expect("written");
        assert!(said(&path).contains("is not a sphere.json"), "{}", said(&path));
        let empty = Report::new("sphere", String::new(), &[]).json().expect("JSON");
        std::fs::write(&path, empty).expect("written");
        assert!(said(&path).contains("holds 0 whole spheres of 0"));
    }
}
