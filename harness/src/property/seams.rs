//! Continuity: both sides of every branch, one ulp apart.
//!
//! The interpreter says which way a function goes at each of its branches. Where two inputs go different ways, the place between them at which
//! the way changes is found by halving: one of the draws that an input is made of is halved, so that all inputs on the way lie in the domain,
//! and then one float, down to neighbours. Both sides are held to the function's tolerance, like any input. Then they are within their bounds of
//! each other as well, provided that the mathematics does not jump there ([`jump`]); and that is asked of the oracle, in the f64 between the two.

use super::draws::mix;
use super::tolerance::{Tolerance, number, ulp_of};
use crate::check::spell;
use crate::dispatch::shape::{Scalar, Shape};
use crate::dispatch::{DispatchError, Kernel};
use crate::formula::{Formula, Words};
use crate::interpreter::{Decision, Program, Site, Stopped, Traced};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Pairs of inputs that are tried, and fewer for a function that takes long: what that comes to in statements.
const MOST_ATTEMPTS: u64 = 800;
const MOST_STATEMENTS: u64 = 400_000;

/// Runs of the function that finding one seam takes, about.
const RUNS: u64 = 40;

/// Seams that are kept of one branch.
const MOST_OF_A_BRANCH: usize = 16;

/// How far apart the inputs of two neighbouring draws may be, in ulp of a vector's largest component: of a unit vector that is still one.
const NEIGHBOURS: f64 = 2.0;

/// Floats beyond either side that are tested as well: where a device rounds otherwise, the way may change there.
const BESIDE: usize = 2;

/// The way that a function goes on one input.
type Way = Vec<Decision>;

/// Two neighbouring inputs on either side of a branch.
#[derive(Clone, Debug)]
pub struct Seam {
    /// Which branch.
    pub site: Site,
    /// The inputs: they differ in one word.
    pub sides: [Words; 2],
    /// Which word that is.
    pub word: usize,
}

/// Finds inputs on either side of as many branches as random inputs lead to.
pub fn find(program: &Program, formula: &Formula, seed: u64) -> Result<Vec<Seam>, Stopped> {
    let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
    let statements = program.run(&formula.domain.row(seed, 0), &mut Traced::default(), &mut Vec::new())?;
    let attempts = (MOST_STATEMENTS / (RUNS * statements.max(1))).clamp(8, MOST_ATTEMPTS);
    let search = Finder { program, formula, scalars };
    let found: Vec<Option<Seam>> = (0..attempts)
        .into_par_iter()
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
        self.between(&at(near), &at(far))
    }

    /// From a row to the same with one float moved by an ulp: this is how a branch is met that only one number takes.
    fn nudge(&self, seed: u64, attempt: u64) -> Result<Option<Seam>, Stopped> {
        let row = self.formula.domain.row(seed, attempt);
        let chance = mix(seed ^ mix(!attempt));
        let word = (chance % row.len() as u64) as usize;
        let value = f32::from_bits(row[word]);
        // Zero is exact, and has no last place.
        if self.scalars[word] != Scalar::F32 || !value.is_normal() {
            return Ok(None);
        }
        let mut moved = row.clone();
        moved[word] = if chance >> 63 == 0 { value.next_up() } else { value.next_down() }.to_bits();
        self.seam(row, moved, word)
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
            // Here the way changes: down to neighbouring floats.
            loop {
                let (one, other) = (f32::from_bits(row[word]), f32::from_bits(moved[word]));
                let next = if one < other { one.next_up() } else { one.next_down() };
                if next == other {
                    return self.seam(row, moved, word);
                }
                let mut between = row.clone();
                between[word] = next.to_bits();
                if self.way(&between)? == way { row = between } else { moved = between }
            }
        }
        Ok(None)
    }

    fn seam(&self, one: Words, other: Words, word: usize) -> Result<Option<Seam>, Stopped> {
        let (way, other_way) = (self.way(&one)?, self.way(&other)?);
        let parting = way.iter().zip(&other_way).find(|(one, other)| one != other);
        Ok(parting.map(|(decision, _)| Seam { site: decision.site, sides: [one, other], word }))
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

/// What the shader breaks at seams, in a sentence each: a side that is off by more than its tolerance or breaks an invariant.
pub fn faults(
    program: &Program,
    formula: &Formula,
    kernel: &mut Kernel<'_>,
    tolerance: &Tolerance,
    seams: &[Seam],
) -> Result<Vec<String>, DispatchError> {
    let mut faults = Vec::new();
    let rows: Vec<Words> = seams.iter().flat_map(beside).collect();
    if rows.is_empty() {
        return Ok(faults);
    }
    let mut results = Words::new();
    kernel.run(&rows.concat(), &mut results)?;
    let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
    let rows_of_a_seam = rows.len() / seams.len();
    for (index, (row, result)) in rows.iter().zip(results.chunks_exact(formula.result.words())).enumerate() {
        let numbers: Vec<f64> = row.iter().zip(&scalars).map(|(word, scalar)| number(*scalar, *word)).collect();
        let (mut mirrored, mut exact) = (Words::new(), Vec::new());
        (formula.mirror)(row, &mut mirrored);
        (formula.oracle)(&numbers, &mut exact);
        let verdict = tolerance.judge(row, result, &mirrored, &exact, &*formula.oracle);
        let broken = formula.invariants.iter().find_map(|invariant| (invariant.holds)(row, result).err());
        let fault = match broken {
            Some(broken) => broken,
            None if verdict.nonfinite => "the result is not finite".to_owned(),
            None if !verdict.holds() => format!("off by {:.1} times the allowed error", verdict.ratio),
            None => continue,
        };
        let line = program.line(seams[index / rows_of_a_seam].site);
        faults.push(format!("beside the branch `{line}`: {fault} at {}", spell(formula, row)));
    }
    Ok(faults)
}

/// A seam's sides and the next floats beyond each.
fn beside(seam: &Seam) -> Vec<Words> {
    let [one, other] = seam.sides.each_ref().map(|side| f32::from_bits(side[seam.word]));
    let step = |value: f32, up: bool| if up { value.next_up() } else { value.next_down() };
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
/// of a continuous function nothing. None where a discrete result changes, which says so itself.
pub fn jump(formula: &Formula, tolerance: &Tolerance, seam: &Seam) -> Option<f64> {
    let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
    let numbers = |side: &Words| -> Vec<f64> { side.iter().zip(&scalars).map(|(w, s)| number(*s, *w)).collect() };
    let [start, end] = seam.sides.each_ref().map(numbers);
    let at = |place: f64| {
        let mut point = start.clone();
        point[seam.word] = place;
        let mut exact = Vec::new();
        (formula.oracle)(&point, &mut exact);
        exact
    };
    let (mut low, mut high) = (start[seam.word], end[seam.word]);
    let (mut at_low, mut at_high) = (at(low), at(high));
    loop {
        if tolerance.discrete_differ(&at_low, &at_high) {
            return None;
        }
        let excess = tolerance.apart(&at_low, &at_high)?;
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            return Some(excess);
        }
        let at_middle = at(middle);
        let below = tolerance.apart(&at_low, &at_middle).unwrap_or(0.0);
        if below >= tolerance.apart(&at_middle, &at_high).unwrap_or(0.0) {
            (high, at_high) = (middle, at_middle);
        } else {
            (low, at_low) = (middle, at_middle);
        }
    }
}
