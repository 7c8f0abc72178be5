//! Light on a scene: its lights and the environment, as the recipes bind them. Each is added to the
//! frame when the first pipeline reads it, and only once.

use super::{RenderError, Settings, environment, harmonics};
use crate::frame::{Bound, Buffer, Builder, PipelineId, Texture};
use crate::record::Record;
use glam::{Vec3, Vec4};
use lapidary_scene::light::Falloff;
use lapidary_scene::{Light, Scene};
use std::cell::OnceCell;

/// Resources of the parts `surroundings`, `lights` and `harmonics`.
pub(super) struct Lighting<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    environment: OnceCell<Texture>,
    lights: OnceCell<Buffer>,
    harmonics: OnceCell<Buffer>,
}

impl<'a> Lighting<'a> {
    /// Takes the scene's lights and the settings' environment.
    pub(super) fn new(scene: &'a Scene, settings: &'a Settings) -> Self {
        let (environment, lights, harmonics) = Default::default();
        Self { scene, settings, environment, lights, harmonics }
    }

    /// Returns the environment's texture.
    pub(super) fn environment(&self, builder: &mut Builder<'_>) -> Result<Texture, RenderError> {
        if let Some(known) = self.environment.get() {
            return Ok(*known);
        }
        // Whichever object asks first, the texture belongs to all objects.
        let made = builder.of_object("", |builder| environment::texture(builder, &self.settings.environment))?;
        Ok(*self.environment.get_or_init(|| made))
    }

    /// Returns the list of lights.
    pub(super) fn lights(&self, builder: &mut Builder<'_>) -> Buffer {
        *self.lights.get_or_init(|| {
            let lights = lights(self.scene);
            builder.of_object("", |builder| builder.records("lights", lights, wgpu::BufferUsages::STORAGE))
        })
    }

    /// Returns the environment's diffuse light.
    fn harmonics(&self, builder: &mut Builder<'_>) -> Buffer {
        *self.harmonics.get_or_init(|| {
            let coefficients = harmonics::project(&self.settings.environment);
            let coefficients: Vec<Vec4> =
                coefficients.iter().map(|coefficient| coefficient.as_vec3().extend(0.0)).collect();
            let harmonics = Record::new("Harmonics").with("coefficients", &coefficients[..]);
            builder.of_object("", |builder| builder.uniform("harmonics", harmonics))
        })
    }

    /// Returns the resources that `pipeline` reads from bindings 1 to 3 of group 0.
    pub(super) fn shared(
        &self,
        builder: &mut Builder<'_>,
        pipeline: PipelineId,
    ) -> Result<Vec<(u32, Bound)>, RenderError> {
        let mut shared = Vec::new();
        if builder.binds(pipeline, 0, 1) {
            shared.push((1, self.environment(builder)?.into()));
        }
        if builder.binds(pipeline, 0, 2) {
            shared.push((2, self.lights(builder).into()));
        }
        if builder.binds(pipeline, 0, 3) {
            shared.push((3, self.harmonics(builder).into()));
        }
        Ok(shared)
    }
}

/// Returns the recipe's `Light` structs in order; one black light if the scene has none.
fn lights(scene: &Scene) -> Vec<Record> {
    // No axis, and all directions within the edge.
    let everywhere = (Vec3::ZERO, Falloff { edge: -1.0, slope: 1.0 });
    let entry = |place: Vec3, point: f32, power: Vec3, (axis, falloff): (Vec3, Falloff)| {
        // The slope of the narrowest cones exceeds the range of f32.
        let [edge, slope] = [falloff.edge as f32, falloff.slope.min(f32::MAX.into()) as f32];
        let record = Record::new("Light").with("place", place).with("point", point).with("power", power);
        record.with("edge", edge).with("axis", axis).with("slope", slope)
    };
    let mut entries: Vec<Record> = scene
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
    entries
}
