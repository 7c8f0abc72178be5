//! Visible nodes of a scene and their transforms.

use ::gltf::json::Root;
use ::gltf::json::scene::Node;
use glam::{DMat4, DQuat, DVec3};

use super::error::{GltfError, designation, excerpt, item};
use super::extras;
use crate::BuiltInEnvironment;

/// A node with its world transform.
#[derive(Debug)]
pub(super) struct ShownNode<'a> {
    pub(super) index: usize,
    pub(super) node: &'a Node,
    /// Transform from the node's space to world space. In f64, so that a deep hierarchy loses no
    /// precision; may contain infinities if the product of the scales overflows.
    pub(super) world: DMat4,
}

impl ShownNode<'_> {
    /// The node's designation in messages.
    pub(super) fn designation(&self) -> String {
        designation("node", self.index, self.node.name.as_deref())
    }
}

/// Nodes of a file's scene, in the file's order, parents first.
#[derive(Debug)]
pub(super) struct Shown<'a> {
    /// Name of the scene; empty if it has none.
    pub(super) name: String,
    pub(super) environment: BuiltInEnvironment,
    pub(super) nodes: Vec<ShownNode<'a>>,
}

impl<'a> Shown<'a> {
    /// Nodes of the default scene, else of the first scene, else all nodes, starting from those
    /// without a parent.
    pub(super) fn of(root: &'a Root) -> Result<Self, GltfError> {
        let number = root.scene.map_or(0, |scene| scene.value());
        let (name, environment, roots) = if root.scene.is_none() && root.scenes.is_empty() {
            (String::new(), BuiltInEnvironment::default(), orphans(root))
        } else {
            let scene = item(&root.scenes, "scene", number, || "the file".to_owned())?;
            let name = scene.name.as_deref().map(excerpt).unwrap_or_default();
            let environment = extras::environment(scene.extras.as_deref())
                .map_err(|problem| GltfError::part(designation("scene", number, scene.name.as_deref()), problem))?;
            (name, environment, scene.nodes.iter().map(|node| node.value()).collect())
        };
        let nodes = walk(root, &roots, number)?;
        Ok(Self { name, environment, nodes })
    }
}

fn orphans(root: &Root) -> Vec<usize> {
    let mut has_parent = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(children) {
        if let Some(flag) = has_parent.get_mut(child) {
            *flag = true;
        }
    }
    (0..has_parent.len()).filter(|&node| !has_parent[node]).collect()
}

fn children(node: &Node) -> impl DoubleEndedIterator<Item = usize> {
    let children = node.children.as_deref().unwrap_or_default();
    children.iter().map(|child| child.value())
}

/// Visits each node once, without recursion, so that neither cycles nor depth do harm.
fn walk<'a>(root: &'a Root, roots: &[usize], scene: usize) -> Result<Vec<ShownNode<'a>>, GltfError> {
    let mut visited = vec![false; root.nodes.len()];
    let mut shown = Vec::new();
    // A stack, so reversed: the first node comes first.
    let mut waiting: Vec<_> = roots.iter().rev().map(|&k| (k, None, DMat4::IDENTITY)).collect();
    while let Some((index, parent, outer)) = waiting.pop() {
        let node = item(&root.nodes, "node", index, || {
            parent.map_or(format!("scene {scene}"), |parent| format!("node {parent}"))
        })?;
        if std::mem::replace(&mut visited[index], true) {
            return Err(GltfError::part(
                designation("node", index, node.name.as_deref()),
                "it is reached twice, but nodes must form a tree; remove the cycle or second parent",
            ));
        }
        let local = local(node)
            .map_err(|problem| GltfError::part(designation("node", index, node.name.as_deref()), problem))?;
        let world = outer * local;
        waiting.extend(children(node).rev().map(|child| (child, Some(index), world)));
        shown.push(ShownNode { index, node, world });
    }
    Ok(shown)
}

/// The node's own transform: its matrix, or else translation · rotation · scale.
fn local(node: &Node) -> Result<DMat4, String> {
    let rotation = node.rotation.map(|rotation| rotation.0);
    let Some(matrix) = node.matrix else {
        if rotation.is_some_and(has_no_direction) {
            return Err("its rotation is 0, 0, 0, 0, which turns nothing; give a unit quaternion, or none".to_owned());
        }
        return Ok(composed(node.translation, rotation, node.scale));
    };
    let others = [
        ("translation", node.translation.is_some()),
        ("rotation", rotation.is_some()),
        ("scale", node.scale.is_some()),
    ];
    if let Some((other, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
        return Err(format!("it has a matrix and a {other}, which exclude each other; remove one"));
    }
    let last = [matrix[3], matrix[7], matrix[11], matrix[15]];
    // Programs that multiply matrices leave their rounding there. Written so that NaN fails.
    let is_affine = last.iter().zip([0.0, 0.0, 0.0, 1.0]).all(|(part, right)| (part - right).abs() <= f32::EPSILON);
    if !is_affine {
        return Err(format!(
            "its matrix has the last row {last:?}, but must have 0, 0, 0, 1; a node has no perspective"
        ));
    }
    let mut matrix = DMat4::from_cols_array(&matrix.map(f64::from));
    for (column, right) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
        matrix.col_mut(column).w = right;
    }
    Ok(matrix)
}

/// Whether a quaternion is no rotation: it has no length.
pub(super) fn has_no_direction(rotation: [f32; 4]) -> bool {
    rotation == [0.0; 4]
}

/// Translation · rotation (a quaternion, real part last) · scale; a missing factor is the identity.
pub(super) fn composed(translation: Option<[f32; 3]>, rotation: Option<[f32; 4]>, scale: Option<[f32; 3]>) -> DMat4 {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let scale = scale.map_or(DVec3::ONE, vector);
    let translation = translation.map_or(DVec3::ZERO, vector);
    let rotation = rotation.map_or(DQuat::IDENTITY, |rotation| {
        // The file's numbers are rounded, so the length is only close to 1.
        let quaternion = DQuat::from_array(rotation.map(f64::from));
        quaternion / quaternion.length()
    });
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
