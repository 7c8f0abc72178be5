//! What a function is compiled to: operations on scalars in registers, calls inlined, vectors and structs taken apart.

use super::machine::Site;
use naga::{BinaryOperator, MathFunction, ScalarKind};

/// The number of a word.
pub(super) type Register = u32;

/// The place of an operation.
pub(super) type Label = usize;

/// A function of floats that is no infix operator, as WGSL names it.
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

/// What gives one of its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bound {
    Min,
    Max,
    Clamp,
}

/// One step. `to` is the register of the result; the others are operands.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    Copy {
        to: Register,
        from: Register,
    },
    /// The number of words from the start of a composite to element `index`, the last where there is none, of `stride` words each;
    /// `from` is where the composite itself starts in another.
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
    /// A branch is taken or not.
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
    /// The registers before the first call: constants are in place, and nothing writes there.
    pub(super) registers: Vec<u32>,
    pub(super) arguments: Vec<Register>,
    pub(super) result: Vec<Register>,
    /// Whether it has a loop.
    pub(super) loops: bool,
}
