// voxelization: a closed mesh as voxels: where a triangle crosses a column, without leaks, and which voxels it touches.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia
//   2010 (parity along columns, conservative overlap); Akenine-Möller, "Fast 3D Triangle-Box
//   Overlap Testing", Journal of Graphics Tools 6(1), 2001 (separating axes).
//
// A grid has `cells` voxels along each edge. Grid coordinates are in voxels: voxel (i, j, k) is the
// cube from (i, j, k) to (i + 1, j + 1, k + 1), and its centre lies at + 1/2. A column is the line
// along x through the centres of the voxels (., j, k), at (j + 1/2, k + 1/2) in y and z.
//
// Whether a column meets a triangle is decided in integers, for each edge separately, on a lattice
// of 2^-14 voxels. Triangles that share an edge therefore agree about it on every device, and if
// each edge belongs to an even number of triangles, each column meets an even number of triangles.

// Lattice points along a voxel's edge.
const VOXELIZATION_LATTICE: f32 = 16384.0f;
// The extent of the lattice from the grid's origin, in voxels. It is chosen so that differences of
// lattice points are at most 2^29 steps.
const VOXELIZATION_REACH: f32 = 16384.0f;
// The margin by which a triangle is enlarged, relative to its largest coordinate or to a voxel,
// 2^-19. WGSL lets + - * round either way, so each has a relative error of up to e = 2^-23. A grid
// coordinate has an error of 3.5 e of itself (a difference, and 2.5 e of a division). A projection
// onto a separating axis has an error of 4 e times the corner's distance from the voxel, which is
// at most twice the largest coordinate, and 1 if both are near; the voxel's projected half size has
// an error of 3 e. The sums, 11.5 e and 7 e, are under 16 e.
const VOXELIZATION_MARGIN: f32 = 1.9073486328125e-6f;
// The steepest plane; steeper ones are cut off by the triangle's own extent, whatever the grid.
const VOXELIZATION_STEEPEST: f32 = 1048576.0f;

// A cube of voxels.
struct VoxelizationGrid {
    // The corner with the least coordinates, in world units.
    origin: vec3f,
    // A voxel's edge in world units.
    spacing: f32,
    // Voxels along each edge.
    cells: u32,
}

// An integer of more than 32 bits: high 2^30 + low.
struct VoxelizationInteger {
    high: i32,
    // From 0 to 2^30 - 1.
    low: i32,
}

// An edge as seen from a column.
struct VoxelizationEdge {
    // 1 if the edge runs counterclockwise about the column, with y to the right and z upwards; -1
    // if clockwise; 0 for an edge without length.
    turn: i32,
    // Twice the area of the triangle between the edge and the column, in squares of the lattice.
    area: f32,
}

// The crossing of a triangle and a column.
struct VoxelizationColumn {
    // True if they cross.
    inside: bool,
    // The x coordinate of the crossing; 0 if there is none.
    depth: f32,
}

// The index of a voxel, with x varying fastest.
// Returns: x + cells (y + cells z).
// Units: none.
// Domain: voxel below cells; cells up to 1024.
// Outside: the same, modulo 2^32.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_index(grid: VoxelizationGrid, voxel: vec3u) -> u32 {
    return voxel.x + grid.cells * (voxel.y + grid.cells * voxel.z);
}

// The centre of a voxel.
// Returns: origin + (voxel + 1/2) spacing.
// Units: world units.
// Domain: voxel below 2^22.
// Outside: finite as long as the centre is.
// Accuracy: lavapipe 1 ulp + 1 backward; portable 1 ulp + 2 backward
fn voxelization_centre(grid: VoxelizationGrid, voxel: vec3u) -> vec3f {
    return grid.origin + (vec3f(voxel) + 0.5f) * grid.spacing;
}

// A position in grid coordinates.
// Returns: (position - origin) / spacing.
// Units: voxels; position in world units.
// Domain: spacing above 0, quotient finite.
// Outside: infinite or a NaN.
// Accuracy: lavapipe 2 ulp; portable 5 ulp
fn voxelization_local(grid: VoxelizationGrid, position: vec3f) -> vec3f {
    return (position - grid.origin) / grid.spacing;
}

// The voxel that contains a position, or the nearest one.
// Returns: coordinates of a voxel, from 0 to cells - 1.
// Units: none; position in world units.
// Domain: spacing above 0, cells at least 1; any position.
// Outside: a voxel of the grid.
// Accuracy: lavapipe 2 backward; portable 4 backward
fn voxelization_voxel(grid: VoxelizationGrid, position: vec3f) -> vec3u {
    let last = grid.cells - 1u;
    return min(vec3u(clamp(voxelization_local(grid, position), vec3f(0.0f), vec3f(f32(last)))), vec3u(last));
}

// The nearest point of the lattice on which inside and outside are decided. Multiplication by a
// power of two and rounding to whole numbers are exact, so a position maps to the same point on
// every device.
// Returns: 2^14 position, rounded to whole numbers, with halves rounded to even.
// Units: steps of the lattice; position in voxels.
// Domain: coordinates up to 16384.
// Outside: the lattice's last point, on the position's side.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_lattice(position: vec2f) -> vec2i {
    let within = clamp(position, vec2f(-VOXELIZATION_REACH), vec2f(VOXELIZATION_REACH));
    return vec2i(round(within * VOXELIZATION_LATTICE));
}

// The cross product of two integer vectors, with all of its bits. In halves of 15 bits no sum of
// products exceeds 32 bits.
// Returns: p.x q.y - p.y q.x.
// Units: none.
// Domain: components up to 2^29.
// Outside: any number, with low from 0 to 2^30 - 1.
// Accuracy: lavapipe high 0 ulp, low 0 ulp; portable high 0 ulp, low 0 ulp
fn voxelization_cross(p: vec2i, q: vec2i) -> VoxelizationInteger {
    let p_high = p >> vec2u(15u);
    let q_high = q >> vec2u(15u);
    let p_low = p & vec2i(32767i);
    let q_low = q & vec2i(32767i);
    let low = p_low.x * q_low.y - p_low.y * q_low.x;
    let middle = (p_high.x * q_low.y - p_high.y * q_low.x) + (p_low.x * q_high.y - p_low.y * q_high.x) + (low >> 15u);
    let high = p_high.x * q_high.y - p_high.y * q_high.x + (middle >> 15u);
    return VoxelizationInteger(high, ((middle & 32767i) << 15u) | (low & 32767i));
}

// An edge as seen from a column. A column on the edge's line counts as a little higher in z, and in
// y by less than that. So it never lies on the line of an edge, and an edge with its ends exchanged
// turns the other way.
// Returns: VoxelizationEdge.
// Units: `from_point` and `to_point` in steps of the lattice, relative to the column.
// Domain: components up to 2^29, and their differences.
// Outside: turn from -1 to 1, area from 0 to 2^62.
// Accuracy: lavapipe turn 0 ulp, area 2 ulp; portable turn 0 ulp, area 4 ulp
fn voxelization_edge(from_point: vec2i, to_point: vec2i) -> VoxelizationEdge {
    let area = voxelization_cross(from_point, to_point);
    let way = to_point - from_point;
    let turn_beside = select(sign(way.x), -sign(way.y), way.x == 0i);
    let turn = select(sign(area.high), select(turn_beside, 1i, area.low > 0i), area.high == 0i);
    // The magnitude: with the sign, a small difference of two large parts would lose its digits.
    let high = select(area.high, -1i - area.high, area.high < 0i);
    let low = select(area.low, 1073741824i - area.low, area.high < 0i);
    return VoxelizationEdge(turn, f32(high) * 1073741824.0f + f32(low));
}

// The crossing of a triangle and a column, which exists if all three edges turn about the column
// the same way. The decision is exact for the corners and the column moved to their nearest lattice
// points, by at most 2^-15 voxels in y and in z. No shared edge is counted twice or missed, on any
// device. A triangle without area on the lattice is never crossed, so no sum of weights is 0.
// Returns: VoxelizationColumn; `depth` within the triangle's extent.
// Units: voxels; `column` is y and z of the column.
// Domain: y and z up to 16384, x up to 1e18.
// Outside: inside as for the lattice's last points.
// Accuracy: lavapipe inside 0 ulp, depth 2 ulp + 4 backward; portable inside 0 ulp, depth 4 ulp + 12 backward
fn voxelization_column(a: vec3f, b: vec3f, c: vec3f, column: vec2f) -> VoxelizationColumn {
    let at = voxelization_lattice(column);
    let p = voxelization_lattice(a.yz) - at;
    let q = voxelization_lattice(b.yz) - at;
    let r = voxelization_lattice(c.yz) - at;
    let ab = voxelization_edge(p, q);
    let bc = voxelization_edge(q, r);
    let ca = voxelization_edge(r, p);
    if ab.turn == 0i || ab.turn != bc.turn || bc.turn != ca.turn {
        return VoxelizationColumn(false, 0.0f);
    }
    // Each corner's weight is the area of the opposite edge.
    let weights = vec3f(bc.area, ca.area, ab.area);
    let depth = dot(weights, vec3f(a.x, b.x, c.x)) / (weights.x + weights.y + weights.z);
    return VoxelizationColumn(true, clamp(depth, min(a.x, min(b.x, c.x)), max(a.x, max(b.x, c.x))));
}

// The first voxel of a row whose centre lies at or beyond a coordinate.
// Returns: the voxel's number, or `cells` if there is none.
// Units: coordinate in voxels.
// Domain: any coordinate; cells up to 2^22.
// Outside: nothing; from 0 to cells for any input.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_first(coordinate: f32, cells: u32) -> u32 {
    // Clamped first, because subtracting the half could overflow for a huge coordinate.
    let near = clamp(coordinate, 0.0f, f32(cells));
    return min(u32(ceil(near - 0.5f)), cells);
}

// The running parity of bits, from the least on: it turns the crossings of a surface into the
// inside.
// Returns: bit i is the parity of bits 0 to i.
// Units: none.
// Domain: any bits.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_prefix(bits: u32) -> u32 {
    let two = bits ^ (bits << 1u);
    let four = two ^ (two << 2u);
    let eight = four ^ (four << 4u);
    let sixteen = eight ^ (eight << 8u);
    return sixteen ^ (sixteen << 16u);
}

// The taxicab length of a vector: the reach of a cube of half size 1 along the vector, times the
// vector's length.
// Returns: |x| + |y| + |z|.
// Units: those of the vector.
// Domain: sum below 3e38.
// Outside: infinite or a NaN.
// Accuracy: lavapipe 2 ulp; portable 2 ulp
fn voxelization_taxicab(vector: vec3f) -> f32 {
    let size = abs(vector);
    return size.x + size.y + size.z;
}

// The margin around a triangle within which it counts as touching voxels, so that rounding misses
// none.
// Returns: 2^-19 (1 + the largest coordinate).
// Units: voxels.
// Domain: coordinates up to 1e30.
// Outside: infinite or a NaN.
// Accuracy: lavapipe 1 ulp; portable 1 ulp
fn voxelization_margin(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    let largest = max(abs(a), max(abs(b), abs(c)));
    return VOXELIZATION_MARGIN * (1.0f + max(largest.x, max(largest.y, largest.z)));
}

// The voxels of a row that an interval meets.
// Returns: the first of them, and the one after the last; the same number twice if there are none.
// Units: low and high in voxels.
// Domain: low <= high, of any size; cells up to 2^22.
// Outside: no voxel for low > high + 1; from 0 to cells for any input.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_range(low: f32, high: f32, cells: u32) -> vec2u {
    let most = f32(cells);
    let end = min(u32(clamp(floor(high) + 1.0f, 0.0f, most)), cells);
    return vec2u(min(u32(clamp(low, 0.0f, most)), end), end);
}

// The interval along x in which a triangle's plane passes over the square of a column, `corner` to `corner` + 1
// in y and z, cut off by the triangle's own extent. Every voxel that voxelization_overlaps finds meets it.
// Returns: low and high; low > high if the plane misses the extent.
// Units: voxels.
// Domain: coordinates up to 1e9.
// Outside: finite for coordinates from 1e-6 to 1e11, or 0.
// Accuracy: lavapipe 4 ulp + 1.2e-5 abs + 16 backward; portable 8 ulp + 5.4e-5 abs + 32 backward
fn voxelization_span(a: vec3f, b: vec3f, c: vec3f, corner: vec2f) -> vec2f {
    let margin = voxelization_margin(a, b, c);
    let extent = vec2f(min(a.x, min(b.x, c.x)) - margin, max(a.x, max(b.x, c.x)) + margin);
    let ab = b - a;
    let ac = c - a;
    let normal = cross(ab, ac);
    let slack = margin * voxelization_taxicab(ab) * voxelization_taxicab(ac);
    let width = (0.5f + margin) * (abs(normal.y) + abs(normal.z)) + slack;
    let slope = abs(normal.x);
    if slope * VOXELIZATION_STEEPEST <= width {
        return extent;
    }
    let middle = a.x - dot(normal.yz, (corner + 0.5f) - a.yz) / normal.x;
    // The rounding error of a quotient is proportional to it, hence the factor.
    let half = (1.0f + VOXELIZATION_MARGIN) * width / slope + margin;
    return vec2f(max(extent.x, middle - half), min(extent.y, middle + half));
}

// Whether a triangle touches a voxel, its faces, edges and corners included, or comes within the margin of it.
// Separating axes: the voxel's, the triangle's normal, and the cross products of voxel's axes and triangle's edges.
// Returns: never false if they touch; true only if they are within a few margins of each other, or for
//   a thin triangle within its thickness.
// Units: voxels; `corner` is the voxel's corner with the least coordinates.
// Domain: coordinates up to 1e9. The accuracy is for triangles at least 1/8 as thick as long, and large
//   enough for f32 to resolve at their distance from the origin.
// Outside: as long as products of three coordinates are finite.
// Accuracy: lavapipe 128 backward; portable 128 backward
fn voxelization_overlaps(a: vec3f, b: vec3f, c: vec3f, corner: vec3f) -> bool {
    let margin = voxelization_margin(a, b, c);
    let half = 0.5f + margin;
    let centre = corner + 0.5f;
    let p = a - centre;
    let q = b - centre;
    let r = c - centre;
    if any(min(p, min(q, r)) > vec3f(half)) || any(max(p, max(q, r)) < vec3f(-half)) {
        return false;
    }
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    // Component i of edge x corner is the corner's projection onto axis i x edge; both ends of the
    // edge have the same projection.
    let ab_p = cross(ab, p);
    let ab_r = cross(ab, r);
    let bc_q = cross(bc, q);
    let bc_p = cross(bc, p);
    let ca_r = cross(ca, r);
    let ca_q = cross(ca, q);
    let ab_half = half * (abs(ab).yzx + abs(ab).zxy);
    let bc_half = half * (abs(bc).yzx + abs(bc).zxy);
    let ca_half = half * (abs(ca).yzx + abs(ca).zxy);
    if any(min(ab_p, ab_r) > ab_half) || any(max(ab_p, ab_r) < -ab_half)
        || any(min(bc_q, bc_p) > bc_half) || any(max(bc_q, bc_p) < -bc_half)
        || any(min(ca_r, ca_q) > ca_half) || any(max(ca_r, ca_q) < -ca_half) {
        return false;
    }
    // The normal of a thin triangle is mostly rounding error, in proportion to the lengths of its
    // edges.
    let normal = cross(ab, ca);
    let slack = margin * voxelization_taxicab(ab) * voxelization_taxicab(ca);
    return abs(dot(normal, p)) <= half * voxelization_taxicab(normal) + slack;
}
