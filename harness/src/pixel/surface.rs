//! Which point of a mesh a pixel shows.

use crate::render::clip_from_world;
use crate::scene::{Mesh, Scene};
use glam::{DMat4, DVec3, DVec4, Vec3};

/// A point of a mesh's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where.
    pub position: Vec3,
    /// On which triangle, by the mesh's own numbers.
    pub triangle: u32,
}

/// The eye of a picture: from its coordinates in pixels to rays.
pub struct Viewer {
    world_from_clip: DMat4,
    eye: DVec3,
    width: f64,
    height: f64,
}

impl Viewer {
    /// The viewer of a picture of `scene`.
    pub fn new(scene: &Scene, width: u32, height: u32) -> Self {
        let matrix = clip_from_world(scene, width, height).as_dmat4();
        Self {
            world_from_clip: matrix.inverse(),
            eye: scene.camera.eye.as_dvec3(),
            width: f64::from(width),
            height: f64::from(height),
        }
    }

    /// The direction from the eye through a point of the picture, in pixels from its upper left corner.
    fn direction(&self, x: f64, y: f64) -> DVec3 {
        let clip = DVec4::new(2.0 * x / self.width - 1.0, 1.0 - 2.0 * y / self.height, 0.5, 1.0);
        let world = self.world_from_clip * clip;
        (world.truncate() / world.w - self.eye).normalize()
    }

    /// The front of `mesh` that is seen at a point of the picture, if any.
    pub fn see(&self, mesh: &Mesh, x: f64, y: f64) -> Option<SurfacePoint> {
        let direction = self.direction(x, y);
        let mut nearest: Option<(f64, u32)> = None;
        for (number, corners) in (0..).zip(mesh.triangles()) {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3() - self.eye);
            // Volumes of the tetrahedra that the ray spans with the edges: all of one sign inside the triangle, seen from its front.
            let edges = [(b, c), (c, a), (a, b)].map(|(from, to)| direction.dot(from.cross(to)));
            let volume: f64 = edges.iter().sum();
            if volume >= 0.0 || edges.iter().any(|&edge| edge > 0.0) {
                continue;
            }
            let distance = a.dot(b.cross(c)) / volume;
            if nearest.is_none_or(|(best, _)| distance < best) {
                nearest = Some((distance, number));
            }
        }
        nearest.map(|(distance, triangle)| self.point(direction, distance, triangle))
    }

    fn point(&self, direction: DVec3, distance: f64, triangle: u32) -> SurfacePoint {
        SurfacePoint { position: (self.eye + distance * direction).as_vec3(), triangle }
    }
}
