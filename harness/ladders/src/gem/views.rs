//! The views of the gem ladder: several cuts from several angles, each with a committed reference.

use crate::error::CostError;
use lapidary_plan::Rung;
use lapidary_reference::spectral;
use lapidary_render::{Picture, Settings};
use lapidary_scene::{Camera, Scene, SceneError};
use lapidary_snapshots as snapshot;
use std::path::PathBuf;

/// Width and height of a reference picture in pixels.
pub const SIDE: u32 = 256;

/// A scene and a viewpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The view's name, which is also the file name of its reference.
    pub name: &'static str,
    /// Name of the built-in scene.
    pub scene: &'static str,
    /// Camera angles in degrees: polar angle from the vertical, and azimuth from +z towards +x;
    /// `None` for the scene's own camera.
    pub from: Option<(f32, f32)>,
    /// Whether the reference has fewer samples and a looser energy bound, [`COARSE`].
    pub coarse: bool,
}

/// Samples along each side of a pixel and energy bound of a coarse reference.
pub const COARSE: (u32, f64) = (2, 1e-3);

const fn own(scene: &'static str) -> View {
    View { name: scene, scene, from: None, coarse: false }
}

/// The views in which every rung is compared. Face-up and tilted bracket how a brilliant is worn;
/// the step cut has long parallel facets, the octahedron few facets, quartz a low index, and the
/// sapphire a colour of its own.
pub const VIEWS: [View; 7] = [
    View { name: "brilliant_face_up", from: Some((0.0, 0.0)), ..own("brilliant") },
    own("brilliant"),
    View { name: "brilliant_tilted", from: Some((45.0, 11.0)), ..own("brilliant") },
    own("step_cut"),
    own("octahedron"),
    own("quartz"),
    own("sapphire"),
];

/// Additional views for rungs that draw bodies of any shape: one dented body, and several bodies in
/// one mesh.
pub const CONCAVE: [View; 2] = [own("bunny_stone"), own("prism_chain")];

/// Views that have a reference but are not part of the ladder, because they show nothing new. In
/// the chandelier a ray meets so many prisms that a reference of the usual quality would take eight
/// hours on one core.
pub const SHOWN: [View; 3] = [own("prism"), own("ruby"), View { coarse: true, ..own("chandelier") }];

impl View {
    /// Returns the view with that name.
    pub fn named(name: &str) -> Option<Self> {
        VIEWS.into_iter().chain(CONCAVE).chain(SHOWN).find(|view| view.name == name)
    }

    /// Returns the scene with this view's camera.
    pub fn open(&self) -> Result<Scene, SceneError> {
        let scene = Scene::named(self.scene)?;
        Ok(match self.from {
            None => scene,
            Some((polar, azimuth)) => scene.seen_from(polar, azimuth),
        })
    }

    /// Returns the path of the view's reference.
    pub fn reference_file(&self) -> PathBuf {
        snapshot::folder("gem").join("reference").join(format!("{}.exr", self.name))
    }

    /// Returns the command that remakes the reference.
    pub fn command(&self) -> String {
        let file = format!("snapshots/gem/reference/{}.exr", self.name);
        let from = self.from.map_or(String::new(), |(polar, azimuth)| format!(" --from {polar},{azimuth}"));
        let (samples, bound) = COARSE;
        let quality = if self.coarse { format!(" --samples {samples} --energy-bound {bound}") } else { String::new() };
        format!("./cook render {}{from} --rung reference --size {SIDE}x{SIDE}{quality} --out {file}", self.scene)
    }

    /// Returns the settings that the reference is rendered with.
    pub fn reference_settings(&self) -> spectral::Settings<'static> {
        let usual = spectral::Settings::of_size(SIDE, SIDE);
        let (samples, energy_bound) = COARSE;
        if self.coarse { spectral::Settings { samples, energy_bound, ..usual } } else { usual }
    }

    /// Returns the committed reference, both linear and encoded for display.
    pub fn reference(&self, gpu: &lapidary_gpu::Gpu) -> Result<Picture, CostError> {
        if !self.reference_file().exists() {
            return Err(CostError::NoReference { path: self.reference_file(), command: self.command() });
        }
        let settings = Settings { rung: Rung::Reference, ..Settings::of_size(SIDE, SIDE) };
        Ok(snapshot::reference_picture(gpu, &self.reference_file(), &settings)?)
    }
}

/// Camera rotation from one frame to the next in degrees: a slow turn of 3° per second at 60 frames
/// per second.
const TURN: f32 = 0.05;

/// Returns the scene in the next frame of a slow turn: the eye rotates about its target.
pub fn turned(scene: &Scene) -> Scene {
    let Camera { eye, target, up, .. } = scene.camera;
    let turn = glam::Quat::from_axis_angle(up, TURN.to_radians());
    Scene { camera: Camera { eye: target + turn * (eye - target), ..scene.camera }, ..scene.clone() }
}

/// Returns the scene as it is timed: so close that the stone fills the frame.
pub fn filled(scene: &Scene) -> Scene {
    // The largest 16:9 rectangle that fits within the girdle, seen at an angle and with a margin:
    // half its diagonal is 0.7 of the radius.
    let bounds = scene.bounds();
    let camera = scene.camera;
    let distance = camera.eye.distance(bounds.centre());
    let half_height = 0.7 * 0.5 * (bounds.max.x - bounds.min.x) * 9.0 / (16f32.hypot(9.0));
    let camera = Camera { target: bounds.centre(), vertical_fov: 2.0 * (half_height / distance).atan(), ..camera };
    Scene { camera, ..scene.clone() }
}
