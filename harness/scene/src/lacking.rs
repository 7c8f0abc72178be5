//! Features of a file that are not drawn: each is listed once, with its users.

use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of clauses in the list: a hostile file may use as many features as it has bytes.
const MOST: usize = 64;

/// A material of the file by its number; `None` for glTF's default one.
pub(crate) type Matter = Option<usize>;

/// Unsupported feature: its kind (`textures`), its description, what is drawn instead, and the kind
/// of its users (`material`).
type Wish = (&'static str, String, &'static str, &'static str);

/// Indices and names of a feature's users, with the material for which alone they need it.
type Users = BTreeMap<(usize, Option<Matter>), Option<String>>;

/// What a file asks for and is not drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lacking {
    /// Each feature with its users.
    wishes: BTreeMap<Wish, Users>,
    /// Material of each body.
    bodies: Vec<Matter>,
}

/// A part of the file that uses a feature.
#[derive(Debug, Clone)]
pub(crate) struct User {
    pub(crate) kind: &'static str,
    pub(crate) index: usize,
    /// Beginning of its name.
    pub(crate) name: Option<String>,
    /// The material for which alone it does.
    pub(crate) of: Option<Matter>,
}

impl User {
    /// The file as a whole.
    pub(crate) fn file() -> Self {
        Self { kind: FILE, index: 0, name: None, of: None }
    }

    /// Returns the same part as far as it uses a material.
    pub(crate) fn of(&self, material: Matter) -> Self {
        Self { of: Some(material), ..self.clone() }
    }
}

const FILE: &str = "file";

impl Lacking {
    /// Returns the list of a file whose bodies have these materials; nothing is lacking yet.
    pub(crate) fn in_bodies(bodies: Vec<Matter>) -> Self {
        Self { wishes: BTreeMap::new(), bodies }
    }

    /// Records that `user` needs `what`, and what is drawn `instead`.
    pub(crate) fn note(&mut self, kind: &'static str, what: String, instead: &'static str, user: &User) {
        let users = self.wishes.entry((kind, what, instead, user.kind)).or_default();
        users.entry((user.index, user.of)).or_insert_with(|| user.name.clone());
    }

    /// Whether any user needs `what` of this `kind`.
    pub(crate) fn has(&self, kind: &str, what: &str) -> bool {
        self.wishes.keys().any(|wish| wish.0 == kind && wish.1 == what)
    }

    /// Leaves out what only materials need that no body has any more, since those bodies, by their numbers in the file's scene,
    /// were given others.
    pub fn replace(&mut self, is_replaced: impl Fn(usize) -> bool) {
        let bodies = || self.bodies.iter().enumerate();
        let left: BTreeSet<Matter> =
            bodies().filter(|(body, _)| !is_replaced(*body)).map(|(_, material)| *material).collect();
        let gone: BTreeSet<Matter> = bodies().map(|(_, material)| *material).filter(|of| !left.contains(of)).collect();
        for users in self.wishes.values_mut() {
            users.retain(|(_, of), _| !of.is_some_and(|of| gone.contains(&of)));
        }
        self.wishes.retain(|_, users| !users.is_empty());
    }

    /// Returns one clause for each feature.
    #[must_use]
    pub fn clauses(&self) -> Vec<String> {
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
fn list(kind: &str, users: &Users) -> String {
    if kind == FILE {
        return "the file".to_owned();
    }
    let first = users.iter().next();
    let name =
        first.map(|((index, _), name)| name.as_ref().map_or_else(|| index.to_string(), |name| format!("`{name}`")));
    let name = name.unwrap_or_default();
    let numbers: BTreeSet<usize> = users.keys().map(|(index, _)| *index).collect();
    match numbers.len() {
        1 => format!("{kind} {name}"),
        count => {
            let ending = if kind.ends_with("sh") { "es" } else { "s" };
            format!("{count} {kind}{ending}, first {name}")
        }
    }
}
