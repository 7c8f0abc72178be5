//! From places on the picture to directions, as the rasteriser maps them.

use crate::scene::Camera;
use glam::DVec3;

/// A camera over a picture of a given size.
pub(crate) struct View {
    /// The camera's place.
    pub(crate) eye: DVec3,
    /// The line of sight, and the picture's half sides at distance 1.
    forward: DVec3,
    half_right: DVec3,
    half_up: DVec3,
    width: f64,
    height: f64,
}

impl View {
    pub(crate) fn new(camera: &Camera, width: u32, height: u32) -> Self {
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

    /// The unit direction in which `x` pixels from the left and `y` pixels from the top lie; pixel k spans k to k + 1.
    pub(crate) fn direction(&self, x: f64, y: f64) -> DVec3 {
        let right = 2.0 * x / self.width - 1.0;
        let up = 1.0 - 2.0 * y / self.height;
        (self.forward + self.half_right * right + self.half_up * up).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec3, Vec4Swizzles as _};

    /// The matrix that the renderer's camera is made of, with f32's digits.
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
            let [right, up] = (projected.xy() / projected.w).to_array().map(f64::from);
            assert!((0.5 * (right + 1.0) * f64::from(width) - x).abs() < 1e-3);
            assert!((0.5 * (1.0 - up) * f64::from(height) - y).abs() < 1e-3);
        }
    }
}
