//! Random shaders: nested branches, switches, loops and calls whose conditions mix overrides and
//! run-time values in every proportion.

use lapidary_assay::draws::Draws;
use std::fmt::Write as _;

/// Greatest nesting depth of branches, switches and loops.
const DEEPEST: u32 = 2;

/// Returns the function `subject(x: f32, n: u32) -> Outcome`, all functions that it calls, and the
/// overrides that it reads. The outcome always depends on `n`: a kernel that reads no argument
/// would lose the binding of its arguments.
pub fn random_program(draws: &mut Draws<'_>) -> String {
    let mut writer = Writer { draws, text: PRELUDE.to_owned(), names: 0, helpers: 0, in_helper: false };
    for name in HELPERS {
        writer.in_helper = true;
        let _ = writeln!(writer.text, "fn {name}(flag: bool, mode: u32, x: f32, n: u32) -> f32 {{");
        writer.variables();
        writer.statements(1, "value");
        writer.text.push_str("    return value;\n}\n");
        writer.helpers += 1;
    }
    writer.in_helper = false;
    writer.text.push_str("fn subject(x: f32, n: u32) -> Outcome {\n");
    writer.variables();
    writer.statements(0, "Outcome(value, hash ^ trace ^ n)");
    writer.text.push_str("    return Outcome(value, hash ^ trace ^ n);\n}\n");
    writer.text
}

/// Returns the overrides with random values.
pub fn random_constants(draws: &mut Draws<'_>) -> Vec<(&'static str, f64)> {
    let mut constants: Vec<_> = SWITCHES.iter().map(|name| (*name, f64::from(draws.below(2)))).collect();
    constants.push(("COUNT", f64::from(draws.below(4))));
    constants.push(("SCALE", f64::from(draws.below(9)) * 0.25 - 0.875));
    constants
}

const SWITCHES: [&str; 3] = ["FIRST", "SECOND", "THIRD"];
const HELPERS: [&str; 2] = ["inner_helper", "outer_helper"];

/// `note` and `bump` have effects, whose order shows in the outcome.
const PRELUDE: &str = "
override FIRST: bool;
override SECOND: bool;
override THIRD: bool;
override COUNT: u32;
override SCALE: f32;
const TABLE = array<f32, 4>(0.25f, -1.5f, 2.0f, 0.75f);
struct Outcome { value: f32, hash: u32 }
var<private> trace: u32;
fn note(what: u32) -> bool {
    trace = (trace ^ what) * 16777619u + 1u;
    return (trace & 4u) == 0u;
}
fn bump(hash: ptr<function, u32>, twice: bool) {
    *hash = *hash * 5u + 1u;
    if (twice) { *hash ^= *hash >> 7u; }
}
";

struct Writer<'a, 'draws> {
    draws: &'a mut Draws<'draws>,
    text: String,
    /// Names given so far.
    names: u32,
    /// Helpers written so far, which may be called.
    helpers: usize,
    in_helper: bool,
}

impl Writer<'_, '_> {
    fn variables(&mut self) {
        self.text.push_str("    var value = 0.5f;\n    var hash = 7u;\n    var state = false;\n");
    }

    /// Writes a few statements. An early return returns `result`.
    fn statements(&mut self, depth: u32, result: &str) {
        for _ in 0..2 + self.draws.below(4) {
            self.statement(depth, result);
        }
    }

    fn line(&mut self, line: &str) {
        self.text.push_str("    ");
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn statement(&mut self, depth: u32, result: &str) {
        match self.draws.below(if depth < DEEPEST { 14 } else { 7 }) {
            0 => {
                let value = self.float(0);
                self.line(&format!("value = clamp({value}, -8.0f, 8.0f);"));
            }
            1 => {
                let whole = self.whole(0);
                self.line(&format!("hash = hash * 31u + {whole};"));
            }
            2 => {
                let truth = self.truth(0);
                self.line(&format!("state = {truth};"));
            }
            3 => {
                let whole = self.whole(0);
                self.line(&format!("_ = note({whole});"));
            }
            4 => {
                let truth = self.truth(1);
                self.line(&format!("bump(&hash, {truth});"));
            }
            5 | 6 => self.call(),
            7..10 => {
                let truth = self.truth(0);
                self.line(&format!("if ({truth}) {{"));
                self.statements(depth + 1, result);
                if self.draws.below(2) == 0 {
                    self.line("} else {");
                    self.statements(depth + 1, result);
                }
                self.line("}");
            }
            10 => self.switch(depth, result),
            11 => self.repeat(depth, result),
            12 => {
                let truth = self.truth(0);
                self.line(&format!("if ({truth}) {{ return {result}; }}"));
            }
            _ => {
                let name = self.name();
                let (first, condition, second) = (self.truth(1), self.truth(1), self.truth(1));
                self.line(&format!("var {name} = {first}; if ({condition}) {{ {name} = {second}; }} if ({name}) {{"));
                self.statements(depth + 1, result);
                self.line("}");
            }
        }
    }

    fn switch(&mut self, depth: u32, result: &str) {
        let selector = self.whole(0);
        self.line(&format!("switch ({selector} % 4u) {{"));
        for case in ["case 0u: {", "case 2u, 3u: {", "default: {"] {
            self.line(case);
            self.statements(depth + 1, result);
            if self.draws.below(3) == 0 {
                let truth = self.truth(0);
                self.line(&format!("if ({truth}) {{ break; }}"));
                self.statement(depth + 1, result);
            }
            self.line("}");
        }
        self.line("}");
    }

    fn repeat(&mut self, depth: u32, result: &str) {
        let name = self.name();
        let bound = self.draws.pick(&["COUNT", "n % 3u", "2u", "(COUNT & 1u)", "(COUNT / 3u)"]);
        let jump = self.draws.pick(&["break", "continue"]);
        self.line(&format!("for (var {name} = 0u; {name} < {bound}; {name}++) {{"));
        self.line(&format!("hash += {name};"));
        self.statements(depth + 1, result);
        if self.draws.below(2) == 0 {
            let truth = self.truth(0);
            self.line(&format!("if ({truth}) {{ {jump}; }}"));
            self.statement(depth + 1, result);
        }
        self.line("}");
    }

    /// Writes a call. The flags are mostly the same in every call.
    fn call(&mut self) {
        let Some(helper) = self.helpers.checked_sub(1) else { return self.line("hash += 3u;") };
        let helper = HELPERS[self.draws.below(helper as u32 + 1) as usize];
        let flag = if self.draws.below(4) == 0 { self.truth(1) } else { "SECOND".to_owned() };
        let mode = if self.draws.below(4) == 0 { self.whole(1) } else { "COUNT".to_owned() };
        let (x, n) = (self.float(1), self.whole(1));
        self.line(&format!("value = clamp({helper}({flag}, {mode}, {x}, {n}), -8.0f, 8.0f);"));
    }

    fn name(&mut self) -> String {
        self.names += 1;
        format!("local_{}_", self.names)
    }

    fn float(&mut self, depth: u32) -> String {
        let (next, most) = (depth + 1, if depth < 2 { 10 } else { 4 });
        match self.draws.below(most) {
            0 => "x".to_owned(),
            1 => "value".to_owned(),
            2 => self.draws.pick(&["0.5f", "-1.25f", "3.0f"]).to_owned(),
            3 => "SCALE".to_owned(),
            4 | 5 => format!("({} + {})", self.float(next), self.float(next)),
            6 => format!("({} * {})", self.float(next), self.float(next)),
            7 => format!("select({}, {}, {})", self.float(next), self.float(next), self.truth(next)),
            8 => format!("TABLE[{} % 4u]", self.whole(next)),
            _ => format!("vec2f({}, {}).y", self.float(next), self.float(next)),
        }
    }

    fn whole(&mut self, depth: u32) -> String {
        let (next, most) = (depth + 1, if depth < 2 { 10 } else { 5 });
        match self.draws.below(most) {
            0 => "n".to_owned(),
            1 => "hash".to_owned(),
            2 => self.draws.pick(&["0u", "1u", "6u"]).to_owned(),
            3 => "COUNT".to_owned(),
            4 => (if self.in_helper { "mode" } else { "COUNT" }).to_owned(),
            5 => format!("({} + {})", self.whole(next), self.whole(next)),
            6 => format!("({} * {})", self.whole(next), self.whole(next)),
            7 => format!("({} ^ ({} >> 2u))", self.whole(next), self.whole(next)),
            8 => format!("select({}, {}, {})", self.whole(next), self.whole(next), self.truth(next)),
            _ => format!("u32({})", self.truth(next)),
        }
    }

    fn truth(&mut self, depth: u32) -> String {
        let (next, most) = (depth + 1, if depth < 2 { 14 } else { 6 });
        match self.draws.below(most) {
            0..3 => self.draws.pick(&SWITCHES).to_owned(),
            3 => "state".to_owned(),
            4 => (if self.in_helper { "flag" } else { "FIRST" }).to_owned(),
            5 => format!("({} < {})", self.float(2), self.float(2)),
            6 => format!("({} % 3u == 1u)", self.whole(next)),
            7 | 8 => format!("({} && {})", self.truth(next), self.truth(next)),
            9 | 10 => format!("({} || {})", self.truth(next), self.truth(next)),
            11 => format!("!{}", self.truth(next)),
            12 => format!("({} & {})", self.truth(next), self.truth(next)),
            // With an effect on the right of `&&`, where it may be skipped.
            _ => format!("({} && note({}))", self.truth(next), self.whole(next)),
        }
    }
}
