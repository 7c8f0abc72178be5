//! The plane of least squares through points, and how far they bind it.

use glam::{DVec2, DVec3};

use crate::polyhedron::Plane;

/// Returns the plane through `points` whose sum of squared distances is least, with its normal on the side of `normal`, from which it
/// may differ by a few degrees; `None` if they lie in a line, to a thousandth of their extent.
pub(super) fn fitted(points: &[DVec3], normal: DVec3) -> Option<Plane> {
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let mut normal = normal.try_normalize()?;
    // A plane z = a x + b y over the one before; the second pass makes heights distances.
    for _ in 0..2 {
        let [across, along] = [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())];
        let (mut xx, mut xy, mut yy, mut slope) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for point in points {
            let from = *point - middle;
            let (x, y, z) = (from.dot(across), from.dot(along), from.dot(normal));
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
            slope += z * DVec2::new(x, y);
        }
        let determinant = xx * yy - xy * xy;
        if determinant <= 1e-6 * (xx + yy).powi(2) {
            return None;
        }
        let slope = DVec2::new(yy * slope.x - xy * slope.y, xx * slope.y - xy * slope.x) / determinant;
        normal = (normal - slope.x * across - slope.y * along).normalize();
    }
    Some(Plane { normal, distance: normal.dot(middle) })
}

/// Returns the least extent of points within a plane: the least distance between two parallel lines in it that hold them between them.
pub(super) fn width(points: &[DVec3], normal: DVec3) -> f64 {
    // One of the lines of the least pair holds a side of the points' convex hull, so two of them.
    let pairs = points.iter().enumerate().flat_map(|(k, from)| points[k + 1..].iter().map(move |to| *to - *from));
    let extent = |across: DVec3| {
        let heights = points.iter().map(|point| point.dot(across));
        heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min)
    };
    let across = pairs.filter_map(|along| normal.cross(along).try_normalize());
    across.map(extent).reduce(f64::min).unwrap_or(0.0)
}

/// Returns the greatest distance of points from a plane.
pub(super) fn reach(points: &[DVec3], plane: &Plane) -> f64 {
    points.iter().map(|point| plane.height(*point).abs()).fold(0.0, f64::max)
}
