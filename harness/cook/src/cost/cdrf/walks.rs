//! Errors of a rung's function against random walks through spheres: the residual of the
//! convolution itself, and what a rung's errors add to it.

use crate::cost::CostError;
use crate::cost::sphere::{Fit, ScaleKind, SphereReport};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Residuals against the recorded spheres, as root mean squares over the spheres of each one's RMS
/// over its surface.
///
/// Each sphere has the best-fit width of the function; the unit is the irradiance of a surface that
/// faces the light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Residuals {
    /// With the best-fit scale.
    pub free: f64,
    /// With the diffuse albedo of the half space as the scale.
    pub fixed: f64,
}

/// Returns the path of the recorded spheres.
pub fn record_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/measurements/random_walk/sphere.json")
}

/// Reads the recorded spheres.
///
/// # Errors
/// Returns an error if the record is missing or damaged.
pub fn record(path: &Path) -> Result<SphereReport, CostError> {
    let unfit = |what: String| CostError::Record { path: path.to_owned(), what };
    let text = std::fs::read_to_string(path).map_err(|error| unfit(format!("cannot be read: {error}")))?;
    let report: SphereReport =
        serde_json::from_str(&text).map_err(|error| unfit(format!("is not a sphere.json: {error}")))?;
    if report.profiles.is_empty() {
        return Err(unfit("holds no sphere".to_owned()));
    }
    Ok(report)
}

/// Returns the residuals of `function`.
pub fn residuals(spheres: &SphereReport, function: &(dyn Fn(f32, f32) -> f32 + Sync)) -> Residuals {
    let [free, fixed] = ScaleKind::ALL.map(|kind| {
        let squares = spheres.profiles.par_iter().map(|profile| {
            let function = |cosine: f64, sigma: f64| f64::from(function(cosine as f32, sigma as f32));
            Fit::best_of(profile, function, kind.of(profile.albedo)).residual.powi(2)
        });
        // Summed in order, so that every run gives the same digits.
        let squares: Vec<f64> = squares.collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    });
    Residuals { free, fixed }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::sphere::Form;
    use lapidary_cdrf as mirror;

    #[test]
    fn residuals_are_those_of_the_spheres_rows() {
        let record = record(&record_file()).expect("the committed record");
        let spheres = SphereReport {
            profiles: record.profiles.iter().filter(|profile| profile.albedo == 0.99).cloned().collect(),
            ..record.clone()
        };
        type Mirror = fn(f32, f32) -> f32;
        let forms: [(Form, Mirror); 3] = [
            (Form::Lambert, |cosine, _| mirror::lambert(cosine)),
            (Form::Circular, mirror::accurate),
            (Form::Spherical, mirror::spherical),
        ];
        for (form, function) in forms {
            let found = residuals(&spheres, &function);
            for (found, kind) in [(found.free, ScaleKind::Free), (found.fixed, ScaleKind::Fixed)] {
                let rows: Vec<f64> = record.best(0.99, form, kind).map(|row| row.residual.powi(2)).collect();
                let recorded = (rows.iter().sum::<f64>() / rows.len() as f64).sqrt();
                assert!((found / recorded - 1.0).abs() < 1e-3, "{form:?} {kind:?}: {found} {recorded}");
            }
        }
    }

    #[test]
    fn a_record_that_is_not_there_or_holds_nothing_is_named() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("sphere.json");
        let said = |path: &Path| record(path).expect_err("no record").to_string();
        assert!(said(&path).contains("sphere.json: cannot be read") && said(&path).contains("./cook cost sphere"));
        std::fs::write(&path, "{}").expect("written");
        assert!(said(&path).contains("is not a sphere.json"));
        std::fs::write(&path, serde_json::to_string(&SphereReport::of(1, 1, Vec::new())).expect("JSON"))
            .expect("written");
        assert!(said(&path).contains("holds no sphere"));
    }
}
