//! A body in a scene, shown once or as copies of one shape.

use std::collections::HashMap;

use glam::Vec3;

use crate::{Bounds, Copies, Material, Mesh, Place};

/// A body in a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name of the node, or of its mesh if the node has none.
    pub name: String,
    /// Surface in world space.
    pub mesh: Mesh,
    /// Material of the whole body.
    pub material: Material,
    /// The copies of one shape of which the body consists; `None` if it is shown once.
    pub copies: Option<Copies>,
}

/// Returns for each body its place in the order of those that share space, the one that is there last: by
/// [`Material::priority`], of equal ones by volume, the smaller last, and of equal volumes by number.
#[must_use]
pub fn precedence(objects: &[Object]) -> Vec<u32> {
    let volumes: Vec<f64> = objects.iter().map(|object| object.mesh.volume_and_area().0).collect();
    let mut bodies: Vec<usize> = (0..objects.len()).collect();
    bodies.sort_by(|&one, &other| {
        let by_priority = objects[one].material.priority.cmp(&objects[other].material.priority);
        by_priority.then(volumes[other].total_cmp(&volumes[one]))
    });
    let mut places = vec![0; objects.len()];
    for (place, body) in (0..).zip(bodies) {
        places[body] = place;
    }
    places
}

impl Object {
    /// Returns a body that is shown once.
    #[must_use]
    pub fn new(name: impl Into<String>, mesh: Mesh, material: Material) -> Self {
        Self { name: name.into(), mesh, material, copies: None }
    }

    /// Returns a body that shows `copies`.
    #[must_use]
    pub fn of_copies(name: impl Into<String>, copies: Copies, material: Material) -> Self {
        let mesh = copies.joined();
        Self { name: name.into(), mesh, material, copies: Some(copies) }
    }

    /// Returns the greatest extent of the body along an axis, or of its first copy, turned upright.
    #[must_use]
    pub fn extent(&self) -> f32 {
        let bounds = Bounds::of(self.shape().positions.iter().copied());
        let scale = self.copies.as_ref().and_then(|copies| copies.places.first()).map_or(1.0, |place| place.scale);
        scale * (bounds.max - bounds.min).max_element()
    }

    /// Returns the surface of one copy in its own space; the mesh of a body that is shown once.
    #[must_use]
    pub fn shape(&self) -> &Mesh {
        self.copies.as_ref().map_or(&self.mesh, |copies| &copies.shape)
    }

    /// Returns the materials of all copies, or the material of a body that is shown once.
    pub fn materials(&self) -> impl Iterator<Item = Material> + '_ {
        let places = self.copies.as_ref().map_or(&[Place::IDENTITY][..], |copies| &copies.places);
        places.iter().map(|place| place.material(&self.material))
    }

    /// Returns the copies of each colour as one body, in the order of their first copies.
    #[must_use]
    pub fn apart(&self) -> Vec<Self> {
        let Some(Copies { shape, places }) = &self.copies else { return vec![self.clone()] };
        let key = |place: &Place| {
            let bits = |color: Vec3| color.to_array().map(f32::to_bits);
            (bits(place.base_color), place.attenuation_color.map(bits))
        };
        let mut numbers = HashMap::new();
        let mut bodies: Vec<Self> = Vec::new();
        for place in places {
            let copy = shape.transformed(place.transform());
            let number = *numbers.entry(key(place)).or_insert(bodies.len());
            match bodies.get_mut(number) {
                Some(body) => body.mesh.append(&copy),
                None => bodies.push(Self::new(&*self.name, copy, place.material(&self.material))),
            }
        }
        bodies
    }
}

/// Returns all vertex positions of `objects`.
pub(crate) fn vertices(objects: &[Object]) -> impl Iterator<Item = Vec3> + Clone + '_ {
    let meshes = objects.iter().map(|object| &object.mesh);
    meshes.flat_map(|mesh| mesh.positions.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use glam::Quat;

    fn place() -> Place {
        let rotation = Quat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0);
        Place { rotation, scale: 2.5, translation: Vec3::new(1.0, -2.0, 3.0), ..Place::IDENTITY }
    }

    #[test]
    fn copies_apart_are_one_body_for_each_colour() {
        let stone = Scene::named("octahedron").expect("built in").objects.remove(0);
        let red = Place { attenuation_color: Some(Vec3::X), base_color: Vec3::splat(0.5), ..place() };
        let again = Place { translation: Vec3::splat(9.0), ..red };
        let copies = Copies { shape: stone.mesh.clone(), places: vec![Place::IDENTITY, red, again] };
        assert!(copies.is_coloured());
        let both = Object::of_copies("both", copies, stone.material.clone());
        let bodies = both.apart();
        assert_eq!((bodies.len(), &bodies[0].mesh), (2, &stone.mesh));
        let mut joined = stone.mesh.clone();
        joined.append(&bodies[1].mesh);
        assert_eq!(both.mesh, joined);
        assert_eq!(bodies[1].material, red.material(&stone.material));
        assert_eq!(bodies[1].material.attenuation_color, Vec3::X);
        let materials = [0, 1, 1].map(|body: usize| bodies[body].material.clone());
        assert_eq!(both.materials().collect::<Vec<_>>(), materials);
    }
}
