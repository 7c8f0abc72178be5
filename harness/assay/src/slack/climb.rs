//! The worst that a device may make of one row: the shares by which its operations err, turned one by one as long as that makes it worse.

use super::device::{Device, Direction, Habit, Mode};
use crate::draws::mix;
use crate::formula::{Formula, Words};
use crate::interpreter::{Program, Registers, Stopped};
use crate::property::alone::verdict;
use crate::tolerance::Tolerance;
use rayon::prelude::*;

/// Sets of shares that a climb starts from.
const STARTS: u64 = 4;

/// Rounds over all operations in a climb.
const ROUNDS: usize = 3;

/// Groups of operations, one after the other, that are turned together where there are more of them.
const GROUPS: usize = 128;

/// Operations that all climbs of a function may take together.
const MOST_OPERATIONS: usize = 200_000_000;

/// The worst found.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Its error over the allowed one.
    pub ratio: f64,
    /// The input.
    pub arguments: Words,
    /// The result there.
    pub result: Words,
}

/// Climbs from each of `rows`, from the first ones where the function takes long, and returns the worst of all; none where there is no row, or one takes too long.
///
/// # Errors
/// Where the interpreter cannot run the function, or a row does not end.
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

/// How many rows may be climbed from: none where one takes too long.
fn affordable(program: &Program, row: &[u32]) -> Result<usize, Stopped> {
    let mut device = Device::new(Mode::IDENTITY, 0);
    let steps = program.run(row, &mut device, &mut Words::new())?.max(1) as usize;
    Ok(MOST_OPERATIONS / (steps * device.operations().clamp(1, GROUPS) * ROUNDS * STARTS as usize))
}

/// The other way, each.
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
    /// The error over the allowed one, the result, and how many operations there were. What `backward` allows is left out, which takes a search, but where a
    /// flag or an integer differs: there nothing else tells one result from a worse one.
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
            // What is right for an input nearby is right.
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
