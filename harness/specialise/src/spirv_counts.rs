//! What a shader is made of, counted in the SPIR-V that naga writes for each entry point alone: a figure that no driver
//! changes, beside the measured times.

use crate::operands;
use naga::back::spv;
use naga::valid::ModuleInfo;
use naga::{AddressSpace, Expression, Function, Handle, Module, ShaderStage, Statement, Type, TypeInner};
use std::collections::{BTreeMap, BTreeSet};

/// The counts of a vertex and a fragment entry point.
///
/// An instruction is one that does something: all that stand inside the functions that the entry point reaches, except
/// what only declares or structures: `OpFunction`, `OpFunctionParameter`, `OpFunctionEnd`, `OpLabel`, `OpVariable`,
/// `OpSelectionMerge`, `OpLoopMerge`, `OpLine`, `OpNoLine`, `OpNop`. Branches, calls and loads count. A function counts
/// once however often it is called, a loop's body once whatever its rounds, and both sides of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpirvCounts {
    /// Instructions that the vertex entry point reaches.
    pub vertex_instructions: u32,
    /// Instructions that the fragment entry point reaches.
    pub fragment_instructions: u32,
    /// Bytes of the uniform buffers, and of the arrays of constants, that either entry point uses, each once. A struct
    /// of constants with an array in it counts whole.
    pub constant_bytes: u32,
    /// Storage buffers that either entry point uses.
    pub storage_bindings: u32,
}

/// Why there are no counts.
#[derive(Debug, thiserror::Error)]
pub enum SpirvCountsError {
    /// naga cannot write the entry point.
    #[error("entry point `{entry_point}` cannot be written as SPIR-V: {error}")]
    Write {
        /// Its name.
        entry_point: String,
        /// naga's word.
        error: spv::Error,
    },
}

/// Counts what a vertex and a fragment entry point of a valid module are made of. Its overrides have been applied, as
/// [`specialise`](crate::specialise) does.
pub fn spirv_counts(
    ir: &Module,
    info: &ModuleInfo,
    vertex_entry: &str,
    fragment_entry: &str,
) -> Result<SpirvCounts, SpirvCountsError> {
    let used = Used::by(ir, info, &[vertex_entry, fragment_entry]);
    let size = |ty: Handle<Type>| ir.types[ty].inner.size(ir.to_ctx());
    let uniforms = used.globals_in(ir, AddressSpace::Uniform).map(size);
    Ok(SpirvCounts {
        vertex_instructions: instructions_of(ir, info, ShaderStage::Vertex, vertex_entry)?,
        fragment_instructions: instructions_of(ir, info, ShaderStage::Fragment, fragment_entry)?,
        constant_bytes: uniforms.chain(used.tables.iter().copied().map(size)).sum(),
        storage_bindings: used.storage_buffers(ir),
    })
}

/// The instructions of all entry points of a valid module without overrides; 0 of one that SPIR-V cannot say.
pub fn instructions(ir: &Module, info: &ModuleInfo) -> usize {
    let of =
        |entry: &naga::EntryPoint| instructions_of(ir, info, entry.stage, &entry.name).unwrap_or_default() as usize;
    ir.entry_points.iter().map(of).sum()
}

/// The instructions that one entry point reaches.
fn instructions_of(
    ir: &Module,
    info: &ModuleInfo,
    shader_stage: ShaderStage,
    entry_point: &str,
) -> Result<u32, SpirvCountsError> {
    let options = spv::Options {
        // The shader as written: without bounds on loops, turned axes or clamped depths.
        flags: spv::WriterFlags::empty(),
        force_loop_bounding: false,
        ..spv::Options::default()
    };
    let pipeline = spv::PipelineOptions { shader_stage, entry_point: entry_point.to_owned() };
    let words = spv::write_vec(ir, info, &options, Some(&pipeline))
        .map_err(|error| SpirvCountsError::Write { entry_point: entry_point.to_owned(), error })?;
    Ok(reached_instructions(&words))
}

/// Opcodes of the SPIR-V specification, section 3.56 (instructions).
mod op {
    pub const NOP: u16 = 0;
    pub const LINE: u16 = 8;
    pub const ENTRY_POINT: u16 = 15;
    pub const FUNCTION: u16 = 54;
    pub const FUNCTION_PARAMETER: u16 = 55;
    pub const FUNCTION_END: u16 = 56;
    pub const FUNCTION_CALL: u16 = 57;
    pub const VARIABLE: u16 = 59;
    pub const LOOP_MERGE: u16 = 246;
    pub const SELECTION_MERGE: u16 = 247;
    pub const LABEL: u16 = 248;
    pub const NO_LINE: u16 = 317;
}

/// Words before the first instruction: magic number, version, generator, bound, schema.
const HEADER_WORDS: usize = 5;

/// Counts the instructions in the functions that the entry points of a SPIR-V module reach; see [`SpirvCounts`].
fn reached_instructions(words: &[u32]) -> u32 {
    #[derive(Default)]
    struct Body {
        instructions: u32,
        calls: Vec<u32>,
    }
    let mut pending = Vec::new();
    let mut bodies: BTreeMap<u32, Body> = BTreeMap::new();
    let mut inside = None;
    let mut rest = &words[HEADER_WORDS..];
    while let Some(&first) = rest.first() {
        let (opcode, length) = (first as u16, (first >> 16) as usize);
        let (instruction, behind) = rest.split_at(length);
        rest = behind;
        match opcode {
            // Execution model, then the function.
            op::ENTRY_POINT => pending.push(instruction[2]),
            // Result type, then the function.
            op::FUNCTION => inside = Some(instruction[2]),
            op::FUNCTION_END => inside = None,
            op::FUNCTION_PARAMETER | op::VARIABLE | op::LABEL | op::SELECTION_MERGE | op::LOOP_MERGE => {}
            op::LINE | op::NO_LINE | op::NOP => {}
            _ => {
                let Some(function) = inside else { continue };
                let body = bodies.entry(function).or_default();
                body.instructions += 1;
                if opcode == op::FUNCTION_CALL {
                    // Result type, result, then the function.
                    body.calls.push(instruction[3]);
                }
            }
        }
    }
    let mut reached = BTreeSet::new();
    let mut instructions = 0;
    while let Some(function) = pending.pop() {
        if let Some(body) = bodies.get(&function)
            && reached.insert(function)
        {
            instructions += body.instructions;
            pending.extend(&body.calls);
        }
    }
    instructions
}

/// What some entry points use, themselves and through the functions that they call.
struct Used {
    globals: BTreeSet<Handle<naga::GlobalVariable>>,
    /// The type of each table of constants, once for each table.
    tables: Vec<Handle<Type>>,
}

impl Used {
    fn by(ir: &Module, info: &ModuleInfo, entry_points: &[&str]) -> Used {
        let mut used = Used { globals: BTreeSet::new(), tables: Vec::new() };
        let mut named = BTreeSet::new();
        let mut pending = Vec::new();
        for (index, entry) in ir.entry_points.iter().enumerate() {
            if entry_points.contains(&entry.name.as_str()) {
                let uses = info.get_entry_point(index);
                let in_use = |global: &Handle<naga::GlobalVariable>| !uses[*global].is_empty();
                used.globals.extend(ir.global_variables.iter().map(|(global, _)| global).filter(in_use));
                used.add_tables(ir, &entry.function, &mut named);
                pending.extend(callees(&entry.function));
            }
        }
        let mut reached = BTreeSet::new();
        while let Some(function) = pending.pop() {
            if reached.insert(function) {
                used.add_tables(ir, &ir.functions[function], &mut named);
                pending.extend(callees(&ir.functions[function]));
            }
        }
        let private: Vec<_> = used.globals_in(ir, AddressSpace::Private).filter(|ty| holds_array(ir, *ty)).collect();
        used.tables.extend(private);
        used
    }

    /// Adds the tables of constants that a function uses: those with a name once for all, `named`; those written out in
    /// its expressions each for itself.
    fn add_tables(&mut self, ir: &Module, function: &Function, named: &mut BTreeSet<Handle<naga::Constant>>) {
        let mut parts = BTreeSet::new();
        // From the back: the whole is met before its parts.
        for (handle, expression) in function.expressions.iter().rev() {
            if let Expression::Constant(constant) = *expression
                && !parts.contains(&handle)
                && holds_array(ir, ir.constants[constant].ty)
                && named.insert(constant)
            {
                self.tables.push(ir.constants[constant].ty);
            }
            if let Expression::Compose { ty, .. } = *expression
                && holds_array(ir, ty)
                && is_constant(function, handle)
            {
                if !parts.contains(&handle) {
                    self.tables.push(ty);
                }
                parts.extend(operands::list_of_expression(expression));
            }
        }
    }

    /// The types of the global variables of an address space.
    fn globals_in(&self, ir: &Module, space: AddressSpace) -> impl Iterator<Item = Handle<Type>> {
        let variables = self.globals.iter().map(|global| &ir.global_variables[*global]);
        variables.filter(move |variable| variable.space == space).map(|variable| variable.ty)
    }

    fn storage_buffers(&self, ir: &Module) -> u32 {
        let is_storage = |space| matches!(space, AddressSpace::Storage { .. });
        let storage = self.globals.iter().filter(|global| is_storage(ir.global_variables[**global].space));
        u32::try_from(storage.count()).expect("fewer buffers than 2³²")
    }
}

/// The functions that a function calls.
fn callees(function: &Function) -> BTreeSet<Handle<Function>> {
    let mut callees = BTreeSet::new();
    operands::for_each_statement(&function.body, &mut |statement| {
        if let Statement::Call { function, .. } = statement {
            callees.insert(*function);
        }
    });
    callees
}

/// Whether a type is an array or a struct that has one, somewhere.
fn holds_array(ir: &Module, ty: Handle<Type>) -> bool {
    match &ir.types[ty].inner {
        TypeInner::Array { .. } => true,
        TypeInner::Struct { members, .. } => members.iter().any(|member| holds_array(ir, member.ty)),
        _ => false,
    }
}

/// Whether an expression is written out of constants alone.
fn is_constant(function: &Function, expression: Handle<Expression>) -> bool {
    match &function.expressions[expression] {
        Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => true,
        Expression::Compose { components, .. } => components.iter().all(|part| is_constant(function, *part)),
        Expression::Splat { value, .. } => is_constant(function, *value),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate as specialise;
    use crate as dispatch;

    fn counts(source: &str) -> SpirvCounts {
        let (module, info) = dispatch::parse(source, "test").unwrap_or_else(|error| panic!("{error}"));
        spirv_counts(&module, &info, "v", "f").unwrap_or_else(|error| panic!("{error}"))
    }

    /// Each instruction: opcode and operands.
    fn module(instructions: &[(u16, &[u32])]) -> Vec<u32> {
        let mut words = vec![0; HEADER_WORDS];
        for (opcode, operands) in instructions {
            let length = u32::try_from(operands.len() + 1).expect("a short instruction");
            words.push(length << 16 | u32::from(*opcode));
            words.extend_from_slice(operands);
        }
        words
    }

    #[test]
    fn only_what_the_entry_point_reaches_is_counted() {
        const RETURN: u16 = 253;
        const ADD: u16 = 129;
        let function = |id, inside: &[(u16, &'static [u32])]| {
            let mut body: Vec<(u16, Vec<u32>)> = vec![(op::FUNCTION, vec![1, id, 0, 2]), (op::LABEL, vec![id + 50])];
            body.extend(inside.iter().map(|(opcode, operands)| (*opcode, operands.to_vec())));
            body.extend([(RETURN, vec![]), (op::FUNCTION_END, vec![])]);
            body
        };
        let all: Vec<(u16, Vec<u32>)> = [
            vec![(op::ENTRY_POINT, vec![4, 12, 0]), (ADD, vec![1, 90, 7, 7])],
            // Called twice, counted once: an addition and a return.
            function(10, &[(op::VARIABLE, &[1, 80, 7]), (ADD, &[1, 81, 7, 7]), (op::NOP, &[])]),
            // Not called.
            function(11, &[(ADD, &[1, 82, 7, 7])]),
            // Two calls, a line, a merge and a return.
            function(
                12,
                &[
                    (op::FUNCTION_CALL, &[1, 83, 10]),
                    (op::LINE, &[1, 2, 3]),
                    (op::FUNCTION_CALL, &[1, 84, 10]),
                    (op::SELECTION_MERGE, &[1, 0]),
                ],
            ),
        ]
        .concat();
        let all: Vec<(u16, &[u32])> = all.iter().map(|(opcode, operands)| (*opcode, operands.as_slice())).collect();
        assert_eq!(reached_instructions(&module(&all)), 2 + 3);
    }

    const PLAIN: &str = "
        @vertex fn v(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f { return vec4f(f32(i)); }
        @fragment fn f() -> @location(0) vec4f { return vec4f(0.5); }";

    #[test]
    fn what_one_stage_computes_is_not_the_others() {
        let plain = counts(PLAIN);
        assert_eq!((plain.constant_bytes, plain.storage_bindings), (0, 0));
        let more = counts(&PLAIN.replace("f32(i)", "sin(f32(i)) * 3.0"));
        assert_eq!(more.vertex_instructions, plain.vertex_instructions + 2);
        assert_eq!(more.fragment_instructions, plain.fragment_instructions);
        // One that nobody calls is not reached; naga writes it all the same.
        let unused = format!("fn unused(x: f32) -> f32 {{ return sin(x) + cos(x); }} {PLAIN}");
        assert_eq!(counts(&unused), plain);
    }

    #[test]
    fn constants_and_buffers_count_where_they_are_used() {
        let source = "
            struct View { matrix: mat4x4f, eye: vec3f }
            @group(0) @binding(0) var<uniform> view: View;
            @group(0) @binding(1) var<uniform> unused: vec4f;
            @group(0) @binding(2) var<storage, read> positions: array<vec4f>;
            @group(0) @binding(3) var<storage, read> others: array<vec4f>;
            const PLANES = array<vec4f, 3>(vec4f(1.0), vec4f(2.0), vec4f(3.0));
            const SPARE = array<f32, 100>();
            fn plane(i: u32) -> vec4f { return PLANES[i]; }
            @vertex fn v(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
                return view.matrix * (positions[i] + plane(i));
            }
            @fragment fn f(@builtin(position) at: vec4f) -> @location(0) vec4f {
                return vec4f(view.eye, 1.0) + PLANES[u32(at.x)];
            }";
        let found = counts(source);
        // The struct is 80 bytes, the table 48 in whichever function it is read.
        assert_eq!((found.constant_bytes, found.storage_bindings), (80 + 48, 1));
    }

    #[test]
    fn the_specialised_gem_is_smaller() {
        let of = |constants: &[(&str, f64)]| {
            let (module, _) = dispatch::parse(&lapidary_wgsl::recipe_source("gem"), "gem").expect("a valid recipe");
            let entry_points = ["gem_vertex", "gem_fragment"];
            let (module, info) = specialise::specialise(module, constants, &entry_points).expect("specialises");
            spirv_counts(&module, &info, entry_points[0], entry_points[1]).expect("counts")
        };
        let (whole, surface) = (of(&[]), of(&[("EFFECT_PROXY_GEOMETRY", 0.0)]));
        assert!(surface.fragment_instructions < whole.fragment_instructions, "{surface:?} {whole:?}");
        assert!(surface.vertex_instructions < whole.vertex_instructions, "{surface:?} {whole:?}");
        // Two uniform blocks: 64 + 12, padded to 80, and 52, padded to 64; the normals are not read.
        assert_eq!((surface.constant_bytes, surface.storage_bindings), (80, 3));
        assert_eq!((whole.constant_bytes, whole.storage_bindings), (80, 4));
    }
}
