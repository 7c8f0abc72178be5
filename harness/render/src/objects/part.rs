//! The objects of a scene, grouped by technique and by the variant of its recipe that their
//! materials call for.

use crate::settings::Settings;
use lapidary_plan::Decisions;
use lapidary_plan::Rung;
use lapidary_scene::{Bounds, Light, Object, Scene};
use std::collections::{HashMap, HashSet};

/// An object and the decisions on how to draw it.
pub(crate) struct Drawn<'a> {
    pub(crate) object: &'a Object,
    /// The object's name, with `#2` and so on if objects before it have the same name.
    pub(crate) name: String,
    pub(crate) decisions: Decisions,
}

/// The objects of a scene that are drawn by one rung.
pub(crate) struct Part<'a> {
    pub(crate) rung: Rung,
    pub(crate) lights: &'a [Light],
    pub(crate) settings: &'a Settings,
    pub(crate) objects: Vec<Drawn<'a>>,
}

impl<'a> Part<'a> {
    /// Returns the parts of a scene, in the order of their first objects.
    pub(crate) fn all(scene: &'a Scene, settings: &'a Settings) -> Vec<Self> {
        // An object without triangles has nothing to draw, and buffers must not be empty.
        let objects = scene.objects.iter().zip(names(scene)).zip(Decisions::all(scene, &settings.request()));
        let shown = objects.filter(|((object, _), _)| !object.mesh.indices.is_empty());
        let drawn = shown.map(|((object, name), decisions)| Drawn { object, name, decisions });
        let part = |(rung, objects)| Part { rung, lights: &scene.lights, settings, objects };
        grouped(drawn.collect(), |drawn| drawn.decisions.rung).into_iter().map(part).collect()
    }

    /// Returns the smallest box around the objects.
    pub(crate) fn bounds(&self) -> Bounds {
        Bounds::of(self.objects.iter().flat_map(|drawn| drawn.object.mesh.positions.iter().copied()))
    }

    /// Returns the objects, grouped by the values that their variant of the recipe is compiled
    /// with.
    pub(crate) fn variants<K: PartialEq>(&self, key: impl Fn(&Drawn<'a>) -> K) -> Vec<(K, Vec<&Drawn<'a>>)> {
        grouped(self.objects.iter().collect(), |drawn| key(drawn))
    }
}

/// Returns a unique name for each object.
pub(crate) fn names(scene: &Scene) -> Vec<String> {
    let mut taken: HashSet<String> = scene.objects.iter().map(|object| object.name.clone()).collect();
    // The last number given to each name so far.
    let mut given: HashMap<&str, u32> = HashMap::new();
    let mut names = Vec::with_capacity(scene.objects.len());
    for object in &scene.objects {
        let number = given.entry(&object.name).or_default();
        *number += 1;
        let mut name = object.name.clone();
        while *number > 1 {
            name = format!("{}#{number}", object.name);
            if taken.insert(name.clone()) {
                break;
            }
            *number += 1;
        }
        names.push(name);
    }
    names
}

/// Groups items by key, in the order of the first item of each key.
fn grouped<T, K: PartialEq>(all: Vec<T>, key: impl Fn(&T) -> K) -> Vec<(K, Vec<T>)> {
    let mut groups: Vec<(K, Vec<T>)> = Vec::new();
    for one in all {
        let key = key(&one);
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, members)) => members.push(one),
            None => groups.push((key, vec![one])),
        }
    }
    groups
}
