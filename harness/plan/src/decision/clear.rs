//! Effects of clear bodies: how light goes through them, and what that meets which leaves them.

use super::{Answer, Case, off, on};
use crate::among;
use crate::numbers::{short, triple};
use crate::shape;
use crate::{Effect, Geometry, MOST_BODIES, Outside, Quality, Rung, Spectrum};
use glam::Vec3;
use lapidary_scene::{Dispersion, Material, Object, Shape, TextureSlot};

/// Describes how a rung finds the facets that rays meet inside a stone.
fn way_of(geometry: Geometry) -> &'static str {
    match geometry {
        Geometry::Proxy => "the proxy",
        Geometry::Convex => "a convex stone's planes",
        Geometry::Walk => "a convex stone's planes, by a map of its facets",
        Geometry::Bvh => "a hierarchy of all triangles",
        Geometry::Triangles => "a loop over all triangles",
        Geometry::Scene => "a hierarchy of all bodies' triangles",
    }
}

impl Case<'_> {
    pub(super) fn is_gem(&self) -> bool {
        matches!(self.rung, Rung::Inside { .. } | Rung::Surface)
    }

    /// Returns why all effects of clear bodies are off.
    pub(super) fn not_clear(&self) -> String {
        if self.material.scatters() {
            "light scatters inside".to_owned()
        } else if self.material.transmission == 0.0 {
            "transmission 0: opaque".to_owned()
        } else {
            format!("the rung {} draws the surface alone", self.rung)
        }
    }

    pub(super) fn inside(&self, effect: Effect, geometry: Geometry) -> Answer {
        let Rung::Inside { geometry: used, .. } = self.rung else {
            return off(if self.rung == Rung::Surface { self.no_inside() } else { self.not_clear() });
        };
        let by_triangles = matches!(used, Geometry::Triangles | Geometry::Scene);
        let serves = used == geometry || by_triangles && effect == Effect::BvhTrace;
        if !serves {
            return off(format!("the rung {} finds facets by {}", self.rung, way_of(used)));
        }
        on(format!("transmission {}, thickness {}", self.material.transmission, self.material.thickness))
    }

    /// Returns why no light is followed inside a clear body.
    fn no_inside(&self) -> String {
        if self.request.rung_of(self.object) == Rung::Surface { "the rung is the surface alone" } else { "thickness 0" }
            .to_owned()
    }

    pub(super) fn thin_wall(&self) -> Answer {
        match self.rung {
            Rung::Surface if self.request.rung_of(self.object) != Rung::Surface => {
                on(format!("transmission {}, thickness 0", self.material.transmission))
            }
            Rung::Surface => off(self.no_inside()),
            Rung::Inside { .. } => off(format!("thickness {}", self.material.thickness)),
            _ => off(self.not_clear()),
        }
    }

    pub(super) fn is_among(&self) -> bool {
        self.rung.is_among()
    }

    /// Returns the first body that is as wanted: the object itself, or any to which its light may go.
    fn first(&self, wanted: impl Fn(&Object) -> bool) -> Option<&Object> {
        let others = self.scene.objects.iter().filter(|_| self.is_among());
        std::iter::once(self.object).chain(others).find(|object| wanted(object))
    }

    /// Returns an answer that needs a rung by which light goes from one body to another.
    fn among(&self, called: Option<String>, not: &str) -> Answer {
        match called {
            None if self.scene.objects.len() > among::MOST_COMPARED => off("too many bodies to compare"),
            None => off(not),
            Some(called) if self.is_among() => on(called),
            Some(called) => off(format!("the rung {} follows light through one body, though {called}", self.rung)),
        }
    }

    pub(super) fn nested(&self) -> Answer {
        if let Some(other) = self.met_inside() {
            return on(format!("{} reaches into it", other.name));
        }
        // By another rung, what only holds the stone is met where light leaves it.
        let shares = if self.is_among() {
            among::shares_space(self.object, self.scene)
        } else {
            among::reaches_into(self.object, self.scene, false)
        };
        let own = shares.map(|other| format!("{} shares space with {}", self.object.name, other.name));
        // Light goes through all clear bodies, so that any of them calls for it. Few vertices are looked at: here boxes that
        // meet are enough.
        let any = || {
            let (object, other) = among::any_share(self.scene).filter(|_| self.is_among())?;
            Some(format!("{} may share space with {other}", object.name))
        };
        self.among(own.or_else(any), "it shares space with no body")
    }

    pub(super) fn behind(&self) -> Answer {
        let other = among::overlaps(self.object, self.scene, self.request.size);
        let called = other.map(|other| format!("in the view it overlaps {}", other.name));
        let itself = || {
            let convex = self.object.copies.is_none() && Shape::of(&self.object.mesh) == Shape::Convex;
            (!convex).then(|| "light that leaves it may meet it again".to_owned())
        };
        let called = if called.is_none() && self.is_among() { itself() } else { called };
        self.among(called, "in the view it overlaps no clear body")
    }

    pub(super) fn smooth(&self) -> Answer {
        match self.first(shape::is_smooth) {
            Some(object) => {
                self.among(Some(format!("the normals of {} are those of a smooth surface", object.name)), "")
            }
            None => self.among(None, shape::why_flat(self.object)),
        }
    }

    pub(super) fn rough(&self) -> Answer {
        match self.first(|object| object.material.facet_slope() > 0.0) {
            Some(object) if self.is_among() => {
                on(format!("roughness {} of {}", short(object.material.roughness), object.name))
            }
            Some(_) => off(format!("the rung {} draws clear bodies polished", self.rung)),
            None => off("clear bodies are polished"),
        }
    }

    /// Whether a rung is asked for, which shows lights on request alone.
    fn hides_lights(&self) -> bool {
        let is_named = self.request.rung_of(self.object) != Rung::ByMaterial && !self.is_among();
        is_named && !self.request.lights
    }

    fn sees_lights(&self) -> bool {
        !self.scene.lights.is_empty() && !self.hides_lights() && !self.request.without.has(Effect::Light)
    }

    pub(super) fn light(&self) -> Answer {
        match self.scene.lights.len() {
            0 => off("no lights"),
            _ if self.hides_lights() => off("a rung is asked for: --with light"),
            // Copies, wavelengths and bounds leave no room for two more buffers.
            _ if matches!(self.rung.spectrum(), Spectrum::Separate(_))
                && self.instances().0
                && self.bounds_trace().0 =>
            {
                off("the stage reads as many buffers as devices offer")
            }
            1 => on("1 light has a disc"),
            count => on(format!("{count} lights have discs")),
        }
    }

    pub(super) fn around(&self) -> Answer {
        match self.scene.beside_stones().count() {
            _ if !self.is_among() => self.around_one(),
            0 => off("all bodies are clear"),
            _ if self.request.outside == Some(Outside::Environment) => off("asked for: environment"),
            1 => on("beside 1 body that is not clear"),
            count => on(format!("beside {count} bodies that are not clear")),
        }
    }

    /// Returns the first body that is not clear, and that rays inside a convex stone meet.
    fn met_inside(&self) -> Option<&Object> {
        let meets = !self.is_among() && !self.request.without.has(Effect::Around) && self.around().0;
        if meets { among::reached_by_opaque(self.object, self.scene) } else { None }
    }

    /// The same under a rung that follows light through one body: what leaves that meets triangles.
    fn around_one(&self) -> Answer {
        let walks = self.rung.geometry_of_inside() == Some(Geometry::Walk);
        match self.request.outside {
            _ if !walks => off(format!("the rung {} follows light through one body", self.rung)),
            Some(Outside::Triangles) | None
                if !among::fits_around(
                    self.instances().0,
                    matches!(self.rung.spectrum(), Spectrum::Separate(_)),
                    self.sees_lights(),
                ) =>
            {
                off("the stage reads as many buffers as devices offer")
            }
            Some(Outside::Triangles) => self.meets("asked for, ", usize::MAX),
            Some(other) => off(format!("asked for: {other}")),
            None if self.request.quality == Quality::Fast => off("quality fast"),
            None => among::reached_by_opaque(self.object, self.scene)
                .map(|other| format!("{} reaches into it", other.name))
                .or_else(|| among::beside(self.object, self.scene, self.request.size))
                .map_or_else(|| off("no body stands around it, or is seen straight through it"), on),
        }
    }

    pub(super) fn absorption(&self) -> Answer {
        // Copies may have colours of their own, and light may go through other bodies.
        let others = self.scene.objects.iter().filter(|object| self.is_among() && object.material.is_clear());
        let materials = self.object.materials().chain(others.flat_map(|object| object.materials()));
        let coloured = materials.into_iter().find(|material| material.absorbs());
        let material = coloured.as_ref().unwrap_or(self.material);
        match self.rung {
            Rung::Surface => off(self.no_inside()),
            Rung::Inside { .. } if material.attenuation_color == Vec3::ONE => off("attenuation white"),
            Rung::Inside { .. } if material.attenuation_distance.is_infinite() => off("attenuation distance infinite"),
            Rung::Inside { .. } => on(format!(
                "attenuation {} after {}",
                triple(material.attenuation_color),
                short(material.attenuation_distance)
            )),
            Rung::OpticalPath(_) => off("part of the way's cost, with what scattering takes"),
            Rung::Diffusion(_) => off("part of diffusion, with what scattering takes"),
            Rung::Diffuse(_) if material.medium.is_some() => off("part of the base colour and of sigma0"),
            _ => off(self.not_clear()),
        }
    }

    pub(super) fn dispersion(&self) -> Answer {
        let spectrum = match self.rung {
            Rung::Inside { spectrum, .. } => spectrum,
            Rung::Surface => return off(self.no_inside()),
            _ => return off(self.not_clear()),
        };
        let disperses = |material: &&Material| material.dispersion != Dispersion::None;
        let others = self.scene.objects.iter().map(|object| &object.material).filter(|material| material.is_clear());
        let other = others.filter(disperses).find(|_| self.is_among());
        let called = match Some(self.material).filter(disperses).or(other).unwrap_or(self.material).dispersion {
            Dispersion::None => return off("dispersion 0"),
            Dispersion::Abbe(value) => format!("dispersion {} (V_d {})", short(value), short(20.0 / value)),
            Dispersion::Sellmeier(mineral) => {
                format!("Sellmeier equation of {} (V_d {})", mineral.name(), short(mineral.abbe_number()))
            }
        };
        if spectrum == Spectrum::One {
            return off(format!("the rung {} follows one index, though {called}", self.rung));
        }
        on(called)
    }

    pub(super) fn instances(&self) -> Answer {
        match &self.object.copies {
            None => off("shown once"),
            Some(_) if self.is_among() => off("light goes from one copy to another"),
            Some(copies) if self.is_gem() => on(format!("{} copies of one shape", copies.places.len())),
            Some(_) => off("drawn as one mesh: only clear stones are drawn by copies"),
        }
    }

    pub(super) fn footprint(&self) -> Answer {
        match self.rung {
            _ if !self.request.footprint => off("not asked for"),
            Rung::Inside { geometry: Geometry::Walk, spectrum: Spectrum::Separate(count), .. } => {
                off(format!("the rung {} follows {count} rays, each with edges of its own", self.rung))
            }
            Rung::Inside { geometry: Geometry::Walk, .. } => on("asked for"),
            Rung::Inside { geometry, .. } => {
                off(format!("the rung {} finds facets by {}, without a runner-up", self.rung, way_of(geometry)))
            }
            Rung::Surface => off(self.no_inside()),
            _ => off(self.not_clear()),
        }
    }

    pub(super) fn screen_trace(&self) -> Answer {
        match self.request.outside {
            _ if !self.is_gem() => off(self.not_clear()),
            _ if self.is_among() => off("light meets bodies by their triangles"),
            Some(Outside::Screen) => self.meets("asked for, ", usize::MAX),
            _ => off("not asked for"),
        }
    }

    pub(super) fn bounds_trace(&self) -> Answer {
        match self.request.outside {
            _ if !self.is_gem() => off(self.not_clear()),
            _ if self.is_among() => off("light meets bodies by their triangles"),
            _ if self.around().0 => off("light meets bodies by their triangles"),
            Some(Outside::Bodies | Outside::Triangles) => self.meets("asked for, ", MOST_BODIES),
            Some(other) => off(format!("asked for: {other}")),
            None if self.request.quality == Quality::Fast => off("quality fast"),
            None => self.meets("", MOST_BODIES),
        }
    }

    /// Returns whether light that leaves the body may meet others, of which it meets the `most` largest.
    fn meets(&self, called: &str, most: usize) -> Answer {
        match self.scene.beside_stones().count() {
            0 => off("all bodies are clear"),
            1 => on(format!("{called}beside 1 body that is not clear")),
            count if count > most => on(format!("{called}the {most} largest of {count} bodies that are not clear")),
            count => on(format!("{called}beside {count} bodies that are not clear")),
        }
    }

    /// Answers for clear bodies of which a share of the light does not enter some.
    pub(super) fn partly_clear(&self) -> Answer {
        match self.first(among::is_partly_clear) {
            Some(object) if self.is_among() && object.material.clear_share() == 1.0 => {
                on(format!("transmissionTexture of {}", object.name))
            }
            Some(object) if self.is_among() => {
                on(format!("transmissionFactor {} of {}", short(object.material.transmission), object.name))
            }
            Some(_) => off(format!("the rung {} draws clear bodies wholly clear", self.rung)),
            None => off("clear bodies are wholly clear"),
        }
    }

    /// Whether light through this body meets others that are not clear, by their triangles.
    pub(super) fn meets_opaque(&self) -> bool {
        self.is_among() && !self.request.without.has(Effect::Around) && self.around().0
    }

    /// Returns the first body that is as wanted, of those whose surface light through this one meets.
    fn first_met(&self, wanted: impl Fn(&Object) -> bool) -> Option<&Object> {
        let meets_opaque = self.meets_opaque();
        self.first(|object| (object.material.is_clear() || meets_opaque) && wanted(object))
    }

    /// Answers for a body in which light scatters, and which light through this one meets.
    pub(super) fn spread_met(&self) -> Answer {
        match self.first_met(|object| object.material.scatters()) {
            Some(object) if self.is_among() => on(format!("light scatters in {}", object.name)),
            _ => off("nothing inside scatters"),
        }
    }

    /// The same for the law of its matter, where the body itself has it.
    pub(super) fn law_met(&self) -> Answer {
        match self.first_met(|object| object.material.scatters()) {
            Some(object) if self.is_among() => {
                let usual = self.request.rung_of(object) == Rung::ByMaterial && self.request.quality != Quality::Fast;
                let is_on = self.request.half_space || usual;
                if is_on {
                    on(format!("light scatters in {}", object.name))
                } else {
                    off("quality fast, or a rung is asked for")
                }
            }
            _ => off("nothing inside scatters"),
        }
    }

    /// Answers for an image of this body, or of any that its light meets.
    pub(super) fn image_met(&self, slot: TextureSlot) -> Answer {
        match self.first_met(|object| among::shows(object, slot)) {
            Some(object) if self.is_among() => on(format!("{} of {}", slot.name(), object.name)),
            Some(_) => off(format!("the rung {} draws factors alone", self.rung)),
            None => off(format!("no {}", slot.name())),
        }
    }

    /// Answers for a metal that light through this body meets.
    pub(super) fn metal_met(&self) -> Answer {
        let meets = !self.request.without.has(Effect::Around) && self.around().0;
        match self.scene.beside_stones().find(|object| object.material.is_metal()) {
            Some(object) if meets => on(format!("{} is a metal", object.name)),
            _ => off("light meets no metal by its triangles"),
        }
    }

    /// Answers for the colours of vertices of this body, or of any that its light meets.
    pub(super) fn colors_met(&self) -> Answer {
        match self.first_met(|object| !object.mesh.colors.is_empty()) {
            Some(object) if self.is_among() => on(format!("{} has colours of vertices", object.name)),
            Some(_) => off(format!("the rung {} draws factors alone", self.rung)),
            None => off("no colours of vertices"),
        }
    }
}
