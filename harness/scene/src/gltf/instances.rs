//! Placement of a node's mesh: once, or many times by `EXT_mesh_gpu_instancing`.

use ::gltf::json::Root;
use glam::{DMat3, DMat4};
use serde_json::{Map, Value};

use super::accessor::{Elements, Kind, ROTATIONS, VECTORS};
use super::buffers::Buffers;
use super::error::{GltfError, excerpt};
use super::extension::Extension;
use super::nodes::{ShownNode, composed};

/// Name of the extension.
pub(super) const NAME: &str = "EXT_mesh_gpu_instancing";
/// Attributes that place an instance.
pub(super) const PLACING: [&str; 3] = ["TRANSLATION", "ROTATION", "SCALE"];

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
        let mut counts = [translations, rotations, scales].into_iter().flatten().map(|elements| elements.count());
        let Some(count) = counts.next() else {
            let problem = format!(
                "its {NAME} has none of {}, so no number of instances; give one, or remove the extension",
                PLACING.join(", ")
            );
            return Err(wrong(problem));
        };
        if let Some(other) = counts.find(|other| *other != count) {
            let problem = format!("its {NAME} attributes have {count} and {other} elements; give each as many");
            return Err(wrong(problem));
        }
        let list = List { count, translations, rotations, scales };
        match list.first_not_finite() {
            Some(instance) => Err(wrong(format!("instance {instance} of its {NAME} is not finite; mend or remove it"))),
            None => Ok(Self { world: node.world, list: Some(list) }),
        }
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
        let mut translations = list.and_then(|list| list.translations).map(Elements::vectors);
        let mut rotations = list.and_then(|list| list.rotations).map(Elements::quaternions);
        let mut scales = list.and_then(|list| list.scales).map(Elements::vectors);
        (0..self.count()).map(move |_| {
            let translation = translations.as_mut().and_then(Iterator::next);
            let rotation = rotations.as_mut().and_then(Iterator::next);
            world * composed(translation, rotation, scales.as_mut().and_then(Iterator::next))
        })
    }

    /// Factor by which lengths of the mesh grow in world space: the cube root of the change in
    /// volume, and the largest over all instances.
    pub(super) fn enlargement(&self) -> f64 {
        let of_volumes = self.transforms().map(|transform| DMat3::from_mat4(transform).determinant().abs());
        of_volumes.fold(0.0, f64::max).cbrt()
    }
}

impl List<'_> {
    fn first_not_finite(&self) -> Option<usize> {
        let of_vectors = |elements: Option<Elements<'_>>| {
            elements?.vectors().position(|vector| !vector.into_iter().all(f32::is_finite))
        };
        let of_rotations = self.rotations.and_then(|elements| {
            elements.quaternions().position(|quaternion| !quaternion.into_iter().all(f32::is_finite))
        });
        [of_vectors(self.translations), of_rotations, of_vectors(self.scales)].into_iter().flatten().min()
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
