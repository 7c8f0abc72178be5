//! Search for the worst result that a device may return for one row. It flips the operations'
//! shares of the allowed error one by one as long as the result gets worse.

use super::device::{Device, Direction, Habit, Mode};
use crate::draws::mix;
use crate::formula::{Formula, Words};
use crate::interpreter::{Program, Registers, Stopped};
use crate::property::alone::verdict;
use crate::tolerance::Tolerance;
use rayon::prelude::*;

/// Sets of shares from which a climb starts.
const STARTS: u64 = 4;

/// Passes over all operations in a climb.
const ROUNDS: usize = 3;

/// Most groups in a climb. If there are more operations, consecutive ones are flipped together.
const GROUPS: usize = 128;

/// Most operations of all climbs of a function together.
const MOST_OPERATIONS: usize = 200_000_000;

/// The worst result found.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Ratio of its error to the allowed error.
    pub ratio: f64,
    /// Its input.
    pub arguments: Words,
    /// Result at that input.
    pub result: Words,
}

/// Climbs from each of `rows`, or only from the first ones if the function takes long, and returns
/// the worst result of all. Returns `None` if there is no row or the first row takes too long.
///
/// # Errors
/// Returns an error if the interpreter cannot run the function, or a row does not end.
pub fn worst(
    program: &Program,
    formula: &Formula,
    tolerance: &Tolerance,
    seed: u64,
    rows: &[Words],
) -> Result<Option<Worst>, Stopped> {
    let Some(first) = rows.first() else { return Ok(None) };
    let rows = &rows[..rows.len().min(affordable(program, first)?)];
    let registers = program.registers()?;
    let found: Vec<Worst> = rows
        .par_iter()
        .map_init(
            || registers.clone(),
            |registers, row| Climb { program, formula, tolerance, row, exact: formula.exact(row), registers }.run(seed),
        )
        .collect::<Result<_, Stopped>>()?;
    Ok(found.into_iter().reduce(|worst, next| if next.ratio > worst.ratio { next } else { worst }))
}

/// Returns the number of rows that the budget allows; 0 if one takes too long.
fn affordable(program: &Program, row: &[u32]) -> Result<usize, Stopped> {
    let mut device = Device::new(Mode::IDENTITY, 0);
    let steps = program.run(row, &mut device, &mut Words::new())?.max(1) as usize;
    Ok(MOST_OPERATIONS / (steps * device.operations().clamp(1, GROUPS) * ROUNDS * STARTS as usize))
}

/// Flips the sign of each share.
fn turn(shares: &mut [f32]) {
    shares.iter_mut().for_each(|share| *share = -*share);
}

/// The search for the worst shares at one input.
struct Climb<'a> {
    program: &'a Program,
    formula: &'a Formula,
    tolerance: &'a Tolerance,
    row: &'a Words,
    exact: Vec<f64>,
    registers: &'a mut Registers,
}

impl Climb<'_> {
    /// Returns the ratio of the error to the allowed error, the result, and the number of
    /// operations. The ratio leaves out the allowance of `backward`, which takes a search, unless it
    /// would be infinite, as for a flag that differs: then nothing else tells one result from a worse
    /// one.
    fn forward(&mut self, mode: Mode, key: u64, shares: &[f32]) -> Result<(f64, Words, usize), Stopped> {
        let mut device = Device::with_shares(mode, key, shares);
        let mut result = Words::new();
        self.program.run_in(self.registers, self.row, &mut device, &mut result)?;
        let forward = self.tolerance.forward(&result, &self.exact);
        let ratio = if forward.is_finite() {
            forward
        } else {
            verdict(self.formula, self.tolerance, self.row, &result, false).ratio
        };
        Ok((ratio, result, device.operations()))
    }

    fn run(&mut self, seed: u64) -> Result<Worst, Stopped> {
        let (_, _, operations) = self.forward(Mode::IDENTITY, seed, &[])?;
        let size = operations.div_ceil(GROUPS).max(1);
        let (mut worst, mut at_worst) = (0.0, Words::new());
        for start in 0..STARTS {
            let key = mix(seed ^ mix(start));
            let mut chance = key;
            let fuses = [Habit::Never, Habit::Always, Habit::Sometimes, Habit::Sometimes][start as usize % 4];
            let mode = Mode { direction: Direction::Extreme, fuses, ..Mode::IDENTITY };
            let mut shares: Vec<f32> = (0..operations)
                .map(|_| {
                    chance = mix(chance);
                    if chance & 1 == 0 { 1.0 } else { -1.0 }
                })
                .collect();
            let (mut ratio, mut result, _) = self.forward(mode, key, &shares)?;
            for _ in 0..ROUNDS {
                let before = ratio;
                for group in (0..operations).step_by(size) {
                    let group = group..(group + size).min(operations);
                    turn(&mut shares[group.clone()]);
                    let (next, words, _) = self.forward(mode, key, &shares)?;
                    if next > ratio {
                        (ratio, result) = (next, words);
                    } else {
                        turn(&mut shares[group]);
                    }
                }
                if ratio == before {
                    break;
                }
            }
            // A result that is right for a nearby input is right.
            if ratio > 1.0 {
                ratio = verdict(self.formula, self.tolerance, self.row, &result, true).ratio;
            }
            if ratio > worst {
                (worst, at_worst) = (ratio, result);
            }
        }
        Ok(Worst { ratio: worst, arguments: self.row.clone(), result: at_worst })
    }
}
