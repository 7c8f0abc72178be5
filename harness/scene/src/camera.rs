//! The camera, and how to place one so that a body fills the picture.

use glam::{DVec3, Vec3};

/// A perspective camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the camera.
    pub eye: Vec3,
    /// A point on the line of sight, different from `eye`.
    pub target: Vec3,
    /// Upward direction of the picture: unit length, not along the line of sight.
    pub up: Vec3,
    /// Angle between the picture's lower and upper edge in radians, above 0 and below π.
    pub vertical_fov: f32,
}

/// Fraction of the picture's height that a framed body fills: tight, with room for its glow.
const FILL_HEIGHT: f64 = 0.75;
/// Fraction of a square picture's width that a framed body may fill.
const FILL_WIDTH: f64 = 0.9;

impl Camera {
    /// Returns a camera at `eye` that looks at `target`, a different point not directly above or
    /// below it, with its upward direction towards +y.
    #[must_use]
    pub fn upright(eye: Vec3, target: Vec3, vertical_fov: f32) -> Self {
        let back = (eye - target).as_dvec3().normalize();
        let right = DVec3::Y.cross(back).normalize();
        Self { eye, target, up: back.cross(right).as_vec3(), vertical_fov }
    }

    /// Returns a camera that sees all `points`, from the direction `toward_eye`, with the given
    /// vertical field of view in radians (above 0, below π).
    ///
    /// In a square picture the points fill three quarters of the height or nine tenths of the
    /// width, whichever is reached first, and lie in the middle. The distance is exact, not that of
    /// a bounding sphere. Without points, or with all in one place, the camera stands one unit
    /// away. A zero-length `toward_eye` counts as +z.
    #[must_use]
    pub fn framing(points: impl Iterator<Item = Vec3> + Clone, toward_eye: Vec3, vertical_fov: f32) -> Self {
        let back = toward_eye.as_dvec3().normalize_or(DVec3::Z);
        let vertical = if back.y.abs() > 0.999 { DVec3::Z } else { DVec3::Y };
        let right = vertical.cross(back).normalize();
        let up = back.cross(right);
        let points = points.map(Vec3::as_dvec3);

        let half = (0.5 * f64::from(vertical_fov)).tan();
        let high = Extent::of(points.clone(), up, back, FILL_HEIGHT * half);
        let wide = Extent::of(points.clone(), right, back, FILL_WIDTH * half);
        let front = points.clone().map(|p| p.dot(back)).reduce(f64::max).unwrap_or(0.0);
        let rear = points.map(|p| p.dot(back)).reduce(f64::min).unwrap_or(0.0);
        let mut distance = high.distance.max(wide.distance);
        if distance - front <= 1e-6 * distance.abs() {
            distance = front + 1.0;
        }
        let in_plane = up * high.middle + right * wide.middle;
        Self {
            eye: (in_plane + back * distance).as_vec3(),
            target: (in_plane + back * (0.5 * (front + rear))).as_vec3(),
            up: up.as_vec3(),
            vertical_fov,
        }
    }
}

/// Returns the unit vector `polar` degrees off the vertical and `azimuth` degrees from +z towards +x.
pub(crate) fn direction(polar: f32, azimuth: f32) -> Vec3 {
    let (across, along) = polar.to_radians().sin_cos();
    let (x, z) = azimuth.to_radians().sin_cos();
    Vec3::new(across * x, along, across * z)
}

/// Extent of points along one picture axis.
#[derive(Debug, Clone, Copy)]
struct Extent {
    /// Smallest distance of the eye, along the line of sight from the origin, that keeps all points
    /// within the slope.
    distance: f64,
    /// Position of the eye on the axis at that distance.
    middle: f64,
}

impl Extent {
    /// A point at `y` on the axis and `w` towards the eye is within `slope` of the line of sight if
    /// |y - middle| <= slope (distance - w). So only the largest y + slope·w and -y + slope·w
    /// matter, and at the smallest distance both hold with equality.
    fn of(points: impl Iterator<Item = DVec3>, axis: DVec3, back: DVec3, slope: f64) -> Self {
        let reach = points
            .map(|point| (point.dot(axis), slope * point.dot(back)))
            .map(|(y, w)| (y + w, w - y))
            .reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)));
        let (above, below) = reach.unwrap_or((0.0, 0.0));
        Self { distance: 0.5 * (above + below) / slope, middle: 0.5 * (above - below) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the picture coordinates of a point: 1 at the right and upper edge of a square
    /// picture.
    fn project(camera: &Camera, point: Vec3) -> (f32, f32) {
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let offset = point - camera.eye;
        let scale = offset.dot(forward) * (0.5 * camera.vertical_fov).tan();
        assert!(scale > 0.0, "{point} lies behind the camera");
        (offset.dot(right) / scale, offset.dot(camera.up) / scale)
    }

    #[test]
    fn framing_fills_the_height_or_the_width() {
        let shapes = [Vec3::new(1.0, 3.0, 1.0), Vec3::new(5.0, 1.0, 2.0)];
        for (half, height_rules) in shapes.into_iter().zip([true, false]) {
            let corners = (0..8u8).map(|k| {
                let sign = |bit: u8| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
                Vec3::splat(7.0) + half * Vec3::new(sign(0), sign(1), sign(2))
            });
            let camera = Camera::framing(corners.clone(), Vec3::new(0.3, 0.5, 1.0), 0.5);
            let seen: Vec<_> = corners.map(|corner| project(&camera, corner)).collect();
            let largest = |f: fn(&(f32, f32)) -> f32| seen.iter().map(f).fold(f32::MIN, f32::max);
            let (right, left) = (largest(|p| p.0), largest(|p| -p.0));
            let (top, bottom) = (largest(|p| p.1), largest(|p| -p.1));
            assert!(top.max(bottom) < 0.7501 && right.max(left) < 0.9001);
            if height_rules {
                assert!(top > 0.7499 && bottom > 0.7499);
            } else {
                assert!(right > 0.8999 && left > 0.8999);
            }
        }
    }

    #[test]
    fn an_upright_camera_has_its_target_in_the_middle_and_what_is_above_above() {
        let (eye, target) = (Vec3::new(3.0, 8.0, -5.0), Vec3::new(-1.0, 2.0, 4.0));
        let camera = Camera::upright(eye, target, 0.5);
        assert!(camera.up.is_normalized() && camera.up.dot(eye - target).abs() < 1e-5);
        let (x, y) = project(&camera, target);
        assert!(x.abs() < 1e-6 && y.abs() < 1e-6);
        let (x, y) = project(&camera, target + Vec3::Y);
        assert!(x.abs() < 1e-6 && y > 0.1);
    }

    #[test]
    fn framing_nothing_or_one_point_still_gives_a_camera() {
        for points in [vec![], vec![Vec3::splat(3.0)], vec![Vec3::ZERO; 4]] {
            for direction in [Vec3::Z, Vec3::Y, Vec3::ZERO] {
                let camera = Camera::framing(points.iter().copied(), direction, 0.5);
                assert!((camera.eye.distance(camera.target) - 1.0).abs() < 1e-5);
                assert!(camera.up.is_normalized());
            }
        }
    }
}
