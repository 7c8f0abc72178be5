//! Errors of a rung's function against random walks through spheres: the residual of the
//! convolution itself, and what a rung's errors add to it.

use crate::error::CostError;
use crate::report::{Report, distinct};
use crate::sphere::{self, Fit, ScaleKind};
use lapidary_cookbook::repository;
use lapidary_reference::random_walk::Profile;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

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
    let report = Report::from_json(sphere::LADDER.name, &text).map_err(|error| match error {
        CostError::Unfit { what, .. } => unfit(format!("is not a sphere.json: {what}")),
        other => other,
    })?;
    let profiles = sphere::profiles(&report);
    let walked = report.rows.iter().filter(|row| row.measure.starts_with("exitance "));
    let spheres = distinct(walked.map(|row| &row.view)).len();
    if profiles.is_empty() || profiles.len() < spheres {
        return Err(unfit(format!("holds {} whole spheres of {spheres}", profiles.len())));
    }
    Ok(profiles)
}

/// Returns the residuals of `function` against the spheres, with the best-fit scale and with the
/// diffuse albedo of the half space as the scale.
///
/// They are root mean squares over the spheres of each one's RMS over its surface, with its best-fit
/// width of the function; the unit is the irradiance of a surface that faces the light.
pub fn residuals(spheres: &[Profile], function: &(dyn Fn(f32, f32) -> f32 + Sync)) -> [f64; 2] {
    ScaleKind::ALL.map(|kind| {
        let squares = spheres.par_iter().map(|profile| {
            let function = |cosine: f64, sigma: f64| f64::from(function(cosine as f32, sigma as f32));
            Fit::best_of(profile, function, kind.of(profile.albedo)).residual.powi(2)
        });
        // Summed in order, so that every run gives the same digits.
        let squares: Vec<f64> = squares.collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Form;
    use lapidary_cdrf as mirror;

    #[test]
    fn residuals_are_those_of_the_spheres_rows() {
        let text = std::fs::read_to_string(record_file()).expect("the committed record");
        let report = Report::from_json("sphere", &text).expect("a report");
        let mut spheres = record(&record_file()).expect("the committed record");
        spheres.retain(|profile| profile.albedo == 0.99);
        type Mirror = fn(f32, f32) -> f32;
        let forms: [(Form, Mirror); 3] = [
            (Form::Lambert, |cosine, _| mirror::lambert(cosine)),
            (Form::Circular, mirror::accurate),
            (Form::Spherical, mirror::spherical),
        ];
        for (form, function) in forms {
            let found = residuals(&spheres, &function);
            for (found, kind) in found.into_iter().zip(ScaleKind::ALL) {
                let residual = |profile: &Profile| {
                    let view = sphere::view(profile.albedo, profile.radius);
                    report.value(&sphere::rung(form, kind), &view, "residual").expect("recorded")
                };
                let squares: f64 = spheres.iter().map(|profile| residual(profile).powi(2)).sum();
                let recorded = (squares / spheres.len() as f64).sqrt();
                assert!((found / recorded - 1.0).abs() < 1e-3, "{form:?} {kind:?}: {found} {recorded}");
            }
        }
    }

    /// The five numbers of `cdrf_drift`: drift and how absorption shortens it, width, and what bounds the
    /// light of a small body that absorbs little.
    const DRIFT: [f64; 5] = [1.9, 3.2, 1.5, 0.13, 0.041];

    /// Returns what leaves a sphere at this cosine, by the drift with these numbers and the half space's
    /// law.
    fn drifted(numbers: [f64; 5], cosine: f64, turn: f64, gamma: f64) -> f64 {
        let sideways = numbers[0] * turn / (1.0 + numbers[1] * gamma);
        let shift = sideways / sideways.hypot(1.0);
        let share = 1.0 / (1.0 + numbers[3] * turn * turn / (gamma * gamma + numbers[4] * turn));
        let shifted = (cosine + shift) / (1.0 + shift * cosine);
        let entered = f64::from(mirror::accurate(shifted as f32, (numbers[2] * turn) as f32));
        share * entered * f64::from(lapidary_half_space::directional(entered as f32, gamma as f32))
    }

    /// Returns the root mean square over the spheres of the residuals, without a free scale.
    fn drift_residual(spheres: &[&Profile], numbers: [f64; 5]) -> f64 {
        let square = |sphere: &&Profile| {
            let gamma = (1.0 - sphere.albedo).sqrt();
            let off = |bin: usize| {
                let mean = Profile::mean(bin, |cosine| drifted(numbers, cosine, 1.0 / sphere.radius, gamma));
                Profile::share(bin) * (mean - sphere.exitance[bin]).powi(2)
            };
            (0..lapidary_reference::random_walk::BINS).map(off).sum::<f64>()
        };
        (spheres.iter().map(square).sum::<f64>() / spheres.len() as f64).sqrt()
    }

    /// The table in docs/cdrf.md, and the fit: another number is no nearer to the spheres from 3 to
    /// 100 mean free paths.
    #[test]
    fn the_drift_is_fitted_to_the_recorded_spheres() {
        let spheres = record(&record_file()).expect("the committed record");
        for (turn, gamma) in [(0.1, 0.3), (0.3, 0.1), (0.02, 0.0)] {
            let drift = mirror::drift(1.0, turn as f32, gamma as f32);
            let own = drift.share * mirror::accurate(mirror::shifted(0.2, drift.shift), drift.sigma);
            let other = drifted(DRIFT, 0.2, turn, gamma);
            let entered = mirror::accurate(mirror::shifted(0.2, drift.shift), drift.sigma);
            let law = lapidary_half_space::directional(entered, gamma as f32);
            assert!((f64::from(own * law) / other - 1.0).abs() < 1e-5, "{turn} {gamma}");
        }
        let [convolution, _] = [mirror::accurate, mirror::spherical];
        for albedo in sphere::ALBEDOS {
            for [low, high] in [[3.0, 7.0], [10.0, 20.0], [30.0, 100.0]] {
                let inside = |of: &&Profile| of.albedo == albedo && (low..=high).contains(&of.radius);
                let some: Vec<&Profile> = spheres.iter().filter(inside).collect();
                let owned: Vec<Profile> = some.iter().map(|of| (*of).clone()).collect();
                let [_, best] = residuals(&owned, &convolution);
                let drift = drift_residual(&some, DRIFT);
                println!("albedo {albedo}, R from {low} to {high}: best width {best:.3}, drift {drift:.4}");
                assert!(drift < 0.7 * best, "{albedo} {low}: {drift} {best}");
            }
        }
        let fitted: Vec<&Profile> = spheres.iter().filter(|of| of.radius >= 3.0).collect();
        let least = drift_residual(&fitted, DRIFT);
        println!("all from 3 on: {least:.4}");
        assert!(least < 0.0098, "{least}");
        for place in 0..DRIFT.len() {
            for factor in [0.85, 1.15] {
                let mut other = DRIFT;
                other[place] *= factor;
                let residual = drift_residual(&fitted, other);
                assert!(residual > least, "number {place} times {factor}: {residual} {least}");
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
        assert!(said(&path).contains("is not a sphere.json"), "{}", said(&path));
        let empty = Report::new("sphere", String::new(), &[]).json().expect("JSON");
        std::fs::write(&path, empty).expect("written");
        assert!(said(&path).contains("holds 0 whole spheres of 0"));
    }
}
