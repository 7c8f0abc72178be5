//! A ladder's report: rows, each of which is one measurement.

use crate::error::CostError;
use crate::timing::Timing;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One measurement of a rung: a value, and what the frame that it was measured in takes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The rung's name; if the rung was drawn in several ways, followed by a comma and the way.
    pub rung: String,
    /// The view's name: a picture, or a part of the work.
    pub view: String,
    /// Name of the measured quantity.
    pub measure: String,
    /// The value in `unit`; `None` if the measure does not apply to the rung or was not taken.
    pub value: Option<f64>,
    /// Unit of the value; empty for a ratio or a count.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Milliseconds for the same frame, the minimum over the rounds; `None` if it was not timed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ms: Option<f64>,
    /// Bytes that the frame needs; each ladder says of which resources.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Numbers of SPIR-V instructions of the frame's specialised shaders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instructions: Vec<u32>,
}

impl Row {
    /// Returns a measurement without a frame.
    pub fn new(rung: &str, view: &str, measure: &str, value: impl Into<Option<f64>>, unit: &str) -> Self {
        let [rung, view, measure, unit] = [rung, view, measure, unit].map(str::to_owned);
        Self { rung, view, measure, value: value.into(), unit, ..Self::default() }
    }

    /// Returns the row with the time of its frame.
    #[must_use]
    pub fn timed(self, ms: Option<f64>) -> Self {
        Self { ms, ..self }
    }
}

/// Name of the measure whose value is a frame's median time.
pub const TIME: &str = "time";

/// A measured ladder.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The ladder's name.
    pub technique: String,
    /// The device and its driver.
    pub adapter: String,
    /// Whole numbers that hold for the run, by name, such as `width`, `height` and `rounds`.
    pub settings: BTreeMap<String, u64>,
    /// The measurements, in order.
    pub rows: Vec<Row>,
}

impl Report {
    /// Returns a report without rows.
    pub fn new(technique: &str, adapter: String, settings: &[(&str, u64)]) -> Self {
        let settings = settings.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        Self { technique: technique.to_owned(), adapter, settings, rows: Vec::new() }
    }

    /// Reads a ladder's report from JSON.
    ///
    /// # Errors
    /// Returns an error if the text is not a report, or one of another ladder.
    pub fn from_json(ladder: &str, json: &str) -> Result<Self, CostError> {
        let unfit = |what: String| CostError::Unfit { ladder: ladder.to_owned(), what };
        let report: Self = serde_json::from_str(json).map_err(|error| unfit(error.to_string()))?;
        if report.technique == ladder {
            Ok(report)
        } else {
            Err(unfit(format!("it is a report of `{}`", report.technique)))
        }
    }

    /// Returns the report as JSON, with a line for each row.
    ///
    /// # Errors
    /// Returns an error if a value is infinite or not a number, which JSON cannot hold.
    pub fn json(&self) -> Result<String, CostError> {
        let is_finite = |row: &&Row| [row.value, row.ms].into_iter().flatten().all(f64::is_finite);
        if let Some(Row { rung, view, measure, .. }) = self.rows.iter().find(|row| !is_finite(row)) {
            return Err(CostError::NotFinite { row: format!("{measure} of {rung} in {view}") });
        }
        let head = serde_json::to_string_pretty(&Self { rows: Vec::new(), ..self.clone() })?;
        let rows: Vec<String> = self.rows.iter().map(serde_json::to_string).collect::<Result<_, _>>()?;
        let empty = "\"rows\": []";
        Ok(head.replace(empty, &format!("\"rows\": [\n    {}\n  ]", rows.join(",\n    "))))
    }

    /// Returns a setting; 0 if the report lacks it.
    pub fn setting(&self, name: &str) -> u64 {
        self.settings.get(name).copied().unwrap_or_default()
    }

    /// Describes the size of the timed frame.
    pub fn size(&self) -> String {
        format!("{} × {}", self.setting("width"), self.setting("height"))
    }

    /// Describes how times were taken and on what.
    pub fn run(&self) -> String {
        match self.setting("rounds") {
            0 => self.adapter.clone(),
            rounds => format!("the least of {rounds} interleaved rounds, on {}", self.adapter),
        }
    }

    /// Returns a measurement.
    pub fn row(&self, rung: &str, view: &str, measure: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.measure == measure && row.rung == rung && row.view == view)
    }

    /// Returns a measurement's value.
    pub fn value(&self, rung: &str, view: &str, measure: &str) -> Option<f64> {
        self.row(rung, view, measure)?.value
    }

    /// Returns the time of a measurement's frame in milliseconds.
    pub fn ms(&self, rung: &str, view: &str, measure: &str) -> Option<f64> {
        self.row(rung, view, measure)?.ms
    }

    /// Returns the rungs with a measure, in order and each once.
    pub fn rungs(&self, measure: &str) -> Vec<&str> {
        distinct(self.rows.iter().filter(|row| row.measure == measure).map(|row| row.rung.as_str()))
    }

    /// Returns the views with a measure, in order and each once.
    pub fn views(&self, measure: &str) -> Vec<&str> {
        distinct(self.rows.iter().filter(|row| row.measure == measure).map(|row| row.view.as_str()))
    }

    /// Adds a frame's times: its median as a value, and the part of its pixels that was drawn unless
    /// all were. `row` gives the frame's rung and view, its bytes and its instructions.
    pub fn add_time(&mut self, row: Row, timing: Option<&Timing>) {
        let row = Row { measure: TIME.to_owned(), unit: "ms".to_owned(), ..row };
        if let Some(timing) = timing.filter(|timing| timing.share < 1.0) {
            self.rows.push(Row::new(&row.rung, &row.view, "share of the pixels", timing.share, ""));
        }
        let (value, ms) = timing.map(|timing| (timing.median_ms, timing.ms)).unzip();
        self.rows.push(Row { value, ms, ..row });
    }

    /// Shows the time of a frame added by [`Self::add_time`]; with a star if a part of its pixels was
    /// timed.
    pub fn shown_ms(&self, rung: &str, view: &str) -> String {
        let star = if self.row(rung, view, "share of the pixels").is_some() { "*" } else { "" };
        self.ms(rung, view, TIME).map_or("-".to_owned(), |ms| format!("{ms:.1}{star}"))
    }

    /// Checks that frames added by [`Self::add_time`] have a time.
    ///
    /// # Errors
    /// Returns a message that names the first rung without one: a page would have gaps.
    pub fn all_timed<'a>(&self, rungs: impl IntoIterator<Item = &'a str>, views: &[&str]) -> Result<(), String> {
        let timed = |rung: &str| views.iter().all(|view| self.ms(rung, view, TIME).is_some());
        match rungs.into_iter().find(|rung| !timed(rung)) {
            Some(rung) => {
                Err(format!("the report has no time of `{rung}`; only the whole ladder, timed, fills a page"))
            }
            None => Ok(()),
        }
    }
}

/// Returns the values in order, each once.
pub fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for value in values {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    found
}

/// Returns the rungs that another one beats, each marked `dominated`.
pub fn dominated<'a>(rungs: &[&'a str], beats: impl Fn(&str, &str) -> bool) -> Vec<&'a str> {
    rungs.iter().copied().filter(|rung| rungs.iter().any(|other| beats(other, rung))).collect()
}

/// Whether every pair of numbers is present and in the order that `is` tells; no pair at all is not.
pub fn all_pairs(pairs: impl IntoIterator<Item = (Option<f64>, Option<f64>)>, is: fn(f64, f64) -> bool) -> bool {
    let mut pairs = pairs.into_iter().peekable();
    pairs.peek().is_some() && pairs.all(|(one, other)| one.zip(other).is_some_and(|(one, other)| is(one, other)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_survives_its_json() {
        let mut report = Report::new("gem", "a device".to_owned(), &[("width", 4)]);
        let empty = report.json().expect("JSON");
        assert_eq!(Report::from_json("gem", &empty).expect("a report"), report);
        report.rows.push(Row::new("proxy-1", "prism", "flip", 0.1 + 0.2, "").timed(Some(1e-7)));
        report.rows.push(Row { bytes: Some(3), instructions: vec![1, 2], ..Row::new("a", "b", "c", None, "ms") });
        let json = report.json().expect("JSON");
        assert_eq!(Report::from_json("gem", &json).expect("a report"), report);
        assert_eq!(json.lines().filter(|line| line.contains("\"rung\"")).count(), 2, "{json}");
        for (field, change) in [("view", "\"veiw\":"), ("value", "\"other\":0,\"value\":")] {
            let wrong = json.replacen(&format!("\"{field}\":"), change, 1);
            let error = Report::from_json("gem", &wrong).expect_err("a wrong field").to_string();
            assert!(error.contains("not a gem.json"), "{error}");
        }
        report.rows[0].value = Some(f64::NAN);
        assert!(report.json().expect_err("no number").to_string().contains("flip of proxy-1 in prism"));
        let other = Report::from_json("cdrf", &json).expect_err("another ladder's").to_string();
        assert!(other.contains("not a cdrf.json") && other.contains("report of `gem`"), "{other}");
    }

    #[test]
    fn a_time_is_shown_with_the_part_that_was_drawn() {
        let mut report = Report::default();
        let timing = |share| Timing { ms: 2.0, median_ms: 3.0, share, encode_us: 1.0 };
        report.add_time(Row::new("whole", "filled", "", None, ""), Some(&timing(1.0)));
        report.add_time(Row::new("part", "filled", "", None, ""), Some(&timing(0.0625)));
        report.add_time(Row::new("untimed", "filled", "", None, ""), None);
        let shown = ["whole", "part", "untimed", "absent"].map(|rung| report.shown_ms(rung, "filled"));
        assert_eq!(shown, ["2.0", "2.0*", "-", "-"]);
        assert_eq!((report.value("part", "filled", TIME), report.rungs(TIME).len()), (Some(3.0), 3));
        assert_eq!(report.all_timed(["whole", "part"], &["filled"]), Ok(()));
        assert!(report.all_timed(["whole", "untimed"], &["filled"]).expect_err("not timed").contains("`untimed`"));
    }

    #[test]
    fn a_rung_is_dominated_if_another_beats_it() {
        let order = ["cheap", "slow", "best"];
        assert_eq!(dominated(&order, |other, rung| (other, rung) == ("cheap", "slow")), ["slow"]);
        let less = |one, other| one < other;
        assert!(all_pairs([(Some(1.0), Some(2.0))], less) && !all_pairs([(Some(2.0), Some(1.0))], less));
        assert!(!all_pairs([(Some(1.0), None)], less) && !all_pairs([], less));
    }
}
