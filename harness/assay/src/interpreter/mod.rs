//! Interpreter of a WGSL function on the CPU, compiled from naga's IR. A [`Machine`] performs every
//! rounding, may err as far as WGSL allows a device to, and is told of every branch taken.

mod code;
mod compile;
mod machine;
mod run;
mod site;
mod stopped;

pub use code::Float;
pub use machine::{Assumption, Decision, Exact, Machine, Nearest, Operation, Slack, Traced};
pub use run::Registers;
pub use site::Site;
pub use stopped::Stopped;

use crate::dispatch::{self, DispatchError};
use code::Code;
use naga::valid::ModuleInfo;
use naga::{Block, Expression, Function, Handle, Module, ScalarKind, Statement};

/// A branch in the source of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// Site of its decisions.
    pub site: Site,
    /// Text of the condition.
    pub condition: String,
    /// Whether it compares floats.
    pub compares_floats: bool,
}

/// A function compiled for the interpreter.
#[derive(Debug)]
pub struct Program {
    module: Module,
    info: ModuleInfo,
    source: String,
    function: Handle<Function>,
    code: Result<Code, Stopped>,
}

impl Program {
    /// Compiles the named function of WGSL source; `path` appears in messages.
    pub fn new(source: &str, path: &str, function: &str) -> Result<Program, DispatchError> {
        let (module, info) = dispatch::parse(source, path)?;
        dispatch::signature::Signature::reflect(&module, function)?;
        let found = module.functions.iter().find(|(_, found)| found.name.as_deref() == Some(function));
        let Some((function, _)) = found else { unreachable!("a reflected function is there") };
        Ok(Self::compiled(module, info, source.to_owned(), function))
    }

    /// Compiles the named function of a module. Returns `None` if the module is not valid or has no
    /// such function. Its lines and conditions have no text.
    pub fn of_module(module: Module, function: &str) -> Option<Program> {
        let info = lapidary_specialise::validate(&module).ok()?;
        let (function, _) = module.functions.iter().find(|(_, found)| found.name.as_deref() == Some(function))?;
        Some(Self::compiled(module, info, String::new(), function))
    }

    fn compiled(module: Module, info: ModuleInfo, source: String, function: Handle<Function>) -> Program {
        let code = compile::compile(&module, &info, function, None);
        Program { module, info, source, function, code }
    }

    /// Returns the same function with chains of sums and of products in another order, as WGSL
    /// allows a compiler; `seed` selects the order.
    #[must_use]
    pub fn reassociated(&self, seed: u64) -> Program {
        Program {
            module: self.module.clone(),
            info: self.info.clone(),
            source: self.source.clone(),
            function: self.function,
            code: compile::compile(&self.module, &self.info, self.function, Some(seed)),
        }
    }

    fn code(&self) -> Result<&Code, Stopped> {
        self.code.as_ref().map_err(Clone::clone)
    }

    /// Returns whether the function has a loop, and so may take long.
    pub fn loops(&self) -> bool {
        self.code.as_ref().is_ok_and(|code| code.loops)
    }

    /// Returns the numbers of words in a row of arguments and in a row of results.
    ///
    /// # Errors
    /// Returns an error if the function uses a feature that the interpreter lacks.
    pub fn words(&self) -> Result<[usize; 2], Stopped> {
        let code = self.code()?;
        Ok([code.arguments.len(), code.result.len()])
    }

    /// Returns registers for a run of the function.
    ///
    /// # Errors
    /// Returns an error if the function uses a feature that the interpreter lacks.
    pub fn registers(&self) -> Result<Registers, Stopped> {
        Ok(self.code()?.registers())
    }

    /// Runs the function on a row of arguments and appends its result. Returns the number of
    /// operations.
    ///
    /// # Errors
    /// Returns an error if the function uses a feature that the interpreter lacks, or does not end.
    pub fn run(&self, arguments: &[u32], machine: &mut impl Machine, result: &mut Vec<u32>) -> Result<u64, Stopped> {
        self.run_in(&mut self.registers()?, arguments, machine, result)
    }

    /// Runs the function as [`Program::run`] does, in the caller's registers, from
    /// [`Program::registers`].
    ///
    /// # Errors
    /// As [`Program::run`].
    pub fn run_in(
        &self,
        registers: &mut Registers,
        arguments: &[u32],
        machine: &mut impl Machine,
        result: &mut Vec<u32>,
    ) -> Result<u64, Stopped> {
        let code = self.code()?;
        let steps = code.run(arguments, registers, machine)?;
        result.extend(code.result.iter().map(|register| registers.word(*register)));
        Ok(steps)
    }

    /// Returns the numbers of the last run's results in the machine's record.
    ///
    /// # Errors
    /// Returns an error if the function uses a feature that the interpreter lacks.
    pub fn recorded(&self, registers: &Registers) -> Result<Vec<u32>, Stopped> {
        Ok(self.code()?.result.iter().map(|register| registers.number(*register)).collect())
    }

    /// Returns the branches of the function itself, without those of its callees.
    pub fn branches(&self) -> Vec<Branch> {
        let mut found = Vec::new();
        self.collect_branches(&self.module.functions[self.function].body, &mut found);
        found
    }

    /// Returns the line of source at a site, trimmed.
    pub fn line(&self, site: Site) -> &str {
        let start = self.span(site).map_or(0, |span| span.start);
        let before = self.source[..start.min(self.source.len())].matches('\n').count();
        self.source.lines().nth(before).unwrap_or_default().trim()
    }

    fn span(&self, site: Site) -> Option<std::ops::Range<usize>> {
        let (_, function) = self.module.functions.iter().nth(site.function as usize)?;
        let (handle, _) = function.expressions.iter().nth(site.expression as usize)?;
        function.expressions.get_span(handle).to_range()
    }

    fn collect_branches(&self, block: &Block, found: &mut Vec<Branch>) {
        let function = &self.module.functions[self.function];
        let branch = |site_of: Handle<naga::Expression>, condition: Handle<naga::Expression>| {
            let span = function.expressions.get_span(condition).to_range().unwrap_or_default();
            let text = self.source.get(span).unwrap_or_default();
            Branch {
                site: Site { function: self.function.index() as u32, expression: site_of.index() as u32 },
                condition: text.split_whitespace().collect::<Vec<_>>().join(" "),
                compares_floats: self.compares_floats(condition),
            }
        };
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        if let naga::Expression::Select { condition, .. } = &function.expressions[handle] {
                            found.push(branch(handle, *condition));
                        }
                    }
                }
                Statement::If { condition, .. } => found.push(branch(*condition, *condition)),
                _ => {}
            }
            match statement {
                Statement::Block(inner) => self.collect_branches(inner, found),
                Statement::If { accept, reject, .. } => {
                    self.collect_branches(accept, found);
                    self.collect_branches(reject, found);
                }
                Statement::Switch { cases, .. } => {
                    cases.iter().for_each(|case| self.collect_branches(&case.body, found));
                }
                Statement::Loop { body, continuing, .. } => {
                    self.collect_branches(body, found);
                    self.collect_branches(continuing, found);
                }
                _ => {}
            }
        }
    }

    /// Returns whether a condition compares floats, itself or in one of its parts. A stored bool
    /// may hide such a comparison.
    fn compares_floats(&self, condition: Handle<Expression>) -> bool {
        let info = &self.info[self.function];
        let is_float = |handle: Handle<Expression>| {
            info[handle].ty.inner_with(&self.module.types).scalar_kind() == Some(ScalarKind::Float)
        };
        match &self.module.functions[self.function].expressions[condition] {
            Expression::Binary { left, right, .. } => {
                is_float(*left) || self.compares_floats(*left) || self.compares_floats(*right)
            }
            Expression::Unary { expr, .. } | Expression::Splat { value: expr, .. } => self.compares_floats(*expr),
            Expression::Relational { argument, .. } => self.compares_floats(*argument),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(source: &str, arguments: &[u32], machine: &mut impl Machine) -> Vec<u32> {
        let program = Program::new(source, "test.wgsl", "f").expect("valid");
        let mut result = Vec::new();
        program.run(arguments, machine, &mut result).expect("ends");
        result
    }

    #[test]
    fn statements_run_as_wgsl_says() {
        let source = "
            struct Pair { one: vec2f, two: u32 }
            fn g(x: f32) -> f32 { if x < 0.0 { return -x; } return x; }
            fn f(a: vec3f, n: u32) -> Pair {
                var sum = vec2f(0.0);
                for (var i = 0u; i < n; i++) {
                    if i == 3u { continue; }
                    if i == 5u { break; }
                    sum.y += f32(i);
                    sum = sum + a.xz;
                }
                var table = array<u32, 3>(7u, 8u, 9u);
                table[n % 3u] += 1u;
                switch n { case 1u: { sum.x = 0.0; } default: { sum.x *= 2.0; } }
                return Pair(vec2f(g(sum.x), sum.y), table[n % 3u]);
            }";
        let row = [(-1f32).to_bits(), 2f32.to_bits(), 3f32.to_bits(), 9];
        let result = call(source, &row, &mut Nearest);
        // Iterations 0, 1, 2 and 4.
        assert_eq!(result, [8f32.to_bits(), (7f32 + 12.0).to_bits(), 8]);
    }

    /// The table holds bodies of a function of one u32, each with arguments and the results under
    /// WGSL's rules.
    #[test]
    fn control_flow_is_wgsls() {
        let table: [(&str, [(u32, u32); 3]); 12] = [
            // A break leaves the switch; a continue ends the iteration of the loop around it.
            (
                "var s = 0u; for (var i = 0u; i < n; i++) { switch i { case 1u: { continue; } case 2u: { break; } default: { s += 10u; } } s += 1u; } return s;",
                [(1, 11), (3, 12), (5, 34)],
            ),
            (
                "var s = 0u; loop { s += 2u; continuing { s += 1u; break if s > n; } } return s;",
                [(0, 3), (3, 6), (7, 9)],
            ),
            (
                "var s = 0u; loop { if s == n { break; } s += 1u; continuing { s += 1u; } } return s;",
                [(0, 0), (2, 2), (6, 6)],
            ),
            ("switch n { case 1u, 2u: { return 5u; } case default, 3u: { return 7u; } }", [(1, 5), (2, 5), (9, 7)]),
            ("switch n { case default: { return 7u; } case 4u: { return 8u; } }", [(4, 8), (0, 7), (5, 7)]),
            // A return from a loop in an inlined call ends only the call.
            ("return first(n) * 100u + first(n + 1u);", [(0, 1), (2, 203), (7, 404)]),
            // A variable in a loop is initialised in each iteration.
            (
                "var s = 0u; for (var i = 0u; i < n; i++) { var t: u32; t += 1u; s += t; } return s;",
                [(0, 0), (1, 1), (4, 4)],
            ),
            ("var s = 0u; for (var i = 0u; i < n; i++) { s += counted(i); } return s;", [(1, 1), (2, 3), (3, 6)]),
            // A pointer to an indexed element.
            (
                "var a = array<u32, 4>(1u, 2u, 3u, 4u); raise(&a[n % 4u]); return a[0] * 1000u + a[1] * 100u + a[2] * 10u + a[3];",
                [(0, 6234), (1, 1734), (3, 1239)],
            ),
            (
                "var m = array<vec3u, 2>(vec3u(1u, 2u, 3u), vec3u(4u, 5u, 6u)); m[n % 2u][n % 3u] = 9u; let r = m[n % 2u]; return r.x * 100u + r.y * 10u + r.z;",
                [(0, 923), (1, 496), (2, 129)],
            ),
            ("let m = mat2x2f(1.0, 2.0, 3.0, 4.0); return u32(m[n % 2u][(n / 2u) % 2u]);", [(0, 1), (1, 3), (3, 4)]),
            // A loaded value does not change.
            ("var a = n; let b = a; a += 1u; var c = a; c += b; return c * 10u + b;", [(0, 10), (1, 31), (2, 52)]),
        ];
        for (body, rows) in table {
            let source = format!(
                "fn first(n: u32) -> u32 {{ for (var i = 0u; i < 9u; i++) {{ if i == n {{ return i; }} if i == 4u {{ return 4u; }} }} return 9u; }}
                fn counted(n: u32) -> u32 {{ var s = 0u; for (var i = 0u; i <= n; i++) {{ s += 1u; }} return s; }}
                fn raise(p: ptr<function, u32>) {{ *p += 5u; }}
                fn f(n: u32) -> u32 {{ {body} }}"
            );
            for (argument, result) in rows {
                assert_eq!(call(&source, &[argument], &mut Nearest), [result], "{body} of {argument}");
            }
        }
    }

    #[test]
    fn an_endless_loop_ends() {
        let program = Program::new("fn f(x: u32) -> u32 { loop { if x > 9u { break; } } return x; }", "t", "f");
        let stopped = program.expect("valid").run(&[3], &mut Nearest, &mut Vec::new()).expect_err("it never ends");
        assert!(stopped.to_string().contains("did not end"), "{stopped}");
    }

    #[test]
    fn branches_are_found_and_noted() {
        let source = "
            fn f(x: f32, n: u32) -> f32 {
                if (x < 1.0 && n == 2u) { return 0.0; }
                return select(x, -x, x > 4.0);
            }";
        let program = Program::new(source, "t", "f").expect("valid");
        let branches = program.branches();
        assert!(branches.iter().any(|branch| branch.condition == "x > 4.0" && branch.compares_floats), "{branches:?}");
        let trace = |x: f32| {
            let mut traced = Traced::default();
            program.run(&[x.to_bits(), 3], &mut traced, &mut Vec::new()).expect("ends");
            traced.decisions
        };
        assert_eq!(trace(2.0), trace(3.0));
        let (low, high) = (trace(2.0), trace(5.0));
        let differing: Vec<&str> =
            low.iter().zip(&high).filter(|(a, b)| a != b).map(|(a, _)| program.line(a.site)).collect();
        assert_eq!(differing, ["return select(x, -x, x > 4.0);"]);
    }
}
