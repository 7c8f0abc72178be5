//! A kernel that also reports whether its function computed an infinity or a NaN on the way. WGSL
//! leaves the effect of one in `clamp`, `min` or `select` to each device, so a result that depends
//! on it is right by chance.

use super::error::DispatchError;
use super::kernel::{self, kernel_source};
use super::layout::Layout;
use super::module::KernelModule;
use super::signature::Signature;
use super::source::parse;
use lapidary_specialise::validate;
use naga::{BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal, MathFunction};
use naga::{RelationalFunction, Scalar, ScalarKind, Span, Statement, TypeInner, VectorSize};

/// Private variable that records an infinity or a NaN.
const FLAG: &str = "lapidary_kernel_nonfinite";

impl KernelModule {
    /// Reflects like `reflect`, with one more word at the end of each result. The word is 0 until
    /// [`KernelModule::watched`] gives it a meaning.
    pub fn reflect_watched(source: &str, path: &str, function: &str) -> Result<KernelModule, DispatchError> {
        let (module, _) = parse(source, path)?;
        let signature = Signature::reflect(&module, function)?;
        let text = with_flag(&kernel_source(&signature));
        let (module, _) = parse(&format!("{source}\n{text}"), path)?;
        let input = Layout::of_struct(&module, kernel::INPUT);
        let output = Layout::of_struct(&module, kernel::OUTPUT);
        Ok(KernelModule { signature, module, input, output })
    }

    /// Returns the same kernel; the last word of a result is 1 if any sum, product, quotient or
    /// function of floats was not finite, outside of `continuing` blocks.
    pub fn watched(mut self) -> KernelModule {
        let flag = self.module.global_variables.iter().find(|(_, variable)| variable.name.as_deref() == Some(FLAG));
        let Some((flag, _)) = flag else { return self };
        let Ok(info) = validate(&self.module) else { return self };
        let types: Vec<Vec<Option<Option<VectorSize>>>> = self
            .module
            .functions
            .iter()
            .map(|(owner, function)| {
                let size =
                    |handle: Handle<Expression>| float_size(info[owner][handle].ty.inner_with(&self.module.types));
                function.expressions.iter().map(|(handle, _)| size(handle)).collect()
            })
            .collect();
        for ((_, function), types) in self.module.functions.iter_mut().zip(types) {
            let body = std::mem::take(&mut function.body);
            let watched = watch(body, function, &types, flag);
            function.body = watched;
        }
        self
    }
}

/// Declares the flag in the generated text and appends it to the result.
fn with_flag(text: &str) -> String {
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.starts_with("    result: ") {
            lines.push(line.to_owned());
            lines.push("    nonfinite: u32,".to_owned());
        } else if line.contains(&format!("= {}(", kernel::OUTPUT)) {
            lines.push(format!("{}, {FLAG});", line.trim_end().trim_end_matches(");")));
        } else {
            lines.push(line.to_owned());
        }
    }
    format!("var<private> {FLAG}: u32;\n{}\n", lines.join("\n"))
}

/// Returns the vector size of a float type: `Some(None)` for a scalar, `None` for other types.
fn float_size(inner: &TypeInner) -> Option<Option<VectorSize>> {
    match inner {
        TypeInner::Scalar(Scalar::F32) => Some(None),
        TypeInner::Vector { size, scalar: Scalar::F32 } => Some(Some(*size)),
        _ => None,
    }
}

/// Inserts a test after each computation of floats.
fn watch(
    block: Block,
    function: &mut Function,
    types: &[Option<Option<VectorSize>>],
    flag: Handle<GlobalVariable>,
) -> Block {
    let mut watched = Block::new();
    for (statement, span) in block.span_into_iter() {
        match statement {
            Statement::Emit(range) => {
                let computed: Vec<(Handle<Expression>, Option<VectorSize>)> = range
                    .clone()
                    .filter(|handle| {
                        matches!(function.expressions[*handle], Expression::Binary { .. } | Expression::Math { .. })
                    })
                    .filter_map(|handle| Some((handle, types.get(handle.index()).copied().flatten()?)))
                    .collect();
                watched.push(Statement::Emit(range), span);
                for (handle, size) in computed {
                    test(&mut watched, function, (handle, size), NOT_FINITE, flag);
                    // By WGSL's definition this is exp2(y log2(0)), whatever a device returns.
                    if let Expression::Math { fun: MathFunction::Pow, arg, .. } = function.expressions[handle] {
                        test(&mut watched, function, (arg, size), ZERO, flag);
                    }
                }
            }
            Statement::Block(inner) => watched.push(Statement::Block(watch(inner, function, types, flag)), span),
            Statement::If { condition, accept, reject } => {
                let accept = watch(accept, function, types, flag);
                let reject = watch(reject, function, types, flag);
                watched.push(Statement::If { condition, accept, reject }, span);
            }
            Statement::Loop { body, continuing, break_if } => {
                let body = watch(body, function, types, flag);
                // `break_if` reads the values emitted last.
                watched.push(Statement::Loop { body, continuing, break_if }, span);
            }
            Statement::Switch { selector, mut cases } => {
                for case in &mut cases {
                    let body = std::mem::take(&mut case.body);
                    case.body = watch(body, function, types, flag);
                }
                watched.push(Statement::Switch { selector, cases }, span);
            }
            other => watched.push(other, span),
        }
    }
    watched
}

/// A mask, and the required value of the bits under it.
type Pattern = (u32, u32);
const NOT_FINITE: Pattern = (0x7f80_0000, 0x7f80_0000);
const ZERO: Pattern = (0x7fff_ffff, 0);

/// Tests the bits: a comparison of floats may be compiled as if there were no NaN.
fn test(
    block: &mut Block,
    function: &mut Function,
    (value, size): (Handle<Expression>, Option<VectorSize>),
    (mask, wanted): Pattern,
    flag: Handle<GlobalVariable>,
) {
    let span = Span::UNDEFINED;
    let expressions = &mut function.expressions;
    let pointer = expressions.append(Expression::GlobalVariable(flag), span);
    let one = expressions.append(Expression::Literal(Literal::U32(1)), span);
    let mut mask = expressions.append(Expression::Literal(Literal::U32(mask)), span);
    let mut wanted = expressions.append(Expression::Literal(Literal::U32(wanted)), span);
    let before = expressions.len();
    if let Some(size) = size {
        mask = expressions.append(Expression::Splat { size, value: mask }, span);
        wanted = expressions.append(Expression::Splat { size, value: wanted }, span);
    }
    let bits = expressions.append(Expression::As { expr: value, kind: ScalarKind::Uint, convert: None }, span);
    let masked = expressions.append(Expression::Binary { op: BinaryOperator::And, left: bits, right: mask }, span);
    let mut is =
        expressions.append(Expression::Binary { op: BinaryOperator::Equal, left: masked, right: wanted }, span);
    if size.is_some() {
        is = expressions.append(Expression::Relational { fun: RelationalFunction::Any, argument: is }, span);
    }
    block.push(Statement::Emit(expressions.range_from(before)), span);
    let mut accept = Block::new();
    accept.push(Statement::Store { pointer, value: one }, span);
    block.push(Statement::If { condition: is, accept, reject: Block::new() }, span);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dispatch::Kernel;
    use crate::runner::Runner;
    use lapidary_gpu::{AdapterChoice, Gpu};

    const SOURCE: &str = "fn subject(x: f32, y: vec2f) -> f32 {\n    var sum = 0.0f;\n    if x > 1.0f {\n        \
                          sum = clamp((y.x * y).x / x, 0.0f, 1.0f);\n    } else {\n        sum = clamp(1.0f / x, 0.0f, \
                          1.0f);\n    }\n    return sum;\n}\n";

    #[test]
    fn what_is_not_finite_on_the_way_is_seen_though_the_result_is() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("an adapter");
        let kernel = KernelModule::reflect_watched(SOURCE, "subject", "subject").expect("reflected").watched();
        let mut kernel = Kernel::new(gpu, kernel).expect("compiles");
        let rows = [[2.0, 1.0, 1.0], [0.5, 1.0, 1.0], [0.0, 1.0, 1.0], [2.0, 3e38, 1.0], [0.5, 3e38, 3e38]];
        let words: Vec<u32> = rows.iter().flatten().map(|value: &f32| value.to_bits()).collect();
        let mut results = Vec::new();
        kernel.run(&words, &mut results).expect("runs");
        let seen: Vec<u32> = results.chunks_exact(2).map(|row| row[1]).collect();
        assert_eq!(seen, [0, 0, 1, 1, 0]);
        assert!(results.chunks_exact(2).all(|row| f32::from_bits(row[0]).is_finite()));
    }
}
