// proxy_geometry: the inside of a gem guessed from the one triangle that a ray enters by.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash c6b01d35b00d68ae
// Source: Imagire, "Proxy Geometry Gem Rendering", section 4.2, eq. (8), (9), and its higher orders.
//
// The triangle is mirrored through the proxy's centre o: x' = 2 o - x. The image lies in a plane P, parallel to the
// triangle, and its translates tile P. A refracted ray meets P in one tile, whose facet normal points from the tile's centroid to o.

// A triangle's image through the centre: one tile of plane P, and the lattice of all tiles.
struct ProxyGeometryPlane {
    // Image of the triangle's first vertex.
    origin: vec3f,
    // From there to the image of the second vertex.
    edge_first: vec3f,
    // And to the image of the third.
    edge_second: vec3f,
}

struct ProxyGeometryHit {
    // Where the ray meets the plane; where it started, on a miss.
    point: vec3f,
    // Along the ray, in units of its direction's length; 0 on a miss.
    distance: f32,
    // False where the plane is behind the ray, through its start, or parallel to it.
    hit: bool,
}

// Which tile of plane P.
struct ProxyGeometryCell {
    // Whole lattice steps along the two edges.
    steps: vec2i,
    // Whether it is the cell's other half: the image turned by a half turn.
    turned: bool,
}

// One tile of plane P. Its vertices follow the orientation of the image: (first, second, third) as the triangle's.
struct ProxyGeometryFacet {
    vertex_first: vec3f,
    vertex_second: vec3f,
    vertex_third: vec3f,
}

// A ray nearer than this to parallel (the sine of its angle to the plane) misses. A dot product of unit vectors is off by
// up to 3 * 2^-24, so at 2^-20 the distance along the ray is known to a fifth; below, it is noise.
const PROXY_GEOMETRY_PARALLEL: f32 = 9.5367431640625e-7f;

// Image of a point through the centre of the proxy. The line from a vertex through the centre meets plane P exactly here,
// for every vertex, so no intersection is computed and none of the vertices is special.
// Returns: 2 centre - position.
// Units: lengths in, length out.
// Domain: any, up to 1e37.
// Outside: overflows beyond.
// Accuracy: lavapipe 1 ulp + 1 backward; portable 1 ulp + 1 backward
fn proxy_geometry_image(centre: vec3f, position: vec3f) -> vec3f {
    return 2.0f * centre - position;
}

// Plane P and its lattice from a triangle and the centre. The edges are differences of the vertices themselves: taken
// between images they would lose digits to a centre that is far away.
// Returns: ProxyGeometryPlane.
// Units: lengths in, lengths out.
// Domain: any, up to 1e37.
// Outside: overflows beyond.
// Accuracy: lavapipe origin 1 ulp + 1 backward, edge_first 0.5 ulp, edge_second 0.5 ulp; portable origin 1 ulp + 1 backward, edge_first 1 ulp, edge_second 1 ulp
fn proxy_geometry_plane(centre: vec3f, position_first: vec3f, position_second: vec3f, position_third: vec3f) -> ProxyGeometryPlane {
    return ProxyGeometryPlane(
        proxy_geometry_image(centre, position_first),
        position_first - position_second,
        position_first - position_third,
    );
}

// Unit normal of a triangle, counter-clockwise seen from where it points. The two shortest edges are crossed: each is as exact as
// its own ends, while two long ones that differ by a short third have lost it if their common end is far from the origin. They are
// scaled to size 1 first: their cross product and its square leave the range of f32 for triangles of size 1e-10 and of 1e10. It is their
// difference that is crossed, which is exact where they are nearly parallel, so that slivers keep their digits.
// Returns: unit normal; zero for a degenerate triangle, one whose edges' cross product has a square below 1.2e-38 once they are scaled.
// Units: lengths in, none out.
// Domain: edges in [1e-30, 1e30], sine of the angle between the two shortest at least 1e-6.
// Outside: finite; zero or ill-conditioned.
// Accuracy: lavapipe 5 ulp + 3 backward; portable 9 ulp + 6 backward
fn proxy_geometry_face_normal(position_first: vec3f, position_second: vec3f, position_third: vec3f) -> vec3f {
    let edge_first = position_second - position_first;
    let edge_second = position_third - position_second;
    let edge_third = position_first - position_third;
    let size_first = max(max(abs(edge_first.x), abs(edge_first.y)), abs(edge_first.z));
    let size_second = max(max(abs(edge_second.x), abs(edge_second.y)), abs(edge_second.z));
    let size_third = max(max(abs(edge_third.x), abs(edge_third.y)), abs(edge_third.z));
    // A subnormal may be flushed where it is divided by.
    if (min(min(size_first, size_second), size_third) < 1.2e-38f) {
        return vec3f(0.0f);
    }
    // The two edges in turn that follow the longest: the cross product of any two in turn is the same.
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

// Where a ray meets the plane through `plane_point` with unit normal `normal`. From a triangle with plane P at height h under
// it, entering along r this is t = 2 h / -(n . r). The sign of the normal does not matter.
// Returns: ProxyGeometryHit.
// Units: lengths; `direction` and `normal` are unit vectors.
// Domain: |direction| = |normal| = 1, positions up to 1e30.
// Outside: for positions beyond, overflows.
// Accuracy: lavapipe point 4 ulp + 4 backward, distance 6 ulp + 4 backward, hit 4 backward; portable point 8 ulp + 7 backward, distance 9 ulp + 7 backward, hit 7 backward
fn proxy_geometry_intersect(position: vec3f, direction: vec3f, plane_point: vec3f, normal: vec3f) -> ProxyGeometryHit {
    let slope = dot(normal, direction);
    let height = dot(normal, plane_point - position);
    if (abs(slope) <= PROXY_GEOMETRY_PARALLEL || height * sign(slope) <= 0.0f) {
        return ProxyGeometryHit(position, 0.0f, false);
    }
    let distance = height / slope;
    return ProxyGeometryHit(position + distance * direction, distance, true);
}

// Coordinates of a point of plane P on the lattice: point = origin + x edge_first + y edge_second. By cross products,
// which keep their digits on slivers, where the usual Gram determinant cancels; scaled to the longest edge against overflow.
// Returns: the two coordinates; zero for a degenerate triangle (|edge_first × edge_second| below 2^-18 of the longest edge squared).
// Units: lengths in, none out.
// Domain: size of the triangle in [1e-27, 1e27], distance of the point at most 100 of it, sine of the angle times the ratio of the edges at least 1e-4.
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
    // 2^-36, the square of the limit stated above: what rounding leaves of two edges that are one is less.
    if (squared < 1.4551915228366852e-11f) {
        return vec2f(0.0f);
    }
    return vec2f(dot(cross(offset, second), perpendicular), dot(cross(first, offset), perpendicular)) / squared;
}

// The tile that holds a point of plane P. A point on an edge or a vertex belongs to exactly one tile: cells are half open, and a
// cell's diagonal belongs to the half that is not turned.
// Returns: ProxyGeometryCell.
// Units: lattice coordinates, as proxy_geometry_coordinates gives them.
// Domain: coordinates up to 2^23, beyond which f32 has no halves.
// Outside: as the formula gives; cells beyond 2^31 are clamped to it.
// Accuracy: lavapipe steps 0 ulp, turned 1 backward; portable steps 0 ulp, turned 1 backward; order kept
fn proxy_geometry_cell(coordinates: vec2f) -> ProxyGeometryCell {
    let corner = floor(coordinates);
    let within = coordinates - corner;
    let short = (corner + 1.0f) - coordinates;
    // within.x + within.y > 1, twice: near a vertex one of the two sides rounds to 1, and the other way round keeps its digits: the one whose
    // sides are smaller.
    let turned = select(within.x > short.y, within.y > short.x, within.y + short.x < within.x + short.y);
    return ProxyGeometryCell(vec2i(corner), turned);
}

// The vertices of a tile, each from its own place on the lattice: no error adds up from tile to tile. Tiles share a vertex to the last bit where a device
// rounds equal expressions alike, and within the bounds below everywhere; nothing rests on more.
// Returns: ProxyGeometryFacet.
// Units: lengths.
// Domain: size of the triangle in [1e-27, 1e27], at most 100 steps.
// Outside: exact steps up to 2^24; overflows beyond 1e37.
// Accuracy: lavapipe vertex_first 2 ulp + 2 backward, vertex_second 2 ulp + 2 backward, vertex_third 2 ulp + 2 backward; portable vertex_first 3 ulp + 4 backward, vertex_second 3 ulp + 4 backward, vertex_third 3 ulp + 4 backward
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

// Normal of a tile, eq. (8) and (9): from its centroid to the centre of the proxy, turned so that it faces the ray.
// Scaled to size 1 before it is normalized, so that stones of size 1e-20 and of 1e19 keep theirs.
// Returns: unit normal with normal . direction <= 0; against the ray where centroid and centre coincide.
// Units: lengths in, none out; `direction` is a unit vector.
// Domain: |direction| = 1, distance between centroid and centre 0 or in [1e-30, 1e30].
// Outside: overflows beyond.
// Accuracy: lavapipe 6 ulp + 5 backward; portable 10 ulp + 7 backward; order kept
fn proxy_geometry_facet_normal(centre: vec3f, vertex_first: vec3f, vertex_second: vec3f, vertex_third: vec3f, direction: vec3f) -> vec3f {
    let to_centre = centre - (vertex_first + vertex_second + vertex_third) / 3.0f;
    let size = max(max(abs(to_centre.x), abs(to_centre.y)), abs(to_centre.z));
    if (size < 1.2e-38f) {
        return -direction;
    }
    let scaled = to_centre / size;
    let normal = scaled / sqrt(dot(scaled, scaled));
    return select(normal, -normal, dot(normal, direction) > 0.0f);
}

// The plane that a ray meets after it was reflected at a tile: the tile's image through the same centre, as the triangle's
// image made plane P. It lies parallel to P on the centre's other side.
// Returns: ProxyGeometryPlane.
// Units: lengths.
// Domain: any, up to 1e37.
// Outside: overflows beyond.
// Accuracy: lavapipe origin 1 ulp + 1 backward, edge_first 0.5 ulp, edge_second 0.5 ulp; portable origin 1 ulp + 1 backward, edge_first 1 ulp, edge_second 1 ulp
fn proxy_geometry_next_plane(centre: vec3f, facet: ProxyGeometryFacet) -> ProxyGeometryPlane {
    return proxy_geometry_plane(centre, facet.vertex_first, facet.vertex_second, facet.vertex_third);
}
