//! Writes the compute entry point that calls a function once per row, from its signature alone.
//!
//! Buffers cannot hold bools, so each struct with a bool travels as a twin with `u32` in its place.
//! Everything else travels unchanged, in naga's layout.

use super::signature::Signature;
use crate::shape::{Scalar, Shape};
use std::fmt::Write as _;

/// The entry point's name.
pub const ENTRY_POINT: &str = "lapidary_kernel";
/// The struct that holds one row's arguments.
pub const INPUT: &str = "LapidaryKernelInput";
/// The struct that holds one row's result.
pub const OUTPUT: &str = "LapidaryKernelOutput";
/// Words of the kernel's text that a source may also declare: the entry point's own variables and
/// members, and words that have a meaning only in their context.
pub const HARMLESS: [&str; 13] = [
    "invocation",
    "row",
    "result",
    "x",
    "group",
    "binding",
    "compute",
    "workgroup_size",
    "builtin",
    "global_invocation_id",
    "storage",
    "read",
    "read_write",
];
/// Invocations in a workgroup.
pub const WORKGROUP_SIZE: u32 = 64;

/// Returns the WGSL text to append to the source that defines the function: transport structs, two
/// buffers (`@group(0)`: binding 0 holds the inputs, binding 1 the outputs), and the entry point.
pub fn kernel_source(signature: &Signature) -> String {
    let mut declarations = String::new();
    let mut declared = Vec::new();
    let mut members = String::new();
    let mut arguments = Vec::new();
    for (index, (_, shape)) in signature.arguments.iter().enumerate() {
        declare_twins(shape, &mut declared, &mut declarations);
        // No name ends in a digit: naga would rename it.
        let _ = writeln!(members, "    argument_{index}_of_row: {},", transport_name(shape));
        arguments.push(decode(shape, &format!("row.argument_{index}_of_row")));
    }
    declare_twins(&signature.result, &mut declared, &mut declarations);
    let result = transport_name(&signature.result);
    let encoded = encode(&signature.result, "result");
    format!(
        "{declarations}
struct {INPUT} {{
{members}}}

struct {OUTPUT} {{
    result: {result},
}}

@group(0) @binding(0) var<storage, read> lapidary_kernel_inputs: array<{INPUT}>;
@group(0) @binding(1) var<storage, read_write> lapidary_kernel_outputs: array<{OUTPUT}>;

@compute @workgroup_size({WORKGROUP_SIZE})
fn {ENTRY_POINT}(@builtin(global_invocation_id) invocation: vec3u) {{
    if (invocation.x >= arrayLength(&lapidary_kernel_outputs)) {{
        return;
    }}
    let row = lapidary_kernel_inputs[invocation.x];
    let result = {function}({arguments});
    lapidary_kernel_outputs[invocation.x] = {OUTPUT}({encoded});
}}
",
        function = signature.function,
        arguments = arguments.join(", "),
    )
}

/// Returns the transport type of `shape`.
fn transport_name(shape: &Shape) -> String {
    if !shape.holds_bool() {
        return shape.to_string();
    }
    match shape {
        Shape::Scalar(_) => "u32".to_owned(),
        Shape::Vector(size, _) => format!("vec{size}u"),
        Shape::Array(element, length) => format!("array<{}, {length}>", transport_name(element)),
        Shape::Struct(name, _) => format!("LapidaryTransport{name}"),
        Shape::Matrix(..) => unreachable!("a matrix holds no bool"),
    }
}

/// Declares the twin of each struct in `shape` that holds a bool, members before their struct.
fn declare_twins(shape: &Shape, declared: &mut Vec<String>, declarations: &mut String) {
    match shape {
        _ if !shape.holds_bool() => {}
        Shape::Array(element, _) => declare_twins(element, declared, declarations),
        Shape::Struct(_, fields) => {
            let twin = transport_name(shape);
            if declared.contains(&twin) {
                return;
            }
            fields.iter().for_each(|(_, shape)| declare_twins(shape, declared, declarations));
            let _ = writeln!(declarations, "struct {twin} {{");
            for (field, shape) in fields {
                let _ = writeln!(declarations, "    {field}: {},", transport_name(shape));
            }
            declarations.push_str("}\n\n");
            declared.push(twin);
        }
        Shape::Scalar(_) | Shape::Vector(..) | Shape::Matrix(..) => {}
    }
}

/// Returns the expression that converts the transported `expression` to a value of `shape`.
fn decode(shape: &Shape, expression: &str) -> String {
    convert(shape, expression, &|shape| shape.to_string(), &|shape, expression| match shape {
        Shape::Vector(size, Scalar::Bool) => format!("({expression} != vec{size}u(0u))"),
        _ => format!("({expression} != 0u)"),
    })
}

/// Returns the expression that converts a value of `shape` to its transported form.
fn encode(shape: &Shape, expression: &str) -> String {
    convert(shape, expression, &transport_name, &|shape, expression| match shape {
        Shape::Vector(size, Scalar::Bool) => format!("select(vec{size}u(0u), vec{size}u(1u), {expression})"),
        _ => format!("select(0u, 1u, {expression})"),
    })
}

/// Rebuilds a value member by member, down to the bools, which `bools` converts; parts without a
/// bool are passed unchanged.
fn convert(
    shape: &Shape,
    expression: &str,
    type_name: &dyn Fn(&Shape) -> String,
    bools: &dyn Fn(&Shape, &str) -> String,
) -> String {
    if !shape.holds_bool() {
        return expression.to_owned();
    }
    let parts: Vec<String> = match shape {
        Shape::Scalar(_) | Shape::Vector(..) => return bools(shape, expression),
        Shape::Array(element, length) => {
            (0..*length).map(|index| convert(element, &format!("{expression}[{index}]"), type_name, bools)).collect()
        }
        Shape::Struct(_, fields) => fields
            .iter()
            .map(|(name, shape)| convert(shape, &format!("{expression}.{name}"), type_name, bools))
            .collect(),
        Shape::Matrix(..) => unreachable!("a matrix holds no bool"),
    };
    format!("{}({})", type_name(shape), parts.join(", "))
}
