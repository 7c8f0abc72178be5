//! What shines on a scene, on the device: its lights and the environment, as the recipes for what scatters light bind them.

use super::device::{buffer, uniform};
use super::pass::Shared;
use super::{Environment, RenderError, Settings, environment, harmonics};
use crate::gpu::Gpu;
use crate::scene::light::Falloff;
use crate::scene::{Light, Scene};
use glam::{DVec3, Vec3};

/// The parts `surroundings`, `lights` and `harmonics`.
pub(super) struct Lighting {
    environment: wgpu::TextureView,
    pub(super) lights: wgpu::Buffer,
    pub(super) harmonics: wgpu::Buffer,
}

impl Lighting {
    /// The scene's lights and the settings' environment.
    pub(super) fn upload(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Self, RenderError> {
        let environment = environment::texture(gpu, &settings.environment)?;
        let coefficients = if settings.light_from_environment {
            harmonics::project(&settings.environment)
        } else {
            [DVec3::ZERO; harmonics::COUNT]
        };
        let coefficients: Vec<f32> =
            coefficients.iter().flat_map(|coefficient| coefficient.as_vec3().extend(0.0).to_array()).collect();
        let [lights, harmonics] = gpu.guarded("uploading lights", |device| {
            let lights = buffer(device, bytemuck::cast_slice(&lights(scene)), wgpu::BufferUsages::STORAGE);
            [lights, uniform(device, &coefficients)]
        })?;
        Ok(Self { environment, lights, harmonics })
    }

    /// Bindings 1 to 3 of group 0.
    pub(super) fn shared(self) -> Vec<Shared> {
        vec![Shared::Texture(self.environment), Shared::Buffer(self.lights), Shared::Buffer(self.harmonics)]
    }
}

/// The overrides of the parts `surroundings`, `lights` and `reflection`, and of the environment's diffuse light.
pub(super) fn constants(scene: &Scene, settings: &Settings) -> [(&'static str, f64); 5] {
    let flag = |on: bool| f64::from(u8::from(on));
    let materials = || scene.objects.iter().map(|object| &object.material);
    let polished = materials().any(|material| material.roughness == 0.0 && material.ior > 1.0);
    let rough = materials().any(|material| material.roughness > 0.0 && material.ior > 1.0);
    let spots = scene.lights.iter().any(|light| matches!(light, Light::Spot { .. }));
    [
        ("EFFECT_ENVIRONMENT", flag(settings.light_from_environment)),
        ("EFFECT_ENVIRONMENT_MAP", flag(matches!(settings.environment, Environment::Map(_)))),
        ("EFFECT_MICROFACET", flag(settings.reflection && rough)),
        ("EFFECT_REFLECTION", flag(settings.reflection && polished)),
        ("EFFECT_SPOT", flag(spots)),
    ]
}

/// `Light` of the recipe, 12 floats each; one black light where there is none.
fn lights(scene: &Scene) -> Vec<f32> {
    // No axis, and all directions within the edge.
    let everywhere = (Vec3::ZERO, Falloff { edge: -1.0, slope: 1.0 });
    let entry = |place: Vec3, point: f32, power: Vec3, (axis, falloff): (Vec3, Falloff)| {
        // Of the narrowest cones the slope is beyond f32.
        let [edge, slope] = [falloff.edge as f32, falloff.slope.min(f32::MAX.into()) as f32];
        let (place, power, axis) = (place.extend(point), power.extend(edge), axis.extend(slope));
        [place.to_array(), power.to_array(), axis.to_array()]
    };
    let mut entries: Vec<[[f32; 4]; 3]> = scene
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
    entries.as_flattened().concat()
}
