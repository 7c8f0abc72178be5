//! Prints a shader with the given values of its overrides as WGSL on standard output, and the
//! counts before and after on standard error.
//!
//! ```sh
//! cargo run -p lapidary-specialise --example strip -- \
//!   shader.wgsl EFFECT_DISPERSION=0 EFFECT_ABSORPTION=1
//! ```

use lapidary_specialise::spirv_counts::instructions;
use lapidary_specialise::{parse, specialise};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("usage: strip SHADER.wgsl [OVERRIDE=VALUE]...")?;
    let arguments: Vec<String> = arguments.collect();
    let values = arguments
        .iter()
        .map(|argument| {
            let (name, value) = argument.split_once('=').ok_or(format!("`{argument}`: expected OVERRIDE=VALUE"))?;
            Ok((name, value.parse::<f64>().map_err(|error| format!("`{argument}`: {error}"))?))
        })
        .collect::<Result<Vec<(&str, f64)>, String>>()?;
    let source = std::fs::read_to_string(&path).map_err(|error| format!("{path}: {error}"))?;
    let (module, _) = parse(&source, &path)?;
    let entries: Vec<String> = module.entry_points.iter().map(|point| point.name.clone()).collect();
    let entries: Vec<&str> = entries.iter().map(String::as_str).collect();
    let before = sizes(&specialise(module.clone(), &[], &entries)?);
    let (module, info) = specialise(module, &values, &entries)?;
    let after = sizes(&(module.clone(), info.clone()));
    let flags = naga::back::wgsl::WriterFlags::empty();
    println!("{}", naga::back::wgsl::write_string(&module, &info, flags)?);
    for (what, before, after) in
        [("instructions", before[0], after[0]), ("functions", before[1], after[1]), ("bindings", before[2], after[2])]
    {
        eprintln!("{what}: {before} with the overrides' defaults, {after} now");
    }
    Ok(())
}

/// Counts the instructions, functions and bindings of a module without overrides.
fn sizes((module, info): &(naga::Module, naga::valid::ModuleInfo)) -> [usize; 3] {
    let bindings = module.global_variables.iter().filter(|(_, variable)| variable.binding.is_some()).count();
    [instructions(module, info), module.functions.len(), bindings]
}
