//! The shells of a mesh: its closed connected components, each the surface of a solid of its own, with faults mended where
//! it is certain how.

use std::fmt;

use glam::DVec3;

use crate::Mesh;

mod components;
mod doubled;
mod nesting;
mod opening;
mod orientation;
mod surface;
mod walls;

use components::Component;
use surface::Surface;

/// Largest number of triangles of a mesh that is looked at.
pub const MOST_TRIANGLES: usize = 1 << 21;
/// Height above the plane of a sheet inside a solid up to which it is flat, as a share of its extent.
const FLAT: f64 = 1.0 / (1 << 12) as f64;

/// The shells of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Shells {
    /// Each closed shell that lies in no other, with all that lie within it, such as those of cavities; in the order of their
    /// first triangles.
    pub solids: Vec<Mesh>,
    /// The components that are not closed.
    pub open: Vec<Mesh>,
    /// What was mended.
    pub mends: Mends,
    /// Distance within which corners were taken for one.
    pub tolerance: f64,
}

/// What was mended of a mesh; all counts are 0 if nothing was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Mends {
    /// Number of positions that were moved to others, within the tolerance of welding.
    pub welded: usize,
    /// Number of triangles left out that were there already.
    pub doubled: usize,
    /// Number of triangles left out that stood inside a solid.
    pub inner: usize,
    /// Number of triangles whose winding was not that of their neighbours.
    pub turned: usize,
    /// Number of solids that were inside out.
    pub inverted: usize,
    /// Number of openings that were closed by a facet.
    pub closed: usize,
}

impl Mends {
    /// Whether nothing was mended.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl std::ops::AddAssign for Mends {
    fn add_assign(&mut self, other: Self) {
        self.welded += other.welded;
        self.doubled += other.doubled;
        self.inner += other.inner;
        self.turned += other.turned;
        self.inverted += other.inverted;
        self.closed += other.closed;
    }
}

impl fmt::Display for Mends {
    /// Writes clauses for a message: `2 triangles that were there twice left out, 1 part turned outside out`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counted = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {many}")),
        };
        let clauses: Vec<String> = [
            counted(self.welded, "corner welded to another", "corners welded to others"),
            counted(self.doubled, "triangle left out that was there twice", "triangles left out that were there twice"),
            counted(self.inner, "triangle left out that stood inside", "triangles left out that stood inside"),
            counted(self.turned, "triangle turned as its neighbours", "triangles turned as their neighbours"),
            counted(self.inverted, "part turned that was inside out", "parts turned that were inside out"),
            counted(self.closed, "opening closed by a facet", "openings closed by facets"),
        ]
        .into_iter()
        .flatten()
        .collect();
        f.write_str(&clauses.join(", "))
    }
}

impl Shells {
    /// Parts a mesh into its shells. Left alone are closed shells within others, whatever their winding (a hollow body),
    /// openings (see [`Shells::close`]), and sheets that enclose nothing.
    ///
    /// `None` if the mesh has over [`MOST_TRIANGLES`] triangles, or so many shells, or so large ones, that it cannot be told in
    /// a few seconds which lie within which.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Option<Self> {
        if mesh.triangle_count() > MOST_TRIANGLES {
            return None;
        }
        let mut surface = Surface::of(mesh);
        let mut mends = Mends { welded: surface.welded(mesh), ..Mends::default() };
        mends.doubled = doubled::remove(&mut surface);
        mends.turned = orientation::unify(&mut surface);
        mends.inner = walls::remove(&mut surface);
        let components = components::of(&surface);
        let around = nesting::outermost(&surface, &components).ok()?;
        let mut groups: Vec<Vec<u32>> = components.iter().map(|component| component.faces.clone()).collect();
        for (inner, outer) in around.iter().enumerate() {
            let Some(outer) = *outer else { continue };
            let faces = std::mem::take(&mut groups[inner]);
            if !components[inner].is_closed && is_flat(&surface, &components[inner]) {
                mends.inner += faces.len();
            } else {
                groups[outer].extend(faces);
            }
        }
        let (mut solids, mut open) = (Vec::new(), Vec::new());
        let mut numbers = vec![u32::MAX; mesh.positions.len()];
        for (component, mut faces) in components.iter().zip(groups).filter(|(_, faces)| !faces.is_empty()) {
            faces.sort_unstable();
            if component.is_closed && component.volume < 0.0 {
                faces.iter().for_each(|&face| surface.faces[face as usize].turn());
                mends.inverted += 1;
            }
            let mut part = Mesh::default();
            surface.append(mesh, &faces, &mut numbers, &mut part);
            let list = if component.is_closed { &mut solids } else { &mut open };
            list.push(part);
        }
        Some(Self { solids, open, mends, tolerance: surface.tolerance })
    }

    /// Closes those open components of which it is certain which facet is missing: their openings are flat or as narrow as
    /// rounding, and with them closed the body is convex and has facets. They become solids, after the others.
    pub fn close(&mut self) {
        let mut open = Vec::new();
        for mesh in std::mem::take(&mut self.open) {
            match opening::closed(&mesh) {
                Some((solid, count)) => {
                    self.solids.push(solid);
                    self.mends.closed += count;
                }
                None => open.push(mesh),
            }
        }
        self.open = open;
    }

    /// Whether there is one solid, or one open component, and nothing was mended.
    #[must_use]
    pub fn is_as_given(&self) -> bool {
        self.mends.is_none() && self.solids.len() + self.open.len() == 1
    }
}

/// Whether all corners of a component lie in one plane.
fn is_flat(surface: &Surface, component: &Component) -> bool {
    let widest =
        component.faces.iter().copied().max_by(|&one, &other| {
            surface.across(one).length_squared().total_cmp(&surface.across(other).length_squared())
        });
    let Some(widest) = widest else { return false };
    let (normal, about) = (surface.across(widest).normalize_or_zero(), surface.corners(widest)[0]);
    let height = |corner: DVec3| normal.dot(corner - about).abs();
    let most = FLAT * (component.max - component.min).max_element();
    component.faces.iter().flat_map(|&face| surface.corners(face)).all(|corner| height(corner) <= most)
}

#[cfg(test)]
mod tests;
