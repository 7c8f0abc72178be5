//! What a material requires: for each effect, whether it is on under the rung that draws the
//! object, and the property that decides.

mod clear;

use super::among;
use super::casting::{self, Casting};
use super::choice::{self, Choice};
use super::chosen::Chosen;
use super::effect::{Effect, Effects};
use super::enclosed;
use super::numbers::{short, triple};
use super::remembered::holding;
use crate::{Geometry, Quality, Request, Rung};
use glam::Vec3;
use lapidary_scene::solver::Reflectance;
use lapidary_scene::{Coverage, Density, Environment, Light, Material, Medium, Object, Scene, TextureSlot};

/// Whether an effect is on, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The effect decided on.
    pub effect: Effect,
    /// Whether the effect is compiled, bound and run.
    pub on: bool,
    /// The property of the material, scene or request that decides.
    pub reason: String,
}

/// The rung and effects of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Decisions {
    /// The rung, which also names the technique.
    pub rung: Rung,
    /// Why this technique was chosen.
    pub reason: String,
    /// Technique and quality that determine the rung; `None` if the rung was named.
    pub chosen: Option<Chosen>,
    /// One decision per effect, in the order of [`Effect::ALL`].
    pub effects: Vec<Decision>,
}

impl Decisions {
    /// Returns the decisions for all objects of `scene`, in order.
    #[must_use]
    pub fn all(scene: &Scene, request: &Request<'_>) -> Vec<Self> {
        holding(scene, || scene.objects.iter().map(|object| Self::of(object, scene, request)).collect())
    }

    /// Returns the decisions for one object of `scene`.
    #[must_use]
    pub fn of(object: &Object, scene: &Scene, request: &Request<'_>) -> Self {
        holding(scene, || Self::decided(object, scene, request))
    }

    fn decided(object: &Object, scene: &Scene, request: &Request<'_>) -> Self {
        let (choice, reason) = choice::of(object, scene, request);
        let (rung, chosen) = match choice {
            Choice::Named(rung) => (rung, None),
            Choice::By(technique) => {
                let chosen = Chosen { technique, quality: request.quality };
                (chosen.rung(), Some(chosen))
            }
        };
        let case = Case { object, material: &object.material, scene, request, rung };
        let decide = |effect: Effect| {
            let (on, reason) = case.decide(effect);
            if on && request.without.has(effect) {
                return Decision { effect, on: false, reason: format!("left out on request, though {reason}") };
            }
            Decision { effect, on, reason }
        };
        Self { rung, reason, chosen, effects: Effect::ALL.map(decide).into() }
    }

    /// Whether an effect is on.
    #[must_use]
    pub fn has(&self, effect: Effect) -> bool {
        self.effects.iter().any(|decision| decision.effect == effect && decision.on)
    }

    /// Returns the set of effects that are on.
    #[must_use]
    pub fn on(&self) -> Effects {
        let on = self.effects.iter().filter(|decision| decision.on);
        on.fold(Effects::NONE, |set, decision| set.and(Effects::of(&[decision.effect])))
    }

    /// Returns the values of the recipes' overrides: name, and 1 if the effect is on, else 0.
    pub fn constants(&self) -> Vec<(&'static str, f64)> {
        let constant = |decision: &Decision| (decision.effect.override_name(), f64::from(u8::from(decision.on)));
        self.effects.iter().map(constant).collect()
    }
}

/// One object under one rung.
struct Case<'a> {
    object: &'a Object,
    material: &'a Material,
    scene: &'a Scene,
    request: &'a Request<'a>,
    rung: Rung,
}

type Answer = (bool, String);

fn on(reason: impl Into<String>) -> Answer {
    (true, reason.into())
}

fn off(reason: impl Into<String>) -> Answer {
    (false, reason.into())
}

impl Case<'_> {
    fn decide(&self, effect: Effect) -> Answer {
        if self.rung == Rung::Reference {
            return off("the reference is computed on the CPU, by no recipe");
        }
        match effect {
            Effect::ProxyGeometry => self.inside(effect, Geometry::Proxy),
            Effect::ConvexTrace => self
                .inside(effect, if self.rung.geometry() == Geometry::Walk { Geometry::Walk } else { Geometry::Convex }),
            Effect::BvhTrace => self.inside(effect, Geometry::Bvh),
            Effect::ThinWall => self.thin_wall(),
            Effect::Absorption => self.absorption(),
            Effect::Dispersion => self.dispersion(),
            Effect::Instances => self.instances(),
            Effect::Footprint => self.footprint(),
            Effect::ScreenTrace => self.screen_trace(),
            Effect::BoundsTrace => self.bounds_trace(),
            // Others need not be measured for them.
            Effect::Nested | Effect::Behind | Effect::Around | Effect::Smooth | Effect::Rough | Effect::Light
                if !self.is_gem() =>
            {
                off(self.not_clear())
            }
            Effect::Nested => self.nested(),
            Effect::Behind => self.behind(),
            Effect::Around => self.around(),
            Effect::Smooth => self.smooth(),
            Effect::Rough => self.rough(),
            Effect::Light => self.light(),
            Effect::Cdrf => self.cdrf(),
            Effect::TextureDiffusion => self.texture_diffusion(),
            Effect::HalfSpace => self.half_space(),
            Effect::OpticalPath => self.optical_path(),
            Effect::Diffusion => self.diffusion(),
            Effect::Surface => {
                self.along_a_way().map_or_else(off, |()| on("light also goes through what is thinner than a voxel"))
            }
            Effect::Color => self.color(),
            Effect::LampInside => self.lamp_inside(),
            Effect::ExtinctionPerVoxel => self.extinction_per_voxel(),
            Effect::Shadow => self.shadow(),
            Effect::TranslucentShadow => self.translucent_shadow(),
            Effect::ColoredShadow => self.colored_shadow(),
            Effect::Environment => self.environment(),
            Effect::Dielectric => self.dielectric(),
            Effect::EnvironmentMap => self.environment_map(),
            Effect::BaseColorTexture => self.image(TextureSlot::BaseColor),
            Effect::NormalTexture => self.image(TextureSlot::Normal),
            Effect::RoughnessTexture if self.is_gem() => off("a clear body has one roughness"),
            Effect::RoughnessTexture => self.image(TextureSlot::MetallicRoughness),
            Effect::ThicknessTexture if self.is_gem() => off("light goes through the mesh itself"),
            Effect::ThicknessTexture => self.on_light_that_spreads(self.image(TextureSlot::Thickness)),
            Effect::PartialTransmission => self.partial_transmission(),
            Effect::TransmissionTexture => self.transmission_texture(),
            Effect::VertexColor => self.vertex_color(),
            Effect::Coverage => self.coverage(),
            Effect::Microfacet => self.microfacet(),
            Effect::SecondLobe => self.second_lobe(),
            Effect::Reflection => self.reflection(),
            Effect::Metal => self.metal(),
            Effect::Spot => self.spot(),
        }
    }

    fn cdrf(&self) -> Answer {
        let Rung::Diffuse(reflectance) = self.rung else {
            return match self.rung {
                _ if self.is_gem() => self.spread_met(),
                Rung::OpticalPath(_) | Rung::Diffusion(_) => off("light is followed through the body instead"),
                _ => off("nothing inside scatters"),
            };
        };
        let Some(sigma0) = super::thickness::sigma0(self.material) else {
            return off("nothing inside scatters");
        };
        if sigma0 == Vec3::ZERO {
            return off("sigma0 0");
        }
        match reflectance {
            Reflectance::Lambert | Reflectance::LambertShadowed => return off("the rung is Lambert's law"),
            Reflectance::Blur => return off("light is blurred in the texture instead"),
            _ => {}
        }
        if self.is_flat() {
            return off("curvature everywhere 0");
        }
        if let (Rung::Diffuse(Reflectance::Drift), Some(path)) = (self.rung, super::thickness::free_path(self.material))
        {
            let from = if self.material.medium.is_some() { "" } else { " from sigma0 and base color" };
            return on(format!("free path {}{from}", triple(path)));
        }
        let from = if self.material.sigma0.is_some() { "" } else { " from scattering and absorption" };
        on(format!("sigma0 {}{from}", triple(sigma0)))
    }

    /// Whether every triangle has the same normal at all corners, so that curvature spreads no
    /// light.
    fn is_flat(&self) -> bool {
        let normals = &self.object.mesh.normals;
        let normal = |index: &u32| normals.get(*index as usize);
        self.object.mesh.indices.chunks_exact(3).all(|corners| {
            let first = normal(&corners[0]);
            corners.iter().all(|corner| normal(corner) == first)
        })
    }

    fn texture_diffusion(&self) -> Answer {
        match self.rung {
            Rung::Diffuse(Reflectance::Blur) => on("the rung is blur"),
            Rung::Diffuse(reflectance) if reflectance.is_lambert() && self.material.scatters() => {
                off("the rung is Lambert's law")
            }
            Rung::Diffuse(_) if self.material.scatters() => {
                off(format!("the rung {} spreads light by curvature", self.rung))
            }
            Rung::OpticalPath(_) | Rung::Diffusion(_) => off("light is followed through the body instead"),
            _ => off("nothing inside scatters"),
        }
    }

    fn half_space(&self) -> Answer {
        if self.is_gem() {
            return self.law_met();
        }
        match self.rung {
            Rung::Diffusion(_) => return off("part of diffusion"),
            Rung::Diffuse(_) | Rung::OpticalPath(_) if !self.material.scatters() => {
                return off("nothing inside scatters");
            }
            Rung::Diffuse(Reflectance::Blur) => return off("the texture holds light of every direction"),
            Rung::Diffuse(_) | Rung::OpticalPath(_) => {}
            _ => return off(self.not_clear()),
        }
        if !self.request.half_space && self.request.rung_of(self.object) != Rung::ByMaterial {
            return off("a rung is asked for: --with half_space");
        }
        if !self.request.half_space && self.request.quality == Quality::Fast {
            return off("quality fast");
        }
        match super::thickness::albedo(self.material) {
            Some(albedo) => on(format!("albedo {}", triple(albedo))),
            None => on(format!("base color {}", triple(self.material.base_color))),
        }
    }

    /// Whether light is followed through the body by a technique, which is that of the rung or not.
    fn through(&self, is_the_rungs: bool) -> Answer {
        match self.rung {
            Rung::OpticalPath(_) | Rung::Diffusion(_) if !is_the_rungs => {
                off(format!("the rung {} follows light through the body", self.rung))
            }
            Rung::OpticalPath(_) if self.scene.lights.is_empty() => {
                off("no light but the environment, which goes no way through bodies")
            }
            Rung::Diffusion(_) if self.scene.lights.is_empty() && self.request.without.has(Effect::Environment) => {
                off("no light")
            }
            Rung::OpticalPath(_) | Rung::Diffusion(_) => {
                let called = self.material.medium.as_ref().map(|Medium { scattering, absorption, .. }| {
                    format!("scattering {}, absorption {}", triple(*scattering), triple(*absorption))
                });
                on(called.unwrap_or_else(|| "the rung".to_owned()))
            }
            Rung::Diffuse(_) if self.material.scatters() => off("no light is followed through the body"),
            _ => off("nothing inside scatters"),
        }
    }

    fn optical_path(&self) -> Answer {
        self.through(matches!(self.rung, Rung::OpticalPath(_)))
    }

    fn diffusion(&self) -> Answer {
        self.through(matches!(self.rung, Rung::Diffusion(_)))
    }

    fn lamp_inside(&self) -> Answer {
        if let Some(missing) = self.missing(Effect::Diffusion, self.diffusion()) {
            return missing;
        }
        match enclosed::count(self.object, &self.scene.lights) {
            0 => off("no lamp stands inside"),
            1 => on("a lamp stands inside"),
            many => on(format!("{many} lamps stand inside")),
        }
    }

    /// Returns `Ok` if light is followed through the body on voxels, else the reason why not.
    fn on_voxels(&self) -> Result<(), String> {
        let effect = if matches!(self.rung, Rung::Diffusion(_)) { Effect::Diffusion } else { Effect::OpticalPath };
        match self.through(true) {
            (true, _) if self.request.without.has(effect) => Err(format!("{effect} is left out")),
            (true, _) => Ok(()),
            (false, reason) => Err(reason),
        }
    }

    /// Returns `Ok` if light paths through the body are followed, else the reason why not.
    fn along_a_way(&self) -> Result<(), String> {
        if matches!(self.rung, Rung::Diffusion(_)) {
            return Err("diffusion needs no paths".to_owned());
        }
        self.on_voxels()
    }

    fn color(&self) -> Answer {
        if let Err(reason) = self.along_a_way() {
            return off(reason);
        }
        let Some(medium) = &self.material.medium else {
            return off("nothing inside scatters");
        };
        let grey = |color: Vec3| color.x == color.y && color.y == color.z;
        if !grey(medium.scattering) || !grey(medium.absorption) {
            return on("scattering or absorption differs from colour to colour");
        }
        if !self.scene.lights.iter().map(Light::power).all(grey) {
            return on("a light is coloured");
        }
        off("scattering, absorption and lights are grey")
    }

    fn extinction_per_voxel(&self) -> Answer {
        if let Err(reason) = self.on_voxels() {
            return off(reason);
        }
        match self.material.medium.as_ref().map(|medium| &medium.density) {
            None => off("nothing inside scatters"),
            Some(Density::Uniform) => off("density the same everywhere"),
            Some(Density::Veins(_)) => on("veins"),
            Some(Density::Grid(_)) => on("a grid of densities"),
        }
    }

    /// Returns `Ok` if the body receives shadows where something casts any, else the reason why not.
    fn receives_shadows(&self) -> Result<(), String> {
        let Rung::Diffuse(reflectance) = self.rung else {
            return Err("clear bodies are lit by the environment".to_owned());
        };
        let asked = self.request.shadows || reflectance == Reflectance::LambertShadowed;
        if !asked && self.request.rung_of(self.object) != Rung::ByMaterial {
            return Err("a rung is asked for: --with shadow or the rung lambert-shadowed".to_owned());
        }
        if !asked && self.request.quality == Quality::Fast {
            return Err("quality fast".to_owned());
        }
        self.has_light()
    }

    fn has_light(&self) -> Result<(), String> {
        if self.scene.lights.is_empty() {
            return Err("no light but the environment, which casts none".to_owned());
        }
        Ok(())
    }

    fn shadow(&self) -> Answer {
        if matches!(self.rung, Rung::OpticalPath(_) | Rung::Diffusion(_)) {
            return self.shadow_on_body();
        }
        if let Err(reason) = self.receives_shadows() {
            return off(reason);
        }
        match casting::caster(self.object, self.scene, Casting::Opaque) {
            None => off("nothing stands between it and a light"),
            Some(caster) if std::ptr::eq(caster, self.object) => on("it may stand in its own light"),
            Some(caster) => on(format!("{} may stand in its light", caster.name)),
        }
    }

    /// Shadow on a body through which light is followed.
    fn shadow_on_body(&self) -> Answer {
        let reason = "its own is part of the rung: light enters where its source sees the body";
        if self.request.rung_of(self.object) != Rung::ByMaterial {
            return off(reason);
        }
        if self.request.quality == Quality::Fast {
            return off("quality fast");
        }
        match casting::caster(self.object, self.scene, Casting::Opaque) {
            Some(caster) if !std::ptr::eq(caster, self.object) => on(format!("{} may stand in its light", caster.name)),
            _ => off(reason),
        }
    }

    /// Why an effect is off that stands on another, given the answer for that one; `None` if that one is on.
    fn missing(&self, effect: Effect, (on, reason): Answer) -> Option<Answer> {
        if self.request.without.has(effect) {
            return Some(off(format!("{effect} is left out")));
        }
        (!on).then(|| off(format!("no {effect}: {reason}")))
    }

    fn translucent_shadow(&self) -> Answer {
        for (effect, answer) in [(Effect::Shadow, self.shadow()), (Effect::HalfSpace, self.half_space())] {
            if let Some(missing) = self.missing(effect, answer) {
                return missing;
            }
        }
        match self.rung {
            Rung::Diffuse(reflectance) if !reflectance.is_lambert() => match self.cdrf() {
                (true, _) if self.request.without.has(Effect::Cdrf) => off("cdrf is left out"),
                (true, _) => on("a shadow on a body that scatters"),
                (false, reason) => off(reason),
            },
            Rung::Diffuse(_) => off("the rung is Lambert's law"),
            _ => off("light is followed through the body"),
        }
    }

    fn colored_shadow(&self) -> Answer {
        if matches!(self.rung, Rung::OpticalPath(_) | Rung::Diffusion(_)) {
            return off("clear stones cast none on a body through which light is followed");
        }
        if let Err(reason) = self.receives_shadows() {
            return off(reason);
        }
        match casting::caster(self.object, self.scene, Casting::Clear) {
            None => off("no clear stone stands between it and a light"),
            Some(caster) => on(format!("light may come through {}", caster.name)),
        }
    }

    fn environment(&self) -> Answer {
        if self.is_among() && self.scene.beside_stones().count() > 0 {
            on("light around falls on bodies that it shows")
        } else if self.is_among() && self.partial_transmission().0 {
            on("light around falls on what is matt in part")
        } else if self.is_gem() {
            off("a clear surface sends nothing back diffusely")
        } else if self.material.is_all_metal() && self.draws_metal() {
            off("a metal sends nothing back diffusely")
        } else {
            on("the surface sends light from all around back")
        }
    }

    fn dielectric(&self) -> Answer {
        match self.rung {
            Rung::Diffusion(_) if self.material.ior == 1.0 => off("ior 1: nothing reflects"),
            Rung::Diffusion(_) => on(format!("ior {}", short(self.material.ior))),
            Rung::OpticalPath(_) => off("a path's cost knows no boundary"),
            Rung::Diffuse(_) if self.material.scatters() => off("part of half_space, or of the base colour"),
            _ => off("nothing inside scatters"),
        }
    }

    fn environment_map(&self) -> Answer {
        match self.request.environment {
            Environment::Studio => off("the environment is the procedural studio"),
            Environment::Map(_) if self.is_gem() => on("the environment is an image"),
            Environment::Map(_) if self.reflection().0 => on("the environment is an image, which the surface reflects"),
            Environment::Map(_) => off("of the image only its diffuse light is needed, which harmonics hold"),
        }
    }

    /// Answers for an image or a mesh's colours that are called for.
    fn drawn_by_rung(&self, what: String) -> Answer {
        if self.rung.draws_images() { on(what) } else { off(format!("the rung {} draws the factor alone", self.rung)) }
    }

    fn image(&self, slot: TextureSlot) -> Answer {
        if self.is_gem() {
            return self.image_met(slot);
        }
        let Some(texture) = self.material.texture(slot) else {
            return off(format!("no {}", slot.name()));
        };
        if !self.material.calls_for(slot) {
            return off(format!("{} with a factor of 0", slot.name()));
        }
        if self.object.mesh.uvs.is_empty() {
            return off(format!("{}, but the mesh has no texture coordinates", slot.name()));
        }
        let [width, height] = [texture.texels.width(), texture.texels.height()];
        self.drawn_by_rung(format!("{} of {width} x {height} texels", slot.name()))
    }

    /// Returns an answer of something that changes how light spreads, or that it does not spread.
    fn on_light_that_spreads(&self, found: Answer) -> Answer {
        if found.0 { self.missing(Effect::Cdrf, self.cdrf()).unwrap_or(found) } else { found }
    }

    fn partial_transmission(&self) -> Answer {
        if self.is_gem() {
            return self.partly_clear();
        }
        let share = self.material.share_that_enters();
        let image = self.image(TextureSlot::DiffuseTransmission);
        let found = match (share < 1.0, image.0) {
            (true, _) => self.drawn_by_rung(format!("diffuseTransmissionFactor {}", short(share))),
            (false, true) => image,
            (false, false) => off("all light enters"),
        };
        self.on_light_that_spreads(found)
    }

    fn transmission_texture(&self) -> Answer {
        if self.is_gem() {
            return self.image_met(TextureSlot::Transmission);
        }
        let found = self.image(TextureSlot::DiffuseTransmission);
        let missing = self.missing(Effect::PartialTransmission, self.partial_transmission());
        if found.0 { missing.unwrap_or(found) } else { found }
    }

    fn coverage(&self) -> Answer {
        if self.meets_opaque() {
            return match self.scene.objects.iter().find(|object| among::is_sheer(object)) {
                Some(object) => on(format!("{} covers a share of what is behind it", object.name)),
                None => off("opaque bodies cover all that is behind them"),
            };
        }
        match self.material.coverage {
            None => off("alphaMode OPAQUE"),
            Some(_) if self.material.covers_all() => off("alpha covers all"),
            Some(Coverage { share, cutoff: None }) => {
                self.drawn_by_rung(format!("alphaMode BLEND, alpha {}", short(share)))
            }
            Some(Coverage { cutoff: Some(cutoff), .. }) => {
                self.drawn_by_rung(format!("alphaMode MASK, cutoff {}", short(cutoff)))
            }
        }
    }

    fn vertex_color(&self) -> Answer {
        if self.is_gem() {
            return self.colors_met();
        }
        if self.object.mesh.colors.is_empty() {
            return off("no colours of vertices");
        }
        self.drawn_by_rung("the mesh has colours of vertices".to_owned())
    }

    fn microfacet(&self) -> Answer {
        let Material { ior, roughness, .. } = *self.material;
        if self.is_gem() {
            return off("clear bodies are drawn polished");
        }
        if ior == 1.0 && !self.draws_metal() {
            return off("ior 1: nothing reflects");
        }
        if roughness == 0.0 {
            return off("roughness 0: polished");
        }
        if self.scene.lights.is_empty() {
            return off("no lights");
        }
        on(format!("roughness {}, ior {}", short(roughness), short(ior)))
    }

    fn second_lobe(&self) -> Answer {
        let Some(lobe) = self.material.second_lobe else {
            return off("no secondLobe");
        };
        if let Some(missing) = self.missing(Effect::Microfacet, self.microfacet()) {
            return missing;
        }
        if !self.rung.draws_images() {
            return off(format!("the rung {} draws the first lobe alone", self.rung));
        }
        on(format!("secondLobe of roughness {}, weight {}", short(lobe.roughness), short(lobe.weight)))
    }

    fn reflection(&self) -> Answer {
        let Material { ior, roughness, .. } = *self.material;
        if self.is_gem() {
            return off("a clear surface's reflection is part of its recipe");
        }
        if ior == 1.0 && !self.draws_metal() {
            return off("ior 1: nothing reflects");
        }
        if roughness > 0.0 {
            return off(format!("roughness {}: the environment's image would be blurred", short(roughness)));
        }
        on(format!("roughness 0, ior {}", short(ior)))
    }

    /// Whether what a metal reflects is drawn.
    fn draws_metal(&self) -> bool {
        self.metal().0 && !self.request.without.has(Effect::Metal)
    }

    fn metal(&self) -> Answer {
        if self.is_gem() {
            return self.metal_met();
        }
        if !self.material.is_metal() {
            return off("no metal");
        }
        self.drawn_by_rung(format!("metallicFactor {}", short(self.material.metallic)))
    }

    fn spot(&self) -> Answer {
        let spots = self.scene.lights.iter().filter(|light| matches!(light, Light::Spot { .. })).count();
        let sees_bodies = self.is_among() && self.scene.beside_stones().count() > 0;
        if self.is_gem() && !sees_bodies && !self.light().0 {
            return off("no light is seen");
        }
        match spots {
            0 => off("no light is a spot"),
            1 => on("a light is a spot"),
            many => on(format!("{many} lights are spots")),
        }
    }
}
