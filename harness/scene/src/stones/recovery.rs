//! Clear stones whose facets a file has rounded, as exactly convex ones.

use super::note::{self, StoneNote};
use crate::convex::planes_of_convex;
use crate::facet_fit::{NotRecovered, Recovered, recover};
use crate::normals::{Normals, is_smooth};
use crate::{Copies, Mesh, Object, Scene};

/// Cosine of the angle up to which a normal is that of a facet: 5°, more than a byte for each part of it rounds.
const FLAT: f32 = 0.996;
/// Share of the area whose normals are those of facets on a body that a file shows with facets.
const MOST: f64 = 0.9;

impl Scene {
    /// Gives the clear bodies that are convex but for the rounding of their file exact facets, by [`recover`], and returns what was
    /// done. A body stays as it is if it is convex already, is painted, or is no cut stone by its normals.
    pub fn recover_stones(&mut self) -> Vec<StoneNote> {
        let mut notes = Vec::new();
        for object in &mut self.objects {
            let is_painted = object.material.textures().next().is_some();
            if !object.material.has_clear_inside() || is_painted {
                continue;
            }
            let recovered = match exact(object.shape(), object.material.normals) {
                Some(Ok(recovered)) => recovered,
                Some(Err(why)) if why.is_nearly() => {
                    note::add(&mut notes, StoneNote::AsModelled { first: object.name.clone(), objects: 1, why });
                    continue;
                }
                _ => continue,
            };
            note::add(&mut notes, StoneNote::recovered(&object.name, &recovered));
            match &object.copies {
                None => object.mesh = recovered.mesh,
                Some(copies) => {
                    let copies = Copies { shape: recovered.mesh, places: copies.places.clone() };
                    *object = Object::of_copies(object.name.clone(), copies, object.material.clone());
                }
            }
        }
        notes
    }
}

/// Returns the stone of a mesh, or why its facets are not recovered; `None` if it is no cut one, or convex already.
fn exact(mesh: &Mesh, normals: Normals) -> Option<Result<Recovered, NotRecovered>> {
    if normals == Normals::File || mesh.indices.is_empty() || planes_of_convex(mesh).is_some() {
        return None;
    }
    // Averaged over all edges, the normals of a cut stone are told from those of a round body by its edges.
    match recover(mesh) {
        Ok(recovered) => {
            let is_cut = normals == Normals::Facets || shows_facets(mesh, &recovered) || !is_smooth(&recovered.mesh);
            is_cut.then_some(Ok(recovered))
        }
        Err(why) => (normals == Normals::Facets || !is_smooth(mesh)).then_some(Err(why)),
    }
}

/// Whether the normals of a mesh are those of the facets that were recovered.
fn shows_facets(mesh: &Mesh, recovered: &Recovered) -> bool {
    let flat = recovered.share_of_area(mesh, |corners, _, facet| {
        corners.iter().all(|&corner| mesh.normals[corner].dot(facet.as_vec3()) >= FLAT)
    });
    flat >= MOST
}

#[cfg(test)]
mod tests;
