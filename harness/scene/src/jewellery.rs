//! What unmarked bodies look like: exporters write a stone as white plastic, as a blend, or as a pane, and metals under any name.

use std::fmt;

use glam::Vec3;

use crate::material::Metal;
use crate::{Object, Preset, Scene};

mod color;
mod cut;
mod words;

use cut::Cut;
use words::Words;

/// Least metallicFactor of a metal.
const METALLIC: f32 = 0.5;

/// What a body looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// A clear stone, with the name of its preset.
    Stone(&'static str),
    /// A metal.
    Metal(Metal),
}

impl Look {
    /// Returns the preset that makes a body what it looks like; `None` if there is none of that name.
    #[must_use]
    pub fn preset(self) -> Option<&'static Preset> {
        Preset::named(match self {
            Self::Stone(name) => name,
            Self::Metal(metal) => metal.name(),
        })
    }
}

impl fmt::Display for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stone(name) => write!(f, "a stone, {name}"),
            Self::Metal(metal) => write!(f, "a metal, {}", metal.name()),
        }
    }
}

/// Bodies of one material that look alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// What they look like.
    pub look: Look,
    /// Numbers of the bodies.
    pub bodies: Vec<usize>,
    /// Name of the first body, and of the material.
    pub first: String,
    /// Name of the material.
    pub material: String,
    /// Why the first one looks so, as clauses.
    pub evidence: Vec<String>,
    /// Names for the option `--material`: the material, or the nodes if bodies of the material look different.
    pub named: Vec<String>,
}

impl Guess {
    /// Returns the options that make the bodies what they look like; empty if there is no preset for it.
    #[must_use]
    pub fn options(&self) -> String {
        let Some(preset) = self.look.preset() else { return String::new() };
        let option = |name: &String| format!("--material '{}={}'", name.replace('\'', r"'\''"), preset.name);
        self.named.iter().map(option).collect::<Vec<_>>().join(" ")
    }
}

impl fmt::Display for Guess {
    /// Writes a line: ``object `Gem`: looks like a stone, diamond (its name says `gem`, closed and convex, 73 facets)``.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.bodies.len() {
            1 => write!(f, "object `{}`", self.first)?,
            count => write!(f, "{count} objects, first `{}`", self.first)?,
        }
        write!(f, " of `{}`: looks like {} ({})", self.material, self.look, self.evidence.join(", "))
    }
}

/// Returns what the bodies of a scene look like that are marked as neither clear with an inside nor scattering, but for those
/// that are `given` a material. Bodies that look like nothing in particular are left out.
///
/// A stone has a name that says so and facets or a convex shape, or is a cut stone by its shape alone: closed, convex or nearly,
/// with flat facets of many directions. A metal is opaque, with a name that says so; what is marked as one, by a metallicFactor
/// of at least a half, is guessed only where it has no colour and the name says which it is.
#[must_use]
pub fn guesses(scene: &Scene, given: impl Fn(usize) -> bool) -> Vec<Guess> {
    let looks: Vec<Option<(Look, Vec<String>)>> = scene
        .objects
        .iter()
        .enumerate()
        .map(|(number, object)| if given(number) { None } else { look(object) })
        .collect();
    let mut found: Vec<Guess> = Vec::new();
    for (number, (object, look)) in scene.objects.iter().zip(&looks).enumerate() {
        let Some((look, evidence)) = look else { continue };
        let same = found.iter_mut().find(|guess| guess.look == *look && guess.material == object.material.name);
        match same {
            Some(guess) => guess.bodies.push(number),
            None => found.push(Guess {
                look: *look,
                bodies: vec![number],
                first: object.name.clone(),
                material: object.material.name.clone(),
                evidence: evidence.clone(),
                named: Vec::new(),
            }),
        }
    }
    for guess in &mut found {
        let of_material = scene.objects.iter().filter(|object| object.material.name == guess.material).count();
        // A node of the material's name would be meant instead.
        let is_node = scene.objects.iter().any(|object| object.name == guess.material);
        if of_material == guess.bodies.len() && !is_node {
            guess.named.push(guess.material.clone());
            continue;
        }
        for &body in &guess.bodies {
            let name = &scene.objects[body].name;
            if !guess.named.contains(name) {
                guess.named.push(name.clone());
            }
        }
    }
    found
}

/// Returns what a body looks like, and why.
fn look(object: &Object) -> Option<(Look, Vec<String>)> {
    let material = &object.material;
    if material.has_clear_inside() || material.scatters() || object.mesh.indices.is_empty() {
        return None;
    }
    let words = Words::of([&object.name, &material.name]);
    let says = |word: &str| format!("its name says `{word}`");
    let is_metallic = material.is_opaque() && material.metallic >= METALLIC;
    // What is named a metal is one, unless it is named a stone as well.
    let is_named_metal = words.metal.is_some() && words.stone.is_none();
    if !is_named_metal {
        let cut = Cut::of(object.shape());
        let by_name = words.stone.as_ref().filter(|_| cut.is_closed() && (cut.is_faceted() || cut.is_nearly_convex()));
        if by_name.is_some() || cut.is_stone() {
            let name = by_name.map(|(word, _)| says(word));
            let how = match () {
                () if material.is_clear() => Some("clear without a thickness".to_owned()),
                () if material.coverage.is_some() => Some("a blend".to_owned()),
                () => None,
            };
            let preset =
                words.stone.as_ref().and_then(|(_, preset)| *preset).unwrap_or_else(|| color::stone_of(object));
            return Some((Look::Stone(preset), name.into_iter().chain([cut.to_string()]).chain(how).collect()));
        }
    }
    let (word, metal) = words.metal?;
    // What a file marks as a metal is drawn as one. Its colour stays, unless it has none and its name says which.
    let is_colored = material.base_color != Vec3::ONE || material.base_color_texture.is_some();
    // A short word that means something else in other languages counts with the factor alone.
    let counts = if is_metallic { !is_colored && metal.is_some() } else { !words::is_ambiguous(&word) };
    if !material.is_opaque() || !counts {
        return None;
    }
    let factor = is_metallic.then(|| format!("metallicFactor {} and no colour", material.metallic));
    let metal = metal.unwrap_or_else(|| color::nearest_metal(material.base_color));
    Some((Look::Metal(metal), std::iter::once(says(&word)).chain(factor).collect()))
}

#[cfg(test)]
mod tests;
