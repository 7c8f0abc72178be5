//! A device that WGSL allows: it errs in every operation, within the limits of the standard.

use crate::draws::mix;
use crate::interpreter::{Assumption, Exact, Machine, Slack};
use std::collections::BTreeSet;

/// Direction in which operations err.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// No error: rounded to nearest.
    Nearest,
    /// All upwards.
    Up,
    /// All downwards.
    Down,
    /// All away from zero.
    Outward,
    /// All towards zero.
    Inward,
    /// Each as far as allowed, up or down.
    Extreme,
    /// Each by a random share of the allowed error.
    Share,
}

/// How often a device makes use of a choice, by operation: never, always or at times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Habit {
    /// Never.
    Never,
    /// Always.
    Always,
    /// At random.
    Sometimes,
}

/// The kind of device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// Direction of rounding.
    pub direction: Direction,
    /// Whether products enter sums unrounded.
    pub fuses: Habit,
    /// Whether subnormals become 0.
    pub flushes: Habit,
    /// Whether zeros lose their sign, and infinities and NaNs become any value.
    pub finite_math: Habit,
}

impl Mode {
    /// Rounds to nearest, fuses nothing, and keeps subnormals, signs of zeros, infinities and NaNs.
    pub const IDENTITY: Mode =
        Mode { direction: Direction::Nearest, fuses: Habit::Never, flushes: Habit::Never, finite_math: Habit::Never };

    /// Returns the mode that `chance` selects.
    pub fn of(chance: u64) -> Mode {
        use Direction::{Down, Extreme, Inward, Outward, Share, Up};
        let habit = |chance: u64| match chance & 3 {
            0 => Habit::Never,
            1 => Habit::Always,
            _ => Habit::Sometimes,
        };
        let directions = [Up, Down, Outward, Inward, Extreme, Extreme, Extreme, Share];
        Mode {
            direction: directions[(chance & 7) as usize],
            fuses: habit(chance >> 3),
            flushes: habit(chance >> 5),
            finite_math: if chance >> 7 & 3 == 0 { Habit::Never } else { Habit::Sometimes },
        }
    }
}

/// A device that WGSL allows, for one call.
#[derive(Clone, Debug)]
pub struct Device<'a> {
    mode: Mode,
    /// Shares of the allowed error, operation by operation; the mode's direction applies after
    /// them.
    shares: &'a [f32],
    key: u64,
    state: u64,
    operations: usize,
    assumptions: BTreeSet<Assumption>,
}

impl<'a> Device<'a> {
    /// Returns a device of the given mode with `key` as the seed of its choices.
    pub fn new(mode: Mode, key: u64) -> Self {
        Self::with_shares(mode, key, &[])
    }

    /// Returns a device with the given shares of the allowed error for its operations, in order,
    /// from -1 (all of it downwards) to 1.
    pub fn with_shares(mode: Mode, key: u64, shares: &'a [f32]) -> Self {
        Self { mode, shares, key, state: mix(key), operations: 0, assumptions: BTreeSet::new() }
    }

    /// Returns the number of operations rounded so far.
    pub fn operations(&self) -> usize {
        self.operations
    }

    /// Returns the assumptions made in cases on which the standard is silent.
    pub fn assumptions(&self) -> &BTreeSet<Assumption> {
        &self.assumptions
    }

    #[inline(always)]
    fn chance(&mut self) -> u32 {
        self.state = self.state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (self.state >> 32) as u32
    }

    fn happens(&mut self, habit: Habit) -> bool {
        match habit {
            Habit::Never => false,
            Habit::Always => true,
            Habit::Sometimes => self.chance() >> 31 == 1,
        }
    }

    /// Returns the share of the allowed error by which the next operation errs.
    #[inline(always)]
    fn share(&mut self, exact: f64) -> f64 {
        let given = self.shares.get(self.operations);
        self.operations += 1;
        if let Some(given) = given {
            return f64::from(*given);
        }
        match self.mode.direction {
            Direction::Nearest => 0.0,
            Direction::Up => 1.0,
            Direction::Down => -1.0,
            Direction::Outward => 1f64.copysign(exact),
            Direction::Inward => -1f64.copysign(exact),
            Direction::Extreme => 1.0 - 2.0 * f64::from(self.chance() >> 31),
            Direction::Share => f64::from(self.chance().cast_signed()) / 2_147_483_648.0,
        }
    }

    /// Returns a float as the device may replace it.
    #[inline(always)]
    fn settled(&mut self, float: f32) -> f32 {
        // A normal float does not change.
        if float.is_normal() { float } else { self.unsettled(float) }
    }

    #[cold]
    fn unsettled(&mut self, float: f32) -> f32 {
        if !float.is_finite() {
            return if self.mode.finite_math == Habit::Never { float } else { self.indeterminate() };
        }
        let float = if float != 0.0 && self.happens(self.mode.flushes) { 0f32.copysign(float) } else { float };
        if float == 0.0 && self.happens(self.mode.finite_math) { -float } else { float }
    }

    /// Returns an arbitrary value.
    fn indeterminate(&mut self) -> f32 {
        let chance = self.chance();
        match chance >> 29 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => f32::NEG_INFINITY,
            3 => 0.0,
            4 => 1.0,
            5 => -f32::MAX,
            6 => f32::MAX,
            _ => f32::from_bits(self.chance()),
        }
    }
}

impl Machine for Device<'_> {
    const FUSES: bool = true;

    #[inline(always)]
    fn round(&mut self, exact: Exact, slack: Slack) -> f32 {
        let share = self.share(exact.value);
        let rounded = erring(exact, share, slack);
        self.settled(rounded)
    }

    #[inline(always)]
    fn operand(&mut self, operand: f32) -> f32 {
        if operand.is_normal() || !operand.is_finite() { operand } else { self.unsettled(operand) }
    }

    #[inline(always)]
    fn kept(&mut self, result: f32) -> f32 {
        self.settled(result)
    }

    #[inline(always)]
    fn compared(&mut self, operands: [f32; 2], holds: bool) -> bool {
        if operands.iter().all(|operand| operand.is_finite()) || self.mode.finite_math == Habit::Never {
            holds
        } else {
            self.chance() >> 31 == 1
        }
    }

    #[inline(always)]
    fn bounded(&mut self, operands: &[f32], result: f32) -> f32 {
        let is_odd = |operand: &f32| !operand.is_finite();
        if self.mode.finite_math != Habit::Never && operands.iter().any(is_odd) {
            return operands[self.chance() as usize % operands.len()];
        }
        self.settled(result)
    }

    #[inline(always)]
    fn fused(&mut self, place: usize, products: [bool; 2]) -> Option<usize> {
        if self.mode.fuses == Habit::Never || products == [false, false] {
            return None;
        }
        // The choice depends on the place in the program: a compiler either fuses an operation or
        // does not.
        let chance = mix(self.key ^ mix(place as u64));
        if self.mode.fuses == Habit::Sometimes && chance & 1 == 0 {
            return None;
        }
        Some(if products == [true, true] { (chance >> 1 & 1) as usize } else { usize::from(products[1]) })
    }

    fn assumed(&mut self, assumption: Assumption) {
        self.assumptions.insert(assumption);
    }
}

/// Returns the result of an operation that errs by `share` of the allowed error.
#[inline(always)]
fn erring(exact: Exact, share: f64, slack: Slack) -> f32 {
    let nearest = exact.value as f32;
    if share == 0.0 || !nearest.is_finite() {
        return nearest;
    }
    match slack {
        // A result that f32 can represent is exact.
        Slack::Rounded => {
            let above = exact.above(nearest);
            if share > 0.0 && above > 0.0 {
                nearest.next_up()
            } else if share < 0.0 && above < 0.0 {
                nearest.next_down()
            } else {
                nearest
            }
        }
        // A unit in the last place of 0 is subnormal. WGSL would permit 0 / x to be one, but no
        // device is that odd.
        Slack::Ulps(_) if exact.value == 0.0 => nearest,
        Slack::Ulps(ulps) => {
            let found = within(exact.value, share * ulps * unit(exact.value));
            // Among subnormals, this many units reach beyond 0, but no device gives exp(-103) a
            // sign.
            if f64::from(found).signum() == exact.value.signum() { found } else { 0.0 }
        }
        Slack::Absolute(most) => within(exact.value, share * most),
        Slack::Root if exact.value == 0.0 => 0.0,
        Slack::Root => {
            let inverse = 1.0 / exact.value;
            let inverse = f64::from(within(inverse, -share * 2.0 * unit(inverse)));
            let root = 1.0 / inverse;
            within(root, share * 2.5 * unit(root))
        }
    }
}

/// Returns the largest distance of a result from the exact one, apart from flushing.
pub(super) fn reach(exact: Exact, slack: Slack) -> f64 {
    let value = exact.value.abs();
    if !value.is_finite() || value > f64::from(f32::MAX) {
        return f64::INFINITY;
    }
    match slack {
        Slack::Rounded if exact.above(exact.value as f32) == 0.0 => 0.0,
        Slack::Rounded => crate::tolerance::ulp_of(value),
        Slack::Ulps(_) | Slack::Root if value == 0.0 => 0.0,
        Slack::Ulps(ulps) => ulps * unit(value),
        Slack::Absolute(most) => most,
        Slack::Root => 2.0 * unit(1.0 / value) * value * value + 2.5 * unit(value),
    }
}

/// Returns WGSL's unit in the last place: the smallest distance of two floats that enclose the
/// number. At a power of two, this is the unit below it.
fn unit(number: f64) -> f64 {
    let is_power = number.to_bits() << 12 == 0;
    let unit = crate::tolerance::ulp_of(number);
    if is_power && number.abs() > f64::from(f32::MIN_POSITIVE) { 0.5 * unit } else { unit }
}

/// Returns the float farthest from `exact` within the signed distance `reach`.
fn within(exact: f64, reach: f64) -> f32 {
    let end = exact + reach;
    let found = end as f32;
    // Rounding must not exceed the distance.
    if (f64::from(found) - exact).abs() <= reach.abs() {
        found
    } else if f64::from(found) > end {
        found.next_down()
    } else {
        found.next_up()
    }
}
