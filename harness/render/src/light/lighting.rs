//! Light on a scene: its lights and the environment, as the recipes bind them. Each is added to the
//! frame when the first pipeline reads it, and only once.

use super::beside::{self, Beside};
use super::blurred;
use super::environment;
use super::from_bodies::{self, Body};
use super::hierarchy::Hierarchy;
use super::screen::{self, Picture};
use crate::error::RenderError;
use crate::frame::record::Record;
use crate::frame::{Bound, Buffer, Builder, PipelineId, Sampler, Texture};
use crate::objects::mesh_buffers::Shapes;
use crate::settings::Settings;
use glam::{DVec3, Vec3, Vec4};
use lapidary_plan::Effect;
use lapidary_scene::light::Falloff;
use lapidary_scene::{Light, Object, Scene, harmonics};
use std::cell::OnceCell;

/// Binding of the part `glints` in group 0.
const GLINTS: u32 = 16;

/// Resources of the parts `surroundings`, `lights`, `harmonics`, `screen` and `bodies`.
pub(crate) struct Lighting<'a> {
    pub(crate) scene: &'a Scene,
    settings: &'a Settings,
    environment: OnceCell<Texture>,
    lights: OnceCell<Buffer>,
    around: OnceCell<[DVec3; harmonics::COUNT]>,
    harmonics: OnceCell<Buffer>,
    screen: OnceCell<Picture>,
    bodies: OnceCell<Buffer>,
    hierarchy: OnceCell<Hierarchy>,
    beside: OnceCell<Beside>,
    glints: OnceCell<Buffer>,
    blurred: OnceCell<Texture>,
    metal: OnceCell<(Texture, Sampler)>,
    /// What keeps light from others.
    pub(crate) shapes: Shapes,
    /// Size of the largest picture in samples.
    size: [u32; 2],
}

impl<'a> Lighting<'a> {
    /// Takes the scene's lights and bodies and the settings' environment, for pictures of up to this
    /// size in samples.
    pub(crate) fn new(scene: &'a Scene, settings: &'a Settings, size: [u32; 2]) -> Self {
        let (environment, lights, around, harmonics, screen, bodies, shapes) = Default::default();
        let (hierarchy, beside, glints, blurred, metal) = Default::default();
        Self {
            scene,
            settings,
            environment,
            lights,
            around,
            harmonics,
            screen,
            bodies,
            hierarchy,
            beside,
            glints,
            blurred,
            metal,
            shapes,
            size,
        }
    }

    /// Returns the picture of the bodies that are not clear stones, once a pipeline reads it, and how
    /// far they reach behind their front.
    pub(crate) fn screen_in_use(&self) -> Option<(Picture, f32)> {
        self.screen.get().map(|picture| (*picture, screen::thickness(self.scene, self.settings)))
    }

    /// Returns the picture of the bodies that are not clear stones.
    fn screen(&self, builder: &mut Builder<'_>) -> Result<Picture, RenderError> {
        if let Some(known) = self.screen.get() {
            return Ok(*known);
        }
        let size = screen::size_of_whole(self.settings).unwrap_or(self.size);
        let made = builder.of_object("", |builder| Picture::new(builder, size))?;
        Ok(*self.screen.get_or_init(|| made))
    }

    /// Returns the bounds of the scene's bodies.
    fn bodies(&self, builder: &mut Builder<'_>) -> Buffer {
        *self.bodies.get_or_init(|| {
            let records = from_bodies::all(self.scene, self.around()).iter().map(Body::record).collect();
            builder.of_object("", |builder| builder.records("bodies", records, wgpu::BufferUsages::STORAGE))
        })
    }

    /// Returns the sizes of the lights' discs.
    fn glints(&self, builder: &mut Builder<'_>) -> Buffer {
        *self.glints.get_or_init(|| {
            let scene = self.scene;
            let footprint = self.settings.footprint_of(&scene.camera);
            let radii = (0..scene.lights.len().max(1)).map(|number| scene.light_radius(number));
            let words: Vec<f32> = std::iter::once(footprint).chain(radii).collect();
            builder.of_object("", |builder| builder.storage("glints", bytemuck::cast_slice(&words)))
        })
    }

    /// Returns the hierarchy of all bodies.
    pub(crate) fn hierarchy(&self, builder: &mut Builder<'_>) -> Result<&Hierarchy, RenderError> {
        if let Some(known) = self.hierarchy.get() {
            return Ok(known);
        }
        let made = Hierarchy::new(builder, self.scene, self.settings)?;
        Ok(self.hierarchy.get_or_init(|| made))
    }

    /// Returns the triangles of the bodies that are not clear.
    fn beside(&self, builder: &mut Builder<'_>) -> Result<Beside, RenderError> {
        if let Some(known) = self.beside.get() {
            return Ok(*known);
        }
        let metals = !self.settings.without.has(Effect::Metal);
        let made = Beside::new(builder, self.scene, self.around(), metals)?;
        Ok(*self.beside.get_or_init(|| made))
    }

    /// Returns the environment blurred for rough metals.
    fn blurred(&self, builder: &mut Builder<'_>) -> Result<Texture, RenderError> {
        if let Some(known) = self.blurred.get() {
            return Ok(*known);
        }
        let made = builder.of_object("", |builder| blurred::texture(builder, &self.settings.environment))?;
        Ok(*self.blurred.get_or_init(|| made))
    }

    /// Returns the table of what metals reflect, and its sampler.
    fn metal(&self, builder: &mut Builder<'_>) -> Result<(Texture, Sampler), RenderError> {
        if let Some(known) = self.metal.get() {
            return Ok(*known);
        }
        let made = builder.of_object("", blurred::table)?;
        Ok(*self.metal.get_or_init(|| made))
    }

    /// Returns the number of an object that is borrowed from the scene.
    pub(crate) fn number_of(&self, object: &Object) -> usize {
        let number = self.scene.objects.iter().position(|other| std::ptr::eq(other, object));
        number.expect("what is drawn is borrowed from the scene")
    }

    /// Returns the environment's texture.
    pub(crate) fn environment(&self, builder: &mut Builder<'_>) -> Result<Texture, RenderError> {
        if let Some(known) = self.environment.get() {
            return Ok(*known);
        }
        // Whichever object asks first, the texture belongs to all objects.
        let made = builder.of_object("", |builder| environment::texture(builder, &self.settings.environment))?;
        Ok(*self.environment.get_or_init(|| made))
    }

    /// Returns the list of lights.
    pub(crate) fn lights(&self, builder: &mut Builder<'_>) -> Buffer {
        *self.lights.get_or_init(|| {
            let lights = lights(self.scene);
            // A host may move them.
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
            builder.of_object("", |builder| builder.records("lights", lights, usage))
        })
    }

    /// Returns the environment's harmonics.
    fn around(&self) -> &[DVec3; harmonics::COUNT] {
        self.around.get_or_init(|| environment::around(self.settings))
    }

    /// Whether an environment lights the bodies.
    pub(crate) fn has_environment(&self) -> bool {
        !self.settings.without.has(Effect::Environment)
    }

    /// Returns a bound of the irradiance from all around, for each channel: what falls on no surface is
    /// more.
    pub(crate) fn largest_around(&self) -> Vec3 {
        if !self.has_environment() {
            return Vec3::ZERO;
        }
        harmonics::largest_irradiance(self.around()).as_vec3()
    }

    /// Returns the environment's diffuse light.
    pub(crate) fn harmonics(&self, builder: &mut Builder<'_>) -> Buffer {
        *self.harmonics.get_or_init(|| {
            let coefficients: Vec<Vec4> =
                self.around().iter().map(|coefficient| coefficient.as_vec3().extend(0.0)).collect();
            let harmonics = Record::new("Harmonics").with("coefficients", &coefficients[..]);
            builder.of_object("", |builder| builder.uniform("harmonics", harmonics))
        })
    }

    /// Returns the resources that `pipeline` reads from bindings 1 to 3, 7 to 9 and 11 to 23 of group 0; 4, 5
    /// and 10 are shadow maps, 6 is the view of the screen.
    pub(crate) fn shared(
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
        if builder.binds(pipeline, 0, screen::RADIANCE) {
            let picture = self.screen(builder)?;
            shared.extend([(screen::RADIANCE, picture.radiance.into()), (screen::DEPTH, picture.depth.into())]);
        }
        if builder.binds(pipeline, 0, from_bodies::BINDING) {
            shared.push((from_bodies::BINDING, self.bodies(builder).into()));
        }
        if builder.binds(pipeline, 0, GLINTS) {
            shared.push((GLINTS, self.glints(builder).into()));
        }
        if builder.binds(pipeline, 0, beside::BINDINGS[0]) {
            let Beside { nodes, corners } = self.beside(builder)?;
            shared.extend(beside::BINDINGS.into_iter().zip([nodes.into(), corners.into()]));
        }
        if builder.binds(pipeline, 0, blurred::ENVIRONMENT) {
            shared.push((blurred::ENVIRONMENT, self.blurred(builder)?.into()));
        }
        let [sampler, table] = blurred::TABLES;
        if builder.binds(pipeline, 0, table) {
            let (reflectance, smooth) = self.metal(builder)?;
            shared.extend([(sampler, smooth.into()), (table, reflectance.into())]);
        }
        if Hierarchy::is_read(builder, pipeline) {
            shared.extend(self.hierarchy(builder)?.shared(builder, pipeline)?);
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
