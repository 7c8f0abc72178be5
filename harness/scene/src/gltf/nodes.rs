//! Which nodes a scene shows, and where.

use ::gltf::json::Root;
use ::gltf::json::scene::Node;
use glam::{DMat4, DQuat, DVec3};

use super::error::{GltfError, designation, excerpt, item};

/// A node and its place in the world.
#[derive(Debug)]
pub(super) struct ShownNode<'a> {
    pub(super) index: usize,
    pub(super) node: &'a Node,
    /// From the node's space to the world's. In f64, so that a deep hierarchy loses nothing; may hold
    /// infinities where scales multiply beyond it.
    pub(super) world: DMat4,
}

impl ShownNode<'_> {
    /// The node as messages call it.
    pub(super) fn designation(&self) -> String {
        designation("node", self.index, self.node.name.as_deref())
    }
}

/// The nodes of a file's scene, in the file's order, parents first.
#[derive(Debug)]
pub(super) struct Shown<'a> {
    /// The scene's name, or nothing.
    pub(super) name: String,
    pub(super) nodes: Vec<ShownNode<'a>>,
}

impl<'a> Shown<'a> {
    /// The nodes of the default scene, else of the first scene, else all nodes from those that are no
    /// one's child.
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
    // Last in, first out: reversed, so that the first comes first.
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

/// Translation · rotation (a quaternion, its real part last) · scale; one that is missing changes nothing.
pub(super) fn composed(translation: Option<[f32; 3]>, rotation: Option<[f32; 4]>, scale: Option<[f32; 3]>) -> DMat4 {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let scale = scale.map_or(DVec3::ONE, vector);
    let translation = translation.map_or(DVec3::ZERO, vector);
    let rotation = rotation.map_or(DQuat::IDENTITY, |rotation| {
        let quaternion = DQuat::from_array(rotation.map(f64::from));
        // Rounded in the file, so that its length is only nearly 1. One without direction
        // turns nothing, which is what exporters mean by four zeros.
        let length = quaternion.length();
        if length > 0.0 { quaternion / length } else { DQuat::IDENTITY }
    });
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
