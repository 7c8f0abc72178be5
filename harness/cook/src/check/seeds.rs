//! Many inputs, drawn from several seeds: their rows become one.

use super::Row;
use lapidary_assay::property::DEFAULT_CASES;
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// Most inputs from one seed.
pub const PART: u64 = 1 << 20;

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
}
