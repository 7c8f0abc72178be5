//! Translucent marble in motion: the light, the camera, a body's shape, and which parts hang together.

use glam::{DVec2, Vec3};
use lapidary_render::Stage;
use lapidary_scene::deform::{merging, twisting};
use lapidary_scene::{Bounds, Light, Object, Scene, SceneError};
use std::f32::consts::PI;

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// The light goes round the bunny.
    Light,
    /// The camera goes round the figure.
    Camera,
    /// The figure twists by a quarter of a turn to either side.
    Deformation,
    /// Two drops meet, and light goes through the bridge between them.
    Topology,
}

impl Motion {
    /// All motions.
    pub const ALL: [Self; 4] = [Self::Light, Self::Camera, Self::Deformation, Self::Topology];

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Camera => "camera",
            Self::Deformation => "deformation",
            Self::Topology => "topology",
        }
    }

    /// The first stage of a frame whose results the motion changes.
    #[must_use]
    pub fn changes(self) -> Stage {
        match self {
            Self::Light => Stage::Maps,
            Self::Camera => Stage::Shade,
            Self::Deformation | Self::Topology => Stage::Voxels,
        }
    }

    /// Returns the scene at a time from 0 to 1.
    ///
    /// # Errors
    /// Returns an error if a built-in scene does not load.
    pub fn scene(self, time: f64) -> Result<Scene, SceneError> {
        let share = time as f32;
        match self {
            Self::Light => Ok(Scene { lights: vec![sun(-100.0 - 160.0 * share, 0.25)], ..Scene::named("bunny")? }),
            Self::Camera => {
                let figure = Scene { lights: vec![sun(-150.0, 0.3)], ..Scene::named("figure")? };
                Ok(figure.seen_from(80.0, -80.0 + 180.0 * share))
            }
            Self::Deformation => {
                let figure = Scene::named("figure")?;
                let still = &figure.objects[0];
                let bounds = Bounds::of(still.mesh.positions.iter().copied());
                let axis = DVec2::new(bounds.centre().x.into(), bounds.centre().z.into());
                let heights = [bounds.min.y, bounds.max.y].map(f64::from);
                let mesh = twisting(&still.mesh, axis, heights, (0.75 + 0.5 * time).fract());
                let objects = vec![Object { mesh, ..still.clone() }];
                Ok(Scene { objects, lights: vec![sun(-150.0, 0.3)], ..figure })
            }
            Self::Topology => {
                let bunny = Scene::named("bunny")?;
                let drops = |time| Object { name: "drops".to_owned(), mesh: merging(time), ..bunny.objects[0].clone() };
                let separate = Scene { objects: vec![drops(0.0)], ..bunny.clone() }.seen_from(75.0, 20.0);
                Ok(Scene { objects: vec![drops(time)], lights: vec![sun(-150.0, 0.4)], ..separate })
            }
        }
    }
}

/// Returns a sun at `azimuth` degrees from +z towards +x and at `height` above the horizon.
fn sun(azimuth: f32, height: f32) -> Light {
    let (x, z) = azimuth.to_radians().sin_cos();
    Light::Directional { toward: Vec3::new(x, height, z).normalize(), irradiance: Vec3::splat(1.4 * PI) }
}
