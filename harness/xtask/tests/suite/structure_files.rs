//! Tests that no files of a crate need each other, neither two nor more in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The sources of a crate: path below its `src` folder, with `/` between folders, and text.
type Sources = BTreeMap<String, String>;

/// Which file of a crate needs which: one that names something, outside of tests, that the other
/// defines. A file that only declares or re-exports something does not need it.
///
/// Sources are read as tokens, not compiled, and so these arrows are missed:
/// - of names inside strings (`"{NAME}"`, `serde(with = "…")`), unless the name is imported;
/// - of fields and methods: they are found by the name of their type, wherever an `impl` stands;
/// - of a macro by its name alone, before or without an import;
/// - of a trait that is re-exported by a file which only calls its methods.
///
/// An arrow may be drawn in error if a local variable has the name of a re-exported function. A
/// name that several items share (under `cfg`, or a function and a type) stands for the first one.
/// A name that a path finds in a module, but that nothing defines there, is taken to come from a macro
/// that the module calls.
/// An import inside a function counts for its whole module. The first name of a path is searched
/// in its own module only, not among its generic parameters.
#[derive(Debug)]
struct FileGraph {
    /// The names for which the first file needs the second.
    arrows: BTreeMap<String, BTreeMap<String, BTreeSet<String>>>,
}

/// A module of a crate: a file, or an inline module in it.
#[derive(Debug, Default)]
struct Module {
    file: String,
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    /// Names of what it defines itself.
    items: BTreeSet<String>,
    /// The modules of the macros that `#[macro_export]` names here, at the root.
    macros: BTreeMap<String, usize>,
    /// Whether it calls a macro outside of functions, which may define further items.
    calls_macros: bool,
    /// The names that it imports, and their paths.
    imports: Vec<(String, Vec<String>)>,
    /// Paths of the modules of which it imports everything.
    globs: Vec<Vec<String>>,
    /// All paths in its code, and those of its private imports.
    mentions: Vec<Vec<String>>,
}

/// What a path leads to.
#[derive(Clone, Debug)]
enum Target {
    Module(usize),
    Item { module: usize, name: String },
}

impl FileGraph {
    /// Reads the files that the crates in a `src` folder are made of: the library and the program.
    fn of_folder(folder: &Path) -> Self {
        let mut sources = Sources::new();
        collect(folder, "", &mut sources);
        Self::of(&sources)
    }

    fn of(sources: &Sources) -> Self {
        let mut arrows: BTreeMap<String, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
        for root in ["lib.rs", "main.rs"].into_iter().filter(|root| sources.contains_key(*root)) {
            let mut modules = Modules::default();
            modules.read_file(sources, root, "", None);
            for (number, module) in modules.0.iter().enumerate() {
                for path in &module.mentions {
                    let found = modules.find(number, path, false, &mut BTreeSet::new());
                    let Some(Target::Item { module: owner, name }) = found else { continue };
                    let definition = &modules.0[owner].file;
                    if *definition != module.file {
                        let needed = arrows.entry(module.file.clone()).or_default();
                        needed.entry(definition.clone()).or_default().insert(name);
                    }
                }
            }
        }
        Self { arrows }
    }

    /// Returns the files that a file needs, also through others.
    fn reach<'graph>(&'graph self, file: &'graph str) -> BTreeSet<&'graph str> {
        let mut reached = BTreeSet::new();
        let mut open = vec![file];
        while let Some(file) = open.pop() {
            let needed = self.arrows.get(file).into_iter().flat_map(BTreeMap::keys);
            open.extend(needed.map(String::as_str).filter(|needed| reached.insert(*needed)));
        }
        reached
    }

    /// Returns the sets of files that all need each other: the strongly connected components of
    /// more than one file.
    fn circles(&self) -> Vec<BTreeSet<&str>> {
        let reach: BTreeMap<&str, BTreeSet<&str>> =
            self.arrows.keys().map(|file| (file.as_str(), self.reach(file))).collect();
        let mut circles = BTreeSet::new();
        for (file, reached) in reach.iter().filter(|(file, reached)| reached.contains(*file)) {
            let returns = |other: &&str| reach.get(other).is_some_and(|reached| reached.contains(file));
            circles.insert(reached.iter().copied().filter(returns).collect::<BTreeSet<&str>>());
        }
        circles.into_iter().collect()
    }

    /// Lists the arrows among the files of a circle, with their names.
    fn arrows_within(&self, circle: &BTreeSet<&str>) -> String {
        let mut text = String::new();
        for (file, needed) in self.arrows.iter().filter(|(file, _)| circle.contains(file.as_str())) {
            for (other, names) in needed.iter().filter(|(other, _)| circle.contains(other.as_str())) {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                writeln!(text, "  {file} needs {other}: {}", names.join(", ")).expect("strings take all text");
            }
        }
        text
    }
}

/// Reads the Rust files of a folder; `prefix` is the folder's path below `src`.
fn collect(folder: &Path, prefix: &str, sources: &mut Sources) {
    for entry in std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry").path();
        let name = format!("{prefix}{}", path.file_name().expect("a name").to_string_lossy());
        if path.is_dir() {
            collect(&path, &format!("{name}/"), sources);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            sources.insert(name, std::fs::read_to_string(&path).expect("a source"));
        }
    }
}

/// The modules of a crate, the root first.
#[derive(Debug, Default)]
struct Modules(Vec<Module>);

impl Modules {
    fn add(&mut self, file: &str, parent: Option<usize>) -> usize {
        self.0.push(Module { file: file.to_owned(), parent, ..Module::default() });
        self.0.len() - 1
    }

    /// Reads a file and those of its child modules, which lie in `folder`.
    fn read_file(&mut self, sources: &Sources, file: &str, folder: &str, parent: Option<usize>) -> usize {
        let module = self.add(file, parent);
        self.read_module(sources, &without_tests(&tokens(&sources[file])), folder, module);
        module
    }

    fn read_module(&mut self, sources: &Sources, tokens: &[&str], folder: &str, module: usize) {
        let (mut index, mut depth) = (0, 0_usize);
        while let Some(&token) = tokens.get(index) {
            let next = tokens.get(index + 1).copied().unwrap_or_default();
            let after = tokens.get(index + 2).copied().unwrap_or_default();
            match token {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth = depth.saturating_sub(1),
                "use" if next != "<" => {
                    let is_public = index > 0 && ["pub", ")"].contains(&tokens[index - 1]);
                    index = self.read_imports(tokens, index + 1, is_public, module);
                }
                "mod" if depth == 0 && after == "{" => {
                    let end = closing(tokens, index + 2);
                    let child = self.add(&self.0[module].file.clone(), Some(module));
                    self.0[module].children.insert(next.to_owned(), child);
                    self.read_module(sources, &tokens[index + 3..end], &format!("{folder}{next}/"), child);
                    index = end;
                }
                "mod" if depth == 0 => {
                    let subfolder = format!("{folder}{next}/");
                    let files = [format!("{folder}{next}.rs"), format!("{subfolder}mod.rs")];
                    if let Some(file) = files.iter().find(|file| sources.contains_key(*file)) {
                        let child = self.read_file(sources, file, &subfolder, Some(module));
                        self.0[module].children.insert(next.to_owned(), child);
                    }
                    index += 1;
                }
                "macro_rules" => {
                    self.0[module].items.insert(after.to_owned());
                    if tokens[..index].ends_with(&["[", "macro_export", "]"]) {
                        self.0[0].macros.insert(after.to_owned(), module);
                    }
                    index += 2;
                }
                "fn" | "struct" | "enum" | "union" | "trait" | "type" | "const" | "static" if is_word(next) => {
                    let is_name = !["fn", "unsafe", "async", "extern", "mut"].contains(&next);
                    if depth == 0 && is_name {
                        self.0[module].items.insert(next.to_owned());
                    }
                    // What is defined here is not named by its definition.
                    index += usize::from(is_name);
                }
                _ if is_word(token) => {
                    self.0[module].calls_macros |= depth == 0 && next == "!";
                    index = self.read_path(tokens, index, module);
                }
                _ => {}
            }
            index += 1;
        }
    }

    /// Reads the path that begins at a token, and returns where its last name is.
    fn read_path(&mut self, tokens: &[&str], start: usize, module: usize) -> usize {
        let mut last = start;
        let mut path = vec![tokens[start].to_owned()];
        while tokens.get(last + 1) == Some(&"::") && tokens.get(last + 2).is_some_and(|token| is_word(token)) {
            last += 2;
            path.push(tokens[last].to_owned());
        }
        let before = |steps: usize| start.checked_sub(steps).map_or("", |place| tokens[place]);
        // A field, a method, or the rest of a path whose beginning is in angle brackets.
        let is_continued = before(1) == "::" || before(1) == "." && before(2) != ".";
        // A variable, or a field with its value or type.
        let is_binding = path.len() == 1 && (before(1) == "let" || tokens.get(last + 1) == Some(&":"));
        if !is_continued && !is_binding {
            self.0[module].mentions.push(path);
        }
        last
    }

    /// Reads an import up to its semicolon, and returns where that is.
    fn read_imports(&mut self, tokens: &[&str], start: usize, is_public: bool, module: usize) -> usize {
        let end = start + tokens[start..].iter().position(|token| *token == ";").unwrap_or(tokens.len() - start);
        let module = &mut self.0[module];
        for mut path in leaves(&tokens[start..end]) {
            let alias = path.iter().position(|name| name == "as").map(|place| path.split_off(place).remove(1));
            if path.last().is_some_and(|name| name == "self") {
                path.pop();
            }
            let is_glob = path.last().is_some_and(|name| name == "*");
            if is_glob {
                path.pop();
                module.globs.push(path.clone());
            } else if let Some(name) = alias.or_else(|| path.last().cloned()) {
                module.imports.push((name, path.clone()));
            }
            if !is_public {
                module.mentions.push(path);
            }
        }
        end
    }

    /// Finds what a path in a module leads to, through re-exports; `None` if that is not in the
    /// crate. A qualifier, which stands before `::`, is a module rather than a function of the same
    /// name. `seen` holds the searches under way.
    fn find(
        &self,
        module: usize,
        path: &[String],
        is_qualifier: bool,
        seen: &mut BTreeSet<(usize, String, bool)>,
    ) -> Option<Target> {
        let (first, rest) = path.split_first()?;
        let mut target = match first.as_str() {
            "crate" => Target::Module(0),
            "self" => Target::Module(module),
            "super" => Target::Module(self.0[module].parent?),
            _ => self.find_name(module, first, is_qualifier || !rest.is_empty(), seen)?,
        };
        for (index, name) in rest.iter().enumerate() {
            // What follows an item is its own: a variant or an associated function.
            let Target::Module(within) = target else { break };
            target = match name.as_str() {
                "super" => Target::Module(self.0[within].parent?),
                _ => {
                    let found = self.find_name(within, name, is_qualifier || index + 1 < rest.len(), seen);
                    let Module { calls_macros, imports, globs, .. } = &self.0[within];
                    let is_imported = !globs.is_empty() || imports.iter().any(|(imported, _)| imported == name);
                    let of_macro = Target::Item { module: within, name: name.clone() };
                    found.or_else(|| (*calls_macros && !is_imported).then_some(of_macro))?
                }
            };
        }
        Some(target)
    }

    fn find_name(
        &self,
        number: usize,
        name: &str,
        is_qualifier: bool,
        seen: &mut BTreeSet<(usize, String, bool)>,
    ) -> Option<Target> {
        if !seen.insert((number, name.to_owned(), is_qualifier)) {
            return None;
        }
        let module = &self.0[number];
        let child = module.children.get(name).map(|child| Target::Module(*child));
        if is_qualifier && child.is_some() {
            return child;
        }
        if module.items.contains(name) {
            return Some(Target::Item { module: number, name: name.to_owned() });
        }
        if let Some(owner) = module.macros.get(name) {
            return Some(Target::Item { module: *owner, name: name.to_owned() });
        }
        let imports = module.imports.iter().filter(|(imported, _)| imported == name);
        for (_, path) in imports {
            let found = self.find(number, path, is_qualifier, seen);
            if found.is_some() {
                return found;
            }
        }
        child.or_else(|| {
            module.globs.iter().find_map(|path| match self.find(number, path, true, seen)? {
                Target::Module(other) => self.find_name(other, name, is_qualifier, seen),
                Target::Item { .. } => None,
            })
        })
    }
}

/// Returns the paths of an import, with `as` and the alias behind the path: one for each name in
/// its braces.
fn leaves(tokens: &[&str]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut path: Vec<String> = Vec::new();
    // The path before each open brace.
    let mut prefixes: Vec<Vec<String>> = Vec::new();
    for token in tokens.iter().chain(&[","]) {
        match *token {
            "{" => prefixes.push(path.clone()),
            "," | "}" => {
                let prefix = prefixes.last().cloned().unwrap_or_default();
                if path.len() > prefix.len() {
                    found.push(std::mem::take(&mut path));
                }
                if *token == "}" {
                    // Nothing follows the brace but a comma or another brace.
                    prefixes.pop();
                }
                path = prefixes.last().cloned().unwrap_or_default();
            }
            "::" => {}
            name => path.push(name.to_owned()),
        }
    }
    found
}

fn is_word(token: &str) -> bool {
    token.starts_with(|letter: char| letter.is_alphabetic() || letter == '_')
}

/// Returns where the bracket that opens at `open` closes.
fn closing(tokens: &[&str], open: usize) -> usize {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().skip(open) {
        match *token {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return index;
        }
    }
    tokens.len()
}

/// Leaves out the items under `#[cfg(test)]` and `#[cfg(all(test, …))]`.
fn without_tests<'source>(tokens: &[&'source str]) -> Vec<&'source str> {
    let mut kept = Vec::new();
    let mut index = 0;
    while let Some(&token) = tokens.get(index) {
        let rest = &tokens[index..];
        if rest.starts_with(&["#", "!", "[", "cfg", "(", "test", ")"]) {
            return Vec::new();
        }
        let is_test = rest.starts_with(&["#", "[", "cfg", "(", "test", ")"])
            || rest.starts_with(&["#", "[", "cfg", "(", "all", "(", "test", ","]);
        if is_test {
            index = item_end(tokens, index);
        } else {
            kept.push(token);
        }
        index += 1;
    }
    kept
}

/// Returns where an item ends that begins with an attribute: at a semicolon, or at the brace that
/// closes its body.
fn item_end(tokens: &[&str], start: usize) -> usize {
    let mut index = start;
    while tokens.get(index) == Some(&"#") {
        index = closing(tokens, index + 1) + 1;
    }
    let mut is_import = false;
    while let Some(&token) = tokens.get(index) {
        match token {
            "use" => is_import = true,
            ";" => return index,
            "{" | "(" | "[" => {
                index = closing(tokens, index);
                if token == "{" && !is_import {
                    return index;
                }
            }
            _ => {}
        }
        index += 1;
    }
    index
}

/// Splits a source into words, `::` and single signs, without comments, strings, characters,
/// numbers and lifetimes.
fn tokens(source: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = source;
    while let Some(letter) = rest.chars().next() {
        let raw = rest.strip_prefix(['b', 'c']).unwrap_or(rest).strip_prefix('r');
        let hashes = raw.map_or(0, |raw| raw.len() - raw.trim_start_matches('#').len());
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            block_comment(rest)
        } else if let Some(raw) = raw.filter(|raw| raw[hashes..].starts_with('"')) {
            let (start, end) = (rest.len() - raw.len() + hashes + 1, format!("\"{}", "#".repeat(hashes)));
            rest[start..].find(&end).map_or(rest.len(), |place| start + place + end.len())
        } else if letter == '"' {
            quoted(rest)
        } else if letter == '\'' {
            // A lifetime has no quote behind its first letter.
            let is_character = rest[1..].starts_with('\\') || rest.chars().nth(2) == Some('\'');
            if is_character { quoted(rest) } else { 1 + word(&rest[1..]) }
        } else if letter.is_ascii_digit() {
            word(rest)
        } else if rest.starts_with("r#") && is_word(&rest[2..]) {
            let length = 2 + word(&rest[2..]);
            found.push(&rest[2..length]);
            length
        } else {
            let length = match letter {
                _ if is_word(rest) => word(rest),
                ':' if rest.starts_with("::") => 2,
                _ => letter.len_utf8(),
            };
            if !letter.is_whitespace() {
                found.push(&rest[..length]);
            }
            length
        };
        rest = &rest[length..];
    }
    found
}

/// Returns the length of the word at the start of a text.
fn word(text: &str) -> usize {
    text.find(|letter: char| !letter.is_alphanumeric() && letter != '_').unwrap_or(text.len())
}

/// Returns the length of the string or character at the start of a text, with its quotes.
fn quoted(text: &str) -> usize {
    let quote = text.as_bytes()[0];
    let mut end = 1;
    while let Some(byte) = text.as_bytes().get(end) {
        match byte {
            b'\\' => end += 2,
            byte if *byte == quote => return end + 1,
            _ => end += 1,
        }
    }
    text.len()
}

/// Returns the length of the comment at the start of a text, with those inside it.
fn block_comment(text: &str) -> usize {
    let (mut end, mut depth) = (0, 0_usize);
    while end < text.len() {
        let pair = text.as_bytes().get(end..end + 2).unwrap_or_default();
        match pair {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                end += 1;
                continue;
            }
        }
        end += 2;
        if depth == 0 {
            return end;
        }
    }
    text.len()
}

/// Returns the `src` folders of the harness, of the modules and of the studies.
fn crates() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let entries = ["harness", "crates"].map(|folder| std::fs::read_dir(root.join(folder)).expect("a folder"));
    let folders = entries.into_iter().flatten().map(|entry| entry.expect("an entry").path());
    let mut sources: Vec<PathBuf> = folders
        .chain([root.join("studies")])
        .filter(|folder| folder.join("Cargo.toml").exists())
        .map(|folder| folder.join("src"))
        .collect();
    sources.sort();
    sources
}

#[test]
fn no_circles_among_files() {
    let mut found = String::new();
    let crates = crates();
    assert!(crates.len() > 30, "{crates:?}");
    for folder in &crates {
        let graph = FileGraph::of_folder(folder);
        for circle in graph.circles() {
            let files: Vec<&str> = circle.iter().copied().collect();
            let name = folder.parent().and_then(Path::file_name).expect("a name").to_string_lossy();
            writeln!(found, "{name}: {}\n{}", files.join(", "), graph.arrows_within(&circle)).expect("text");
        }
    }
    assert!(found.is_empty(), "these files need each other:\n{found}");
}

fn graph(files: &[(&str, &str)]) -> FileGraph {
    FileGraph::of(&files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect())
}

/// Returns the arrows of a crate as `from > to: names`.
fn arrows(files: &[(&str, &str)]) -> Vec<String> {
    let arrows = graph(files).arrows.into_iter().flat_map(|(file, needed)| {
        needed.into_iter().map(move |(other, names)| {
            let names: Vec<String> = names.into_iter().collect();
            format!("{file} > {other}: {}", names.join(", "))
        })
    });
    arrows.collect()
}

#[test]
fn imports_are_read_from_nested_braces() {
    let root = "mod a; mod b; mod c; mod d;";
    let a = "use crate::{b::{self, B}, c::{x::{C, D as E}, F}, G};\nuse super::d::*;\nfn f() -> H { b::f() }";
    let (b, c) = ("pub struct B; pub fn f() {}", "pub mod x { pub struct C; pub struct D; }\npub struct F;");
    assert_eq!(
        arrows(&[("lib.rs", root), ("a.rs", a), ("b.rs", b), ("c.rs", c), ("d.rs", "pub(crate) struct H;")]),
        ["a.rs > b.rs: B, f", "a.rs > c.rs: C, D, F", "a.rs > d.rs: H"]
    );
    let braces = leaves(&tokens("a::{b, c::{d, e::{f}}, g::{h as i}, self, j::*}, k"));
    let braces: Vec<String> = braces.iter().map(|path| path.join(".")).collect();
    assert_eq!(braces, ["a.b", "a.c.d", "a.c.e.f", "a.g.h.as.i", "a.self", "a.j.*", "k"]);
}

#[test]
fn parents_and_the_own_module_are_followed() {
    let files = [
        ("lib.rs", "mod a; pub mod z; struct Top;"),
        ("a/mod.rs", "pub mod b; struct Middle; fn f() { self::b::f(); }"),
        (
            "a/b.rs",
            "mod c { fn f() { super::super::super::z::f(); self::g(); } fn g() {} } pub fn f() { super::Middle; }",
        ),
        ("z.rs", "pub mod y; pub fn f() {}"),
        ("z/y.rs", "use super::super::Top;"),
    ];
    assert_eq!(
        arrows(&files),
        ["a/b.rs > a/mod.rs: Middle", "a/b.rs > z.rs: f", "a/mod.rs > a/b.rs: f", "z/y.rs > lib.rs: Top"]
    );
}

#[test]
fn re_exports_lead_to_the_definition() {
    let files = [
        ("lib.rs", "mod a; mod b; pub use a::inner::A as Renamed; pub use b::*;"),
        ("a/mod.rs", "pub mod inner; pub(crate) use inner::{A, inner};"),
        ("a/inner.rs", "use crate::B; pub struct A; pub fn inner() {}"),
        (
            "b.rs",
            "pub struct B; fn f(a: crate::Renamed) { crate::a::inner(); crate::Renamed::new(); super::a::inner::inner() }",
        ),
    ];
    // The files that re-export have no arrows.
    assert_eq!(arrows(&files), ["a/inner.rs > b.rs: B", "b.rs > a/inner.rs: A, inner"]);
    // One that re-exports a name and uses it has.
    assert_eq!(arrows(&[("lib.rs", "mod a; pub use a::A; fn f() -> A { A }"), ("a.rs", "pub struct A;")]).len(), 1);
    // Names from other crates lead nowhere, and re-exports in a circle end.
    assert!(
        arrows(&[("lib.rs", "mod a; pub use a::*; use std::fmt;"), ("a.rs", "pub use super::*; fn f() { x() }")])
            .is_empty()
    );
}

#[test]
fn macros_and_what_they_make_are_found() {
    let b = "#[macro_export]\nmacro_rules! m { ($a:ident) => { struct $a; } }\nm!(Made);";
    let a = "use crate::b::Made; use crate::Outer; crate::m!(Own);";
    let files = [("lib.rs", "mod a; mod b; use other::Outer;"), ("a.rs", a), ("b.rs", b)];
    assert_eq!(arrows(&files), ["a.rs > b.rs: Made, m"]);
}

#[test]
fn comments_strings_and_tests_name_nothing() {
    let b = r##"
//! crate::A
/* crate::A /* crate::A */ crate::A */
fn f<'a>(_: &'a str) { ("\" crate::A", r#"" crate::A"#, b"crate::A", '"', '\'', "crate::A"); }
#[cfg(test)]
use crate::{A, a::{B}};
#[cfg(all(test, unix))]
#[allow(dead_code)]
fn g(_: [crate::A; 2]) { crate::A; }
#[cfg(test)]
mod tests { use crate::A; fn f() {} }
#[cfg(test)]
mod outside;
fn last(pair: (u8, crate::Last)) { pair.A; let A = 1; X { A: 1 } }
use crate::A as _;
"##;
    let files = [("lib.rs", "mod b; struct A; struct Last;"), ("b.rs", b), ("b/outside.rs", "use crate::A;")];
    assert_eq!(arrows(&files), ["b.rs > lib.rs: A, Last"]);
    assert_eq!(tokens("r#type::x1 0x1f 'a' '\\u{1}' 'static 1.0e5"), ["type", "::", "x1", "."]);
}

#[test]
fn circles_are_found_whole() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c; mod d; mod e; mod f; fn top() { f::f() }"),
        ("a.rs", "use crate::b::B; pub struct A;"),
        ("b.rs", "use crate::c::C; pub struct B;"),
        ("c.rs", "use crate::{a::A, d::D}; pub struct C;"),
        ("d.rs", "pub struct D;"),
        ("e.rs", "mod child; use child::Child; pub struct E(Child);"),
        ("e/child.rs", "use super::E; pub struct Child;"),
        ("f.rs", "mod child; pub use child::f;"),
        ("f/child.rs", "pub fn f() { g() } fn g() { f() }"),
    ];
    let graph = graph(&files);
    let circles: Vec<Vec<&str>> = graph.circles().into_iter().map(|circle| circle.into_iter().collect()).collect();
    assert_eq!(circles, [vec!["a.rs", "b.rs", "c.rs"], vec!["e.rs", "e/child.rs"]]);
    let text = graph.arrows_within(&BTreeSet::from(["e.rs", "e/child.rs"]));
    assert_eq!(text, "  e.rs needs e/child.rs: Child\n  e/child.rs needs e.rs: E\n");
}
