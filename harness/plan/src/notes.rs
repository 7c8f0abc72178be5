//! Warnings before a scene is drawn: bodies and lights that no technique can render faithfully.

mod merge;
mod shared_space;

use super::{Decisions, thickness, through};
use crate::among;
use crate::remembered::{Remembered, holding};
use crate::{Effect, Geometry, Note, Objects, Request, Rung, enclosed};
use glam::{DVec2, DVec3, Vec3, Vec4};
use lapidary_environment::oracle;
use lapidary_scene::normals::has_hard_edges;
use lapidary_scene::{Dispersion, Environment, Material, MeshDiagnosis, Object, Scene, TextureSlot, clip_from_world};
use merge::add;
use std::f64::consts::PI;

/// Maximum triangle count of a mesh that is diagnosed. Larger ones would take seconds, and as much
/// additional memory as the mesh itself.
const MOST_DIAGNOSED: usize = 1 << 20;

/// Share of light below which a body counts as black at exposure 1: an eighth of the smallest step
/// of linear 8-bit encoding.
const INVISIBLE: f32 = 1.0 / 2048.0;

/// Darkest channel of a pixel whose channels are all written as 255.
const WHITE: f32 = 254.5 / 255.0;

/// Returns the warnings about a scene before it is drawn: meshes, materials, lights and a camera
/// that no technique can render faithfully. Each warning appears once, with the first object it
/// applies to.
///
/// `decisions` are those of the scene's objects, in the same order.
#[must_use]
pub fn of(scene: &Scene, request: &Request<'_>, decisions: &[&Decisions]) -> Vec<Note> {
    holding(scene, || found(scene, request, decisions))
}

fn found(scene: &Scene, request: &Request<'_>, decisions: &[&Decisions]) -> Vec<Note> {
    let around = mean_radiance(request.environment);
    let mut notes: Vec<Note> = Vec::new();
    if is_out_of_view(scene, request) {
        notes.push(Note::NothingInView);
    }
    let is_shown_through = decisions.iter().any(|of| of.rung.is_among() && of.has(Effect::Cdrf));
    for (object, decisions) in scene.objects.iter().zip(decisions) {
        let shows_lights = decisions.has(Effect::Light) || request.without.has(Effect::Light);
        let case = Case { object, rung: decisions.rung, shows_lights, is_shown_through, scene, request };
        for note in case.notes(around) {
            add(&mut notes, note);
        }
    }
    notes.extend(shared_space::notes(scene, decisions));
    notes
}

/// One object with its rung.
struct Case<'a> {
    object: &'a Object,
    rung: Rung,
    /// Whether lights are seen in a clear body, or left out on request.
    shows_lights: bool,
    /// Whether clear bodies show scattering ones.
    is_shown_through: bool,
    scene: &'a Scene,
    request: &'a Request<'a>,
}

impl Case<'_> {
    fn notes(&self, around: DVec3) -> Vec<Note> {
        let objects = Objects { first: self.object.name.clone(), count: 1 };
        if !self.object.mesh.indices.is_empty() && !self.object.mesh.has_area() {
            return vec![Note::NoArea { objects }];
        }
        let rung = self.rung;
        let mut notes = Vec::new();
        let asked = self.request.rung_of(self.object);
        if asked.is_for_clear_stones() && !self.object.material.is_clear() {
            notes.push(Note::NotClear { objects: objects.clone(), asked, instead: rung });
        }
        let what = self.factors_alone();
        if !what.is_empty() {
            notes.push(Note::FactorsAlone { objects: objects.clone(), rung, what });
        }
        let share = self.object.material.share_that_enters();
        if self.object.material.scatters() && share < 1.0 && !rung.spreads_by_curvature() {
            notes.push(Note::AllEnters { objects: objects.clone(), rung, share });
        }
        let scatters = self.object.material.scatters() && !matches!(rung, Rung::Diffusion(_));
        if scatters && enclosed::count(self.object, &self.scene.lights) > 0 {
            notes.push(Note::LampInside { objects: objects.clone(), rung });
        }
        let is_followed = self.object.material.is_clear() && matches!(rung, Rung::Inside { .. } | Rung::Surface);
        if is_followed && self.object.mesh.encloses(self.scene.camera.eye) {
            notes.push(Note::EyeWithin { objects: objects.clone(), rung });
        }
        notes.extend(self.simpler_through_others(&objects));
        notes.extend(self.other_color(&objects));
        notes.extend(self.polished(&objects));
        let lit = is_followed && !self.scene.lights.is_empty();
        if lit && !self.shows_lights {
            notes.push(Note::LightsNotSeen { objects: objects.clone(), rung });
        }
        if is_followed && !rung.is_among() && among::copies_overlap(self.object, self.scene, self.request.size) {
            notes.push(Note::CopiesApart { objects: objects.clone(), rung });
        }
        let is_alone = is_followed && !rung.is_among() && !self.request.without.has(Effect::Behind);
        if is_alone && among::overlaps(self.object, self.scene, self.request.size).is_some() {
            let share = through::others(self.object, self.scene, self.request.size).share;
            // A share of nothing is nothing left out.
            notes.extend((share > 0.0).then(|| Note::OthersNotSeen { objects: objects.clone(), rung, share }));
        }
        notes.extend(self.of_mesh(&objects));
        if rung.geometry_of_inside() == Some(Geometry::Proxy) && has_hard_edges(&self.object.mesh) {
            notes.push(Note::HardEdges { objects: objects.clone(), rung });
        }
        notes.extend(self.thin_wall(&objects));
        notes.extend(self.black(&objects));
        notes.extend(self.white(&objects, around));
        notes
    }

    /// Returns a note if a scattering body looks simpler through clear ones than by itself.
    fn simpler_through_others(&self, objects: &Objects) -> Option<Note> {
        let (material, has) = (&self.object.material, |slot| among::shows(self.object, slot));
        let is_through = matches!(self.rung, Rung::OpticalPath(_) | Rung::Diffusion(_));
        let varies = has(TextureSlot::Thickness) || has(TextureSlot::DiffuseTransmission);
        let is_simpler = is_through || varies || material.share_that_enters() < 1.0;
        (self.is_shown_through && material.scatters() && is_simpler)
            .then(|| Note::SimplerThroughOthers { objects: objects.clone() })
    }

    /// Returns a note if a scattering body's coefficients have another colour than its base colour, unless that is white, as
    /// of a file that names none.
    fn other_color(&self, objects: &Objects) -> Option<Note> {
        let Object { mesh, material, .. } = self.object;
        let color = thickness::color(material, &mesh.colors);
        let differs = (color - material.base_color).abs().max_element() > MOST_OTHER;
        (material.base_color != Vec3::ONE && differs).then(|| Note::OtherColor { objects: objects.clone(), color })
    }

    /// Returns a note if a clear body is rough or not wholly clear, and its rung does not draw that.
    fn polished(&self, objects: &Objects) -> Option<Note> {
        let material = &self.object.material;
        let rough = (material.facet_slope() > 0.0).then_some("roughnessFactor");
        let partly = (material.clear_share() < 1.0).then_some("transmissionFactor");
        let what: Vec<&'static str> = rough.into_iter().chain(partly).collect();
        let drawn = matches!(self.rung, Rung::Inside { .. } | Rung::Surface) && !self.rung.is_among();
        (material.is_clear() && drawn && !what.is_empty()).then(|| Note::PolishedAndClear {
            objects: objects.clone(),
            rung: self.rung,
            what,
        })
    }

    /// Returns the images, and the colours of vertices, that the rung leaves out.
    fn factors_alone(&self) -> Vec<&'static str> {
        let Object { mesh, material, .. } = self.object;
        let by_reference = self.rung == Rung::Reference;
        let is_followed = material.is_clear() && (self.rung.is_among() || by_reference);
        let is_matte = material.is_opaque() && by_reference;
        let draws = self.rung.draws_images() || is_followed || is_matte;
        let spreads = self.rung.spreads_by_curvature();
        let slots = [
            (TextureSlot::BaseColor, draws),
            (TextureSlot::Normal, draws),
            (TextureSlot::Thickness, spreads || material.is_clear()),
            (TextureSlot::Transmission, is_followed),
            (TextureSlot::DiffuseTransmission, spreads || !material.scatters()),
        ];
        let lost = |(slot, drawn): &(TextureSlot, bool)| !drawn && material.effective(*slot).is_some();
        let colors = (!draws && !mesh.colors.is_empty()).then_some("COLOR_0");
        let draws_alpha = self.rung.draws_images() || is_matte;
        let alpha = (!draws_alpha && !material.covers_all()).then_some("alphaMode");
        slots.into_iter().filter(lost).map(|(slot, _)| slot.name()).chain(colors).chain(alpha).collect()
    }

    /// Returns what is wrong with the object's mesh for its rung; `None` if nothing is.
    fn of_mesh(&self, objects: &Objects) -> Option<Note> {
        let Object { mesh, material, .. } = self.object;
        if mesh.triangle_count() > MOST_DIAGNOSED {
            return None;
        }
        let takes_a_solid = match self.rung {
            Rung::Inside { geometry: Geometry::Scene, .. } | Rung::Reference if material.is_thin_wall() => false,
            Rung::Inside { .. } | Rung::OpticalPath(_) | Rung::Diffusion(_) => true,
            Rung::Reference => material.is_clear(),
            _ => false,
        };
        static FOUND: Remembered<MeshDiagnosis> = Remembered::new();
        let found = FOUND.of(mesh, MeshDiagnosis::of);
        if takes_a_solid {
            let faults = found.clauses();
            return (!faults.is_empty()).then(|| Note::NotSolid { objects: objects.clone(), rung: self.rung, faults });
        }
        if found.is_closed() && found.inverted_parts > 0 {
            return Some(Note::InsideOut { objects: objects.clone() });
        }
        let shows_its_back = material.double_sided && !found.is_closed();
        shows_its_back.then(|| Note::BackNotDrawn { objects: objects.clone() })
    }

    fn thin_wall(&self, objects: &Objects) -> Option<Note> {
        let material = &self.object.material;
        if self.rung != Rung::Surface || self.request.rung_of(self.object) == Rung::Surface || material.thickness > 0.0
        {
            return None;
        }
        let absorbs = material.absorbs().then_some("absorption");
        let disperses = (material.dispersion != Dispersion::None).then_some("dispersion");
        Some(Note::ThinWall { objects: objects.clone(), unused: absorbs.into_iter().chain(disperses).collect() })
    }

    /// Returns a note if not even the thin parts of a clear body let visible light through.
    fn black(&self, objects: &Objects) -> Option<Note> {
        let Object { material, mesh, .. } = self.object;
        let is_inside = matches!(self.rung, Rung::Inside { .. } | Rung::Reference) && material.is_clear();
        if !is_inside || material.clear_share() < 1.0 || mesh.triangle_count() > MOST_DIAGNOSED {
            return None;
        }
        // Only an absorbing body has to be measured.
        let absorbs = self.object.materials().any(|material| material.absorbs());
        let thickness = if absorbs { thickness::measured(mesh) } else { 0.0 };
        let left = self.object.materials().map(|material| {
            let Material { base_color, attenuation_color, attenuation_distance, .. } = material;
            let coefficient = lapidary_absorption::coefficient(attenuation_color, attenuation_distance);
            (base_color * lapidary_absorption::transmittance(coefficient, thickness)).max_element()
        });
        // The brightest of the copies, if there are any.
        let share = left.fold(0.0, f32::max);
        (share * self.request.exposure < INVISIBLE).then(|| Note::Black { objects: objects.clone(), share, thickness })
    }

    /// Returns a note if a body at normal incidence to the lights is shown as plain white.
    fn white(&self, objects: &Objects, around: DVec3) -> Option<Note> {
        let Object { material, mesh, .. } = self.object;
        let mut radiance = around;
        if !material.is_clear() {
            let bounds = lapidary_scene::Bounds::of(mesh.positions.iter().copied());
            let (middle, radius) = (bounds.centre().as_dvec3(), f64::from(bounds.radius()));
            let arriving = self.scene.lights.iter().map(|light| {
                let arrival = light.arrival(middle);
                // A lamp inside a body lights the body's rim.
                let is_inside = arrival.distance < radius;
                if is_inside { light.arrival(middle + radius * DVec3::X).irradiance } else { arrival.irradiance }
            });
            radiance += arriving.sum::<DVec3>() / PI;
        }
        let shown = (self.request.exposure * radiance.as_vec3() * thickness::color(material, &mesh.colors))
            .min(Vec3::splat(f32::MAX));
        let encoded = lapidary_srgb::encode_color(lapidary_srgb::tone_curve(shown.min(Vec3::splat(1e9))));
        (encoded.min_element() >= WHITE)
            .then(|| Note::ClipsToWhite { objects: objects.clone(), radiance: shown.max_element() })
    }
}

/// How far a part of a scattering body's base colour may be from that of its coefficients.
const MOST_OTHER: f32 = 0.05;

/// Number of rows of directions from pole to pole; there are twice as many columns.
const ROWS: u32 = 64;

/// Returns the mean radiance of the environment over all directions, per channel.
fn mean_radiance(environment: &Environment) -> DVec3 {
    let row = |row: u32| {
        let v = (f64::from(row) + 0.5) / f64::from(ROWS);
        let edges = [row, row + 1].map(|edge| (PI * f64::from(edge) / f64::from(ROWS)).cos());
        // Solid angle of one direction in this row, as a share of the sphere.
        let share = 0.5 * (edges[0] - edges[1]) / f64::from(2 * ROWS);
        let columns = (0..2 * ROWS).map(|column| {
            let uv = DVec2::new((f64::from(column) + 0.5) / f64::from(2 * ROWS), v);
            environment.radiance(oracle::direction_from_uv(uv))
        });
        share * columns.sum::<DVec3>()
    };
    (0..ROWS).map(row).sum()
}

/// Whether every triangle lies beyond one of the picture's edges, or behind the eye.
fn is_out_of_view(scene: &Scene, request: &Request<'_>) -> bool {
    let matrix = clip_from_world(scene, request.size[0], request.size[1]);
    let beyond = |clip: Vec4| {
        let [x, y, _, w] = clip.to_array();
        [x < -w, x > w, y < -w, y > w, w <= 0.0]
    };
    let mut triangles = scene.objects.iter().flat_map(|object| object.mesh.triangles());
    triangles.all(|corners| {
        let [a, b, c] = corners.map(|corner| beyond(matrix * corner.extend(1.0)));
        (0..a.len()).any(|side| a[side] && b[side] && c[side])
    })
}

#[cfg(test)]
mod tests;
