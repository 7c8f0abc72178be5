//! A domain as a proptest strategy: each failing input is shrunk by its draws.

use super::Domain;
use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

impl<T> Domain<T> {
    /// The tree of row `row`, to be shrunk.
    pub fn tree(&self, seed: u64, row: u64) -> DrawTree<T> {
        let draws = self.draws(seed, row);
        DrawTree { domain: self.clone(), draws, at: 0, stage: 0, undo: None, moved: false }
    }
}

impl<T: std::fmt::Debug> Strategy for Domain<T> {
    type Tree = DrawTree<T>;
    type Value = T;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        use proptest::prelude::Rng as _;
        let seed = runner.rng().next_u64();
        Ok(self.tree(seed, 0))
    }
}

/// A value with the draws that made it. Each draw in turn is tried at 0, then with ever fewer of its low bits cleared,
/// then one less; what still fails is kept, and rounds go on until one changes nothing.
pub struct DrawTree<T> {
    domain: Domain<T>,
    draws: Vec<u32>,
    at: usize,
    stage: usize,
    undo: Option<(usize, u32)>,
    moved: bool,
}

/// What a draw is tried at, from the boldest to the smallest step.
const STAGES: [fn(u32) -> u32; 11] = [
    |_| 0,
    |draw| draw & 0xff00_0000,
    |draw| draw & 0xfff0_0000,
    |draw| draw & 0xffff_0000,
    |draw| draw & 0xffff_f000,
    |draw| draw & 0xffff_fe00,
    |draw| draw / 2,
    |draw| draw - draw / 8,
    |draw| draw - draw / 16,
    |draw| draw - draw / 32,
    |draw| draw - draw / 128,
];

impl<T: std::fmt::Debug> ValueTree for DrawTree<T> {
    type Value = T;

    fn current(&self) -> T {
        self.domain.of_draws(&self.draws)
    }

    fn simplify(&mut self) -> bool {
        // Reached again without `complicate`: the last step was kept.
        if self.undo.take().is_some() {
            self.moved = true;
        }
        loop {
            if self.at == self.draws.len() {
                if !self.moved {
                    return false;
                }
                (self.at, self.stage, self.moved) = (0, 0, false);
                continue;
            }
            if self.stage == STAGES.len() {
                (self.at, self.stage) = (self.at + 1, 0);
                continue;
            }
            let draw = self.draws[self.at];
            let simpler = STAGES[self.stage](draw);
            self.stage += 1;
            if simpler != draw {
                self.undo = Some((self.at, draw));
                self.draws[self.at] = simpler;
                return true;
            }
        }
    }

    fn complicate(&mut self) -> bool {
        match self.undo.take() {
            None => false,
            Some((at, draw)) => {
                self.draws[at] = draw;
                true
            }
        }
    }
}

impl<T> std::fmt::Debug for DrawTree<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DrawTree").field("draws", &self.draws).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_the_same_alone_as_in_its_run() {
        let domain = Domain::new(|draws| (draws.signed(-126, 127), draws.unit_vector()));
        for row in 0..1000 {
            assert_eq!(domain.row(7, row), domain.tree(7, row).current());
        }
    }

    #[test]
    fn shrinking_finds_the_edge_of_a_failure() {
        // Fails above 1000 whatever the sign: the smallest failing magnitude is the edge itself.
        let domain = Domain::new(|draws| draws.signed(-20, 20));
        let fails = |value: f32| value.abs() > 1000.0;
        let row = (0..).find(|row| fails(domain.row(3, *row))).expect("some row fails");
        let mut tree = domain.tree(3, row);
        while tree.simplify() {
            if !fails(tree.current()) {
                tree.complicate();
            }
        }
        assert!((1000.0..1100.0).contains(&tree.current()), "{}", tree.current());
    }

    #[test]
    fn it_serves_as_a_proptest_strategy() {
        let mut runner = TestRunner::deterministic();
        let domain = Domain::new(|draws| draws.between(-1.0, 1.0));
        runner
            .run(&domain, |value| {
                proptest::prop_assert!((-1.0..=1.0).contains(&value));
                Ok(())
            })
            .expect("in range");
    }
}
