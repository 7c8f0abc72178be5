//! Compiled code of a function: operations on scalars in registers, with calls inlined, and vectors
//! and structs split into scalars.

use super::site::Site;
use naga::{BinaryOperator, MathFunction, ScalarKind};

/// Index of a word.
pub(super) type Register = u32;

/// Index of an operation.
pub(super) type Label = usize;

/// A function of floats other than an infix operator, under its WGSL name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Float {
    /// `abs`
    Abs,
    /// `sign`
    Sign,
    /// `floor`
    Floor,
    /// `ceil`
    Ceil,
    /// `round`
    Round,
    /// `trunc`
    Trunc,
    /// `step`
    Step,
    /// `sqrt`
    Sqrt,
    /// `inverseSqrt`
    InverseSqrt,
    /// `exp`
    Exp,
    /// `exp2`
    Exp2,
    /// `log`
    Log,
    /// `log2`
    Log2,
    /// `pow`
    Pow,
    /// `sin`
    Sin,
    /// `cos`
    Cos,
    /// `asin`
    Asin,
    /// `acos`
    Acos,
    /// `atan`
    Atan,
    /// `atan2`
    Atan2,
}

/// A function that returns one of its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bound {
    Min,
    Max,
    Clamp,
}

/// One operation. `to` is the register of the result; the other registers are operands.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    Copy {
        to: Register,
        from: Register,
    },
    /// Offset in words of element `index` of a composite, or of the last element if there is no
    /// such element, with `stride` words per element. `from` is the offset of the composite itself
    /// within another.
    Offset {
        to: Register,
        from: Register,
        index: Register,
        last: u32,
        stride: u32,
    },
    LoadAt {
        to: Register,
        start: Register,
        offset: Register,
    },
    StoreAt {
        start: Register,
        offset: Register,
        from: Register,
    },
    Add {
        to: Register,
        a: Register,
        b: Register,
    },
    Subtract {
        to: Register,
        a: Register,
        b: Register,
    },
    Multiply {
        to: Register,
        a: Register,
        b: Register,
    },
    Divide {
        to: Register,
        a: Register,
        b: Register,
    },
    Negate {
        to: Register,
        from: Register,
    },
    Float {
        fun: Float,
        to: Register,
        operands: [Register; 2],
        site: Site,
    },
    Bound {
        bound: Bound,
        to: Register,
        operands: [Register; 3],
        site: Site,
    },
    Compare {
        op: BinaryOperator,
        to: Register,
        a: Register,
        b: Register,
    },
    Signed {
        op: BinaryOperator,
        to: Register,
        a: Register,
        b: Register,
    },
    Unsigned {
        op: BinaryOperator,
        to: Register,
        a: Register,
        b: Register,
    },
    Integer {
        fun: MathFunction,
        signed: bool,
        to: Register,
        operands: [Register; 3],
    },
    Not {
        to: Register,
        from: Register,
    },
    Complement {
        to: Register,
        from: Register,
    },
    Convert {
        kinds: [ScalarKind; 2],
        to: Register,
        from: Register,
        site: Site,
    },
    Select {
        to: Register,
        condition: Register,
        accept: Register,
        reject: Register,
        site: Option<Site>,
    },
    /// Notes whether a branch is taken.
    Decide {
        condition: Register,
        site: Site,
    },
    Jump {
        target: Label,
    },
    Unless {
        condition: Register,
        target: Label,
    },
    Equal {
        selector: Register,
        value: u32,
        target: Label,
    },
}

/// A compiled function.
#[derive(Debug)]
pub(super) struct Code {
    pub(super) ops: Vec<Op>,
    /// Registers before the first call; they hold the constants, which no operation overwrites.
    pub(super) registers: Vec<u32>,
    pub(super) arguments: Vec<Register>,
    pub(super) result: Vec<Register>,
    /// Whether the function has a loop.
    pub(super) loops: bool,
}
