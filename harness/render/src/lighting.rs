//! What shines on a scene, on the device: its lights and the environment, as the recipes bind them. Each is made when
//! the first pipeline reads it, and once for all.

use super::device::{Pipeline, storage, uniform};
use super::pass::Shared;
use super::{RenderError, Settings, environment, harmonics};
use crate::record::Record;
use glam::{Vec3, Vec4};
use lapidary_gpu::Gpu;
use lapidary_gpu::capture::OfObject;
use lapidary_scene::light::Falloff;
use lapidary_scene::{Light, Scene};
use std::cell::OnceCell;

/// The parts `surroundings`, `lights` and `harmonics`.
pub(super) struct Lighting<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    settings: &'a Settings,
    environment: OnceCell<wgpu::TextureView>,
    lights: OnceCell<wgpu::Buffer>,
    harmonics: OnceCell<wgpu::Buffer>,
}

impl<'a> Lighting<'a> {
    /// The scene's lights and the settings' environment.
    pub(super) fn new(gpu: &'a Gpu, scene: &'a Scene, settings: &'a Settings) -> Self {
        let (environment, lights, harmonics) = Default::default();
        Self { gpu, scene, settings, environment, lights, harmonics }
    }

    /// The environment's image.
    pub(super) fn environment(&self) -> Result<&wgpu::TextureView, RenderError> {
        once(&self.environment, || environment::texture(self.gpu, &self.settings.environment))
    }

    /// The list of lights.
    pub(super) fn lights(&self) -> Result<&wgpu::Buffer, RenderError> {
        once(&self.lights, || {
            let lights = lights(self.scene);
            Ok(self.gpu.guarded("uploading lights", |device| storage(device, "lights", &lights))?)
        })
    }

    /// The environment's diffuse light.
    pub(super) fn harmonics(&self) -> Result<&wgpu::Buffer, RenderError> {
        once(&self.harmonics, || {
            let coefficients = harmonics::project(&self.settings.environment);
            let coefficients: Vec<Vec4> =
                coefficients.iter().map(|coefficient| coefficient.as_vec3().extend(0.0)).collect();
            let harmonics = Record::new("Harmonics").with("coefficients", &coefficients[..]).bytes();
            Ok(self.gpu.guarded("uploading lights", |device| uniform(device, "harmonics", &harmonics))?)
        })
    }

    /// What `pipeline` reads of bindings 1 to 3 of group 0.
    pub(super) fn shared(&self, pipeline: &Pipeline) -> Result<Vec<(u32, Shared)>, RenderError> {
        let mut shared = Vec::new();
        if pipeline.binds(0, 1) {
            shared.push((1, Shared::Texture(self.environment()?.clone())));
        }
        if pipeline.binds(0, 2) {
            shared.push((2, Shared::Buffer(self.lights()?.clone())));
        }
        if pipeline.binds(0, 3) {
            shared.push((3, Shared::Buffer(self.harmonics()?.clone())));
        }
        Ok(shared)
    }
}

/// What is in the cell, made now where nothing is.
fn once<T>(cell: &OnceCell<T>, make: impl FnOnce() -> Result<T, RenderError>) -> Result<&T, RenderError> {
    if let Some(known) = cell.get() {
        return Ok(known);
    }
    // Whoever asks first, it is all objects'.
    let _of = OfObject::named("");
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}

/// `Light` of the recipe, one after the other; one black light where there is none.
fn lights(scene: &Scene) -> Vec<u8> {
    // No axis, and all directions within the edge.
    let everywhere = (Vec3::ZERO, Falloff { edge: -1.0, slope: 1.0 });
    let entry = |place: Vec3, point: f32, power: Vec3, (axis, falloff): (Vec3, Falloff)| {
        // Of the narrowest cones the slope is beyond f32.
        let [edge, slope] = [falloff.edge as f32, falloff.slope.min(f32::MAX.into()) as f32];
        let record = Record::new("Light").with("place", place).with("point", point).with("power", power);
        record.with("edge", edge).with("axis", axis).with("slope", slope).bytes()
    };
    let mut entries: Vec<Vec<u8>> = scene
        .lights
        .iter()
        .map(|light| match *light {
            Light::Directional { toward, irradiance } => entry(toward, 0.0, irradiance, everywhere),
            Light::Point { position, intensity } => entry(position, 1.0, intensity, everywhere),
            Light::Spot { position, direction, intensity, inner_angle, outer_angle } => {
                entry(position, 1.0, intensity, (direction, Falloff::between(inner_angle, outer_angle)))
            }
        })
        .collect();
    if entries.is_empty() {
        entries.push(entry(Vec3::Y, 0.0, Vec3::ZERO, everywhere));
    }
    entries.concat()
}
