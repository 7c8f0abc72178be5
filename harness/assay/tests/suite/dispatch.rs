//! Any WGSL function as a kernel: shapes and bits survive the way to the device and back.

use glam::{BVec2, BVec3, BVec4, IVec2, IVec3, IVec4, Mat2, Mat3, Mat4, UVec2, UVec3, UVec4, Vec2, Vec3, Vec4};
use lapidary_assay::dispatch::signature::Signature;
use lapidary_assay::dispatch::{self, DispatchError, Kernel, KernelModule, ROWS_PER_DISPATCH};
use lapidary_assay::draws::Draws;
use lapidary_assay::mirror_struct;
use lapidary_assay::runner::Runner;
use lapidary_assay::shape::{Scalar, Shape};
use lapidary_assay::value::Value;
use lapidary_testing::gpu;
use std::collections::BTreeSet;
use std::fmt::Debug;

/// Number of signatures made at run time.
const SIGNATURES: u64 = 200;
/// Number of rows per call.
const ROWS: usize = 5;
/// Limit of the words of all arguments together: the time to compile grows with them.
const MOST_WORDS: usize = 64;
/// Deepest nesting of structs and arrays.
const DEEPEST: u32 = 3;
const SEED: u64 = 0xec40;
const SCALARS: [Scalar; 4] = [Scalar::F32, Scalar::I32, Scalar::U32, Scalar::Bool];

/// Makes shapes, and remembers the structs that they need.
struct Generator {
    draws: Draws<'static>,
    structs: Vec<Shape>,
}

/// Returns `prefix` and a letter: a name that ends in a digit would change on the way.
fn named(prefix: &str, index: usize) -> String {
    let letter = |index: usize| char::from(b'a' + (index % 26) as u8);
    if index < 26 {
        format!("{prefix}{}", letter(index))
    } else {
        format!("{prefix}{}{}", letter(index / 26), letter(index))
    }
}

impl Generator {
    /// A shape of at most `most` words, `depth` levels down.
    fn shape(&mut self, depth: u32, most: usize) -> Shape {
        match self.draws.below(if depth < DEEPEST { 8 } else { 4 }) {
            1 if most >= 4 => Shape::Vector(2 + self.draws.below(3) as u8, self.draws.pick(&SCALARS)),
            2 | 3 => {
                let matrix = Shape::Matrix(2 + self.draws.below(3) as u8, 2 + self.draws.below(3) as u8);
                if matrix.words() <= most { matrix } else { Shape::Vector(2, Scalar::F32) }
            }
            4 if most >= 6 => {
                let length = 1 + self.draws.below(3);
                Shape::Array(Box::new(self.shape(depth + 1, most / length as usize)), length)
            }
            5..8 if most >= 8 => {
                let count = 1 + self.draws.below(4) as usize;
                let members =
                    (0..count).map(|index| (named("m_", index), self.shape(depth + 1, most / count))).collect();
                let shape = Shape::Struct(named("Part_", self.structs.len()), members);
                self.structs.push(shape.clone());
                shape
            }
            _ => Shape::Scalar(self.draws.pick(&SCALARS)),
        }
    }

    /// Returns an argument's shape: a new one, or an existing struct.
    fn argument(&mut self, most: usize) -> Shape {
        let fitting: Vec<Shape> = self.structs.iter().filter(|shape| shape.words() <= most).cloned().collect();
        if !fitting.is_empty() && self.draws.below(4) == 0 {
            return fitting[self.draws.below(fitting.len() as u32) as usize].clone();
        }
        self.shape(0, most)
    }

    /// Returns any bits that the scalar may hold and that every device keeps: no NaN, no subnormal.
    fn word(&mut self, scalar: Scalar) -> u32 {
        match scalar {
            Scalar::F32 => {
                let (sign, exponent) = (self.draws.below(2), 1 + self.draws.below(254));
                sign << 31 | exponent << 23 | self.draws.bits() >> 9
            }
            Scalar::I32 | Scalar::U32 => self.draws.bits(),
            Scalar::Bool => self.draws.below(2),
        }
    }
}

/// Returns the declaration of a struct.
fn declaration(shape: &Shape) -> String {
    let Shape::Struct(name, members) = shape else { unreachable!("only structs are declared") };
    let members: String = members.iter().map(|(name, shape)| format!("    {name}: {shape},\n")).collect();
    format!("struct {name} {{\n{members}}}\n\n")
}

/// Returns the nesting of structs and arrays.
fn depth(shape: &Shape) -> u32 {
    match shape {
        Shape::Array(element, _) => 1 + depth(element),
        Shape::Struct(_, members) => 1 + members.iter().map(|(_, shape)| depth(shape)).max().unwrap_or(0),
        _ => 0,
    }
}

/// Collects the types without component types that a shape is made of.
fn kinds(shape: &Shape, found: &mut BTreeSet<String>) {
    match shape {
        Shape::Array(element, _) => {
            found.insert("array".to_owned());
            kinds(element, found);
        }
        Shape::Struct(_, members) => members.iter().for_each(|(_, shape)| kinds(shape, found)),
        other => {
            found.insert(other.to_string());
        }
    }
}

#[test]
fn random_signatures_survive_and_their_words_come_back() {
    let mut met = BTreeSet::new();
    let mut deepest = 0;
    let mut counts = BTreeSet::new();
    for case in 0..SIGNATURES {
        let mut generator =
            Generator { draws: Draws::of_row(SEED ^ lapidary_testing::seed(), case), structs: Vec::new() };
        let count = 1 + generator.draws.below(6) as usize;
        let arguments: Vec<(String, Shape)> =
            (0..count).map(|index| (named("a_", index), generator.argument(MOST_WORDS / count))).collect();
        counts.insert(count);
        for (_, shape) in &arguments {
            kinds(shape, &mut met);
            deepest = deepest.max(depth(shape));
        }
        let members =
            arguments.iter().enumerate().map(|(index, (_, shape))| (named("m_", index), shape.clone())).collect();
        let echo = Shape::Struct("Echo".to_owned(), members);
        let declarations: String = generator.structs.iter().chain([&echo]).map(declaration).collect();
        let parameters: Vec<String> = arguments.iter().map(|(name, shape)| format!("{name}: {shape}")).collect();
        let names: Vec<&str> = arguments.iter().map(|(name, _)| name.as_str()).collect();
        let source = format!(
            "{declarations}fn echo({}) -> Echo {{\n    return Echo({});\n}}\n",
            parameters.join(", "),
            names.join(", ")
        );

        let module = KernelModule::reflect(&source, "echo.wgsl", "echo")
            .unwrap_or_else(|error| panic!("case {case}: {error}\n{source}"));
        let generated = Signature { function: "echo".to_owned(), arguments, result: echo };
        assert_eq!(module.signature, generated, "case {case}:\n{source}");
        let mut kernel = Kernel::new(gpu(), module).unwrap_or_else(|error| panic!("case {case}: {error}\n{source}"));
        assert_eq!(
            (kernel.argument_words(), kernel.result_words()),
            (generated.result.words(), generated.result.words())
        );

        let scalars = generated.result.scalars();
        let words: Vec<u32> = (0..ROWS).flat_map(|_| scalars.clone()).map(|scalar| generator.word(scalar)).collect();
        let mut results = Vec::new();
        kernel.run(&words, &mut results).unwrap_or_else(|error| panic!("case {case}: {error}\n{source}"));
        assert_eq!(results, words, "case {case}:\n{source}");
    }
    // Every scalar, vector and matrix type, arrays, all depths and all numbers of arguments.
    let mut wanted: BTreeSet<String> = SCALARS.iter().map(|scalar| scalar.name().to_owned()).collect();
    for size in 2..=4 {
        wanted.extend(SCALARS.iter().map(|scalar| Shape::Vector(size, *scalar).to_string()));
        wanted.extend((2..=4).map(|rows| Shape::Matrix(size, rows).to_string()));
    }
    wanted.insert("array".to_owned());
    assert_eq!(met, wanted);
    assert_eq!(deepest, DEEPEST);
    assert_eq!(counts, (1..=6).collect::<BTreeSet<usize>>());
}

/// Asserts that values of a type pass through a WGSL function unchanged.
fn comes_back<T: Value + Clone + PartialEq + Debug>(values: &[T]) {
    let name = T::shape();
    let source = format!("fn same(value: {name}) -> {name} {{\n    return value;\n}}\n");
    let inputs: Vec<(T,)> = values.iter().cloned().map(|value| (value,)).collect();
    let outputs: Vec<T> =
        dispatch::call(gpu(), &source, "same", &inputs).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(outputs, values, "{name}");
}

#[test]
fn scalars_and_vectors_come_back() {
    comes_back(&[0.0f32, -1.5, f32::MAX, f32::MIN_POSITIVE]);
    comes_back(&[0u32, 1, u32::MAX]);
    comes_back(&[0i32, -1, i32::MIN, i32::MAX]);
    comes_back(&[true, false, true]);
    comes_back(&[Vec2::new(1.0, -2.0), Vec2::new(0.25, 3.0)]);
    comes_back(&[Vec3::new(1.0, -2.0, 3.0), Vec3::NEG_Z]);
    comes_back(&[Vec4::new(1.0, -2.0, 3.0, -4.0), Vec4::W]);
    comes_back(&[IVec2::new(1, -2), IVec2::MIN]);
    comes_back(&[IVec3::new(1, -2, 3), IVec3::MAX]);
    comes_back(&[IVec4::new(1, -2, 3, -4), IVec4::MIN]);
    comes_back(&[UVec2::new(1, 2), UVec2::MAX]);
    comes_back(&[UVec3::new(1, 2, 3), UVec3::MAX]);
    comes_back(&[UVec4::new(1, 2, 3, 4), UVec4::MAX]);
}

#[test]
fn bool_vectors_come_back() {
    comes_back(&[BVec2::new(true, false), BVec2::new(false, true)]);
    comes_back(&[BVec3::new(true, false, false), BVec3::new(false, true, true)]);
    comes_back(&[BVec4::new(true, false, false, true), BVec4::new(false, true, false, false)]);
}

#[test]
fn matrices_come_back_column_by_column() {
    let numbers: [f32; 16] = std::array::from_fn(|index| index as f32 - 7.5);
    comes_back(&[Mat2::from_cols_slice(&numbers), Mat2::IDENTITY]);
    comes_back(&[Mat3::from_cols_slice(&numbers), Mat3::IDENTITY]);
    comes_back(&[Mat4::from_cols_slice(&numbers), Mat4::IDENTITY]);
    // The identity function cannot detect a transposed matrix; its first column can.
    let source = "fn first(matrix: mat3x3f) -> vec3f {\n    return matrix[0];\n}\n";
    let columns: Vec<Vec3> =
        dispatch::call(gpu(), source, "first", &[(Mat3::from_cols_slice(&numbers),)]).expect("valid WGSL");
    assert_eq!(columns, [Vec3::new(-7.5, -6.5, -5.5)]);
}

#[test]
fn arrays_come_back() {
    comes_back(&[[1.0f32, 2.0, 3.0], [-1.0, -2.0, -3.0]]);
    // Elements of three words have a stride of four.
    comes_back(&[[Vec3::X, Vec3::Y], [Vec3::Z, Vec3::NEG_ONE]]);
    comes_back(&[[[true, false], [false, false], [true, true]]]);
    comes_back(&[[Mat3::IDENTITY, Mat3::from_cols(Vec3::X, Vec3::ONE, Vec3::Z)]]);
}

/// A crate with a mirror struct and its oracle's twin, as `mirror_struct` expects it.
mod sample {
    use glam::{BVec2, Mat2, Vec3};

    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct SampleParts {
        pub flags: BVec2,
        pub direction: Vec3,
        pub turn: Mat2,
        pub counts: [u32; 2],
        pub hit: bool,
    }

    pub mod oracle {
        use glam::{BVec2, DMat2, DVec3};

        #[allow(dead_code, reason = "only its shape is used")]
        pub struct SampleParts {
            pub flags: BVec2,
            pub direction: DVec3,
            pub turn: DMat2,
            pub counts: [u32; 2],
            pub hit: bool,
        }
    }
}

mirror_struct!(sample, SampleParts { flags, direction, turn, counts, hit });

const PARTS: &str = "\
struct SampleParts {
    flags: vec2<bool>,
    direction: vec3f,
    turn: mat2x2f,
    counts: array<u32, 2>,
    hit: bool,
}

fn parts(first: SampleParts, scale: f32) -> SampleParts {
    return SampleParts(first.flags.yx, scale * first.direction, first.turn, first.counts, !first.hit);
}
";

#[test]
fn mirror_structs_travel_member_by_member() {
    let parts = sample::SampleParts {
        flags: BVec2::new(true, false),
        direction: Vec3::new(1.0, 2.0, 3.0),
        turn: Mat2::from_cols_array(&[1.0, 2.0, 3.0, 4.0]),
        counts: [5, 6],
        hit: false,
    };
    let results: Vec<sample::SampleParts> =
        dispatch::call(gpu(), PARTS, "parts", &[(parts, 2.0f32)]).expect("valid WGSL");
    let wanted =
        sample::SampleParts { flags: BVec2::new(false, true), direction: 2.0 * parts.direction, hit: true, ..parts };
    assert_eq!(results, [wanted]);
}

#[test]
fn more_rows_than_a_dispatch_holds_come_back_in_order() {
    let rows = 150_000u32;
    assert!(rows as usize > 2 * ROWS_PER_DISPATCH && !(rows as usize).is_multiple_of(ROWS_PER_DISPATCH));
    let source = "fn next(value: u32, flag: bool) -> u32 {\n    return select(value, value + 1u, flag);\n}\n";
    let inputs: Vec<(u32, bool)> = (0..rows).map(|row| (row, row.is_multiple_of(3))).collect();
    let results: Vec<u32> = dispatch::call(gpu(), source, "next", &inputs).expect("valid WGSL");
    assert_eq!(results.len(), inputs.len());
    let wrong = inputs.iter().zip(&results).position(|((value, flag), result)| value + u32::from(*flag) != *result);
    assert_eq!(wrong, None);
}

#[test]
fn a_kernel_serves_batches_of_any_size() {
    let source = "fn twice(value: u32) -> u32 {\n    return 2u * value;\n}\n";
    let mut kernel = Kernel::new(gpu(), KernelModule::reflect(source, "twice.wgsl", "twice").expect("valid WGSL"))
        .expect("compiles");
    let mut results = vec![9];
    // Growing, shrinking and empty: no data of an earlier batch may remain.
    for rows in [3u32, 1000, 1, 0, 65, 64] {
        let arguments: Vec<u32> = (0..rows).collect();
        kernel.run(&arguments, &mut results).expect("runs");
        assert_eq!(results, arguments.iter().map(|value| 2 * value).collect::<Vec<_>>());
    }
}

const FUNCTIONS: &str = "\
struct Pair {
    first: f32,
    second: f32,
}

fn twice(value: vec3f) -> vec3f {
    return 2.0f * value;
}

fn pair(value: f32) -> Pair {
    return Pair(value, value);
}

fn nothing(value: f32) {
}

fn size(image: texture_2d<f32>) -> vec2u {
    return textureDimensions(image);
}

fn behind(place: ptr<function, f32>) -> f32 {
    return *place;
}
";

fn reflected(function: &str) -> Result<Signature, String> {
    KernelModule::reflect(FUNCTIONS, "functions.wgsl", function)
        .map(|kernel| kernel.signature)
        .map_err(|error| error.to_string())
}

/// Returns the message for a function whose Rust side expects these shapes.
fn mismatch(function: &str, arguments: &[Shape], result: &Shape) -> String {
    reflected(function).expect("it can be dispatched").expect(arguments, result).expect_err("a mismatch").to_string()
}

const FLOAT: Shape = Shape::Scalar(Scalar::F32);
const VECTOR: Shape = Shape::Vector(3, Scalar::F32);

#[test]
fn a_mismatch_is_said_with_both_types() {
    assert_eq!(mismatch("twice", &[FLOAT], &VECTOR), "function `twice`: argument `value`: expected f32, found vec3f");
    assert_eq!(mismatch("twice", &[VECTOR], &FLOAT), "function `twice`: result: expected f32, found vec3f");
    assert_eq!(
        mismatch("twice", &[VECTOR, FLOAT], &VECTOR),
        "function `twice`: number of arguments: expected 2, found 1"
    );
    let pair = |name: &str, second: (&str, Shape)| {
        Shape::Struct(name.to_owned(), vec![("first".to_owned(), FLOAT), (second.0.to_owned(), second.1)])
    };
    assert_eq!(
        mismatch("pair", &[FLOAT], &pair("Pair", ("other", FLOAT))),
        "function `pair`: result: expected Pair { first: f32, other: f32 }, found Pair { first: f32, second: f32 }"
    );
    assert_eq!(
        mismatch("pair", &[FLOAT], &pair("Pair", ("second", Shape::Scalar(Scalar::U32)))),
        "function `pair`: result: expected Pair.second: u32, found Pair.second: f32"
    );
    assert_eq!(
        mismatch("pair", &[FLOAT], &pair("Twins", ("second", FLOAT))),
        "function `pair`: result: expected Twins { first: f32, second: f32 }, found Pair { first: f32, second: f32 }"
    );
    reflected("pair")
        .expect("it can be dispatched")
        .expect(&[FLOAT], &pair("Pair", ("second", FLOAT)))
        .expect("the right shapes");
}

#[test]
fn what_cannot_be_dispatched_is_said() {
    let refused = |function: &str| reflected(function).expect_err(function);
    assert_eq!(refused("thrice"), "function `thrice` is missing");
    assert_eq!(refused("nothing"), "function `nothing`: result: it returns nothing");
    for (function, argument, what) in [("size", "image", "texture"), ("behind", "place", "pointer")] {
        let expected =
            format!("function `{function}`: argument `{argument}`: a {what} cannot be passed through a buffer");
        assert_eq!(refused(function), expected);
    }
}

#[test]
fn a_typed_call_checks_the_types_before_it_runs() {
    let error = dispatch::call::<(f32,), Vec3>(gpu(), FUNCTIONS, "twice", &[(1.0,)]).expect_err("a mismatch");
    assert_eq!(error.to_string(), "function `twice`: argument `value`: expected f32, found vec3f");
    assert!(matches!(error, DispatchError::Signature(_)));
}

#[test]
fn broken_source_is_said_with_line_and_column() {
    let error = KernelModule::reflect("fn f() -> f32 {\n    return missing;\n}\n", "broken.wgsl", "f")
        .expect_err("invalid WGSL");
    assert!(error.to_string().contains("broken.wgsl:2:12"), "{error}");
    // Valid to the parser, but not to the validator.
    let error = KernelModule::reflect("fn f() -> f32 {\n    if (true) { return 1.0f; }\n}\n", "broken.wgsl", "f")
        .expect_err("invalid WGSL");
    assert!(error.to_string().contains("broken.wgsl:"), "{error}");
}

/// A pseudo-random sequence after a number of turns. No compiler writes it as a formula.
const SEQUENCE: &str = "fn after(turns: u32) -> u32 {\n    var state = 1u;\n    for (var turn = 0u; turn < turns; turn++) {\n\
    state = state * 1664525u + 1013904223u;\n    }\n    return state;\n}\n";

fn after(turns: u32) -> u32 {
    (0..turns).fold(1, |state: u32, _| state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223))
}

#[test]
fn rows_are_not_cut_short_by_their_neighbours() {
    // lavapipe counts the turns of a group of rows together: here each row takes 40,000, and the
    // group 80,000.
    let source = format!(
        "{SEQUENCE}fn both(row: u32) -> u32 {{\n    var sum = 0u;\n    if (row % 2u == 0u) {{ sum = after(40000u + row); }}\n\
         if (row % 2u == 1u) {{ sum = after(40000u + row); }}\n    return sum;\n}}\n"
    );
    let module = KernelModule::reflect(&source, "both.wgsl", "both").expect("valid WGSL");
    let mut kernel = Kernel::new(gpu(), module).expect("compiles");
    let arguments: Vec<u32> = (0..100).collect();
    let mut results = Vec::new();
    kernel.run(&arguments, &mut results).expect("runs");
    assert!(!kernel.any_stopped());
    let wanted: Vec<u32> = arguments.iter().map(|row| after(40_000 + row)).collect();
    assert_eq!(results, wanted);
}

#[test]
fn turns_are_counted_to_the_limit_and_no_further() {
    let module = KernelModule::reflect(SEQUENCE, "after.wgsl", "after").expect("valid WGSL");
    let mut kernel = Kernel::new(gpu(), module).expect("compiles");
    let limit = kernel.turn_limit().expect("it has a loop");
    // The turn after the last, which evaluates the condition, counts too.
    let arguments = [0, 1, 7, limit - 1, limit, limit + 100, u32::MAX];
    let mut results = Vec::new();
    kernel.run(&arguments, &mut results).expect("runs");
    let stopped: Vec<bool> = (0..arguments.len()).map(|row| kernel.stopped(row)).collect();
    assert_eq!(stopped, [false, false, false, false, true, true, true]);
    for (turns, result) in arguments.iter().zip(&results).take(4) {
        assert_eq!(*result, after(*turns), "{turns} turns");
    }
    // Nothing is counted if there is no loop.
    let plain = "fn twice(value: u32) -> u32 {\n    return 2u * value;\n}\n";
    let mut kernel =
        Kernel::new(gpu(), KernelModule::reflect(plain, "twice.wgsl", "twice").expect("valid")).expect("compiles");
    kernel.run(&[1], &mut results).expect("runs");
    assert_eq!((kernel.turn_limit(), kernel.any_stopped()), (None, false));
}
