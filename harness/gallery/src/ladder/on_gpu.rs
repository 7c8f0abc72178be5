//! What the one GPU took that was measured: its committed records.

use super::kind::{KINDS, Kind};
use lapidary_ladders::Report;
use lapidary_plan::ladder::{Ladder, Step};
use lapidary_plan::{Rung, Technique};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Milliseconds of a frame, of which 60 are shown in a second.
pub const SIXTIETH: f64 = 1000.0 / 60.0;

/// The records, by the ladder's report.
const RECORDS: [(&str, &str); 4] = [
    ("gem", include_str!("../../../../docs/measurements/nvidia_h200/gem.json")),
    ("cdrf", include_str!("../../../../docs/measurements/nvidia_h200/cdrf.json")),
    ("optical_path", include_str!("../../../../docs/measurements/nvidia_h200/optical_path.json")),
    ("translucent", include_str!("../../../../docs/measurements/nvidia_h200/translucent.json")),
];

/// A ladder on the GPU.
#[derive(Debug)]
pub struct OnGpu {
    /// Its record.
    pub report: Report,
    /// Whether times are of a whole frame that a stone fills; of the others they are means over the views.
    pub fills: bool,
    /// Milliseconds of its rungs, in the record's order.
    pub times: Vec<(String, f64)>,
}

static ALL: LazyLock<BTreeMap<&str, OnGpu>> =
    LazyLock::new(|| KINDS.iter().map(|kind| (kind.name, OnGpu::read(kind))).collect());

impl OnGpu {
    /// Returns a ladder's.
    pub fn of(kind: &Kind) -> &'static Self {
        &ALL[kind.name]
    }

    /// Reads a ladder's record.
    ///
    /// # Panics
    /// If the committed record is damaged, which the tests of all ladders find.
    fn read(kind: &Kind) -> Self {
        let record = RECORDS.iter().find(|(report, _)| *report == kind.report).map_or("", |(_, record)| record);
        let damaged = |error: &dyn std::fmt::Display| -> ! { panic!("nvidia_h200/{}.json: {error}", kind.report) };
        let report = Report::from_json(kind.report, record).unwrap_or_else(|error| damaged(&error));
        let fills = kind.technique == Technique::Convex;
        let times = if fills {
            // The steady rung's frame is timed with each way to sample a pixel; the ladder's is one sample.
            let frame =
                |rung: &str| report.ms(rung, "filled", "time").or_else(|| report.ms(rung, "filled", "time with 1"));
            let rungs = report.rungs("time").into_iter().chain(report.rungs("time with 1"));
            rungs.filter_map(|rung| Some((rung.to_owned(), frame(rung)?))).collect()
        } else {
            let ladder = Ladder::of_record(kind.technique, record).unwrap_or_else(|error| damaged(&error));
            ladder.steps.into_iter().map(|step| (step.rung, step.ms)).collect()
        };
        Self { report, fills, times }
    }

    /// Returns the GPU's name, without its driver.
    pub fn name(&self) -> String {
        self.report.adapter.split(" (").next().unwrap_or_default().to_owned()
    }

    /// Returns the milliseconds of a rung; `None` if it was not measured.
    pub fn ms(&self, rung: &str) -> Option<f64> {
        self.times.iter().find(|(name, _)| name == rung).map(|(_, ms)| *ms)
    }

    /// Returns a ladder with these times instead of its own, without the rungs that were not measured here.
    pub fn ladder(&self, ladder: &Ladder) -> Ladder {
        let timed = |step: &Step| Some(Step { ms: self.ms(&step.rung)?, ..step.clone() });
        Ladder { measure: ladder.measure, steps: ladder.steps.iter().filter_map(timed).collect() }
    }

    /// Returns the size of the pictures that it drew, in words.
    pub fn size(&self, kind: &Kind) -> String {
        if self.fills { format!("{}, filled", self.report.size()) } else { kind.size(&self.report) }
    }

    /// Returns the measured rungs that differ from this one in their hits or in their colours alone.
    pub fn relatives(&self, rung: Rung) -> impl Iterator<Item = &(String, f64)> {
        let is_near = move |other: &str| match (rung, other.parse()) {
            (
                Rung::Inside { geometry, hits, spectrum },
                Ok(Rung::Inside { geometry: other_geometry, hits: other_hits, spectrum: other_spectrum }),
            ) => geometry == other_geometry && (hits == other_hits || spectrum == other_spectrum),
            _ => false,
        };
        self.times.iter().filter(move |(name, _)| is_near(name))
    }
}
