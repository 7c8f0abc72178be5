//! Mirror of `wgsl/voxelization.wgsl`: where a triangle crosses a column of voxel centres, without leaks, and which voxels it
//! touches. After Schwarz and Seidel 2010 and Akenine-Möller 2001.
//!
//! The WGSL file states units, domain and accuracy of each function; this file reads line by line like it.
//! [`kernels`] mirrors the recipe `wgsl/recipes/voxelization.wgsl`.

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod kernels;
pub mod oracle;

#[cfg(test)]
mod tests;

use glam::{UVec2, UVec3, Vec2, Vec3, Vec3Swizzles as _};

/// How far a triangle reaches beyond itself, relative to its largest coordinate or to a voxel, 2⁻¹⁹.
pub const VOXELIZATION_MARGIN: f32 = 1.9073486328125e-6;
/// Steeper planes than this are cut off by the triangle's own extent, whatever the grid.
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

/// Where an edge crosses a plane across y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationCrossing {
    /// Whether it does.
    pub crossed: bool,
    /// x and z of the place; 0 where there is none.
    pub at: Vec2,
}

/// Where a triangle crosses a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelizationColumn {
    /// Whether it does.
    pub inside: bool,
    /// x of the place; 0 where there is none.
    pub depth: f32,
}

/// The number of a voxel, x running fastest.
pub fn index(grid: VoxelizationGrid, voxel: UVec3) -> u32 {
    voxel.x + grid.cells * (voxel.y + grid.cells * voxel.z)
}

/// The centre of a voxel, in world units.
pub fn centre(grid: VoxelizationGrid, voxel: UVec3) -> Vec3 {
    grid.origin + (voxel.as_vec3() + 0.5) * grid.spacing
}

/// A position in the grid's own coordinates, which count voxels.
pub fn local(grid: VoxelizationGrid, position: Vec3) -> Vec3 {
    (position - grid.origin) / grid.spacing
}

/// The voxel that holds a position, or the nearest one.
pub fn voxel(grid: VoxelizationGrid, position: Vec3) -> UVec3 {
    let last = grid.cells - 1;
    local(grid, position).clamp(Vec3::ZERO, Vec3::splat(last as f32)).as_uvec3().min(UVec3::splat(last))
}

/// The point that divides a line at two distances.
pub fn between(from_point: Vec2, to_point: Vec2, before: f32, after: f32) -> Vec2 {
    // A subnormal may be flushed where it is divided by.
    let share = before.min(after) / (before + after).max(1.2e-38);
    let near = if before < after { from_point } else { to_point };
    let far = if before < after { to_point } else { from_point };
    (near + share * (far - near)).clamp(near.min(far), near.max(far))
}

/// Where an edge crosses the plane of a row of columns: its lower end belongs to it and its upper does not.
pub fn crossing(a: Vec3, b: Vec3, y: f32) -> VoxelizationCrossing {
    let swapped = b.y < a.y;
    let lower = if swapped { b } else { a };
    let upper = if swapped { a } else { b };
    if lower.y <= y && y < upper.y {
        return VoxelizationCrossing { crossed: true, at: between(lower.xz(), upper.xz(), y - lower.y, upper.y - y) };
    }
    VoxelizationCrossing { crossed: false, at: Vec2::ZERO }
}

/// Where a triangle crosses a column: the column passes between two of its edges' crossings, the lower one included.
pub fn column(a: Vec3, b: Vec3, c: Vec3, column: Vec2) -> VoxelizationColumn {
    // Two edges are one as seen along x: a device may round them apart.
    if a.yz() == b.yz() || b.yz() == c.yz() || c.yz() == a.yz() {
        return VoxelizationColumn { inside: false, depth: 0.0 };
    }
    let ab = crossing(a, b, column.x);
    let bc = crossing(b, c, column.x);
    let ca = crossing(c, a, column.x);
    let under_ab = ab.crossed && ab.at.y <= column.y;
    let under_bc = bc.crossed && bc.at.y <= column.y;
    let under_ca = ca.crossed && ca.at.y <= column.y;
    // Of three edges none or two are crossed; the column is between two of which one lies under it.
    if (under_ab != under_bc) != under_ca {
        let not_ab = if under_bc { bc.at } else { ca.at };
        let low = if under_ab { ab.at } else { not_ab };
        let not_ab = if bc.crossed && !under_bc { bc.at } else { ca.at };
        let high = if ab.crossed && !under_ab { ab.at } else { not_ab };
        return VoxelizationColumn { inside: true, depth: between(low, high, column.y - low.y, high.y - column.y).x };
    }
    VoxelizationColumn { inside: false, depth: 0.0 }
}

/// The same by edge functions, as one finds it.
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

/// The first voxel of a row whose centre lies at a coordinate or beyond it; `cells` where there is none.
pub fn first(coordinate: f32, cells: u32) -> u32 {
    let near = coordinate.clamp(0.0, cells as f32);
    ((near - 0.5).ceil() as u32).min(cells)
}

/// Bits that change at each bit that is set, the least first.
pub fn prefix(bits: u32) -> u32 {
    let two = bits ^ (bits << 1);
    let four = two ^ (two << 2);
    let eight = four ^ (four << 4);
    let sixteen = eight ^ (eight << 8);
    sixteen ^ (sixteen << 16)
}

/// The length of a way along the axes.
pub fn taxicab(vector: Vec3) -> f32 {
    let size = vector.abs();
    size.x + size.y + size.z
}

/// How far beyond itself a triangle touches voxels, so that rounding misses none.
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

/// The interval along x in which a triangle's plane passes over the square of a column, cut off by the triangle's own extent.
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
    // What quotients round goes with them.
    let half = (1.0 + VOXELIZATION_MARGIN) * width / slope + margin;
    Vec2::new(extent.x.max(middle - half), extent.y.min(middle + half))
}

/// Whether a triangle touches a voxel, its faces, edges and corners included, or comes within the margin of it.
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
    // Component i of edge × corner is the corner's projection onto axis i × edge; both ends of the edge have the same.
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
    // The normal of a thin triangle is rounding for the most part, by as much as its edges are long.
    let normal = ab.cross(ca);
    let slack = margin * taxicab(ab) * taxicab(ca);
    normal.dot(p).abs() <= half * taxicab(normal) + slack
}
