//! WGSL fitted to a host that has values, bindings and groups of its own.

use crate::TranslateError;
use crate::declarations::words;
use crate::settled::settled;
use naga::valid::TypeFlags;

/// Returns the text with constants in place of these overrides, without the branches that they rule out. A
/// value is written as in WGSL, without a suffix: `true`, `8`, `0.5`. Functions that no entry point reaches
/// any more go, but for those of `wanted`.
///
/// # Errors
/// Returns an error if the text has no such override, or if a value is not of its type.
pub fn with_constants(source: &str, values: &[(&str, &str)], wanted: &[&str]) -> Result<String, TranslateError> {
    let known: Vec<&str> = source.lines().filter_map(|line| Some(override_of(line)?.0)).collect();
    if let Some((unknown, _)) = values.iter().find(|(name, _)| !known.contains(name)) {
        return Err(unknown_name("override", unknown, &known));
    }
    if values.is_empty() {
        return Ok(source.to_owned());
    }
    let is_second = |(nth, (name, _)): &(usize, &(&str, &str))| values[..*nth].iter().any(|(other, _)| other == name);
    if let Some((_, (name, _))) = values.iter().enumerate().find(is_second) {
        return Err(TranslateError::Fit(format!("`{name}` is set twice")));
    }
    let text = lines_of(source, |line| {
        let Some((name, ty)) = override_of(line) else { return Ok(line.to_owned()) };
        let Some((_, value)) = values.iter().find(|(wanted, _)| *wanted == name) else { return Ok(line.to_owned()) };
        match literal(ty, value) {
            Some(literal) => Ok(format!("const {name}: {ty} = {literal};")),
            None => Err(TranslateError::Fit(format!("`{name}` is of type {ty}; `{value}` is no value of it"))),
        }
    })?;
    Ok(settled(&text, wanted))
}

/// Returns the text with private variables in place of these bindings: the host's own stage sets them
/// before it calls a function. `planes[73]` gives an array without a length its length.
///
/// # Errors
/// Returns an error if the text is not valid, has no such binding, or writes it, and if a variable cannot
/// hold what is bound: a texture, a sampler, an array without a length or whose length is asked for.
pub fn with_private(source: &str, names: &[&str]) -> Result<String, TranslateError> {
    if names.is_empty() {
        return Ok(source.to_owned());
    }
    let (module, info) = lapidary_specialise::parse(source, "the shader")?;
    let bound: Vec<(&str, TypeFlags)> = module
        .global_variables
        .iter()
        .filter(|(_, variable)| variable.binding.is_some())
        .filter_map(|(_, variable)| Some((variable.name.as_deref()?, info[variable.ty])))
        .collect();
    let names: Vec<(&str, Option<&str>)> = names.iter().map(|name| with_length(name)).collect();
    for (place, (name, length)) in names.iter().enumerate() {
        if names[..place].iter().any(|(other, _)| other == name) {
            return Err(TranslateError::Fit(format!("`{name}` is named twice")));
        }
        let Some((_, flags)) = bound.iter().find(|(bound, _)| bound == name) else {
            let known: Vec<&str> = bound.iter().map(|(name, _)| *name).collect();
            return Err(unknown_name("binding", name, &known));
        };
        let fit = |why: String| Err(TranslateError::Fit(why));
        let is_array = flags.contains(TypeFlags::DATA) && !flags.contains(TypeFlags::SIZED);
        match length {
            Some(length) if !is_array => return fit(format!("`{name}` has no length to set; leave [{length}] out")),
            Some(length) if length.parse::<u32>().is_ok_and(|length| length > 0) => {}
            Some(length) => return fit(format!("`{name}[{length}]`: give the number of elements, such as {name}[1]")),
            None if flags.contains(TypeFlags::CONSTRUCTIBLE) => {}
            None if is_array => {
                return fit(format!("`{name}` is an array without a length; give one, such as {name}[1]"));
            }
            None => {
                return fit(format!(
                    "`{name}` is a texture, a sampler or atomic, which no variable holds; leave it out"
                ));
            }
        }
    }
    let text = lines_of(source, |line| {
        let Some(Bound { name, declared, .. }) = binding_of(line) else { return Ok(line.to_owned()) };
        let Some((_, length)) = names.iter().find(|(wanted, _)| *wanted == name) else { return Ok(line.to_owned()) };
        if declared.contains("read_write") {
            return Err(TranslateError::Fit(format!("`{name}` is written; leave it out")));
        }
        let ty = line.split_once(&format!("{name}:")).map_or("", |(_, ty)| ty);
        let ty = length.map_or(ty.to_owned(), |length| ty.replace(">;", &format!(", {length}>;")));
        Ok(format!("var<private> {name}:{ty}"))
    })?;
    // A variable has a length that the text must not ask for.
    let asks = |name: &&(&str, Option<&str>)| name.1.is_some() && text.contains(&format!("arrayLength(&{})", name.0));
    if let Some((name, _)) = names.iter().find(asks) {
        return Err(TranslateError::Fit(format!(
            "the length of `{name}` is asked for, which needs a buffer; leave it out"
        )));
    }
    lapidary_specialise::parse(&text, "the shader")?;
    Ok(text)
}

/// Splits `name[length]`.
fn with_length(name: &str) -> (&str, Option<&str>) {
    match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
        Some((name, length)) => (name, Some(length)),
        None => (name, None),
    }
}

/// Returns the text with all bindings in one group, numbered from 0 in the order that they had, and a first
/// comment that lists them. The group is a number, or what stands for one: a constant's name, or what a
/// preprocessor replaces, such as `#{MATERIAL_BIND_GROUP}`.
#[must_use]
pub fn in_group(source: &str, group: &str) -> String {
    let mut bound: Vec<Bound<'_>> = source.lines().filter_map(binding_of).collect();
    bound.sort_by_key(|bound| bound.at);
    let place = |binding: (u32, u32)| bound.iter().position(|bound| bound.at == binding).unwrap_or_default();
    let mut text =
        format!("// All bindings are in group {group}. In brackets: their group and binding in the recipe.\n");
    for (number, Bound { name, at: binding, declared }) in bound.iter().enumerate() {
        text.push_str(&format!("//   {number}: {declared} {name} ({}, {})\n", binding.0, binding.1));
    }
    text.push('\n');
    for line in source.lines() {
        match binding_of(line) {
            Some(bound) => {
                let rest = line.find(" var").map_or("", |start| &line[start..]);
                text.push_str(&format!("@group({group}) @binding({}){rest}\n", place(bound.at)));
            }
            None => {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    text
}

/// A binding, as a line declares it.
struct Bound<'a> {
    name: &'a str,
    /// Group and binding.
    at: (u32, u32),
    /// `var<uniform>` and its like.
    declared: &'a str,
}

fn binding_of(line: &str) -> Option<Bound<'_>> {
    let (group, rest) = line.strip_prefix("@group(")?.split_once(") @binding(")?;
    let (binding, rest) = rest.split_once(") ")?;
    let (declaration, _) = rest.split_once(':')?;
    let (declared, name) = declaration.rsplit_once(' ')?;
    Some(Bound { name, at: (group.parse().ok()?, binding.parse().ok()?), declared })
}

/// Returns the name and the type of an override.
fn override_of(line: &str) -> Option<(&str, &str)> {
    let (name, rest) = line.strip_prefix("override ")?.split_once(':')?;
    Some((name.trim(), words(rest).next()?))
}

/// Returns a value as a literal of a type; `None` if it is none.
fn literal(ty: &str, value: &str) -> Option<String> {
    match ty {
        "bool" => value.parse::<bool>().ok().map(|value| value.to_string()),
        "u32" => value.parse::<u32>().ok().map(|value| format!("{value}u")),
        "i32" => value.parse::<i32>().ok().map(|value| format!("{value}i")),
        "f32" => value.parse::<f32>().ok().filter(|value| value.is_finite()).map(|value| format!("{value:?}f")),
        _ => None,
    }
}

fn unknown_name(what: &'static str, name: &str, known: &[&str]) -> TranslateError {
    let known = known.iter().map(|name| (*name).to_owned()).collect();
    TranslateError::NoSuch { what, name: name.to_owned(), known }
}

fn lines_of(source: &str, changed: impl Fn(&str) -> Result<String, TranslateError>) -> Result<String, TranslateError> {
    source.lines().map(|line| Ok(changed(line)? + "\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
// Number of steps.
override STEPS: u32 = 1u;
override SCALE: f32 = 1.0f;
override ON: bool = false;

struct View {
    eye: vec3f,
}

// The eye.
@group(0) @binding(3) var<uniform> view: View;
@group(1) @binding(0) var<storage, read> planes: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> count: u32;
@group(0) @binding(1) var map: texture_2d<f32>;

fn seen() -> vec4f {
    count = STEPS;
    if (ON) {
        return SCALE * planes[0] + textureLoad(map, vec2u(0u), 0);
    }
    return vec4f(view.eye, 1.0f);
}
";

    #[test]
    fn overrides_become_constants_of_their_type() {
        let text = with_constants(TEXT, &[("STEPS", "8"), ("SCALE", "2")], &[]).expect("set");
        for line in ["const STEPS: u32 = 8u;", "const SCALE: f32 = 2.0f;"] {
            assert!(text.contains(line), "{text}");
        }
        assert!(text.starts_with("// Number of steps.\nconst"), "{text}");
        let on = with_constants(TEXT, &[("ON", "true")], &[]).expect("set");
        assert!(on.contains("    return SCALE *") && !on.contains("if (ON)") && !on.contains("view.eye"), "{on}");
        lapidary_specialise::parse(&text, "text").expect("valid");
        assert_eq!(with_constants(TEXT, &[], &[]).expect("as it was"), TEXT);
        for (name, value) in [("STEPS", "-1"), ("STEPS", "8u"), ("SCALE", "inf"), ("ON", "1"), ("STEP", "1")] {
            with_constants(TEXT, &[(name, value)], &[]).expect_err(value);
        }
    }

    #[test]
    fn what_a_variable_can_hold_may_be_private() {
        let text = with_private(TEXT, &["view"]).expect("private");
        assert_eq!(text, TEXT.replace("@group(0) @binding(3) var<uniform> view", "var<private> view"));
        lapidary_specialise::parse(&text, "text").expect("valid");
        let text = with_private(TEXT, &["view", "planes[3]"]).expect("private");
        assert!(text.contains("var<private> planes: array<vec4f, 3>;"), "{text}");
        let asked = TEXT.replace("count = STEPS;", "count = arrayLength(&planes);");
        with_private(&asked, &["planes[3]"]).expect_err("its length is asked for");
        for name in ["planes", "planes[0]", "planes[n]", "view[1]", "map", "map[1]", "count", "vieu"] {
            with_private(TEXT, &[name]).expect_err(name);
        }
    }

    #[test]
    fn bindings_share_a_group_in_the_order_that_they_had() {
        let text = in_group(TEXT, "2");
        let (module, _) = lapidary_specialise::parse(&text, "text").expect("valid");
        let mut bound: Vec<(u32, &str)> = module
            .global_variables
            .iter()
            .filter_map(|(_, variable)| Some((variable.binding?, variable.name.as_deref()?)))
            .map(|(binding, name)| {
                assert_eq!(binding.group, 2);
                (binding.binding, name)
            })
            .collect();
        bound.sort_unstable();
        assert_eq!(bound, [(0, "map"), (1, "view"), (2, "count"), (3, "planes")]);
        assert!(text.contains("//   3: var<storage, read> planes (1, 0)\n"), "{text}");
        assert!(in_group(TEXT, "#{GROUP}").contains("@group(#{GROUP}) @binding(0) var map:"));
    }
}
