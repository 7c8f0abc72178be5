//! Machines for the interpreter: one rounds to nearest, one also notes every decision.

use super::code::Float;
use super::site::Site;

/// A decision and its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// Place of the decision.
    pub site: Site,
    /// Condition as 0 or 1; for a minimum or maximum, whether the first operand won; for a clamp,
    /// which of the three; for a floor, step or conversion, the bits of the result.
    pub choice: u32,
}

/// The exact result of an operation on floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact {
    /// The nearest f64.
    pub value: f64,
    /// Remainder of a sum. It is 0 for other operations: products of two f32 are exact in f64, and
    /// the standard asks for no correct rounding of quotients and functions.
    pub rest: f64,
}

impl From<f64> for Exact {
    fn from(value: f64) -> Self {
        Self { value, rest: 0.0 }
    }
}

impl Exact {
    /// Returns a + b without an error (Knuth's two-sum).
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Self {
        let value = a + b;
        let from_b = value - a;
        let rest = (a - (value - from_b)) + (b - from_b);
        Self { value, rest }
    }

    /// Returns the distance of the result above `float`, the nearest f32 or a neighbour of it. The
    /// sign is right, however small the difference.
    #[inline(always)]
    pub fn above(self, float: f32) -> f64 {
        (self.value - f64::from(float)) + self.rest
    }
}

/// Error that WGSL allows in the result of an operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slack {
    /// Correctly rounded, up or down.
    Rounded,
    /// Error in units in the last place.
    Ulps(f64),
    /// Absolute error.
    Absolute(f64),
    /// Error of 1 / inverseSqrt: 2 ulp, then 2.5 ulp of a division.
    Root,
}

/// Assumption in a case for which the standard states no accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Assumption {
    /// Quotient by a divisor below 2^-126: 2.5 ulp, as within; by one above 2^126: the same, or 0, which is what
    /// NVIDIA's driver returns.
    Quotient,
    /// Sine or cosine beyond ±π: 2^-11, as within.
    Wave,
    /// sqrt(0) is 0.
    Root,
    /// pow(0, y) is 0 for y > 0.
    Power,
    /// atan2 with x or y of 0, or a divisor beyond 2^±126: 4096 ulp, as elsewhere.
    Angle,
}

impl std::fmt::Display for Assumption {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Assumption::Quotient => {
                "a quotient is as accurate, or is 0, where the divisor lies above 2^126; as accurate below 2^-126"
            }
            Assumption::Wave => "sine and cosine are as accurate beyond -π to π",
            Assumption::Root => "sqrt(0) is 0",
            Assumption::Power => "pow(0, y) is 0 for y > 0",
            Assumption::Angle => "atan2 is as accurate where x or y is 0 or beyond 2^-126 to 2^126",
        })
    }
}

/// A completed operation on floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operation {
    /// Function and its first argument; `None` for an infix operator.
    pub function: Option<(Float, f32)>,
    /// Numbers of its operands in the record; 0 for a constant.
    pub operands: [u32; 2],
    /// Derivatives of its result with respect to the operands.
    pub partials: [f64; 2],
}

/// Arithmetic of the interpreter: it rounds results and is told of decisions.
pub trait Machine {
    /// Whether the machine may fuse products with sums.
    const FUSES: bool = false;

    /// Whether the machine records operations.
    const RECORDS: bool = false;

    /// Returns the rounded result of an operation, given the exact one.
    fn round(&mut self, exact: Exact, slack: Slack) -> f32;

    /// Returns an operand as the operation sees it.
    #[inline(always)]
    fn operand(&mut self, operand: f32) -> f32 {
        operand
    }

    /// Returns a result that needs no rounding, such as an absolute value.
    #[inline(always)]
    fn kept(&mut self, result: f32) -> f32 {
        result
    }

    /// Returns the result of a comparison.
    #[inline(always)]
    fn compared(&mut self, _operands: [f32; 2], holds: bool) -> bool {
        holds
    }

    /// Returns the result of `min`, `max` or `clamp`.
    #[inline(always)]
    fn bounded(&mut self, _operands: &[f32], result: f32) -> f32 {
        result
    }

    /// Notes an assumption in a case on which the standard is silent.
    #[inline(always)]
    fn assumed(&mut self, _assumption: Assumption) {}

    /// Returns the index of the sum's operand that enters unrounded, one of those that are
    /// products; `at` is the number of the sum in the program.
    #[inline(always)]
    fn fused(&mut self, _at: usize, _products: [bool; 2]) -> Option<usize> {
        None
    }

    /// Records an operation's result and its dependence on the operands. Returns its number in the
    /// record, or 0 if nothing is recorded.
    #[inline(always)]
    fn recorded(&mut self, _operation: Operation) -> u32 {
        0
    }

    /// Notes a decision: a branch, or a minimum, maximum, clamp, floor, step or conversion.
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
    /// Decisions, in order.
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
