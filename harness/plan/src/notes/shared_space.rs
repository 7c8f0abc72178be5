//! Bodies that share space with clear ones.

use super::merge::add;
use crate::among::{self, Share};
use crate::note::MOST_AROUND;
use crate::{Decisions, Effect, Note, Objects, Rung};
use lapidary_scene::{Bounds, Object, Scene, precedence};

/// A body with its box.
struct Boxed<'a> {
    object: &'a Object,
    rung: Rung,
    /// Whether clear bodies that share its space are shown, and whether others are.
    nested: [bool; 2],
    bounds: Bounds,
    /// Its place among bodies that share space: [`precedence`].
    place: u32,
}

/// Says which bodies lie within clear ones whose rungs show nothing of them, and which share space with clear ones.
pub(super) fn notes(scene: &Scene, decisions: &[&Decisions]) -> Vec<Note> {
    if scene.objects.len() > among::MOST_COMPARED {
        let mut rungs = decisions.iter().map(|decisions| decisions.rung);
        let is_alone = rungs.any(|rung| matches!(rung, Rung::Inside { .. }) && !rung.is_among());
        return is_alone.then_some(Note::NotCompared { count: scene.objects.len() }).into_iter().collect();
    }
    let places = precedence(&scene.objects);
    let all = scene.objects.iter().zip(decisions).zip(places);
    let all = all.filter(|((object, _), _)| object.mesh.triangle_count() > 0);
    let bodies: Vec<Boxed<'_>> = all
        .map(|((object, decisions), place)| {
            let bounds = Bounds::of(object.mesh.positions.iter().copied());
            let shows = |effect| decisions.rung == Rung::Reference || decisions.has(effect);
            let nested = shows(Effect::Nested);
            let is_among = decisions.rung.is_among() || decisions.rung == Rung::Reference;
            let nested = [nested && is_among, nested && shows(Effect::Around)];
            Boxed { object, rung: decisions.rung, nested, bounds, place }
        })
        .collect();
    let mut notes = Vec::new();
    let clear = bodies.iter().enumerate().filter(|(_, body)| body.follows_light());
    for body in bodies.iter().filter(|body| body.follows_light() && body.rung.is_among()) {
        let is_around = |around: &&Boxed<'_>| {
            let other = !std::ptr::eq(around.object, body.object) && around.follows_light();
            other && among::meet(body.bounds, around.bounds) && body.share_within(around) == Share::All
        };
        let within = 1 + bodies.iter().filter(is_around).count();
        if within > MOST_AROUND {
            let objects = Objects { first: body.object.name.clone(), count: 1 };
            add(&mut notes, Note::TooDeep { objects, within, rung: body.rung });
        }
    }
    for (place, around) in clear {
        for (other, body) in
            bodies.iter().enumerate().filter(|(other, body)| *other != place && among::meet(body.bounds, around.bounds))
        {
            let objects = Objects { first: body.object.name.clone(), count: 1 };
            match body.share_within(around) {
                Share::Nothing => {}
                Share::All if around.share_within(body) != Share::All => {
                    let (around, rung, nested) = (around.object.name.clone(), around.rung, around.nested);
                    if !nested[usize::from(!body.object.material.is_clear())] {
                        add(&mut notes, Note::Within { objects, around, rung });
                    }
                }
                // Of two that follow light it is told once.
                _ if other < place && body.follows_light() && around.share_within(body) != Share::Nothing => {}
                _ => {
                    let there = if around.comes_before(body) { around } else { body };
                    let (with, there) = (around.object.name.clone(), there.object.name.clone());
                    let shown = around.nested[usize::from(!body.object.material.is_clear())];
                    add(&mut notes, Note::ShareSpace { objects, with, there, rung: around.rung, shown });
                }
            }
        }
    }
    notes
}

impl Boxed<'_> {
    /// Whether light is followed through the body.
    fn follows_light(&self) -> bool {
        self.object.material.is_clear() && matches!(self.rung, Rung::Inside { .. } | Rung::Reference)
    }

    /// Whether this body is there where both are: an opaque one is, and of clear ones as
    /// [`Material::priority`](lapidary_scene::Material::priority) has it.
    fn comes_before(&self, other: &Self) -> bool {
        let key = |body: &Self| (!body.object.material.is_clear(), body.place);
        key(self) > key(other)
    }

    fn share_within(&self, around: &Self) -> Share {
        among::share_within(self.object, around.object)
    }
}
