//! SPIR-V reduced to its behaviour: ids, and the order in which types, constants and variables are
//! declared, have no meaning.

use naga::back::spv;
use naga::valid::ModuleInfo;
use naga::{Module, ShaderStage};
use spirv::Op;
use std::collections::BTreeMap;

/// One entry point of a shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canonical {
    /// All lines outside of functions, each spelt out to the last type, in alphabetical order.
    pub declarations: Vec<String>,
    /// The instructions of the functions that the entry point reaches, in the order of first use.
    /// Ids inside a function are numbered by appearance.
    pub body: Vec<String>,
}

impl Canonical {
    /// Returns the first line at which the two forms differ, of both; nothing if they are equal.
    pub fn difference(&self, other: &Canonical) -> Option<String> {
        let parts = [(&self.declarations, &other.declarations), (&self.body, &other.body)];
        parts.into_iter().find_map(|(left, right)| {
            let place = (0..left.len().max(right.len())).find(|line| left.get(*line) != right.get(*line))?;
            let spell = |lines: &[String]| lines.get(place).map_or("nothing", String::as_str).to_owned();
            let counts = format!("line {place} of {} and {}", left.len(), right.len());
            Some(format!("{counts}:\n  {}\n  {}", spell(left), spell(right)))
        })
    }
}

/// Returns the canonical form of an entry point, as naga writes it without names, loop bounds and
/// flipped axes.
pub fn canonical(ir: &Module, info: &ModuleInfo, shader_stage: ShaderStage, entry_point: &str) -> Canonical {
    let options = spv::Options { flags: spv::WriterFlags::empty(), force_loop_bounding: false, ..Default::default() };
    let pipeline = spv::PipelineOptions { shader_stage, entry_point: entry_point.to_owned() };
    let words = spv::write_vec(ir, info, &options, Some(&pipeline)).unwrap_or_else(|e| panic!("{entry_point}: {e}"));
    of_words(&words)
}

/// Returns the canonical form of a module with one entry point.
pub fn of_words(words: &[u32]) -> Canonical {
    let mut instructions = Vec::new();
    // After the magic number, version, generator, bound and schema.
    let mut rest = &words[5..];
    while let Some(first) = rest.first() {
        let (instruction, behind) = rest.split_at((first >> 16) as usize);
        instructions.push(Instruction::read(instruction));
        rest = behind;
    }
    let first_function = instructions.iter().position(|it| it.op == Op::Function).unwrap_or(instructions.len());
    let (outside, inside) = instructions.split_at(first_function);
    let mut names = Names::default();
    for instruction in outside.iter().chain(inside) {
        if matches!(instruction.op, Op::Decorate | Op::MemberDecorate) {
            let [Operand::Id(target), what @ ..] = &instruction.operands[..] else { panic!("a decoration's target") };
            names.decorations.entry(*target).or_default().push(format!("{:?}{what:?}", instruction.op));
        }
    }
    names.decorations.values_mut().for_each(|of_one| of_one.sort());
    let mut declarations = Vec::new();
    for instruction in outside {
        match instruction.op {
            Op::Decorate | Op::MemberDecorate | Op::EntryPoint | Op::ExecutionMode => {}
            _ => declarations.push(names.declare(instruction)),
        }
    }
    let bodies: BTreeMap<u32, &[Instruction]> = functions(inside);
    let mut body = Vec::new();
    for instruction in outside {
        match instruction.op {
            Op::EntryPoint => {
                let [stage, Operand::Id(function), name, interface @ ..] = &instruction.operands[..] else {
                    panic!("an entry point's function")
                };
                let mut interface: Vec<String> = interface.iter().map(|operand| names.spell(operand)).collect();
                interface.sort();
                declarations.push(format!("EntryPoint {stage:?} {name:?} {interface:?}"));
                names.reached.push(*function);
            }
            Op::ExecutionMode => declarations.push(format!("ExecutionMode {:?}", &instruction.operands[1..])),
            _ => {}
        }
    }
    declarations.sort();
    let mut written = 0;
    while let Some(function) = names.reached.get(written).copied() {
        written += 1;
        names.local.clear();
        let ordered = names.in_order(bodies[&function]);
        body.extend(ordered.into_iter().map(|instruction| names.write(instruction)));
    }
    Canonical { declarations, body }
}

/// Returns the instructions of each function by its id, from `OpFunction` to `OpFunctionEnd`.
fn functions(instructions: &[Instruction]) -> BTreeMap<u32, &[Instruction]> {
    let parts = instructions.split_inclusive(|instruction| instruction.op == Op::FunctionEnd);
    parts.map(|part| (part[0].result.expect("a function has an id"), part)).collect()
}

#[derive(Clone, Debug)]
enum Operand {
    Id(u32),
    Literal(u32),
    Text(String),
}

#[derive(Debug)]
struct Instruction {
    op: Op,
    result: Option<u32>,
    /// Operands with the type of the result, without the result.
    operands: Vec<Operand>,
}

impl Instruction {
    fn read(words: &[u32]) -> Instruction {
        let op = Op::from_u32(words[0] & 0xffff).expect("an instruction of SPIR-V");
        let mut instruction = Instruction { op, result: None, operands: Vec::new() };
        let mut kinds = form(op).chars();
        let mut words = &words[1..];
        // A kind before `*` applies to all further words. For a pair, the two kinds alternate.
        let mut last = Vec::new();
        while let Some((&word, behind)) = words.split_first() {
            let kind = kinds.next().or(form(op).ends_with('*').then_some('*'));
            let kind = kind.unwrap_or_else(|| panic!("{op:?} has more operands than are listed here"));
            let kind = if kind == '*' {
                last.rotate_left(1);
                *last.last().expect("a kind before `*`")
            } else {
                last = if kind == 'p' { vec!['i', 'l'] } else { vec![kind] };
                if kind == 'p' { 'l' } else { kind }
            };
            words = behind;
            match kind {
                'r' => instruction.result = Some(word),
                'i' => instruction.operands.push(Operand::Id(word)),
                'l' => instruction.operands.push(Operand::Literal(word)),
                's' => {
                    let mut bytes = word.to_le_bytes().to_vec();
                    while !bytes.contains(&0) {
                        let (word, behind) = words.split_first().expect("a text ends");
                        bytes.extend(word.to_le_bytes());
                        words = behind;
                    }
                    let text = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
                    instruction.operands.push(Operand::Text(String::from_utf8_lossy(text).into_owned()));
                }
                other => panic!("{op:?} has an operand of kind `{other}`"),
            }
        }
        instruction
    }
}

/// Returns the kinds of an instruction's words, as in section 3 of the specification: `r` the
/// result, `i` an id, `l` a literal, `s` a text, `p` pairs of literal and id; `*` repeats the last
/// for all that follow. An unlisted instruction fails.
fn form(op: Op) -> &'static str {
    use Op::*;
    match op {
        Capability | MemoryModel => "l*",
        Extension => "s",
        ExtInstImport => "rs",
        EntryPoint => "lisi*",
        ExecutionMode | Decorate | MemberDecorate => "il*",
        TypeVoid | TypeBool | TypeSampler | Label => "r",
        TypeInt | TypeFloat => "rl*",
        TypeVector | TypeMatrix | TypeImage => "ril*",
        TypeSampledImage | TypeRuntimeArray | TypeArray | TypeStruct | TypeFunction => "ri*",
        TypePointer => "rli",
        ConstantTrue | ConstantFalse | ConstantNull | FunctionParameter => "ir",
        Constant => "irl*",
        ConstantComposite => "iri*",
        Function => "irli",
        Variable => "irli*",
        FunctionCall | AccessChain | CompositeConstruct | VectorExtractDynamic | CopyObject | SampledImage => "iri*",
        ExtInst => "irili*",
        Load | ArrayLength | CompositeExtract => "iril*",
        VectorShuffle | CompositeInsert => "iriil*",
        Store => "iil*",
        ImageFetch | ImageSampleExplicitLod | ImageSampleImplicitLod => "iriili*",
        ImageQuerySize | ImageQuerySizeLod | ImageQueryLevels => "iri*",
        ConvertFToU | ConvertFToS | ConvertSToF | ConvertUToF | Bitcast => "iri*",
        SNegate | FNegate | IAdd | FAdd | ISub | FSub | IMul | FMul | UDiv | SDiv | FDiv | UMod | SRem | FRem => "iri*",
        VectorTimesScalar | MatrixTimesScalar | VectorTimesMatrix | MatrixTimesVector | MatrixTimesMatrix => "iri*",
        OuterProduct | Dot | Transpose | UMulExtended => "iri*",
        Any | All | IsNan | IsInf | LogicalEqual | LogicalNotEqual | LogicalOr | LogicalAnd | LogicalNot => "iri*",
        Select | IEqual | INotEqual | UGreaterThan | SGreaterThan | UGreaterThanEqual | SGreaterThanEqual => "iri*",
        ULessThan | SLessThan | ULessThanEqual | SLessThanEqual => "iri*",
        FOrdEqual | FOrdNotEqual | FUnordNotEqual | FOrdLessThan | FOrdGreaterThan => "iri*",
        FOrdLessThanEqual | FOrdGreaterThanEqual => "iri*",
        ShiftRightLogical | ShiftRightArithmetic | ShiftLeftLogical | BitwiseOr | BitwiseXor | BitwiseAnd => "iri*",
        Not | BitFieldInsert | BitFieldSExtract | BitFieldUExtract | BitReverse | BitCount => "iri*",
        DPdx | DPdy | Fwidth => "iri*",
        AtomicLoad | AtomicExchange | AtomicCompareExchange | AtomicIAdd | AtomicISub => "iri*",
        AtomicSMin | AtomicUMin | AtomicSMax | AtomicUMax | AtomicAnd | AtomicOr | AtomicXor | Phi => "iri*",
        AtomicStore | ControlBarrier | MemoryBarrier | Branch | ReturnValue => "i*",
        LoopMerge => "iil*",
        SelectionMerge => "il",
        BranchConditional => "iiil*",
        Switch => "iip*",
        Kill | Return | Unreachable | FunctionEnd => "",
        other => panic!("{other:?}: its operands are not listed here"),
    }
}

/// Meanings of the ids.
#[derive(Default)]
struct Names {
    decorations: BTreeMap<u32, Vec<String>>,
    /// Full description of each id outside of functions.
    global: BTreeMap<u32, String>,
    /// Functions, in the order of first use.
    reached: Vec<u32>,
    /// Number of each id inside the current function.
    local: BTreeMap<u32, usize>,
}

impl Names {
    /// Spells a declaration out, and stores it as its id's name.
    fn declare(&mut self, instruction: &Instruction) -> String {
        let mut text = self.spell_instruction(instruction);
        if let Some(result) = instruction.result {
            if let Some(decorations) = self.decorations.get(&result) {
                text.push_str(&decorations.join(" "));
            }
            let known = self.global.insert(result, format!("<{text}>"));
            assert!(known.is_none(), "id {result} is declared twice");
        }
        text
    }

    /// Returns the instructions of a function, with the initial loads of its bindings sorted: naga
    /// writes them in the order of the bindings' declarations.
    fn in_order<'a>(&mut self, function: &'a [Instruction]) -> Vec<&'a Instruction> {
        let opens =
            |it: &&Instruction| matches!(it.op, Op::Function | Op::FunctionParameter | Op::Label | Op::Variable);
        let first = function.iter().take_while(opens).count();
        let is_global = |operand: &Operand| match operand {
            Operand::Id(id) => self.global.contains_key(id),
            Operand::Literal(_) | Operand::Text(_) => true,
        };
        let fetches =
            |it: &&Instruction| matches!(it.op, Op::AccessChain | Op::Load) && it.operands.iter().all(is_global);
        let count = function[first..].iter().take_while(fetches).count();
        let mut ordered: Vec<&Instruction> = function.iter().collect();
        ordered[first..first + count].sort_by_cached_key(|instruction| self.spell_instruction(instruction));
        ordered
    }

    /// Writes an instruction inside a function.
    fn write(&mut self, instruction: &Instruction) -> String {
        let mut text = String::new();
        if let Some(result) = instruction.result.filter(|_| instruction.op != Op::Function) {
            text = format!("{} = ", self.spell(&Operand::Id(result)));
            text.extend(self.decorations.get(&result).into_iter().flatten().map(String::as_str));
        }
        text + &self.spell_instruction(instruction)
    }

    fn spell_instruction(&mut self, instruction: &Instruction) -> String {
        let called = usize::from(instruction.op == Op::FunctionCall);
        let mut text = format!("{:?}", instruction.op);
        for (place, operand) in instruction.operands.iter().enumerate() {
            let operand = match operand {
                // After the result's type.
                Operand::Id(function) if called == 1 && place == 1 => format!("function {}", self.function(*function)),
                other => self.spell(other),
            };
            text.push(' ');
            text.push_str(&operand);
        }
        text
    }

    /// Returns the place of a function in the order of first use.
    fn function(&mut self, function: u32) -> usize {
        self.reached.iter().position(|known| *known == function).unwrap_or_else(|| {
            self.reached.push(function);
            self.reached.len() - 1
        })
    }

    fn spell(&mut self, operand: &Operand) -> String {
        match operand {
            Operand::Literal(word) => word.to_string(),
            Operand::Text(text) => format!("{text:?}"),
            Operand::Id(id) => match self.global.get(id) {
                Some(name) => name.clone(),
                None => {
                    let next = self.local.len();
                    format!("%{}", self.local.entry(*id).or_insert(next))
                }
            },
        }
    }
}
