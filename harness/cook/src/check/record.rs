//! A long check in parts: joins the rows of a function from several seeds, and stores the progress
//! in a file, so that a run can resume where another ended, and runs on several machines can be
//! merged.

use super::Row;
use crate::cookbook::{self, release};
use crate::text_file;
use lapidary_assay::property::DEFAULT_CASES;
use lapidary_assay::property::histogram::Histogram;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Random inputs per part: a longer check takes that many from each of several seeds in turn.
pub const PART: u64 = 1 << 20;

/// Largest size of a record in bytes.
const MOST_BYTES: u64 = 1 << 28;

/// The progress of a long check.
#[derive(Clone, Debug)]
pub struct Record {
    /// Description of what was compared, and on which device.
    pub about: String,
    /// Random inputs per seed.
    pub cases: u64,
    /// Number of parts of the whole check in all shards; a part is one function with one seed.
    pub parts: usize,
    /// One row per function.
    pub rows: Vec<Row>,
    /// Hash of each module's text.
    texts: BTreeMap<String, String>,
}

/// The file format of a record. Borrowed for writing, because it is written after every part.
#[derive(Serialize, Deserialize)]
struct Stored<'a> {
    about: Cow<'a, str>,
    cases: u64,
    texts: Cow<'a, BTreeMap<String, String>>,
    parts: usize,
    rows: Cow<'a, [Row]>,
    /// The distribution of errors behind each row.
    ulps: Vec<Cow<'a, Histogram>>,
}

impl Record {
    /// Returns an empty record.
    pub fn new(about: &str, cases: u64, parts: usize) -> Record {
        Record { about: about.to_owned(), cases, parts, rows: Vec::new(), texts: BTreeMap::new() }
    }

    /// Returns the number of parts done.
    pub fn done(&self) -> usize {
        self.rows.iter().map(|row| row.seeds.len()).sum()
    }

    /// Reads a record from a file; if the file does not exist, returns an empty record.
    ///
    /// # Errors
    /// Returns a one-line message if the file is not a record, or is the record of a different
    /// check.
    pub fn open(path: &Path, about: &str, cases: u64, parts: usize) -> Result<Record, String> {
        if !path.exists() {
            return Ok(Record::new(about, cases, parts));
        }
        let found = Record::read(path)?;
        let name = path.display();
        if found.cases != cases {
            return Err(format!("{name}: holds {} inputs a seed, not {cases}; name another file", found.cases));
        }
        if found.parts != parts {
            return Err(format!("{name}: holds a check of {} parts, not {parts}; name another file", found.parts));
        }
        if found.about != about {
            return Err(format!("{name}: holds a check on another device; name another file"));
        }
        found.check_texts(path)?;
        Ok(found)
    }

    /// Reads a record from a file.
    ///
    /// # Errors
    /// Returns a one-line message if the file cannot be read or is not a record.
    pub fn read(path: &Path) -> Result<Record, String> {
        let text = text_file::read(path, MOST_BYTES)?;
        let found: Result<Stored<'_>, _> = serde_json::from_str(&text);
        let found = found.map_err(|error| format!("{}: no record of a check: {error}", path.display()))?;
        let Stored { about, cases, texts, parts, rows, ulps } = found;
        let mut rows = rows.into_owned();
        rows.iter_mut().zip(ulps).for_each(|(row, ulps)| row.ulps = ulps.into_owned());
        Ok(Record { about: about.into_owned(), cases, parts, rows, texts: texts.into_owned() })
    }

    /// Returns the record as the text of a file.
    pub fn text(&self) -> String {
        let Record { about, cases, parts, rows, texts } = self;
        let stored = Stored {
            about: about.into(),
            cases: *cases,
            texts: Cow::Borrowed(texts),
            parts: *parts,
            rows: rows.into(),
            ulps: rows.iter().map(|row| Cow::Borrowed(&row.ulps)).collect(),
        };
        serde_json::to_string(&stored).unwrap_or_else(|error| unreachable!("{error}"))
    }

    /// Returns an error if the record is of a different text.
    fn check_texts(&self, path: &Path) -> Result<(), String> {
        match self.texts.iter().find(|(module, text)| text_hash(module) != **text) {
            None => Ok(()),
            Some((module, _)) => {
                Err(format!("{}: `{module}` has changed since; name another file, or remove this one", path.display()))
            }
        }
    }

    /// Whether a function was tested with a seed.
    pub fn holds(&self, function: &str, seed: u64) -> bool {
        self.rows.iter().any(|row| row.function == function && row.seeds.contains(&seed))
    }

    /// Adds a function's row.
    pub fn add(&mut self, row: Row) {
        self.texts.insert(row.module.clone(), text_hash(&row.module));
        self.put(row);
    }

    fn put(&mut self, row: Row) {
        match self.rows.iter_mut().find(|found| found.function == row.function) {
            Some(found) => *found = std::mem::take(found).join(row),
            None => self.rows.push(row),
        }
    }

    /// Returns the record with its rows in the cookbook's order.
    #[must_use]
    pub fn in_order(mut self) -> Record {
        let order: BTreeMap<&str, usize> =
            crate::formulas::all().iter().enumerate().map(|(place, formula)| (formula.function, place)).collect();
        self.rows.sort_by_key(|row| order.get(row.function.as_str()).copied());
        self
    }

    /// Merges several records into one.
    ///
    /// # Errors
    /// Returns a one-line message if they belong to different checks or texts, or if a part occurs
    /// twice.
    pub fn merge(records: Vec<(String, Record)>) -> Result<Record, String> {
        let mut records = records.into_iter();
        let (first, mut merged) = records.next().ok_or("no record to merge")?;
        for (name, record) in records {
            if (&record.about, record.cases, record.parts) != (&merged.about, merged.cases, merged.parts) {
                return Err(format!("{name}: of another device or number of inputs than {first}"));
            }
            let other = record
                .texts
                .iter()
                .find(|(module, text)| merged.texts.get(*module).is_some_and(|found| found != *text));
            if let Some((module, _)) = other {
                return Err(format!("{name}: of another text of `{module}` than those before it"));
            }
            for row in record.rows {
                if let Some(seed) = row.seeds.iter().find(|seed| merged.holds(&row.function, **seed)) {
                    return Err(format!(
                        "{name}: holds `{}` from seed {seed}, which another holds as well",
                        row.function
                    ));
                }
                merged.put(row);
            }
            merged.texts.extend(record.texts);
        }
        Ok(merged.in_order())
    }
}

/// Returns the hash of a module's text as in its version line.
fn text_hash(module: &str) -> String {
    cookbook::module(module).map_or_else(String::new, |module| release::text_hash(module.whole))
}

impl Row {
    /// Combines two rows of one function with different seeds: the failures of either, the worst of
    /// both.
    #[must_use]
    pub fn join(mut self, mut other: Row) -> Row {
        let badness = |row: &Row| (row.failed > 0, !row.passed, row.worst_ratio);
        if badness(&other).partial_cmp(&badness(&self)) == Some(Ordering::Greater) {
            return other.join(self);
        }
        // This row is the worse: its worst input, failure and command are kept.
        self.cases += other.cases;
        self.failed += other.failed;
        self.nonfinite += other.nonfinite;
        self.stopped += other.stopped;
        self.max_ulp = self.max_ulp.max(other.max_ulp);
        self.ulps.join(&other.ulps);
        self.p99_ulp = self.ulps.quantile(0.99).min(f64::MAX);
        self.median_ulp = self.ulps.quantile(0.5).min(f64::MAX);
        self.worst_ratio = self.worst_ratio.max(other.worst_ratio);
        self.held_hard_cases = self.held_hard_cases.min(other.held_hard_cases);
        let largest = |row: &Row| row.difference.as_ref().map_or(-1.0, |difference| difference.max_ulp);
        if self.difference_input.is_none() || largest(&other) > largest(&self) {
            self.difference_input = other.difference_input.take().or(self.difference_input);
        }
        for (found, others) in [
            (&mut self.broken_hard_cases, other.broken_hard_cases),
            (&mut self.broken_promises, other.broken_promises),
            (&mut self.broken_branches, other.broken_branches),
            (&mut self.assumptions, other.assumptions),
        ] {
            let all: BTreeSet<String> = found.drain(..).chain(others).collect();
            found.extend(all);
        }
        self.worst_choices = self.worst_choices.or(other.worst_choices);
        if other.allowance > self.allowance {
            (self.allowance, self.allowance_input) = (other.allowance, other.allowance_input);
        }
        for (field, other) in self.allowances.iter_mut().zip(&other.allowances) {
            field.largest = field.largest.max(other.largest);
            field.with_method = field.with_method.max(other.with_method);
        }
        self.difference = match (self.difference, other.difference) {
            (Some(one), Some(other)) => Some(one.join(other)),
            (one, other) => one.or(other),
        };
        self.branches_untested = self.branches_untested.or(other.branches_untested);
        self.missed_edges.retain(|edge| other.missed_edges.contains(edge));
        self.seconds += other.seconds;
        self.seeds.extend(other.seeds);
        self.seeds.sort_unstable();
        // An edge is reached if either row reached it.
        self.passed = self.is_right() && (self.cases < DEFAULT_CASES || self.missed_edges.is_empty());
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(seed: u64, failed: u64, ulp: f64) -> Row {
        let mut row = Row {
            passed: failed == 0,
            module: "srgb".to_owned(),
            function: "srgb_encode".to_owned(),
            cases: 10,
            failed,
            ..Row::default()
        };
        (row.max_ulp, row.worst_ratio, row.seeds) = (ulp, ulp / 4.0, vec![seed]);
        row.worst_input = format!("of {seed}");
        (0..10).for_each(|_| row.ulps.add(ulp));
        row
    }

    #[test]
    fn rows_join_to_what_one_run_would_say() {
        let joined = row(1, 0, 2.0).join(row(2, 3, 8.0)).join(row(3, 0, 1.0));
        assert!(!joined.passed);
        assert_eq!((joined.cases, joined.failed, joined.max_ulp, joined.worst_ratio), (30, 3, 8.0, 2.0));
        assert_eq!(
            (joined.median_ulp, joined.worst_input.as_str(), joined.seeds.as_slice()),
            (2.0, "of 2", &[1, 2, 3][..])
        );
    }

    #[test]
    fn an_edge_that_one_part_reached_is_reached_and_a_broken_invariant_is_not_lost() {
        let missing = |edges: &[&str]| Row {
            passed: false,
            cases: DEFAULT_CASES,
            missed_edges: edges.iter().map(|edge| (*edge).to_owned()).collect(),
            ..row(1, 0, 1.0)
        };
        let joined = missing(&["one"]).join(missing(&["two"]));
        assert!(joined.passed && joined.missed_edges.is_empty(), "{joined:?}");
        assert!(!missing(&["one"]).join(missing(&["one", "two"])).passed);
        // One row broke a promise at a larger share of its bound; the other has the failing input.
        let mut promise = Row { passed: false, ..row(1, 0, 3.6) };
        promise.broken_promises.push("a promise".to_owned());
        let invariant = Row { reason: Some("an invariant".to_owned()), ..row(2, 1, 2.0) };
        let joined = promise.join(invariant);
        assert_eq!((joined.reason.as_deref(), joined.broken_promises.len()), (Some("an invariant"), 1));
    }

    #[test]
    fn records_are_read_back_merged_and_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.json");
        let mut one = Record::open(&path, "on a device", 10, 2).expect("none yet");
        one.add(row(1, 0, 2.0));
        std::fs::write(&path, one.text()).expect("written");
        let again = Record::open(&path, "on a device", 10, 2).expect("the same");
        assert!(again.holds("srgb_encode", 1) && !again.holds("srgb_encode", 2));
        assert_eq!(again.rows[0].ulps, one.rows[0].ulps);
        assert!(Record::open(&path, "on another", 10, 2).expect_err("another").contains("another device"));
        let mut two = Record::new("on a device", 10, 2);
        two.add(row(2, 1, 4.0));
        let named = |record: &Record| ("x.json".to_owned(), record.clone());
        let merged = Record::merge(vec![named(&one), named(&two)]).expect("merge");
        assert_eq!((merged.rows.len(), merged.rows[0].cases, merged.rows[0].failed), (1, 20, 1));
        assert_eq!((one.done(), merged.done(), merged.parts), (1, 2, 2));
        assert!(Record::merge(vec![named(&one), named(&one)]).expect_err("twice").contains("another holds as well"));
        let mut changed = one.clone();
        changed.texts.insert("srgb".to_owned(), "another".to_owned());
        std::fs::write(&path, changed.text()).expect("written");
        assert!(Record::open(&path, "on a device", 10, 2).expect_err("changed").contains("has changed since"));
    }
}
