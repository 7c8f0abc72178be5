//! Registration: which meshes are one shape, turned, scaled alike in all directions, and moved.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use crate::{Copies, Mesh, Place};

mod alignment;
mod form;
mod noise;

use alignment::{Alignment, Budget, Reference};
use form::Form;
pub use noise::noise;

/// Comparisons of two shapes' distances up to which equal ones are looked for; the rest count as different.
const MOST_COMPARED: usize = 1 << 22;
/// Corners that are looked up, until which equal shapes are looked for.
const MOST_LOOKED_UP: usize = 1 << 26;

/// Meshes of one shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The shape, about the middle of its corners, and its places.
    pub copies: Copies,
    /// The number of each mesh, in the order of the places.
    pub members: Vec<usize>,
}

/// Returns the meshes that are one shape with others, as groups of at least two in the order of their first. `noise` gives for
/// each mesh the distance by which a corner may be off; see [`noise`](fn@noise). `is_smooth` says whether normals are
/// interpolated, which must then agree as well.
///
/// Corners are compared, and what they enclose; vertex colours and texture coordinates are not: a group has those of its first.
/// The shape is the mean of all, by the squares of their sizes over their noise, so that it has less noise than any.
#[must_use]
pub fn groups(meshes: &[&Mesh], noise: &[f64], is_smooth: &[bool]) -> Vec<Group> {
    let mut found: Vec<Found> = Vec::new();
    let mut of_count: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut left = MOST_COMPARED;
    let mut budget = Budget(MOST_LOOKED_UP);
    for (number, mesh) in meshes.iter().enumerate() {
        let (noise, is_smooth) = (noise.get(number).copied().unwrap_or(0.0), is_smooth.get(number) == Some(&true));
        let Some(form) = Form::of(mesh, noise, is_smooth) else { continue };
        let alike = of_count.entry(form.points.len()).or_default();
        let compared = alike.len().min(left);
        left -= compared;
        let candidates = alike[..compared].iter().copied();
        let joined =
            candidates.into_iter().find_map(|group| Some((group, found[group].reference.align(&form, &mut budget)?)));
        match joined {
            Some((group, alignment)) => found[group].add(number, &form, alignment),
            None => {
                alike.push(found.len());
                found.push(Found::of(number, form));
            }
        }
    }
    let groups = found.into_iter().filter(|found| found.members.len() > 1);
    groups.map(|found| found.group(meshes)).collect()
}

/// A group as it is found.
struct Found {
    reference: Reference,
    members: Vec<Member>,
    /// Weighted sum of the members' corners, in the first one's frame and unit, and of the weights.
    sums: Vec<DVec3>,
    weight: f64,
}

struct Member {
    number: usize,
    centre: DVec3,
    unit: f64,
    rotation: DQuat,
    /// Ratio of its size and the first one's, each in its own unit.
    scale: f64,
}

impl Found {
    fn of(number: usize, form: Form) -> Self {
        let weight = form.noise.powi(-2);
        let sums = form.points.iter().map(|point| weight * *point).collect();
        let first = Member { number, centre: form.centre, unit: form.unit, rotation: DQuat::IDENTITY, scale: 1.0 };
        Self { reference: Reference::of(form), members: vec![first], sums, weight }
    }

    fn add(&mut self, number: usize, form: &Form, Alignment { rotation, scale, partners }: Alignment) {
        let weight = form.noise.powi(-2);
        self.weight += weight;
        for (sum, partner) in self.sums.iter_mut().zip(partners) {
            *sum += weight / scale * (rotation.inverse() * form.points[partner]);
        }
        self.members.push(Member { number, centre: form.centre, unit: form.unit, rotation, scale });
    }

    fn group(self, meshes: &[&Mesh]) -> Group {
        let Self { reference, members, sums, weight } = self;
        let form = &reference.form;
        let mut shape = meshes[members[0].number].clone();
        for (position, &place) in shape.positions.iter_mut().zip(&form.place_of_vertex) {
            *position = (form.unit / weight * sums[place]).as_vec3();
        }
        let place = |member: &Member| Place {
            rotation: member.rotation.as_quat(),
            scale: (member.scale * member.unit / form.unit) as f32,
            translation: member.centre.as_vec3(),
            ..Place::IDENTITY
        };
        let places = members.iter().map(place).collect();
        Group { copies: Copies { shape, places }, members: members.iter().map(|member| member.number).collect() }
    }
}

#[cfg(test)]
mod tests;
