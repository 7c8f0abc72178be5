//! Placement of a node's mesh: once, or many times by `EXT_mesh_gpu_instancing`.

use ::gltf::json::Root;
use glam::{DMat3, DMat4, DQuat, Quat, Vec3};
use serde_json::{Map, Value};

use super::accessor::Elements;
use super::buffers::Buffers;
use super::error::{GltfError, excerpt};
use super::extension::Extension;
use super::kind::{Kind, ROTATIONS, VECTORS};
use super::nodes::{ShownNode, composed, has_no_direction};
use crate::copies::Place;

/// Name of the extension.
pub(crate) const NAME: &str = "EXT_mesh_gpu_instancing";
/// Attributes that place an instance.
pub(super) const PLACING: [&str; 3] = ["TRANSLATION", "ROTATION", "SCALE"];
/// Attributes of our own that colour an instance: a factor of the base colour, and an attenuation
/// colour in place of the material's.
pub(crate) const COLORING: [&str; 2] = ["_LAPIDARY_BASE_COLOR", "_LAPIDARY_ATTENUATION_COLOR"];

/// Places at which a node shows its mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instances<'a> {
    /// Transform from the node's space to world space.
    world: DMat4,
    /// Transforms from an instance's space to the node's; `None` if the node shows its mesh once.
    list: Option<List<'a>>,
}

/// Attributes of the instances; each has `count` elements or is missing.
#[derive(Debug, Clone, Copy)]
struct List<'a> {
    count: usize,
    translations: Option<Elements<'a>>,
    rotations: Option<Elements<'a>>,
    scales: Option<Elements<'a>>,
    base_colors: Option<Elements<'a>>,
    attenuation_colors: Option<Elements<'a>>,
}

impl<'a> Instances<'a> {
    /// Returns the instances of `node`, with all numbers checked to be finite. Allocates no memory,
    /// however many there are.
    pub(super) fn of(root: &Root, buffers: &'a Buffers<'_>, node: &ShownNode<'_>) -> Result<Self, GltfError> {
        let wrong = |problem: String| GltfError::part(node.designation(), problem);
        let Some(attributes) = attributes(node).map_err(wrong)? else {
            return Ok(Self { world: node.world, list: None });
        };
        let user = format!("{}, {NAME}", node.designation());
        let elements = |name: &str, kind: Kind| -> Result<Option<Elements<'a>>, GltfError> {
            let Some(value) = attributes.get(name) else { return Ok(None) };
            let index = value.as_u64().and_then(|index| usize::try_from(index).ok()).ok_or_else(|| {
                let found = excerpt(&value.to_string());
                wrong(format!("its {NAME} attribute {name} is {found}, but must be the number of an accessor"))
            })?;
            Elements::of(root, buffers, index, kind, &user).map(Some)
        };
        let [translations, rotations, scales] =
            [elements("TRANSLATION", VECTORS)?, elements("ROTATION", ROTATIONS)?, elements("SCALE", VECTORS)?];
        let [base_colors, attenuation_colors] = COLORING.map(|name| elements(name, VECTORS));
        let (base_colors, attenuation_colors) = (base_colors?, attenuation_colors?);
        let placing = [translations, rotations, scales];
        let mut counts = placing.into_iter().flatten().map(|elements| elements.count());
        let Some(count) = counts.next() else {
            let problem = format!(
                "its {NAME} has none of {}, so no number of instances; give one, or remove the extension",
                PLACING.join(", ")
            );
            return Err(wrong(problem));
        };
        let colored = [base_colors, attenuation_colors].into_iter().flatten().map(|elements| elements.count());
        if let Some(other) = counts.chain(colored).find(|other| *other != count) {
            let problem = format!("its {NAME} attributes have {count} and {other} elements; give each as many");
            return Err(wrong(problem));
        }
        let list = List { count, translations, rotations, scales, base_colors, attenuation_colors };
        if let Some(instance) = list.first_not_finite() {
            return Err(wrong(format!("instance {instance} of its {NAME} is not finite; mend or remove it")));
        }
        if let Some(instance) = rotations.and_then(|all| all.numbers().position(has_no_direction)) {
            return Err(wrong(format!(
                "instance {instance} of its {NAME} has the rotation 0, 0, 0, 0, which turns nothing; give a unit quaternion"
            )));
        }
        Ok(Self { world: node.world, list: Some(list) })
    }

    /// Number of places, at least one.
    pub(super) fn count(&self) -> usize {
        self.list.map_or(1, |list| list.count)
    }

    /// Whether the places come from the extension.
    pub(super) fn is_list(&self) -> bool {
        self.list.is_some()
    }

    /// Iterates over the transforms from the mesh's space to world space, one for each place.
    pub(super) fn transforms(&self) -> impl Iterator<Item = DMat4> + 'a {
        let Self { world, list } = *self;
        let mut translations = list.and_then(|list| list.translations).map(Elements::numbers);
        let mut rotations = list.and_then(|list| list.rotations).map(Elements::numbers);
        let mut scales = list.and_then(|list| list.scales).map(Elements::numbers);
        (0..self.count()).map(move |_| {
            let translation = translations.as_mut().and_then(Iterator::next);
            let rotation = rotations.as_mut().and_then(Iterator::next);
            world * composed(translation, rotation, scales.as_mut().and_then(Iterator::next))
        })
    }

    /// Returns the places, or `None` if the node shows its mesh once, or an instance is mirrored or
    /// scaled unevenly.
    ///
    /// # Errors
    /// The problem, if a colour is out of range.
    pub(super) fn places(&self) -> Result<Option<Vec<Place>>, String> {
        let Some(list) = self.list.filter(|list| list.count > 0) else { return Ok(None) };
        let places = match self.world == DMat4::IDENTITY {
            true => list.places_as_given(),
            false => self.transforms().map(Place::of_transform).collect(),
        };
        let Some(mut places): Option<Vec<Place>> = places else {
            let colored = list.base_colors.is_some() || list.attenuation_colors.is_some();
            let wrong = "its instances have colours, but one is mirrored or scaled unevenly; scale it alike along all \
                         axes, or leave the colours out";
            return if colored { Err(wrong.to_owned()) } else { Ok(None) };
        };
        let color = |name: &str, instance: usize, color: [f32; 3]| {
            let proper = color.iter().all(|part| (0.0..=1.0).contains(part));
            let [r, g, b] = color;
            let wrong = || format!("instance {instance} has the {name} ({r}, {g}, {b}); give parts from 0 to 1");
            proper.then_some(Vec3::from_array(color)).ok_or_else(wrong)
        };
        for (instance, base_color) in list.base_colors.iter().flat_map(|colors| colors.numbers()).enumerate() {
            places[instance].base_color = color(COLORING[0], instance, base_color)?;
        }
        for (instance, attenuation) in list.attenuation_colors.iter().flat_map(|all| all.numbers()).enumerate() {
            places[instance].attenuation_color = Some(color(COLORING[1], instance, attenuation)?);
        }
        Ok(Some(places))
    }

    /// Factor by which lengths of the mesh grow in world space: the cube root of the change in
    /// volume, and the largest over all instances.
    pub(super) fn enlargement(&self) -> f64 {
        let of_volumes = self.transforms().map(|transform| DMat3::from_mat4(transform).determinant().abs());
        of_volumes.fold(0.0, f64::max).cbrt()
    }
}

impl List<'_> {
    /// Returns the places with the very numbers of the file, or `None` if one is mirrored or scaled
    /// unevenly.
    fn places_as_given(&self) -> Option<Vec<Place>> {
        let mut places = vec![Place::IDENTITY; self.count];
        for (place, translation) in places.iter_mut().zip(self.translations.iter().flat_map(|all| all.numbers())) {
            place.translation = Vec3::from_array(translation);
        }
        for (place, rotation) in places.iter_mut().zip(self.rotations.iter().flat_map(|all| all.numbers())) {
            let exact = DQuat::from_array(rotation.map(f64::from));
            let length = exact.length();
            // The file's own numbers are as close to length 1 as f32 comes.
            let is_unit = (length - 1.0).abs() < 1e-6;
            place.rotation = if is_unit { Quat::from_array(rotation) } else { (exact / length).as_quat() };
        }
        for (place, [x, y, z]) in places.iter_mut().zip(self.scales.iter().flat_map(|all| all.numbers())) {
            if !(x > 0.0 && x == y && y == z) {
                return None;
            }
            place.scale = x;
        }
        Some(places)
    }

    fn first_not_finite(&self) -> Option<usize> {
        let of_vectors = |elements: Option<Elements<'_>>| {
            elements?.numbers::<3>().position(|vector| !vector.into_iter().all(f32::is_finite))
        };
        let of_rotations = self.rotations.and_then(|elements| {
            elements.numbers::<4>().position(|quaternion| !quaternion.into_iter().all(f32::is_finite))
        });
        let colors = [of_vectors(self.base_colors), of_vectors(self.attenuation_colors)];
        let places = [of_vectors(self.translations), of_rotations, of_vectors(self.scales)];
        places.into_iter().chain(colors).flatten().min()
    }
}

/// Attributes of a node's instances; `None` if it has no instances, or no mesh to show.
pub(super) fn attributes<'a>(node: &ShownNode<'a>) -> Result<Option<&'a Map<String, Value>>, String> {
    let all = node.node.extensions.as_ref().map(|all| &all.others);
    if node.node.mesh.is_none() || !all.is_some_and(|all| all.contains_key(NAME)) {
        return Ok(None);
    }
    let attributes = Extension::of(all, NAME)?.member("attributes").and_then(Value::as_object);
    attributes.map(Some).ok_or_else(|| format!("its {NAME} has no object `attributes`; export it again"))
}
