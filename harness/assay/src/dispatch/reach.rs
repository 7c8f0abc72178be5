//! The functions that a function calls, and the module-scope variables that those read. A function
//! that a kernel calls must be pure, and small enough for a compiler to inline into one piece.

use lapidary_specialise::for_each_statement;
use naga::{AddressSpace, Expression, Function, Handle, Module, Span, Statement, TypeInner};
use std::collections::BTreeSet;

/// Most bytes of variables of a function and its callees: what WGSL guarantees in the function address space (section 2.4,
/// limits). Lavapipe compiles an array that is indexed at run time in a time of its square: one of that size for minutes.
const MOST_BYTES: u64 = 8_192;
/// Nesting depth of structs and arrays that WGSL guarantees.
const DEEPEST_TYPE: usize = 15;
/// Deepest chain of calls.
const DEEPEST_CALL: usize = 100;
/// Most statements and expressions after all calls are inlined, as compilers for GPUs do.
const MOST_INLINED: u64 = 1_000_000;

/// A fault that naga does not see in the text of a module: its place, and one line with a remedy.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Place of the fault; undefined if nothing names it.
    pub span: Span,
    /// The fault and its remedy.
    pub message: String,
}

/// Needs of a function with all of its calls inlined.
#[derive(Clone, Copy, Default)]
struct Cost {
    depth: usize,
    inlined: u64,
    bytes: u64,
}

/// Checks that a kernel can call `function` of a validated module: that neither it nor its callees
/// read a binding, an override or another variable of the module, and that their total size is one
/// that compilers accept.
pub fn check(module: &Module, function: &str) -> Result<(), Fault> {
    let Some((root, _)) = module.functions.iter().find(|(_, found)| found.name.as_deref() == Some(function)) else {
        // naga does not count an entry point as a function. If the function does not exist at all,
        // its reflection says so.
        return match module.entry_points.iter().find(|point| point.name == function) {
            Some(_) => Err(Fault {
                span: Span::UNDEFINED,
                message: format!("`{function}` is an entry point, which nothing can call; make it a plain function"),
            }),
            None => Ok(()),
        };
    };
    let costs = costs(module)?;
    let fault = |message: String| {
        Err(Fault { span: module.functions.get_span(root), message: format!("`{function}` {message}") })
    };
    let cost = costs[root.index()];
    if cost.depth > DEEPEST_CALL {
        return fault(format!("calls functions {} deep, at most {DEEPEST_CALL}; shorten the chain", cost.depth));
    }
    if cost.inlined > MOST_INLINED {
        return fault(format!(
            "has over {MOST_INLINED} expressions once its calls are inlined, as compilers do; call less often"
        ));
    }
    if cost.bytes > MOST_BYTES {
        return fault(format!(
            "needs {} bytes of variables, and WGSL promises {MOST_BYTES}; make its arrays smaller",
            cost.bytes
        ));
    }
    let deep = deep_types(module);
    for handle in reached(module, root) {
        let reached = &module.functions[handle];
        let variables = reached.local_variables.iter().map(|(_, variable)| variable.ty);
        let values = reached.expressions.iter().filter_map(|(_, expression)| value_type(module, expression));
        if let Some(ty) = variables.chain(values).find(|ty| deep.contains(ty)) {
            let name = module.types[ty].name.as_deref().unwrap_or("array");
            return fault(format!(
                "uses `{name}`, which holds structs and arrays over {DEEPEST_TYPE} deep, more than WGSL promises; flatten it"
            ));
        }
        pure(module, reached, function)?;
    }
    Ok(())
}

/// Returns the depth, size and memory of every function; naga keeps callees before their callers.
fn costs(module: &Module) -> Result<Vec<Cost>, Fault> {
    let mut layouter = naga::proc::Layouter::default();
    let sized = layouter.update(module.to_ctx());
    sized.map_err(|error| Fault { span: Span::UNDEFINED, message: error.to_string() })?;
    let size = |ty: Handle<naga::Type>| u64::from(layouter[ty].size);
    let mut costs: Vec<Cost> = Vec::new();
    for (_, function) in module.functions.iter() {
        let mut cost = Cost { depth: 1, ..Cost::default() };
        for (_, variable) in function.local_variables.iter() {
            cost.bytes = cost.bytes.saturating_add(size(variable.ty));
        }
        for (_, expression) in function.expressions.iter() {
            cost.inlined += 1;
            // Values are held in registers, unless they are too large: then they are stored in
            // memory to be indexed.
            if let Some(ty) = value_type(module, expression).filter(|ty| size(*ty) > MOST_BYTES) {
                cost.bytes = cost.bytes.saturating_add(size(ty));
            }
        }
        for_each_statement(&function.body, &mut |statement| {
            cost.inlined = cost.inlined.saturating_add(1);
            if let Statement::Call { function, .. } = statement {
                let callee = costs[function.index()];
                cost.depth = cost.depth.max(callee.depth + 1);
                cost.inlined = cost.inlined.saturating_add(callee.inlined);
                cost.bytes = cost.bytes.saturating_add(callee.bytes);
            }
        });
        costs.push(cost);
    }
    Ok(costs)
}

/// Returns the type of a value that an expression makes as a whole.
fn value_type(module: &Module, expression: &Expression) -> Option<Handle<naga::Type>> {
    match expression {
        Expression::ZeroValue(ty) | Expression::Compose { ty, .. } => Some(*ty),
        Expression::Constant(constant) => Some(module.constants[*constant].ty),
        _ => None,
    }
}

/// Returns the types that are nested too deep; naga keeps a type after its members.
fn deep_types(module: &Module) -> BTreeSet<Handle<naga::Type>> {
    let mut depths: Vec<usize> = Vec::new();
    let mut deep = BTreeSet::new();
    for (handle, ty) in module.types.iter() {
        let depth = match &ty.inner {
            TypeInner::Array { base, .. } => 1 + depths[base.index()],
            TypeInner::Struct { members, .. } => {
                1 + members.iter().map(|member| depths[member.ty.index()]).max().unwrap_or(0)
            }
            _ => 0,
        };
        if depth > DEEPEST_TYPE {
            deep.insert(handle);
        }
        depths.push(depth);
    }
    deep
}

/// Returns the function and everything that it calls.
fn reached(module: &Module, root: Handle<Function>) -> BTreeSet<Handle<Function>> {
    let mut found = BTreeSet::from([root]);
    let mut ahead = vec![root];
    while let Some(handle) = ahead.pop() {
        for_each_statement(&module.functions[handle].body, &mut |statement| {
            if let Statement::Call { function, .. } = statement
                && found.insert(*function)
            {
                ahead.push(*function);
            }
        });
    }
    found
}

/// Checks that a function within reach of `root` uses nothing but its arguments and the module's
/// consts.
fn pure(module: &Module, function: &Function, root: &str) -> Result<(), Fault> {
    let by = match function.name.as_deref() {
        Some(name) if name != root => format!("`{root}` reaches through `{name}`"),
        _ => format!("`{root}` uses"),
    };
    const ADVICE: &str = "a module holds pure functions, whose values all come as arguments";
    for (_, expression) in function.expressions.iter() {
        let (kind, name, span) = match expression {
            Expression::GlobalVariable(handle) => {
                let variable = &module.global_variables[*handle];
                let kind = match variable.space {
                    AddressSpace::Private => "`var<private>`",
                    AddressSpace::WorkGroup => "`var<workgroup>`",
                    _ => "binding",
                };
                (kind, &variable.name, module.global_variables.get_span(*handle))
            }
            Expression::Override(handle) => {
                ("`override`", &module.overrides[*handle].name, module.overrides.get_span(*handle))
            }
            _ => continue,
        };
        let name = name.as_deref().unwrap_or_default();
        let message = format!("{kind} `{name}`, which {by}: {ADVICE}; pass `{name}` as one, or remove it");
        return Err(Fault { span, message });
    }
    let mut barrier = false;
    for_each_statement(&function.body, &mut |statement| {
        barrier |= matches!(statement, Statement::ControlBarrier(_) | Statement::MemoryBarrier(_));
    });
    if barrier {
        let message = format!("a barrier, which {by}: {ADVICE}; remove it");
        return Err(Fault { span: Span::UNDEFINED, message });
    }
    Ok(())
}
