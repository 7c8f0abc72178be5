//! Drops vertex outputs that no fragment stage reads.

use crate::validate;
use naga::proc::{Alignment, Layouter};
use naga::valid::{FunctionInfo, ModuleInfo, ValidationError};
use naga::{Arena, Binding, EntryPoint, Expression, Function, Handle, Module, ShaderStage, StructMember, Type};
use naga::{TypeInner, WithSpan};
use std::collections::HashSet;

/// Drops the unread members of the struct between a vertex and a fragment stage; returns whether
/// there was any. Code that only they needed is then dead. The module is compact, so every
/// expression in it is in use.
///
/// Nothing is dropped if the stages name two different structs, or if only one of the stages is
/// kept: a fragment stage may not ask for an input that no vertex stage provides. A member that the
/// vertex stage assigns individually is kept too.
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

/// Returns the struct that the vertex stage returns and every fragment stage takes; `None` if
/// anything else depends on its layout.
fn handed_on(module: &Module) -> Option<Handle<Type>> {
    let entries_of = |stage| module.entry_points.iter().filter(move |entry| entry.stage == stage);
    let returned =
        entries_of(ShaderStage::Vertex).find_map(|entry| entry.function.result.as_ref()).map(|result| result.ty)?;
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
        && entries_of(ShaderStage::Fragment).next().is_some()
        && entries_of(ShaderStage::Fragment).all(takes_it_alone)
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

/// Returns all functions, followed by those of the entry points.
fn functions(module: &Module) -> impl Iterator<Item = &Function> {
    let functions = module.functions.iter().map(|(_, function)| function);
    functions.chain(module.entry_points.iter().map(|entry| &entry.function))
}

/// Returns the same functions in the same order, mutably.
fn functions_mut(module: &mut Module) -> impl Iterator<Item = &mut Function> {
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    functions.chain(module.entry_points.iter_mut().map(|entry| &mut entry.function))
}

/// Returns, for each function in order, the expressions that access a member of the struct or of a
/// variable of its type.
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

/// Returns the indices of the members that an expression accesses.
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

/// Removes the dropped components wherever the struct is composed.
fn keep_components(expressions: &mut Arena<Expression>, composed: Handle<Type>, kept: &[usize]) {
    for (_, expression) in expressions.iter_mut() {
        if let Expression::Compose { ty, components } = expression
            && *ty == composed
        {
            *components = kept.iter().map(|index| components[*index]).collect();
        }
    }
}

/// Returns a struct of these members, laid out one after another by WGSL's rules.
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
