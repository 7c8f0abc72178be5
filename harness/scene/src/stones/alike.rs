//! Which bodies look alike but for their shape.

use std::collections::HashMap;

use crate::Object;
use crate::material::Material;

/// Number of materials with the same factors, but other differences, up to which equal ones are found.
const MOST_COMPARED: usize = 256;

/// Materials that are equal in all but name, by number. In place of the name stands that of a body which is apart.
#[derive(Default)]
pub(super) struct Kinds {
    of_factors: HashMap<[u32; 12], Vec<(usize, Material)>>,
    count: usize,
}

impl Kinds {
    /// Returns the number of a body's material, and of its name if it is `apart`. Those with images are each of a kind of
    /// their own.
    pub(super) fn of(&mut self, object: &Object, apart: bool) -> usize {
        let name = if apart { object.name.clone() } else { String::new() };
        let material = Material { name, thickness: 1.0, ..object.material.clone() };
        let next = self.count;
        if material.textures().next().is_some() {
            self.count += 1;
            return next;
        }
        let alike = self.of_factors.entry(factors(&material)).or_default();
        if let Some((kind, _)) = alike.iter().take(MOST_COMPARED).find(|(_, other)| *other == material) {
            return *kind;
        }
        alike.push((next, material));
        self.count += 1;
        next
    }
}

fn factors(material: &Material) -> [u32; 12] {
    let Material { base_color, attenuation_color, .. } = material;
    let [r, g, b] = base_color.to_array();
    let [red, green, blue] = attenuation_color.to_array();
    [
        r,
        g,
        b,
        red,
        green,
        blue,
        material.attenuation_distance,
        material.ior,
        material.transmission,
        material.diffuse_transmission,
        material.roughness,
        material.normal_scale,
    ]
    .map(f32::to_bits)
}

/// Whether shape and material say all about how a body looks: it has neither colours of vertices nor images.
pub(super) fn is_told_by_shape(object: &Object) -> bool {
    object.mesh.colors.is_empty() && object.material.textures().next().is_none()
}
