//! A recipe as its text declares it.

use lapidary_cookbook::marks;
use lapidary_translate::declarations::{Declaration, declarations, without_comment};
use lapidary_translate::{BindingKind, bindings};
use lapidary_wgsl::Recipe;
use naga::{ArraySize, Binding, BuiltIn, Handle, Module, ShaderStage, Type, TypeInner};
use std::collections::{BTreeSet, HashSet};

/// What a recipe's text says to a host.
pub(super) struct Description {
    pub(super) name: &'static str,
    pub(super) purpose: String,
    /// What its header says further.
    pub(super) text: String,
    pub(super) requires: Vec<&'static str>,
    pub(super) entries: Vec<Entry>,
    pub(super) bindings: Vec<Row>,
    pub(super) structs: Vec<Struct>,
    pub(super) overrides: Vec<Override>,
}

/// An entry point.
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) stage: &'static str,
    /// Threads of a workgroup, numbers that the GPU gives, or formats that are written.
    pub(super) needs: String,
    pub(super) comment: String,
}

/// A binding.
pub(super) struct Row {
    pub(super) group: u32,
    pub(super) binding: u32,
    pub(super) name: String,
    pub(super) kind: BindingKind,
    pub(super) ty: String,
    /// Bytes of a struct or fixed array, or of an element of an array without a length; `None` for textures
    /// and samplers.
    pub(super) bytes: Option<u32>,
    /// Whether it is an array without a length.
    pub(super) is_open: bool,
    /// The effects that bring it; empty if it is always there.
    pub(super) effects: String,
    pub(super) comment: String,
}

/// A struct that a binding holds.
pub(super) struct Struct {
    pub(super) name: String,
    pub(super) bytes: u32,
    pub(super) members: Vec<Member>,
}

/// A member of a struct.
pub(super) struct Member {
    pub(super) offset: u32,
    pub(super) name: String,
    pub(super) ty: String,
    pub(super) comment: String,
}

/// An override.
pub(super) struct Override {
    pub(super) name: String,
    pub(super) ty: String,
    pub(super) default: String,
    pub(super) comment: String,
}

impl Description {
    pub(super) fn of(recipe: &'static Recipe, source: &str) -> Result<Self, String> {
        let (ir, _) = lapidary_specialise::parse(source, recipe.name).map_err(|error| error.to_string())?;
        let lines: Vec<&str> = source.lines().collect();
        let declared = declarations(&lines);
        let comment = |name: &str| {
            let found = declared.iter().find(|declaration| declaration.name == Some(name));
            found.map_or_else(String::new, |found| joined(found.comment()))
        };
        let ty = |name: &str| {
            let found = declared.iter().find(|declaration| declaration.name == Some(name));
            found.and_then(|found| type_of(found)).unwrap_or_default()
        };
        let presence = Presence::of(recipe)?;
        let mut rows = Vec::new();
        let mut order: Vec<Handle<Type>> = Vec::new();
        for bound in bindings(&ir) {
            add_structs(&ir, bound.ty, &mut order);
            let (bytes, is_open) = size(&ir, bound.ty);
            rows.push(Row {
                group: bound.group,
                binding: bound.binding,
                ty: ty(&bound.name),
                kind: bound.kind,
                bytes,
                is_open,
                effects: presence.effects_of(&bound.name),
                comment: comment(&bound.name),
                name: bound.name,
            });
        }
        let structs = order.into_iter().map(|handle| struct_of(&ir, handle, &declared)).collect();
        let overrides = ir.overrides.iter().filter_map(|(_, it)| it.name.clone()).map(|name| Override {
            ty: ty(&name),
            default: default_of(&declared, &name),
            comment: comment(&name),
            name,
        });
        let entries = ir.entry_points.iter().map(|point| Entry {
            name: point.name.clone(),
            stage: match point.stage {
                ShaderStage::Vertex => "vertex",
                ShaderStage::Compute => "compute",
                _ => "fragment",
            },
            needs: needs(&ir, point),
            comment: comment(&point.name),
        });
        let purpose = recipe.source.lines().next().and_then(|line| line.split_once(": ")).map_or("", |(_, rest)| rest);
        Ok(Self {
            name: recipe.name,
            purpose: purpose.to_owned(),
            text: header(recipe.source),
            requires: recipe.requires(),
            entries: entries.collect(),
            bindings: rows,
            structs,
            overrides: overrides.collect(),
        })
    }
}

/// Returns what a recipe's header says below the lines that name its source and parts, as Markdown.
fn header(source: &str) -> String {
    let lines = source.lines().take_while(|line| line.starts_with("//"));
    let below = lines.skip_while(|line| *line != "//").skip(1).map(|line| line.trim_start_matches('/'));
    below.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n")
}

/// Returns the text of a comment's lines.
fn joined(lines: &[&str]) -> String {
    let words = lines.iter().map(|line| line.trim().trim_start_matches('/').trim());
    words.collect::<Vec<_>>().join(" ").trim().to_owned()
}

/// Returns the declared type of a variable or override.
fn type_of(declaration: &Declaration<'_>) -> Option<String> {
    let code = declaration.lines.iter().map(|line| without_comment(line)).find(|line| !line.trim().is_empty())?;
    let (_, ty) = code.split_once(": ")?;
    Some(ty.split(" = ").next()?.trim().trim_end_matches(';').to_owned())
}

fn default_of(declared: &[Declaration<'_>], name: &str) -> String {
    let found = declared.iter().find(|declaration| declaration.name == Some(name));
    let line = found.and_then(|found| found.lines.last());
    let value = line.and_then(|line| without_comment(line).split_once(" = "));
    value.map_or_else(String::new, |(_, value)| value.trim().trim_end_matches(';').to_owned())
}

/// Returns a type's bytes, or those of its elements, and whether it is an array without a length.
fn size(ir: &Module, ty: Handle<Type>) -> (Option<u32>, bool) {
    let mut layouter = naga::proc::Layouter::default();
    // A valid module has a layout.
    let laid_out = layouter.update(ir.to_ctx()).is_ok();
    match ir.types[ty].inner {
        TypeInner::Image { .. } | TypeInner::Sampler { .. } => (None, false),
        TypeInner::Array { size: ArraySize::Dynamic, stride, .. } => (Some(stride), true),
        // The last member of a struct may be one.
        TypeInner::Struct { ref members, .. } if members.last().is_some_and(|last| size(ir, last.ty).1) => {
            (members.last().map(|last| last.offset), true)
        }
        _ if laid_out => (Some(layouter[ty].size), false),
        _ => (None, false),
    }
}

/// Adds the structs that a type is made of, outer ones first, each once.
fn add_structs(ir: &Module, ty: Handle<Type>, order: &mut Vec<Handle<Type>>) {
    match &ir.types[ty].inner {
        TypeInner::Struct { members, .. } if !order.contains(&ty) => {
            order.push(ty);
            for member in members {
                add_structs(ir, member.ty, order);
            }
        }
        TypeInner::Array { base, .. } => add_structs(ir, *base, order),
        _ => {}
    }
}

fn struct_of(ir: &Module, handle: Handle<Type>, declared: &[Declaration<'_>]) -> Struct {
    let ty = &ir.types[handle];
    let name = ty.name.clone().unwrap_or_default();
    let TypeInner::Struct { members, span } = &ty.inner else {
        return Struct { name, bytes: 0, members: Vec::new() };
    };
    let text = declared.iter().find(|declaration| declaration.name == Some(name.as_str()));
    let lines: Vec<&str> = text.map_or_else(Vec::new, |text| text.lines.clone());
    let members = members.iter().map(|member| {
        let member_name = member.name.clone().unwrap_or_default();
        let place = lines.iter().position(|line| line.trim_start().starts_with(&format!("{member_name}: ")));
        let (ty, comment) = place.map_or_else(Default::default, |place| {
            let comments = lines[..place].iter().rev().take_while(|line| line.trim_start().starts_with("//")).count();
            let code = without_comment(lines[place]);
            let ty = code.split_once(": ").map_or("", |(_, ty)| ty.trim().trim_end_matches(','));
            (ty.to_owned(), joined(&lines[place - comments..place]))
        });
        Member { offset: member.offset, name: member_name, ty, comment }
    });
    Struct { bytes: *span, members: members.collect(), name }
}

/// Which bindings a recipe has with some effects off, by its cut texts.
struct Presence {
    effects: Vec<String>,
    /// Bindings without any effect.
    without_any: HashSet<String>,
    /// Bindings without one effect, in the order of `effects`.
    without: Vec<HashSet<String>>,
    /// Bindings with one effect alone.
    alone: Vec<HashSet<String>>,
}

impl Presence {
    fn of(recipe: &'static Recipe) -> Result<Self, String> {
        let effects = marks::effects(&recipe.compose());
        let known: Vec<&str> = effects.iter().map(String::as_str).collect();
        let left = |off: &[&str]| -> Result<HashSet<String>, String> {
            let text = marks::without(recipe, off).map_err(|fault| fault.message)?;
            let lines: Vec<&str> = text.lines().collect();
            let bound =
                |declaration: &Declaration<'_>| declaration.lines.iter().any(|line| line.starts_with("@group("));
            let names = declarations(&lines).into_iter().filter(bound).filter_map(|declaration| declaration.name);
            Ok(names.map(str::to_owned).collect())
        };
        let but = |effect: &str| known.iter().filter(|other| **other != effect).copied().collect::<Vec<_>>();
        Ok(Self {
            without_any: left(&known)?,
            without: known.iter().map(|effect| left(&[effect])).collect::<Result<_, _>>()?,
            alone: known.iter().map(|effect| left(&but(effect))).collect::<Result<_, _>>()?,
            effects,
        })
    }

    /// Returns which effects bring a binding: those without any of which it is gone, or else those of which one
    /// is enough; nothing if it is always there.
    fn effects_of(&self, binding: &str) -> String {
        if self.without_any.contains(binding) {
            return String::new();
        }
        let quoted = |sets: &[HashSet<String>], has: bool| -> Vec<String> {
            let all = self.effects.iter().zip(sets).filter(|(_, set)| set.contains(binding) == has);
            all.map(|(effect, _)| format!("`{effect}`")).collect()
        };
        let needed = quoted(&self.without, false);
        if needed.is_empty() { quoted(&self.alone, true).join(" or ") } else { needed.join(" and ") }
    }
}

/// Returns what an entry point needs of the host: threads, numbers, formats.
fn needs(ir: &Module, point: &naga::EntryPoint) -> String {
    let mut builtins: BTreeSet<&str> = BTreeSet::new();
    for argument in &point.function.arguments {
        add_builtins(ir, argument.binding.as_ref(), argument.ty, &mut builtins);
    }
    match point.stage {
        ShaderStage::Compute => {
            let [x, y, z] = point.workgroup_size;
            format!("workgroups of {x} × {y} × {z}")
        }
        ShaderStage::Vertex => {
            let names: Vec<String> = builtins.iter().map(|name| format!("`{name}`")).collect();
            format!("{}; no vertex buffer", names.join(", "))
        }
        _ => {
            let mut targets = Vec::new();
            if let Some(result) = &point.function.result {
                add_targets(ir, "", result.binding.as_ref(), result.ty, &mut targets);
            }
            format!("writes {}", targets.join(", "))
        }
    }
}

fn add_builtins(ir: &Module, binding: Option<&Binding>, ty: Handle<Type>, found: &mut BTreeSet<&'static str>) {
    match (binding, &ir.types[ty].inner) {
        (Some(Binding::BuiltIn(BuiltIn::VertexIndex)), _) => {
            found.insert("vertex_index");
        }
        (Some(Binding::BuiltIn(BuiltIn::InstanceIndex)), _) => {
            found.insert("instance_index");
        }
        (None, TypeInner::Struct { members, .. }) => {
            for member in members {
                add_builtins(ir, member.binding.as_ref(), member.ty, found);
            }
        }
        _ => {}
    }
}

/// Adds the colour targets of a fragment stage: their numbers and names.
fn add_targets(ir: &Module, name: &str, binding: Option<&Binding>, ty: Handle<Type>, found: &mut Vec<String>) {
    match (binding, &ir.types[ty].inner) {
        (Some(Binding::Location { location, .. }), _) => {
            let label = if name.is_empty() { String::new() } else { format!(" `{name}`") };
            found.push(format!("target {location}{label}"));
        }
        (None, TypeInner::Struct { members, .. }) => {
            for member in members {
                let name = member.name.as_deref().unwrap_or_default();
                add_targets(ir, name, member.binding.as_ref(), member.ty, found);
            }
        }
        (Some(Binding::BuiltIn(BuiltIn::FragDepth)), _) => found.push("depth".to_owned()),
        _ => {}
    }
}
