//! How much of the light that a convex stone sends to the eye comes from other clear bodies.

use crate::among::seen;
use crate::remembered::key;
use crate::shape::is_convex;
use glam::{DVec3, Vec2, Vec3, Vec4};
use lapidary_bvh_trace::traversal;
use lapidary_convex_trace as convex_trace;
use lapidary_scene::{Bounds, Bvh, Camera, Convex, Mesh, Object, Scene, clip_from_world};
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash as _, Hasher as _};
use std::sync::{Arc, Mutex, PoisonError};

/// Share of a stone's light, from other clear bodies, up to which it may be drawn without them: a hundredth costs a FLIP of about
/// .01 (docs/gem_scene.md), and .05 is what the quicker rung may cost.
const MOST: f32 = 0.05;
/// Area of a stone, as a share of the picture's, up to which it may lack more: a tenth of the picture's side.
const SMALL: f32 = 0.01;
/// Sum over such stones of the products of share and area: as much FLIP of the whole picture, by the same rule.
const MOST_OF_PICTURE: f32 = 0.02;
/// Rays along each side of the picture of a stone, and of each of several copies: enough for a share within a few hundredths.
const RAYS: u32 = 12;
const RAYS_OF_COPY: u32 = 6;
/// Copies that are looked at, evenly among more.
const MOST_COPIES: usize = 32;
/// Facets that a ray meets inside, as many as by quality good.
const HITS: u32 = 8;
/// Share of the way from the eye by which a body has to be nearer than the stone to hide it.
const NEARER: f32 = 1e-4;

/// What of a stone's light comes from other clear bodies or from other copies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Others {
    /// Share of the light, as the eye sees it; 0 for an object that is no clear convex stone, or is not seen.
    pub(crate) share: f32,
    /// Whether it is so little that the stone may be drawn without them.
    pub(crate) is_little: bool,
}

/// Returns what of an object's light comes from others in a picture of this size.
pub(crate) fn others(object: &Object, scene: &Scene, size: [u32; 2]) -> Others {
    let number = scene.objects.iter().position(|other| std::ptr::eq(other, object));
    number.map_or_else(Others::default, |number| all(scene, size)[number])
}

/// Returns the same of all objects. A scene is planned several times for one picture, so that the last ones are kept.
fn all(scene: &Scene, size: [u32; 2]) -> Arc<[Others]> {
    static LAST: Mutex<Option<(u64, Arc<[Others]>)>> = Mutex::new(None);
    let fingerprint = fingerprint(scene, size);
    let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, others)) = last().as_ref().filter(|(known, _)| *known == fingerprint) {
        return Arc::clone(others);
    }
    let all = All::of(scene);
    let matrix = clip_from_world(scene, size[0], size[1]);
    let world_from_clip = matrix.as_dmat4().inverse();
    let share_and_area = |object: &Object| {
        if !object.material.has_clear_inside() || !is_convex(object) {
            return (0.0, 0.0);
        }
        let (rays, step, copies) = match &object.copies {
            None => (RAYS, 1, vec![object.mesh.clone()]),
            Some(copies) => {
                let step = copies.places.len().div_ceil(MOST_COPIES).max(1);
                let places = copies.places.iter().step_by(step);
                (RAYS_OF_COPY, step, places.map(|place| copies.shape.transformed(place.transform())).collect())
            }
        };
        let (mut sum, mut area) = (Sum::default(), 0.0);
        for mesh in copies {
            let bounds = Bounds::of(mesh.positions.iter().copied());
            let Some((least, most)) = seen(bounds, matrix) else { continue };
            let Some(stone) = Stone::of(&mesh, object.material.ior) else { continue };
            let mut hits = 0;
            for number in 0..rays * rays {
                let place = Vec2::new((number % rays) as f32 + 0.5, (number / rays) as f32 + 0.5) / rays as f32;
                let place = least + place * (most - least);
                // The depth is that of a plane in the middle of the scene's.
                let point = world_from_clip.project_point3(place.extend(0.5).as_dvec3());
                let direction = (point - scene.camera.eye.as_dvec3()).normalize_or(DVec3::NEG_Z);
                hits += u32::from(stone.look(&all, &scene.camera, direction, &mut sum));
            }
            // The picture is 2 wide and 2 high.
            area += 0.25 * (most - least).element_product() * hits as f32 / (rays * rays) as f32;
        }
        (if sum.all > 0.0 { sum.of_clear / sum.all } else { 0.0 }, step as f32 * area)
    };
    let others = little(&scene.objects.iter().map(share_and_area).collect::<Vec<_>>());
    *last() = Some((fingerprint, Arc::clone(&others)));
    others
}

/// Decides which stones have little light from others, by their shares and their areas in the picture as shares of it.
fn little(found: &[(f32, f32)]) -> Arc<[Others]> {
    let mut others: Vec<Others> = found.iter().map(|&(share, _)| Others { share, is_little: share <= MOST }).collect();
    let of_picture = |number: &usize| found[*number].0 * found[*number].1;
    let mut more: Vec<usize> = (0..found.len()).filter(|&number| !others[number].is_little).collect();
    more.sort_by(|one, other| of_picture(one).total_cmp(&of_picture(other)));
    let mut sum = 0.0;
    for number in more {
        sum += of_picture(&number);
        others[number].is_little = sum <= MOST_OF_PICTURE && found[number].1 <= SMALL;
    }
    others.into()
}

/// Returns a hash of what shares follow from.
fn fingerprint(scene: &Scene, size: [u32; 2]) -> u64 {
    let mut hasher = DefaultHasher::new();
    let Camera { eye, target, up, vertical_fov } = scene.camera;
    size.hash(&mut hasher);
    for vector in [eye, target, up, Vec3::splat(vertical_fov)] {
        vector.to_array().map(f32::to_bits).hash(&mut hasher);
    }
    for object in &scene.objects {
        let material = &object.material;
        [key(&object.mesh), key(object.shape())].hash(&mut hasher);
        (material.is_clear(), material.is_thin_wall(), material.ior.to_bits()).hash(&mut hasher);
    }
    hasher.finish()
}

/// The triangles of all bodies, as a ray meets them outside: those of clear bodies from their front, others from both sides.
struct All {
    bvh: Bvh,
    /// Triangles before this one are not clear.
    first_clear: u32,
}

impl All {
    fn of(scene: &Scene) -> Self {
        let (mut positions, mut indices) = (Vec::new(), Vec::new());
        let mut first_clear = 0;
        for clear in [false, true] {
            for object in scene.objects.iter().filter(|object| object.material.is_clear() == clear) {
                let offset = positions.len() as u32;
                positions.extend(&object.mesh.positions);
                for corners in object.mesh.indices.chunks_exact(3) {
                    let [a, b, c] = [0, 1, 2].map(|corner| offset + corners[corner]);
                    // The hierarchy's rays leave a solid: turned round, they enter it.
                    indices.extend([a, c, b]);
                    if !clear {
                        indices.extend([a, b, c]);
                    }
                }
            }
            if !clear {
                first_clear = (indices.len() / 3) as u32;
            }
        }
        Self { bvh: Bvh::build(&positions, &indices), first_clear }
    }

    /// Returns the distance of what a ray meets, and whether that is clear.
    fn met(&self, position: Vec3, direction: Vec3) -> Option<(f32, bool)> {
        let none = lapidary_bvh_trace::BVH_TRACE_NONE;
        let hit = traversal::trace(&self.bvh.nodes, &self.bvh.corners, position, direction, none);
        let original = self.bvh.order.get(hit.triangle as usize)?;
        Some((hit.distance, *original >= self.first_clear))
    }
}

/// Light that the eye gets from a stone.
#[derive(Default)]
struct Sum {
    all: f32,
    of_clear: f32,
}

/// A convex stone.
struct Stone {
    centre: Vec3,
    /// About the centre.
    planes: Vec<Vec4>,
    index: f32,
}

impl Stone {
    fn of(mesh: &Mesh, index: f32) -> Option<Self> {
        let centre = Bounds::of(mesh.positions.iter().copied()).centre();
        Some(Self { centre, planes: Convex::about(centre, mesh)?.planes, index })
    }

    /// Adds what a ray from the eye sees of the stone, unless another body hides it; returns whether it sees it.
    fn look(&self, all: &All, camera: &Camera, direction: DVec3, sum: &mut Sum) -> bool {
        let direction = direction.as_vec3();
        let Some((distance, mut face)) = self.entry(camera.eye - self.centre, direction) else { return false };
        if all.met(camera.eye, direction).is_some_and(|(hit, _)| hit < (1.0 - NEARER) * distance) {
            return false;
        }
        let mut position = camera.eye - self.centre + distance * direction;
        let normal = self.planes[face as usize].truncate();
        let reflectance = lapidary_fresnel::dielectric(-normal.dot(direction), self.index);
        let mut leaves = |light: f32, position: Vec3, direction: Vec3| {
            sum.all += light;
            if all.met(position + self.centre, direction).is_some_and(|(_, clear)| clear) {
                sum.of_clear += light;
            }
        };
        leaves(reflectance, position, lapidary_refraction::reflect(direction, normal));
        let mut inside = lapidary_refraction::refract(direction, normal, self.index).direction;
        let mut light = 1.0 - reflectance;
        for _ in 0..HITS {
            let hit = convex_trace::trace(&self.planes, position, inside, face);
            let Some(plane) = self.planes.get(hit.face as usize) else { break };
            face = hit.face;
            position = convex_trace::point(position, inside, hit.distance, *plane);
            let normal = plane.truncate();
            let reflectance = lapidary_fresnel::dielectric(normal.dot(inside), 1.0 / self.index);
            let leaving = lapidary_refraction::refract(inside, -normal, 1.0 / self.index);
            if !leaving.total {
                leaves(light * (1.0 - reflectance), position, leaving.direction);
            }
            light *= reflectance;
            inside = lapidary_refraction::reflect(inside, normal);
        }
        true
    }

    /// Returns where a ray from outside enters, and through which plane.
    fn entry(&self, eye: Vec3, direction: Vec3) -> Option<(f32, u32)> {
        let (mut entry, mut exit, mut face) = (0.0, f32::INFINITY, None);
        for (number, plane) in (0..).zip(&self.planes) {
            let height = plane.truncate().dot(eye) - plane.w;
            let slope = plane.truncate().dot(direction);
            let distance = -height / slope;
            if slope < 0.0 && distance > entry {
                (entry, face) = (distance, Some(number));
            } else if slope > 0.0 {
                exit = exit.min(distance);
            } else if slope == 0.0 && height > 0.0 {
                return None;
            }
        }
        face.filter(|_| entry < exit).map(|face| (entry, face))
    }
}

#[cfg(test)]
mod tests;
