//! The worst that a device may make of a function: every operation errs as far as WGSL lets it, in the directions that add up.
//!
//! What the reference device computes says little of other devices. The `portable` bounds are held to this instead.

use crate::draws::mix;
use crate::formula::{Formula, Words};
use crate::interpreter::{Program, Slacking, Stopped};
use crate::tolerance::Tolerance;
use rayon::prelude::*;

/// Sets of directions that a climb starts from.
const STARTS: u64 = 4;

/// Rounds over all operations in a climb.
const ROUNDS: usize = 3;

/// The worst found.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Its error over the allowed one.
    pub ratio: f64,
    /// The input.
    pub arguments: Words,
}

/// Searches `rows` random inputs, and those of the hard cases, for the largest error over the allowed one.
pub fn worst(
    program: &Program,
    formula: &Formula,
    tolerance: &Tolerance,
    seed: u64,
    rows: u64,
) -> Result<Worst, Stopped> {
    let random = (0..rows).into_par_iter().map(|row| formula.domain.row(seed, row));
    let hard = formula.hard_cases.par_iter().map(|case| case.arguments.clone());
    let found: Vec<Worst> = random
        .chain(hard)
        .map(|arguments| {
            let exact = formula.exact(&arguments);
            let climb = Climb { program, formula, tolerance, arguments: &arguments, exact };
            let ratio = climb.run(seed)?;
            Ok(Worst { ratio, arguments })
        })
        .collect::<Result<_, Stopped>>()?;
    let least = Worst { ratio: 0.0, arguments: Words::new() };
    Ok(found.into_iter().fold(least, |worst, next| if next.ratio > worst.ratio { next } else { worst }))
}

/// The search for the worst directions at one input.
struct Climb<'a> {
    program: &'a Program,
    formula: &'a Formula,
    tolerance: &'a Tolerance,
    arguments: &'a Words,
    exact: Vec<f64>,
}

impl Climb<'_> {
    /// The error over the allowed one, without what `backward` allows, and how many operations there were.
    fn forward(&self, directions: &[f64]) -> Result<(f64, Words, usize), Stopped> {
        let mut machine = Slacking::new(directions.to_vec());
        let mut result = Words::new();
        self.program.run(self.arguments, &mut machine, &mut result)?;
        let ratio = self.tolerance.forward(&result, &self.exact);
        Ok((ratio, result, machine.operations()))
    }

    fn run(&self, seed: u64) -> Result<f64, Stopped> {
        let (_, _, operations) = self.forward(&[])?;
        let (mut worst, mut at_worst) = (0.0, Words::new());
        for start in 0..STARTS {
            let mut chance = mix(seed ^ mix(start));
            let mut directions: Vec<f64> = (0..operations)
                .map(|_| {
                    chance = mix(chance);
                    if chance & 1 == 0 { 1.0 } else { -1.0 }
                })
                .collect();
            let (mut ratio, mut result, _) = self.forward(&directions)?;
            for _ in 0..ROUNDS {
                let before = ratio;
                for turned in 0..operations {
                    directions[turned] = -directions[turned];
                    let (next, words, _) = self.forward(&directions)?;
                    if next > ratio {
                        (ratio, result) = (next, words);
                    } else {
                        directions[turned] = -directions[turned];
                    }
                }
                if ratio == before {
                    break;
                }
            }
            if ratio > worst {
                (worst, at_worst) = (ratio, result);
            }
        }
        // What is right for an input nearby is right.
        if worst > 1.0 {
            let oracle = &*self.formula.oracle;
            worst = self.tolerance.judge(self.arguments, &at_worst, &at_worst, &self.exact, oracle).ratio;
        }
        Ok(worst)
    }
}
