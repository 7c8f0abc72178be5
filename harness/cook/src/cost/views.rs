//! What the gem ladder is looked at with: several cuts, from several angles, each with its committed reference.

use super::CostError;
use crate::snapshot;
use lapidary_plan::Rung;
use lapidary_reference::spectral;
use lapidary_render::{Picture, Settings};
use lapidary_scene::{Camera, Scene, SceneError};
use std::path::PathBuf;

/// Side of a reference picture.
pub const SIDE: u32 = 256;

/// A scene and where it is seen from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Its name, and that of its reference's file.
    pub name: &'static str,
    /// The built-in scene.
    pub scene: &'static str,
    /// Degrees off the vertical, and from +z towards +x; the scene's own camera where there are none.
    pub from: Option<(f32, f32)>,
    /// Whether its reference has fewer samples and a looser bound, [`COARSE`].
    pub coarse: bool,
}

/// Samples a side and energy bound of a coarse reference.
pub const COARSE: (u32, f64) = (2, 1e-3);

const fn own(scene: &'static str) -> View {
    View { name: scene, scene, from: None, coarse: false }
}

/// The views that every rung is compared in. Face-up and tilted bracket how a brilliant is worn; the step cut has long
/// parallel facets, the octahedron few, quartz a low index, and the sapphire a colour of its own.
pub const VIEWS: [View; 7] = [
    View { name: "brilliant_face_up", from: Some((0.0, 0.0)), ..own("brilliant") },
    own("brilliant"),
    View { name: "brilliant_tilted", from: Some((45.0, 11.0)), ..own("brilliant") },
    own("step_cut"),
    own("octahedron"),
    own("quartz"),
    own("sapphire"),
];

/// The views that rungs for bodies of any shape are compared in as well: one dented, and several in one mesh.
pub const CONCAVE: [View; 2] = [own("bunny_stone"), own("prism_chain")];

/// Views with a reference that the ladder leaves out: they show nothing that those above do not. A ray in the chandelier meets so many prisms
/// that its picture would take eight hours of a core at the usual quality.
pub const SHOWN: [View; 3] = [own("prism"), own("ruby"), View { coarse: true, ..own("chandelier") }];

impl View {
    /// The view of that name.
    pub fn named(name: &str) -> Option<Self> {
        VIEWS.into_iter().chain(CONCAVE).chain(SHOWN).find(|view| view.name == name)
    }

    /// The scene with this view's camera.
    pub fn open(&self) -> Result<Scene, SceneError> {
        let scene = Scene::named(self.scene)?;
        Ok(match self.from {
            None => scene,
            Some((polar, azimuth)) => scene.seen_from(polar, azimuth),
        })
    }

    /// Where its reference is kept.
    pub fn reference_file(&self) -> PathBuf {
        snapshot::folder("gem").join("reference").join(format!("{}.exr", self.name))
    }

    /// The command that remakes its reference.
    pub fn command(&self) -> String {
        let file = format!("snapshots/gem/reference/{}.exr", self.name);
        let from = self.from.map_or(String::new(), |(polar, azimuth)| format!(" --from {polar},{azimuth}"));
        let (samples, bound) = COARSE;
        let quality = if self.coarse { format!(" --samples {samples} --energy-bound {bound}") } else { String::new() };
        format!("./cook render {}{from} --rung reference --size {SIDE}x{SIDE}{quality} --out {file}", self.scene)
    }

    /// How its reference is made.
    pub fn reference_settings(&self) -> spectral::Settings<'static> {
        let usual = spectral::Settings::of_size(SIDE, SIDE);
        let (samples, energy_bound) = COARSE;
        if self.coarse { spectral::Settings { samples, energy_bound, ..usual } } else { usual }
    }

    /// Its committed reference, linear and as it is seen.
    pub fn reference(&self, gpu: &lapidary_gpu::Gpu) -> Result<Picture, CostError> {
        if !self.reference_file().exists() {
            return Err(CostError::NoReference { path: self.reference_file(), command: self.command() });
        }
        let settings = Settings { rung: Rung::Reference, ..Settings::of_size(SIDE, SIDE) };
        Ok(snapshot::reference_picture(gpu, &self.reference_file(), &settings)?)
    }
}

/// By how much a camera is turned from one frame to the next: a slow turn of 3° a second at 60 frames.
const TURN: f32 = 0.05;

/// The scene in the next frame of a slow turn: the eye goes sideways about what it looks at.
pub fn turned(scene: &Scene) -> Scene {
    let Camera { eye, target, up, .. } = scene.camera;
    let turn = glam::Quat::from_axis_angle(up, TURN.to_radians());
    Scene { camera: Camera { eye: target + turn * (eye - target), ..scene.camera }, ..scene.clone() }
}

/// How a frame is timed: so near that the stone fills it.
pub fn filled(scene: &Scene) -> Scene {
    // The largest 16:9 rectangle within the girdle, seen at a slant, with a margin: half its diagonal is 0.7 of the radius.
    let bounds = scene.bounds();
    let camera = scene.camera;
    let distance = camera.eye.distance(bounds.centre());
    let half_height = 0.7 * 0.5 * (bounds.max.x - bounds.min.x) * 9.0 / (16f32.hypot(9.0));
    let camera = Camera { target: bounds.centre(), vertical_fov: 2.0 * (half_height / distance).atan(), ..camera };
    Scene { camera, ..scene.clone() }
}
