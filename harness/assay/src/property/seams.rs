//! Continuity: both sides of every branch, one ulp apart.
//!
//! The interpreter says which way a function goes at each of its branches. Where two inputs go different ways, the place between them at which
//! the way changes is found by halving: one of the draws that an input is made of is halved, so that all inputs on the way lie in the domain,
//! and then one float, down to neighbours. Both sides are held to the function's tolerance, like any input. Then they are within their bounds of
//! each other as well, provided that the mathematics does not jump there ([`jump`]); and that is asked of the oracle, in the f64 between the two.

use super::alone;
use crate::dispatch::DispatchError;
use crate::draws::mix;
use crate::formula::{Formula, Words};
use crate::interpreter::{Decision, Program, Site, Stopped, Traced};
use crate::literal::{self, Language};
use crate::runner::Runner;
use crate::shape::{Scalar, Shape};
use crate::tolerance::{Tolerance, number, ulp_of};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Pairs of inputs that are tried, and fewer for a function that takes long: what that comes to in operations.
const MOST_ATTEMPTS: u64 = 4_000;
const MOST_OPERATIONS: u64 = 8_000_000;

/// Runs of the function that finding one seam takes, about.
const RUNS: u64 = 40;

/// Seams that are kept of one branch.
const MOST_OF_A_BRANCH: usize = 16;

/// How far apart the inputs of two neighbouring draws may be, in ulp of a vector's largest component: of a unit vector that is still one.
const NEIGHBOURS: f64 = 2.0;

/// Faults that are searched for thoroughly before the rest are taken as they are.
const ENOUGH_FAULTS: usize = 16;

/// Halvings of the way between two neighbouring floats: far fewer than f64 resolves there.
const HALVINGS: usize = 20;

/// Floats beyond either side that are tested as well: where a device rounds otherwise, the way may change there.
const BESIDE: usize = 2;

/// The way that a function goes on one input.
type Way = Vec<Decision>;

/// Two neighbouring inputs on either side of a branch.
#[derive(Clone, Debug)]
pub struct Seam {
    /// Which branch: the first that goes another way.
    pub site: Site,
    /// All that go another way, as far as both sides run the same statements.
    pub parted: Vec<Site>,
    /// The inputs: they differ in one word.
    pub sides: [Words; 2],
    /// Which word that is.
    pub word: usize,
    /// The inputs that were drawn on the way to it: they lie in the domain, where a float moved alone may have left it.
    pub drawn: Vec<Words>,
}

/// Finds inputs on either side of as many branches as random inputs lead to.
pub fn find(program: &Program, formula: &Formula, seed: u64) -> Result<Vec<Seam>, Stopped> {
    let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
    let operations = program.run(&formula.domain.row(seed, 0), &mut Traced::default(), &mut Vec::new())?;
    let attempts = (MOST_OPERATIONS / (RUNS * operations.max(1))).clamp(8, MOST_ATTEMPTS);
    let search = Finder { program, formula, scalars };
    let found: Vec<Option<Seam>> = (0..attempts)
        .into_par_iter()
        // The draws of a strategy's value are its generator's seed, half of which leads nowhere.
        .filter(|attempt| attempt % 4 == 0 || !formula.domain.is_of_strategy())
        .map(|attempt| if attempt % 4 == 0 { search.nudge(seed, attempt) } else { search.halve(seed, attempt) })
        .collect::<Result<_, _>>()?;
    let mut kept: BTreeMap<Site, usize> = BTreeMap::new();
    let mut is_new = |seam: &Seam| {
        let count = kept.entry(seam.site).or_default();
        *count += 1;
        *count <= MOST_OF_A_BRANCH
    };
    Ok(found.into_iter().flatten().filter(|seam| is_new(seam)).collect())
}

struct Finder<'a> {
    program: &'a Program,
    formula: &'a Formula,
    scalars: Vec<Scalar>,
}

impl Finder<'_> {
    fn way(&self, arguments: &[u32]) -> Result<Way, Stopped> {
        let mut traced = Traced::default();
        self.program.run(arguments, &mut traced, &mut Vec::new())?;
        Ok(traced.decisions)
    }

    /// From a row to the same with one draw replaced.
    fn halve(&self, seed: u64, attempt: u64) -> Result<Option<Seam>, Stopped> {
        let domain = &self.formula.domain;
        let mut draws = domain.draws(seed, attempt);
        if draws.is_empty() {
            return Ok(None);
        }
        let chance = mix(seed ^ mix(!attempt));
        let moving = (chance % draws.len() as u64) as usize;
        let [mut near, mut far] = [draws[moving], (chance >> 32) as u32];
        let mut at = |place: u32| {
            draws[moving] = place;
            domain.of_draws(&draws)
        };
        let (way_near, way_far) = (self.way(&at(near))?, self.way(&at(far))?);
        if way_near == way_far {
            return Ok(None);
        }
        while near.abs_diff(far) > 1 {
            let middle = near.midpoint(far);
            if self.way(&at(middle))? == way_near { near = middle } else { far = middle }
        }
        let drawn = [at(near), at(far)];
        Ok(self.between(&drawn[0], &drawn[1])?.map(|seam| Seam { drawn: drawn.to_vec(), ..seam }))
    }

    /// From a row to the same with one float moved by an ulp: this is how a branch is met that only one number takes.
    fn nudge(&self, seed: u64, attempt: u64) -> Result<Option<Seam>, Stopped> {
        let row = self.formula.domain.row(seed, attempt);
        if row.is_empty() {
            return Ok(None);
        }
        let chance = mix(seed ^ mix(!attempt));
        let word = (chance % row.len() as u64) as usize;
        let value = f32::from_bits(row[word]);
        if self.scalars[word] != Scalar::F32 || !value.is_normal() && value != 0.0 {
            return Ok(None);
        }
        let mut moved = row.clone();
        moved[word] = step(value, chance >> 63 == 0).to_bits();
        let drawn = vec![row.clone()];
        Ok(self.seam(row, moved, word)?.map(|seam| Seam { drawn, ..seam }))
    }

    /// The seam between two rows that are all but equal, float by float.
    fn between(&self, near: &Words, far: &Words) -> Result<Option<Seam>, Stopped> {
        if !self.are_neighbours(near, far) {
            return Ok(None);
        }
        let way = self.way(near)?;
        let mut row = near.clone();
        for word in 0..near.len() {
            if row[word] == far[word] {
                continue;
            }
            let mut moved = row.clone();
            moved[word] = far[word];
            if self.way(&moved)? == way {
                row = moved;
                continue;
            }
            // Here the way changes: down to neighbouring floats. Beside a large component there are billions of them about 0.
            let [mut one, mut other] = [row[word], moved[word]].map(ordered);
            while one.abs_diff(other) > 1 {
                let middle = one.midpoint(other);
                row[word] = unordered(middle);
                if self.way(&row)? == way { one = middle } else { other = middle }
            }
            (row[word], moved[word]) = (unordered(one), unordered(other));
            return self.seam(row, moved, word);
        }
        Ok(None)
    }

    fn seam(&self, one: Words, other: Words, word: usize) -> Result<Option<Seam>, Stopped> {
        let (way, other_way) = (self.way(&one)?, self.way(&other)?);
        let together = way.iter().zip(&other_way).take_while(|(one, other)| one.site == other.site);
        let parted: Vec<Site> = together.filter(|(one, other)| one != other).map(|(one, _)| one.site).collect();
        Ok(parted.first().map(|site| Seam {
            site: *site,
            parted: parted.clone(),
            sides: [one, other],
            word,
            drawn: Vec::new(),
        }))
    }

    fn are_neighbours(&self, near: &Words, far: &Words) -> bool {
        let mut start = 0;
        self.formula.arguments.iter().flat_map(Shape::leaves).all(|leaf| {
            let words = start..start + leaf.length;
            start += leaf.length;
            let numbers =
                |row: &Words| -> Vec<f64> { row[words.clone()].iter().map(|w| number(leaf.scalar, *w)).collect() };
            let (near, far) = (numbers(near), numbers(far));
            let scale = near.iter().chain(&far).fold(0.0, |scale: f64, value| scale.max(value.abs()));
            let reach = if leaf.scalar == Scalar::F32 { NEIGHBOURS * ulp_of(scale) } else { 0.0 };
            // A NaN is nobody's neighbour.
            near.iter().zip(&far).all(|(near, far)| near == far || (near - far).abs() <= reach)
        })
    }
}

/// The next float; beside 0 the least that no device flushes.
fn step(value: f32, up: bool) -> f32 {
    let next = if up { value.next_up() } else { value.next_down() };
    if next.is_subnormal() && value == 0.0 { next.signum() * f32::MIN_POSITIVE } else { next }
}

/// A float's bits as a number that grows with it, both zeros apart.
fn ordered(bits: u32) -> u32 {
    if bits >> 31 == 0 { bits | 0x8000_0000 } else { !bits }
}

/// The float's bits again.
fn unordered(number: u32) -> u32 {
    if number >> 31 == 1 { number & 0x7fff_ffff } else { !number }
}

/// What the shader breaks beside a branch: a side that is off by more than its tolerance or breaks an invariant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The line that the branch is on.
    pub line: String,
    /// What, and at which input.
    pub what: String,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "beside the branch `{}`: {}", self.line, self.what)
    }
}

/// What the shader breaks at seams, at inputs beside each that `rows` gives: [`Seam::drawn`] or [`beside`].
pub fn faults(
    program: &Program,
    formula: &Formula,
    runner: &mut dyn Runner,
    tolerance: &Tolerance,
    seams: &[Seam],
    rows: impl Fn(&Seam) -> Vec<Words>,
) -> Result<Vec<Fault>, DispatchError> {
    let mut faults = Vec::new();
    let (rows, sites): (Vec<Words>, Vec<Site>) =
        seams.iter().flat_map(|seam| rows(seam).into_iter().map(|row| (row, seam.site))).unzip();
    if rows.is_empty() {
        return Ok(faults);
    }
    let mut results = Words::new();
    runner.run(&rows.concat(), &mut results)?;
    for ((row, site), result) in rows.iter().zip(sites).zip(results.chunks_exact(formula.result.words())) {
        // Of infinities the standard says nothing; halving goes on to where a device that knows none turns.
        if runner.is_portable() && !alone::is_stated(formula, row) {
            continue;
        }
        let judge = |thoroughly| alone::verdict_of(runner.is_portable(), formula, tolerance, row, result, thoroughly);
        // Of a function that is wrong everywhere a few faults are enough, and need no long search.
        let quick = judge(false);
        let verdict = if quick.holds() || faults.len() > ENOUGH_FAULTS { quick } else { judge(true) };
        let fault = match alone::broken(formula, row, result, runner.is_portable()) {
            Some((_, broken)) => broken,
            None if verdict.nonfinite => "the result is not finite".to_owned(),
            None if !verdict.holds() => format!("off by {:.1} times the allowed error", verdict.ratio),
            None => continue,
        };
        let line = program.line(site).to_owned();
        faults.push(Fault { line, what: format!("{fault} at {}", literal::call(Language::Wgsl, formula, row)) });
    }
    Ok(faults)
}

/// What `cook check` says of the branches of a formula's function in `source`: up to three faults, at inputs of the domain. Where the interpreter
/// cannot run the function, why.
pub fn of_source(
    source: &str,
    formula: &Formula,
    runner: &mut dyn Runner,
    tolerance: &Tolerance,
    seed: u64,
) -> Result<Result<Vec<Fault>, Stopped>, DispatchError> {
    let program = Program::new(source, formula.module, formula.function)?;
    let seams = match find(&program, formula, seed) {
        Ok(seams) => seams,
        Err(stopped) => return Ok(Err(stopped)),
    };
    let mut found = faults(&program, formula, runner, tolerance, &seams, |seam| seam.drawn.clone())?;
    found.sort_by(|one, other| one.line.cmp(&other.line));
    found.dedup_by(|one, other| one.line == other.line);
    found.truncate(3);
    Ok(Ok(found))
}

/// A seam's sides and the next floats beyond each.
pub fn beside(seam: &Seam) -> Vec<Words> {
    let [one, other] = seam.sides.each_ref().map(|side| f32::from_bits(side[seam.word]));
    let up = other > one;
    let mut rows = seam.sides.to_vec();
    for (side, start, up) in [(0, one, !up), (1, other, up)] {
        let mut value = start;
        for _ in 0..BESIDE {
            value = step(value, up);
            // Beyond 0 and beyond the largest float the other side of the domain may begin.
            let mut row = seam.sides[side].clone();
            row[seam.word] = if value.is_normal() { value } else { start }.to_bits();
            rows.push(row);
        }
    }
    rows
}

/// By how much the oracle jumps between a seam's sides, if by more than the tolerances of both allow: halving towards the greater change leaves
/// less and less of a continuous function, and all of a jump. None where a discrete result changes, which says so itself.
pub fn jump(formula: &Formula, tolerance: &Tolerance, seam: &Seam) -> Option<f64> {
    let [start, end] = seam.sides.each_ref().map(|side| formula.numbers(side));
    let at = |place: f64| {
        let mut point = start.clone();
        point[seam.word] = place;
        let mut exact = Vec::new();
        (formula.oracle)(&point, &mut exact);
        exact
    };
    let (mut low, mut high) = (start[seam.word], end[seam.word]);
    let (mut at_low, mut at_high) = (at(low), at(high));
    let all = tolerance.apart(&at_low, &at_high)?;
    let mut left = all;
    for _ in 0..HALVINGS {
        if tolerance.discrete_differ(&at_low, &at_high) {
            return None;
        }
        let middle = 0.5 * (low + high);
        let at_middle = at(middle);
        let below = tolerance.apart(&at_low, &at_middle).unwrap_or(0.0);
        let above = tolerance.apart(&at_middle, &at_high).unwrap_or(0.0);
        left = below.max(above);
        if below >= above {
            (high, at_high) = (middle, at_middle);
        } else {
            (low, at_low) = (middle, at_middle);
        }
    }
    (left >= all / 16.0).then_some(all)
}
