//! Features of a file that are not drawn: each is listed once, with its users.

use std::collections::BTreeMap;

use super::error::excerpt;

/// Maximum number of clauses in the list: a hostile file may use as many features as it has bytes.
const MOST: usize = 64;

/// Unsupported feature: its kind (`textures`), its description, what is drawn instead, and the kind
/// of its users (`material`).
type Wish = (&'static str, String, &'static str, &'static str);

/// Unsupported features, sorted.
#[derive(Debug, Default)]
pub(super) struct Lacking {
    /// Each feature with the indices and names of its users.
    wishes: BTreeMap<Wish, BTreeMap<usize, Option<String>>>,
}

/// A part of the file that uses a feature.
#[derive(Debug, Clone, Copy)]
pub(super) struct User<'a> {
    pub(super) kind: &'static str,
    pub(super) index: usize,
    pub(super) name: Option<&'a str>,
}

impl User<'_> {
    /// The file as a whole.
    pub(super) const FILE: User<'static> = User { kind: "file", index: 0, name: None };
}

impl Lacking {
    /// Records that `user` needs `what`, and what is drawn `instead`.
    pub(super) fn note(&mut self, kind: &'static str, what: String, instead: &'static str, user: User<'_>) {
        let users = self.wishes.entry((kind, what, instead, user.kind)).or_default();
        users.entry(user.index).or_insert_with(|| user.name.map(excerpt));
    }

    /// Whether any user needs `what` of this `kind`.
    pub(super) fn has(&self, kind: &str, what: &str) -> bool {
        self.wishes.keys().any(|wish| wish.0 == kind && wish.1 == what)
    }

    /// Returns one clause for each feature.
    pub(super) fn clauses(&self) -> Vec<String> {
        let mut clauses: Vec<String> = self
            .wishes
            .iter()
            .take(MOST)
            .map(|((kind, what, instead, user), users)| format!("{kind}: {what} of {} ({instead})", list(user, users)))
            .collect();
        if self.wishes.len() > MOST {
            clauses.push(format!("and {} more", self.wishes.len() - MOST));
        }
        clauses
    }
}

/// Formats ``material `table` ``, or ``3 materials, first `table` ``.
fn list(kind: &str, users: &BTreeMap<usize, Option<String>>) -> String {
    if kind == User::FILE.kind {
        return "the file".to_owned();
    }
    let first = users.iter().next();
    let name = first.map(|(index, name)| name.as_ref().map_or_else(|| index.to_string(), |name| format!("`{name}`")));
    let name = name.unwrap_or_default();
    match users.len() {
        1 => format!("{kind} {name}"),
        count => {
            let ending = if kind.ends_with("sh") { "es" } else { "s" };
            format!("{count} {kind}{ending}, first {name}")
        }
    }
}
