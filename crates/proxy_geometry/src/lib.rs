//! Mirror of `wgsl/proxy_geometry.wgsl`: the inside of a gem guessed from the one triangle that a
//! ray enters by. Imagire, "Proxy Geometry Gem Rendering", section 4.2, eq. (8), (9).
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line.
//!
//! ```
//! use glam::{Vec3, vec3};
//! use lapidary_proxy_geometry::face_normal;
//!
//! let normal = face_normal(Vec3::ZERO, vec3(1e-20, 0.0, 0.0), vec3(0.0, 1e-20, 0.0));
//! assert_eq!(normal, Vec3::Z);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{IVec2, Vec2, Vec3};

/// The image of a triangle through the centre: one tile of plane P, and the lattice of all tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryPlane {
    /// Image of the triangle's first vertex.
    pub origin: Vec3,
    /// Edge from `origin` to the image of the second vertex.
    pub edge_first: Vec3,
    /// Edge from `origin` to the image of the third vertex.
    pub edge_second: Vec3,
}

/// Intersection of a ray with a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryHit {
    /// Intersection of the ray with the plane; on a miss, the start of the ray.
    pub point: Vec3,
    /// Distance along the ray, in units of its direction's length; 0 on a miss.
    pub distance: f32,
    /// False if the plane is behind the ray, passes through its start, or is parallel to it.
    pub hit: bool,
}

/// Position of a tile in the lattice of plane P.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProxyGeometryCell {
    /// Whole lattice steps along the two edges.
    pub steps: IVec2,
    /// True for the other half of the cell: the image rotated by half a turn.
    pub turned: bool,
}

/// One tile of plane P.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryFacet {
    /// The first vertex.
    pub vertex_first: Vec3,
    /// The second.
    pub vertex_second: Vec3,
    /// The third.
    pub vertex_third: Vec3,
}

/// Sine of the angle between ray and plane up to which the ray counts as parallel and misses.
pub const PROXY_GEOMETRY_PARALLEL: f32 = 9.536_743_164_062_5e-7;

/// Returns the image of a point through the centre of the proxy.
pub fn image(centre: Vec3, position: Vec3) -> Vec3 {
    2.0 * centre - position
}

/// Returns plane P and its lattice, from a triangle and the centre.
pub fn plane(centre: Vec3, position_first: Vec3, position_second: Vec3, position_third: Vec3) -> ProxyGeometryPlane {
    ProxyGeometryPlane {
        origin: image(centre, position_first),
        edge_first: position_first - position_second,
        edge_second: position_first - position_third,
    }
}

/// Returns the unit normal of a triangle; zero for a degenerate triangle.
pub fn face_normal(position_first: Vec3, position_second: Vec3, position_third: Vec3) -> Vec3 {
    let edge_first = position_second - position_first;
    let edge_second = position_third - position_second;
    let edge_third = position_first - position_third;
    let size_first = edge_first.x.abs().max(edge_first.y.abs()).max(edge_first.z.abs());
    let size_second = edge_second.x.abs().max(edge_second.y.abs()).max(edge_second.z.abs());
    let size_third = edge_third.x.abs().max(edge_third.y.abs()).max(edge_third.z.abs());
    // A subnormal divisor may be flushed to 0.
    if size_first.min(size_second).min(size_third) < 1.2e-38 {
        return Vec3::ZERO;
    }
    // The two edges that follow the longest one in cyclic order. The cross product of any two
    // consecutive edges is the same.
    let mut first = edge_first / size_first;
    let mut second = edge_second / size_second;
    if size_first >= size_second.max(size_third) {
        first = second;
        second = edge_third / size_third;
    } else if size_second >= size_third {
        second = first;
        first = edge_third / size_third;
    }
    let perpendicular = first.cross(second - first);
    let squared = perpendicular.dot(perpendicular);
    if squared < 1.2e-38 {
        return Vec3::ZERO;
    }
    perpendicular / squared.sqrt()
}

/// Computes the straightforward form of the normal: normalize(cross).
pub fn face_normal_naive(position_first: Vec3, position_second: Vec3, position_third: Vec3) -> Vec3 {
    (position_second - position_first).cross(position_third - position_first).normalize()
}

/// Intersects a ray with the plane through `plane_point` with unit normal `normal`.
pub fn intersect(position: Vec3, direction: Vec3, plane_point: Vec3, normal: Vec3) -> ProxyGeometryHit {
    let slope = normal.dot(direction);
    let height = normal.dot(plane_point - position);
    if slope.abs() <= PROXY_GEOMETRY_PARALLEL || height * slope.signum() <= 0.0 {
        return ProxyGeometryHit { point: position, distance: 0.0, hit: false };
    }
    let distance = height / slope;
    ProxyGeometryHit { point: position + distance * direction, distance, hit: true }
}

/// Computes the intersection without the special cases.
pub fn intersect_naive(position: Vec3, direction: Vec3, plane_point: Vec3, normal: Vec3) -> ProxyGeometryHit {
    let distance = normal.dot(plane_point - position) / normal.dot(direction);
    ProxyGeometryHit { point: position + distance * direction, distance, hit: true }
}

/// Returns the lattice coordinates of a point of plane P.
pub fn coordinates(point: Vec3, origin: Vec3, edge_first: Vec3, edge_second: Vec3) -> Vec2 {
    let extent = edge_first.abs().max(edge_second.abs());
    let size = extent.x.max(extent.y).max(extent.z);
    if size < 1.2e-38 {
        return Vec2::ZERO;
    }
    let offset = (point - origin) / size;
    let first = edge_first / size;
    let second = edge_second / size;
    let perpendicular = first.cross(second);
    let squared = perpendicular.dot(perpendicular);
    // 2^-36, the square of the limit that the WGSL states. If the two edges lie on one line,
    // rounding leaves less than this.
    if squared < 1.455_191_522_836_685_2e-11 {
        return Vec2::ZERO;
    }
    Vec2::new(offset.cross(second).dot(perpendicular), first.cross(offset).dot(perpendicular)) / squared
}

/// Computes the coordinates from the Gram matrix of the edges.
pub fn coordinates_naive(point: Vec3, origin: Vec3, edge_first: Vec3, edge_second: Vec3) -> Vec2 {
    let offset = point - origin;
    let first_first = edge_first.dot(edge_first);
    let first_second = edge_first.dot(edge_second);
    let second_second = edge_second.dot(edge_second);
    let offset_first = offset.dot(edge_first);
    let offset_second = offset.dot(edge_second);
    Vec2::new(
        second_second * offset_first - first_second * offset_second,
        first_first * offset_second - first_second * offset_first,
    ) / (first_first * second_second - first_second * first_second)
}

/// Returns the tile that contains a point of plane P.
pub fn cell(coordinates: Vec2) -> ProxyGeometryCell {
    let corner = coordinates.floor();
    let within = coordinates - corner;
    let short = (corner + 1.0) - coordinates;
    // within.x + within.y > 1, in two forms. Near a vertex a side of one form rounds to 1, and the
    // other form keeps its digits: the one with the smaller sides.
    let turned = if within.y + short.x < within.x + short.y { within.y > short.x } else { within.x > short.y };
    ProxyGeometryCell { steps: corner.as_ivec2(), turned }
}

/// Computes the tile from the sum of the fractions, the straightforward form.
pub fn cell_naive(coordinates: Vec2) -> ProxyGeometryCell {
    let corner = coordinates.floor();
    let within = coordinates - corner;
    ProxyGeometryCell { steps: corner.as_ivec2(), turned: within.x + within.y > 1.0 }
}

/// Returns the vertices of a tile, each computed from its own lattice position.
pub fn facet(plane: ProxyGeometryPlane, cell: ProxyGeometryCell) -> ProxyGeometryFacet {
    // The turned half starts at the far corner of the cell and runs backwards along both edges.
    let corner = cell.steps.as_vec2() + if cell.turned { 1.0 } else { 0.0 };
    let way = if cell.turned { -1.0 } else { 1.0 };
    ProxyGeometryFacet {
        vertex_first: plane.origin + corner.x * plane.edge_first + corner.y * plane.edge_second,
        vertex_second: plane.origin + (corner.x + way) * plane.edge_first + corner.y * plane.edge_second,
        vertex_third: plane.origin + corner.x * plane.edge_first + (corner.y + way) * plane.edge_second,
    }
}

/// Returns the normal of a tile, eq. (8) and (9), flipped if necessary to face the ray.
pub fn facet_normal(
    centre: Vec3,
    vertex_first: Vec3,
    vertex_second: Vec3,
    vertex_third: Vec3,
    direction: Vec3,
) -> Vec3 {
    let to_centre = centre - (vertex_first + vertex_second + vertex_third) / 3.0;
    let size = to_centre.x.abs().max(to_centre.y.abs()).max(to_centre.z.abs());
    if size < 1.2e-38 {
        return -direction;
    }
    let scaled = to_centre / size;
    let normal = scaled / scaled.dot(scaled).sqrt();
    if normal.dot(direction) > 0.0 { -normal } else { normal }
}

/// Computes eq. (8) and (9) exactly as written.
pub fn facet_normal_naive(centre: Vec3, vertex_first: Vec3, vertex_second: Vec3, vertex_third: Vec3) -> Vec3 {
    (centre - (vertex_first + vertex_second + vertex_third) / 3.0).normalize()
}

/// Returns the plane that a ray meets after reflection at a tile.
pub fn next_plane(centre: Vec3, facet: ProxyGeometryFacet) -> ProxyGeometryPlane {
    plane(centre, facet.vertex_first, facet.vertex_second, facet.vertex_third)
}
