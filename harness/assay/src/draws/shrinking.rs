//! Domains and proptest: a domain is a strategy that shrinks failing values through their draws;
//! conversely, a strategy makes a domain.

use super::tree::{MakeTree, Seed, Tree};
use super::{Domain, Draws};
use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::fmt::Debug;
use std::sync::Arc;

impl<T: Debug + 'static> Domain<T> {
    /// Creates the domain of a proptest strategy. The strategy's own tree shrinks a failing value.
    ///
    /// # Panics
    /// Panics when a value is requested and the strategy has no value, for example after too many
    /// rejections by a filter.
    pub fn of_strategy(strategy: impl Strategy<Value = T> + Send + Sync + 'static) -> Self
    where
        T: Send + Sync,
    {
        let strategy = strategy.sboxed();
        let tree: MakeTree<T> = Arc::new(move |seed: Seed| {
            let mut runner = runner(seed);
            let tree = strategy.new_tree(&mut runner);
            Box::new(tree.unwrap_or_else(|reason| panic!("the strategy gives no value: {reason}")))
        });
        let generate = {
            let tree = Arc::clone(&tree);
            Arc::new(move |draws: &mut Draws<'_>| tree(seed(draws)).current())
        };
        Self { generate, tree: Some(tree) }
    }

    /// Returns the tree of row `row`, for shrinking.
    pub fn tree(&self, seed: u64, row: u64) -> Tree<T> {
        if let Some(tree) = &self.tree {
            return tree(self::seed(&mut Draws::of_row(seed, row)));
        }
        let draws = self.draws(seed, row);
        Box::new(DrawTree { domain: self.clone(), draws, at: 0, stage: 0, undo: None, moved: false })
    }
}

fn seed(draws: &mut Draws<'_>) -> Seed {
    std::array::from_fn(|_| draws.bits())
}

/// Creates a runner whose random numbers follow from `seed`.
fn runner(seed: Seed) -> TestRunner {
    let bytes: Vec<u8> = seed.iter().flat_map(|word| word.to_le_bytes()).collect();
    TestRunner::new_with_rng(Config::default(), TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
}

impl<T: Debug + 'static> Strategy for Domain<T> {
    type Tree = Tree<T>;
    type Value = T;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        use proptest::prelude::Rng as _;
        let seed = runner.rng().next_u64();
        Ok(self.tree(seed, 0))
    }
}

/// A value with the draws behind it. Each draw in turn is tried at 0, then with ever fewer of its
/// low bits cleared, then at a half of itself and less by ever smaller fractions. A value that still
/// fails is kept, and rounds continue until one changes nothing.
struct DrawTree<T> {
    domain: Domain<T>,
    draws: Vec<u32>,
    at: usize,
    stage: usize,
    undo: Option<(usize, u32)>,
    moved: bool,
}

/// Attempts for a draw, from the boldest to the smallest step.
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
        // Called again without `complicate`: the last step was kept.
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
            Some((place, draw)) => {
                self.draws[place] = draw;
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
        // Fails above 1000 for either sign: the smallest failing magnitude is the edge itself.
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
