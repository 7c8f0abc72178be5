//! Registration: which meshes are one shape, turned, scaled alike in all directions, and moved.

use std::collections::HashMap;

use glam::{DVec3, Quat};

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
/// Where corners are off by more than f32 rounds, the shape is the mean of all.
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
    members: Vec<(usize, DVec3, f64, Alignment)>,
    /// Sum of the members' corners, in the first one's frame and unit.
    sums: Vec<DVec3>,
}

impl Found {
    fn of(number: usize, form: Form) -> Self {
        let (centre, unit, sums) = (form.centre, form.unit, form.points.clone());
        let members = vec![(number, centre, unit, Alignment::identity(form.points.len()))];
        Self { reference: Reference::of(form), members, sums }
    }

    fn add(&mut self, number: usize, form: &Form, alignment: Alignment) {
        for (sum, &partner) in self.sums.iter_mut().zip(&alignment.partners) {
            *sum += alignment.rotation.inverse() * form.points[partner] / alignment.scale;
        }
        self.members.push((number, form.centre, form.unit, alignment));
    }

    fn group(self, meshes: &[&Mesh]) -> Group {
        let Self { reference, members, sums } = self;
        let form = &reference.form;
        let first = meshes[members[0].0];
        let mut shape = Mesh { uvs: Vec::new(), ..first.clone() };
        let count = members.len() as f64;
        let origin = form.centre.as_vec3().as_dvec3();
        for (position, &place) in shape.positions.iter_mut().zip(&form.place_of_vertex) {
            *position = if form.is_rounded {
                (form.unit * sums[place] / count).as_vec3()
            } else {
                (position.as_dvec3() - origin).as_vec3()
            };
        }
        shape.uvs.clone_from(&first.uvs);
        // The middle of the shape's corners, in its own space.
        let middle = if form.is_rounded { DVec3::ZERO } else { form.centre - origin };
        let place = |(_, centre, unit, alignment): &(usize, DVec3, f64, Alignment)| {
            let scale = alignment.scale * unit / form.unit;
            let rotation = alignment.rotation;
            let translation = *centre - scale * (rotation * middle);
            Place {
                rotation: if rotation == glam::DQuat::IDENTITY { Quat::IDENTITY } else { rotation.as_quat() },
                scale: scale as f32,
                translation: translation.as_vec3(),
                ..Place::IDENTITY
            }
        };
        let places = members.iter().map(place).collect();
        Group { copies: Copies { shape, places }, members: members.iter().map(|member| member.0).collect() }
    }
}

#[cfg(test)]
mod tests;
