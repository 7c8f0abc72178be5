//! WGSL's built-in functions. A function that inherits its accuracy from an expression is compiled
//! to that expression.

use super::Compiler;
use crate::interpreter::Stopped;
use crate::interpreter::code::{Bound, Float, Op, Register};
use crate::interpreter::site::Site;
use naga::{BinaryOperator, MathFunction as Fun, ScalarKind};

impl Compiler<'_> {
    /// Compiles a built-in function and returns the registers of its result.
    pub(super) fn builtin(
        &mut self,
        fun: Fun,
        kind: Option<ScalarKind>,
        arguments: &[Vec<Register>],
        site: Site,
    ) -> Result<Vec<Register>, Stopped> {
        match kind {
            Some(ScalarKind::Float) => {}
            Some(ScalarKind::Sint) => return self.of_integers(fun, true, arguments),
            Some(ScalarKind::Uint) => return self.of_integers(fun, false, arguments),
            _ => return Err(Stopped(format!("cannot evaluate {fun:?} of matrices on the CPU"))),
        }
        Ok(match fun {
            Fun::Dot => vec![self.dot(&arguments[0], &arguments[1])],
            Fun::Length => vec![self.length(&arguments[0], site)],
            Fun::Distance => {
                let difference = self.each(&arguments[..2], |compiler, x| compiler.subtract(x[0], x[1]));
                vec![self.length(&difference, site)]
            }
            Fun::Normalize => {
                let length = self.length(&arguments[0], site);
                arguments[0].iter().map(|x| self.divide(*x, length)).collect()
            }
            Fun::Cross => {
                let (a, b) = (&arguments[0], &arguments[1]);
                let component = |(i, j): (usize, usize)| {
                    let (one, other) = (self.multiply(a[i], b[j]), self.multiply(a[j], b[i]));
                    self.subtract(one, other)
                };
                [(1, 2), (2, 0), (0, 1)].into_iter().map(component).collect()
            }
            Fun::FaceForward => {
                let along = self.dot(&arguments[2], &arguments[1]);
                let zero = self.constant(0);
                let before = self.result(|to| Op::Compare { op: BinaryOperator::Less, to, a: along, b: zero });
                let forward = |x: &Register| {
                    let accept = *x;
                    let reject = self.result(|to| Op::Negate { to, from: accept });
                    self.result(|to| Op::Select { to, condition: before, accept, reject, site: Some(site) })
                };
                arguments[0].iter().map(forward).collect()
            }
            Fun::Reflect => {
                let along = self.dot(&arguments[1], &arguments[0]);
                let two = self.number(2.0);
                let twice = self.multiply(two, along);
                self.each(&arguments[..2], |compiler, x| {
                    let part = compiler.multiply(twice, x[1]);
                    compiler.subtract(x[0], part)
                })
            }
            Fun::Refract => self.refract(arguments, site),
            _ => {
                let mut fault = None;
                let result = self.each(arguments, |compiler, operands| {
                    compiler.scalar(fun, operands, site).unwrap_or_else(|| {
                        fault = Some(Stopped(format!("cannot evaluate {fun:?} on the CPU")));
                        operands[0]
                    })
                });
                match fault {
                    Some(fault) => return Err(fault),
                    None => result,
                }
            }
        })
    }

    /// Applies `operation` component by component; a scalar is repeated to match the vectors.
    fn each(
        &mut self,
        arguments: &[Vec<Register>],
        mut operation: impl FnMut(&mut Self, &[Register]) -> Register,
    ) -> Vec<Register> {
        let length = arguments.iter().map(Vec::len).max().unwrap_or(0);
        (0..length)
            .map(|index| {
                let operands: Vec<Register> =
                    arguments.iter().map(|argument| argument[index % argument.len()]).collect();
                operation(self, &operands)
            })
            .collect()
    }

    fn refract(&mut self, arguments: &[Vec<Register>], site: Site) -> Vec<Register> {
        let (incident, normal, eta) = (&arguments[0], &arguments[1], arguments[2][0]);
        let (zero, one) = (self.constant(0), self.number(1.0));
        // k = 1 - η² (1 - cos²)
        let cosine = self.dot(normal, incident);
        let squared = self.multiply(cosine, cosine);
        let sine = self.subtract(one, squared);
        let inner = self.multiply(eta, sine);
        let outer = self.multiply(eta, inner);
        let radicand = self.subtract(one, outer);
        let is_total = self.result(|to| Op::Compare { op: BinaryOperator::Less, to, a: radicand, b: zero });
        self.push(Op::Decide { condition: is_total, site });
        let positive =
            self.result(|to| Op::Select { to, condition: is_total, accept: zero, reject: radicand, site: None });
        let root = self.function(Float::Sqrt, positive, positive, site);
        let along = self.multiply(eta, cosine);
        let along = self.add(along, root);
        self.each(&[incident.clone(), normal.clone()], |compiler, x| {
            let (one, other) = (compiler.multiply(eta, x[0]), compiler.multiply(along, x[1]));
            let refracted = compiler.subtract(one, other);
            compiler.result(|to| Op::Select { to, condition: is_total, accept: zero, reject: refracted, site: None })
        })
    }

    fn dot(&mut self, a: &[Register], b: &[Register]) -> Register {
        let products: Vec<Register> = a.iter().zip(b).map(|(a, b)| self.multiply(*a, *b)).collect();
        self.sum_of(products)
    }

    fn length(&mut self, vector: &[Register], site: Site) -> Register {
        let squared = self.dot(vector, vector);
        self.function(Float::Sqrt, squared, squared, site)
    }

    /// Compiles a function of float scalars; `None` if the interpreter lacks it.
    fn scalar(&mut self, fun: Fun, operands: &[Register], site: Site) -> Option<Register> {
        let x = operands[0];
        let y = operands.get(1).copied().unwrap_or(x);
        let call_of = |fun: Float| (fun, x, y);
        let (fun, x, y) = match fun {
            Fun::Abs => call_of(Float::Abs),
            Fun::Sign => call_of(Float::Sign),
            Fun::Floor => call_of(Float::Floor),
            Fun::Ceil => call_of(Float::Ceil),
            Fun::Round => call_of(Float::Round),
            Fun::Trunc => call_of(Float::Trunc),
            Fun::Sqrt => call_of(Float::Sqrt),
            Fun::InverseSqrt => call_of(Float::InverseSqrt),
            Fun::Exp => call_of(Float::Exp),
            Fun::Exp2 => call_of(Float::Exp2),
            Fun::Log => call_of(Float::Log),
            Fun::Log2 => call_of(Float::Log2),
            Fun::Pow => call_of(Float::Pow),
            Fun::Sin => call_of(Float::Sin),
            Fun::Cos => call_of(Float::Cos),
            Fun::Asin => call_of(Float::Asin),
            Fun::Acos => call_of(Float::Acos),
            Fun::Atan => call_of(Float::Atan),
            Fun::Atan2 => call_of(Float::Atan2),
            Fun::Step => call_of(Float::Step),
            Fun::Fract => {
                let below = self.function(Float::Floor, x, x, site);
                return Some(self.subtract(x, below));
            }
            Fun::Min => return Some(self.bound(Bound::Min, [x, y, y], site)),
            Fun::Max => return Some(self.bound(Bound::Max, [x, y, y], site)),
            Fun::Clamp => return Some(self.bound(Bound::Clamp, [x, y, operands[2]], site)),
            Fun::Saturate => {
                let (zero, one) = (self.constant(0), self.number(1.0));
                return Some(self.bound(Bound::Clamp, [x, zero, one], site));
            }
            Fun::Tan => {
                let sine = self.function(Float::Sin, x, x, site);
                let cosine = self.function(Float::Cos, x, x, site);
                return Some(self.divide(sine, cosine));
            }
            Fun::Mix => {
                let one = self.number(1.0);
                let rest = self.subtract(one, operands[2]);
                let (one, other) = (self.multiply(x, rest), self.multiply(y, operands[2]));
                return Some(self.add(one, other));
            }
            Fun::Fma => {
                let product = self.multiply(x, y);
                return Some(self.add(product, operands[2]));
            }
            Fun::Radians => {
                let factor = self.number(std::f32::consts::PI / 180.0);
                return Some(self.multiply(x, factor));
            }
            Fun::Degrees => {
                let factor = self.number(180.0 / std::f32::consts::PI);
                return Some(self.multiply(x, factor));
            }
            Fun::SmoothStep => {
                // t² (3 - 2t), t = (x - low) / (high - low) within [0, 1]
                let (low, high, x) = (x, y, operands[2]);
                let (zero, one) = (self.constant(0), self.number(1.0));
                let (above, range) = (self.subtract(x, low), self.subtract(high, low));
                let share = self.divide(above, range);
                let t = self.bound(Bound::Clamp, [share, zero, one], site);
                let (two, three) = (self.number(2.0), self.number(3.0));
                let twice = self.multiply(two, t);
                let rest = self.subtract(three, twice);
                let squared = self.multiply(t, t);
                return Some(self.multiply(squared, rest));
            }
            _ => return None,
        };
        Some(self.function(fun, x, y, site))
    }

    fn function(&mut self, fun: Float, x: Register, y: Register, site: Site) -> Register {
        self.result(|to| Op::Float { fun, to, operands: [x, y], site })
    }

    fn bound(&mut self, bound: Bound, operands: [Register; 3], site: Site) -> Register {
        self.result(|to| Op::Bound { bound, to, operands, site })
    }

    fn number(&mut self, number: f32) -> Register {
        self.constant(number.to_bits())
    }

    pub(super) fn add(&mut self, a: Register, b: Register) -> Register {
        self.result(|to| Op::Add { to, a, b })
    }

    pub(super) fn subtract(&mut self, a: Register, b: Register) -> Register {
        self.result(|to| Op::Subtract { to, a, b })
    }

    pub(super) fn multiply(&mut self, a: Register, b: Register) -> Register {
        self.result(|to| Op::Multiply { to, a, b })
    }

    pub(super) fn divide(&mut self, a: Register, b: Register) -> Register {
        self.result(|to| Op::Divide { to, a, b })
    }

    fn of_integers(&mut self, fun: Fun, signed: bool, arguments: &[Vec<Register>]) -> Result<Vec<Register>, Stopped> {
        match fun {
            Fun::Dot => {
                let unsigned = |op: BinaryOperator, a: Register, b: Register| move |to| Op::Unsigned { op, to, a, b };
                let products: Vec<Register> = arguments[0]
                    .iter()
                    .zip(&arguments[1])
                    .map(|(a, b)| self.result(unsigned(BinaryOperator::Multiply, *a, *b)))
                    .collect();
                let sum = products.into_iter().reduce(|a, b| self.result(unsigned(BinaryOperator::Add, a, b)));
                Ok(sum.into_iter().collect())
            }
            Fun::Min
            | Fun::Max
            | Fun::Clamp
            | Fun::Abs
            | Fun::Sign
            | Fun::CountOneBits
            | Fun::CountLeadingZeros
            | Fun::CountTrailingZeros
            | Fun::ReverseBits
            | Fun::FirstTrailingBit
            | Fun::FirstLeadingBit => Ok(self.each(arguments, |compiler, operands| {
                let operand = |index: usize| operands.get(index).copied().unwrap_or(operands[0]);
                let operands = [operand(0), operand(1), operand(2)];
                compiler.result(|to| Op::Integer { fun, signed, to, operands })
            })),
            _ => Err(Stopped(format!("cannot evaluate {fun:?} of integers on the CPU"))),
        }
    }
}
