//! Reassociation: sums of three or more terms, and products of three or more factors, in another
//! order.
//!
//! The standard allows it within an expression, `let` included: `(a + b) + c` as `a + (b + c)`,
//! `(a - b) + c` as `(a + c) - b`, `(a * b) / c` as `(a / c) * b`. A value that passes through a
//! `var` or a call keeps its order.

use super::value::Value;
use super::{Call, Compiler};
use crate::draws::mix;
use crate::interpreter::Stopped;
use crate::interpreter::code::{Op, Register};
use naga::{BinaryOperator, Expression, Handle, ScalarKind, UnaryOperator};

/// Most operands of a chain; operands beyond that number stay together.
const MOST_LINKS: usize = 64;

/// Kind of chain.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Sum,
    Product,
}

/// An operand of a chain; inverse if it is subtracted or is a divisor.
struct Link {
    handle: Handle<Expression>,
    inverse: bool,
}

impl<'a> Compiler<'a> {
    /// Returns the value of a chain in the order that the seed gives, or `None` if the expression
    /// is no chain or there is no seed.
    pub(super) fn reordered(
        &mut self,
        call: &mut Call<'a>,
        handle: Handle<Expression>,
    ) -> Result<Option<Value>, Stopped> {
        let Some(order) = self.order else { return Ok(None) };
        let Expression::Binary { op, left, right } = call.function.expressions[handle] else { return Ok(None) };
        if [left, right].into_iter().any(|side| self.kind(call, side) != Some(ScalarKind::Float)) {
            return Ok(None);
        }
        let kind = match op {
            BinaryOperator::Add | BinaryOperator::Subtract => Kind::Sum,
            BinaryOperator::Multiply | BinaryOperator::Divide => Kind::Product,
            _ => return Ok(None),
        };
        let mut links = Vec::new();
        self.links(call, kind, handle, false, &mut links);
        if links.len() < 3 {
            return Ok(None);
        }
        let mut operands = Vec::new();
        for link in &links {
            operands.push(self.value(call, link.handle)?.registers().to_vec());
        }
        let length = operands.iter().map(Vec::len).max().unwrap_or(0);
        let site = call.site(handle);
        let seed = mix(order ^ mix(u64::from(site.function) << 32 | u64::from(site.expression)));
        // All components have the same order: a compiler sees whole vectors.
        let components = (0..length).map(|index| {
            let terms = operands.iter().zip(&links);
            let terms = terms.map(|(registers, link)| (registers[index % registers.len()], link.inverse)).collect();
            self.tree(kind, terms, seed)
        });
        Ok(Some(Value::Words(components.collect())))
    }

    /// Collects the operands of the chain that ends in an expression.
    fn links(&self, call: &Call<'a>, kind: Kind, handle: Handle<Expression>, inverse: bool, links: &mut Vec<Link>) {
        let float = |handle: Handle<Expression>| self.kind(call, handle) == Some(ScalarKind::Float);
        // Matrices are excluded, since their factors differ in the number of words. The number of
        // links is limited, since a shared expression counts each time.
        let is_float = links.len() < MOST_LINKS
            && float(handle)
            && match call.function.expressions[handle] {
                Expression::Binary { left, right, .. } => float(left) && float(right),
                _ => true,
            };
        match (&call.function.expressions[handle], kind) {
            (Expression::Binary { op: BinaryOperator::Add, left, right }, Kind::Sum)
            | (Expression::Binary { op: BinaryOperator::Multiply, left, right }, Kind::Product)
                if is_float =>
            {
                self.links(call, kind, *left, inverse, links);
                self.links(call, kind, *right, inverse, links);
            }
            (Expression::Binary { op: BinaryOperator::Subtract, left, right }, Kind::Sum)
            | (Expression::Binary { op: BinaryOperator::Divide, left, right }, Kind::Product)
                if is_float =>
            {
                self.links(call, kind, *left, inverse, links);
                self.links(call, kind, *right, !inverse, links);
            }
            (Expression::Unary { op: UnaryOperator::Negate, expr }, Kind::Sum) if is_float => {
                self.links(call, kind, *expr, !inverse, links);
            }
            _ => links.push(Link { handle, inverse }),
        }
    }

    /// Sums `terms` from first to last, or in the order that the seed gives.
    pub(super) fn sum_of(&mut self, terms: Vec<Register>) -> Register {
        match self.order {
            Some(order) => {
                let place = mix(order ^ mix(self.here() as u64));
                self.tree(Kind::Sum, terms.into_iter().map(|term| (term, false)).collect(), place)
            }
            None => terms.into_iter().reduce(|a, b| self.add(a, b)).expect("a vector has components"),
        }
    }

    /// Joins two of the remaining terms, chosen by the seed, until one remains.
    fn tree(&mut self, kind: Kind, mut terms: Vec<(Register, bool)>, mut seed: u64) -> Register {
        while terms.len() > 1 {
            seed = mix(seed);
            let one = terms.swap_remove((seed % terms.len() as u64) as usize);
            seed = mix(seed);
            let other = terms.swap_remove((seed % terms.len() as u64) as usize);
            let ((a, a_inverse), (b, b_inverse)) = (one, other);
            let joined = match (kind, a_inverse, b_inverse) {
                (Kind::Sum, false, true) => (self.subtract(a, b), false),
                (Kind::Sum, true, false) => (self.subtract(b, a), false),
                (Kind::Sum, inverse, _) => (self.add(a, b), inverse),
                (Kind::Product, false, true) => (self.divide(a, b), false),
                (Kind::Product, true, false) => (self.divide(b, a), false),
                (Kind::Product, inverse, _) => (self.multiply(a, b), inverse),
            };
            terms.push(joined);
        }
        match (terms[0], kind) {
            ((register, false), _) => register,
            ((register, true), Kind::Sum) => self.result(|to| Op::Negate { to, from: register }),
            ((register, true), Kind::Product) => {
                let one = self.constant(1f32.to_bits());
                self.divide(one, register)
            }
        }
    }
}
