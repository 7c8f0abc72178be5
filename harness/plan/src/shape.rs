//! What a body's surface is: smooth or cut, convex or not.

use crate::remembered::Remembered;
use lapidary_scene::normals::{self, Normals};
use lapidary_scene::{Object, Shape};

/// Whether the normals between a triangle's corners reflect and refract in a clear body.
#[must_use]
pub fn is_smooth(object: &Object) -> bool {
    static FOUND: Remembered<bool> = Remembered::new();
    let normals = object.material.normals;
    object.material.has_clear_inside()
        && match normals {
            Normals::Decided => FOUND.of(&object.mesh, |mesh| normals.are_smooth(mesh)),
            Normals::File | Normals::Facets => normals.are_smooth(&object.mesh),
        }
}

/// Whether a body, or what its copies share, is closed and convex.
pub(crate) fn is_convex(object: &Object) -> bool {
    static FOUND: Remembered<bool> = Remembered::new();
    FOUND.of(object.shape(), |mesh| Shape::of(mesh) == Shape::Convex)
}

/// Returns why a clear body is not smooth.
pub(crate) fn why_flat(object: &Object) -> &'static str {
    static BENT: Remembered<bool> = Remembered::new();
    match object.material.normals {
        Normals::Facets => "asked for: facets",
        Normals::Decided if BENT.of(&object.mesh, normals::is_bent) => {
            "few, wide facets with normals averaged over sharp edges: a cut stone"
        }
        Normals::Decided | Normals::File => "its normals are those of facets",
    }
}
