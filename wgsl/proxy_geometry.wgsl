// proxy_geometry: the inside of a gem guessed from the one triangle that a ray enters by.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", section 4.2, eq. (8), (9), and its higher
//   orders.
//
// The triangle is mirrored through the proxy's centre o: x' = 2 o - x. The image lies in a plane P
// parallel to the triangle. Its translates, and those of the image rotated by half a turn, tile P.
// A refracted ray meets P in one tile, whose facet normal points from the centroid of the tile to
// o.

// The image of a triangle through the centre: one tile of plane P, and the lattice of all tiles.
struct ProxyGeometryPlane {
    // Image of the triangle's first vertex.
    origin: vec3f,
    // Edge from `origin` to the image of the second vertex.
    edge_first: vec3f,
    // Edge from `origin` to the image of the third vertex.
    edge_second: vec3f,
}

struct ProxyGeometryHit {
    // Intersection of the ray with the plane; on a miss, the start of the ray.
    point: vec3f,
    // Distance along the ray, in units of its direction's length; 0 on a miss.
    distance: f32,
    // False if the plane is behind the ray, passes through its start, or is parallel to it.
    hit: bool,
}

// Position of a tile in the lattice of plane P.
struct ProxyGeometryCell {
    // Whole lattice steps along the two edges.
    steps: vec2i,
    // True for the other half of the cell: the image rotated by half a turn.
    turned: bool,
}

// One tile of plane P. Its vertices keep the orientation of the image: (first, second, third) as in
// the triangle.
struct ProxyGeometryFacet {
    vertex_first: vec3f,
    vertex_second: vec3f,
    vertex_third: vec3f,
}

// Sine of the angle between ray and plane up to which the ray counts as parallel and misses. A dot
// product of unit vectors is off by up to 3 * 2^-24, so at 2^-20 the distance along the ray is
// known to within a fifth; below that, it is noise.
const PROXY_GEOMETRY_PARALLEL: f32 = 9.5367431640625e-7f;

// Image of a point through the centre of the proxy. For every vertex, the line from the vertex
// through the centre meets plane P exactly here, so no intersection is needed and no vertex is
// special.
// Returns: 2 centre - position.
// Units: lengths in, length out.
// Domain: any, up to 1e37.
// Outside: overflows beyond.
// Accuracy: lavapipe 1 ulp + 1 backward; portable 1 ulp + 1 backward
fn proxy_geometry_image(centre: vec3f, position: vec3f) -> vec3f {
    return 2.0f * centre - position;
}

// Plane P and its lattice, from a triangle and the centre. The edges are differences of the
// vertices themselves; differences of the images would lose digits to a distant centre.
// Returns: ProxyGeometryPlane.
// Units: lengths in, lengths out.
// Domain: any, up to 1e37.
// Outside: overflows beyond.
// Accuracy: lavapipe origin 1 ulp + 1 backward, edge_first 0.5 ulp, edge_second 0.5 ulp;
//   portable origin 1 ulp + 1 backward, edge_first 1 ulp, edge_second 1 ulp
fn proxy_geometry_plane(
    centre: vec3f, position_first: vec3f, position_second: vec3f, position_third: vec3f
) -> ProxyGeometryPlane {
    return ProxyGeometryPlane(
        proxy_geometry_image(centre, position_first),
        position_first - position_second,
        position_first - position_third,
    );
}

// Unit normal of a triangle, to the side from which its vertices run counter-clockwise: the cross
// product of the two shortest edges, scaled to size 1. One is crossed with the difference of the two,
// which is exact if they are nearly parallel.
// Returns: unit normal; zero for a degenerate triangle, where the scaled edges' cross product has a
//   square below 1.2e-38.
// Units: lengths in, none out.
// Domain: edges in [1e-30, 1e30], sine of the angle between the two shortest edges at least 1e-6.
// Outside: finite; zero or ill-conditioned.
// Accuracy: lavapipe 5 ulp + 3 backward; portable 9 ulp + 6 backward
fn proxy_geometry_face_normal(position_first: vec3f, position_second: vec3f, position_third: vec3f) -> vec3f {
    let edge_first = position_second - position_first;
    let edge_second = position_third - position_second;
    let edge_third = position_first - position_third;
    let size_first = max(max(abs(edge_first.x), abs(edge_first.y)), abs(edge_first.z));
    let size_second = max(max(abs(edge_second.x), abs(edge_second.y)), abs(edge_second.z));
    let size_third = max(max(abs(edge_third.x), abs(edge_third.y)), abs(edge_third.z));
    // A subnormal divisor may be flushed to 0.
    if (min(min(size_first, size_second), size_third) < 1.2e-38f) {
        return vec3f(0.0f);
    }
    // The two edges that follow the longest one in cyclic order. The cross product of any two
    // consecutive edges is the same.
    var first = edge_first / size_first;
    var second = edge_second / size_second;
    if (size_first >= max(size_second, size_third)) {
        first = second;
        second = edge_third / size_third;
    } else if (size_second >= size_third) {
        second = first;
        first = edge_third / size_third;
    }
    let perpendicular = cross(first, second - first);
    let squared = dot(perpendicular, perpendicular);
    if (squared < 1.2e-38f) {
        return vec3f(0.0f);
    }
    return perpendicular / sqrt(squared);
}

// Intersection of a ray with the plane through `plane_point` with unit normal `normal`. For a ray
// that enters along r through a triangle with the proxy's centre at depth h, the distance to
// plane P is t = 2 h / -(n . r). The sign of the normal does not matter.
// Returns: ProxyGeometryHit.
// Units: lengths; `direction` and `normal` are unit vectors.
// Domain: |direction| = |normal| = 1, positions up to 1e30.
// Outside: for positions beyond, overflows.
// Accuracy: lavapipe point 4 ulp + 4 backward, distance 6 ulp + 4 backward, hit 4 backward;
//   portable point 8 ulp + 7 backward, distance 9 ulp + 7 backward, hit 7 backward
fn proxy_geometry_intersect(position: vec3f, direction: vec3f, plane_point: vec3f, normal: vec3f) -> ProxyGeometryHit {
    let slope = dot(normal, direction);
    let height = dot(normal, plane_point - position);
    if (abs(slope) <= PROXY_GEOMETRY_PARALLEL || height * sign(slope) <= 0.0f) {
        return ProxyGeometryHit(position, 0.0f, false);
    }
    let distance = height / slope;
    return ProxyGeometryHit(position + distance * direction, distance, true);
}

// Lattice coordinates of a point of plane P: point = origin + x edge_first + y edge_second. They come
// from cross products, which keep their digits on slivers, scaled by the longest edge.
// Returns: the two coordinates; zero for a degenerate triangle (|edge_first × edge_second| below 2^-18
//   of the longest edge squared).
// Units: lengths in, none out.
// Domain: size of the triangle in [1e-27, 1e27], distance of the point at most 100 times that size,
//   sine of the angle times the ratio of the edges at least 1e-4.
// Outside: finite; ill-conditioned.
// Accuracy: lavapipe 8 ulp + 3 backward; portable 16 ulp + 5.5 backward
fn proxy_geometry_coordinates(point: vec3f, origin: vec3f, edge_first: vec3f, edge_second: vec3f) -> vec2f {
    let extent = max(abs(edge_first), abs(edge_second));
    let size = max(max(extent.x, extent.y), extent.z);
    if (size < 1.2e-38f) {
        return vec2f(0.0f);
    }
    let offset = (point - origin) / size;
    let first = edge_first / size;
    let second = edge_second / size;
    let perpendicular = cross(first, second);
    let squared = dot(perpendicular, perpendicular);
    // 2^-36, the square of the limit stated above. If the two edges lie on one line, rounding
    // leaves less than this.
    if (squared < 1.4551915228366852e-11f) {
        return vec2f(0.0f);
    }
    return vec2f(dot(cross(offset, second), perpendicular), dot(cross(first, offset), perpendicular)) / squared;
}

// The tile that contains a point of plane P. A point on an edge or a vertex belongs to exactly one
// tile: cells are half open, and the diagonal of a cell belongs to the half that is not turned.
// Returns: ProxyGeometryCell.
// Units: lattice coordinates, as returned by proxy_geometry_coordinates.
// Domain: coordinates up to 2^23, beyond which f32 has no halves.
// Outside: as the formula gives; cells beyond 2^31 are clamped to it.
// Accuracy: lavapipe steps 0 ulp, turned 1 backward; portable steps 0 ulp, turned 1 backward; order kept
fn proxy_geometry_cell(coordinates: vec2f) -> ProxyGeometryCell {
    let corner = floor(coordinates);
    let within = coordinates - corner;
    let short = (corner + 1.0f) - coordinates;
    // within.x + within.y > 1, in two forms. Near a vertex a side of one form rounds to 1, and the
    // other form keeps its digits: the one with the smaller sides.
    let turned = select(within.x > short.y, within.y > short.x, within.y + short.x < within.x + short.y);
    return ProxyGeometryCell(vec2i(corner), turned);
}

// The vertices of a tile, each from its own lattice position, so no error accumulates. Tiles share a vertex to
// the last bit if the device rounds equal expressions alike, else within the bounds; nothing relies on more.
// Returns: ProxyGeometryFacet.
// Units: lengths.
// Domain: size of the triangle in [1e-27, 1e27], at most 100 steps.
// Outside: exact steps up to 2^24; overflows beyond 1e37.
// Accuracy: lavapipe vertex_first 2 ulp + 2 backward, vertex_second 2 ulp + 2 backward,
//   vertex_third 2 ulp + 2 backward;
//   portable vertex_first 3 ulp + 4 backward, vertex_second 3 ulp + 4 backward, vertex_third 3 ulp + 4 backward
fn proxy_geometry_facet(plane: ProxyGeometryPlane, cell: ProxyGeometryCell) -> ProxyGeometryFacet {
    // The turned half starts at the far corner of the cell and runs backwards along both edges.
    let corner = vec2f(cell.steps) + select(0.0f, 1.0f, cell.turned);
    let way = select(1.0f, -1.0f, cell.turned);
    return ProxyGeometryFacet(
        plane.origin + corner.x * plane.edge_first + corner.y * plane.edge_second,
        plane.origin + (corner.x + way) * plane.edge_first + corner.y * plane.edge_second,
        plane.origin + corner.x * plane.edge_first + (corner.y + way) * plane.edge_second,
    );
}

// Normal of a tile, eq. (8) and (9): it points from the centroid of the tile to the centre of the
// proxy, and is flipped if necessary to face the ray. The vector is scaled to size 1 before it is
// normalised, so stones of size 1e-20 and of 1e19 keep their normals.
// Returns: unit normal with normal . direction <= 0; -direction if centroid and centre coincide.
// Units: lengths in, none out; `direction` is a unit vector.
// Domain: |direction| = 1, distance between centroid and centre 0 or in [1e-30, 1e30].
// Outside: overflows beyond.
// Accuracy: lavapipe 6 ulp + 5 backward; portable 10 ulp + 7 backward; order kept
fn proxy_geometry_facet_normal(
    centre: vec3f, vertex_first: vec3f, vertex_second: vec3f, vertex_third: vec3f, direction: vec3f
) -> vec3f {
    let to_centre = centre - (vertex_first + vertex_second + vertex_third) / 3.0f;
    let size = max(max(abs(to_centre.x), abs(to_centre.y)), abs(to_centre.z));
    if (size < 1.2e-38f) {
        return -direction;
    }
    let scaled = to_centre / size;
    let normal = scaled / sqrt(dot(scaled, scaled));
    return select(normal, -normal, dot(normal, direction) > 0.0f);
}

// The plane that a ray meets after reflection at a tile: the image of the tile through the same
// centre, just as the image of the triangle spans plane P. It is parallel to P, on the other side
// of the centre.
// Returns: ProxyGeometryPlane.
// Units: lengths.
// Domain: any, up to 1e37.
// Outside: overflows beyond.
// Accuracy: lavapipe origin 1 ulp + 1 backward, edge_first 0.5 ulp, edge_second 0.5 ulp;
//   portable origin 1 ulp + 1 backward, edge_first 1 ulp, edge_second 1 ulp
fn proxy_geometry_next_plane(centre: vec3f, facet: ProxyGeometryFacet) -> ProxyGeometryPlane {
    return proxy_geometry_plane(centre, facet.vertex_first, facet.vertex_second, facet.vertex_third);
}
