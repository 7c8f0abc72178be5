//! `cook new`.

use lapidary_cook::command::{Failure, Outcome, output};
use lapidary_cookbook::repository;
use std::path::{Path, PathBuf};

/// Writes the files of a new technique, with functions to replace; they pass every test as they
/// are. Next steps: CONTRIBUTING.md.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook new thin_film")]
pub struct Arguments {
    /// Name of the technique: lower-case letters, digits and single underscores, such as
    /// `thin_film`.
    name: String,
    /// Folder of the cookbook, if it is not the one that this program was built from.
    #[arg(long = "in", value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// Paths and contents of the technique's files, with `NAME` in place of the name.
const FILES: [(&str, &str); 8] = [
    ("wgsl/NAME.wgsl", include_str!("new/module.wgsl")),
    ("wgsl/naive/NAME.wgsl", include_str!("new/naive.wgsl")),
    ("crates/NAME/Cargo.toml", include_str!("new/manifest.toml")),
    ("crates/NAME/src/lib.rs", include_str!("new/lib.rs.txt")),
    ("crates/NAME/src/oracle.rs", include_str!("new/oracle.rs.txt")),
    ("crates/NAME/src/formulas.rs", include_str!("new/formulas.rs.txt")),
    ("crates/NAME/tests/formulas.rs", include_str!("new/tests.rs.txt")),
    ("docs/NAME.md", include_str!("new/page.md")),
];

/// Manifests that need a line for cargo, and that line; the lines are sorted by name.
const MANIFESTS: [(&str, &str); 2] = [
    ("Cargo.toml", "lapidary-NAME = { path = \"crates/NAME\", version = \"0.2.0\" }"),
    ("harness/cook/Cargo.toml", "lapidary-NAME = { workspace = true, features = [\"formulas\"] }"),
];

/// The changelog, and the heading under which a new module is listed.
const CHANGELOG: (&str, &str) = ("CHANGELOG.md", "### New\n\n");

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let name = arguments.name.as_str();
    check_name(name).map_err(Failure)?;
    let root = match &arguments.folder {
        Some(folder) => folder.clone(),
        None => repository::required("new")?,
    };
    let changes = changes(&root, name).map_err(Failure)?;
    write(&changes).map_err(Failure)?;
    for Change { path, is_new, .. } in &changes {
        let path = path.strip_prefix(&root).unwrap_or(path).display();
        output::line(&format!("{} {path}", if *is_new { "new    " } else { "changed" }))?;
    }
    output::line(&format!("next: cargo test -p {}; then CONTRIBUTING.md, from \"The WGSL\" on", package(name)))?;
    Ok(Outcome::Passed)
}

/// A file to be written as a whole.
struct Change {
    path: PathBuf,
    text: String,
    /// Whether the file is created; otherwise an existing one is changed.
    is_new: bool,
}

/// Returns an error if the name cannot be that of a module.
fn check_name(name: &str) -> Result<(), String> {
    let fault =
        |what: &str| Err(format!("`{name}` {what}; choose a name of small letters, digits and single underscores"));
    if !name.starts_with(|first: char| first.is_ascii_lowercase()) {
        return fault("does not begin with a small letter");
    }
    if !name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_') {
        return fault("has other characters than a to z, 0 to 9 and _");
    }
    if name.contains("__") || name.ends_with('_') {
        return fault("has two underscores in a row, or one at its end, which naga_oil does not allow");
    }
    if lapidary_wgsl::RECIPES.iter().any(|recipe| recipe.name == name) {
        return Err(format!("`{name}` is a recipe; choose another name"));
    }
    Ok(())
}

/// Returns all changes to be written, without writing anything.
fn changes(root: &Path, name: &str) -> Result<Vec<Change>, String> {
    let named = |text: &str| text.replace("lapidary-NAME", &package(name)).replace("NAME", name);
    let mut changes = Vec::new();
    for (path, text) in FILES {
        let path = root.join(named(path));
        if path.exists() {
            return Err(format!("{}: is there already; choose another name, or delete it", path.display()));
        }
        changes.push(Change { path, text: named(text), is_new: true });
    }
    for (path, line) in MANIFESTS {
        let path = root.join(path);
        let manifest = read(&path)?;
        let package = package(name);
        if name == "cook" || manifest.lines().any(|line| line.split([' ', '.']).next() == Some(package.as_str())) {
            return Err(format!("`{name}`: there is a crate `{package}` already; choose another name"));
        }
        let text = with_line(&manifest, &named(line)).ok_or_else(|| {
            format!("{}: has no line of a module, `lapidary-…`; is {} the cookbook?", path.display(), root.display())
        })?;
        changes.push(Change { path, text, is_new: false });
    }
    let (path, heading) = (root.join(CHANGELOG.0), CHANGELOG.1);
    let text = read(&path)?;
    let Some((before, after)) = text.split_once(heading) else {
        return Err(format!("{}: has no heading `{}` to name the module below", path.display(), heading.trim()));
    };
    let text = format!("{before}{heading}- `{name}`: a new module.\n{after}");
    changes.push(Change { path, text, is_new: false });
    Ok(changes)
}

/// Returns the name of a module's package.
fn package(name: &str) -> String {
    format!("lapidary-{}", name.replace('_', "-"))
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: cannot be read: {error}", path.display()))
}

/// Returns the manifest with a dependency's line inserted among those of the modules, which are
/// sorted; `None` if there are none.
fn with_line(manifest: &str, line: &str) -> Option<String> {
    // Lines of the same form up to the name, and from the name on.
    let form =
        |line: &str| line.starts_with("lapidary-") && (line.contains("crates/") || line.contains("\"formulas\""));
    let lines: Vec<&str> = manifest.lines().collect();
    let first = lines.iter().position(|line| form(line))?;
    let last = lines.iter().rposition(|line| form(line))?;
    let place = (first..=last).find(|place| form(lines[*place]) && lines[*place] > line).unwrap_or(last + 1);
    let (before, after) = lines.split_at(place);
    Some([before, &[line], after].concat().join("\n") + "\n")
}

/// Writes all files, or none.
fn write(changes: &[Change]) -> Result<(), String> {
    // Everything is written to temporary files first; renaming them then needs no more space.
    let beside = |path: &Path| path.with_extension("cook-new");
    let made = |path: &Path, text: &str| {
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
        std::fs::write(beside(path), text)
    };
    let result = changes.iter().try_for_each(|Change { path, text, .. }| {
        made(path, text).map_err(|error| format!("{}: cannot be written: {error}", path.display()))
    });
    if result.is_err() {
        for Change { path, .. } in changes {
            // If removing these fails as well, the message already covers the cause; non-empty
            // folders stay.
            let _ = std::fs::remove_file(beside(path));
            let _ = path.parent().map(std::fs::remove_dir);
            let _ = path.parent().and_then(Path::parent).map(std::fs::remove_dir);
        }
        return result;
    }
    changes.iter().try_for_each(|Change { path, .. }| {
        std::fs::rename(beside(path), path).map_err(|error| format!("{}: cannot be written: {error}", path.display()))
    })
}
