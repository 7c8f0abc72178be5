//! Visible nodes of a scene and their transforms.

use ::gltf::json::Root;
use ::gltf::json::scene::Node;
use glam::{DMat4, DQuat, DVec3};

use super::error::{GltfError, designation, excerpt, item};

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
    pub(super) nodes: Vec<ShownNode<'a>>,
}

impl<'a> Shown<'a> {
    /// Nodes of the default scene, else of the first scene, else all nodes, starting from those
    /// without a parent.
    pub(super) fn of(root: &'a Root) -> Result<Self, GltfError> {
        let number = root.scene.map_or(0, |scene| scene.value());
        let (name, roots) = if root.scene.is_none() && root.scenes.is_empty() {
            (String::new(), orphans(root))
        } else {
            let scene = item(&root.scenes, "scene", number, || "the file".to_owned())?;
            let name = scene.name.as_deref().map(excerpt).unwrap_or_default();
            (name, scene.nodes.iter().map(|node| node.value()).collect())
        };
        let nodes = walk(root, &roots, number)?;
        Ok(Self { name, nodes })
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
        let world = outer * local(node);
        waiting.extend(children(node).rev().map(|child| (child, Some(index), world)));
        shown.push(ShownNode { index, node, world });
    }
    Ok(shown)
}

/// The node's own transform: its matrix, or else translation · rotation · scale.
fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    composed(node.translation, node.rotation.map(|rotation| rotation.0), node.scale)
}

/// Translation · rotation (a quaternion, real part last) · scale; a missing factor is the identity.
pub(super) fn composed(translation: Option<[f32; 3]>, rotation: Option<[f32; 4]>, scale: Option<[f32; 3]>) -> DMat4 {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let scale = scale.map_or(DVec3::ONE, vector);
    let translation = translation.map_or(DVec3::ZERO, vector);
    let rotation = rotation.map_or(DQuat::IDENTITY, |rotation| {
        let quaternion = DQuat::from_array(rotation.map(f64::from));
        // The file's numbers are rounded, so the length is only close to 1. A zero quaternion is
        // taken as the identity, which is what exporters mean by four zeros.
        let length = quaternion.length();
        if length > 0.0 { quaternion / length } else { DQuat::IDENTITY }
    });
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
