//! Ground truth in f64 and in integers of 128 bits. Faces and centres are counted. The edges beside
//! a column decide whether it is inside, and Cramer's rule gives its depth. A triangle touches a
//! voxel if a part of it remains after clipping by the six faces of the voxel.

use glam::{DVec2, DVec3, IVec2, UVec2, UVec3};

/// A cube of voxels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationGrid {
    /// The corner with the least coordinates, in world units.
    pub origin: DVec3,
    /// A voxel's edge in world units.
    pub spacing: f64,
    /// Voxels along each edge.
    pub cells: u32,
}

/// An integer of more than 32 bits: high 2³⁰ + low.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VoxelizationInteger {
    /// Units of 2³⁰.
    pub high: i32,
    /// From 0 to 2³⁰ - 1.
    pub low: i32,
}

/// An edge as seen from a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationEdge {
    /// 1 if counterclockwise, -1 if clockwise, 0 for an edge without length.
    pub turn: i32,
    /// Twice the area of the triangle between the edge and the column.
    pub area: f64,
}

/// The crossing of a triangle and a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationColumn {
    /// True if they cross.
    pub inside: bool,
    /// The x coordinate of the crossing; 0 if there is none.
    pub depth: f64,
}

/// Counts the slices, rows and voxels before this one.
pub fn index(grid: VoxelizationGrid, voxel: UVec3) -> u32 {
    let row = grid.cells;
    let slice = row * grid.cells;
    voxel.z * slice + voxel.y * row + voxel.x
}

/// Returns the middle of the voxel's two extreme corners.
pub fn centre(grid: VoxelizationGrid, voxel: UVec3) -> DVec3 {
    let corner = |voxel: UVec3| grid.origin + grid.spacing * voxel.as_dvec3();
    0.5 * (corner(voxel) + corner(voxel + 1))
}

/// Multiplies by the reciprocal of the spacing.
pub fn local(grid: VoxelizationGrid, position: DVec3) -> DVec3 {
    let density = grid.spacing.recip();
    position * density - grid.origin * density
}

/// Counts the faces between voxels that lie at the position or before it.
pub fn voxel(grid: VoxelizationGrid, position: DVec3) -> UVec3 {
    UVec3::from_array([0, 1, 2].map(|axis| {
        let faces = (1..grid.cells).map(|face| grid.origin[axis] + f64::from(face) * grid.spacing);
        faces.filter(|face| *face <= position[axis]).count() as u32
    }))
}

/// Chooses between the whole numbers on both sides.
pub fn lattice(position: DVec2) -> IVec2 {
    let nearest = |coordinate: f64| {
        let steps = coordinate.clamp(-16384.0, 16384.0) * 16384.0;
        let (below, part) = (steps.floor() as i32, steps - steps.floor());
        below + i32::from(part > 0.5 || (part == 0.5 && below % 2 != 0))
    };
    IVec2::new(nearest(position.x), nearest(position.y))
}

/// Computes the cross product at once, in 128 bits.
fn whole_cross(p: IVec2, q: IVec2) -> i128 {
    i128::from(p.x) * i128::from(q.y) - i128::from(p.y) * i128::from(q.x)
}

/// Splits the cross product into its parts.
pub fn cross(p: IVec2, q: IVec2) -> VoxelizationInteger {
    let whole = whole_cross(p, q);
    VoxelizationInteger { high: whole.div_euclid(1 << 30) as i32, low: whole.rem_euclid(1 << 30) as i32 }
}

/// Writes the area from a column at (e², e) as a polynomial in e; the first coefficient that is not
/// 0 gives the sign.
pub fn edge(from_point: IVec2, to_point: IVec2) -> VoxelizationEdge {
    let area = whole_cross(from_point, to_point);
    let powers = [area, i128::from(to_point.x - from_point.x), i128::from(from_point.y - to_point.y)];
    let turn = powers.into_iter().map(i128::signum).find(|sign| *sign != 0).unwrap_or(0);
    VoxelizationEdge { turn: turn as i32, area: area.unsigned_abs() as f64 }
}

/// Returns twice the signed area of a triangle in the plane of y and z.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn across(point: DVec3) -> DVec2 {
    DVec2::new(point.y, point.z)
}

/// Decides by the edges beside the column, each with its lower end and without its upper end. Ties
/// count as if the column lay a little higher in z, and in y by less than that.
pub fn column(a: DVec3, b: DVec3, c: DVec3, column: DVec2) -> VoxelizationColumn {
    let origin = lattice(column);
    let corners = [a, b, c].map(|corner| (lattice(across(corner)) - origin, corner.x));
    let weight = |k: usize| whole_cross(corners[(k + 1) % 3].0, corners[(k + 2) % 3].0);
    let beside = |k: usize| {
        let (from, to) = (corners[(k + 1) % 3].0, corners[(k + 2) % 3].0);
        let upwards = if from.x <= to.x { weight(k) } else { -weight(k) };
        from.x.min(to.x) <= 0 && 0 < from.x.max(to.x) && upwards >= 0
    };
    if (0..3).filter(|k| beside(*k)).count() % 2 == 0 {
        return VoxelizationColumn { inside: false, depth: 0.0 };
    }
    // From the first corner along two edges (Cramer's rule).
    let [(first, start), (second, _), (third, _)] = corners;
    let [along, across] = [second - first, third - first];
    let whole = whole_cross(along, across) as f64;
    let [to_second, to_third] = [whole_cross(-first, across) as f64 / whole, whole_cross(along, -first) as f64 / whole];
    VoxelizationColumn { inside: true, depth: start + to_second * (b.x - start) + to_third * (c.x - start) }
}

/// Returns the x coordinate of the plane over a column, within the triangle's extent.
fn on_plane(a: DVec3, b: DVec3, c: DVec3, column: DVec2) -> f64 {
    let normal = (b - a).cross(c - a);
    let depth = a.x - (normal.y * (column.x - a.y) + normal.z * (column.y - a.z)) / normal.x;
    depth.clamp(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x))
}

/// Decides by the signs of areas: inside if the column is not outside any edge.
pub fn column_naive(a: DVec3, b: DVec3, c: DVec3, column: DVec2) -> VoxelizationColumn {
    let whole = area(across(a), across(b), across(c));
    let outside = |from: DVec3, to: DVec3| area(across(from), across(to), column) * whole < 0.0;
    if outside(a, b) || outside(b, c) || outside(c, a) {
        return VoxelizationColumn { inside: false, depth: 0.0 };
    }
    VoxelizationColumn { inside: true, depth: on_plane(a, b, c, column) }
}

/// Counts the centres before the coordinate.
pub fn first(coordinate: f64, cells: u32) -> u32 {
    (0..cells).filter(|voxel| f64::from(*voxel) + 0.5 < coordinate).count() as u32
}

/// Computes the parity bit by bit.
pub fn prefix(bits: u32) -> u32 {
    let mut inside = 0;
    (0..u32::BITS).fold(0, |result, bit| {
        inside ^= bits >> bit & 1;
        result | inside << bit
    })
}

/// Returns the largest of the sums with all combinations of signs.
pub fn taxicab(vector: DVec3) -> f64 {
    let signs = [1.0, -1.0];
    let sums = signs.map(|x| signs.map(|y| signs.map(|z| vector.dot(DVec3::new(x, y, z)))));
    sums.into_iter().flatten().flatten().fold(0.0, f64::max)
}

/// Returns 2⁻¹⁹ of the largest coordinate plus one voxel.
pub fn margin(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let all = [a, b, c].map(|corner| corner.to_array());
    let largest = all.into_iter().flatten().fold(0.0, |largest: f64, x| largest.max(x).max(-x));
    (largest + 1.0) / f64::from(1 << 19)
}

/// Counts the voxels that end before the interval, and those that begin in it or before it.
pub fn range(low: f64, high: f64, cells: u32) -> UVec2 {
    let before = (0..cells).filter(|voxel| f64::from(voxel + 1) <= low).count() as u32;
    let begun = (0..cells).filter(|voxel| f64::from(*voxel) <= high).count() as u32;
    UVec2::new(before.min(begun), begun)
}

/// Evaluates the plane at the corners of the square, and moves it along x by its possible error.
pub fn span(a: DVec3, b: DVec3, c: DVec3, corner: DVec2) -> DVec2 {
    let margin = margin(a, b, c);
    let xs = [a.x, b.x, c.x];
    let low = xs.into_iter().fold(f64::INFINITY, f64::min) - margin;
    let high = xs.into_iter().fold(f64::NEG_INFINITY, f64::max) + margin;
    let normal = (b - a).cross(c - a);
    let slack = margin * taxicab(b - a) * taxicab(c - a);
    let across_square = taxicab(DVec3::new(0.0, normal.y, normal.z)) * (0.5 + margin);
    if normal.x.abs() <= (across_square + slack) / f64::from(1 << 20) {
        return DVec2::new(low, high);
    }
    let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(y, z)| {
        let widened = corner + DVec2::new(y, z) + margin * DVec2::new(2.0 * y - 1.0, 2.0 * z - 1.0);
        let offset = widened - across(a);
        a.x - (normal.y * offset.x + normal.z * offset.y) / normal.x
    });
    let [least, most] =
        [corners.into_iter().fold(f64::INFINITY, f64::min), corners.into_iter().fold(-f64::INFINITY, f64::max)];
    let beyond = slack / normal.x.abs();
    let more = beyond + (0.5 * (most - least) + beyond) / f64::from(1 << 19) + margin;
    DVec2::new(low.max(least - more), high.min(most + more))
}

/// Returns the part of a polygon on one side of a face perpendicular to an axis.
fn clipped(polygon: &[DVec3], axis: usize, side: f64, face: f64) -> Vec<DVec3> {
    let height = |point: DVec3| side * (point[axis] - face);
    let mut left = Vec::new();
    for (place, &point) in polygon.iter().enumerate() {
        let next = polygon[(place + 1) % polygon.len()];
        let (here, there) = (height(point), height(next));
        if here <= 0.0 {
            left.push(point);
        }
        if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
            let mut met = point + (next - point) * (here / (here - there));
            met[axis] = face;
            left.push(met);
        }
    }
    left
}

/// Returns whether any part of the triangle is within a voxel enlarged by `margin` on all sides.
pub fn touches([a, b, c]: [DVec3; 3], corner: DVec3, margin: f64) -> bool {
    let mut polygon = vec![a, b, c];
    for axis in 0..3 {
        for (side, face) in [(-1.0, corner[axis] - margin), (1.0, corner[axis] + 1.0 + margin)] {
            polygon = clipped(&polygon, axis, side, face);
            if polygon.is_empty() {
                return false;
            }
        }
    }
    true
}

/// Clips the triangle by the voxel, enlarged by the margin.
pub fn overlaps(a: DVec3, b: DVec3, c: DVec3, corner: DVec3) -> bool {
    touches([a, b, c], corner, margin(a, b, c))
}
