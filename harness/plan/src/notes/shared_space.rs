//! Bodies that share space with clear ones.

use super::merge::add;
use crate::{Decisions, Note, Objects, Rung};
use glam::Vec3;
use lapidary_scene::{Bounds, Object, Scene};

/// Number of vertices of a body of which it is asked whether they lie in the other.
const VERTICES: usize = 32;
/// Products of these vertices and the other's triangles for one pair: fewer vertices are asked for if there are more.
const MOST_PRODUCTS: usize = 1 << 22;
/// How far below its surface a body's vertex is looked at, as a share of the body's radius: a body that only touches another
/// one shares no space with it.
const BELOW: f32 = 1e-4;

/// A body with its box.
struct Boxed<'a> {
    object: &'a Object,
    rung: Rung,
    bounds: Bounds,
}

/// How much of a body lies within another one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Share {
    Nothing,
    Part,
    All,
}

/// Says which bodies lie within clear ones whose rungs show nothing of them, and which share space with clear ones.
pub(super) fn notes(scene: &Scene, decisions: &[&Decisions]) -> Vec<Note> {
    let all = scene.objects.iter().zip(decisions).filter(|(object, _)| object.mesh.triangle_count() > 0);
    let bodies: Vec<Boxed<'_>> = all
        .map(|(object, decisions)| {
            let bounds = Bounds::of(object.mesh.positions.iter().copied());
            Boxed { object, rung: decisions.rung, bounds }
        })
        .collect();
    let mut notes = Vec::new();
    let clear = bodies.iter().enumerate().filter(|(_, body)| body.follows_light());
    for (place, around) in clear {
        for (other, body) in bodies.iter().enumerate().filter(|(other, body)| *other != place && body.meets(around)) {
            let objects = Objects { first: body.object.name.clone(), count: 1 };
            match body.share_within(around) {
                Share::Nothing => {}
                Share::All if around.share_within(body) != Share::All => {
                    let (around, rung) = (around.object.name.clone(), around.rung);
                    if rung != Rung::Reference {
                        add(&mut notes, Note::Within { objects, around, rung });
                    }
                }
                // Of two that follow light it is told once.
                _ if other < place && body.follows_light() && around.share_within(body) != Share::Nothing => {}
                _ => {
                    let there = if around.comes_before(body) { around } else { body };
                    let (with, there) = (around.object.name.clone(), there.object.name.clone());
                    add(&mut notes, Note::ShareSpace { objects, with, there, rung: around.rung });
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

    fn meets(&self, other: &Self) -> bool {
        self.bounds.min.cmple(other.bounds.max).all() && other.bounds.min.cmple(self.bounds.max).all()
    }

    /// Whether this body is there where both are: an opaque one is, and of clear ones as
    /// [`Material::priority`](lapidary_scene::Material::priority) has it.
    fn comes_before(&self, other: &Self) -> bool {
        let key = |body: &Self| (!body.object.material.is_clear(), body.object.material.priority);
        let smaller = || self.object.mesh.volume_and_area().0 <= other.object.mesh.volume_and_area().0;
        key(self) > key(other) || key(self) == key(other) && smaller()
    }

    /// Returns how many of the body's vertices lie within another one.
    fn share_within(&self, around: &Self) -> Share {
        let mesh = &self.object.mesh;
        let asked = VERTICES.min(MOST_PRODUCTS / around.object.mesh.triangle_count().max(1)).max(1);
        let step = mesh.positions.len().div_ceil(asked).max(1);
        let below = BELOW * self.bounds.radius();
        let vertices =
            mesh.positions.iter().zip(mesh.normals.iter().chain(std::iter::repeat(&Vec3::ZERO))).step_by(step);
        let (mut within, mut count) = (0, 0);
        for (position, normal) in vertices {
            count += 1;
            within += usize::from(around.object.mesh.encloses(*position - below * *normal));
        }
        match within {
            0 => Share::Nothing,
            _ if within == count => Share::All,
            _ => Share::Part,
        }
    }
}
