//! Rows of a function on devices that err as far as WGSL allows.

use super::device::{Device, Mode};
use crate::dispatch::DispatchError;
use crate::draws::mix;
use crate::interpreter::{Assumption, Program, Registers, Stopped};
use crate::runner::Runner;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Rows that one thread takes at a time.
const ROWS_PER_TASK: usize = 256;

/// Orders of the chains of sums and products, if they are reordered.
const ORDERS: u64 = 16;

/// Order of chains of sums and of products.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reassociation {
    /// As written.
    Written,
    /// Changed.
    Reordered,
}

/// A function that runs each row on a different device that WGSL allows. The row determines the
/// device, so the same row gives the same result.
#[derive(Debug)]
pub struct Slackened {
    programs: Vec<Program>,
    words: [usize; 2],
    seed: u64,
    assumptions: BTreeSet<Assumption>,
    stopped: Vec<bool>,
    why: Option<Stopped>,
}

/// Results of one task's rows.
struct Part {
    results: Vec<u32>,
    stopped: Vec<bool>,
    assumptions: BTreeSet<Assumption>,
    why: Option<Stopped>,
}

impl Slackened {
    /// Compiles the named function of WGSL source. `path` appears in messages, and `seed`
    /// determines the devices' choices.
    ///
    /// # Errors
    /// Returns an error if the source is not valid, or uses a feature that the interpreter lacks.
    pub fn new(
        source: &str,
        path: &str,
        function: &str,
        seed: u64,
        reassociation: Reassociation,
    ) -> Result<Slackened, DispatchError> {
        let program = Program::new(source, path, function)?;
        let programs = match reassociation {
            Reassociation::Written => vec![program],
            Reassociation::Reordered => (0..ORDERS).map(|order| program.reassociated(mix(seed ^ order))).collect(),
        };
        let slackened = Self::of_programs(programs, seed);
        slackened.map_err(|stopped| DispatchError::Fault { line: None, message: stopped.to_string() })
    }

    /// Wraps a compiled function.
    ///
    /// # Errors
    /// Returns an error if the function uses a feature that the interpreter lacks.
    pub fn of_program(program: Program, seed: u64) -> Result<Slackened, Stopped> {
        Self::of_programs(vec![program], seed)
    }

    fn of_programs(programs: Vec<Program>, seed: u64) -> Result<Slackened, Stopped> {
        let words = programs[0].words()?;
        Ok(Slackened { programs, words, seed, assumptions: BTreeSet::new(), stopped: Vec::new(), why: None })
    }

    /// Returns the function in the first of its orders.
    pub(super) fn program(&self) -> &Program {
        &self.programs[0]
    }

    /// Returns the assumptions made so far in cases on which the standard is silent.
    pub fn assumptions(&self) -> &BTreeSet<Assumption> {
        &self.assumptions
    }

    /// Returns a row's key, computed from its words: every run of the row gets the same device.
    fn key(&self, row: &[u32]) -> u64 {
        row.iter().fold(mix(self.seed), |key, word| mix(key ^ u64::from(*word)))
    }

    fn part(&self, registers: &mut [Registers], rows: &[u32]) -> Part {
        let mut part = Part { results: Vec::new(), stopped: Vec::new(), assumptions: BTreeSet::new(), why: None };
        for row in rows.chunks_exact(self.words[0]) {
            let key = self.key(row);
            let mut device = Device::new(Mode::of(key), mix(key));
            let order = (key >> 32) as usize % self.programs.len();
            let before = part.results.len();
            let ran = self.programs[order].run_in(&mut registers[order], row, &mut device, &mut part.results);
            part.stopped.push(ran.is_err());
            part.assumptions.extend(device.assumptions());
            if let Err(why) = ran {
                part.results.resize(before + self.words[1], 0);
                part.why = Some(why);
            }
        }
        part
    }
}

impl Runner for Slackened {
    fn argument_words(&self) -> usize {
        self.words[0]
    }

    fn result_words(&self) -> usize {
        self.words[1]
    }

    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        let registers: Vec<Registers> = self.programs.iter().map_while(|program| program.registers().ok()).collect();
        let parts: Vec<Part> = arguments
            .par_chunks(ROWS_PER_TASK * self.words[0])
            .map_init(|| registers.clone(), |registers, rows| self.part(registers, rows))
            .collect();
        results.clear();
        self.stopped.clear();
        for part in parts {
            results.extend(part.results);
            self.stopped.extend(part.stopped);
            self.assumptions.extend(part.assumptions);
            self.why = part.why.or(self.why.take());
        }
        Ok(())
    }

    fn is_portable(&self) -> bool {
        true
    }

    fn loops(&self) -> bool {
        self.programs.iter().any(Program::loops)
    }

    fn stopped(&self, row: usize) -> bool {
        self.stopped.get(row).copied().unwrap_or(false)
    }

    fn any_stopped(&self) -> bool {
        self.stopped.contains(&true)
    }

    fn why_stopped(&self) -> String {
        self.why.as_ref().map_or_else(String::new, ToString::to_string)
    }
}
