//! The facets of a cut stone, recovered from a mesh that is convex but for the rounding of its file.
//!
//! Exporters round corners to 16 bits and fewer, which bends every facet. Here the triangles of the convex hull are grouped into facets
//! again, each facet's plane is fitted to its own corners, planes that a symmetry takes to one another are averaged, and the stone is
//! the solid between the planes.

use glam::DVec3;

use crate::hull::{Hull, volume};
use crate::polyhedron::{MAX_PLANES, Plane};
use crate::{Bounds, Mesh, registration};
use plane::{fitted, reach, width};
use regions::{Region, Triangles};
use symmetry::Facet;

mod error;
mod plane;
mod regions;
mod solid;
mod symmetry;

pub use error::NotRecovered;
pub use symmetry::Symmetry;

/// Share of the hull's volume that may lie outside a mesh whose facets are recovered.
pub const VOLUME: f64 = 0.01;
/// Depth of a corner below the hull, as a share of the diagonal of the bounds, that such a mesh may have.
pub const DEPTH: f64 = 0.01;

/// Tolerances of grouping, as shares of the diagonal: from a little more than f32 rounds, by √2.
const LEAST_TOLERANCE: f64 = 1.0 / (1 << 22) as f64;
const TOLERANCES: i32 = 40;
/// And up to this one.
const COARSEST: f64 = 1.0 / 64.0;
/// Number of tolerances in a row, 2.8 to 1, by which the facets are the same: those of the stone, not those of rounding.
const STEADY: usize = 4;
/// Largest number of triangles of a mesh, and of corners of its hull, of which facets are looked for: of a cut stone, whose facets are
/// cut into many triangles each, and few of whose corners rounding puts on the hull.
const MOST_TRIANGLES: usize = 1 << 16;
const MOST_CORNERS: usize = 1 << 12;
/// Distance of a corner from a plane that is averaged over a symmetry, in half steps, up to which it is rounding: √3 along a cube's
/// diagonal, and as much for what the noise is estimated by.
const AVERAGED: f64 = 3.5;
/// Distance of a corner from the solid, in half steps, up to which it is rounding.
const MOVED: f64 = 6.0;

/// Angle in radians, 5°, by which a triangle is turned into its facet at most, if no tolerances agree on the facets.
const UNSTEADY: f64 = 0.087;
/// Share of the area of triangles that may be turned further all the same: those of a girdle, and slivers. With more of them dents
/// that were modelled are not told from rounding: of 1200 stones of public rings it is at most .13, and .38 or more in six.
const TURNED: f64 = 0.15;

/// A stone recovered from a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Recovered {
    /// The surface of the solid, exactly convex to the rounding of f32.
    pub mesh: Mesh,
    /// Its facets.
    pub facets: Vec<RecoveredFacet>,
    /// Share of the hull's volume outside the mesh.
    pub volume: f64,
    /// Half the step to which corners were rounded, as their distances from the planes tell it, as a share of the diagonal of the
    /// bounds.
    pub noise: f64,
    /// Greatest distance of a corner of the mesh from the recovered solid, as a share of the diagonal.
    pub moved: f64,
    /// The symmetry that planes were averaged over.
    pub symmetry: Option<Symmetry>,
    /// Whether the facets are told from rounding: several tolerances gave the same.
    pub is_steady: bool,
}

/// A facet of a recovered stone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecoveredFacet {
    /// Its plane, in the mesh's space.
    pub plane: Plane,
    /// Twice the angle in radians by which corners that are off by half a step turn it: half a step over its least width, less by
    /// the root of the number of planes that were averaged.
    pub uncertainty: f64,
}

impl Recovered {
    /// Returns the largest angle by which a facet may be turned, in radians.
    #[must_use]
    pub fn uncertainty(&self) -> f64 {
        self.facets.iter().map(|facet| facet.uncertainty).fold(0.0, f64::max)
    }

    /// Returns the share of the area of `mesh`, from which the stone was recovered, of triangles that are so: by the numbers of their
    /// corners, their unit normals, and those of the facets that cover them.
    pub(crate) fn share_of_area(&self, mesh: &Mesh, is_so: impl Fn([usize; 3], DVec3, DVec3) -> bool) -> f64 {
        let (mut so, mut whole) = (0.0, 0.0);
        for corners in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| corners[corner] as usize);
            let [a, b, c] = corners.map(|corner| mesh.positions[corner].as_dvec3());
            let (across, middle) = ((b - a).cross(c - a), (a + b + c) / 3.0);
            let height = |facet: &&RecoveredFacet| facet.plane.height(middle);
            let covers = self.facets.iter().max_by(|one, other| height(one).total_cmp(&height(other)));
            whole += across.length();
            if covers.is_some_and(|facet| is_so(corners, across.normalize_or_zero(), facet.plane.normal)) {
                so += across.length();
            }
        }
        so / whole
    }
}

/// Recovers the stone of a mesh that is convex but for rounding.
///
/// # Errors
/// [`NotRecovered`] if it is no such mesh.
pub fn recover(mesh: &Mesh) -> Result<Recovered, NotRecovered> {
    if !mesh.colors.is_empty() {
        return Err(NotRecovered::Painted);
    }
    let bounds = Bounds::of(mesh.positions.iter().copied());
    let size = f64::from(2.0 * bounds.radius());
    if mesh.triangle_count() > MOST_TRIANGLES {
        return Err(NotRecovered::Large);
    }
    let hull = Hull::of(&mesh.positions).ok_or(NotRecovered::Flat)?;
    // A hull of c corners has 2 c - 4 triangles.
    if hull.triangles.len() > 2 * MOST_CORNERS {
        return Err(NotRecovered::Large);
    }
    // About the centroid, through which the axes of all symmetries go.
    let (whole, centre) = volume(&mesh.positions, hull.triangles.iter().copied());
    let triangles = mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k| corners[k] as usize));
    let outside = 1.0 - volume(&mesh.positions, triangles).0 / whole;
    if outside.abs() > VOLUME {
        return Err(NotRecovered::Hollowed { share: outside });
    }
    let points: Vec<DVec3> = mesh.positions.iter().map(|position| position.as_dvec3() - centre).collect();
    let depth = depth(&points, &hull, mesh);
    if depth > DEPTH * size {
        return Err(NotRecovered::Dented { depth: depth / size });
    }
    let (regions, is_steady) =
        grouped(&Triangles::new(&points, &hull.triangles), depth, size).ok_or(NotRecovered::Round)?;
    let facets: Vec<Facet> = regions.iter().map(|region| facet(region, &points)).collect();
    let noise = noise(&facets).max(if is_steady { LEAST_TOLERANCE * size } else { depth });
    let (planes, symmetry) = match symmetric(&facets, noise).filter(|_| is_steady) {
        Some((planes, symmetry)) => (planes, Some(symmetry)),
        None => (facets.iter().map(|facet| facet.plane).collect(), None),
    };
    let moved = hull_corners(&hull).map(|corner| highest(&planes, points[corner]).abs()).fold(0.0, f64::max);
    if moved > MOVED * noise {
        return Err(NotRecovered::Unlike { moved: moved / size });
    }
    let solid = solid::between(&planes, centre).ok_or(NotRecovered::Open)?;
    // Of a lattice along the axes, whose rounding is alike in corners that are alike, distances tell too little.
    let half_step = noise.max(registration::noise(mesh) / 3f64.sqrt());
    let order = symmetry.map_or(1.0, |symmetry| f64::from(symmetry.order()).sqrt());
    let facets = facets.iter().zip(&planes).map(|(facet, plane)| RecoveredFacet {
        plane: Plane { normal: plane.normal, distance: plane.distance + plane.normal.dot(centre) },
        uncertainty: 2.0 * half_step / width(&facet.points, plane.normal) / order,
    });
    let recovered = Recovered {
        mesh: solid,
        facets: facets.collect(),
        volume: outside,
        noise: noise / size,
        moved: moved / size,
        symmetry,
        is_steady,
    };
    if is_steady {
        return Ok(recovered);
    }
    let share = recovered.share_of_area(mesh, |_, normal, facet| normal.dot(facet) < UNSTEADY.cos());
    if share <= TURNED { Ok(recovered) } else { Err(NotRecovered::Turned { share }) }
}

/// Returns the greatest depth below the hull of the mesh's surface, at the corners and the middles of sides: where rounding bends a
/// facet, half its sides run below the hull.
fn depth(points: &[DVec3], hull: &Hull, mesh: &Mesh) -> f64 {
    let planes: Vec<Plane> = hull.triangles.iter().filter_map(|corners| through(corners.map(|k| points[k]))).collect();
    let corner = |index: u32| points[index as usize];
    let sides = mesh.indices.chunks_exact(3).flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let middles = sides.map(|[from, to]| 0.5 * (corner(from) + corner(to)));
    points.iter().copied().chain(middles).map(|point| -highest(&planes, point)).fold(0.0, f64::max)
}

/// Returns the plane through a triangle's corners.
fn through([a, b, c]: [DVec3; 3]) -> Option<Plane> {
    let normal = (b - a).cross(c - a).try_normalize()?;
    Some(Plane { normal, distance: normal.dot(a) })
}

/// Returns the greatest height of a point above planes: below 0 within the solid.
fn highest(planes: &[Plane], point: DVec3) -> f64 {
    planes.iter().map(|plane| plane.height(point)).fold(f64::MIN, f64::max)
}

fn hull_corners(hull: &Hull) -> impl Iterator<Item = usize> {
    let mut corners: Vec<usize> = hull.triangles.iter().flatten().copied().collect();
    corners.sort_unstable();
    corners.dedup();
    corners.into_iter()
}

/// Returns the facets that several tolerances in a row agree on, the first above `depth`: by lower ones each facet that rounding bent
/// is several. If no tolerances agree, those of the least one, of which rounding may have bent one into several; and whether any did.
fn grouped(triangles: &Triangles<'_>, depth: f64, size: f64) -> Option<(Vec<Region>, bool)> {
    let least = depth.max(LEAST_TOLERANCE * size);
    let mut first = None;
    let mut row: Vec<Vec<Region>> = Vec::new();
    for step in 0..TOLERANCES {
        let tolerance = least * 2.0_f64.powf(0.5 * f64::from(step));
        if step > 0 && tolerance > COARSEST * size {
            break;
        }
        let Some(regions) = triangles.grouped(tolerance, MAX_PLANES) else { continue };
        if regions.len() < 4 {
            break;
        }
        if row.last().is_some_and(|last| last.len() != regions.len()) {
            first = first.or(row.drain(..).next());
        }
        row.push(regions);
        if row.len() == STEADY {
            return row.pop().map(|regions| (regions, true));
        }
    }
    first.or(row.drain(..).next()).map(|regions| (regions, false))
}

/// Returns a facet with its plane fitted to its corners.
fn facet(region: &Region, points: &[DVec3]) -> Facet {
    let corners: Vec<DVec3> = region.corners.iter().map(|&corner| points[corner]).collect();
    let plane = fitted(&corners, region.plane.normal).unwrap_or(region.plane);
    Facet { plane, points: corners, area: region.area }
}

/// Returns half the step to which corners were rounded, as far as their distances from the planes tell: an error that is even over a
/// cube of side 2 h has the variance h² / 3 along any normal, and each plane takes up three of its corners' distances.
fn noise(facets: &[Facet]) -> f64 {
    let squares = |facet: &Facet| facet.points.iter().map(|point| facet.plane.height(*point).powi(2)).sum::<f64>();
    let free: usize = facets.iter().map(|facet| facet.points.len().saturating_sub(3)).sum();
    (3.0 * facets.iter().map(squares).sum::<f64>() / free.max(1) as f64).sqrt()
}

/// Returns the planes averaged over the solid's symmetry, if all corners stay as near to them as rounding allows.
fn symmetric(facets: &[Facet], noise: f64) -> Option<(Vec<Plane>, Symmetry)> {
    let (planes, symmetry) = symmetry::averaged(facets, 16.0 * noise)?;
    let stays = |(facet, plane): (&Facet, &Plane)| reach(&facet.points, plane) <= AVERAGED * noise;
    facets.iter().zip(&planes).all(stays).then_some((planes, symmetry))
}

#[cfg(test)]
mod tests;
