//! Exact results in f64, by other geometry than the mirror's: the point reflection as a midpoint,
//! normals by the Gram-Schmidt process, the intersection by bisection of the signed height, lattice
//! coordinates by Cramer's rule in an orthonormal frame of the plane, the tile by a search over the
//! lattice.

use glam::{DMat2, DMat3, DVec2, DVec3, IVec2};

/// The image of a triangle through the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryPlane {
    /// Image of the triangle's first vertex.
    pub origin: DVec3,
    /// Edge from `origin` to the image of the second vertex.
    pub edge_first: DVec3,
    /// Edge from `origin` to the image of the third vertex.
    pub edge_second: DVec3,
}

/// Intersection of a ray with a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryHit {
    /// Intersection of the ray with the plane; on a miss, the start of the ray.
    pub point: DVec3,
    /// Distance along the ray; 0 on a miss.
    pub distance: f64,
    /// True if the ray meets the plane.
    pub hit: bool,
}

/// Position of a tile in the lattice of plane P.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProxyGeometryCell {
    /// Whole lattice steps along the two edges.
    pub steps: IVec2,
    /// True for the other half of the cell.
    pub turned: bool,
}

/// One tile of plane P.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyGeometryFacet {
    /// The first vertex.
    pub vertex_first: DVec3,
    /// The second.
    pub vertex_second: DVec3,
    /// The third.
    pub vertex_third: DVec3,
}

/// Returns the point whose midpoint with `position` is `centre`.
pub fn image(centre: DVec3, position: DVec3) -> DVec3 {
    centre + (centre - position)
}

/// Computes the edges as differences of images.
pub fn plane(
    centre: DVec3,
    position_first: DVec3,
    position_second: DVec3,
    position_third: DVec3,
) -> ProxyGeometryPlane {
    let [first, second, third] =
        [position_first, position_second, position_third].map(|x| image(centre - position_first, x - position_first));
    ProxyGeometryPlane { origin: first + position_first, edge_first: second - first, edge_second: third - first }
}

/// Makes one edge perpendicular to the other at the corner with the largest angle (Gram-Schmidt),
/// then completes a right-handed frame.
pub fn face_normal(position_first: DVec3, position_second: DVec3, position_third: DVec3) -> DVec3 {
    let corners = [position_first, position_second, position_third];
    let edges = |corner: usize| [1, 2].map(|step| (corners[(corner + step) % 3] - corners[corner]).normalize_or_zero());
    let cosine = |corner: usize| {
        let [one, other] = edges(corner);
        one.dot(other)
    };
    let widest = (0..3).min_by(|one, other| cosine(*one).total_cmp(&cosine(*other))).unwrap_or(0);
    let [first, second] = edges(widest);
    let mut across = second - second.dot(first) * first;
    // A second pass removes the cancellation of the first; two are enough (Kahan).
    across -= across.dot(first) * first;
    // Below the rounding of f64 the edges are parallel, and the triangle is degenerate.
    if across.length() < 1e-13 { DVec3::ZERO } else { first.cross(across.normalize()).normalize_or_zero() }
}

/// Finds the parameter at which the ray's height over the plane changes its sign, by bisection.
pub fn intersect(position: DVec3, direction: DVec3, plane_point: DVec3, normal: DVec3) -> ProxyGeometryHit {
    let miss = ProxyGeometryHit { point: position, distance: 0.0, hit: false };
    let height = |distance: f64| (position - plane_point).dot(normal) + distance * direction.dot(normal);
    // A ray that descends by 2^-20 of its length or less counts as parallel: it must reach the
    // plane within 2^20 heights.
    let start = height(0.0);
    let mut far = start.abs() * 2f64.powi(20);
    if start == 0.0 || height(far) * start >= 0.0 {
        return miss;
    }
    let mut near = 0.0;
    // Repeats until the two are neighbours in f64.
    loop {
        let middle = 0.5 * (near + far);
        if middle <= near || middle >= far {
            break;
        }
        if height(middle) * start > 0.0 { near = middle } else { far = middle }
    }
    ProxyGeometryHit { point: position + far * direction, distance: far, hit: true }
}

/// Applies Cramer's rule to two components, in an orthonormal frame of the plane.
pub fn coordinates(point: DVec3, origin: DVec3, edge_first: DVec3, edge_second: DVec3) -> DVec2 {
    let size = edge_first.abs().max(edge_second.abs()).max_element();
    if size == 0.0 {
        return DVec2::ZERO;
    }
    let (first, second, offset) = (edge_first / size, edge_second / size, (point - origin) / size);
    // The frame lies along the longer edge, so that a zero edge does no harm.
    let along = if first.length() > second.length() { first } else { second }.normalize();
    let other = if first.length() > second.length() { second } else { first };
    let across = other - other.dot(along) * along;
    let across = (across - across.dot(along) * along).normalize_or_zero();
    let flat = |v: DVec3| DVec2::new(v.dot(along), v.dot(across));
    let matrix = DMat2::from_cols(flat(first), flat(second));
    let area = matrix.determinant();
    if area.abs() < 2f64.powi(-18) {
        return DVec2::ZERO;
    }
    let offset = flat(offset);
    DVec2::new(
        DMat2::from_cols(offset, flat(second)).determinant(),
        DMat2::from_cols(flat(first), offset).determinant(),
    ) / area
}

/// Finds the tile that contains the point, among those around the rounded coordinates, by its
/// half-open inequalities.
pub fn cell(coordinates: DVec2) -> ProxyGeometryCell {
    let near = coordinates.round();
    for (dx, dy) in [(-1.0, -1.0), (-1.0, 0.0), (0.0, -1.0), (0.0, 0.0)] {
        let cell = near + DVec2::new(dx, dy);
        // Compared, not subtracted: the difference to a tiny negative coordinate would round to the
        // next cell.
        if coordinates.cmplt(cell).any() || coordinates.cmpge(cell + DVec2::ONE).any() {
            continue;
        }
        let below_diagonal = coordinates.x - cell.x <= (cell.y + 1.0) - coordinates.y;
        return ProxyGeometryCell { steps: cell.as_ivec2(), turned: !below_diagonal };
    }
    unreachable!("the four cells about the nearest lattice point hold the point")
}

/// Computes the corners of the tile in homogeneous lattice coordinates, with the matrix of the
/// lattice.
pub fn facet(plane: ProxyGeometryPlane, cell: ProxyGeometryCell) -> ProxyGeometryFacet {
    let corners = if cell.turned {
        [DVec2::new(1.0, 1.0), DVec2::new(0.0, 1.0), DVec2::new(1.0, 0.0)]
    } else {
        [DVec2::ZERO, DVec2::X, DVec2::Y]
    };
    let lattice = DMat3::from_cols(plane.edge_first, plane.edge_second, plane.origin);
    let [vertex_first, vertex_second, vertex_third] =
        corners.map(|corner| lattice * (cell.steps.as_dvec2() + corner).extend(1.0));
    ProxyGeometryFacet { vertex_first, vertex_second, vertex_third }
}

/// Returns the direction from the centroid, summed vertex by vertex, to the centre, with the sign
/// of the larger angle to the ray.
pub fn facet_normal(
    centre: DVec3,
    vertex_first: DVec3,
    vertex_second: DVec3,
    vertex_third: DVec3,
    direction: DVec3,
) -> DVec3 {
    let to_centre =
        [vertex_first, vertex_second, vertex_third].iter().map(|vertex| (centre - vertex) / 3.0).sum::<DVec3>();
    if to_centre == DVec3::ZERO {
        return -direction;
    }
    let normal = to_centre / to_centre.length();
    if normal.angle_between(direction) < std::f64::consts::FRAC_PI_2 { -normal } else { normal }
}

/// Returns the same as `facet_normal`, without the flip towards the ray.
pub fn facet_normal_naive(centre: DVec3, vertex_first: DVec3, vertex_second: DVec3, vertex_third: DVec3) -> DVec3 {
    facet_normal(centre, vertex_first, vertex_second, vertex_third, DVec3::ZERO)
}

/// Returns the plane of the tile's image.
pub fn next_plane(centre: DVec3, facet: ProxyGeometryFacet) -> ProxyGeometryPlane {
    plane(centre, facet.vertex_first, facet.vertex_second, facet.vertex_third)
}
