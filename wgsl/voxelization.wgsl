// voxelization: a closed triangle mesh as voxels: where a triangle crosses a column of voxel centres, without leaks, and which voxels it touches.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash 3e9e0cc921c21ce5
// Source: Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia 2010 (parity along columns, conservative
//   overlap); Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", Journal of Graphics Tools 6(1), 2001 (separating axes).
//
// A grid has `cells` voxels along each edge. Its own coordinates count voxels: voxel (i, j, k) is the cube from (i, j, k) to (i + 1, j + 1,
// k + 1), and its centre lies at + 1/2. A column is the line along x through the centres of the voxels (., j, k); it has the place (j + 1/2,
// k + 1/2) in y and z.
//
// Every comparison that decides whether a column meets a triangle is made for an edge alone, with its ends in one order. So the triangles that
// share an edge agree about it, however it is rounded; and where each edge belongs to an even number of triangles, each column meets an even
// number of triangles.

// How far a triangle reaches beyond itself, relative to its largest coordinate or to a voxel, 2^-19. With e = 2^-23, by which WGSL lets + - * be
// off, since it lets them round either way: a grid coordinate is off by 3.5 e of itself (a difference, and 2.5 e of a division); a projection
// onto a separating axis by 4 e times the corner's distance from the voxel, which is at most twice the largest coordinate and 1 where both are
// near; its half size by 3 e. The sum, 11.5 e and 7 e, is under 16 e.
const VOXELIZATION_MARGIN: f32 = 1.9073486328125e-6f;
// Steeper planes than this are cut off by the triangle's own extent, whatever the grid.
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

// Where an edge crosses a plane across y.
struct VoxelizationCrossing {
    // Whether it does.
    crossed: bool,
    // x and z of the place; 0 where there is none.
    at: vec2f,
}

// Where a triangle crosses a column.
struct VoxelizationColumn {
    // Whether it does.
    inside: bool,
    // x of the place; 0 where there is none.
    depth: f32,
}

// The number of a voxel, x running fastest.
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

// A position in the grid's own coordinates.
// Returns: (position - origin) / spacing.
// Units: voxels; position in world units.
// Domain: spacing above 0, quotient finite.
// Outside: infinite or a NaN.
// Accuracy: lavapipe 2 ulp; portable 5 ulp
fn voxelization_local(grid: VoxelizationGrid, position: vec3f) -> vec3f {
    return (position - grid.origin) / grid.spacing;
}

// The voxel that holds a position, or the nearest one.
// Returns: coordinates of a voxel, from 0 to cells - 1.
// Units: none; position in world units.
// Domain: spacing above 0, cells at least 1; any position.
// Outside: some voxel of the grid.
// Accuracy: lavapipe 2 backward; portable 4 backward
fn voxelization_voxel(grid: VoxelizationGrid, position: vec3f) -> vec3u {
    let last = grid.cells - 1u;
    return min(vec3u(clamp(voxelization_local(grid, position), vec3f(0.0f), vec3f(f32(last)))), vec3u(last));
}

// The point that divides a line at two distances. It is found from the nearer end, and is that end where the distance is 0.
// Returns: (after from + before to) / (before + after), within the box of `from` and `to`.
// Units: those of `from` and `to`; before and after in any one unit.
// Domain: before >= 0, after > 0, their sum at least 1.2e-38; products below 1e38.
// Outside: within the box for a smaller sum too.
// Accuracy: lavapipe 1 ulp + 2 backward; portable 3 ulp + 4 backward
fn voxelization_between(from_point: vec2f, to_point: vec2f, before: f32, after: f32) -> vec2f {
    // A subnormal may be flushed where it is divided by.
    let share = min(before, after) / max(before + after, 1.2e-38f);
    let near = select(to_point, from_point, before < after);
    let far = select(from_point, to_point, before < after);
    return clamp(near + share * (far - near), min(near, far), max(near, far));
}

// Where an edge crosses the plane of a row of columns. The lower end belongs to the edge and the upper does not, so that of two edges that meet
// at a vertex one is crossed where they go on, and both or none where they turn round. Which end is named first makes no difference.
// Returns: VoxelizationCrossing; `at` within the edge's box.
// Units: any one length.
// Domain: coordinates up to 1e18.
// Outside: crossed as the comparisons say.
// Accuracy: lavapipe crossed 0 ulp, at 1 ulp + 4 backward; portable crossed 0 ulp, at 3 ulp + 6 backward
fn voxelization_crossing(a: vec3f, b: vec3f, y: f32) -> VoxelizationCrossing {
    let swapped = b.y < a.y;
    let lower = select(a, b, swapped);
    let upper = select(b, a, swapped);
    if lower.y <= y && y < upper.y {
        return VoxelizationCrossing(true, voxelization_between(lower.xz, upper.xz, y - lower.y, upper.y - y));
    }
    return VoxelizationCrossing(false, vec2f(0.0f));
}

// Where a triangle crosses a column: the column passes between two of its edges' crossings, the lower one included. No area is divided by, so that
// triangles without one need no care.
// Returns: VoxelizationColumn; `depth` within the triangle's extent.
// Units: any one length; `column` is y and z of the column.
// Domain: coordinates up to 1e18.
// Outside: as voxelization_crossing.
// Accuracy: lavapipe inside 8 backward, depth 2 ulp + 8 backward; portable inside 16 backward, depth 4 ulp + 16 backward
fn voxelization_column(a: vec3f, b: vec3f, c: vec3f, column: vec2f) -> VoxelizationColumn {
    // Two edges are one as seen along x: a device may round them apart.
    if all(a.yz == b.yz) || all(b.yz == c.yz) || all(c.yz == a.yz) {
        return VoxelizationColumn(false, 0.0f);
    }
    let ab = voxelization_crossing(a, b, column.x);
    let bc = voxelization_crossing(b, c, column.x);
    let ca = voxelization_crossing(c, a, column.x);
    let under_ab = ab.crossed && ab.at.y <= column.y;
    let under_bc = bc.crossed && bc.at.y <= column.y;
    let under_ca = ca.crossed && ca.at.y <= column.y;
    // Of three edges none or two are crossed; the column is between two of which one lies under it.
    if (under_ab != under_bc) != under_ca {
        let low = select(select(ca.at, bc.at, under_bc), ab.at, under_ab);
        let high = select(select(ca.at, bc.at, bc.crossed && !under_bc), ab.at, ab.crossed && !under_ab);
        return VoxelizationColumn(true, voxelization_between(low, high, column.y - low.y, high.y - column.y).x);
    }
    return VoxelizationColumn(false, 0.0f);
}

// The same by edge functions, as one finds it: each triangle counts what lies on its edges, and its depth is weighted by areas.
// Returns: VoxelizationColumn.
// Units: as voxelization_column.
// Domain: triangles that have an area as seen along x.
// Outside: columns on a shared edge count for both triangles; seen edge-on, depth is 0/0.
// Accuracy: naive
fn voxelization_column_naive(a: vec3f, b: vec3f, c: vec3f, column: vec2f) -> VoxelizationColumn {
    let p = a.yz - column;
    let q = b.yz - column;
    let r = c.yz - column;
    let weights = vec3f(q.x * r.y - q.y * r.x, r.x * p.y - r.y * p.x, p.x * q.y - p.y * q.x);
    if all(weights >= vec3f(0.0f)) || all(weights <= vec3f(0.0f)) {
        return VoxelizationColumn(true, dot(weights, vec3f(a.x, b.x, c.x)) / (weights.x + weights.y + weights.z));
    }
    return VoxelizationColumn(false, 0.0f);
}

// The first voxel of a row whose centre lies at a coordinate or beyond it.
// Returns: its number, or `cells` where there is none.
// Units: coordinate in voxels.
// Domain: any coordinate; cells up to 2^22.
// Outside: none is; from 0 to cells whatever comes in.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_first(coordinate: f32, cells: u32) -> u32 {
    // Far off the half would overflow.
    let near = clamp(coordinate, 0.0f, f32(cells));
    return min(u32(ceil(near - 0.5f)), cells);
}

// Bits that change at each bit that is set, the least first: what lies inside, from where a surface is crossed.
// Returns: bit i is the parity of bits 0 to i.
// Units: none.
// Domain: any bits.
// Outside: none is.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_prefix(bits: u32) -> u32 {
    let two = bits ^ (bits << 1u);
    let four = two ^ (two << 2u);
    let eight = four ^ (four << 4u);
    let sixteen = eight ^ (eight << 8u);
    return sixteen ^ (sixteen << 16u);
}

// The length of a way along the axes: how far a cube of half size 1 reaches along a vector, times the vector's length.
// Returns: |x| + |y| + |z|.
// Units: those of the vector.
// Domain: sum below 3e38.
// Outside: infinite or a NaN.
// Accuracy: lavapipe 2 ulp; portable 2 ulp
fn voxelization_taxicab(vector: vec3f) -> f32 {
    let size = abs(vector);
    return size.x + size.y + size.z;
}

// How far beyond itself a triangle touches voxels, so that rounding misses none.
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
// Returns: the first of them, and the one after the last; the same number twice where there are none.
// Units: low and high in voxels.
// Domain: low <= high, of any size; cells up to 2^22.
// Outside: none for low > high + 1; from 0 to cells whatever comes in.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn voxelization_range(low: f32, high: f32, cells: u32) -> vec2u {
    let most = f32(cells);
    let end = min(u32(clamp(floor(high) + 1.0f, 0.0f, most)), cells);
    return vec2u(min(u32(clamp(low, 0.0f, most)), end), end);
}

// The interval along x in which a triangle's plane passes over the square of a column, `corner` to `corner` + 1 in y and z, cut off by the
// triangle's own extent. A voxel that voxelization_overlaps finds meets it, so that no other need be looked at.
// Returns: low and high; low > high where the plane passes the extent by. The absolute error is that of half a length of 64, which may be taken from as
//   much: a product, a quotient and a sum, 3 units of 2^-24 where each is rounded to nearest. By WGSL's guarantees the half has e + 2.5 e + e with
//   e = 2^-23, and what it is taken from another 2.5 e of its quotient: 7 e of 64.
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
    // What quotients round goes with them.
    let half = (1.0f + VOXELIZATION_MARGIN) * width / slope + margin;
    return vec2f(max(extent.x, middle - half), min(extent.y, middle + half));
}

// Whether a triangle touches a voxel, its faces, edges and corners included, or comes within the margin of it. By separating axes: those of the
// voxel, the products of its axes and the triangle's edges, and the triangle's normal.
// Returns: never false where they touch; true only where they are nearer than a few margins, for a thin triangle its thickness.
// Units: voxels; `corner` is the voxel's corner with the least coordinates.
// Domain: coordinates up to 1e9. The accuracy is for triangles at least 1/8 as thick as long, as large as their distance from the origin lets be.
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
    // Component i of edge x corner is the corner's projection onto axis i x edge; both ends of the edge have the same.
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
    // The normal of a thin triangle is rounding for the most part, by as much as its edges are long.
    let normal = cross(ab, ca);
    let slack = margin * voxelization_taxicab(ab) * voxelization_taxicab(ca);
    return abs(dot(normal, p)) <= half * voxelization_taxicab(normal) + slack;
}
