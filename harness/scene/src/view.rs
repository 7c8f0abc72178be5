//! Maps positions in the picture to directions, as the rasteriser does.

use crate::{Bounds, Camera, Scene};
use glam::{DVec3, Mat4, Vec3};

/// Returns the matrix from world to clip space for a whole picture of `scene`. Depth runs from 0
/// (near) to 1 (far).
#[must_use]
pub fn clip_from_world(scene: &Scene, width: u32, height: u32) -> Mat4 {
    let camera = &scene.camera;
    let (near, far) = depth_range(camera, &scene.bounds());
    let aspect = width as f32 / height as f32;
    let clip_from_view = glam::camera::rh::proj::directx::perspective(camera.vertical_fov, aspect, near, far);
    clip_from_view * glam::camera::rh::view::look_at_mat4(camera.eye, camera.target, camera.up)
}

/// Returns near and far distances that enclose the scene, with a ratio of at most 1e4 so that depth
/// keeps its digits.
fn depth_range(camera: &Camera, bounds: &Bounds) -> (f32, f32) {
    let forward = (camera.target - camera.eye).normalize_or(Vec3::NEG_Z);
    let middle = (bounds.centre() - camera.eye).dot(forward);
    let radius = bounds.radius().max(f32::MIN_POSITIVE);
    let far = (middle + 1.01 * radius).max(radius * 1e-3);
    let near = (middle - 1.01 * radius).max(far * 1e-4);
    (near, far)
}

/// A camera with a picture of a given size.
pub struct View {
    /// Position of the camera.
    pub eye: DVec3,
    /// Line of sight, and half the sides of the picture at distance 1.
    forward: DVec3,
    half_right: DVec3,
    half_up: DVec3,
    width: f64,
    height: f64,
}

impl View {
    /// Returns a camera with a picture of `width` × `height` pixels.
    #[must_use]
    pub fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let (eye, target) = (camera.eye.as_dvec3(), camera.target.as_dvec3());
        let (width, height) = (f64::from(width), f64::from(height));
        let forward = (target - eye).normalize_or(DVec3::NEG_Z);
        let right = forward.cross(camera.up.as_dvec3()).normalize_or(DVec3::X);
        let half = (0.5 * f64::from(camera.vertical_fov)).tan();
        Self {
            eye,
            forward,
            half_right: right * (half * width / height),
            half_up: right.cross(forward) * half,
            width,
            height,
        }
    }

    /// Returns the unit direction through the position `x` pixels from the left and `y` pixels from
    /// the top; pixel k spans k to k + 1.
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        let right = 2.0 * x / self.width - 1.0;
        let up = 1.0 - 2.0 * y / self.height;
        (self.forward + self.half_right * right + self.half_up * up).normalize()
    }

    /// Returns how the picture shows a point, or `None` if it lies behind the eye or outside the
    /// picture.
    pub fn sight(&self, point: DVec3) -> Option<Sight> {
        let way = point - self.eye;
        let depth = way.dot(self.forward);
        if depth <= 0.0 {
            return None;
        }
        let along = |half: DVec3| way.dot(half) / (depth * half.length_squared());
        let x = 0.5 * self.width * (1.0 + along(self.half_right));
        let y = 0.5 * self.height * (1.0 - along(self.half_up));
        if !((0.0..self.width).contains(&x) && (0.0..self.height).contains(&y)) {
            return None;
        }
        let distance = way.length();
        // A pixel's area at depth 1, from half the sides.
        let pixel = 4.0 * self.half_right.length() * self.half_up.length() / (self.width * self.height);
        Some(Sight { x, y, toward: -way / distance, distance, weight: distance / (depth.powi(3) * pixel) })
    }
}

/// How a picture shows a point.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// Distance from the left edge in pixels.
    pub x: f64,
    /// Distance from the top edge in pixels.
    pub y: f64,
    /// Unit direction from the point to the eye.
    pub toward: DVec3,
    /// Distance from the point to the eye.
    pub distance: f64,
    /// Mean radiance over the pixel added by a radiant intensity of 1 at the point.
    pub weight: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec3, Vec4Swizzles as _};

    /// The solid angle of a pixel is that spanned by the directions to its corners.
    #[test]
    fn an_intensity_is_spread_over_a_pixels_solid_angle() {
        let camera = Camera { vertical_fov: 0.9, ..Camera::framing([Vec3::ZERO].into_iter(), Vec3::Z, 0.9) };
        let view = View::new(&camera, 64, 48);
        for (x, y) in [(32.0, 24.0), (0.5, 0.5), (60.5, 10.5)] {
            let shift = 1e-3;
            let [right, down] = [(shift, 0.0), (0.0, shift)]
                .map(|(a, b)| (view.direction(x + a, y + b) - view.direction(x - a, y - b)) / (2.0 * shift));
            let solid_angle = right.cross(down).length();
            let sight = view.sight(view.eye + 3.0 * view.direction(x, y)).expect("in the picture");
            // The irradiance at the eye from a point of intensity 1, divided by the solid angle.
            assert!((sight.weight * 9.0 * solid_angle - 1.0).abs() < 1e-6, "{sight:?}");
        }
        assert!(view.sight(view.eye - view.direction(32.0, 24.0)).is_none());
        assert!(view.sight(view.eye + view.direction(-1.0, 24.0)).is_none());
    }

    /// The matrix behind the renderer's camera, to f32 precision.
    #[test]
    fn directions_project_back_to_their_pixels() {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 5.0),
            target: Vec3::new(0.0, 0.5, 0.0),
            up: Vec3::new(0.1, 1.0, 0.0).normalize(),
            vertical_fov: 0.47,
        };
        let (width, height) = (640, 480);
        let view = View::new(&camera, width, height);
        let projection = glam::camera::rh::proj::directx::perspective(camera.vertical_fov, 4.0 / 3.0, 0.1, 100.0);
        let clip = projection * glam::camera::rh::view::look_at_mat4(camera.eye, camera.target, camera.up);
        for (x, y) in [(0.125, 0.875), (320.0, 240.0), (639.5, 10.25), (17.0, 479.0)] {
            let point = camera.eye + 7.0 * view.direction(x, y).as_vec3();
            let projected = clip * point.extend(1.0);
            let sight = view.sight(camera.eye.as_dvec3() + 7.0 * view.direction(x, y)).expect("in the picture");
            assert!((sight.x - x).abs() < 1e-9 && (sight.y - y).abs() < 1e-9 && (sight.distance - 7.0).abs() < 1e-12);
            let [right, up] = (projected.xy() / projected.w).to_array().map(f64::from);
            assert!((0.5 * (right + 1.0) * f64::from(width) - x).abs() < 1e-3);
            assert!((0.5 * (1.0 - up) * f64::from(height) - y).abs() < 1e-3);
        }
    }
}
