//! HLSL without naga's heap of samplers, and as glslang takes it.

use crate::bindings;
use crate::items::{Item, Kind};
use naga::back::hlsl;
use naga::{GlobalVariable, Module, TypeInner};
use std::collections::HashMap;

/// Gives naga the heap of samplers that it wants to read from; [`portable`] takes it out again.
pub fn give_heap(module: &Module, options: &mut hlsl::Options) {
    for (_, variable) in module.global_variables.iter() {
        if let (Some(binding), TypeInner::Sampler { .. }) = (variable.binding, &module.types[variable.ty].inner) {
            let key = hlsl::SamplerIndexBufferKey { group: binding.group };
            options.sampler_buffer_binding_map.insert(key, hlsl::BindTarget::default());
        }
    }
}

/// Returns naga's HLSL with each sampler in a register of its own, and without two forms that glslang
/// refuses: a whole number of the other sign in an atomic read, and an array made of one 0.
pub fn portable(text: &str, module: &Module) -> String {
    let heap = [
        "SamplerState nagaSamplerHeap",
        "SamplerComparisonState nagaComparisonSamplerHeap",
        "StructuredBuffer<uint> nagaGroup",
    ];
    let lines = text.lines().filter(|line| !heap.iter().any(|start| line.starts_with(start)));
    let line = |line: &str| {
        if line.contains(".InterlockedOr(") {
            return line.replace(", 0, ", ", 0u, ");
        }
        sampler(line, module).or_else(|| zeroed_array(line)).unwrap_or_else(|| line.to_owned())
    };
    lines.map(|text| line(text) + "\n").collect()
}

/// Returns the declaration of a sampler in its register, if a line takes one from the heap.
fn sampler(line: &str, module: &Module) -> Option<String> {
    let (declared, _) = line.strip_prefix("static const ")?.split_once(" = naga")?;
    let name = declared.rsplit(' ').next()?;
    // A keyword ends with an underscore here, and a name that a function has as well with a number.
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
    let is_it = |variable: &GlobalVariable| variable.name.as_deref().is_some_and(|word| word == name || word == base);
    let (_, variable) = module.global_variables.iter().find(|(_, variable)| is_it(variable))?;
    let space = variable.binding?.group;
    Some(format!("{declared} : register({}, space{space});", bindings::register_of(module, variable)))
}

/// Returns what sets an array to 0, if a line does that by a cast: `name = (float3[64][2])0;`.
fn zeroed_array(line: &str) -> Option<String> {
    let (name, cast) = line.trim_end().strip_suffix(")0;")?.split_once(" = (")?;
    let (element, lengths) = cast.split_at(cast.find('[')?);
    let indent = &name[..name.len() - name.trim_start().len()];
    let lengths: Vec<&str> = lengths.trim_matches(['[', ']']).split("][").collect();
    if name.trim_start().contains(' ') {
        // A declaration takes a list.
        let count = lengths.iter().map(|length| length.parse::<usize>().ok()).product::<Option<usize>>()?;
        let zeros = vec![format!("({element})0"); count];
        return Some(format!("{name} = {{ {} }};", zeros.join(", ")));
    }
    let loops = lengths.iter().enumerate().map(|(depth, length)| {
        let index = format!("at{depth}");
        format!("for (uint {index} = 0u; {index} < {length}u; {index}++) ")
    });
    let places: String = (0..lengths.len()).map(|depth| format!("[at{depth}]")).collect();
    Some(format!("{indent}{}{}{places} = ({element})0;", loops.collect::<String>(), name.trim_start()))
}

/// Replaces the calls by which naga makes constant structs by lists, which glslang takes for constants.
pub fn list_constants(items: &mut [Item]) {
    let structs: HashMap<String, Vec<bool>> = items
        .iter()
        .filter(|item| item.kind == Kind::Struct)
        .map(|item| (item.name.clone(), pads(&item.text)))
        .collect();
    for item in items.iter_mut().filter(|item| item.kind == Kind::Variable) {
        let Some((declared, value)) = item.text.split_once(" = Construct") else { continue };
        let Some((made, fields)) = value.split_once('(') else { continue };
        let (Some(pads), Some(fields)) = (structs.get(made), fields.trim_end().strip_suffix(");")) else { continue };
        let mut fields = split(fields).into_iter();
        if fields.as_slice().iter().any(|field| field.contains("Construct")) {
            continue;
        }
        let values: Option<Vec<&str>> =
            pads.iter().map(|is_pad| if *is_pad { Some("0") } else { fields.next() }).collect();
        let Some(values) = values else { continue };
        item.text = format!("{declared} = {{ {} }};", values.join(", "));
    }
}

/// Returns for each member of a struct whether it only fills a gap.
fn pads(text: &str) -> Vec<bool> {
    let members = text.lines().filter(|line| line.starts_with(' ') && line.trim_end().ends_with(';'));
    members.map(|line| line.contains(" _pad") || line.contains(" _end_pad")).collect()
}

/// Splits a list at the commas that no parentheses hold.
fn split(list: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0i32, 0);
    for (place, character) in list.char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(list[start..place].trim());
                start = place + 1;
            }
            _ => {}
        }
    }
    parts.push(list[start..].trim());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_is_set_to_0_by_loops() {
        let found = zeroed_array("    squares = (float3[64][2])0;").expect("a cast of an array");
        let expected = "    for (uint at0 = 0u; at0 < 64u; at0++) for (uint at1 = 0u; at1 < 2u; at1++) squares[at0][at1] = (float3)0;";
        assert_eq!(found, expected);
        let found = zeroed_array("static uint stack[3] = (uint[3])0;").expect("a cast of an array");
        assert_eq!(found, "static uint stack[3] = { (uint)0, (uint)0, (uint)0 };");
        assert_eq!(zeroed_array("    Hit ret = (Hit)0;"), None);
    }

    #[test]
    fn a_constant_struct_is_a_list() {
        let text = "struct Index {\n    float a;\n    int _pad1_0;\n    float3 b;\n};\nstatic const Index GLASS = ConstructIndex(1.0, float3(2.0, 3.0, 4.0));\n";
        let mut found = crate::items::items(text);
        list_constants(&mut found);
        assert_eq!(found[1].text, "static const Index GLASS = { 1.0, 0, float3(2.0, 3.0, 4.0) };");
    }
}
