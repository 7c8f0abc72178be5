//! The point of a mesh that a pixel shows.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use lapidary_scene::{Mesh, Scene, clip_from_world};

/// A point of a mesh's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position of the point.
    pub position: Vec3,
    /// Number of its triangle, in the mesh's own order.
    pub triangle: u32,
}

/// The eye of a picture: maps coordinates in pixels to rays.
pub struct Viewer {
    clip_from_world: DMat4,
    world_from_clip: DMat4,
    eye: DVec3,
    width: f64,
    height: f64,
}

impl Viewer {
    /// Creates the viewer of a picture of `scene`.
    pub fn new(scene: &Scene, width: u32, height: u32) -> Self {
        let matrix = clip_from_world(scene, width, height).as_dmat4();
        Self {
            clip_from_world: matrix,
            world_from_clip: matrix.inverse(),
            eye: scene.camera.eye.as_dvec3(),
            width: f64::from(width),
            height: f64::from(height),
        }
    }

    /// Returns the direction from the eye through a point of the picture, in pixels from its upper
    /// left corner.
    fn direction(&self, x: f64, y: f64) -> DVec3 {
        // On the far plane: near the eye, the matrix's rounding would turn the direction.
        let clip = DVec4::new(2.0 * x / self.width - 1.0, 1.0 - 2.0 * y / self.height, 1.0, 1.0);
        let world = self.world_from_clip * clip;
        (world.truncate() / world.w - self.eye).normalize()
    }

    /// Returns where a world point in front of the eye appears, in pixels from the picture's upper
    /// left corner.
    pub fn place(&self, position: Vec3) -> DVec2 {
        let clip = self.clip_from_world.project_point3(position.as_dvec3());
        0.5 * DVec2::new((clip.x + 1.0) * self.width, (1.0 - clip.y) * self.height)
    }

    /// Returns the length in pixels of all edges of the front faces of `mesh`, including those
    /// hidden by other front faces. A shared edge counts twice.
    pub fn edge_length(&self, mesh: &Mesh) -> f64 {
        let of_front = |corners: [Vec3; 3]| {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3() - self.eye);
            let places = corners.map(|corner| self.place(corner));
            let length: f64 = (0..3).map(|k| places[k].distance(places[(k + 1) % 3])).sum();
            // The eye is on the side that the normal points to.
            if a.dot(b.cross(c)) < 0.0 { length } else { 0.0 }
        };
        mesh.triangles().map(of_front).sum()
    }

    /// Returns the point of a front face of `mesh` that is seen at a point of the picture, or
    /// `None`.
    pub fn see(&self, mesh: &Mesh, x: f64, y: f64) -> Option<SurfacePoint> {
        let direction = self.direction(x, y);
        let mut nearest: Option<(f64, u32)> = None;
        for (number, corners) in (0..).zip(mesh.triangles()) {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3() - self.eye);
            // Volumes of the tetrahedra that the ray spans with the edges: all of one sign inside
            // the triangle, seen from its front.
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
