//! A scene as a command draws it, and the names of its bodies.

use super::Failure;
use lapidary_plan::Note;
use lapidary_scene::Scene;

/// A scene as it is drawn.
pub(super) struct Opened {
    pub(super) scene: Scene,
    /// What was changed and guessed.
    pub(super) notes: Vec<Note>,
    /// For each body the name in the file of the one that it comes from.
    pub(super) nodes: Vec<String>,
}

/// Refuses an option that is given twice for all objects or for one node.
pub(super) fn refuse_twice<'a>(option: &str, nodes: impl Iterator<Item = Option<&'a str>>) -> Result<(), Failure> {
    let mut seen = Vec::new();
    for node in nodes {
        if seen.contains(&node) {
            let what = node.map_or("all objects".to_owned(), |node| format!("`{node}`"));
            return Err(Failure(format!("{option} names {what} twice; leave one out, or name a node")));
        }
        seen.push(node);
    }
    Ok(())
}

/// Returns each name once, in the order of the first.
pub(super) fn distinct<'a>(names: impl Iterator<Item = &'a String>) -> Vec<&'a str> {
    let mut known: Vec<&str> = Vec::new();
    for name in names {
        if !known.contains(&name.as_str()) {
            known.push(name);
        }
    }
    known
}
