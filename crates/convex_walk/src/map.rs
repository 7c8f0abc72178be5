//! The map of a stone's facets by direction, made from its planes.

use crate::{CONVEX_WALK_FACE, CONVEX_WALK_MORE, CONVEX_WALK_PLACE, CONVEX_WALK_SHIFT, cell, square};
use glam::{DVec2, DVec3, DVec4, Vec3, Vec4, Vec4Swizzles as _};
use std::fmt;

/// Angle by which facets and cells that do not meet must be apart, in radians. `square` may be off
/// by 9e-7 on any device, which is at most 4.3 times as much as an angle; the point's own rounding
/// adds 4 ulp.
const APART: f64 = 1.0 / (1 << 15) as f64;
/// Half the side of the first polygon of a facet, in units of the largest distance of a plane: how
/// far a corner of a closed stone may lie.
const FAR: f64 = 1e6;
/// How much larger the box is than the stone, in units of its own size.
const ROOM: f64 = 1.0 / (1 << 10) as f64;
/// Largest side of a map.
const LARGEST_SIDE: u32 = 512;

/// Why planes have no map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoMap {
    /// The side is odd, 0 or too large.
    Side(u32),
    /// There are more facets than a word can number.
    Facets(usize),
    /// The origin is not inside a plane, or the plane holds something else than finite numbers.
    Plane(usize),
    /// Planes leave a side open.
    Open,
    /// There are more words than one can address.
    Lists(usize),
}

impl fmt::Display for NoMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Side(side) => write!(f, "a map of side {side}; take an even number from 2 to {LARGEST_SIDE}"),
            Self::Facets(count) => {
                write!(f, "{count} facets; a map holds {} at most: take bvh_trace", CONVEX_WALK_FACE + 1)
            }
            Self::Plane(plane) => {
                write!(f, "plane {plane} does not have the origin on its inner side; move the stone over the origin")
            }
            Self::Open => write!(f, "the planes leave a side open; add planes until the stone is closed"),
            Self::Lists(words) => write!(f, "a map of {words} words, more than can be addressed; take a smaller side"),
        }
    }
}

impl std::error::Error for NoMap {}

/// The facets that are seen from the origin, by direction, and a box around the stone.
#[derive(Debug, Clone, PartialEq)]
pub struct FacetMap {
    /// Cells along each side of the square.
    pub side: u32,
    /// The cells' words and, behind them, further ones of cells with more than two candidates; as a
    /// shader reads them.
    pub words: Vec<u32>,
    /// Corner of the box with the smallest coordinates.
    pub lower: Vec3,
    /// Corner of the box with the largest coordinates.
    pub upper: Vec3,
}

impl FacetMap {
    /// Returns a side with at least 32 cells for each facet, from 64 to 512: lists stay so short
    /// that a walk over thousands of facets takes little more time than one over dozens, and more
    /// cells would shorten it by less than they cost in memory.
    #[must_use]
    pub fn usual_side(facets: usize) -> u32 {
        let enough = |side: &u32| (side * side) as usize >= 32 * facets;
        [64, 128, 256].into_iter().find(enough).unwrap_or(LARGEST_SIDE)
    }

    /// Returns the map of the stone that `planes` enclose: outward unit normals and distances, with
    /// the origin inside. Planes that bound no facet are in no cell.
    ///
    /// A cell lists each facet that comes within 2^-15 radians of it. That is more than the
    /// rounding of a lookup on any device, so the lists are conservative: by the edges of cones, not
    /// by samples.
    ///
    /// # Errors
    /// [`NoMap`], if the planes enclose nothing around the origin, or there are too many.
    pub fn of_planes(planes: &[Vec4], side: u32) -> Result<Self, NoMap> {
        if side == 0 || side % 2 == 1 || side > LARGEST_SIDE {
            return Err(NoMap::Side(side));
        }
        if planes.len() > CONVEX_WALK_FACE as usize + 1 {
            return Err(NoMap::Facets(planes.len()));
        }
        let planes: Vec<DVec4> = planes.iter().map(|plane| plane.as_dvec4()).collect();
        if let Some(bad) = planes.iter().position(|plane| !(plane.w > 0.0 && plane.is_finite())) {
            return Err(NoMap::Plane(bad));
        }
        let far = far(&planes);
        let facets: Vec<Vec<DVec3>> = (0..planes.len()).map(|face| facet_corners(&planes, face)).collect();
        let corners = || facets.iter().flatten();
        if corners().next().is_none() || corners().any(|corner| corner.length() > 0.5 * far) {
            return Err(NoMap::Open);
        }
        let lower = corners().fold(DVec3::INFINITY, |least, corner| least.min(*corner));
        let upper = corners().fold(DVec3::NEG_INFINITY, |most, corner| most.max(*corner));
        let room = ROOM * (upper - lower).max_element();
        let cones: Vec<Cone> = facets.iter().map(|facet| Cone::of(facet)).collect();
        Ok(Self {
            side,
            words: words(&lists(&cones, side))?,
            lower: (lower - room).as_vec3(),
            upper: (upper + room).as_vec3(),
        })
    }

    /// Returns the map of a side that suits the number of planes, [`FacetMap::usual_side`], or of the
    /// next smaller one whose lists can be addressed.
    ///
    /// # Errors
    /// [`NoMap`], as for [`FacetMap::of_planes`].
    pub fn of_stone(planes: &[Vec4]) -> Result<Self, NoMap> {
        let mut side = Self::usual_side(planes.len());
        loop {
            match Self::of_planes(planes, side) {
                Err(NoMap::Lists(_)) if side > 2 => side /= 2,
                made => return made,
            }
        }
    }

    /// Returns the number of words of the longest list of a cell.
    #[must_use]
    pub fn longest_list(&self) -> usize {
        let cells = (self.side * self.side) as usize;
        let length = |cell: usize| {
            let mut words = 1;
            let mut place = cell;
            while self.words[place] >= CONVEX_WALK_MORE {
                place = (self.words[place] >> CONVEX_WALK_SHIFT & CONVEX_WALK_PLACE) as usize;
                words += 1;
            }
            words
        };
        (0..cells).map(length).max().unwrap_or_default()
    }

    /// Returns the candidates of the cell in which `point` is seen from the origin, in the order in
    /// which a shader tests them, two for each word.
    pub fn candidates(&self, point: Vec3) -> impl Iterator<Item = u32> + '_ {
        let mut place = Some(cell(square(point), self.side));
        std::iter::from_fn(move || {
            let word = self.words[place? as usize];
            let (first, rest) = (word & CONVEX_WALK_FACE, word >> CONVEX_WALK_SHIFT & CONVEX_WALK_PLACE);
            let more = word >= CONVEX_WALK_MORE;
            place = more.then_some(rest);
            Some([first, if more { first } else { rest }])
        })
        .flatten()
    }
}

/// Returns how far from the origin the first polygon of a facet reaches.
fn far(planes: &[DVec4]) -> f64 {
    FAR * planes.iter().map(|plane| plane.w.abs()).fold(0.0, f64::max)
}

/// Returns the corners of a facet of the stone that `planes` enclose, outward normals and distances,
/// counter-clockwise from outside; empty if the other planes leave nothing of it. They are exact to
/// about 1e-9 of the largest distance. A facet with an open side has corners about 1e6 times as far
/// away as the largest distance.
///
/// # Panics
/// If there is no plane `face`.
#[must_use]
pub fn facet_corners(planes: &[DVec4], face: usize) -> Vec<DVec3> {
    let far = far(planes);
    let normal = planes[face].xyz().normalize();
    let first = normal.any_orthonormal_vector();
    let second = normal.cross(first);
    let middle = normal * (planes[face].w / planes[face].xyz().length());
    let corner = |x: f64, y: f64| middle + far * (x * first + y * second);
    let mut corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    for (_, plane) in planes.iter().enumerate().filter(|(other, _)| *other != face) {
        let height = |point: DVec3| plane.xyz().dot(point) - plane.w;
        let mut left = Vec::with_capacity(corners.len() + 1);
        for (index, &from) in corners.iter().enumerate() {
            let to = corners[(index + 1) % corners.len()];
            let [start, end] = [from, to].map(height);
            if start <= 0.0 {
                left.push(from);
            }
            if start.min(end) < 0.0 && start.max(end) > 0.0 {
                left.push(from.lerp(to, start / (start - end)));
            }
        }
        corners = left;
    }
    if corners.len() < 3 { Vec::new() } else { corners }
}

/// A convex cone of directions: that of a facet, or of a part of a cell.
struct Cone {
    /// Unit vectors along its edges, counter-clockwise from outside.
    edges: Vec<DVec3>,
    /// Inward unit normals of its sides.
    sides: Vec<DVec3>,
    /// Direction near its middle, and the cosine and sine of the largest angle from it to an edge.
    middle: DVec3,
    cosine: f64,
    sine: f64,
}

impl Cone {
    fn of(corners: &[DVec3]) -> Self {
        let edges: Vec<DVec3> = corners.iter().map(|corner| corner.normalize()).collect();
        // The direction of a shorter side would be rounding noise; without it, less is left out.
        let sides: Vec<DVec3> = (0..edges.len())
            .map(|index| edges[index].cross(edges[(index + 1) % edges.len()]))
            .filter(|side| side.length() > 1e-8)
            .map(DVec3::normalize)
            .collect();
        let middle = edges.iter().copied().sum::<DVec3>().normalize_or_zero();
        let cosine = edges.iter().map(|edge| edge.dot(middle)).fold(1.0, f64::min);
        Self { edges, sides, middle, cosine, sine: (1.0 - cosine * cosine).max(0.0).sqrt() }
    }

    /// Whether the cones come within [`APART`] of each other. Two convex cones that do not are
    /// separated by a side of one of them. A side counts only if it leaves out all of the other by
    /// that angle; so an error is always to the side of true.
    fn comes_near(&self, other: &Self) -> bool {
        if self.edges.is_empty() {
            return false;
        }
        // First the circles around them, if both are less than a half-space.
        let between = self.cosine * other.cosine - self.sine * other.sine - 2.0 * APART;
        if self.cosine > 0.0 && other.cosine > 0.0 && self.middle.dot(other.middle) < between {
            return false;
        }
        let leaves_out = |one: &Self, other: &Self| {
            one.sides.iter().any(|side| other.edges.iter().all(|edge| side.dot(*edge) < -APART))
        };
        !leaves_out(self, other) && !leaves_out(other, self)
    }
}

/// Returns the direction at a place on the square: the inverse of `square`.
fn direction(place: DVec2) -> DVec3 {
    let height = 1.0 - place.x.abs() - place.y.abs();
    match height >= 0.0 {
        true => place.extend(height),
        false => ((DVec2::ONE - DVec2::new(place.y, place.x).abs()) * place.signum()).extend(height),
    }
}

/// Returns the candidates of each cell. A cell is a square on a face of the octahedron or, on its
/// edge, two triangles on two faces; each is a cone with flat sides.
fn lists(facets: &[Cone], side: u32) -> Vec<Vec<u32>> {
    let position_of = |x: u32, y: u32| DVec2::new(f64::from(x), f64::from(y)) * (2.0 / f64::from(side)) - 1.0;
    let cells = (0..side * side).map(|cell| (cell % side, cell / side));
    let list = cells.map(|(x, y)| {
        let places = [position_of(x, y), position_of(x + 1, y), position_of(x + 1, y + 1), position_of(x, y + 1)];
        let middle = 0.5 * (places[0] + places[2]);
        // The octahedron's edges cross the square's quadrants from axis to axis.
        let [first, second] = if middle.x * middle.y > 0.0 { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] };
        let parts = [first, second].map(|part| {
            let mut corners = part.map(|corner: usize| direction(places[corner]));
            if corners[0].dot(corners[1].cross(corners[2])) < 0.0 {
                corners.reverse();
            }
            Cone::of(&corners)
        });
        let near = |facet: &Cone| parts.iter().any(|part| facet.comes_near(part));
        (0..).zip(facets).filter(|(_, facet)| near(facet)).map(|(face, _)| face).collect()
    });
    list.collect()
}

/// Returns the map as a shader reads it.
fn words(lists: &[Vec<u32>]) -> Result<Vec<u32>, NoMap> {
    let mut words = vec![0; lists.len()];
    for (cell, list) in lists.iter().enumerate() {
        let mut place = cell;
        let mut list = &list[..];
        while let [face, rest @ ..] = list
            && rest.len() > 1
        {
            words[place] = CONVEX_WALK_MORE | (words.len() as u32) << CONVEX_WALK_SHIFT | face;
            place = words.len();
            words.push(0);
            list = rest;
        }
        let (Some(first), Some(last)) = (list.first(), list.last()) else { return Err(NoMap::Open) };
        words[place] = last << CONVEX_WALK_SHIFT | first;
        if words.len() > CONVEX_WALK_PLACE as usize {
            return Err(NoMap::Lists(words.len()));
        }
    }
    Ok(words)
}
