//! Continuity: both sides of every branch, one ulp apart.
//!
//! The interpreter records the path that a function takes through its branches. If two inputs take
//! different paths, bisection finds the place between them at which the path changes: first it
//! bisects one of the draws behind the input, so that all inputs on the way lie in the domain, and
//! then one float, down to neighbours. Both sides are held to the function's tolerance, like any
//! input. They are then within their bounds of each other as well, provided that the mathematics
//! does not jump there ([`jump`]); the oracle answers that, in f64 between the two.

use super::alone;
use crate::dispatch::DispatchError;
use crate::draws::mix;
use crate::formula::{Formula, Words};
use crate::interpreter::{Decision, Program, Site, Stopped, Traced};
use crate::literal::{self, Language};
use crate::order::{ordered, unordered};
use crate::runner::Runner;
use crate::shape::{Scalar, Shape};
use crate::tolerance::{Tolerance, number, ulp_of};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Maximum number of pairs of inputs to try; a slow function gets fewer, within the number of
/// operations below.
const MOST_ATTEMPTS: u64 = 4_000;
const MOST_OPERATIONS: u64 = 8_000_000;

/// Approximate number of runs of the function to find one seam.
const RUNS: u64 = 40;

/// Maximum number of seams kept for one branch.
const MOST_OF_A_BRANCH: usize = 16;

/// Largest distance between the inputs of two neighbouring draws, in ulp of a vector's largest
/// component; a unit vector is still one at this distance.
const NEIGHBOURS: f64 = 2.0;

/// Number of faults that are searched for thoroughly; the rest are taken as they are.
const ENOUGH_FAULTS: usize = 16;

/// Bisections between two neighbouring floats: far fewer than f64 resolves there.
const HALVINGS: usize = 20;

/// Floats beyond either side that are tested as well, since a device that rounds differently may
/// change its path there.
const BESIDE: usize = 2;

/// The path of a function on one input.
type Way = Vec<Decision>;

/// Two neighbouring inputs on either side of a branch.
#[derive(Clone, Debug)]
pub struct Seam {
    /// First branch at which the paths differ.
    pub site: Site,
    /// All branches at which the paths differ, as far as both sides run the same statements.
    pub parted: Vec<Site>,
    /// The two inputs, which differ in one word.
    pub sides: [Words; 2],
    /// Index of that word.
    pub word: usize,
    /// Inputs drawn on the way to the seam. They lie in the domain, which a float moved alone may
    /// have left.
    pub drawn: Vec<Words>,
}

/// Finds inputs on either side of as many branches as random inputs reach.
pub fn find(program: &Program, formula: &Formula, seed: u64) -> Result<Vec<Seam>, Stopped> {
    let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
    let operations = program.run(&formula.domain.row(seed, 0), &mut Traced::default(), &mut Vec::new())?;
    let attempts = (MOST_OPERATIONS / (RUNS * operations.max(1))).clamp(8, MOST_ATTEMPTS);
    let search = Finder { program, formula, scalars };
    let found: Vec<Option<Seam>> = (0..attempts)
        .into_par_iter()
        // The draws of a strategy's value seed its generator; bisecting them leads nowhere.
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

    /// Finds a seam between a row and the same row with one draw replaced.
    fn halve(&self, seed: u64, attempt: u64) -> Result<Option<Seam>, Stopped> {
        let domain = &self.formula.domain;
        let mut draws = domain.draws(seed, attempt);
        if draws.is_empty() {
            return Ok(None);
        }
        let chance = mix(seed ^ mix(!attempt));
        let moving = (chance % draws.len() as u64) as usize;
        let [mut near, mut far] = [draws[moving], (chance >> 32) as u32];
        let mut row_at = |place: u32| {
            draws[moving] = place;
            domain.of_draws(&draws)
        };
        let (way_near, way_far) = (self.way(&row_at(near))?, self.way(&row_at(far))?);
        if way_near == way_far {
            return Ok(None);
        }
        while near.abs_diff(far) > 1 {
            let middle = near.midpoint(far);
            if self.way(&row_at(middle))? == way_near { near = middle } else { far = middle }
        }
        let drawn = [row_at(near), row_at(far)];
        Ok(self.between(&drawn[0], &drawn[1])?.map(|seam| Seam { drawn: drawn.to_vec(), ..seam }))
    }

    /// Finds a seam between a row and the same row with one float moved by an ulp. This finds a
    /// branch that only one number takes.
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

    /// Finds the seam between two nearly equal rows, float by float.
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
            // The path changes here; bisection continues down to neighbouring floats. In a vector
            // with a large component, billions of floats lie around 0.
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
            // A NaN has no neighbours.
            near.iter().zip(&far).all(|(near, far)| near == far || (near - far).abs() <= reach)
        })
    }
}

/// Returns the next float; next to 0, the smallest one that no device flushes.
fn step(value: f32, up: bool) -> f32 {
    let next = if up { value.next_up() } else { value.next_down() };
    if next.is_subnormal() && value == 0.0 { next.signum() * f32::MIN_POSITIVE } else { next }
}

/// A fault of the shader next to a branch: a side exceeds its tolerance or breaks an invariant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Source line of the branch.
    pub line: String,
    /// The fault and its input.
    pub what: String,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "beside the branch `{}`: {}", self.line, self.what)
    }
}

/// Returns the faults of the shader at seams, at the inputs that `rows` gives for each:
/// [`Seam::drawn`] or [`beside`].
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
        // The standard says nothing about infinities; bisection leads to the point at which a
        // device without them changes its path.
        if runner.is_portable() && !alone::is_stated(formula, row) {
            continue;
        }
        let judge = |thoroughly| alone::verdict_of(runner.is_portable(), formula, tolerance, row, result, thoroughly);
        // For a function that is wrong everywhere a few faults suffice, without a long search.
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

/// Returns the faults that `cook check` reports for the branches of a formula's function in
/// `source`: up to three, at inputs of the domain. If the interpreter cannot run the function,
/// returns the reason.
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

/// Returns a seam's sides and the next floats beyond each.
pub fn beside(seam: &Seam) -> Vec<Words> {
    let [one, other] = seam.sides.each_ref().map(|side| f32::from_bits(side[seam.word]));
    let up = other > one;
    let mut rows = seam.sides.to_vec();
    for (side, start, up) in [(0, one, !up), (1, other, up)] {
        let mut value = start;
        for _ in 0..BESIDE {
            value = step(value, up);
            // Beyond 0 and beyond the largest float, the other side of the domain may begin.
            let mut row = seam.sides[side].clone();
            row[seam.word] = if value.is_normal() { value } else { start }.to_bits();
            rows.push(row);
        }
    }
    rows
}

/// Returns the jump of the oracle between a seam's sides, if it exceeds the tolerances of both.
/// Bisection towards the greater change keeps less and less of a continuous function's change, but
/// all of a jump. Returns `None` if a discrete result changes, which shows by itself.
pub fn jump(formula: &Formula, tolerance: &Tolerance, seam: &Seam) -> Option<f64> {
    let [start, end] = seam.sides.each_ref().map(|side| formula.numbers(side));
    let exact_at = |place: f64| {
        let mut point = start.clone();
        point[seam.word] = place;
        let mut exact = Vec::new();
        (formula.oracle)(&point, &mut exact);
        exact
    };
    let (mut low, mut high) = (start[seam.word], end[seam.word]);
    let (mut at_low, mut at_high) = (exact_at(low), exact_at(high));
    let all = tolerance.apart(&at_low, &at_high)?;
    let mut left = all;
    for _ in 0..HALVINGS {
        if tolerance.discrete_differ(&at_low, &at_high) {
            return None;
        }
        let middle = 0.5 * (low + high);
        let at_middle = exact_at(middle);
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
