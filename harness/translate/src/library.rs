//! A text without entry points.

use crate::declarations::{self, Declaration, declarations, of_functions, words};
use crate::hlsl;
use crate::items::{Item, Kind, items};
use crate::names::{camel, prefix_helpers, take_numbers_off};
use crate::overrides::with_defaults;
use crate::{Language, Setting, TranslateError, written};
use naga::ShaderStage;
use naga::back::glsl;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Translates functions, structs and consts, with their comments and names.
///
/// `name` begins the names of what the language needs besides: `optics_` of functions, `Optics` of types.
///
/// # Errors
/// Returns an error if the source is not valid WGSL, or if the language lacks something that a function
/// needs; the function is named.
pub fn library(source: &str, name: &str, language: Language) -> Result<String, TranslateError> {
    lapidary_specialise::parse(source, name)?;
    let body = translated(source, language).map_err(|why| culprit(source, language, why))?;
    let lines: Vec<&str> = source.lines().collect();
    let declarations = declarations(&lines);
    let declared: HashSet<&str> = declarations.iter().filter_map(|declaration| declaration.name).collect();
    let mut items: Vec<Item> = items(&body).into_iter().filter(|item| is_kept(item, language)).collect();
    if language == Language::Hlsl {
        hlsl::list_constants(&mut items);
    }
    prefix_helpers(&mut items, &declared, &format!("{name}_"), &camel(name));
    take_numbers_off(&mut items);
    let header = declarations.first().filter(|first| first.name.is_none()).map_or(&[][..], Declaration::comment);
    let mut text: String = header.iter().flat_map(|line| [line, "\n"]).collect();
    text.push_str(&note(name, language));
    text.push_str(&other_names(&items, source));
    text.push_str(&commented(&items, &declarations));
    Ok(text)
}

/// Returns the items below the comments of the declarations that they translate.
pub(crate) fn commented(items: &[Item], declarations: &[Declaration<'_>]) -> String {
    let by_name: HashMap<&str, &Declaration<'_>> =
        declarations.iter().filter_map(|declaration| Some((declaration.name?, declaration))).collect();
    let mut text = String::new();
    let mut before: Option<&Item> = None;
    for item in items {
        // A name that is a keyword of the language ends with an underscore.
        let declaration = by_name.get(item.name.as_str()).or_else(|| by_name.get(item.name.trim_end_matches('_')));
        let comment = declaration.map_or(&[][..], |declaration| declaration.comment());
        let is_short = |item: &Item| matches!(item.kind, Kind::Other | Kind::Variable | Kind::Alias);
        if !(before.is_some_and(is_short) && is_short(item) && comment.is_empty()) {
            text.push('\n');
        }
        text.extend(comment.iter().flat_map(|line| [line, "\n"]));
        text.push_str(&match (item.kind, declaration) {
            (Kind::Struct, Some(declaration)) => with_members_comments(&item.text, declaration),
            _ => item.text.clone(),
        });
        text.push('\n');
        before = Some(item);
    }
    text
}

/// Returns the text of a struct with the comments of its members.
fn with_members_comments(text: &str, declaration: &Declaration<'_>) -> String {
    let (mut comments, mut above): (HashMap<&str, Vec<String>>, Vec<String>) = (HashMap::new(), Vec::new());
    for line in &declaration.lines {
        let (code, comment) = line.split_once("//").map_or((*line, None), |(code, comment)| (code, Some(comment)));
        if !line.starts_with("//") {
            above.extend(comment.map(|comment| format!("//{comment}")));
        }
        if let Some((member, _)) = code.split_once(':') {
            // Attributes such as `@location(0)` stand before the name.
            let member = words(member).last().unwrap_or_default();
            comments.insert(member, std::mem::take(&mut above));
        }
    }
    // A name that is a keyword of the language ends with an underscore.
    let of_member = |member: &str| comments.get(member).or_else(|| comments.get(member.trim_end_matches('_')));
    let mut lines = Vec::new();
    for line in text.lines() {
        // What a member means to the pipeline stands behind a colon.
        let before = line.split(" : ").next().unwrap_or_default().split([';', '[']).next().unwrap_or_default();
        let indent = &line[..line.len() - line.trim_start().len()];
        if !indent.is_empty()
            && let Some(found) = words(before).last().and_then(of_member)
        {
            lines.extend(found.iter().map(|comment| format!("{indent}{comment}")));
        }
        lines.push(line.to_owned());
    }
    lines.join("\n")
}

/// Returns what the writer makes of a source without entry points.
fn translated(source: &str, language: Language) -> Result<String, String> {
    // GLSL's writer follows an entry point.
    let stage = match language {
        Language::Glsl => "@compute @workgroup_size(1)",
        _ => "@fragment",
    };
    let entry = "translated_from_wgsl";
    let whole = match language.glsl_version() {
        Some(_) => format!("{source}\n{stage} fn {entry}() {{}}\n"),
        None => source.to_owned(),
    };
    let (module, _) = lapidary_specialise::parse(&whole, "the text").map_err(|error| error.to_string())?;
    let (module, info) = with_defaults(&module)?;
    let of_stage = if language == Language::Glsl { ShaderStage::Compute } else { ShaderStage::Fragment };
    let entry = language.glsl_version().map(|_| (entry.to_owned(), of_stage));
    let setting = Setting::strict(entry, glsl::WriterFlags::INCLUDE_UNUSED_ITEMS);
    written(&module, &info, language, &setting).map(|(text, _)| text)
}

/// Whether an item belongs to a text that is pasted into another.
fn is_kept(item: &Item, language: Language) -> bool {
    match item.kind {
        Kind::Other => {
            language == Language::Msl || (language == Language::GlslEs && item.text.starts_with("precision "))
        }
        Kind::Function => item.name != "main",
        Kind::Struct | Kind::Alias | Kind::Variable => true,
    }
}

/// Returns the error for the first function that alone cannot be translated.
pub(crate) fn culprit(source: &str, language: Language, why: String) -> TranslateError {
    let lines: Vec<&str> = source.lines().collect();
    let found =
        declarations::declarations(&lines).into_iter().filter_map(|declaration| declaration.name).find_map(|name| {
            let alone = of_functions(source, &[name])?;
            translated(&alone, language).err().map(|why| (name.to_owned(), why))
        });
    let (what, why) = found.unwrap_or_else(|| ("the text".to_owned(), why));
    TranslateError::Lacks { language: language.title(), what, why }
}

/// Returns the comment that says what language this is, and how it is pasted.
fn note(name: &str, language: Language) -> String {
    let how = match language {
        Language::Glsl => "Paste it below `#version 450`.",
        Language::GlslEs => "Paste it below `#version 300 es`.",
        Language::Hlsl | Language::Msl => "Paste or #include it.",
    };
    format!(
        "//\n// {language}, translated from the WGSL of {name} by naga. {how}\n// The accuracy is that of the WGSL: a compiler that reorders or fuses floats may lose it.\n"
    )
}

/// Returns the comment with the names that end with an underscore here and not in the source.
pub(crate) fn other_names(items: &[Item], source: &str) -> String {
    let known: HashSet<&str> = source.lines().flat_map(words).collect();
    let of_item = |item: &Item| -> Vec<String> {
        let found = words(&item.text).filter(|word| word.ends_with('_') && known.contains(word.trim_end_matches('_')));
        found.map(str::to_owned).collect()
    };
    let names: BTreeSet<String> = items.iter().flat_map(of_item).collect();
    if names.is_empty() {
        return String::new();
    }
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    format!("// With an underscore here, as words of the language or for a digit at the end: {}.\n", names.join(", "))
}
