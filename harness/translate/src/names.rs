//! Names that a writer made, replaced by names like those of the text's author.

use crate::items::{Item, Kind, Token, tokens};
use std::collections::{HashMap, HashSet};

/// Returns the names that stand for something in a text.
fn used(text: &str) -> HashSet<&str> {
    tokens(text).into_iter().filter_map(|token| if let Token::Name(name) = token { Some(name) } else { None }).collect()
}

/// Returns the names that a text declares as arguments or variables: a name after a type, before a value, the
/// next argument or the end.
fn declared(text: &str) -> HashSet<&str> {
    let tokens: Vec<Token<'_>> = tokens(text).into_iter().filter(|token| !token.text().trim().is_empty()).collect();
    let is_type = |token: Token<'_>| {
        let text = token.text();
        text == "&" || text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    let names = (1..tokens.len().saturating_sub(1)).filter_map(|index| match (tokens[index - 1], tokens[index]) {
        (before, Token::Name(name)) if is_type(before) && before.text() != "return" => {
            [";", "=", ",", ")", "["].contains(&tokens[index + 1].text()).then_some(name)
        }
        _ => None,
    });
    names.collect()
}

/// Returns what stands before the underscore and the number that a writer adds; `None` if there is no number.
fn without_number(name: &str) -> Option<&str> {
    let (base, number) = name.rsplit_once('_')?;
    (!number.is_empty() && number.chars().all(|c| c.is_ascii_digit())).then_some(base)
}

/// Gives a writer's names of bindings and variables back the shader's own, in `(writer's, own)`. What a function
/// calls so itself gets another name where both meet.
pub fn rename_globals(items: &mut [Item], renames: &[(String, String)]) {
    for item in items.iter_mut() {
        let text = item.text.clone();
        let names = used(&text);
        let mut here = HashMap::new();
        for (from, to) in renames.iter().filter(|(from, _)| names.contains(from.as_str())) {
            here.insert(from.clone(), to.clone());
            if names.contains(to.as_str()) {
                here.insert(to.clone(), format!("{to}_here"));
            }
        }
        item.text = renamed(&item.text, &here);
        if let Some(name) = here.get(&item.name) {
            item.name.clone_from(name);
        }
    }
}

/// Returns a text with its names replaced by those of `renamed`.
pub fn renamed(text: &str, renamed: &HashMap<String, String>) -> String {
    let replace = |token: Token<'_>| match token {
        Token::Name(name) => renamed.get(name).map_or(name, String::as_str).to_owned(),
        Token::Other(text) => text.to_owned(),
    };
    tokens(text).into_iter().map(replace).collect()
}

/// Gives bindings and variables their names in `known` back, where a writer has added a number because a
/// function has something of that name. That, where it meets them, gets another.
pub fn restore_globals(items: &mut [Item], known: &HashSet<&str>) {
    let mut numbered = Vec::new();
    for item in items.iter().filter(|item| item.kind == Kind::Variable && !known.contains(item.name.as_str())) {
        if let Some(base) = without_number(&item.name).filter(|base| known.contains(base)) {
            numbered.push((item.name.clone(), base.to_owned()));
        }
    }
    rename_globals(items, &numbered);
}

/// Takes off the numbers by which a writer tells apart what has one name in two functions, where
/// within the function one name is left.
///
/// A writer never declares anything by a keyword of its language, so that a name that is declared bare
/// somewhere can stand in any function.
pub fn take_numbers_off(items: &mut [Item]) {
    let bare: HashSet<String> = items.iter().flat_map(|item| declared(&item.text)).map(str::to_owned).collect();
    let globals: HashSet<String> = items.iter().map(|item| item.name.clone()).collect();
    for item in items.iter_mut().filter(|item| item.kind == Kind::Function) {
        let text = item.text.clone();
        let names: HashSet<&str> = used(&text);
        let mut wanted: HashMap<&str, Vec<&str>> = HashMap::new();
        for name in &names {
            let Some(base) = without_number(name) else { continue };
            let is_own = globals.contains(base) || globals.contains(*name);
            if bare.contains(base) && !names.contains(base) && !is_own {
                wanted.entry(base).or_default().push(name);
            }
        }
        // Of several, all keep their numbers but the first, so that none is mixed up.
        fn first(candidates: Vec<&str>) -> Option<&str> {
            candidates.into_iter().min_by_key(|name| (name.len(), (*name).to_owned()))
        }
        let renames: HashMap<String, String> =
            wanted.into_iter().filter_map(|(base, alike)| Some((first(alike)?.to_owned(), base.to_owned()))).collect();
        item.text = renamed(&item.text, &renames);
    }
}

/// Gives what a writer has added the prefixes of the text's own names, so that two translated texts
/// do not clash: `functions` for functions and variables, `types` for types.
///
/// `known` are the names that the text declares itself.
pub fn prefix_helpers(items: &mut [Item], known: &HashSet<&str>, functions: &str, types: &str) {
    let mut taken: HashSet<String> = items.iter().map(|item| item.name.clone()).collect();
    let mut renames = HashMap::new();
    for item in items.iter().filter(|item| !item.name.is_empty() && !known.contains(item.name.as_str())) {
        let is_type = matches!(item.kind, Kind::Struct | Kind::Alias);
        let array = array_of(&item.text);
        let name = array.as_deref().unwrap_or(&item.name);
        let name = name.strip_prefix("naga_").unwrap_or(name).trim_matches('_');
        let name = name.strip_prefix("Naga").unwrap_or(name);
        let mut new = match (is_type, name.strip_prefix("Construct")) {
            (true, _) => format!("{types}{}", camel(name)),
            (false, Some(made)) => format!("{functions}make_{}", snake(made.strip_prefix(types).unwrap_or(made))),
            (false, None) => format!("{functions}{}", snake(name)),
        };
        new = new.trim_end_matches('_').to_owned();
        // Overloads keep one name: the item's own is not taken by another.
        if renames.contains_key(&item.name) {
            continue;
        }
        while taken.contains(&new) {
            new.push_str("_helper");
        }
        taken.insert(new.clone());
        renames.insert(item.name.clone(), new);
    }
    for item in items {
        item.text = renamed(&item.text, &renames);
        if let Some(new) = renames.get(&item.name) {
            item.name.clone_from(new);
        }
    }
}

/// Returns the name of a struct that only wraps an array: its element and its length, not the number of a type.
fn array_of(text: &str) -> Option<String> {
    let (_, inside) = text.strip_prefix("struct type_")?.split_once('{')?;
    let (element, length) = inside.trim().split_once(" inner[")?;
    Some(format!("{}_array{}", element.rsplit("::").next()?, length.split(']').next()?))
}

/// Returns a name of words with underscores as one of words with capitals.
pub fn camel(name: &str) -> String {
    let word =
        |word: &str| word.chars().next().map_or(String::new(), |c| c.to_uppercase().collect::<String>() + &word[1..]);
    name.split('_').map(word).collect()
}

fn snake(name: &str) -> String {
    let mut text = String::new();
    let mut before = '_';
    for character in name.chars() {
        if character.is_uppercase() && before.is_ascii_lowercase() {
            text.push('_');
        }
        // No two underscores: reserved in GLSL.
        if character != '_' || !text.ends_with('_') {
            text.extend(character.to_lowercase());
        }
        before = character;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::items::items;

    fn text(items: &[Item]) -> String {
        items.iter().map(|item| item.text.clone()).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn numbers_go_where_one_name_is_left() {
        let mut found = items(
            "float a(float x, float y) { return x + y; }\nfloat b(float x_1, float step_1) { float y_1 = x_1; float y_2 = step_1; return y_1 + y_2 + step(0.0, x_1); }",
        );
        take_numbers_off(&mut found);
        let expected = "float a(float x, float y) { return x + y; }\nfloat b(float x, float step_1) { float y = x; float y_2 = step_1; return y + y_2 + step(0.0, x); }";
        assert_eq!(text(&found), expected);
    }

    #[test]
    fn no_keyword_is_left_bare() {
        let text = "layout(location = 0) out vec4 color;\nfloat a(float out_, float vertex_) { return out_; }\nfloat b(float out_1, float vertex_1) { return out_1 * vertex_1; }";
        let mut found = items(text);
        take_numbers_off(&mut found);
        assert!(self::text(&found).ends_with("float b(float out_1, float vertex_1) { return out_1 * vertex_1; }"));
    }

    #[test]
    fn a_number_stays_where_a_global_has_the_name() {
        let text = "const float limit = 2.0;\nfloat a(float limit_1) { return min(limit_1, 1.0); }\nfloat b(float x) { float limit = x; return limit; }";
        let mut found = items(text);
        take_numbers_off(&mut found);
        assert_eq!(self::text(&found), text);
    }

    #[test]
    fn a_binding_has_its_name_back() {
        let mut found = items(
            "cbuffer view_1 : register(b0) { View view_1; }\nfloat a(float view) { return view; }\nfloat b() { float view = view_1.x; return view; }",
        );
        restore_globals(&mut found, &HashSet::from(["view", "View"]));
        let expected = "cbuffer view : register(b0) { View view; }\nfloat a(float view) { return view; }\nfloat b() { float view_here = view.x; return view_here; }";
        assert_eq!(text(&found), expected);
    }

    #[test]
    fn helpers_have_the_prefix_of_their_text() {
        let mut found = items(
            "struct type_5 { float inner[2]; };\nstruct OpticHit { float at; };\nOpticHit ConstructOpticHit(float at) { return at; }\nint naga_f2i32(float x) { return int(x); }\nint naga_f2i32(vec2 x) { return int(x.x); }\nOpticHit optic_hit(type_5 x) { return ConstructOpticHit(naga_f2i32(x.inner[0])); }",
        );
        prefix_helpers(&mut found, &HashSet::from(["OpticHit", "optic_hit"]), "optic_", "Optic");
        let expected = "struct OpticFloatArray2 { float inner[2]; };\nstruct OpticHit { float at; };\nOpticHit optic_make_hit(float at) { return at; }\nint optic_f2i32(float x) { return int(x); }\nint optic_f2i32(vec2 x) { return int(x.x); }\nOpticHit optic_hit(OpticFloatArray2 x) { return optic_make_hit(optic_f2i32(x.inner[0])); }";
        assert_eq!(text(&found), expected);
    }
}
