//! Which body may cast a shadow on which, by their bounds and the lights.

use crate::remembered::Remembered;
use lapidary_scene::mesh_diagnosis::shades_itself;
use lapidary_scene::{Bounds, Light, Object, Scene};

/// Number of bodies above which any counts as in the shadow of another: comparing all pairs of more would
/// take longer than drawing them.
const MOST_COMPARED: usize = 256;
/// Share of a body's extent by which it may sink into another that it stands on.
const SUNK: f32 = 0.01;

/// What a body does to the light of a lamp or sun on its way to another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Casting {
    /// Nothing: it has no triangles, or is a clear thin wall.
    Nothing,
    /// It takes all light away.
    Opaque,
    /// It is a clear stone, and colours the light.
    Clear,
}

impl Casting {
    /// Returns what a body does.
    #[must_use]
    pub fn of(object: &Object) -> Self {
        let clear = object.material.is_clear();
        if object.mesh.indices.is_empty() || object.material.is_thin_wall() {
            return Self::Nothing;
        }
        if clear { Self::Clear } else { Self::Opaque }
    }
}

/// Returns the first body that does this to light which falls on `receiver`, which may be itself; `None`
/// if no body does.
#[must_use]
pub fn caster<'a>(receiver: &Object, scene: &'a Scene, casting: Casting) -> Option<&'a Object> {
    let of_receiver = (receiver, bounds(receiver));
    let others = || scene.objects.iter().filter(|other| Casting::of(other) == casting);
    let all = scene.objects.len() > MOST_COMPARED && !scene.lights.is_empty();
    let found = others()
        .filter(|other| !std::ptr::eq(receiver, *other))
        .find(|other| all || casts((other, bounds(other)), of_receiver, &scene.lights));
    found.or_else(|| {
        others()
            .find(|other| std::ptr::eq(receiver, *other) && casts((other, of_receiver.1), of_receiver, &scene.lights))
    })
}

/// Returns the smallest box around a body.
#[must_use]
pub fn bounds(body: &Object) -> Bounds {
    Bounds::of(body.mesh.positions.iter().copied())
}

/// Whether a body may keep light from another or from itself, each given with its box.
#[must_use]
pub fn casts(caster: (&Object, Bounds), receiver: (&Object, Bounds), lights: &[Light]) -> bool {
    if std::ptr::eq(caster.0, receiver.0) {
        static SHADES_ITSELF: Remembered<bool> = Remembered::new();
        return !lights.is_empty() && SHADES_ITSELF.of(&caster.0.mesh, shades_itself);
    }
    may_cast(caster.1, receiver.1, lights)
}

/// Whether a body within `caster` may keep light from a body within `receiver`.
fn may_cast(caster: Bounds, receiver: Bounds, lights: &[Light]) -> bool {
    lights.iter().any(|light| {
        // The box that light on its way to the receiver crosses, per axis from `least` to `most`.
        let sunk = SUNK * (receiver.max - receiver.min).min(caster.max - caster.min).min_element();
        let (least, most) = match *light {
            Light::Directional { toward, .. } => {
                let open = |towards: f32, bound: f32| if towards > 0.0 { f32::INFINITY } else { bound };
                let least = receiver.min.to_array().into_iter().zip((-toward).to_array());
                let most = receiver.max.to_array().into_iter().zip(toward.to_array());
                let least: Vec<f32> = least.map(|(bound, towards)| -open(towards, -bound)).collect();
                let most: Vec<f32> = most.map(|(bound, towards)| open(towards, bound)).collect();
                ([least[0], least[1], least[2]].into(), [most[0], most[1], most[2]].into())
            }
            Light::Point { position, .. } | Light::Spot { position, .. } => {
                (receiver.min.min(position), receiver.max.max(position))
            }
        };
        let meets: bool = caster.min.cmple(most - sunk).all() && caster.max.cmpge(least + sunk).all();
        meets && near_the_way(caster, receiver, light)
    })
}

/// Whether the sphere about a caster comes as near as that to the way of light to the sphere about a
/// receiver.
fn near_the_way(caster: Bounds, receiver: Bounds, light: &Light) -> bool {
    let Light::Directional { toward, .. } = *light else { return true };
    let way = caster.centre() - receiver.centre();
    let aside = way - way.dot(toward) * toward;
    aside.length() <= caster.radius() + receiver.radius()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use lapidary_scene::Material;
    use lapidary_scene::surfaces::{rounded_box, sphere, torus};

    fn sun(toward: Vec3) -> Light {
        Light::Directional { toward: toward.normalize(), irradiance: Vec3::ONE }
    }

    fn at(position: Vec3, half: Vec3) -> Bounds {
        Bounds { min: position - half, max: position + half }
    }

    #[test]
    fn what_stands_before_the_light_casts() {
        let (body, table) = (at(Vec3::ZERO, Vec3::ONE), at(Vec3::new(0.0, -1.1, 0.0), Vec3::new(9.0, 0.1, 9.0)));
        for toward in [Vec3::Y, Vec3::new(0.8, 0.3, 0.2), Vec3::new(-1.0, 0.1, 0.4)] {
            let lights = [sun(toward)];
            assert!(may_cast(body, table, &lights) && !may_cast(table, body, &lights), "{toward}");
        }
        // From below the table takes the body's light.
        assert!(may_cast(table, body, &[sun(-Vec3::Y)]) && !may_cast(body, table, &[sun(-Vec3::Y)]));
        let beside = at(Vec3::new(5.0, 0.0, 0.0), Vec3::ONE);
        assert!(!may_cast(beside, body, &[sun(Vec3::Y)]) && may_cast(beside, body, &[sun(Vec3::new(1.0, 0.1, 0.0))]));
        let lamp = |position| [Light::Point { position, intensity: Vec3::ONE }];
        assert!(may_cast(beside, body, &lamp(Vec3::new(9.0, 0.0, 0.0))));
        assert!(!may_cast(beside, body, &lamp(Vec3::new(-9.0, 0.0, 0.0))));
        assert!(!may_cast(beside, body, &[]));
    }

    #[test]
    fn only_a_bent_body_casts_on_itself() {
        let alone = |mesh| {
            let objects = vec![Object::new("body", mesh, Material::standard())];
            let scene = Scene { objects, lights: vec![sun(Vec3::Y)], ..Scene::named("octahedron").expect("built in") };
            caster(&scene.objects[0], &scene, Casting::Opaque).is_some()
        };
        assert!(!alone(sphere(1.0, 32)) && !alone(rounded_box(glam::DVec3::new(1.0, 0.5, 2.0), 0.05, 2)));
        assert!(alone(torus(2.0, 0.5, 24, 12)));
        let vitrine = Scene::named("vitrine").expect("built in");
        let of_itself: Vec<bool> = vitrine.objects.iter().map(|body| shades_itself(&body.mesh)).collect();
        // The table's corners have edges that are bent inwards by less than a texel.
        assert_eq!(of_itself, [false, false, false, true, true, true, false, false, false, false, true]);
        let mut two = sphere(1.0, 16);
        two.append(&sphere(1.0, 16).placed(glam::DQuat::IDENTITY, 3.0 * glam::DVec3::X));
        assert!(alone(two));
    }
}
