//! Static size of a shader, counted in the SPIR-V that naga writes for each entry point alone. The
//! counts do not depend on a driver, and complement the measured times.

use crate::operands;
use naga::back::spv;
use naga::valid::ModuleInfo;
use naga::{AddressSpace, Expression, Function, Handle, Module, ShaderStage, Statement, Type, TypeInner};
use std::collections::{BTreeMap, BTreeSet};

/// The counts of a vertex and a fragment entry point.
///
/// All instructions inside the functions that the entry point reaches are counted, except those
/// that only declare or structure: `OpFunction`, `OpFunctionParameter`, `OpFunctionEnd`, `OpLabel`,
/// `OpVariable`, `OpSelectionMerge`, `OpLoopMerge`, `OpLine`, `OpNoLine`, `OpNop`. Branches, calls
/// and loads count. A function counts once however often it is called, a loop body once whatever
/// its number of iterations, and both sides of a branch count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpirvCounts {
    /// Number of instructions that the vertex entry point reaches.
    pub vertex_instructions: u32,
    /// Number of instructions that the fragment entry point reaches.
    pub fragment_instructions: u32,
    /// Size in bytes of the uniform buffers and the constant arrays that either entry point uses,
    /// each counted once. A struct of constants that contains an array counts in full.
    pub constant_bytes: u32,
    /// Number of storage buffers that either entry point uses.
    pub storage_bindings: u32,
}

/// The reason why there are no counts.
#[derive(Debug, thiserror::Error)]
pub enum SpirvCountsError {
    /// naga cannot write the entry point.
    #[error("entry point `{entry_point}` cannot be written as SPIR-V: {error}")]
    Write {
        /// Name of the entry point.
        entry_point: String,
        /// The error reported by naga.
        error: spv::Error,
    },
}

/// Counts the contents of a vertex and a fragment entry point of a valid module. Its overrides have
/// been applied, as [`specialise`](crate::specialise) does.
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

/// Returns the number of instructions of all entry points of a valid module without overrides. An
/// entry point that SPIR-V cannot express counts as 0.
pub fn instructions(ir: &Module, info: &ModuleInfo) -> usize {
    let count_of =
        |entry: &naga::EntryPoint| instructions_of(ir, info, entry.stage, &entry.name).unwrap_or_default() as usize;
    ir.entry_points.iter().map(count_of).sum()
}

/// Returns the number of instructions that one entry point reaches.
fn instructions_of(
    ir: &Module,
    info: &ModuleInfo,
    shader_stage: ShaderStage,
    entry_point: &str,
) -> Result<u32, SpirvCountsError> {
    let options = spv::Options {
        // The shader as written: without loop bounds, flipped axes or clamped depths.
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

/// Number of words before the first instruction: magic number, version, generator, bound, schema.
const HEADER_WORDS: usize = 5;

/// Counts the instructions in the functions that the entry points of a SPIR-V module reach; see
/// [`SpirvCounts`].
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
            // Operands: execution model, function.
            op::ENTRY_POINT => pending.push(instruction[2]),
            // Operands: result type, function.
            op::FUNCTION => inside = Some(instruction[2]),
            op::FUNCTION_END => inside = None,
            op::FUNCTION_PARAMETER | op::VARIABLE | op::LABEL | op::SELECTION_MERGE | op::LOOP_MERGE => {}
            op::LINE | op::NO_LINE | op::NOP => {}
            _ => {
                let Some(function) = inside else { continue };
                let body = bodies.entry(function).or_default();
                body.instructions += 1;
                if opcode == op::FUNCTION_CALL {
                    // Operands: result type, result, function.
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

/// The globals and constant tables that some entry points use, directly or through the functions
/// that they call.
struct Used {
    globals: BTreeSet<Handle<naga::GlobalVariable>>,
    /// Type of each table of constants, once per table.
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

    /// Adds the tables of constants that a function uses. A table with a name counts once overall,
    /// tracked in `named`; a table written out in an expression counts each time.
    fn add_tables(&mut self, ir: &Module, function: &Function, named: &mut BTreeSet<Handle<naga::Constant>>) {
        let mut parts = BTreeSet::new();
        // In reverse order, so that the whole comes before its parts.
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

    /// Returns the types of the used global variables in an address space.
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

/// Returns the functions that a function calls.
fn callees(function: &Function) -> BTreeSet<Handle<Function>> {
    let mut callees = BTreeSet::new();
    operands::for_each_statement(&function.body, &mut |statement| {
        if let Statement::Call { function, .. } = statement {
            callees.insert(*function);
        }
    });
    callees
}

/// Whether a type is an array or a struct that contains one at any depth.
fn holds_array(ir: &Module, ty: Handle<Type>) -> bool {
    match &ir.types[ty].inner {
        TypeInner::Array { .. } => true,
        TypeInner::Struct { members, .. } => members.iter().any(|member| holds_array(ir, member.ty)),
        _ => false,
    }
}

/// Whether an expression consists of constants only.
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

    /// Assembles a module from instructions: opcode and operands of each.
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
        // A function that is never called is not reached, although naga writes it.
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
        // The struct is 80 bytes; the table is 48, whichever function reads it.
        assert_eq!((found.constant_bytes, found.storage_bindings), (80 + 48, 1));
    }

    #[test]
    fn the_specialised_gem_is_smaller() {
        let counts_of = |constants: &[(&str, f64)]| {
            let (module, _) = dispatch::parse(&lapidary_wgsl::recipe_source("gem"), "gem").expect("a valid recipe");
            let entry_points = ["gem_vertex", "gem_fragment"];
            let (module, info) = specialise::specialise(module, constants, &entry_points).expect("specialises");
            spirv_counts(&module, &info, entry_points[0], entry_points[1]).expect("counts")
        };
        let (whole, surface) = (counts_of(&[]), counts_of(&[("EFFECT_PROXY_GEOMETRY", 0.0)]));
        assert!(surface.fragment_instructions < whole.fragment_instructions, "{surface:?} {whole:?}");
        assert!(surface.vertex_instructions < whole.vertex_instructions, "{surface:?} {whole:?}");
        // One uniform block, the view: 64 + 12 bytes, padded to 80. Without the proxy the normals are
        // not read.
        assert_eq!((surface.constant_bytes, surface.storage_bindings), (80, 3));
        assert_eq!((whole.constant_bytes, whole.storage_bindings), (80, 4));
    }
}
