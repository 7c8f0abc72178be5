//! Conversion of a mesh's primitives to objects in world space.

use std::collections::HashMap;

use ::gltf::Semantic;
use ::gltf::json::Root;
use ::gltf::json::mesh::Primitive;
use ::gltf::json::validation::Checked;
use glam::{DMat3, DMat4, Vec2, Vec3};

use super::accessor::Elements;
use super::arrangement::{Arrangement, assemble};
use super::budget::Budget;
use super::buffers::Buffers;
use super::draco;
use super::error::{GltfError, designation, excerpt, item};
use super::instances::Instances;
use super::kind::{COLORS, INDICES, Kind, NORMALS, POSITIONS, TEXTURE_COORDINATES};
use super::limits::MAX_COORDINATE;
use super::material::Materials;
use super::nodes::ShownNode;
use crate::copies::{Copies, MOST_JOINED};
use crate::lacking::Matter;
use crate::normals::{Averaging, Cofactors, shared_normals};
use crate::{Mesh, Object};

/// Adds an object for each material of the triangle primitives that `node` shows: exporters part one body's triangles over
/// several. All instances of a primitive form one mesh, or several if one would be too large for a device. Each object comes with
/// its material's number.
pub(super) fn add_objects(
    root: &Root,
    buffers: &Buffers<'_>,
    node: &ShownNode<'_>,
    materials: &mut Materials<'_>,
    budget: &mut Budget,
    objects: &mut Vec<(Matter, Object)>,
) -> Result<(), GltfError> {
    let Some(mesh_index) = node.node.mesh.map(|mesh| mesh.value()) else {
        return Ok(());
    };
    let mesh = item(&root.meshes, "mesh", mesh_index, || node.designation())?;
    let given = |name: &'_ Option<String>| name.clone().filter(|name| !name.is_empty());
    let name = given(&node.node.name).or_else(|| given(&mesh.name));
    let name = name.map_or_else(|| format!("mesh {mesh_index}"), |name| excerpt(&name));
    let instances = Instances::of(root, buffers, node)?;
    let enlargement = instances.enlargement();
    // Each with the number of its first primitive, and its material's.
    let mut found: Vec<(usize, Matter, Object)> = Vec::new();
    // The last of each material, with texture coordinates or without.
    let mut of_kind = HashMap::new();
    for (index, primitive) in mesh.primitives.iter().enumerate() {
        let Some(arrangement) = Arrangement::of(primitive.mode) else {
            budget.pass_over()?;
            continue;
        };
        let user = format!("{}, primitive {index}", designation("mesh", mesh_index, mesh.name.as_deref()));
        let mut reader = Reader { root, buffers, primitive, user: &user, budget };
        let meshes_in_world = reader.meshes(arrangement, &instances)?;
        let material_index = primitive.material.map(|material| material.value());
        let has_coordinates = meshes_in_world.iter().all(|(mesh, _)| !mesh.uvs.is_empty());
        let mut material = materials.get(material_index, has_coordinates, &user)?;
        // glTF states the thickness in the mesh's space, unlike its other lengths. A solid that is scaled to nothing is no thin
        // wall.
        if material.thickness > 0.0 {
            let thickness = (f64::from(material.thickness) * enlargement) as f32;
            material.thickness = thickness.clamp(f32::MIN_POSITIVE, f32::MAX);
        }
        let diamond = materials.diamond(material_index);
        for (mesh, copies) in meshes_in_world {
            let mut material = material.clone();
            if let Some(diamond) = diamond {
                diamond.absorb(&mut material, copies.as_ref().map_or(&mesh, |copies| &copies.shape));
            }
            let object = Object { name: name.clone(), mesh, material, copies };
            let kind = (material_index, object.mesh.uvs.is_empty());
            let other = of_kind.get(&kind).map(|place: &usize| &mut found[*place]);
            match other.filter(|(first, _, other)| *first != index && are_one(other, &object)) {
                Some((_, _, other)) => other.mesh.append(&object.mesh),
                None => {
                    of_kind.insert(kind, found.len());
                    found.push((index, material_index, object));
                }
            }
        }
    }
    let are_parts = found.iter().any(|(index, ..)| Some(index) != found.first().map(|(first, ..)| first));
    objects.extend(found.into_iter().map(|(index, material, object)| {
        let name = if are_parts { format!("{name} / {index}") } else { object.name };
        (material, Object { name, ..object })
    }));
    Ok(())
}

/// Whether two primitives of a mesh and of one material are one body: they are shown once, and together not too large.
fn are_one(one: &Object, other: &Object) -> bool {
    let size = |mesh: &Mesh| mesh.positions.len().max(mesh.indices.len());
    let fits = size(&one.mesh) + size(&other.mesh) <= MOST_JOINED;
    fits && one.copies.is_none() && other.copies.is_none()
}

struct Reader<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    primitive: &'a Primitive,
    /// The primitive's designation in messages.
    user: &'a str,
    budget: &'a mut Budget,
}

impl<'a> Reader<'a> {
    /// Returns the mesh in world space, or the meshes of so many instances each, with their places.
    fn meshes(
        &mut self,
        arrangement: Arrangement,
        instances: &Instances<'_>,
    ) -> Result<Vec<(Mesh, Option<Copies>)>, GltfError> {
        let wrong = |problem: String| GltfError::part(self.user.to_owned(), problem);
        let extensions = self.primitive.extensions.as_ref().map(|all| &all.others);
        let compressed = match draco::Reference::of(extensions).map_err(wrong)? {
            Some(reference) => Some((reference, self.buffers.decoded(self.root, reference.view, self.user)?)),
            None => None,
        };
        let attribute = |semantic: Semantic, kind: Kind| self.attribute(&semantic, kind, compressed);
        // A compressed primitive is a list, whatever it was.
        let arrangement = if compressed.is_some() { Arrangement::List } else { arrangement };
        let positions = attribute(Semantic::Positions, POSITIONS)?
            .ok_or_else(|| wrong("it has no POSITION; export it again".to_owned()))?;
        let normals = attribute(Semantic::Normals, NORMALS)?;
        let uvs = attribute(Semantic::TexCoords(0), TEXTURE_COORDINATES)?;
        let colors = attribute(Semantic::Colors(0), COLORS)?;
        let indices = match (compressed, self.primitive.indices) {
            (Some((_, decoded)), _) => Some(Elements::of_corners(&decoded.corners)),
            (None, Some(index)) => Some(self.elements(index.value(), INDICES)?),
            (None, None) => None,
        };
        let vertices = positions.count();
        for (what, elements) in [("normals", normals), ("texture coordinates", uvs), ("colours", colors)] {
            if elements.is_some_and(|elements| elements.count() != vertices) {
                let problem = format!("it has not as many {what} as positions; export it again");
                return Err(GltfError::part(self.user.to_owned(), problem));
            }
        }
        let corners = indices.map_or(vertices, |indices| indices.count());
        let triangles = arrangement.triangles(corners);
        let uv_bytes = if uvs.is_some() { size_of::<Vec2>() } else { 0 };
        // No overflow: each factor is at most the length of a buffer, 2³⁰.
        let times = instances.count() as u64;
        let joined = (MOST_JOINED / vertices.max(3 * triangles).max(1)).max(1);
        let objects = times.div_ceil(joined as u64);
        let color_bytes = if colors.is_some() { size_of::<Vec3>() } else { 0 };
        let vertex_bytes = 2 * size_of::<Vec3>() + uv_bytes + color_bytes;
        self.budget.take(objects, times * vertices as u64, vertex_bytes, times * triangles as u64)?;

        let corners = match indices {
            Some(indices) => self.in_range(indices, vertices)?,
            // The budget bounds the vertices below 2²⁶.
            None => (0..vertices as u32).collect(),
        };
        let uvs = uvs.map(|uvs| self.texture_coordinates(uvs)).transpose()?.unwrap_or_default();
        let colors = colors.map(|colors| self.colors(colors)).transpose()?.unwrap_or_default();
        let mesh = |transform: DMat4, instance: Option<usize>| -> Result<Mesh, GltfError> {
            let positions = self.positions(positions, transform, instance)?;
            let linear = DMat3::from_mat4(transform);
            let mirrored = linear.determinant() < 0.0;
            let indices = assemble(&corners, arrangement, mirrored);
            let normals = match normals {
                Some(normals) => given_or_shared(normals.numbers(), Cofactors::of(linear), &positions, &indices),
                None => shared_normals(&positions, &indices, Averaging::Angle),
            };
            Ok(Mesh { positions, normals, uvs: uvs.clone(), colors: colors.clone(), indices, halo: Vec::new() })
        };
        let mut all: Vec<Mesh> = Vec::new();
        for (instance, transform) in instances.transforms().enumerate() {
            let mesh = mesh(transform, instances.is_list().then_some(instance))?;
            match all.last_mut().filter(|_| instance % joined != 0) {
                Some(last) => last.append(&mesh),
                None => all.push(mesh),
            }
        }
        let Some(places) = instances.places().map_err(|problem| GltfError::part(self.user.to_owned(), problem))? else {
            return Ok(all.into_iter().map(|mesh| (mesh, None)).collect());
        };
        let shape = mesh(DMat4::IDENTITY, None)?;
        let copies = places.chunks(joined).map(|places| Copies { shape: shape.clone(), places: places.to_vec() });
        Ok(all.into_iter().zip(copies.map(Some)).collect())
    }

    /// Returns an attribute; what a compressed primitive does not hold stands beside it.
    fn attribute(
        &self,
        semantic: &Semantic,
        kind: Kind,
        compressed: Option<(draco::Reference<'_>, &'a draco::Decoded)>,
    ) -> Result<Option<Elements<'a>>, GltfError> {
        let Some(index) = self.primitive.attributes.get(&Checked::Valid(semantic.clone())) else { return Ok(None) };
        let held =
            compressed.map(|(reference, decoded)| reference.attribute(&semantic.to_string(), decoded)).transpose();
        let held = held.map_err(|problem| GltfError::part(self.user.to_owned(), problem))?.flatten();
        match held {
            Some(held) => Elements::of_unpacked(self.root, held, index.value(), kind, self.user).map(Some),
            None => self.elements(index.value(), kind).map(Some),
        }
    }

    fn elements(&self, index: usize, kind: Kind) -> Result<Elements<'a>, GltfError> {
        Elements::of(self.root, self.buffers, index, kind, self.user)
    }

    fn positions(&self, elements: Elements<'_>, world: DMat4, instance: Option<usize>) -> Result<Vec<Vec3>, GltfError> {
        let mut positions = Vec::with_capacity(elements.count());
        for (vertex, local) in elements.numbers().enumerate() {
            let position = world.transform_point3(Vec3::from_array(local).as_dvec3()).as_vec3();
            // Written so that NaN fails as well.
            let placed = position.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE);
            if !placed {
                let user = self.user;
                return Err(GltfError::Position {
                    primitive: instance.map_or_else(|| user.to_owned(), |k| format!("{user}, instance {k}")),
                    vertex,
                    position: position.to_array(),
                });
            }
            positions.push(position);
        }
        Ok(positions)
    }

    fn texture_coordinates(&self, elements: Elements<'_>) -> Result<Vec<Vec2>, GltfError> {
        let finite = |(vertex, [u, v]): (usize, [f32; 2])| {
            let uv = Vec2::new(u, v);
            uv.is_finite().then_some(uv).ok_or_else(|| {
                GltfError::part(
                    self.user.to_owned(),
                    format!("vertex {vertex} has texture coordinates ({u}, {v}), but they must be finite; mend them"),
                )
            })
        };
        elements.numbers().enumerate().map(finite).collect()
    }

    /// Returns the colours, within 0 to 1; none if all are white.
    fn colors(&self, elements: Elements<'_>) -> Result<Vec<Vec3>, GltfError> {
        let color = |(vertex, [red, green, blue]): (usize, [f32; 3])| {
            let color = Vec3::new(red, green, blue);
            let problem =
                || format!("vertex {vertex} has the colour ({red}, {green}, {blue}), but it must be finite; mend it");
            let finite = color.is_finite().then(|| color.clamp(Vec3::ZERO, Vec3::ONE));
            finite.ok_or_else(|| GltfError::part(self.user.to_owned(), problem()))
        };
        let colors: Vec<Vec3> = elements.numbers().enumerate().map(color).collect::<Result<_, _>>()?;
        Ok(if colors.iter().all(|color| *color == Vec3::ONE) { Vec::new() } else { colors })
    }

    fn in_range(&self, elements: Elements<'_>, vertices: usize) -> Result<Vec<u32>, GltfError> {
        let mut indices = Vec::with_capacity(elements.count());
        for (place, index) in elements.indices().enumerate() {
            if index as usize >= vertices {
                return Err(GltfError::IndexOutOfRange {
                    primitive: self.user.to_owned(),
                    place,
                    index,
                    vertices: vertices as u64,
                });
            }
            indices.push(index);
        }
        Ok(indices)
    }
}

/// The file's normals where they have a direction, else the shared normals of the triangles.
fn given_or_shared(
    given: impl Iterator<Item = [f32; 3]>,
    transform: Cofactors,
    positions: &[Vec3],
    indices: &[u32],
) -> Vec<Vec3> {
    let given: Vec<Option<Vec3>> = given.map(|normal| transform.apply(Vec3::from_array(normal))).collect();
    if given.iter().all(Option::is_some) {
        return given.into_iter().flatten().collect();
    }
    let shared = shared_normals(positions, indices, Averaging::Angle);
    let pairs = given.into_iter().zip(shared);
    pairs.map(|(given, shared)| given.unwrap_or(shared)).collect()
}
