//! What a vertex stage hands on and no fragment stage reads.

use crate::validate;
use naga::proc::{Alignment, Layouter};
use naga::valid::{FunctionInfo, ModuleInfo, ValidationError};
use naga::{Arena, Binding, EntryPoint, Expression, Function, Handle, Module, ShaderStage, StructMember, Type};
use naga::{TypeInner, WithSpan};
use std::collections::HashSet;

/// Drops the members of the struct between a vertex and a fragment stage that nothing reads; whether there was any. What
/// only they needed is dead then. The module is compact, so that an expression is one in use.
///
/// Where the stages name two structs, or only one of the stages is kept, nothing is dropped: a fragment stage may not
/// ask for what no vertex stage gives. Nor is a member that the vertex stage assigns by itself.
pub(super) fn drop_unread_members(module: &mut Module) -> Result<bool, Box<WithSpan<ValidationError>>> {
    let Some(handed_on) = handed_on(module) else { return Ok(false) };
    let info = validate(module)?;
    let members = members(module, handed_on);
    let read = read_members(module, &info, handed_on);
    let is_kept =
        |index: usize| read.contains(&index) || !matches!(members[index].binding, Some(Binding::Location { .. }));
    let kept: Vec<usize> = (0..members.len()).filter(|index| is_kept(*index)).collect();
    if kept.len() == members.len() {
        return Ok(false);
    }
    let accesses = accesses(module, &info, handed_on);
    let mut accesses = accesses.into_iter();
    for function in functions_mut(module) {
        let accessed = accesses.next().unwrap_or_default();
        for expression in accessed {
            if let Expression::AccessIndex { index, .. } = function.expressions.get_mut(expression) {
                let place = kept.binary_search(&(*index as usize)).expect("what is accessed is kept");
                *index = u32::try_from(place).expect("moved towards the front");
            }
        }
        keep_components(&mut function.expressions, handed_on, &kept);
    }
    keep_components(&mut module.global_expressions, handed_on, &kept);
    let kept = kept.into_iter().map(|index| members[index].clone()).collect();
    let inner = laid_out(module, kept);
    let name = module.types[handed_on].name.clone();
    module.types.replace(handed_on, Type { name, inner });
    Ok(true)
}

/// The struct that the vertex stage returns and every fragment stage takes, where nothing else depends on its layout.
fn handed_on(module: &Module) -> Option<Handle<Type>> {
    let of = |stage| module.entry_points.iter().filter(move |entry| entry.stage == stage);
    let returned = of(ShaderStage::Vertex).find_map(|entry| entry.function.result.as_ref()).map(|result| result.ty)?;
    let is_struct = |ty: Handle<Type>| matches!(module.types[ty].inner, TypeInner::Struct { .. });
    let takes_it_alone = |entry: &EntryPoint| {
        let takes = |ty| entry.function.arguments.iter().any(|argument| argument.ty == ty);
        let located = |ty: Handle<Type>, binding: &Option<Binding>| match binding {
            Some(binding) => matches!(binding, Binding::Location { .. }),
            None => is_struct(ty),
        };
        let mut others = entry.function.arguments.iter().filter(|argument| argument.ty != returned);
        takes(returned) && !others.any(|argument| located(argument.ty, &argument.binding))
    };
    let is_part_of = |inner: &TypeInner| match inner {
        TypeInner::Struct { members, .. } => members.iter().any(|member| member.ty == returned),
        TypeInner::Array { base, .. } | TypeInner::BindingArray { base, .. } => *base == returned,
        _ => false,
    };
    let alone = is_struct(returned)
        && of(ShaderStage::Fragment).next().is_some()
        && of(ShaderStage::Fragment).all(takes_it_alone)
        && !module.types.iter().any(|(_, ty)| is_part_of(&ty.inner))
        && !module.global_variables.iter().any(|(_, variable)| variable.ty == returned);
    alone.then_some(returned)
}

fn members(module: &Module, ty: Handle<Type>) -> Vec<StructMember> {
    match &module.types[ty].inner {
        TypeInner::Struct { members, .. } => members.clone(),
        _ => Vec::new(),
    }
}

/// All functions, the entry points' behind the others.
fn functions(module: &Module) -> impl Iterator<Item = &Function> {
    let functions = module.functions.iter().map(|(_, function)| function);
    functions.chain(module.entry_points.iter().map(|entry| &entry.function))
}

/// The same in the same order, to be changed.
fn functions_mut(module: &mut Module) -> impl Iterator<Item = &mut Function> {
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    functions.chain(module.entry_points.iter_mut().map(|entry| &mut entry.function))
}

/// For each function, in order, the expressions that take a member out of the struct or out of a variable of its type.
fn accesses(module: &Module, info: &ModuleInfo, ty: Handle<Type>) -> Vec<Vec<Handle<Expression>>> {
    let infos = module.functions.iter().map(|(handle, _)| &info[handle]);
    let infos = infos.chain((0..module.entry_points.len()).map(|index| info.get_entry_point(index)));
    let is_of = |info: &FunctionInfo, base: Handle<Expression>| match info[base].ty.inner_with(&module.types) {
        TypeInner::Pointer { base, .. } => *base == ty,
        _ => info[base].ty.handle() == Some(ty),
    };
    let accesses = |(function, info): (&Function, &FunctionInfo)| {
        let accesses = function.expressions.iter().filter(|(_, expression)| match expression {
            Expression::AccessIndex { base, .. } => is_of(info, *base),
            _ => false,
        });
        accesses.map(|(handle, _)| handle).collect()
    };
    functions(module).zip(infos).map(accesses).collect()
}

/// The members that an expression names.
fn read_members(module: &Module, info: &ModuleInfo, ty: Handle<Type>) -> HashSet<usize> {
    let accesses = functions(module).zip(accesses(module, info, ty));
    accesses
        .flat_map(|(function, accesses)| {
            accesses.into_iter().filter_map(|access| match function.expressions[access] {
                Expression::AccessIndex { index, .. } => Some(index as usize),
                _ => None,
            })
        })
        .collect()
}

/// Leaves out the other components wherever the struct is composed.
fn keep_components(expressions: &mut Arena<Expression>, composed: Handle<Type>, kept: &[usize]) {
    for (_, expression) in expressions.iter_mut() {
        if let Expression::Compose { ty, components } = expression
            && *ty == composed
        {
            *components = kept.iter().map(|index| components[*index]).collect();
        }
    }
}

/// A struct of these members, one behind another as WGSL lays them out.
fn laid_out(module: &Module, mut members: Vec<StructMember>) -> TypeInner {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).expect("a valid module's types have a layout");
    let (mut end, mut alignment) = (0, Alignment::ONE);
    for member in &mut members {
        let layout = layouter[member.ty];
        member.offset = layout.alignment.round_up(end);
        end = member.offset + layout.size;
        alignment = alignment.max(layout.alignment);
    }
    TypeInner::Struct { members, span: alignment.round_up(end) }
}
