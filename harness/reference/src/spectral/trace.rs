//! Tracing of rays of one wavelength, split at every surface that they meet.

use super::geometry::{Bodies, Way};
use super::hit::{Hit, Place};
use super::paint::Painted;
use super::rough;
use super::scatterer::Scatterer;
use super::within::{Order, Within};
use glam::DVec3;
use lapidary_fresnel::oracle as fresnel;
use lapidary_refraction::oracle as refraction;
use lapidary_scene::{Environment, Light};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

/// Largest number of surface hits for one sample and wavelength, over all its rays. Total
/// reflection takes no energy, so a ray may be trapped for a long time; its energy then counts as
/// lost.
const MOST_HITS: u32 = 20_000;

/// Number of hits of a sample and wavelength after which a ray that meets a polished surface goes one way, at random, if any
/// body is rough.
const MOST_SPLIT: u32 = 32;

/// Optical properties of a body at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Optics {
    /// Refractive index relative to air.
    pub(super) index: f64,
    /// Absorption coefficient of the Beer-Lambert law per unit of distance, for each channel of
    /// linear RGB.
    pub(super) absorption: DVec3,
    /// Factor applied to light on entry, linear RGB.
    pub(super) base_color: DVec3,
}

/// Properties of a body's surface at every wavelength.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// Whether it is a thin wall: clear, without an inside.
    pub(super) is_thin: bool,
    /// Whether it is opaque: what passes it passes beside it.
    pub(super) is_opaque: bool,
    /// Width of its facets' slopes; 0 if it is polished.
    pub(super) alpha: f64,
    /// What it has where no image says otherwise; at an arrival, what it has there.
    pub(super) painted: Painted,
    /// Whether a share of the light does not enter, somewhere.
    pub(super) is_partly_clear: bool,
    /// Share of light that its metal reflects head on, without images.
    pub(super) f0: DVec3,
}

impl Surface {
    /// Whether light goes one of several ways from it.
    pub(super) fn is_rough(&self) -> bool {
        self.alpha > 0.0 || self.is_metal() && self.painted.metal_alpha > 0.0
    }

    fn is_metal(&self) -> bool {
        self.painted.metallic > 0.0
    }

    /// Returns the factor of the base colour for light that passes.
    fn color(&self) -> DVec3 {
        if self.is_opaque { DVec3::ONE } else { self.painted.color }
    }
}

/// The surroundings of a ray, whatever its wavelength.
pub(super) struct Surroundings<'scene> {
    pub(super) bodies: Bodies,
    pub(super) order: Order,
    /// Lights whose discs are seen, with their radii: of a sun the sine of the angle.
    pub(super) lights: Vec<(Light, f64)>,
    pub(super) surfaces: Vec<Surface>,
    /// Whether any of them is rough or scatters, so that light takes one of several ways there.
    pub(super) is_random: bool,
    /// By the bodies, those that scatter.
    pub(super) scatterers: &'scene [Option<&'scene dyn Scatterer>],
    /// The clear bodies around the eye.
    pub(super) around_eye: Within,
    pub(super) environment: &'scene Environment,
    /// Share of a camera ray's energy that may be dropped.
    pub(super) energy_bound: f64,
}

/// Result of a camera ray at one wavelength.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    /// Linear RGB radiance; each channel is computed as if all its light were of this wavelength.
    pub(super) radiance: DVec3,
    /// Share of the ray's energy that was not followed to its end.
    pub(super) lost: f64,
}

/// A camera ray up to its first surface, which does not depend on the wavelength.
pub(super) enum Primary {
    /// The ray meets a polished clear body.
    Clear(Box<Entry>),
    /// The ray meets a rough, partly clear or scattering body, or begins within clear ones: it is followed from the eye on.
    FromEye(Ray),
    /// The ray meets a matte body, which sends this radiance.
    Matte(DVec3),
}

/// A camera ray at the surface of a clear body.
pub(super) struct Entry {
    arrival: Arrival,
    /// Direction of the reflection at the surface.
    reflected: DVec3,
    /// Radiance of the matte body or of the environment that the reflection meets; `None` if it
    /// meets a clear body.
    reflected_radiance: Option<DVec3>,
}

/// What a ray meets first.
enum Ahead<'scene> {
    /// The surface of a clear body.
    Surface(Hit, Way),
    /// A matte body or the environment, with the radiance that it sends and its distance.
    Light(DVec3, f64),
    /// A body that scatters, and its distance.
    Scatterer(&'scene dyn Scatterer, f64),
}

/// A ray that arrives at a surface.
#[derive(Clone, Copy)]
struct Arrival {
    point: DVec3,
    direction: DVec3,
    /// Unit normal of the face, facing the ray.
    normal: DVec3,
    /// Unit normal that reflects and refracts: interpolated on a smooth body, unless it faces away.
    shading: DVec3,
    surface: Surface,
    /// Whether it comes from outside the body.
    enters: bool,
    place: Place,
    /// The bodies before the surface.
    before: Within,
    /// The bodies behind it.
    behind: Within,
    throughput: DVec3,
}

/// A ray that leaves a surface, or the eye.
#[derive(Clone, Copy)]
pub(super) struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// The face that it comes from; none for the eye's.
    left: Option<Place>,
    /// The bodies around it.
    within: Within,
    /// Factor from the ray's radiance to its contribution to the camera ray.
    throughput: DVec3,
    /// Whether it shows the discs of lights: not if they were counted where it left.
    sees_lights: bool,
}

impl Ray {
    fn of_eye(origin: DVec3, direction: DVec3, within: Within) -> Self {
        Self { origin, direction, left: None, within, throughput: DVec3::ONE, sees_lights: true }
    }

    fn energy(&self) -> f64 {
        self.throughput.max_element()
    }
}

// Ordered by energy, so that the heap yields the strongest ray first.
impl Ord for Ray {
    fn cmp(&self, other: &Self) -> Ordering {
        self.energy().total_cmp(&other.energy())
    }
}

impl PartialOrd for Ray {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ray {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Ray {}

impl<'scene> Surroundings<'scene> {
    /// Finds the first surface that a camera ray meets, of whatever body; `None` if it meets none.
    pub(super) fn primary(&self, eye: DVec3, direction: DVec3) -> Option<Primary> {
        if !self.around_eye.is_empty() {
            let within = self.around_eye;
            return Some(Primary::FromEye(Ray::of_eye(eye, direction, within)));
        }
        let hit = self.bodies.enter(eye, direction, None)?;
        if let Some(radiance) = self.bodies.sent(&hit, eye + hit.distance * direction) {
            return Some(Primary::Matte(radiance));
        }
        let ray = Ray::of_eye(eye, direction, Within::default());
        let surface = self.surfaces[hit.place.body];
        if surface.alpha > 0.0 || surface.is_partly_clear || surface.is_metal() || self.scatterer(&hit).is_some() {
            return Some(Primary::FromEye(ray));
        }
        let arrival = self.arrive(&ray, hit, Way::In, DVec3::ONE)?;
        let reflected = arrival.reflected();
        let reflected_radiance = match self.ahead(&arrival.leave(reflected, arrival.before, DVec3::ONE))? {
            Ahead::Surface(..) | Ahead::Scatterer(..) => None,
            Ahead::Light(radiance, _) => Some(radiance),
        };
        Some(Primary::Clear(Box::new(Entry { arrival, reflected, reflected_radiance })))
    }

    /// Returns the body at a hit if it scatters.
    fn scatterer(&self, hit: &Hit) -> Option<&'scene dyn Scatterer> {
        self.scatterers.get(hit.place.body).copied().flatten()
    }

    /// Finds what a ray meets; `None` if it is within a body whose surface has a gap there.
    fn ahead(&self, ray: &Ray) -> Option<Ahead<'scene>> {
        let Some((hit, way)) = self.bodies.cross(ray.origin, ray.direction, ray.left, &ray.within) else {
            let around = || Ahead::Light(self.around(ray), f64::INFINITY);
            return ray.within.is_empty().then(around);
        };
        if let Some(scatterer) = self.scatterer(&hit) {
            return Some(Ahead::Scatterer(scatterer, hit.distance));
        }
        let sent = self.bodies.sent(&hit, ray.origin + hit.distance * ray.direction);
        Some(sent.map_or(Ahead::Surface(hit, way), |radiance| Ahead::Light(radiance, hit.distance)))
    }

    /// Returns the radiance of the environment and of the lights' discs along a ray.
    fn around(&self, ray: &Ray) -> DVec3 {
        let mut radiance = self.environment.radiance(ray.direction);
        for (light, radius) in self.lights.iter().filter(|_| ray.sees_lights) {
            let arrival = light.arrival(ray.origin);
            let distance = if arrival.distance.is_finite() { arrival.distance } else { 1.0 };
            let sine = (radius / distance.max(f64::MIN_POSITIVE)).min(1.0);
            let ahead = arrival.direction.dot(ray.direction) > 0.0;
            if ahead && arrival.direction.cross(ray.direction).length() <= sine {
                radiance += arrival.irradiance / (PI * sine * sine);
            }
        }
        radiance
    }

    /// Follows `primary` at one wavelength with the bodies' `optics` at that wavelength. The
    /// strongest ray comes first, until all remaining rays together have less energy than the
    /// bound. At a rough surface light takes one way, at random.
    pub(super) fn follow(&self, primary: &Primary, optics: &[Optics], random: &mut Xoshiro256PlusPlus) -> Outcome {
        let mut outcome = Outcome::default();
        let mut waiting = BinaryHeap::with_capacity(16);
        match primary {
            Primary::Matte(radiance) => return Outcome { radiance: *radiance, lost: 0.0 },
            Primary::FromEye(ray) => waiting.push(*ray),
            Primary::Clear(entry) => {
                let Entry { arrival, reflected, reflected_radiance } = &**entry;
                let (reflectance, transmitted) = arrival.split(&self.order, optics);
                match reflected_radiance {
                    Some(radiance) => outcome.radiance += reflectance * *radiance,
                    None => waiting.push(arrival.leave(*reflected, arrival.before, DVec3::splat(reflectance))),
                }
                waiting.extend(transmitted);
            }
        }
        let mut pending: f64 = waiting.iter().map(Ray::energy).sum();
        // The strongest ray, if known without asking the heap: usually one under total reflection.
        let mut strongest: Option<Ray> = None;
        let mut hits = 1;
        while pending >= self.energy_bound
            && hits < MOST_HITS
            && let Some(ray) = strongest.take().or_else(|| waiting.pop())
        {
            pending -= ray.energy();
            let Some(arrival) = self.travel(&ray, optics, &mut outcome, random) else { continue };
            hits += 1;
            let (reflectance, transmitted) = if arrival.surface.alpha > 0.0 {
                (0.0, Some(arrival.scatter(&self.order, optics, random)))
            } else {
                arrival.split(&self.order, optics)
            };
            if let Some(ray) = self.reflect(&arrival, &mut outcome, random) {
                pending += ray.energy();
                waiting.push(ray);
            }
            // The many rays of a tree would wander between rough surfaces one by one.
            let (reflectance, transmitted) = match transmitted {
                Some(ray) if self.is_random && hits > MOST_SPLIT && reflectance > 0.0 => {
                    let reflects = random.random::<f64>() < reflectance;
                    let whole = Ray { throughput: ray.throughput / (1.0 - reflectance), ..ray };
                    if reflects { (1.0, None) } else { (0.0, Some(whole)) }
                }
                transmitted => (reflectance, transmitted),
            };
            let transmitted = transmitted.map(|ray| self.part(&arrival, ray, &mut outcome));
            if let Some(ray) = transmitted {
                pending += ray.energy();
                waiting.push(ray);
            }
            if reflectance > 0.0 {
                let ray = arrival.leave(arrival.reflected(), arrival.before, arrival.throughput * reflectance);
                pending += ray.energy();
                match waiting.peek() {
                    Some(other) if *other > ray => waiting.push(ray),
                    _ => strongest = Some(ray),
                }
            }
        }
        outcome.lost += waiting.iter().chain(&strongest).map(Ray::energy).sum::<f64>();
        outcome
    }

    /// Finds the next surface of a clear body along the ray. If there is none, the light of the matte
    /// body or of the environment ahead is added to `outcome`. A ray within bodies that meets no surface has left the
    /// smooth ones; within others, whose surface has a gap there, it is lost, and so it is if it comes into more bodies than
    /// are followed.
    fn travel(
        &self,
        ray: &Ray,
        optics: &[Optics],
        outcome: &mut Outcome,
        random: &mut Xoshiro256PlusPlus,
    ) -> Option<Arrival> {
        let (mut ray, mut ahead) = (*ray, self.ahead(ray));
        // A ray that started on a curved surface, above the face, may have passed the body's edge: it is outside.
        if ahead.is_none() {
            let smooth = ray.within.bodies().filter(|body| self.bodies.is_smooth(*body));
            let outside = smooth.fold(ray.within, |within, body| within.without(body));
            if outside != ray.within {
                ray.within = outside;
                ahead = self.ahead(&ray);
            }
        }
        let through = |distance: f64| {
            let matter = ray.within.matter(&self.order);
            ray.throughput * matter.map_or(DVec3::ONE, |body| (-distance * optics[body].absorption).exp())
        };
        let arrival = match ahead {
            Some(Ahead::Light(radiance, distance)) => {
                outcome.radiance += through(distance) * radiance;
                return None;
            }
            Some(Ahead::Scatterer(scatterer, distance)) => {
                match scatterer.sent(ray.origin, ray.direction, random) {
                    Some(radiance) => outcome.radiance += through(distance) * radiance,
                    None => outcome.lost += ray.energy(),
                }
                return None;
            }
            Some(Ahead::Surface(hit, way)) => self.arrive(&ray, hit, way, through(hit.distance)),
            None => None,
        };
        if arrival.is_none() {
            outcome.lost += ray.energy();
        }
        arrival
    }

    /// Returns the ray that leaves a metal, at random; `None` where no metal is. The lights are added to `outcome`.
    fn reflect(&self, arrival: &Arrival, outcome: &mut Outcome, random: &mut Xoshiro256PlusPlus) -> Option<Ray> {
        let Arrival { surface, point, direction, place, .. } = *arrival;
        let Painted { color, clear, metallic, metal_alpha } = surface.painted;
        if !surface.is_metal() {
            return None;
        }
        let mattes = self.bodies.mattes();
        let given = mattes.normal(place, arrival.normal, point, self.bodies.paint(place));
        let normal = if given.dot(direction) < 0.0 { given } else { arrival.normal };
        let (f0, throughput) = (color * surface.f0, (1.0 - clear) * metallic * arrival.throughput);
        if metal_alpha == 0.0 {
            let left = throughput * rough::schlick(f0, -normal.dot(direction));
            return Some(arrival.leave(arrival.on_side(reflect(direction, normal), false), arrival.before, left));
        }
        let metal = (normal, metal_alpha, f0);
        let lights = &mut outcome.radiance;
        let (direction, left) = rough::reflect(random, direction, metal, |direction, below, left| {
            for light in mattes.arrivals(point) {
                let sent = rough::toward(light.direction, direction, metal, below);
                *lights += throughput * left * sent * light.irradiance;
            }
        });
        let direction = arrival.on_side(direction, false);
        Some(Ray { sees_lights: false, ..arrival.leave(direction, arrival.before, throughput * left) })
    }

    /// Takes from a ray that crosses a partly clear surface what does not enter, for which the surface is matt.
    fn part(&self, arrival: &Arrival, mut ray: Ray, outcome: &mut Outcome) -> Ray {
        let Arrival { surface, enters, point, .. } = *arrival;
        // A rough wall's one ray may have been reflected.
        let passes = surface.is_thin && ray.direction.dot(arrival.normal) < 0.0;
        let crosses = passes || ray.within.matter(&self.order) != arrival.before.matter(&self.order);
        if surface.painted.clear < 1.0 && enters && crosses {
            let sent = self.bodies.sent_in_part((arrival.place, surface.painted), arrival.normal, point);
            outcome.radiance += ray.throughput * sent;
            ray.throughput *= surface.painted.clear;
        }
        ray
    }

    /// Returns a ray's arrival at `hit`; `None` if it comes into more bodies than are followed.
    fn arrive(&self, ray: &Ray, hit: Hit, way: Way, throughput: DVec3) -> Option<Arrival> {
        let Ray { origin, direction, within: before, .. } = *ray;
        let point = origin + hit.distance * direction;
        let mut surface = self.surfaces[hit.place.body];
        let (side, behind) = match way {
            Way::In if surface.is_thin => (1.0, before),
            Way::In => (1.0, before.with(hit.place.body)?),
            Way::Out => (-1.0, before.without(hit.place.body)),
        };
        let normal = side * hit.normal;
        let paint = self.bodies.paint(hit.place);
        if let Some(paint) = paint {
            surface.painted = paint.at(hit.place, point);
        }
        let (point, given) = self.bodies.curved(&hit, point, direction);
        let given = paint.map_or(given, |paint| paint.bent(hit.place, point, given));
        let given = side * given;
        let shading = if given.dot(direction) < 0.0 { given } else { normal };
        let enters = matches!(way, Way::In);
        Some(Arrival {
            point,
            direction,
            normal,
            shading,
            surface,
            enters,
            place: hit.place,
            before,
            behind,
            throughput,
        })
    }
}

impl Arrival {
    fn leave(&self, direction: DVec3, within: Within, throughput: DVec3) -> Ray {
        Ray { origin: self.point, direction, left: Some(self.place), within, throughput, sees_lights: true }
    }

    /// Returns the direction of the reflection: by the face's normal where the interpolated one would send it through the
    /// face.
    fn reflected(&self) -> DVec3 {
        let reflected = reflect(self.direction, self.shading);
        if reflected.dot(self.normal) > 0.0 { reflected } else { reflect(self.direction, self.normal) }
    }

    /// Returns the reflectance of a thin wall, between whose two interfaces light goes back and forth, and the transmitted
    /// ray.
    fn split_thin(&self, Optics { index, base_color, .. }: Optics) -> (f64, Option<Ray>) {
        let reflectance = pane(-self.shading.dot(self.direction), index);
        let throughput = self.throughput * base_color * self.surface.color() * (1.0 - reflectance);
        (reflectance, Some(self.leave(self.direction, self.before, throughput)))
    }

    /// Returns the ratio of the refractive indices behind the surface and before it, and the ray behind it, which goes straight
    /// on; no ratio if the same matter is on both sides. Light takes a body's colour once on its way through it: where its ray
    /// first comes into its matter, or, if the eye is there, leaves it.
    fn cross(&self, order: &Order, optics: &[Optics]) -> (Option<f64>, Ray) {
        let (mut before, mut behind) = (self.before, self.behind);
        let (from, to) = (before.matter(order), behind.matter(order));
        if from == to {
            return (None, self.leave(self.direction, behind, self.throughput));
        }
        let index = |matter: Option<usize>| matter.map_or(1.0, |body| optics[body].index);
        let mut color = DVec3::ONE;
        if let Some(body) = from
            && before.color(body)
        {
            color *= self.color(body, optics);
        }
        if let Some(body) = to
            && behind.color(body)
        {
            color *= self.color(body, optics);
        }
        (Some(index(to) / index(from)), self.leave(self.direction, behind, self.throughput * color))
    }

    /// Returns the colour that light takes from a body at this surface: with its images, if the surface is the body's own.
    fn color(&self, body: usize, optics: &[Optics]) -> DVec3 {
        let painted = if body == self.place.body { self.surface.color() } else { DVec3::ONE };
        painted * optics[body].base_color
    }

    /// Returns the one ray that leaves a rough surface, at random.
    fn scatter(&self, order: &Order, optics: &[Optics], random: &mut Xoshiro256PlusPlus) -> Ray {
        if self.surface.is_thin {
            return self.scatter_thin(optics[self.place.body], random);
        }
        let (relative_index, through) = self.cross(order, optics);
        let Some(relative_index) = relative_index else { return through };
        let (direction, passes) =
            rough::scatter(random, self.direction, self.shading, self.surface.alpha, relative_index);
        let direction = self.on_side(direction, passes);
        if passes { Ray { direction, ..through } } else { self.leave(direction, self.before, self.throughput) }
    }

    /// Mirrors a direction at the face if it goes to the wrong side of it, by an interpolated normal.
    fn on_side(&self, direction: DVec3, passes: bool) -> DVec3 {
        if (direction.dot(self.normal) < 0.0) == passes { direction } else { reflect(direction, self.normal) }
    }

    /// Returns the one ray that leaves a rough thin wall, at random: one facet reflects it, and what goes through goes as if
    /// reflected to the other side (`KHR_materials_transmission`).
    fn scatter_thin(&self, Optics { index, base_color, .. }: Optics, random: &mut Xoshiro256PlusPlus) -> Ray {
        let facet = rough::facet(random, self.direction, self.shading, self.surface.alpha);
        let passes = random.random::<f64>() >= pane(-facet.dot(self.direction), index);
        let reflected = reflect(self.direction, facet);
        let direction = if passes { reflect(reflected, self.normal) } else { reflected };
        let color = if passes { base_color * self.surface.color() } else { DVec3::ONE };
        self.leave(self.on_side(direction, passes), self.before, self.throughput * color)
    }

    /// Returns the surface's reflectance and the transmitted ray; `None` under total reflection. A surface with the same
    /// matter on both sides is not there: all light crosses it straight.
    fn split(&self, order: &Order, optics: &[Optics]) -> (f64, Option<Ray>) {
        if self.surface.is_thin {
            return self.split_thin(optics[self.place.body]);
        }
        let (relative_index, through) = self.cross(order, optics);
        let Some(relative_index) = relative_index else { return (0.0, Some(through)) };
        let cosine = -self.shading.dot(self.direction);
        // Skips the oracle well beyond the critical angle; near it, the oracle decides.
        let squared_sine = (1.0 - cosine) * (1.0 + cosine);
        if squared_sine > 1.000_001 * relative_index * relative_index {
            return (1.0, None);
        }
        let mut refracted = refraction::refract(self.direction, self.shading, relative_index);
        if !refracted.total && refracted.direction.dot(self.normal) >= 0.0 {
            // It would stay before its own face.
            refracted = refraction::refract(self.direction, self.normal, relative_index);
        }
        if refracted.total {
            return (1.0, None);
        }
        let reflectance = fresnel::dielectric(cosine, relative_index);
        let throughput = through.throughput * (1.0 - reflectance);
        (reflectance, Some(Ray { direction: refracted.direction, throughput, ..through }))
    }
}

/// Returns the reflectance of two interfaces, between which light goes back and forth.
fn pane(cosine: f64, index: f64) -> f64 {
    let once = fresnel::dielectric(cosine, index);
    2.0 * once / (1.0 + once)
}

/// Reflects by the vector form of the law of reflection. The oracle's angle form gives the same
/// result to the last digits, but would take a quarter of an image's render time: most hits are
/// reflections.
fn reflect(incident: DVec3, normal: DVec3) -> DVec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

#[cfg(test)]
mod tests;
