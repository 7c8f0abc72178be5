//! A WGSL function on the CPU, run on naga's IR: with every rounding in the hands of a [`Machine`], which may err as far as WGSL lets a
//! device, and with every branch that is taken told to it.

mod arithmetic;
mod builtin;
mod layout;
mod machine;

pub use machine::{Decision, Machine, Nearest, Site, Slack, Slacking, Traced};

use crate::dispatch::{self, DispatchError};
use layout::{Frame, Layout};
use naga::{Block, Function, Handle, Statement, SwitchValue};

/// Statements that one call may run: more is an endless loop.
const MOST_STATEMENTS: u64 = 2_000_000;

/// What the interpreter cannot run, or did not end.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Stopped(String);

/// A branch of a function, as its source has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// Where decisions of it are noted.
    pub site: Site,
    /// The condition's text.
    pub condition: String,
    /// Whether it compares floats.
    pub compares_floats: bool,
}

/// A function that can be run.
#[derive(Debug)]
pub struct Program {
    module: naga::Module,
    source: String,
    layouts: Vec<Layout>,
    function: Handle<Function>,
}

/// Where a block's statements end.
enum Flow {
    Next,
    Break,
    Continue,
    Return,
}

/// One call's state: the machine, and what is left of its time.
struct Run<'a, M> {
    machine: &'a mut M,
    statements: u64,
}

impl Program {
    /// The function of that name in WGSL source; `path` is for messages.
    pub fn new(source: &str, path: &str, function: &str) -> Result<Program, DispatchError> {
        let (module, info) = dispatch::parse(source, path)?;
        dispatch::signature::Signature::reflect(&module, function)?;
        let found = module.functions.iter().find(|(_, found)| found.name.as_deref() == Some(function));
        let Some((function, _)) = found else { unreachable!("a reflected function is there") };
        let layouts =
            module.functions.iter().map(|(handle, found)| Layout::of(&module, &info[handle], found)).collect();
        Ok(Program { module, source: source.to_owned(), layouts, function })
    }

    /// Runs the function on a row of arguments and appends its result. Returns how many statements it ran.
    pub fn run(&self, arguments: &[u32], machine: &mut impl Machine, result: &mut Vec<u32>) -> Result<u64, Stopped> {
        let mut run = Run { machine, statements: 0 };
        let mut frame = self.frame(self.function);
        frame.set_arguments(arguments);
        self.block(&mut frame, &self.module.functions[self.function].body, &mut run)?;
        result.extend_from_slice(&frame.result);
        Ok(run.statements)
    }

    /// The branches of the function itself: those of what it calls are theirs.
    pub fn branches(&self) -> Vec<Branch> {
        let mut found = Vec::new();
        self.collect_branches(&self.module.functions[self.function].body, &mut found);
        found
    }

    /// The line of source that a site is on, trimmed.
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

    fn frame(&self, function: Handle<Function>) -> Frame<'_> {
        Frame::new(&self.module.functions[function], &self.layouts[function.index()], function)
    }

    fn block<M: Machine>(&self, frame: &mut Frame<'_>, block: &Block, run: &mut Run<'_, M>) -> Result<Flow, Stopped> {
        for statement in block {
            run.statements += 1;
            if run.statements > MOST_STATEMENTS {
                return Err(Stopped(format!("ran {MOST_STATEMENTS} statements and did not end")));
            }
            let flow = match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        frame.evaluate(&self.module, handle, run.machine)?;
                    }
                    Flow::Next
                }
                Statement::Block(inner) => self.block(frame, inner, run)?,
                Statement::If { condition, accept, reject } => {
                    let chosen = frame.word(*condition) != 0;
                    run.machine.decided(frame.site(*condition), chosen.into());
                    self.block(frame, if chosen { accept } else { reject }, run)?
                }
                Statement::Switch { selector, cases } => self.switch(frame, frame.word(*selector), cases, run)?,
                Statement::Loop { body, continuing, break_if } => loop {
                    match self.block(frame, body, run)? {
                        Flow::Break => break Flow::Next,
                        Flow::Return => break Flow::Return,
                        Flow::Next | Flow::Continue => {}
                    }
                    self.block(frame, continuing, run)?;
                    if break_if.is_some_and(|condition| frame.word(condition) != 0) {
                        break Flow::Next;
                    }
                },
                Statement::Break => Flow::Break,
                Statement::Continue => Flow::Continue,
                Statement::Return { value } => {
                    if let Some(value) = value {
                        frame.result = frame.words(*value).to_vec();
                    }
                    Flow::Return
                }
                Statement::Store { pointer, value } => {
                    frame.store(*pointer, *value);
                    Flow::Next
                }
                Statement::Call { function, arguments, result } => {
                    let mut callee = self.frame(*function);
                    let words: Vec<u32> =
                        arguments.iter().flat_map(|argument| frame.words(*argument).to_vec()).collect();
                    callee.set_arguments(&words);
                    self.block(&mut callee, &self.module.functions[*function].body, run)?;
                    if let Some(result) = result {
                        frame.set(*result, &callee.result);
                    }
                    Flow::Next
                }
                other => return Err(Stopped(format!("cannot run {other:?} on the CPU"))),
            };
            if !matches!(flow, Flow::Next) {
                return Ok(flow);
            }
        }
        Ok(Flow::Next)
    }

    fn switch<M: Machine>(
        &self,
        frame: &mut Frame<'_>,
        selector: u32,
        cases: &[naga::SwitchCase],
        run: &mut Run<'_, M>,
    ) -> Result<Flow, Stopped> {
        let is_chosen = |case: &naga::SwitchCase| match case.value {
            SwitchValue::I32(value) => value.cast_unsigned() == selector,
            SwitchValue::U32(value) => value == selector,
            SwitchValue::Default => false,
        };
        let default = || cases.iter().position(|case| matches!(case.value, SwitchValue::Default));
        let Some(first) = cases.iter().position(is_chosen).or_else(default) else { return Ok(Flow::Next) };
        for case in &cases[first..] {
            match self.block(frame, &case.body, run)? {
                Flow::Next if case.fall_through => {}
                Flow::Next | Flow::Break => break,
                flow => return Ok(flow),
            }
        }
        Ok(Flow::Next)
    }

    fn collect_branches(&self, block: &Block, found: &mut Vec<Branch>) {
        let layout = &self.layouts[self.function.index()];
        let function = &self.module.functions[self.function];
        let branch = |site_of: Handle<naga::Expression>, condition: Handle<naga::Expression>| {
            let span = function.expressions.get_span(condition).to_range().unwrap_or_default();
            let text = self.source.get(span).unwrap_or_default();
            Branch {
                site: Site { function: self.function.index() as u32, expression: site_of.index() as u32 },
                condition: text.split_whitespace().collect::<Vec<_>>().join(" "),
                compares_floats: layout.compares_floats(function, condition),
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
        // Turns 0, 1, 2 and 4.
        assert_eq!(result, [8f32.to_bits(), (7f32 + 12.0).to_bits(), 8]);
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

    #[test]
    fn a_device_may_err_as_far_as_wgsl_lets_it() {
        let source = "fn f(x: f32, y: f32) -> f32 { return x * y / 3.0; }";
        let row = [1.1f32.to_bits(), 1.3f32.to_bits()];
        let exact = f64::from(1.1f32) * f64::from(1.3f32) / 3.0;
        let ulps = |directions: &[f64]| {
            let result = call(source, &row, &mut Slacking::new(directions.to_vec()));
            (f64::from(f32::from_bits(result[0])) - exact) / 2f64.powi(-25)
        };
        assert!(ulps(&[1.0, 1.0]) > 1.5 && ulps(&[1.0, 1.0]) <= 2.5 + 1.4);
        assert!(ulps(&[-1.0, -1.0]) < -1.5 && ulps(&[0.0, 0.0]).abs() < 1.5);
    }
}
