//! Machines to run on: one that rounds to nearest, one that notes every decision.

use super::code::Float;

/// Where a decision is made: a function of the module and an expression of it, by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Site {
    /// Which function.
    pub function: u32,
    /// Which expression of it.
    pub expression: u32,
}

/// What was decided where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// Where.
    pub site: Site,
    /// A condition as 0 or 1, the operand that a minimum took, the whole number that a floor gave.
    pub choice: u32,
}

/// The exact result of an operation on floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact {
    /// The nearest f64.
    pub value: f64,
    /// What is left of a sum. Of other operations it is 0: products of two f32 are f64 numbers, and for quotients and functions the standard asks
    /// for no correct rounding.
    pub rest: f64,
}

impl From<f64> for Exact {
    fn from(value: f64) -> Self {
        Self { value, rest: 0.0 }
    }
}

impl Exact {
    /// a + b without an error (Knuth's two-sum).
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Self {
        let value = a + b;
        let from_b = value - a;
        let rest = (a - (value - from_b)) + (b - from_b);
        Self { value, rest }
    }

    /// How far the result lies above `float`, the nearest f32 or next to it: its sign is right, however small the difference.
    #[inline(always)]
    pub fn above(self, float: f32) -> f64 {
        (self.value - f64::from(float)) + self.rest
    }
}

/// How far WGSL lets the result of an operation be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slack {
    /// Correctly rounded, up or down.
    Rounded,
    /// So many units in the last place.
    Ulps(f64),
    /// So much.
    Absolute(f64),
    /// As 1 / inverseSqrt: 2 ulp, then a division's 2.5.
    Root,
}

/// What is taken to hold where the standard states no accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Assumption {
    /// A divisor beyond 2^±126: 2.5 ulp, as within.
    Quotient,
    /// A sine or a cosine beyond ±π: 2^-11, as within.
    Wave,
    /// sqrt(0) is 0.
    Root,
    /// pow(0, y) is 0 for y > 0.
    Power,
    /// atan2 where x is 0 or y is 0: 4096 ulp, as elsewhere.
    Angle,
}

impl std::fmt::Display for Assumption {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Assumption::Quotient => "a quotient is as accurate where the divisor lies beyond 2^-126 to 2^126",
            Assumption::Wave => "sine and cosine are as accurate beyond -π to π",
            Assumption::Root => "sqrt(0) is 0",
            Assumption::Power => "pow(0, y) is 0 for y > 0",
            Assumption::Angle => "atan2 is as accurate where x or y is 0 or beyond 2^-126 to 2^126",
        })
    }
}

/// An operation on floats that was run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operation {
    /// Which function, and its first argument; none of an infix operator.
    pub function: Option<(Float, f32)>,
    /// The numbers of its operands in the record: 0 for a constant.
    pub operands: [u32; 2],
    /// The derivatives of its result by them.
    pub partials: [f64; 2],
}

/// What rounds, and what is told of decisions.
pub trait Machine {
    /// Whether it may fuse products with sums.
    const FUSES: bool = false;

    /// Whether it records operations.
    const RECORDS: bool = false;

    /// The result of an operation whose exact one is `exact`.
    fn round(&mut self, exact: Exact, slack: Slack) -> f32;

    /// An operand as the operation sees it.
    #[inline(always)]
    fn operand(&mut self, operand: f32) -> f32 {
        operand
    }

    /// A result that is a float from the start, such as an absolute value.
    #[inline(always)]
    fn kept(&mut self, result: f32) -> f32 {
        result
    }

    /// A comparison's result.
    #[inline(always)]
    fn compared(&mut self, _operands: [f32; 2], holds: bool) -> bool {
        holds
    }

    /// The result of `min`, `max` or `clamp`.
    #[inline(always)]
    fn bounded(&mut self, _operands: &[f32], result: f32) -> f32 {
        result
    }

    /// The standard states nothing here.
    #[inline(always)]
    fn assumed(&mut self, _assumption: Assumption) {}

    /// Which of a sum's operands, those that are products, comes in unrounded; `at` numbers the sum in the program.
    #[inline(always)]
    fn fused(&mut self, _at: usize, _products: [bool; 2]) -> Option<usize> {
        None
    }

    /// Notes an operation's result, and how it depends on its operands; returns its number in the record, 0 where nothing is recorded.
    #[inline(always)]
    fn recorded(&mut self, _operation: Operation) -> u32 {
        0
    }

    /// A branch was taken.
    #[inline(always)]
    fn decided(&mut self, _site: Site, _choice: u32) {}
}

/// Rounds to nearest, as the mirrors do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest;

impl Machine for Nearest {
    #[inline(always)]
    fn round(&mut self, exact: Exact, _: Slack) -> f32 {
        exact.value as f32
    }
}

/// Rounds to nearest and notes every decision.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    /// What was decided, in order.
    pub decisions: Vec<Decision>,
}

impl Machine for Traced {
    #[inline(always)]
    fn round(&mut self, exact: Exact, _: Slack) -> f32 {
        exact.value as f32
    }

    fn decided(&mut self, site: Site, choice: u32) {
        self.decisions.push(Decision { site, choice });
    }
}
