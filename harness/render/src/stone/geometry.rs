//! The data that a rung's geometry needs of a stone's mesh, besides its positions.

use super::facet_map::Walked;
use crate::error::RenderError;
use crate::frame::Builder;
use crate::frame::record::Record;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_scene::normals::soft_normals;
use lapidary_scene::{Bvh, Convex, Mesh, Object, convex};
use std::borrow::Cow;

/// Data of a mesh that a rung's geometry needs, besides its positions.
pub(super) struct Geometries<'a> {
    pub(super) indices: Cow<'a, [u32]>,
    /// The buffers of group 2.
    pub(super) facets: Vec<(&'static str, Cow<'a, [u8]>)>,
    /// A struct that follows them.
    pub(super) record: Option<(&'static str, Record)>,
    /// Loop iterations to find one hit.
    pub(super) steps: u64,
}

/// Number of loop iterations, summed over all loops of one invocation, after which lavapipe
/// silently ends loops (Mesa's `LP_MAX_TGSI_LOOP_ITERATIONS`).
const LAVAPIPE_STEPS: u64 = 65_535;

/// Rejects a rung that lavapipe would render incorrectly.
pub(super) fn check_steps(builder: &Builder<'_>, rung: Rung, steps: u64) -> Result<(), RenderError> {
    let rays = match rung.spectrum() {
        Spectrum::One | Spectrum::Paper | Spectrum::Tracker => 1,
        Spectrum::Split => 2,
        Spectrum::Separate(count) => u64::from(count),
    };
    let steps = rays * (1 + u64::from(rung.hits()) * (1 + steps));
    if builder.is_for_lavapipe() && steps > LAVAPIPE_STEPS {
        return Err(RenderError::TooManySteps { rung, steps, limit: LAVAPIPE_STEPS });
    }
    Ok(())
}

impl<'a> Geometries<'a> {
    /// Returns the data for a body of this name.
    pub(super) fn of(name: &str, mesh: &'a Mesh, rung: Rung) -> Result<Self, RenderError> {
        let indices = Cow::Borrowed(&mesh.indices[..]);
        let not_convex = |reason| RenderError::NotConvex { object: name.to_owned(), reason };
        Ok(match rung.geometry() {
            Geometry::Proxy => {
                let normals = match soft_normals(mesh) {
                    Cow::Borrowed(given) => Cow::Borrowed(bytemuck::cast_slice(given)),
                    Cow::Owned(softened) => Cow::Owned(bytemuck::cast_slice(&softened).to_vec()),
                };
                Self { indices, facets: vec![("normals", normals)], record: None, steps: 0 }
            }
            Geometry::Convex => {
                let convex = Convex::of_mesh(mesh).ok_or_else(|| not_convex(convex::obstacle(mesh)))?;
                Self { indices, facets: facets(&convex), record: None, steps: convex.planes.len() as u64 }
            }
            Geometry::Walk => {
                let Walked { convex, map, centre } = Walked::of_mesh(mesh).map_err(not_convex)?;
                let stone = Record::new("GemStone").with("centre", centre).with("side", map.side);
                let stone = stone.with("lower", map.lower).with("upper", map.upper);
                let mut facets = facets(&convex);
                facets.push(("facet map", bytemuck::cast_slice(&map.words).to_vec().into()));
                // Few walks take more than four passes, even over the longest lists.
                Self { indices, facets, record: Some(("stone", stone)), steps: 4 * map.longest_list() as u64 }
            }
            // Its triangles are in the hierarchy of all bodies.
            Geometry::Scene => Self { indices, facets: Vec::new(), record: None, steps: 0 },
            Geometry::Bvh | Geometry::Triangles => {
                let bvh = Bvh::build(&mesh.positions, &mesh.indices);
                let words = bvh.words();
                let (nodes, corners): (&[u8], &[u8]) =
                    (bytemuck::cast_slice(&words), bytemuck::cast_slice(&bvh.corners));
                let facets = vec![("nodes", nodes.to_vec().into()), ("corners", corners.to_vec().into())];
                // The recipe, too, numbers triangles in the order of the leaves.
                let triangles = mesh.triangle_count() as u64;
                // A ray's path through a hierarchy has no useful bound; few take as many as 16
                // iterations for each of its levels.
                let levels = u64::from(triangles.ilog2()) + 1;
                let steps = if rung.geometry() == Geometry::Bvh { 16 * levels } else { triangles };
                Self { indices: Cow::Owned(bvh.indices), facets, record: None, steps }
            }
        })
    }
}

/// Returns the buffers of a convex body's facets.
fn facets<'a>(Convex { planes, face_of_triangle }: &Convex) -> Vec<(&'static str, Cow<'a, [u8]>)> {
    let planes: Vec<[f32; 4]> = planes.iter().map(|plane| plane.to_array()).collect();
    let (planes, faces): (&[u8], &[u8]) = (bytemuck::cast_slice(&planes), bytemuck::cast_slice(face_of_triangle));
    vec![("planes", planes.to_vec().into()), ("face of triangle", faces.to_vec().into())]
}

/// Size in bytes of the device buffers that a rung's geometry needs for `object`, besides positions
/// and indices.
pub fn geometry_bytes(object: &Object, rung: Rung) -> Result<u64, RenderError> {
    let Geometries { facets, record, .. } = Geometries::of(&object.name, object.shape(), rung)?;
    let record = record.map_or(0, |(_, record)| record.bytes().len());
    Ok(facets.iter().map(|(_, part)| part.len() as u64).sum::<u64>() + record as u64)
}
