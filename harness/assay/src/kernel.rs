//! A property test of a compute entry point on whole buffers: [`kernel`] names the entry point,
//! further methods state its requirements, and [`KernelTest::run`] runs the test.

mod buffers;
mod program;

pub use buffers::{Buffer, Buffers, Type};

use crate::accuracy_line::{FieldBound, check_fields, parse_bounds};
use crate::dispatch::signature::difference;
use crate::draws::{Domain, Draws};
use crate::environment::{self, SEED_VARIABLE};
use crate::examination::not_reached;
use crate::formula::Words;
use crate::literal::{self, Language};
use crate::property::Settings;
use crate::tolerance::{Tolerance, numbers};
use crate::wgsl::{Failure, Outcome};
use program::{Binding, Program};
use proptest::strategy::Strategy;
use std::fmt::{self, Write as _};

/// Default number of random inputs.
const DEFAULT_CASES: u64 = 256;
/// Maximum number of dispatches for shrinking an input.
const MOST_SHRINKS: usize = 2_000;

/// Begins a test of the compute entry point `entry` in `source`, a WGSL text that is valid by
/// itself.
pub fn kernel(source: impl Into<String>, entry: &'static str) -> KernelSource {
    KernelSource { text: source.into(), entry, constants: Vec::new() }
}

/// A compute entry point without a mirror.
#[derive(Clone, Debug)]
pub struct KernelSource {
    text: String,
    entry: &'static str,
    constants: Vec<(&'static str, f64)>,
}

impl KernelSource {
    /// Sets the value of an `override`; a bool is 0 or 1.
    #[must_use]
    pub fn constant(mut self, name: &'static str, value: f64) -> Self {
        self.constants.push((name, value));
        self
    }

    /// Sets the mirror, a Rust function with the kernel's effect on its buffers. The buffers that
    /// the entry point uses form a tuple in the order of groups and bindings: a `Vec` for a
    /// runtime-sized array, an integer for an atomic, otherwise one value. Their types are checked
    /// against the shader's.
    pub fn mirror<B: Buffers>(self, mirror: impl Fn(&mut B) + 'static) -> KernelMirror<B> {
        KernelMirror { source: self, mirror: Box::new(mirror) }
    }
}

type Mirror<B> = Box<dyn Fn(&mut B)>;
type Workgroups<B> = Box<dyn Fn(&B) -> [u32; 3]>;
type Reached<B> = Box<dyn Fn(&B) -> bool>;
/// The tolerance of each buffer, if it has one.
type Tolerances = Vec<Option<Tolerance>>;

/// A compute entry point with its mirror.
pub struct KernelMirror<B> {
    source: KernelSource,
    mirror: Mirror<B>,
}

impl<B: Buffers + fmt::Debug + 'static> KernelMirror<B> {
    /// Takes buffers from a proptest strategy, which also shrinks failing inputs. Output buffers
    /// are included, since the kernel sees their length.
    pub fn inputs(self, strategy: impl Strategy<Value = B> + Send + Sync + 'static) -> KernelTest<B> {
        self.over(Domain::of_strategy(strategy.prop_map(|buffers| buffers.words())))
    }

    /// Takes buffers from draws. Every guarantee of the generator also holds for the shrunk inputs.
    pub fn draws(self, generate: impl Fn(&mut Draws<'_>) -> B + Send + Sync + 'static) -> KernelTest<B> {
        self.over(Domain::new(move |draws| generate(draws).words()))
    }

    fn over(self, domain: Domain<Vec<Words>>) -> KernelTest<B> {
        let Self { source, mirror } = self;
        let settings = Settings { cases: DEFAULT_CASES, ..Settings::default() };
        let workgroups = Box::new(|_: &B| [1, 1, 1]);
        KernelTest {
            source,
            mirror,
            domain,
            workgroups,
            bounds: Vec::new(),
            kept: Vec::new(),
            edges: Vec::new(),
            settings,
        }
    }
}

/// A property test of a kernel, ready to run.
#[must_use = "a test says nothing until it is run"]
pub struct KernelTest<B> {
    source: KernelSource,
    mirror: Mirror<B>,
    domain: Domain<Vec<Words>>,
    workgroups: Workgroups<B>,
    bounds: Vec<(&'static str, String)>,
    /// Inputs that are always tested.
    kept: Vec<Vec<Words>>,
    edges: Vec<(&'static str, Reached<B>)>,
    settings: Settings,
}

/// The element with the largest error in a run.
struct Worst {
    buffer: usize,
    element: usize,
    ratio: f64,
    got: Words,
    expected: Words,
}

impl<B: Buffers + fmt::Debug + 'static> KernelTest<B> {
    /// Sets the number of workgroups to dispatch for these buffers; the default is one.
    pub fn workgroups(mut self, workgroups: impl Fn(&B) -> [u32; 3] + 'static) -> Self {
        self.workgroups = Box::new(workgroups);
        self
    }

    /// Sets the tolerance of the named buffer's elements: a sum of `ulp`, `abs` and `rel` terms;
    /// for structs, one sum per field. Without a tolerance, the buffer must equal the mirror's to
    /// the bit.
    pub fn within(mut self, buffer: &'static str, bounds: &str) -> Self {
        self.bounds.push((buffer, bounds.to_owned()));
        self
    }

    /// Names a part of the inputs that a run must reach.
    pub fn edge(mut self, name: &'static str, reached: impl Fn(&B) -> bool + 'static) -> Self {
        self.edges.push((name, Box::new(reached)));
        self
    }

    /// Adds buffers that are always tested, such as those of a failure: the tuple that it prints
    /// after `in Rust`.
    pub fn case(mut self, buffers: B) -> Self {
        self.kept.push(buffers.words());
        self
    }

    /// Sets the number of random inputs; the default is 256.
    pub fn cases(mut self, cases: u64) -> Self {
        self.settings.cases = cases;
        self
    }

    /// Sets the seed; `ASSAY_SEED` overrides it.
    pub fn seed(mut self, seed: u64) -> Self {
        self.settings.seed = seed;
        self
    }

    /// Runs the kernel on the device that `LAPIDARY_ADAPTER` names. An endless loop is not stopped
    /// here; the driver's limits apply.
    ///
    /// # Errors
    /// Returns an error if a buffer is wrong, with the simplest input found; if the source is not
    /// valid or its buffers differ; or if there is no adapter, unless `ASSAY_WITHOUT_ADAPTER=skip`.
    pub fn run(mut self) -> Outcome {
        let entry = self.source.entry;
        let fail = |what: String| Failure::new(format!("{entry}: {what}"));
        if self.settings.cases == 0 && self.kept.is_empty() {
            return Err(fail("no cases: nothing would be tested".to_owned()));
        }
        self.settings.seed = environment::seed().map_err(fail)?.unwrap_or(self.settings.seed);
        let gpu = environment::gpu(entry).map_err(|error| fail(error.to_string()))?;
        let Some(gpu) = gpu else { return Ok(()) };
        let program = Program::new(gpu, &self.source.text, entry, &self.source.constants).map_err(fail)?;
        expect(&program.bindings, &B::types()).map_err(fail)?;
        let tolerances = self.tolerances(&program.bindings).map_err(fail)?;
        let Settings { cases, seed } = self.settings;
        for kept in &self.kept {
            let found = self.judge(&program, &tolerances, kept).map_err(fail)?;
            if let Some(found) = found.filter(|found| found.ratio > 1.0) {
                return Err(fail(self.describe(&program, &tolerances, kept, &found, 1)));
            }
        }
        let (mut failed, mut worst): (u64, Option<(u64, Worst)>) = (0, None);
        let mut missed: Vec<&(&str, Reached<B>)> = self.edges.iter().collect();
        for row in 0..cases {
            let buffers = self.domain.row(seed, row);
            missed.retain(|(_, reached)| !reached(&B::of_words(&buffers)));
            let found = self.judge(&program, &tolerances, &buffers).map_err(fail)?;
            let Some(found) = found.filter(|found| found.ratio > 1.0) else { continue };
            failed += 1;
            if worst.as_ref().is_none_or(|(_, worst)| found.ratio > worst.ratio) {
                worst = Some((row, found));
            }
        }
        let Some((row, worst)) = worst else {
            let missed: Vec<&str> = missed.iter().map(|(name, _)| *name).collect();
            return if missed.is_empty() { Ok(()) } else { Err(fail(not_reached(&missed))) };
        };
        let (buffers, worst) = self.shrink(&program, &tolerances, row, worst).map_err(fail)?;
        Err(fail(self.describe(&program, &tolerances, &buffers, &worst, failed)))
    }

    /// Creates one tolerance for each buffer that has bounds.
    fn tolerances(&self, bindings: &[Binding]) -> Result<Tolerances, String> {
        if let Some((name, _)) = self.bounds.iter().find(|(name, _)| !bindings.iter().any(|b| b.name == *name)) {
            return Err(format!("within: the entry point uses no buffer `{name}`"));
        }
        let tolerance_of = |binding: &Binding| {
            let stated = self.bounds.iter().find(|(name, _)| *name == binding.name);
            let Some((_, text)) = stated else { return Ok(None) };
            let bounds = bounds(text, binding).map_err(|fault| format!("within `{}`: {fault}", binding.name))?;
            Ok(Some(Tolerance::new(&[], &binding.ty.shape, &bounds)))
        };
        bindings.iter().map(tolerance_of).collect()
    }

    /// Returns the element with the largest error, or `None` if every element equals the mirror's.
    fn judge(&self, program: &Program<'_>, tolerances: &Tolerances, before: &[Words]) -> Result<Option<Worst>, String> {
        let mut mirrored = B::of_words(before);
        let got = program.run(before, (self.workgroups)(&mirrored))?;
        (self.mirror)(&mut mirrored);
        let expected = mirrored.words();
        let mut worst: Option<Worst> = None;
        for (buffer, binding) in program.bindings.iter().enumerate() {
            let (got, expected) = (&got[buffer], &expected[buffer]);
            if got.len() != expected.len() {
                return Err(format!("the mirror changes the length of `{}`, which no kernel can", binding.name));
            }
            if !binding.is_written && got != expected {
                return Err(format!("the mirror changes `{}`, which the kernel cannot", binding.name));
            }
            let width = binding.ty.shape.words();
            let elements = got.chunks_exact(width).zip(expected.chunks_exact(width)).enumerate();
            // An element that equals the mirror's to the bit is right, even an infinity.
            for (element, (got, expected)) in elements.filter(|(_, (got, expected))| got != expected) {
                let ratio = match &tolerances[buffer] {
                    None => f64::INFINITY,
                    Some(tolerance) => {
                        let exact = numbers(&binding.ty.shape, expected);
                        tolerance.judge(&[], got, expected, &exact, &|_, _| {}).ratio
                    }
                };
                if worst.as_ref().is_none_or(|worst| ratio > worst.ratio) {
                    worst = Some(Worst { buffer, element, ratio, got: got.to_vec(), expected: expected.to_vec() });
                }
            }
        }
        Ok(worst)
    }

    /// Returns the simplest buffers found that fail at least half as badly as the worst.
    fn shrink(
        &self,
        program: &Program<'_>,
        tolerances: &Tolerances,
        row: u64,
        mut worst: Worst,
    ) -> Result<(Vec<Words>, Worst), String> {
        let enough = if worst.ratio.is_finite() { (0.5 * worst.ratio).max(1.0) } else { 1.0 };
        let mut tree = self.domain.tree(self.settings.seed, row);
        let mut buffers = tree.current();
        let mut steps = 0;
        let mut fails = true;
        // As in proptest's own runner, the value after a step back is tested as well.
        while steps < MOST_SHRINKS && (if fails { tree.simplify() } else { tree.complicate() }) {
            steps += 1;
            let simpler = tree.current();
            fails = simpler == buffers;
            if fails {
                continue;
            }
            if let Some(found) = self.judge(program, tolerances, &simpler)?.filter(|found| found.ratio > enough) {
                (buffers, worst, fails) = (simpler, found, true);
            }
        }
        Ok((buffers, worst))
    }

    fn describe(
        &self,
        program: &Program<'_>,
        tolerances: &Tolerances,
        buffers: &[Words],
        worst: &Worst,
        failed: u64,
    ) -> String {
        let Settings { cases, seed } = self.settings;
        let binding = &program.bindings[worst.buffer];
        let shape = &binding.ty.shape;
        let place = if binding.ty.is_runtime_sized {
            format!("{}[{}]", binding.name, worst.element)
        } else {
            binding.name.clone()
        };
        let exact = numbers(shape, &worst.expected);
        let mut text = format!(
            "{failed} of {cases} inputs failed; `{place}` is off by {} times the allowed error\n  {place} = {}\n  expected {}\n",
            worst.ratio,
            literal::of_shape(Language::Wgsl, shape, &worst.got),
            literal::of_shape(Language::Wgsl, shape, &worst.expected)
        );
        for part in tolerances[worst.buffer].iter().flat_map(|tolerance| tolerance.allowed(&exact)) {
            let name = if part.leaf.path.is_empty() { String::new() } else { format!("{} ", part.leaf.path) };
            let _ = writeln!(text, "  allowed {name}± {:.3e}", part.allowed);
        }
        for (binding, words) in program.bindings.iter().zip(buffers) {
            let _ = writeln!(text, "  {} = {}", binding.name, spell(Language::Wgsl, &binding.ty, words));
        }
        let rust: Vec<String> = program
            .bindings
            .iter()
            .zip(buffers)
            .map(|(binding, words)| spell(Language::Rust, &binding.ty, words))
            .collect();
        let [x, y, z] = (self.workgroups)(&B::of_words(buffers));
        let _ = write!(
            text,
            "  in Rust: ({}), {x} x {y} x {z} workgroups\n  seed {seed}, {cases} inputs; again with {SEED_VARIABLE}={seed}",
            rust.join(", ")
        );
        text
    }
}

fn bounds(text: &str, binding: &Binding) -> Result<Vec<FieldBound>, String> {
    let bounds = parse_bounds(text)?;
    check_fields(&bounds, &binding.ty.shape)?;
    if bounds.iter().any(|bound| bound.bound.backward > 0.0) {
        return Err("a whole buffer has no backward error; give ulp, abs or rel".to_owned());
    }
    Ok(bounds)
}

/// Checks that the mirror's buffers match the entry point's.
fn expect(bindings: &[Binding], types: &[Type]) -> Result<(), String> {
    if bindings.len() != types.len() {
        let names: Vec<String> = bindings.iter().map(|binding| format!("`{}`", binding.name)).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        return Err(format!(
            "the mirror has {} buffers, the entry point uses {}: {names}",
            types.len(),
            bindings.len()
        ));
    }
    match bindings.iter().zip(types).find(|(binding, ty)| binding.ty != **ty) {
        None => Ok(()),
        Some((binding, ty)) => {
            // For structs of the same name, the message names the member.
            let inner = difference(&ty.shape, &binding.ty.shape).filter(|_| ty.to_string() == binding.ty.to_string());
            let (expected, found) = inner.unwrap_or_else(|| (ty.to_string(), binding.ty.to_string()));
            Err(format!("buffer `{}`: expected {expected}, found {found}", binding.name))
        }
    }
}

/// Formats a buffer as a literal.
fn spell(language: Language, ty: &Type, words: &[u32]) -> String {
    if !ty.is_runtime_sized {
        return literal::of_shape(language, &ty.shape, words);
    }
    let elements: Vec<String> =
        words.chunks_exact(ty.shape.words()).map(|element| literal::of_shape(language, &ty.shape, element)).collect();
    match language {
        Language::Wgsl => format!("array<{}, {}>({})", ty.shape, elements.len(), elements.join(", ")),
        Language::Rust => format!("vec![{}]", elements.join(", ")),
    }
}
