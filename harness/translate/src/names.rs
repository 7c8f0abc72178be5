//! Names that a writer made, replaced by names like those of the text's author.

use crate::items::{Item, Kind, Token, tokens};
use std::collections::{HashMap, HashSet};

/// Returns the names that stand for something in a text.
fn used(text: &str) -> HashSet<&str> {
    tokens(text).into_iter().filter_map(|token| if let Token::Name(name) = token { Some(name) } else { None }).collect()
}

/// Returns a text with its names replaced by those of `renamed`.
pub fn renamed(text: &str, renamed: &HashMap<String, String>) -> String {
    let replace = |token: Token<'_>| match token {
        Token::Name(name) => renamed.get(name).map_or(name, String::as_str).to_owned(),
        Token::Other(text) => text.to_owned(),
    };
    tokens(text).into_iter().map(replace).collect()
}

/// Gives bindings and variables their names in `own` back, where a writer has added a number because a
/// function has something of that name. That, where it meets them, gets another.
pub fn restore_globals(items: &mut [Item], own: &HashSet<&str>) {
    let mut numbered = Vec::new();
    for item in items.iter().filter(|item| item.kind == Kind::Variable && !own.contains(item.name.as_str())) {
        let Some((base, number)) = item.name.rsplit_once('_') else { continue };
        if own.contains(base) && number.chars().all(|c| c.is_ascii_digit()) {
            numbered.push((item.name.clone(), base.to_owned()));
        }
    }
    for item in items.iter_mut() {
        let text = item.text.clone();
        let names = used(&text);
        for (name, base) in numbered.iter().filter(|(name, _)| names.contains(name.as_str())) {
            let mut renames = HashMap::from([(name.clone(), base.clone())]);
            if names.contains(base.as_str()) {
                renames.insert(base.clone(), format!("{base}_here"));
            }
            item.text = renamed(&item.text, &renames);
            if item.name == *name {
                item.name.clone_from(base);
            }
        }
    }
}

/// Takes off the numbers by which a writer tells apart what has one name in two functions, where
/// within the function one name is left.
///
/// A writer never leaves a keyword of its language bare, so that a bare name that is no call's can
/// stand in any function.
pub fn take_numbers_off(items: &mut [Item]) {
    let bare: HashSet<String> = {
        let mut bare = HashSet::new();
        for item in items.iter() {
            let tokens = tokens(&item.text);
            for (at, token) in tokens.iter().enumerate() {
                let is_called = tokens.get(at + 1).is_some_and(|next| next.text() == "(");
                if let (Token::Name(name), false) = (token, is_called) {
                    bare.insert((*name).to_owned());
                }
            }
        }
        bare
    };
    let globals: HashSet<String> = items.iter().map(|item| item.name.clone()).collect();
    for item in items.iter_mut().filter(|item| item.kind == Kind::Function) {
        let text = item.text.clone();
        let names: HashSet<&str> = used(&text);
        let mut wanted: HashMap<&str, Vec<&str>> = HashMap::new();
        for name in &names {
            let Some((base, number)) = name.rsplit_once('_') else { continue };
            let is_number = !number.is_empty() && number.chars().all(|c| c.is_ascii_digit());
            let is_own = globals.contains(base) || globals.contains(*name);
            if is_number && bare.contains(base) && !names.contains(base) && !is_own {
                wanted.entry(base).or_default().push(name);
            }
        }
        // Of several, all keep their numbers but the first, so that none is mixed up.
        fn first(of: Vec<&str>) -> Option<&str> {
            of.into_iter().min_by_key(|name| (name.len(), (*name).to_owned()))
        }
        let renames: HashMap<String, String> =
            wanted.into_iter().filter_map(|(base, of)| Some((first(of)?.to_owned(), base.to_owned()))).collect();
        item.text = renamed(&item.text, &renames);
    }
}

/// Gives what a writer has added the prefixes of the text's own names, so that two translated texts
/// do not clash: `functions` for functions and variables, `types` for types.
///
/// `own` are the names that the text declares itself. Returns the new names with what they make.
pub fn prefix_helpers(items: &mut [Item], own: &HashSet<&str>, functions: &str, types: &str) {
    let mut taken: HashSet<String> = items.iter().map(|item| item.name.clone()).collect();
    let mut renames = HashMap::new();
    for item in items.iter().filter(|item| !item.name.is_empty() && !own.contains(item.name.as_str())) {
        let is_type = matches!(item.kind, Kind::Struct | Kind::Alias);
        let name = item.name.strip_prefix("naga_").unwrap_or(&item.name).trim_matches('_');
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

fn camel(name: &str) -> String {
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
        let expected = "struct OpticType5 { float inner[2]; };\nstruct OpticHit { float at; };\nOpticHit optic_make_hit(float at) { return at; }\nint optic_f2i32(float x) { return int(x); }\nint optic_f2i32(vec2 x) { return int(x.x); }\nOpticHit optic_hit(OpticType5 x) { return optic_make_hit(optic_f2i32(x.inner[0])); }";
        assert_eq!(text(&found), expected);
    }
}
