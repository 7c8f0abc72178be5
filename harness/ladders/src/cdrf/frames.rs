//! The frames of a rung that are timed, and the memory that they need besides mesh and material.

use super::rungs::{MEASURES, VIEWS};
use super::shader;
use crate::error::CostError;
use crate::options::Options;
use crate::report::{Report, Row};
use crate::timing::{self, Timed};
use glam::{Vec2, Vec3};
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render::texture_diffusion::{IRRADIANCE_FORMAT, STRETCH_FORMAT};
use lapidary_render::{Curvature, DiffuseOptions, FrameTimer, Settings};
use lapidary_scene::solver::Reflectance;
use lapidary_scene::{Camera, Scene, SceneError};

/// Name of the timed scene.
const SCENE: &str = "skin_bunny";

/// The part of a renderer's work that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Diffuse light only: the body fills the frame, under one light.
    Lit,
    /// A whole frame: the body in front of a backdrop, in the studio and under one light, with
    /// specular reflection, tone-mapped and encoded.
    Whole,
}

impl Part {
    /// Both parts.
    const ALL: [Self; 2] = [Self::Lit, Self::Whole];
}

/// The source of curvature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CurvatureSource {
    /// Screen-space derivatives at the pixel.
    Screen,
    /// Per-vertex values in the mesh.
    Vertex,
}

impl CurvatureSource {
    /// Both sources.
    const ALL: [Self; 2] = [Self::Screen, Self::Vertex];

    fn curvature(self) -> Curvature {
        match self {
            Self::Screen => Curvature::Mean,
            Self::Vertex => Curvature::Vertex,
        }
    }
}

/// The scenes that are drawn, one per part.
pub(super) struct Scenes {
    lit: Scene,
    whole: Scene,
}

impl Scenes {
    pub(super) fn new() -> Result<Self, SceneError> {
        let whole = Scene::named(SCENE)?;
        Ok(Self { lit: filled(&whole), whole })
    }

    fn of(&self, part: Part) -> &Scene {
        match part {
            Part::Lit => &self.lit,
            Part::Whole => &self.whole,
        }
    }

    /// Returns the number of vertices of the displayed mesh; halo vertices occur only in its
    /// texture.
    pub(super) fn vertices(&self) -> usize {
        self.whole.objects.iter().map(|object| object.mesh.without_halo().positions.len()).sum()
    }

    /// Returns the bytes of mesh data that a rung needs besides positions, normals and indices of
    /// the displayed mesh.
    pub(super) fn mesh_bytes(&self, reflectance: Reflectance) -> u64 {
        let shown = self.vertices();
        let bytes = match reflectance {
            Reflectance::Lambert | Reflectance::LambertShadowed => 0,
            // Texture coordinates, the vertices of halos, and a list of triangles including halos.
            Reflectance::Blur => {
                let meshes = || self.whole.objects.iter().map(|object| &object.mesh);
                let vertices: usize = meshes().map(|mesh| mesh.positions.len()).sum();
                let drawn: usize = meshes().map(|mesh| mesh.halo.len() + mesh.indices.len()).sum();
                vertices * size_of::<Vec2>() + (vertices - shown) * 2 * size_of::<Vec3>() + drawn * size_of::<u32>()
            }
            // A curvature per vertex, if it comes from the mesh.
            _ => shown * size_of::<f32>(),
        };
        bytes as u64
    }
}

/// A view of the bunny so close that its flank fills a 16:9 frame: centre of the flank and height
/// of the frame, in halves of the picture's height.
const FLANK: ([f32; 2], f32) = ([0.07, -0.19], 0.22);

fn filled(scene: &Scene) -> Scene {
    let camera = scene.camera;
    let ([right, up], half_height) = FLANK;
    let half = (0.5 * camera.vertical_fov).tan();
    let forward = (camera.target - camera.eye).normalize_or(Vec3::NEG_Z);
    let across = forward.cross(camera.up);
    let to_flank = forward + half * (right * across + up * camera.up);
    let target = camera.eye + camera.eye.distance(camera.target) * to_flank;
    let camera = Camera { target, vertical_fov: 2.0 * (half_height * half).atan(), ..camera };
    Scene { camera, ..scene.clone() }
}

fn settings(part: Part, curvature: Option<CurvatureSource>, reflectance: Reflectance, frame: [u32; 2]) -> Settings {
    let whole = part == Part::Whole;
    Settings {
        samples: 1,
        rung: Rung::Diffuse(reflectance),
        without: if whole { Effects::NONE } else { Effects::of(&[Effect::Environment]).and(Effects::SHEEN) },
        diffuse: DiffuseOptions {
            curvature: curvature.map_or(Curvature::Mean, CurvatureSource::curvature),
            ..DiffuseOptions::default()
        },
        ..Settings::of_size(frame[0], frame[1])
    }
}

/// Returns the settings of a rung's frames, in the order of [`VIEWS`]; a rung that does not use
/// curvature has the same frame with either source.
fn frames(reflectance: Reflectance, size: [u32; 2]) -> Vec<(Part, Option<CurvatureSource>, Settings)> {
    let uses = !matches!(reflectance, Reflectance::Lambert | Reflectance::LambertShadowed | Reflectance::Blur);
    let views = Part::ALL.into_iter().flat_map(|part| CurvatureSource::ALL.map(|source| (part, source)));
    let frame = |(part, source): (Part, CurvatureSource)| {
        let source = uses.then_some(source);
        (part, source, settings(part, source, reflectance, size))
    };
    views.map(frame).collect()
}

/// Adds the rungs' frames in all views, timed interleaved. `errors` has the rungs' errors by
/// [`MEASURES`], in the order of the options.
pub(super) fn measure(
    gpu: &Gpu,
    scenes: &Scenes,
    options: &Options<Reflectance>,
    errors: &[Option<[f64; MEASURES.len()]>],
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let mut rows = Vec::new();
    let mut timed: Vec<Timed<'_>> = Vec::new();
    for (&reflectance, errors) in options.rungs.iter().zip(errors) {
        let mut known: Vec<(Part, Option<CurvatureSource>, usize)> = Vec::new();
        for ((part, source, settings), view) in frames(reflectance, options.frame).into_iter().zip(VIEWS) {
            let counts = shader::counts(scenes.of(part), &settings, reflectance)?;
            let row = Row {
                bytes: Some(texture_bytes(reflectance)),
                instructions: vec![counts.vertex_instructions, counts.fragment_instructions],
                ..Row::new(reflectance.name(), view, "", None, "")
            };
            let same = known.iter().find(|other| (other.0, other.1) == (part, source)).map(|other| other.2);
            let index = same.unwrap_or_else(|| {
                timed.push(Timed {
                    displayed: part == Part::Whole,
                    // The blur's texture does not shrink with the picture.
                    scales: reflectance != Reflectance::Blur,
                    ..Timed::new(scenes.of(part), settings)
                });
                timed.len() - 1
            });
            known.push((part, source, index));
            rows.push((row, errors, index));
        }
    }
    let timings = timing::time(gpu, &timed, options.rounds, progress)?;
    for (row, errors, index) in rows {
        let timing = timings[index].as_ref();
        for (place, measure) in MEASURES.into_iter().enumerate() {
            let error = errors.map(|errors| errors[place]);
            report.rows.push(Row::new(&row.rung, &row.view, measure, error, "").timed(timing.map(|timing| timing.ms)));
        }
        report.add_time(row, timing);
    }
    Ok(())
}

/// Returns the bytes of a rung's textures for one material.
pub(super) fn texture_bytes(reflectance: Reflectance) -> u64 {
    let bytes = |format: wgpu::TextureFormat, side: u32| {
        u64::from(format.block_copy_size(None).unwrap_or_default()) * u64::from(side).pow(2)
    };
    match reflectance {
        Reflectance::Table(side, format) => bytes(lapidary_render::cdrf::table::format(format), side),
        // Irradiance before and after each pass of the blur, and the stretch.
        Reflectance::Blur => {
            2 * bytes(IRRADIANCE_FORMAT, FrameTimer::BLUR_SIDE) + bytes(STRETCH_FORMAT, FrameTimer::BLUR_SIDE)
        }
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_assay::extremum::larger;
    use lapidary_gpu::AdapterChoice;
    use lapidary_render as render;
    use lapidary_scene::solver::Format;

    #[test]
    fn the_lit_part_fills_the_frame_and_the_whole_does_not() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let scenes = Scenes::new().expect("built in");
        for part in Part::ALL {
            let settings = settings(part, None, Reflectance::Lambert, [320, 180]);
            let picture = render::render(gpu, scenes.of(part), &settings).expect("rendered");
            let covered = picture.linear.iter().filter(|pixel| pixel[3] > 0.0).count();
            assert_eq!(covered == 320 * 180, part == Part::Lit, "{covered}");
            // Both the lit and the shadow side are visible.
            let red: Vec<f32> = picture.linear.iter().filter(|pixel| pixel[3] > 0.0).map(|pixel| pixel[0]).collect();
            let (least, most) = (red.iter().copied().fold(f32::MAX, f32::min), red.iter().copied().fold(0.0, larger));
            assert!(most > 4.0 * least, "{part:?}: {least} {most}");
        }
    }

    #[test]
    fn memory_is_what_is_bound() {
        assert_eq!(texture_bytes(Reflectance::Table(256, Format::Rgba8)), 256 * 256 * 4);
        assert_eq!(texture_bytes(Reflectance::Table(257, Format::Rgba16Float)), 257 * 257 * 8);
        assert_eq!(texture_bytes(Reflectance::Table(257, Format::R32Float)), 257 * 257 * 4);
        assert_eq!(texture_bytes(Reflectance::Blur), 3 * 8 * 1024 * 1024);
        assert_eq!(texture_bytes(Reflectance::Accurate), 0);
        let scenes = Scenes::new().expect("built in");
        let curvatures = scenes.mesh_bytes(Reflectance::Accurate);
        assert_eq!((scenes.mesh_bytes(Reflectance::Lambert), curvatures), (0, 4 * scenes.vertices() as u64));
        // Two floats and at least one index per vertex, plus the halos.
        assert!(scenes.mesh_bytes(Reflectance::Blur) > 3 * curvatures);
    }
}
