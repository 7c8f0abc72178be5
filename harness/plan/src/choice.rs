//! How a body is drawn: the rung or technique that its material and shape require, and why.

use super::among;
use super::effect::Effect;
use super::numbers::{percent, short};
use super::quality::Technique;
use super::shape;
use super::thickness::Thickness;
use super::through;
use crate::request::Scattering;
use crate::{Outside, Quality, Request, Rung};
use lapidary_scene::{Object, Scene, Shape};

/// Triangles of a scene up to which copies are drawn as bodies of their own: of more, the corners are beyond a buffer that every
/// device offers.
const MOST_JOINED: usize = 2_500_000;

/// How an object is drawn: by a rung that the user or the material names, or by a technique.
pub(super) enum Choice {
    /// A named rung.
    Named(Rung),
    /// A technique; the requested quality decides its rung.
    By(Technique),
}

/// Returns the rung or technique for an object, and the reason.
pub(super) fn of(object: &Object, scene: &Scene, request: &Request<'_>) -> (Choice, String) {
    let asked = request.rung_of(object);
    if asked.is_for_clear_stones() && !object.material.is_clear() {
        let (choice, reason) = by_material(object, scene, request);
        return (choice, format!("{asked} was asked for, which is for clear stones, but {reason}"));
    }
    if asked != Rung::ByMaterial {
        return (Choice::Named(asked), "asked for".to_owned());
    }
    by_material(object, scene, request)
}

/// Returns the rung or technique that an object's material requires, and the reason.
fn by_material(object: &Object, scene: &Scene, request: &Request<'_>) -> (Choice, String) {
    let material = &object.material;
    if material.scatters() {
        return scattering(object, scene, request);
    }
    let (technique, reason) = if material.transmission == 0.0 {
        (Technique::Opaque, "opaque: transmission 0, and nothing inside scatters".to_owned())
    } else if let Some(reason) = among_others(object, scene, request) {
        (Technique::Among, format!("clear: transmission {}; {reason}", material.transmission))
    } else if material.thickness == 0.0 {
        let reason = format!("clear: transmission {}, and a thin wall: thickness 0", material.transmission);
        (Technique::ThinWall, reason)
    } else {
        let joined = request.without.has(Effect::Instances);
        let (technique, shape) = clear(Shape::of(if joined { &object.mesh } else { object.shape() }));
        (technique, format!("clear: transmission {}, thickness {}; {shape}", material.transmission, material.thickness))
    };
    (Choice::By(technique), reason)
}

/// Returns why light that leaves a clear body has to be followed through others; `None` if it has not.
fn among_others(object: &Object, scene: &Scene, request: &Request<'_>) -> Option<String> {
    let has = |effect| !request.without.has(effect);
    let inside = object.material.thickness > 0.0;
    let walks = inside && walks(object, request);
    let meets = || walks && meets(object, scene, request);
    // A setting is met where light leaves the stone, unless time is no matter.
    let shared = || match request.quality {
        Quality::Best => among::shares_space(object, scene),
        Quality::Fast | Quality::Good => among::reaches_into(object, scene, meets()),
    };
    if inside
        && has(Effect::Nested)
        && let Some(other) = shared()
    {
        return Some(format!("it shares space with {}", other.name));
    }
    if inside && has(Effect::Smooth) && shape::is_smooth(object) {
        return Some("its normals are those of a smooth surface".to_owned());
    }
    if has(Effect::Rough) && object.material.facet_slope() > 0.0 {
        return Some(format!("roughness {}", short(object.material.roughness)));
    }
    if has(Effect::PartialTransmission) && among::is_partly_clear(object) {
        return Some("a share of the light does not enter".to_owned());
    }
    if let Some((_, slot)) =
        among::IMAGES_MET.into_iter().find(|(effect, slot)| has(*effect) && among::shows(object, *slot))
    {
        return Some(format!("it has a {}", slot.name()));
    }
    if has(Effect::VertexColor) && !object.mesh.colors.is_empty() {
        return Some("its vertices have colours".to_owned());
    }
    // Asked for what light meets, a user has chosen another way.
    if request.outside.is_some() {
        return None;
    }
    if let Some(other) = among::overlaps(object, scene, request.size).filter(|_| has(Effect::Behind)) {
        let from_others = walks.then(|| through::others(object, scene, request.size));
        if from_others.is_none_or(|others| !others.is_little) {
            let share = from_others.map_or_else(String::new, |others| {
                format!(", and {} of its light comes from such", percent(others.share))
            });
            return Some(format!("in the view it overlaps {}, which is clear{share}", other.name));
        }
    }
    // A search of all copies for each hit takes many times as long as planes of one.
    let is_best = request.quality == Quality::Best && scene.triangle_count() <= MOST_JOINED;
    if is_best && has(Effect::Behind) && among::copies_overlap(object, scene, request.size) {
        return Some("in the view its copies overlap".to_owned());
    }
    if request.quality == Quality::Fast || !has(Effect::Around) {
        return None;
    }
    let reason = among::beside(object, scene, request.size)?;
    (!meets()).then_some(reason)
}

/// Whether what leaves a convex body can be looked for by the effect `around` alone, to which others cover all that is behind them,
/// and what rays inside meet by the effect `nested`.
fn meets(object: &Object, scene: &Scene, request: &Request<'_>) -> bool {
    let has = |effect| !request.without.has(effect);
    let lights = !scene.lights.is_empty() && has(Effect::Light);
    request.quality == Quality::Good
        && request.outside.is_none_or(|outside| outside == Outside::Triangles)
        && has(Effect::Around)
        && among::fits_around(object.copies.is_some(), false, lights)
        && !scene.objects.iter().any(among::is_sheer)
}

/// Whether a clear body with an inside may be drawn by the planes of its facets where time counts.
fn walks(object: &Object, request: &Request<'_>) -> bool {
    let joined = object.copies.is_some() && request.without.has(Effect::Instances);
    request.quality != Quality::Best && !joined && shape::is_convex(object)
}

/// Returns the technique for a clear body with an inside, and the reason. The proxy is never
/// chosen: in no ladder does it come close to the actual stone.
fn clear(shape: Shape) -> (Technique, &'static str) {
    match shape {
        Shape::Convex => (Technique::Convex, "closed and convex: rays inside meet its facets, by a map of them"),
        Shape::Concave => (Technique::Concave, "closed, not convex: rays inside meet its triangles"),
        Shape::Open => (
            Technique::Concave,
            "not closed: rays inside meet its triangles, and go straight on into the environment where there are none",
        ),
    }
}

/// Returns the rung or technique for a scattering body, and the reason.
fn scattering(object: &Object, scene: &Scene, request: &Request<'_>) -> (Choice, String) {
    if let (Some(solver), None) = (object.material.solver, request.scattering) {
        return (Choice::Named(solver.into()), "extras.lapidary.solver names it".to_owned());
    }
    let (technique, reason) = by_thickness(object, scene, request);
    (Choice::By(technique), reason)
}

/// Decides whether light comes through a scattering body; returns the technique and the reason.
fn by_thickness(object: &Object, scene: &Scene, request: &Request<'_>) -> (Technique, String) {
    let Some(medium) = &object.material.medium else {
        let reason = "sigma0 alone: no scattering and absorption to follow light through it by";
        return (Technique::Cdrf, reason.to_owned());
    };
    if let Some(asked) = request.scattering {
        let technique = match asked {
            Scattering::Cdrf => Technique::Cdrf,
            Scattering::OpticalPath => Technique::OpticalPath,
            Scattering::Diffusion => Technique::Diffusion,
        };
        return (technique, "asked for, whatever its thickness".to_owned());
    }
    if scene.lights.is_empty() && request.quality == Quality::Fast {
        return (Technique::Cdrf, "no light but the environment, which takes no path through bodies".to_owned());
    }
    let thickness = Thickness::of(object, medium);
    if thickness.thickness == 0.0 {
        return (Technique::Cdrf, "its mesh has no inside whose thickness could be measured".to_owned());
    }
    let free = thickness.mean_free_path;
    if free.is_infinite() {
        let reason = "somewhere a colour is neither scattered nor absorbed: light comes through the body";
        return (Technique::Translucent, reason.to_owned());
    }
    let paths = thickness.mean_free_paths();
    let most = super::thickness::MOST_MEAN_FREE_PATHS;
    let source = if thickness.is_given { "given" } else { "measured" };
    let compared = format!(
        "{source} thickness {} is {} mean free paths of {}",
        short(thickness.thickness),
        short(paths),
        short(free)
    );
    if thickness.shows_through() {
        return (Technique::Translucent, format!("{compared}, at most {most}: light comes through the body"));
    }
    let reason = format!("{compared}, above {most}: light stays near the surface, whose curvature says how it spreads");
    (Technique::Cdrf, reason)
}
