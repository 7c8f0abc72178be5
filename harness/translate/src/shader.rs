//! A whole shader.

use crate::bindings::{self, Place};
use crate::declarations::{Declaration, declarations, without_comment};
use crate::hlsl;
use crate::items::{Item, items};
use crate::library::{commented, culprit, other_names};
use crate::names::{rename_globals, restore_globals, take_numbers_off};
use crate::overrides::with_defaults;
use crate::{Language, Setting, TranslateError, written};
use naga::back::{glsl, spv};
use naga::{AddressSpace, Module, ShaderStage};

/// Translates a whole shader. Its first comment tells what was set, and where each binding is found.
///
/// Overrides have their default values. GLSL holds one entry point, which `entry` names.
///
/// # Errors
/// Returns an error if the source is not valid WGSL, if there is no such entry point, or if the language
/// lacks something that the shader needs.
pub fn shader(source: &str, name: &str, language: Language, entry: Option<&str>) -> Result<String, TranslateError> {
    let loads = if language.is_glsl() { depths_as_floats(source) } else { None };
    let (whole, _) = lapidary_specialise::parse(loads.as_deref().unwrap_or(source), name)?;
    let mut module = whole.clone();
    let entry = entry_of(&module, name, language, entry)?;
    let lacks = |what: &str, why: &str| TranslateError::Lacks {
        language: language.title(),
        what: what.to_owned(),
        why: why.to_owned(),
    };
    let overrides: Vec<String> = module.overrides.iter().filter_map(|(_, it)| it.name.clone()).collect();
    if let Some((entry, _)) = &entry {
        module.entry_points.retain(|point| point.name == *entry);
    }
    let (mut module, _) = with_defaults(&module).map_err(|why| lacks("the shader", &why))?;
    // What the entry points do not need goes.
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    let info = lapidary_specialise::validate(&module).map_err(|error| lacks("the shader", &error.to_string()))?;
    if let (Language::GlslEs, Some((entry, stage))) = (language, &entry) {
        if *stage == ShaderStage::Compute {
            return Err(lacks(&format!("{name}::{entry}"), "compute shaders"));
        }
        let buffers = storage_buffers(&module);
        if !buffers.is_empty() {
            return Err(lacks(&format!("{name}::{entry}"), &format!("storage buffers (`{}`)", buffers.join("`, `"))));
        }
    }
    // No flip of clip space: the text says what the shader says.
    let mut setting = Setting::strict(entry, glsl::WriterFlags::empty());
    let places = bindings::assign(&whole, &module, language, &mut setting);
    hlsl::give_heap(&module, &mut setting.hlsl);
    let (body, found) = written(&module, &info, language, &setting)
        .map_err(|why| culprit(loads.as_deref().unwrap_or(source), language, why))?;
    let lines: Vec<&str> = source.lines().collect();
    let declarations = declarations(&lines);
    let mut items: Vec<Item> = match found {
        Some(found) => with_names(&items(&body), &module, &found),
        None if language == Language::Hlsl => items(&hlsl::portable(&body, &module)),
        None => items(&body),
    };
    if language == Language::Hlsl {
        hlsl::list_constants(&mut items);
    }
    let declared = declarations.iter().filter_map(|declaration| declaration.name).collect();
    restore_globals(&mut items, &declared);
    take_numbers_off(&mut items);
    // GLSL calls every entry point so.
    for item in items.iter_mut().filter(|item| language.is_glsl() && item.name == "main") {
        item.name = setting.entry.as_ref().map_or_else(String::new, |(entry, _)| entry.clone());
    }
    let mut text = String::new();
    // A version's directive comes first.
    let version = items.iter().position(|item| item.text.starts_with("#version"));
    if let Some(place) = version {
        text = format!("{}\n", items.remove(place).text);
    }
    text.push_str(&header(&declarations, &items));
    text.push_str(&note(name, language, &setting, &body));
    text.push_str(&other_names(&items, source));
    text.push_str(&settings(&overrides, &declarations));
    text.push_str(&table(&places, &declarations, language));
    text.push_str(&commented(&items, &declarations));
    Ok(text)
}

/// Writes SPIR-V, little endian, with the overrides' default values. Sets and bindings are WGSL's groups and
/// bindings, and clip space is WebGPU's.
///
/// # Errors
/// Returns naga's message if SPIR-V lacks something.
pub fn spirv(module: &Module) -> Result<Vec<u8>, String> {
    let (module, info) = with_defaults(module)?;
    let mut options = spv::Options::default();
    // No flip of clip space: a viewport of negative height does that.
    options.flags.remove(spv::WriterFlags::ADJUST_COORDINATE_SPACE);
    let words = spv::write_vec(&module, &info, &options, None).map_err(|error| error.to_string())?;
    Ok(words.iter().flat_map(|word| word.to_le_bytes()).collect())
}

/// Returns the entry point to write; `None` if the language's texts hold them all.
fn entry_of(
    module: &Module,
    name: &str,
    language: Language,
    entry: Option<&str>,
) -> Result<Option<(String, ShaderStage)>, TranslateError> {
    let found = || {
        let points = module.entry_points.iter().map(|point| format!("{name}::{}", point.name));
        points.collect::<Vec<_>>().join(", ")
    };
    let point_of = |wanted: &str| module.entry_points.iter().find(|point| point.name == wanted);
    match (entry, module.entry_points.as_slice()) {
        (Some(wanted), _) => match point_of(wanted) {
            Some(point) => Ok(Some((wanted.to_owned(), point.stage))),
            None => {
                Err(TranslateError::NoEntryPoint { name: name.to_owned(), entry: wanted.to_owned(), found: found() })
            }
        },
        (None, _) if !language.is_glsl() => Ok(None),
        (None, [only]) => Ok(Some((only.name.clone(), only.stage))),
        (None, _) => Err(TranslateError::WhichEntryPoint { language: language.title(), found: found() }),
    }
}

/// Returns the source with its depth textures as textures of floats; `None` if it has none, or if they are
/// sampled, which compares. GLSL has no loads from textures of depth.
fn depths_as_floats(source: &str) -> Option<String> {
    const DEPTH: &str = ": texture_depth_2d;";
    let lines = source.lines().filter(|line| without_comment(line).trim_end().ends_with(DEPTH));
    let names: Vec<&str> =
        lines.filter_map(|line| without_comment(line).trim_end().strip_suffix(DEPTH)?.rsplit(' ').next()).collect();
    let mut text = source.replace(DEPTH, ": texture_2d<f32>;");
    for name in &names {
        let sampled = ["textureSample", "textureGather"].iter().any(|call| {
            text.match_indices(call)
                .any(|(start, _)| text[start..].split_once('(').is_some_and(|(_, rest)| rest.starts_with(name)))
        });
        if sampled {
            return None;
        }
        let call = format!("textureLoad({name},");
        let places: Vec<usize> = text.match_indices(&call).map(|(start, _)| start).collect();
        for start in places.into_iter().rev() {
            let mut depth = 0i32;
            let end = text[start..].char_indices().find_map(|(offset, character)| {
                depth += i32::from(character == '(') - i32::from(character == ')');
                (character == ')' && depth == 0).then_some(start + offset + 1)
            })?;
            text.insert_str(end, ".x");
        }
    }
    (!names.is_empty()).then_some(text)
}

fn storage_buffers(module: &Module) -> Vec<&str> {
    let variables = module.global_variables.iter().map(|(_, variable)| variable);
    let buffers = variables.filter(|variable| matches!(variable.space, AddressSpace::Storage { .. }));
    buffers.filter_map(|variable| variable.name.as_deref()).collect()
}

/// Returns GLSL's items with the shader's own names of bindings.
fn with_names(found: &[Item], module: &Module, reflection: &glsl::ReflectionInfo) -> Vec<Item> {
    let mut names = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let (Some(binding), Some(name)) = (variable.binding, &variable.name) else { continue };
        for stage in ["vs", "fs", "cs"] {
            names.push((format!("_group_{}_binding_{}_{stage}", binding.group, binding.binding), name.clone()));
        }
        if let Some(block) = reflection.uniforms.get(&handle) {
            names.push((block.clone(), format!("{name}_block")));
        }
    }
    let mut found = found.to_vec();
    rename_globals(&mut found, &names);
    found
}

/// Returns the first comment of the last text that has one: a recipe's own, below its modules'. Then come those of
/// which something is left.
fn header(declarations: &[Declaration<'_>], items: &[Item]) -> String {
    let is_left = |name: &str| items.iter().any(|item| item.name == name || item.text.contains(name));
    let mut headers: Vec<(&Declaration<'_>, bool)> = Vec::new();
    for declaration in declarations {
        if declaration.is_header() {
            headers.push((declaration, false));
        } else if let (Some((_, has_any)), Some(name)) = (headers.last_mut(), declaration.name) {
            *has_any |= is_left(name);
        }
    }
    let Some(((last, _), others)) = headers.split_last() else { return String::new() };
    let mut text: String = last.comment().iter().flat_map(|line| [line, "\n"]).collect();
    let others: Vec<&Declaration<'_>> =
        others.iter().filter(|(_, has_any)| *has_any).map(|(other, _)| *other).collect();
    if !others.is_empty() {
        text.push_str("//\n// It holds:\n");
    }
    for other in others {
        // Name and purpose, licence, and source with its further lines.
        let lines = other.comment().iter().take_while(|line| **line != "//");
        let kept = lines.filter(|line| !line.starts_with("// Version:"));
        text.extend(kept.enumerate().map(|(index, line)| {
            let line = line.trim_start_matches("//").trim_start();
            format!("// {} {line}\n", if index == 0 { "-" } else { " " })
        }));
    }
    text
}

/// Returns the comment that says what language this is, and what differs there.
fn note(name: &str, language: Language, setting: &Setting, body: &str) -> String {
    let of_entry = setting.entry.as_ref().map_or(String::new(), |(entry, _)| format!("::{entry}"));
    let mut text = format!("//\n// {language}, translated from {name}{of_entry} by naga.\n");
    let mut say = |line: &str| text.push_str(&format!("// {line}\n"));
    let is_drawn = setting.entry.as_ref().is_none_or(|(_, stage)| *stage != ShaderStage::Compute);
    match language {
        Language::Glsl if is_drawn => {
            say("Clip space is WebGPU's: y up, depth from 0 to 1; call glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE).");
            say("Row 0 of a target is the top in WebGPU and the bottom here: gl_FragCoord.y counts from there.");
        }
        Language::GlslEs if is_drawn => {
            say(
                "Clip space is WebGPU's: y up, depth from 0 to 1. A vertex shader's gl_Position.z is to become 2 z - w.",
            );
            say("Row 0 of a target is the top in WebGPU and the bottom here: gl_FragCoord.y counts from there.");
        }
        Language::Hlsl if is_drawn => {
            say("Clip space is Direct3D's as it is WebGPU's. SV_VertexID and SV_InstanceID start at 0 in each");
            say("draw, WebGPU's indices at the draw's first.");
        }
        Language::Msl if is_drawn => say("Clip space is Metal's as it is WebGPU's."),
        _ => {}
    }
    if body.contains("naga_vs_first_instance") {
        say("naga_vs_first_instance: the draw's first instance, mostly 0.");
    }
    text
}

/// Returns the comment with the overrides' values.
fn settings(overrides: &[String], declarations: &[Declaration<'_>]) -> String {
    if overrides.is_empty() {
        return String::new();
    }
    let mut text = "//\n// Set here, in WGSL by an override:\n".to_owned();
    for declaration in declarations {
        let Some(name) = declaration.name.filter(|name| overrides.iter().any(|it| it == name)) else { continue };
        let code = declaration.lines.iter().map(|line| without_comment(line)).find(|line| line.contains("override "));
        let value = code.and_then(|code| code.split_once('=')).map_or("", |(_, value)| value.trim());
        text.push_str(&format!("//   {name} = {}\n", value.trim_end_matches(';')));
    }
    text
}

/// Returns the comment with the bindings' places.
fn table(places: &[Place], declarations: &[Declaration<'_>], language: Language) -> String {
    let mut rows = Vec::new();
    for place in places {
        let declaration = declarations.iter().find(|declaration| declaration.name == Some(place.name.as_str()));
        let lines = declaration.map_or(&[][..], |declaration| &declaration.lines);
        let code = lines.iter().find_map(|line| Some(&line[line.find(" var")? + 1..]));
        let code = code.map_or("", |code| without_comment(code).trim_end().trim_end_matches(';'));
        let attributes =
            place.wgsl.map_or(String::new(), |slot| format!("@group({}) @binding({}) ", slot.group, slot.binding));
        // In Metal a binding is an argument, without a place for its comment.
        let comment = match (language, declaration) {
            (Language::Msl, Some(declaration)) => declaration.comment(),
            _ => &[],
        };
        rows.push((format!("{attributes}{}", if code.is_empty() { &place.name } else { code }), &place.place, comment));
    }
    if rows.is_empty() {
        return String::new();
    }
    let mut text = "//\n// Bindings, in WGSL and here:\n".to_owned();
    for (wgsl, place, comment) in rows {
        text.push_str(&format!("//   {wgsl}: {place}\n"));
        text.extend(comment.iter().map(|line| format!("//     {}\n", line.trim_start_matches("//").trim_start())));
    }
    text
}
