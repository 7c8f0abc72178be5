//! Where the values of a function's expressions and variables lie while it runs: flat words, as rows of arguments are.

use super::machine::Site;
use naga::valid::FunctionInfo;
use naga::{ArraySize, Expression, Function, Handle, Literal, Module, ScalarKind, TypeInner};

/// The words of one function's expressions.
#[derive(Debug)]
pub(super) struct Layout {
    /// Type, first word and number of words of each expression.
    places: Vec<Place>,
    /// First word of each local variable, and the number of words of all.
    locals: Vec<usize>,
    local_words: usize,
    /// The words before anything has run: constants are in place.
    template: Vec<u32>,
    /// First word and number of words of each argument.
    arguments: Vec<usize>,
}

/// One expression's words.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// Its type; of a pointer, what it points to.
    pub(super) inner: TypeInner,
    pub(super) pointer: bool,
    pub(super) start: usize,
    pub(super) length: usize,
}

impl Place {
    /// The kind of its scalars; none of a struct's or an array's.
    pub(super) fn kind(&self) -> Option<ScalarKind> {
        match self.inner {
            TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } => Some(scalar.kind),
            _ => None,
        }
    }
}

impl Layout {
    pub(super) fn of(module: &Module, info: &FunctionInfo, function: &Function) -> Layout {
        let mut places = Vec::new();
        let mut words = 0;
        for (handle, _) in function.expressions.iter() {
            let (inner, pointer) = match info[handle].ty.inner_with(&module.types) {
                TypeInner::Pointer { base, .. } => (module.types[*base].inner.clone(), true),
                TypeInner::ValuePointer { size: Some(size), scalar, .. } => {
                    (TypeInner::Vector { size: *size, scalar: *scalar }, true)
                }
                TypeInner::ValuePointer { size: None, scalar, .. } => (TypeInner::Scalar(*scalar), true),
                inner => (inner.clone(), false),
            };
            // A pointer is the number of the local word that it points to.
            let length = if pointer { 1 } else { words_of(module, &inner) };
            places.push(Place { inner, pointer, start: words, length });
            words += length;
        }
        let mut local_words = 0;
        let locals = function.local_variables.iter().map(|(_, local)| {
            let start = local_words;
            local_words += words_of(module, &module.types[local.ty].inner);
            start
        });
        let locals: Vec<usize> = locals.collect();
        let mut template = vec![0; words];
        for (handle, expression) in function.expressions.iter() {
            let place = &places[handle.index()];
            if let Expression::LocalVariable(local) = expression {
                template[place.start] = locals[local.index()] as u32;
            } else if let Some(value) = constant(module, &function.expressions, handle) {
                template[place.start..place.start + place.length].copy_from_slice(&value);
            }
        }
        let mut start = 0;
        let arguments = function.arguments.iter().map(|argument| {
            start += words_of(module, &module.types[argument.ty].inner);
            start
        });
        let arguments = arguments.collect();
        Layout { places, locals, local_words, template, arguments }
    }

    pub(super) fn place(&self, handle: Handle<Expression>) -> &Place {
        &self.places[handle.index()]
    }

    /// The words of an argument among those of all.
    pub(super) fn argument(&self, index: usize) -> std::ops::Range<usize> {
        let start = if index == 0 { 0 } else { self.arguments[index - 1] };
        start..self.arguments[index]
    }

    /// Whether a condition compares floats: itself, or what it is put together from. A bool that was stored may have been such a one.
    pub(super) fn compares_floats(&self, function: &Function, condition: Handle<Expression>) -> bool {
        match &function.expressions[condition] {
            Expression::Binary { left, right, .. } => {
                self.place(*left).kind() == Some(ScalarKind::Float)
                    || self.compares_floats(function, *left)
                    || self.compares_floats(function, *right)
            }
            Expression::Unary { expr, .. } | Expression::Splat { value: expr, .. } => {
                self.compares_floats(function, *expr)
            }
            Expression::Relational { argument, .. } => self.compares_floats(function, *argument),
            _ => false,
        }
    }
}

/// How many words a value of a type has.
fn words_of(module: &Module, inner: &TypeInner) -> usize {
    match inner {
        TypeInner::Vector { size, .. } => *size as usize,
        TypeInner::Matrix { columns, rows, .. } => *columns as usize * *rows as usize,
        TypeInner::Array { base, size: ArraySize::Constant(length), .. } => {
            words_of(module, &module.types[*base].inner) * length.get() as usize
        }
        TypeInner::Struct { members, .. } => {
            members.iter().map(|member| words_of(module, &module.types[member.ty].inner)).sum()
        }
        _ => 1,
    }
}

/// Where part `index` of a composite lies in it, and how long it is.
pub(super) fn part(module: &Module, inner: &TypeInner, index: usize) -> (usize, usize) {
    match inner {
        TypeInner::Matrix { rows, .. } => (index * *rows as usize, *rows as usize),
        TypeInner::Array { base, .. } => {
            let length = words_of(module, &module.types[*base].inner);
            (index * length, length)
        }
        TypeInner::Struct { members, .. } => {
            let length = |member: &naga::StructMember| words_of(module, &module.types[member.ty].inner);
            (members[..index].iter().map(length).sum(), length(&members[index]))
        }
        _ => (index, 1),
    }
}

/// The words of an expression that is constant.
fn constant(module: &Module, expressions: &naga::Arena<Expression>, handle: Handle<Expression>) -> Option<Vec<u32>> {
    Some(match &expressions[handle] {
        Expression::Literal(literal) => vec![match *literal {
            Literal::F32(value) => value.to_bits(),
            Literal::U32(value) => value,
            Literal::I32(value) => value.cast_unsigned(),
            Literal::Bool(value) => value.into(),
            Literal::AbstractInt(value) => value as u32,
            Literal::AbstractFloat(value) => (value as f32).to_bits(),
            _ => return None,
        }],
        Expression::Constant(constant_of) => {
            constant(module, &module.global_expressions, module.constants[*constant_of].init)?
        }
        Expression::ZeroValue(ty) => vec![0; words_of(module, &module.types[*ty].inner)],
        Expression::Compose { components, .. } => {
            let parts = components.iter().map(|part| constant(module, expressions, *part));
            parts.collect::<Option<Vec<_>>>()?.concat()
        }
        Expression::Splat { size, value } => constant(module, expressions, *value)?.repeat(*size as usize),
        _ => return None,
    })
}

/// One call of a function.
pub(super) struct Frame<'a> {
    pub(super) function: &'a Function,
    pub(super) layout: &'a Layout,
    number: u32,
    values: Vec<u32>,
    locals: Vec<u32>,
    scratch: Vec<u32>,
    pub(super) result: Vec<u32>,
}

impl<'a> Frame<'a> {
    pub(super) fn new(function: &'a Function, layout: &'a Layout, handle: Handle<Function>) -> Self {
        let mut locals = vec![0; layout.local_words];
        let values = layout.template.clone();
        for ((_, local), start) in function.local_variables.iter().zip(&layout.locals) {
            if let Some(init) = local.init {
                let place = layout.place(init);
                locals[*start..start + place.length].copy_from_slice(&values[place.start..place.start + place.length]);
            }
        }
        let number = handle.index() as u32;
        Self { function, layout, number, values, locals, scratch: Vec::new(), result: Vec::new() }
    }

    pub(super) fn set_arguments(&mut self, words: &[u32]) {
        for (handle, expression) in self.function.expressions.iter() {
            if let Expression::FunctionArgument(index) = expression {
                self.set(handle, &words[self.layout.argument(*index as usize)]);
            }
        }
    }

    pub(super) fn site(&self, handle: Handle<Expression>) -> Site {
        Site { function: self.number, expression: handle.index() as u32 }
    }

    pub(super) fn words(&self, handle: Handle<Expression>) -> &[u32] {
        let place = self.layout.place(handle);
        &self.values[place.start..place.start + place.length]
    }

    pub(super) fn word(&self, handle: Handle<Expression>) -> u32 {
        self.values[self.layout.place(handle).start]
    }

    pub(super) fn set(&mut self, handle: Handle<Expression>, words: &[u32]) {
        let start = self.layout.place(handle).start;
        self.values[start..start + words.len()].copy_from_slice(words);
    }

    pub(super) fn load(&self, pointer: Handle<Expression>, length: usize) -> &[u32] {
        let start = self.word(pointer) as usize;
        &self.locals[start..start + length]
    }

    pub(super) fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) {
        let start = self.word(pointer) as usize;
        let place = self.layout.place(value);
        self.locals[start..start + place.length].copy_from_slice(&self.values[place.start..place.start + place.length]);
    }

    /// Room for a result, to be handed back.
    pub(super) fn take_scratch(&mut self) -> Vec<u32> {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.clear();
        scratch
    }

    pub(super) fn keep(&mut self, handle: Handle<Expression>, scratch: Vec<u32>) {
        self.set(handle, &scratch);
        self.scratch = scratch;
    }
}
