//! Mirror of `wgsl/voxelization.wgsl`: the crossing of a triangle and a column of voxel centres,
//! without leaks, and the voxels that a triangle touches. After Schwarz and Seidel 2010 and
//! Akenine-Möller 2001.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file mirrors it line
//! by line. [`kernels`] mirrors the recipe `wgsl/recipes/voxelization.wgsl`.
//!
//! ```
//! use glam::{Vec3, vec2, vec3};
//! use lapidary_voxelization::column;
//!
//! // Two triangles of a square share a diagonal. A column on it meets one of them.
//! let [a, b, c, d] = [vec3(2.0, 0.0, 0.0), vec3(2.0, 4.0, 0.0), vec3(2.0, 4.0, 4.0), vec3(2.0, 0.0, 4.0)];
//! let met = [[a, b, c], [a, c, d]].map(|[a, b, c]: [Vec3; 3]| column(a, b, c, vec2(1.5, 1.5)));
//! assert_eq!(met.iter().filter(|crossing| crossing.inside).count(), 1);
//! assert!(met.iter().any(|crossing| crossing.depth == 2.0));
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod kernels;
pub mod oracle;

#[cfg(test)]
mod tests;

use glam::{IVec2, UVec2, UVec3, Vec2, Vec3, Vec3Swizzles as _};

/// Lattice points along a voxel's edge.
pub const VOXELIZATION_LATTICE: f32 = 16384.0;
/// The extent of the lattice from the grid's origin, in voxels.
pub const VOXELIZATION_REACH: f32 = 16384.0;
/// The margin by which a triangle is enlarged, relative to its largest coordinate or to a voxel,
/// 2⁻¹⁹.
pub const VOXELIZATION_MARGIN: f32 = 1.9073486328125e-6;
/// The steepest plane; steeper ones are cut off by the triangle's own extent, whatever the grid.
pub const VOXELIZATION_STEEPEST: f32 = 1048576.0;

/// A cube of voxels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationGrid {
    /// The corner with the least coordinates, in world units.
    pub origin: Vec3,
    /// A voxel's edge in world units.
    pub spacing: f32,
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
    /// 1 if the edge runs counterclockwise about the column, with y to the right and z upwards; -1
    /// if clockwise; 0 for an edge without length.
    pub turn: i32,
    /// Twice the area of the triangle between the edge and the column, in squares of the lattice.
    pub area: f32,
}

/// The crossing of a triangle and a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationColumn {
    /// True if they cross.
    pub inside: bool,
    /// The x coordinate of the crossing; 0 if there is none.
    pub depth: f32,
}

/// The index of a voxel, with x varying fastest.
pub fn index(grid: VoxelizationGrid, voxel: UVec3) -> u32 {
    voxel.x + grid.cells * (voxel.y + grid.cells * voxel.z)
}

/// The centre of a voxel, in world units.
pub fn centre(grid: VoxelizationGrid, voxel: UVec3) -> Vec3 {
    grid.origin + (voxel.as_vec3() + 0.5) * grid.spacing
}

/// A position in grid coordinates, which count voxels.
pub fn local(grid: VoxelizationGrid, position: Vec3) -> Vec3 {
    (position - grid.origin) / grid.spacing
}

/// The voxel that contains a position, or the nearest one.
pub fn voxel(grid: VoxelizationGrid, position: Vec3) -> UVec3 {
    let last = grid.cells - 1;
    local(grid, position).clamp(Vec3::ZERO, Vec3::splat(last as f32)).as_uvec3().min(UVec3::splat(last))
}

/// The nearest point of the lattice on which inside and outside are decided.
pub fn lattice(position: Vec2) -> IVec2 {
    let within = position.clamp(Vec2::splat(-VOXELIZATION_REACH), Vec2::splat(VOXELIZATION_REACH));
    let scaled = within * VOXELIZATION_LATTICE;
    Vec2::new(scaled.x.round_ties_even(), scaled.y.round_ties_even()).as_ivec2()
}

/// The cross product of two integer vectors, with all of its bits.
pub fn cross(p: IVec2, q: IVec2) -> VoxelizationInteger {
    let p_high = p >> UVec2::splat(15);
    let q_high = q >> UVec2::splat(15);
    let p_low = p & IVec2::splat(32767);
    let q_low = q & IVec2::splat(32767);
    let low = p_low.x * q_low.y - p_low.y * q_low.x;
    let middle = (p_high.x * q_low.y - p_high.y * q_low.x) + (p_low.x * q_high.y - p_low.y * q_high.x) + (low >> 15);
    let high = p_high.x * q_high.y - p_high.y * q_high.x + (middle >> 15);
    VoxelizationInteger { high, low: ((middle & 32767) << 15) | (low & 32767) }
}

/// An edge as seen from a column, which never lies on the line of an edge.
pub fn edge(from_point: IVec2, to_point: IVec2) -> VoxelizationEdge {
    let area = cross(from_point, to_point);
    let way = to_point - from_point;
    let turn_beside = if way.x == 0 { -way.y.signum() } else { way.x.signum() };
    let turn_near = if area.low > 0 { 1 } else { turn_beside };
    let turn = if area.high == 0 { turn_near } else { area.high.signum() };
    // The magnitude: with the sign, a small difference of two large parts would lose its digits.
    let high = if area.high < 0 { -1 - area.high } else { area.high };
    let low = if area.high < 0 { 1_073_741_824 - area.low } else { area.low };
    VoxelizationEdge { turn, area: high as f32 * 1_073_741_824.0 + low as f32 }
}

/// The crossing of a triangle and a column, which exists if all three edges turn about the column
/// the same way.
pub fn column(a: Vec3, b: Vec3, c: Vec3, column: Vec2) -> VoxelizationColumn {
    let at = lattice(column);
    let p = lattice(a.yz()) - at;
    let q = lattice(b.yz()) - at;
    let r = lattice(c.yz()) - at;
    let ab = edge(p, q);
    let bc = edge(q, r);
    let ca = edge(r, p);
    if ab.turn == 0 || ab.turn != bc.turn || bc.turn != ca.turn {
        return VoxelizationColumn { inside: false, depth: 0.0 };
    }
    // Each corner's weight is the area of the opposite edge.
    let weights = Vec3::new(bc.area, ca.area, ab.area);
    let depth = weights.dot(Vec3::new(a.x, b.x, c.x)) / (weights.x + weights.y + weights.z);
    VoxelizationColumn { inside: true, depth: depth.clamp(a.x.min(b.x.min(c.x)), a.x.max(b.x.max(c.x))) }
}

/// [`column()`] in floats, as usually written.
pub fn column_naive(a: Vec3, b: Vec3, c: Vec3, column: Vec2) -> VoxelizationColumn {
    let p = a.yz() - column;
    let q = b.yz() - column;
    let r = c.yz() - column;
    let weights = Vec3::new(q.x * r.y - q.y * r.x, r.x * p.y - r.y * p.x, p.x * q.y - p.y * q.x);
    if weights.cmpge(Vec3::ZERO).all() || weights.cmple(Vec3::ZERO).all() {
        let depth = weights.dot(Vec3::new(a.x, b.x, c.x)) / (weights.x + weights.y + weights.z);
        return VoxelizationColumn { inside: true, depth };
    }
    VoxelizationColumn { inside: false, depth: 0.0 }
}

/// The first voxel of a row whose centre lies at or beyond a coordinate; `cells` if there is none.
pub fn first(coordinate: f32, cells: u32) -> u32 {
    let near = coordinate.clamp(0.0, cells as f32);
    ((near - 0.5).ceil() as u32).min(cells)
}

/// The running parity of bits, from the least on.
pub fn prefix(bits: u32) -> u32 {
    let two = bits ^ (bits << 1);
    let four = two ^ (two << 2);
    let eight = four ^ (four << 4);
    let sixteen = eight ^ (eight << 8);
    sixteen ^ (sixteen << 16)
}

/// The taxicab length of a vector.
pub fn taxicab(vector: Vec3) -> f32 {
    let size = vector.abs();
    size.x + size.y + size.z
}

/// The margin around a triangle within which it counts as touching voxels, so that rounding misses
/// none.
pub fn margin(a: Vec3, b: Vec3, c: Vec3) -> f32 {
    let largest = a.abs().max(b.abs().max(c.abs()));
    VOXELIZATION_MARGIN * (1.0 + largest.x.max(largest.y.max(largest.z)))
}

/// The voxels of a row that an interval meets: the first of them, and the one after the last.
pub fn range(low: f32, high: f32, cells: u32) -> UVec2 {
    let most = cells as f32;
    let end = ((high.floor() + 1.0).clamp(0.0, most) as u32).min(cells);
    UVec2::new((low.clamp(0.0, most) as u32).min(end), end)
}

/// The interval along x in which a triangle's plane passes over the square of a column, cut off by
/// the triangle's own extent.
pub fn span(a: Vec3, b: Vec3, c: Vec3, corner: Vec2) -> Vec2 {
    let margin = margin(a, b, c);
    let extent = Vec2::new(a.x.min(b.x.min(c.x)) - margin, a.x.max(b.x.max(c.x)) + margin);
    let ab = b - a;
    let ac = c - a;
    let normal = ab.cross(ac);
    let slack = margin * taxicab(ab) * taxicab(ac);
    let width = (0.5 + margin) * (normal.y.abs() + normal.z.abs()) + slack;
    let slope = normal.x.abs();
    if slope * VOXELIZATION_STEEPEST <= width {
        return extent;
    }
    let middle = a.x - normal.yz().dot((corner + 0.5) - a.yz()) / normal.x;
    // The rounding error of a quotient is proportional to it, hence the factor.
    let half = (1.0 + VOXELIZATION_MARGIN) * width / slope + margin;
    Vec2::new(extent.x.max(middle - half), extent.y.min(middle + half))
}

/// Whether a triangle touches a voxel, including its faces, edges and corners, or comes within the
/// margin of it.
pub fn overlaps(a: Vec3, b: Vec3, c: Vec3, corner: Vec3) -> bool {
    let margin = margin(a, b, c);
    let half = 0.5 + margin;
    let centre = corner + 0.5;
    let p = a - centre;
    let q = b - centre;
    let r = c - centre;
    if p.min(q.min(r)).cmpgt(Vec3::splat(half)).any() || p.max(q.max(r)).cmplt(Vec3::splat(-half)).any() {
        return false;
    }
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    // Component i of edge × corner is the corner's projection onto axis i × edge; both ends of the
    // edge have the same projection.
    let ab_p = ab.cross(p);
    let ab_r = ab.cross(r);
    let bc_q = bc.cross(q);
    let bc_p = bc.cross(p);
    let ca_r = ca.cross(r);
    let ca_q = ca.cross(q);
    let ab_half = half * (ab.abs().yzx() + ab.abs().zxy());
    let bc_half = half * (bc.abs().yzx() + bc.abs().zxy());
    let ca_half = half * (ca.abs().yzx() + ca.abs().zxy());
    if ab_p.min(ab_r).cmpgt(ab_half).any()
        || ab_p.max(ab_r).cmplt(-ab_half).any()
        || bc_q.min(bc_p).cmpgt(bc_half).any()
        || bc_q.max(bc_p).cmplt(-bc_half).any()
        || ca_r.min(ca_q).cmpgt(ca_half).any()
        || ca_r.max(ca_q).cmplt(-ca_half).any()
    {
        return false;
    }
    // The normal of a thin triangle is mostly rounding error, in proportion to the lengths of its
    // edges.
    let normal = ab.cross(ca);
    let slack = margin * taxicab(ab) * taxicab(ca);
    normal.dot(p).abs() <= half * taxicab(normal) + slack
}
