//! Mirror of `wgsl/proxy_geometry.wgsl`: the inside of a gem guessed from the one triangle that a ray enters by. Imagire,
//! "Proxy Geometry Gem Rendering", section 4.2, eq. (8), (9).
//!
//! The WGSL file states units, domain and accuracy of each function; this file reads line by line like it.
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

/// A triangle's image through the centre: one tile of plane P, and the lattice of all tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryPlane {
    /// Image of the triangle's first vertex.
    pub origin: Vec3,
    /// From there to the image of the second vertex.
    pub edge_first: Vec3,
    /// And to the image of the third.
    pub edge_second: Vec3,
}

/// Where a ray meets a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryHit {
    /// Where the ray meets the plane; where it started, on a miss.
    pub point: Vec3,
    /// Along the ray, in units of its direction's length; 0 on a miss.
    pub distance: f32,
    /// False where the plane is behind the ray, through its start, or parallel to it.
    pub hit: bool,
}

/// Which tile of plane P.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProxyGeometryCell {
    /// Whole lattice steps along the two edges.
    pub steps: IVec2,
    /// Whether it is the cell's other half: the image turned by a half turn.
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

/// A ray nearer than this to parallel (the sine of its angle to the plane) misses.
pub const PROXY_GEOMETRY_PARALLEL: f32 = 9.536_743_164_062_5e-7;

/// Image of a point through the centre of the proxy.
pub fn image(centre: Vec3, position: Vec3) -> Vec3 {
    2.0 * centre - position
}

/// Plane P and its lattice from a triangle and the centre.
pub fn plane(centre: Vec3, position_first: Vec3, position_second: Vec3, position_third: Vec3) -> ProxyGeometryPlane {
    ProxyGeometryPlane {
        origin: image(centre, position_first),
        edge_first: position_first - position_second,
        edge_second: position_first - position_third,
    }
}

/// Unit normal of a triangle, zero for a degenerate one.
pub fn face_normal(position_first: Vec3, position_second: Vec3, position_third: Vec3) -> Vec3 {
    let edge_first = position_second - position_first;
    let edge_second = position_third - position_second;
    let edge_third = position_first - position_third;
    let size_first = edge_first.x.abs().max(edge_first.y.abs()).max(edge_first.z.abs());
    let size_second = edge_second.x.abs().max(edge_second.y.abs()).max(edge_second.z.abs());
    let size_third = edge_third.x.abs().max(edge_third.y.abs()).max(edge_third.z.abs());
    // A subnormal may be flushed where it is divided by.
    if size_first.min(size_second).min(size_third) < 1.2e-38 {
        return Vec3::ZERO;
    }
    // The two edges in turn that follow the longest: the cross product of any two in turn is the same.
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

/// The normal as one writes it.
pub fn face_normal_naive(position_first: Vec3, position_second: Vec3, position_third: Vec3) -> Vec3 {
    (position_second - position_first).cross(position_third - position_first).normalize()
}

/// Where a ray meets the plane through `plane_point` with unit normal `normal`.
pub fn intersect(position: Vec3, direction: Vec3, plane_point: Vec3, normal: Vec3) -> ProxyGeometryHit {
    let slope = normal.dot(direction);
    let height = normal.dot(plane_point - position);
    if slope.abs() <= PROXY_GEOMETRY_PARALLEL || height * slope.signum() <= 0.0 {
        return ProxyGeometryHit { point: position, distance: 0.0, hit: false };
    }
    let distance = height / slope;
    ProxyGeometryHit { point: position + distance * direction, distance, hit: true }
}

/// The intersection without its cases.
pub fn intersect_naive(position: Vec3, direction: Vec3, plane_point: Vec3, normal: Vec3) -> ProxyGeometryHit {
    let distance = normal.dot(plane_point - position) / normal.dot(direction);
    ProxyGeometryHit { point: position + distance * direction, distance, hit: true }
}

/// Coordinates of a point of plane P on the lattice.
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
    // 2^-36, the square of the limit stated above: what rounding leaves of two edges that are one is less.
    if squared < 1.455_191_522_836_685_2e-11 {
        return Vec2::ZERO;
    }
    Vec2::new(offset.cross(second).dot(perpendicular), first.cross(offset).dot(perpendicular)) / squared
}

/// The coordinates by the Gram matrix of the edges.
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

/// The tile that holds a point of plane P.
pub fn cell(coordinates: Vec2) -> ProxyGeometryCell {
    let corner = coordinates.floor();
    let within = coordinates - corner;
    let short = (corner + 1.0) - coordinates;
    // within.x + within.y > 1, twice: near a vertex one of the two sides rounds to 1, and the other way round keeps its digits: the one whose
    // sides are smaller.
    let turned = if within.y + short.x < within.x + short.y { within.y > short.x } else { within.x > short.y };
    ProxyGeometryCell { steps: corner.as_ivec2(), turned }
}

/// The tile by the sum of the fractions, as one writes it.
pub fn cell_naive(coordinates: Vec2) -> ProxyGeometryCell {
    let corner = coordinates.floor();
    let within = coordinates - corner;
    ProxyGeometryCell { steps: corner.as_ivec2(), turned: within.x + within.y > 1.0 }
}

/// The vertices of a tile, each from its own place on the lattice.
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

/// Normal of a tile, eq. (8) and (9), turned so that it faces the ray.
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

/// Eq. (8) and (9) as they stand.
pub fn facet_normal_naive(centre: Vec3, vertex_first: Vec3, vertex_second: Vec3, vertex_third: Vec3) -> Vec3 {
    (centre - (vertex_first + vertex_second + vertex_third) / 3.0).normalize()
}

/// The plane that a ray meets after it was reflected at a tile.
pub fn next_plane(centre: Vec3, facet: ProxyGeometryFacet) -> ProxyGeometryPlane {
    plane(centre, facet.vertex_first, facet.vertex_second, facet.vertex_third)
}
