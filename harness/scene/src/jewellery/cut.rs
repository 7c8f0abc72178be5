//! Whether a shape is that of a cut stone: closed, convex, with flat facets of many directions.

use std::fmt;

use glam::DVec3;

use crate::Mesh;
use crate::hull::{Hull, volume};
use crate::normals::is_smooth;
use crate::shells::Shells;

/// Triangles of a mesh up to which its shape is looked at.
const MOST_TRIANGLES: usize = 1 << 18;
/// Number of parts that are looked at, and products of planes and corners for each.
const PARTS: usize = 16;
const MOST_PRODUCTS: usize = 1 << 24;
/// Height of a corner above a facet that is no dent, as a share of the size.
const DENT: f64 = 0.01;
/// Share of the area whose planes no corner lies above, in a convex body.
const CONVEX: f64 = 0.95;
/// Share of the volume of its hull that a cut stone has which is modelled with bent facets: those that were tried have .979 and
/// more, parts of settings .33 and less.
const FILLED: f64 = 0.95;
/// Share of the triangles in closed parts.
const CLOSED: f64 = 0.9;
/// Cosine of the angle within which normals are one direction: 2°.
const SAME: f64 = 0.999_4;
/// Numbers of facets of a cut stone: fewer are a box or a tile, more a smooth body.
const FACETS: std::ops::RangeInclusive<usize> = 16..=400;
/// Sine of the angle by which a normal may be off the axis of a prism or its plane.
const PRISM: f64 = 0.05;

/// The shape of a mesh, as far as a cut stone is told by it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Cut {
    /// Share of the triangles that are in closed parts.
    closed: f64,
    /// Least share, over the parts, of the area whose planes no corner lies above.
    convex: f64,
    /// Least share, over the parts, of the volume of the hull: 1 for convex ones, 0 for others without a stone's number of facets.
    filled: f64,
    /// Largest number of facets of a part.
    facets: usize,
    is_smooth: bool,
    /// Whether all facets of a part stand upright around an axis or across it.
    is_prism: bool,
    /// Whether the mesh was looked at.
    is_known: bool,
}

impl Cut {
    pub(super) fn of(mesh: &Mesh) -> Self {
        if mesh.triangle_count() > MOST_TRIANGLES {
            return Self::default();
        }
        let Some(mut shells) = Shells::of(mesh) else { return Self::default() };
        shells.close();
        let in_closed: usize = shells.solids.iter().map(Mesh::triangle_count).sum();
        let in_open: usize = shells.open.iter().map(Mesh::triangle_count).sum();
        let closed = in_closed as f64 / (in_closed + in_open).max(1) as f64;
        let step = shells.solids.len().div_ceil(PARTS).max(1);
        let parts: Vec<Part> = shells.solids.iter().step_by(step).map(Part::of).collect();
        Self {
            closed,
            convex: parts.iter().map(|part| part.convex).fold(1.0, f64::min),
            filled: parts.iter().map(|part| part.filled).fold(1.0, f64::min),
            facets: parts.iter().map(|part| part.facets).max().unwrap_or_default(),
            is_smooth: shells.solids.iter().step_by(step).any(is_smooth),
            is_prism: parts.iter().any(|part| part.is_prism),
            is_known: !parts.is_empty(),
        }
    }

    pub(super) fn is_closed(&self) -> bool {
        self.is_known && self.closed >= CLOSED
    }

    fn is_convex(&self) -> bool {
        self.is_known && self.convex >= CONVEX
    }

    /// Whether it is convex, or would be but for bent facets.
    pub(super) fn is_nearly_convex(&self) -> bool {
        self.is_convex() || self.is_known && self.filled >= FILLED
    }

    pub(super) fn is_faceted(&self) -> bool {
        self.is_known && !self.is_smooth && self.facets <= *FACETS.end()
    }

    /// Whether the shape alone is that of a cut stone, convex or with facets that are bent.
    pub(super) fn is_stone(&self) -> bool {
        self.is_closed()
            && self.is_nearly_convex()
            && self.is_faceted()
            && FACETS.contains(&self.facets)
            && !self.is_prism
    }
}

impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match () {
            () if self.is_convex() => f.write_str("closed and convex")?,
            () if self.is_nearly_convex() => {
                write!(f, "closed, though not convex ({:.0} % of its hull)", (100.0 * self.filled).floor())?;
            }
            () => f.write_str("closed")?,
        }
        if self.is_faceted() { write!(f, ", {} facets", self.facets) } else { Ok(()) }
    }
}

/// A closed part.
struct Part {
    convex: f64,
    filled: f64,
    facets: usize,
    is_prism: bool,
}

impl Part {
    fn of(mesh: &Mesh) -> Self {
        let triangles: Vec<[DVec3; 3]> = mesh.triangles().map(|corners| corners.map(|at| at.as_dvec3())).collect();
        let across = |[a, b, c]: &[DVec3; 3]| 0.5 * (*b - *a).cross(*c - *a);
        let corners = || triangles.iter().flatten().copied();
        let (min, max) =
            corners().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), at| (min.min(at), max.max(at)));
        let dent = DENT * (max - min).max_element();
        // The largest first, whose normals are the most exact.
        let mut planes: Vec<(DVec3, DVec3)> = triangles.iter().map(|corners| (across(corners), corners[0])).collect();
        planes.sort_by(|one, other| other.0.length_squared().total_cmp(&one.0.length_squared()));
        let area: f64 = planes.iter().map(|(across, _)| across.length()).sum();
        let step = (planes.len() * 3 * triangles.len()).div_ceil(MOST_PRODUCTS).max(1);
        let (mut below, mut looked_at) = (0.0, 0.0);
        let mut normals: Vec<(DVec3, f64)> = Vec::new();
        for (number, (across, about)) in planes.iter().enumerate() {
            let (normal, size) = (across.normalize_or_zero(), across.length());
            if number % step == 0 {
                looked_at += size;
                let is_above = corners().any(|corner| normal.dot(corner - *about) > dent);
                below += if is_above { 0.0 } else { size };
            }
            match normals.iter().position(|(other, _)| other.dot(normal) >= SAME) {
                Some(facet) => normals[facet].1 += size,
                None if normals.len() <= *FACETS.end() => normals.push((normal, size)),
                None => {}
            }
        }
        // What is left of slivers is no facet.
        normals.retain(|(_, size)| *size > 1e-5 * area);
        let directions: Vec<DVec3> = normals.iter().map(|(normal, _)| *normal).collect();
        let convex = below / f64::max(looked_at, f64::MIN_POSITIVE);
        let filled = match directions.len() {
            _ if convex >= CONVEX => 1.0,
            facets if FACETS.contains(&facets) => filled(mesh),
            _ => 0.0,
        };
        Self { convex, filled, facets: directions.len(), is_prism: is_prism(&directions) }
    }
}

/// Returns the share of the volume of its hull that a closed mesh has; 0 if that has none.
fn filled(mesh: &Mesh) -> f64 {
    let triangles = mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k| corners[k] as usize));
    let own = volume(&mesh.positions, triangles).0;
    Hull::of(&mesh.positions).map_or(0.0, |hull| own / volume(&mesh.positions, hull.triangles).0)
}

/// Whether normals are all along an axis, which is one of the first of them or across two, or across it.
fn is_prism(normals: &[DVec3]) -> bool {
    let first = &normals[..normals.len().min(4)];
    let across = first.iter().enumerate().flat_map(|(k, one)| first[k + 1..].iter().map(|other| one.cross(*other)));
    let axes = first.iter().copied().chain(across).filter_map(DVec3::try_normalize);
    axes.into_iter().any(|axis| {
        normals.iter().all(|normal| {
            let along = normal.dot(axis).abs();
            along <= PRISM || along >= (1.0 - PRISM * PRISM).sqrt()
        })
    })
}
