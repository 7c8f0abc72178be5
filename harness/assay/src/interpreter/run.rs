//! Execution of the compiled code.

use super::code::{Bound, Code, Float, Op};
use super::machine::{Assumption, Exact, Machine, Operation, Slack};
use super::site::Site;
use super::stopped::Stopped;
use naga::{BinaryOperator, MathFunction, ScalarKind};

/// Most operations of one call; more count as an endless loop.
const MOST_OPERATIONS: u64 = 10_000_000;

/// Magnitudes of divisors for which the standard states the accuracy of a quotient.
const DIVISORS: std::ops::RangeInclusive<f32> = f32::MIN_POSITIVE..=8.507_059e37;

/// Working memory of a program, reused for each row.
#[derive(Clone, Debug)]
pub struct Registers {
    words: Vec<u32>,
    /// Exact product of each word that is a product; NaN for any other word.
    products: Vec<f64>,
    /// Number of each word that a machine has recorded; 0 for any other word.
    records: Vec<u32>,
}

impl Code {
    pub(super) fn registers(&self) -> Registers {
        let length = self.registers.len();
        Registers { words: self.registers.clone(), products: vec![f64::NAN; length], records: vec![0; length] }
    }

    /// Runs the code and returns the number of operations executed.
    pub(super) fn run<M: Machine>(
        &self,
        arguments: &[u32],
        registers: &mut Registers,
        machine: &mut M,
    ) -> Result<u64, Stopped> {
        if M::RECORDS {
            registers.records.fill(0);
        }
        for (register, word) in self.arguments.iter().zip(arguments) {
            registers.set::<M>(*register, *word);
            registers.record::<M>(*register, [*register; 2], [0.0; 2], machine);
        }
        let (mut place, mut steps) = (0, 0);
        while let Some(op) = self.ops.get(place) {
            steps += 1;
            if steps > MOST_OPERATIONS {
                return Err(Stopped(format!("ran {MOST_OPERATIONS} operations and did not end")));
            }
            place = registers.step(op, place, machine);
        }
        Ok(steps)
    }
}

impl Registers {
    pub(super) fn word(&self, register: u32) -> u32 {
        self.words[register as usize]
    }

    fn float(&self, register: u32) -> f32 {
        f32::from_bits(self.word(register))
    }

    fn set<M: Machine>(&mut self, register: u32, word: u32) {
        self.words[register as usize] = word;
        if M::FUSES {
            self.products[register as usize] = f64::NAN;
        }
        if M::RECORDS {
            self.records[register as usize] = 0;
        }
    }

    /// Records the dependence of a result on its operands.
    #[inline(always)]
    fn record<M: Machine>(&mut self, to: u32, operands: [u32; 2], partials: [f64; 2], machine: &mut M) {
        if M::RECORDS {
            let operands = operands.map(|register| self.records[register as usize]);
            self.records[to as usize] = machine.recorded(Operation { function: None, operands, partials });
        }
    }

    /// Returns the number of a word in the machine's record.
    pub(super) fn number(&self, register: u32) -> u32 {
        self.records[register as usize]
    }

    /// Copies a word with its exact product and its record.
    fn copy<M: Machine>(&mut self, to: u32, from: u32) {
        self.words[to as usize] = self.word(from);
        if M::FUSES {
            self.products[to as usize] = self.products[from as usize];
        }
        if M::RECORDS {
            self.records[to as usize] = self.records[from as usize];
        }
    }

    /// Executes one operation and returns the place of the next.
    #[inline(always)]
    fn step<M: Machine>(&mut self, op: &Op, place: usize, machine: &mut M) -> usize {
        match *op {
            Op::Copy { to, from } => self.copy::<M>(to, from),
            Op::Offset { to, from, index, last, stride } => {
                let offset = self.word(from) + self.word(index).min(last) * stride;
                self.set::<M>(to, offset);
            }
            Op::LoadAt { to, start, offset } => self.copy::<M>(to, start + self.word(offset)),
            Op::StoreAt { start, offset, from } => self.copy::<M>(start + self.word(offset), from),
            Op::Add { to, a, b } => self.sum(to, [a, b], 1.0, place, machine),
            Op::Subtract { to, a, b } => self.sum(to, [a, b], -1.0, place, machine),
            Op::Multiply { to, a, b } => {
                let (x, y) = (machine.operand(self.float(a)), machine.operand(self.float(b)));
                let exact = f64::from(x) * f64::from(y);
                let rounded = machine.round(Exact::from(exact), Slack::Rounded);
                self.put(to, rounded, (None, [a, b]), || [y.into(), x.into()], machine);
                if M::FUSES {
                    self.products[to as usize] = exact;
                }
            }
            Op::Divide { to, a, b } => {
                let (x, y) = (machine.operand(self.float(a)), machine.operand(self.float(b)));
                if !DIVISORS.contains(&y.abs()) {
                    machine.assumed(Assumption::Quotient);
                }
                // GPUs multiply by a reciprocal, which is subnormal for such a divisor and may be flushed.
                let flushed = y.is_finite() && y.abs() > *DIVISORS.end() && machine.operand(1.0 / y) == 0.0;
                let exact = if flushed { 0.0 } else { f64::from(x) / f64::from(y) };
                let quotient = machine.round(Exact::from(exact), Slack::Ulps(2.5));
                self.put(to, quotient, (None, [a, b]), || [1.0 / f64::from(y), -exact / f64::from(y)], machine);
            }
            Op::Negate { to, from } => {
                let operand = machine.operand(self.float(from));
                let negated = machine.kept(-operand);
                let product = if M::FUSES { -self.products[from as usize] } else { f64::NAN };
                self.put(to, negated, (None, [from; 2]), || [-1.0, 0.0], machine);
                if M::FUSES {
                    self.products[to as usize] = product;
                }
            }
            Op::Float { fun, to, operands, site } => {
                let floats = operands.map(|register| machine.operand(self.float(register)));
                let result = float(fun, floats, site, machine);
                self.put(
                    to,
                    result,
                    (Some((fun, floats[0])), operands),
                    || derivatives(fun, floats.map(f64::from)),
                    machine,
                );
            }
            Op::Bound { bound, to, operands, site } => {
                let floats = operands.map(|register| machine.operand(self.float(register)));
                let result = bounded(bound, floats, site, machine);
                // The first operand that equals the result. For a NaN, the dependence is unknown.
                let chosen = floats.iter().position(|float| *float == result);
                let partial = if chosen.is_some() { 1.0 } else { f64::NAN };
                self.put(to, result, (None, [operands[chosen.unwrap_or(0)]; 2]), || [partial, 0.0], machine);
            }
            Op::Compare { op, to, a, b } => {
                let (a, b) = (machine.operand(self.float(a)), machine.operand(self.float(b)));
                let holds = match op {
                    BinaryOperator::Equal => a == b,
                    BinaryOperator::NotEqual => a != b,
                    BinaryOperator::Less => a < b,
                    BinaryOperator::LessEqual => a <= b,
                    BinaryOperator::Greater => a > b,
                    _ => a >= b,
                };
                let holds = machine.compared([a, b], holds);
                self.set::<M>(to, holds.into());
            }
            Op::Signed { op, to, a, b } => {
                self.set::<M>(to, signed(op, self.word(a).cast_signed(), self.word(b).cast_signed()));
            }
            Op::Unsigned { op, to, a, b } => self.set::<M>(to, unsigned(op, self.word(a), self.word(b))),
            Op::Integer { fun, signed, to, operands } => {
                self.set::<M>(to, integer(fun, signed, operands.map(|register| self.word(register))));
            }
            Op::Not { to, from } => self.set::<M>(to, u32::from(self.word(from) == 0)),
            Op::Complement { to, from } => self.set::<M>(to, !self.word(from)),
            Op::Convert { kinds: [from_kind, kind], to, from, site } => {
                let word = convert(from_kind, kind, self.word(from), machine);
                if from_kind == ScalarKind::Float && kind != ScalarKind::Float {
                    machine.decided(site, word);
                }
                self.set::<M>(to, word);
                if kind == ScalarKind::Float && from_kind != ScalarKind::Float {
                    self.record(to, [to; 2], [0.0; 2], machine);
                }
            }
            Op::Select { to, condition, accept, reject, site } => {
                let chosen = self.word(condition) != 0;
                if let Some(site) = site {
                    machine.decided(site, chosen.into());
                }
                self.copy::<M>(to, if chosen { accept } else { reject });
            }
            Op::Decide { condition, site } => machine.decided(site, u32::from(self.word(condition) != 0)),
            Op::Jump { target } => return target,
            Op::Unless { condition, target } => {
                if self.word(condition) == 0 {
                    return target;
                }
            }
            Op::Equal { selector, value, target } => {
                if self.word(selector) == value {
                    return target;
                }
            }
        }
        place + 1
    }

    /// Sets a float and records its dependence on its operands.
    #[inline(always)]
    fn put<M: Machine>(
        &mut self,
        to: u32,
        float: f32,
        (function, operands): (Option<(Float, f32)>, [u32; 2]),
        partials: impl FnOnce() -> [f64; 2],
        machine: &mut M,
    ) {
        let numbers = if M::RECORDS { operands.map(|register| self.records[register as usize]) } else { [0; 2] };
        self.set::<M>(to, float.to_bits());
        if M::RECORDS {
            let operation = Operation { function, operands: numbers, partials: partials() };
            self.records[to as usize] = machine.recorded(operation);
        }
    }

    /// Computes a ± b; a product may enter unrounded.
    #[inline(always)]
    fn sum<M: Machine>(&mut self, to: u32, [a, b]: [u32; 2], sign: f64, place: usize, machine: &mut M) {
        let mut operands = [a, b].map(|register| f64::from(machine.operand(self.float(register))));
        if M::FUSES {
            let products = [a, b].map(|register| self.products[register as usize]);
            if let Some(fused) = machine.fused(place, products.map(|product| !product.is_nan())) {
                operands[fused] = products[fused];
            }
        }
        let sum = machine.round(Exact::sum(operands[0], sign * operands[1]), Slack::Rounded);
        self.put(to, sum, (None, [a, b]), || [1.0, sign], machine);
    }
}

/// Returns the derivatives of a function with respect to its operands; 0 for functions with steps.
fn derivatives(fun: Float, [x, y]: [f64; 2]) -> [f64; 2] {
    let of_first = match fun {
        Float::Abs => x.signum(),
        Float::Sign | Float::Floor | Float::Ceil | Float::Round | Float::Trunc | Float::Step => 0.0,
        Float::Sqrt => 0.5 / x.sqrt(),
        Float::InverseSqrt => -0.5 / (x * x.sqrt()),
        Float::Exp => x.exp(),
        Float::Exp2 => std::f64::consts::LN_2 * x.exp2(),
        Float::Log => 1.0 / x,
        Float::Log2 => std::f64::consts::LOG2_E / x,
        Float::Pow if x == 0.0 => 0.0,
        Float::Pow => return [y * x.powf(y - 1.0), x.ln() * x.powf(y)],
        Float::Sin => x.cos(),
        Float::Cos => -x.sin(),
        Float::Asin => 1.0 / (1.0 - x * x).sqrt(),
        Float::Acos => -1.0 / (1.0 - x * x).sqrt(),
        Float::Atan => 1.0 / (1.0 + x * x),
        // The first operand is the ordinate.
        Float::Atan2 => return [y / (x * x + y * y), -x / (x * x + y * y)],
    };
    [of_first, 0.0]
}

#[inline(always)]
fn float<M: Machine>(fun: Float, [x, y]: [f32; 2], site: Site, machine: &mut M) -> f32 {
    let exact = f64::from(x);
    let assumed = match fun {
        Float::Sqrt if x == 0.0 => Some(Assumption::Root),
        Float::Sin | Float::Cos if exact.abs() > std::f64::consts::PI => Some(Assumption::Wave),
        Float::Atan2 if x == 0.0 || !DIVISORS.contains(&y.abs()) => Some(Assumption::Angle),
        Float::Pow if x == 0.0 && y > 0.0 => Some(Assumption::Power),
        _ => None,
    };
    if let Some(assumed) = assumed {
        machine.assumed(assumed);
    }
    let mut round = |exact: f64, slack: Slack| machine.round(Exact::from(exact), slack);
    match fun {
        Float::Abs => machine.kept(x.abs()),
        Float::Sign | Float::Floor | Float::Ceil | Float::Round | Float::Trunc => {
            let whole = match fun {
                Float::Sign if x == 0.0 => 0.0,
                Float::Sign => x.signum(),
                Float::Floor => x.floor(),
                Float::Ceil => x.ceil(),
                Float::Round => x.round_ties_even(),
                _ => x.trunc(),
            };
            machine.decided(site, whole.to_bits());
            machine.kept(whole)
        }
        Float::Step => {
            machine.decided(site, u32::from(x <= y));
            f32::from(machine.compared([x, y], x <= y))
        }
        Float::Pow if x == 0.0 && y > 0.0 => machine.kept(0.0),
        Float::Pow => {
            let logarithm = f64::from(round(exact.log2(), logarithm(x)));
            let exponent = f64::from(round(f64::from(y) * logarithm, Slack::Rounded));
            round(exponent.exp2(), Slack::Ulps(3.0 + 2.0 * exponent.abs()))
        }
        _ => {
            let (exact, slack) = fun.exact(x, y);
            round(exact, slack)
        }
    }
}

impl Float {
    /// Returns the exact value of a function and the error that WGSL allows it. `atan2` takes the
    /// ordinate first. The error of a power is only that of its last step.
    pub fn exact(self, x: f32, y: f32) -> (f64, Slack) {
        let exact = f64::from(x);
        match self {
            Float::Abs => (exact.abs(), Slack::Rounded),
            Float::Sign if x == 0.0 => (0.0, Slack::Rounded),
            Float::Sign => (exact.signum(), Slack::Rounded),
            Float::Floor => (exact.floor(), Slack::Rounded),
            Float::Ceil => (exact.ceil(), Slack::Rounded),
            Float::Round => (exact.round_ties_even(), Slack::Rounded),
            Float::Trunc => (exact.trunc(), Slack::Rounded),
            Float::Step => (f64::from(u8::from(x <= y)), Slack::Rounded),
            Float::Sqrt => (exact.sqrt(), Slack::Root),
            Float::InverseSqrt => (1.0 / exact.sqrt(), Slack::Ulps(2.0)),
            Float::Exp => (exact.exp(), Slack::Ulps(3.0 + 2.0 * exact.abs())),
            Float::Exp2 => (exact.exp2(), Slack::Ulps(3.0 + 2.0 * exact.abs())),
            Float::Log => (exact.ln(), logarithm(x)),
            Float::Log2 => (exact.log2(), logarithm(x)),
            Float::Pow => {
                let exponent = f64::from(y) * exact.log2();
                (exact.powf(f64::from(y)), Slack::Ulps(3.0 + 2.0 * exponent.abs()))
            }
            Float::Sin => (exact.sin(), Slack::Absolute(2f64.powi(-11))),
            Float::Cos => (exact.cos(), Slack::Absolute(2f64.powi(-11))),
            Float::Asin => (exact.asin(), Slack::Absolute(inverse_sine(exact, exact.asin()))),
            Float::Acos => (exact.acos(), Slack::Absolute(inverse_sine(exact, exact.acos()))),
            Float::Atan => (exact.atan(), Slack::Ulps(4096.0)),
            Float::Atan2 => (exact.atan2(f64::from(y)), Slack::Ulps(4096.0)),
        }
    }
}

/// Computes a minimum, a maximum or both. The choice of the operand is a decision.
fn bounded<M: Machine>(bound: Bound, operands: [f32; 3], site: Site, machine: &mut M) -> f32 {
    let [x, y, z] = operands;
    let (choice, result) = match bound {
        Bound::Min => (u32::from(x < y), x.min(y)),
        Bound::Max => (u32::from(x > y), x.max(y)),
        Bound::Clamp => (if x < y { 0 } else { 1 + u32::from(x > z) }, x.max(y).min(z)),
    };
    machine.decided(site, choice);
    let count = if bound == Bound::Clamp { 3 } else { 2 };
    machine.bounded(&operands[..count], result)
}

/// Returns the allowed error of a logarithm. It is absolute near 1, at which the logarithm is 0.
fn logarithm(x: f32) -> Slack {
    if (0.5..=2.0).contains(&x) { Slack::Absolute(2f64.powi(-21)) } else { Slack::Ulps(3.0) }
}

/// Returns the allowed error of acos x or asin x: an absolute error, or the error inherited from
/// `atan2` of x and sqrt(1 - x²), whichever is larger.
fn inverse_sine(x: f64, result: f64) -> f64 {
    let unit = 2f64.powi(-23);
    let left = (1.0 - x * x).max(0.0);
    // The difference errs by its own rounding and the square's; the root halves that error and adds
    // 2 and 2.5 ulp of its own.
    let difference = unit * (left + x * x);
    let root = (left + difference).sqrt() * (1.0 + 4.5 * unit) - left.sqrt();
    (4096.0 * crate::tolerance::ulp_of(result) + x.abs() * root).max(6.81e-5)
}

fn signed(op: BinaryOperator, a: i32, b: i32) -> u32 {
    let value = match op {
        BinaryOperator::Divide => a.checked_div(b).unwrap_or(a),
        BinaryOperator::Modulo => a.checked_rem(b).unwrap_or(0),
        BinaryOperator::ShiftRight => a.wrapping_shr(b.cast_unsigned()),
        BinaryOperator::Less => return u32::from(a < b),
        BinaryOperator::LessEqual => return u32::from(a <= b),
        BinaryOperator::Greater => return u32::from(a > b),
        BinaryOperator::GreaterEqual => return u32::from(a >= b),
        // In two's complement the sign makes no difference to the others.
        _ => return unsigned(op, a.cast_unsigned(), b.cast_unsigned()),
    };
    value.cast_unsigned()
}

fn unsigned(op: BinaryOperator, a: u32, b: u32) -> u32 {
    match op {
        BinaryOperator::Add => a.wrapping_add(b),
        BinaryOperator::Subtract => a.wrapping_sub(b),
        BinaryOperator::Multiply => a.wrapping_mul(b),
        BinaryOperator::Divide => a.checked_div(b).unwrap_or(a),
        BinaryOperator::Modulo => a.checked_rem(b).unwrap_or(0),
        BinaryOperator::Equal => u32::from(a == b),
        BinaryOperator::NotEqual => u32::from(a != b),
        BinaryOperator::Less => u32::from(a < b),
        BinaryOperator::LessEqual => u32::from(a <= b),
        BinaryOperator::Greater => u32::from(a > b),
        BinaryOperator::GreaterEqual => u32::from(a >= b),
        BinaryOperator::And | BinaryOperator::LogicalAnd => a & b,
        BinaryOperator::ExclusiveOr => a ^ b,
        BinaryOperator::InclusiveOr | BinaryOperator::LogicalOr => a | b,
        BinaryOperator::ShiftLeft => a.wrapping_shl(b),
        BinaryOperator::ShiftRight => a.wrapping_shr(b),
    }
}

fn convert<M: Machine>(from: ScalarKind, to: ScalarKind, word: u32, machine: &mut M) -> u32 {
    let mut rounded = |value: f64| machine.round(Exact::from(value), Slack::Rounded).to_bits();
    match (from, to) {
        (ScalarKind::Float, ScalarKind::Sint) => (f32::from_bits(word) as i32).cast_unsigned(),
        (ScalarKind::Float, ScalarKind::Uint) => f32::from_bits(word) as u32,
        (ScalarKind::Float, ScalarKind::Bool) => u32::from(f32::from_bits(word) != 0.0),
        (ScalarKind::Float, _) => word,
        (ScalarKind::Sint, ScalarKind::Float) => rounded(f64::from(word.cast_signed())),
        (_, ScalarKind::Float) => rounded(f64::from(word)),
        (_, ScalarKind::Bool) => u32::from(word != 0),
        _ => word,
    }
}

fn integer(fun: MathFunction, is_signed: bool, [a, b, c]: [u32; 3]) -> u32 {
    let pick = |a: u32, b: u32, least: bool| {
        let below = if is_signed { a.cast_signed() < b.cast_signed() } else { a < b };
        if below == least { a } else { b }
    };
    match fun {
        MathFunction::Min => pick(a, b, true),
        MathFunction::Max => pick(a, b, false),
        MathFunction::Clamp => pick(pick(a, b, false), c, true),
        MathFunction::Abs if is_signed => a.cast_signed().wrapping_abs().cast_unsigned(),
        MathFunction::Sign => a.cast_signed().signum().cast_unsigned(),
        MathFunction::CountOneBits => a.count_ones(),
        MathFunction::CountLeadingZeros => a.leading_zeros(),
        MathFunction::CountTrailingZeros => a.trailing_zeros(),
        MathFunction::ReverseBits => a.reverse_bits(),
        MathFunction::FirstTrailingBit if a == 0 => u32::MAX,
        MathFunction::FirstTrailingBit => a.trailing_zeros(),
        MathFunction::FirstLeadingBit => {
            let bits = if is_signed && a.cast_signed() < 0 { !a } else { a };
            if bits == 0 { u32::MAX } else { 31 - bits.leading_zeros() }
        }
        _ => a,
    }
}
