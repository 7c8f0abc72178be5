//! What accuracy costs in time: each rung of a technique's ladder is compared with its reference
//! and timed, all in one run.

pub mod cdrf;
mod choices;
mod dispersion;
pub mod drawing;
pub mod effects;
mod error;
mod gem;
mod gem_tables;
pub mod optical_path;
pub mod page;
pub mod plot;
mod profile;
pub mod proxy_sizes;
mod quality;
mod reflection;
pub mod restraint;
mod seen;
pub mod sphere;
mod table;
mod timing;
pub mod views;

pub use choices::Choice;
pub use dispersion::Colours;
pub use error::Errors;
pub use gem::{Options, RUNGS, run};
pub use profile::profile;
pub use reflection::Reflection;
pub use seen::{Seen, Steadiness};
pub use timing::{Timed, Timing};

use lapidary_specialise::SpecialiseError;
use lapidary_specialise::spirv_counts::SpirvCountsError;
use serde::{Deserialize, Serialize};

/// The measures of a gem rung in a view, numbered as in [`Seen::of`].
pub const MEASURES: [&str; 4] = ["flip", "rmse", "energy", "change"];

/// The result for one rung, one view and one measure.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The ladder's name.
    pub technique: &'static str,
    /// The rung's name.
    pub rung: String,
    /// The view's name; for gems see [`views::VIEWS`].
    pub view: String,
    /// The error, in the unit of its measure; `None` if the measure does not apply to the rung.
    pub error: Option<f64>,
    /// Name of the measure. Gems: `flip`, `rmse`, `energy` or `change`. Reflectance: `largest` or
    /// `rms` (from the convolution), or `walks` (from random walks). Optical paths: `nats`,
    /// `luminance` or `walks`.
    pub error_measure: &'static str,
    /// Milliseconds per frame; `None` if timing was skipped.
    pub ms: Option<f64>,
    /// Whether another rung is at least as fast and has a smaller error in this view and measure.
    pub dominated: bool,
    /// The timed device and its driver.
    pub adapter: String,
}

/// All results of one rung.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RungReport {
    /// The rung's name.
    pub rung: String,
    /// Results by view, in the order of [`Report::views`].
    pub views: Vec<Option<Seen>>,
    /// Results by view, in the order of [`Report::concave`]; `None` if the rung draws convex bodies
    /// only.
    pub concave: Vec<Option<Seen>>,
    /// The time of the paper's frame, which the stone fills; `None` if timing was skipped.
    pub timing: Option<Timing>,
    /// Number of SPIR-V instructions in the specialised fragment shader.
    pub fragment_instructions: u32,
    /// Number of SPIR-V instructions in the specialised vertex shader.
    pub vertex_instructions: u32,
    /// Bytes of constants and storage that the geometry of the timed stone needs besides the mesh.
    pub geometry_bytes: u64,
    /// Whether another rung is faster and, averaged over the views, has no larger error in either
    /// FLIP or RMSE.
    pub dominated: bool,
}

/// The measured gem ladder.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// The device and its driver.
    pub adapter: String,
    /// Names of the views of convex bodies.
    pub views: Vec<String>,
    /// Names of the views of concave bodies.
    pub concave: Vec<String>,
    /// Width and height in pixels of a view's picture, which is both compared and timed.
    pub side: u32,
    /// Samples per pixel, both in the views and in the paper's frame.
    pub samples: u32,
    /// Width and height of the paper's frame in pixels.
    pub frame: [u32; 2],
    /// The rungs, from cheap to exact.
    pub rungs: Vec<RungReport>,
    /// Distance of tracked colours from the colours of separate wavelengths.
    pub colours: Vec<Colours>,
    /// Ways to end a ray: what happens to its remainder, and where it ends.
    pub choices: Vec<Choice>,
    /// The frame-to-frame change that remains with more samples.
    pub steadiness: Vec<Steadiness>,
    /// The proxy at small sizes; empty if only a part of the ladder was requested.
    pub sizes: Vec<proxy_sizes::AtSize>,
    /// Total internal reflection at the first hit, exact and with the proxy.
    pub reflections: Vec<Reflection>,
}

impl RungReport {
    /// Returns the time in milliseconds, with a star if only part of the frame was timed.
    fn milliseconds(&self) -> String {
        let shown = |timing: Timing| format!("{:.1}{}", timing.ms, if timing.share < 1.0 { "*" } else { "" });
        self.timing.map_or("-".to_owned(), shown)
    }

    /// Returns the mean error over the views, by index into [`MEASURES`].
    pub fn mean(&self, measure: usize) -> f64 {
        let errors: Vec<f64> = self.views.iter().flatten().map(|seen| seen.of(measure)).collect();
        errors.iter().sum::<f64>() / errors.len() as f64
    }

    /// Returns the largest error over the views, by index into [`MEASURES`].
    pub fn worst(&self, measure: usize) -> f64 {
        self.views.iter().flatten().map(|seen| seen.of(measure)).fold(0.0, f64::max)
    }

    /// Returns the mean time of a view's picture in milliseconds: the pictures whose errors
    /// [`Self::mean`] averages.
    pub fn view_ms(&self) -> Option<f64> {
        let sum = self.views.iter().flatten().map(|seen| seen.ms).sum::<Option<f64>>()?;
        (sum > 0.0).then(|| sum / self.views.iter().flatten().count() as f64)
    }
}

/// The factor by which a rung's error may exceed a faster one's and still count as equal: equal
/// geometry gives equal pictures except for rounding.
const ALIKE: f64 = 1.001;

impl Report {
    /// Returns the rung with that name.
    fn rung(&self, name: &str) -> Option<&RungReport> {
        self.rungs.iter().find(|rung| rung.rung == name)
    }

    /// Returns the time of `slow` divided by the time of `fast`.
    fn ratio(&self, slow: &str, fast: &str) -> Option<f64> {
        Some(self.rung(slow)?.timing?.ms / self.rung(fast)?.timing?.ms)
    }

    /// Returns one row per rung, measure and view.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for rung in &self.rungs {
            let views = self.views.iter().zip(&rung.views).chain(self.concave.iter().zip(&rung.concave));
            for (view, seen) in views.filter_map(|(view, seen)| Some((view, seen.as_ref()?))) {
                for (measure, error_measure) in MEASURES.into_iter().enumerate() {
                    rows.push(Row {
                        technique: "gem",
                        rung: rung.rung.clone(),
                        view: view.clone(),
                        error: Some(seen.of(measure)),
                        error_measure,
                        ms: seen.ms,
                        dominated: false,
                        adapter: self.adapter.clone(),
                    });
                }
            }
        }
        mark_rows(&mut rows, |_, _| true);
        rows
    }

    /// Marks every dominated rung: another one is faster and, averaged over the views, no worse in
    /// either FLIP or RMSE, up to rounding.
    pub fn mark_dominated(&mut self) {
        let beats = |other: &RungReport, rung: &RungReport| {
            let faster = matches!((other.view_ms(), rung.view_ms()), (Some(other), Some(rung)) if other < rung);
            faster && (0..2).all(|measure| other.mean(measure) <= ALIKE * rung.mean(measure))
        };
        mark(&mut self.rungs, beats, |rung| &mut rung.dominated);
    }

    /// Returns the report as text.
    pub fn text(&self) -> String {
        table::text(self)
    }
}

/// Sets the mark of each item that another one beats.
fn mark<T>(items: &mut [T], beats: impl Fn(&T, &T) -> bool, mark: impl Fn(&mut T) -> &mut bool) {
    let marks: Vec<bool> = items.iter().map(|item| items.iter().any(|other| beats(other, item))).collect();
    for (item, beaten) in items.iter_mut().zip(marks) {
        *mark(item) = beaten;
    }
}

/// Marks each row for which another row of the same view and measure is at least as fast and has a
/// smaller error, provided that the two errors are `comparable`.
fn mark_rows(rows: &mut [Row], comparable: impl Fn(&Row, &Row) -> bool) {
    let beats = |other: &Row, row: &Row| {
        let alike = (&other.view, other.error_measure) == (&row.view, row.error_measure);
        let no_slower = matches!((other.ms, row.ms), (Some(other), Some(row)) if other <= row);
        let nearer = matches!((other.error, row.error), (Some(other), Some(row)) if other < row);
        alike && no_slower && nearer && comparable(other, row)
    };
    mark(rows, beats, |row| &mut row.dominated);
}

/// Why a ladder could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// The record of spheres is missing or unusable, so there is nothing to compare with.
    #[error(
        "{}: {what}; restore it from version control, or remake it: ./cook cost sphere --out docs/measurements/random_walk",
        path.display()
    )]
    Record {
        /// Expected path of the record.
        path: std::path::PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A picture or a frame could not be rendered.
    #[error(transparent)]
    Render(#[from] lapidary_render::RenderError),
    /// A view's scene could not be made.
    #[error(transparent)]
    Scene(#[from] lapidary_scene::SceneError),
    /// The reference to compare with is missing; references are never generated automatically.
    #[error("{}: missing; restore it from version control, or remake it: {command}", path.display())]
    NoReference {
        /// Expected path of the reference.
        path: std::path::PathBuf,
        /// The command that makes the reference.
        command: String,
    },
    /// A committed reference is damaged.
    #[error(transparent)]
    Reference(#[from] crate::snapshot::SnapshotError),
    /// The recipe could not be specialised for counting its instructions.
    #[error("counting instructions: {0}")]
    Specialise(#[from] SpecialiseError),
    /// The instructions of the specialised recipe could not be counted.
    #[error("counting instructions: {0}")]
    Counts(#[from] SpirvCountsError),
    /// The plot could not be drawn.
    #[error("drawing the plot: {0}")]
    Plot(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rung(name: &str, ms: f64, flip: f64, rmse: f64) -> RungReport {
        RungReport {
            rung: name.to_owned(),
            views: vec![Some(Seen { errors: Errors { flip, rmse, energy: 0.0 }, change: 0.0, ms: Some(ms) })],
            concave: Vec::new(),
            timing: Some(Timing { ms, median_ms: ms, share: 1.0, encode_us: 1.0, draw_calls: 1 }),
            fragment_instructions: 1,
            vertex_instructions: 1,
            geometry_bytes: 0,
            dominated: false,
        }
    }

    fn untimed(mut rung: RungReport) -> RungReport {
        rung.timing = None;
        rung.views.iter_mut().flatten().for_each(|seen| seen.ms = None);
        rung
    }

    fn report(rungs: Vec<RungReport>) -> Report {
        let mut report = Report {
            adapter: String::new(),
            views: vec!["view".to_owned()],
            concave: Vec::new(),
            side: 256,
            samples: 1,
            frame: [1920, 1080],
            rungs,
            colours: Vec::new(),
            choices: Vec::new(),
            steadiness: Vec::new(),
            sizes: Vec::new(),
            reflections: Vec::new(),
        };
        report.mark_dominated();
        report
    }

    fn marked(report: &Report) -> Vec<&str> {
        report.rungs.iter().filter(|rung| rung.dominated).map(|rung| rung.rung.as_str()).collect()
    }

    #[test]
    fn a_rung_is_dominated_by_a_faster_one_that_errs_no_more() {
        let cheap = rung("cheap", 1.0, 0.5, 0.5);
        let slow = rung("slow", 2.0, 0.5, 0.5);
        let mixed = rung("mixed", 3.0, 0.4, 0.6);
        let best = rung("best", 4.0, 0.1, 0.1);
        let worse = rung("worse", 5.0, 0.2, 0.2);
        assert_eq!(marked(&report(vec![cheap, slow, mixed, best, worse])), ["slow", "worse"]);
    }

    #[test]
    fn nothing_untimed_is_dominated() {
        let untimed = untimed(rung("untimed", 0.0, 0.9, 0.9));
        assert!(marked(&report(vec![rung("cheap", 1.0, 0.1, 0.1), untimed])).is_empty());
    }

    #[test]
    fn rows_are_marked_by_measure_and_view() {
        let report = report(vec![rung("cheap", 1.0, 0.5, 0.5), rung("mixed", 3.0, 0.4, 0.6)]);
        let of = |name: &str, measure: &str| {
            let rows = report.rows();
            let row = rows.iter().find(|row| row.rung == name && row.error_measure == measure);
            row.expect("a row").dominated
        };
        assert!(!of("mixed", "flip") && of("mixed", "rmse") && !of("cheap", "rmse"));
    }

    #[test]
    fn a_plot_shows_every_timed_rung() {
        let report = report(vec![rung("surface", 1.0, 0.5, 0.5), rung("convex-4+tracker", 3.0, 0.4, 0.6)]);
        for measure in ["flip", "rmse"] {
            let svg = plot::svg(&report, measure).expect("drawn");
            assert!(svg.contains("surface") && svg.contains("convex-4+tracker") && svg.ends_with("</svg>\n"), "{svg}");
        }
        let untimed = untimed(rung("surface", 0.0, 0.9, 0.9));
        assert!(plot::svg(&Report { rungs: vec![untimed], ..report }, "flip").is_err());
    }
}
