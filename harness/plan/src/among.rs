//! Which bodies share space, and which are seen through one another.

use crate::Effect;
use crate::casting::bounds;
use crate::remembered::Remembered;
use crate::setting;
use glam::{Mat4, Vec2, Vec3};
use lapidary_scene::{Bounds, Mesh, Object, Scene, TextureSlot, clip_from_world};
use std::collections::BTreeMap;

/// Number of vertices of a body of which it is asked whether they lie in the other.
const VERTICES: usize = 32;
/// Products of these vertices and the other's triangles for one pair: fewer vertices are asked for if there are more.
const MOST_PRODUCTS: usize = 1 << 22;
/// How far below its surface a body's vertex is looked at, as a share of the body's radius: a body that only touches another
/// one shares no space with it.
const BELOW: f32 = 1e-4;
/// Number of bodies above which none is compared with the others: all pairs of more would take longer than drawing them.
pub(crate) const MOST_COMPARED: usize = 256;

/// Steps of a unit vector's parts within which two faces count as parallel.
const PARALLEL: f32 = 64.0;
/// Share of a body's area that each of two parallel faces has at least.
const LEAST_FACE: f32 = 0.12;

/// How much of a body lies within another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Share {
    Nothing,
    Part,
    All,
}

/// Returns how many of a body's vertices lie within another one.
pub(crate) fn share_within(body: &Object, around: &Object) -> Share {
    static FOUND: Remembered<Share> = Remembered::new();
    FOUND.of_both(&body.mesh, &around.mesh, |mesh, around| {
        let asked = VERTICES.min(MOST_PRODUCTS / around.triangle_count().max(1)).max(1);
        let step = mesh.positions.len().div_ceil(asked).max(1);
        let below = BELOW * Bounds::of(mesh.positions.iter().copied()).radius();
        let vertices =
            mesh.positions.iter().zip(mesh.normals.iter().chain(std::iter::repeat(&Vec3::ZERO))).step_by(step);
        let (mut within, mut count) = (0, 0);
        for (position, normal) in vertices {
            count += 1;
            within += usize::from(around.encloses(*position - below * *normal));
        }
        match within {
            0 => Share::Nothing,
            _ if within == count => Share::All,
            _ => Share::Part,
        }
    })
}

/// Whether two boxes have a point in common.
pub(crate) fn meet(one: Bounds, other: Bounds) -> bool {
    one.min.cmple(other.max).all() && other.min.cmple(one.max).all()
}

/// Returns the bodies of a scene that is not too large.
fn compared(scene: &Scene) -> impl Iterator<Item = &Object> {
    let compared = if scene.objects.len() > MOST_COMPARED { &[] } else { &scene.objects[..] };
    compared.iter().filter(|object| object.mesh.triangle_count() > 0)
}

/// Returns the other bodies of a scene that is not too large, with their boxes.
fn others<'a>(object: &'a Object, scene: &'a Scene) -> impl Iterator<Item = (&'a Object, Bounds)> {
    compared(scene).filter(|other| !std::ptr::eq(*other, object)).map(|other| (other, bounds(other)))
}

/// Returns the first body that shares space with a clear one, which has an inside.
pub(crate) fn shares_space<'a>(object: &'a Object, scene: &'a Scene) -> Option<&'a Object> {
    met(object, scene).find(|other| share(object, other))
}

/// Returns the first such body that does more than hold a cut stone. Opaque ones do not where rays inside meet them: `meets`.
pub(crate) fn reaches_into<'a>(object: &'a Object, scene: &'a Scene, meets: bool) -> Option<&'a Object> {
    // Vertices in a body of many triangles take much longer than planes of a stone.
    met(object, scene).find(|other| !setting::holds(other, object, meets) && share(object, other))
}

/// Returns the first body that is not clear and lies within a convex stone in part.
pub(crate) fn reached_by_opaque<'a>(object: &'a Object, scene: &'a Scene) -> Option<&'a Object> {
    met(object, scene).find(|other| setting::enters(other, object))
}

/// Returns the other bodies whose boxes meet that of a body.
fn met<'a>(object: &'a Object, scene: &'a Scene) -> impl Iterator<Item = &'a Object> {
    let own = bounds(object);
    others(object, scene).filter(move |(_, bounds)| meet(*bounds, own)).map(|(other, _)| other)
}

/// Whether a clear body and another one share space.
fn share(object: &Object, other: &Object) -> bool {
    share_within(other, object) != Share::Nothing
        || !other.material.is_thin_wall() && share_within(object, other) != Share::Nothing
}

/// Returns the first clear body of a scene that may share space with others, and what with: its own copies, a clear body
/// whose box meets its own, or another body that does share space with it.
pub(crate) fn any_share(scene: &Scene) -> Option<(&Object, &str)> {
    let boxed: Vec<(&Object, Bounds)> = compared(scene).map(|object| (object, bounds(object))).collect();
    boxed.iter().filter(|(object, _)| object.material.is_clear()).find_map(|(object, own)| {
        if object.copies.as_ref().is_some_and(|copies| copies.places.len() > 1) {
            return Some((*object, "its copies"));
        }
        let shares = |other: &Object| other.material.is_clear() || share(object, other);
        let others = boxed.iter().filter(|(other, bounds)| !std::ptr::eq(*other, *object) && meet(*bounds, *own));
        let found = others.map(|(other, _)| *other).find(|other| shares(other));
        found.map(|other| (*object, other.name.as_str()))
    })
}

/// Returns the first clear body that overlaps another clear one in a picture of this size: their boxes do.
pub(crate) fn overlaps<'a>(object: &'a Object, scene: &'a Scene, size: [u32; 2]) -> Option<&'a Object> {
    overlapping(object, scene, size, true)
}

/// Whether any two copies of a clear body overlap in a picture of this size: their boxes do.
pub(crate) fn copies_overlap(object: &Object, scene: &Scene, size: [u32; 2]) -> bool {
    let count = object.copies.as_ref().map_or(1, |copies| copies.places.len());
    let each = object.mesh.positions.len() / count.max(1);
    if count < 2 || each == 0 {
        return false;
    }
    let matrix = clip_from_world(scene, size[0], size[1]);
    let copies = object.mesh.positions.chunks_exact(each);
    let mut places: Vec<(Vec2, Vec2)> =
        copies.filter_map(|copy| seen(Bounds::of(copy.iter().copied()), matrix)).collect();
    places.sort_by(|one, other| one.0.x.total_cmp(&other.0.x));
    let beside = |number: usize| {
        let (least, most) = places[number];
        let mut next = places[number + 1..].iter().take_while(|other| other.0.x < most.x);
        next.any(|other| other.0.y < most.y && least.y < other.1.y)
    };
    (0..places.len()).any(beside)
}

/// Returns the first body that is seen undistorted through a clear one, between two parallel faces or through a thin wall: one
/// that is not clear, and overlaps it in a picture of this size.
fn seen_straight<'a>(object: &'a Object, scene: &'a Scene, size: [u32; 2]) -> Option<&'a Object> {
    static FOUND: Remembered<bool> = Remembered::new();
    let other = overlapping(object, scene, size, false)?;
    (object.material.is_thin_wall() || FOUND.of(object.shape(), has_parallel_faces)).then_some(other)
}

/// Whether two opposite directions each face a share of a mesh's area.
fn has_parallel_faces(mesh: &Mesh) -> bool {
    let mut areas: BTreeMap<[i32; 3], f32> = BTreeMap::new();
    for [a, b, c] in mesh.triangles() {
        let across = (b - a).cross(c - a);
        let direction = (PARALLEL * across.normalize_or_zero()).round().as_ivec3();
        *areas.entry(direction.to_array()).or_default() += across.length();
    }
    let least = LEAST_FACE * areas.values().sum::<f32>();
    let is_wide = |direction: &[i32; 3]| areas.get(direction).is_some_and(|area| *area >= least);
    areas.keys().any(|direction| is_wide(direction) && is_wide(&direction.map(|part| -part)))
}

/// Returns the first body, clear or not, that overlaps another one in the view.
fn overlapping<'a>(object: &'a Object, scene: &'a Scene, size: [u32; 2], clear: bool) -> Option<&'a Object> {
    // The matrix asks for the bounds of the whole scene.
    others(object, scene).next()?;
    let matrix = clip_from_world(scene, size[0], size[1]);
    let own = seen(bounds(object), matrix)?;
    let overlaps = |bounds: Bounds| {
        seen(bounds, matrix).is_some_and(|other| own.0.cmplt(other.1).all() && other.0.cmplt(own.1).all())
    };
    let found = others(object, scene).find(|(other, bounds)| other.material.is_clear() == clear && overlaps(*bounds));
    found.map(|(other, _)| other)
}

/// Returns why bodies that are not clear are seen in or through a clear one by their triangles; `None` if their bounds will do.
pub(crate) fn beside(object: &Object, scene: &Scene, size: [u32; 2]) -> Option<String> {
    if let Some(other) = seen_straight(object, scene, size) {
        let way = if object.material.is_thin_wall() { "it" } else { "its parallel faces" };
        return Some(format!("{} is seen straight through {way}", other.name));
    }
    stands_in(object, scene).map(|around| format!("it stands within the bounds of {}", around.name))
}

/// Storage buffers of one stage that every device offers.
const MOST_BUFFERS: u32 = 8;

/// Whether the stage of a convex stone can read the two buffers of the effect `around`, beside its material, planes, map and place,
/// and one of copies, one of single wavelengths and two of lights.
pub(crate) fn fits_around(copies: bool, wavelengths: bool, lights: bool) -> bool {
    6 + u32::from(copies) + u32::from(wavelengths) + 2 * u32::from(lights) <= MOST_BUFFERS
}

/// Whether a body that is not clear covers only a share of what is behind it.
pub(crate) fn is_sheer(object: &Object) -> bool {
    !object.material.is_clear() && !object.material.covers_all()
}

/// The images that light through clear bodies meets, each with its effect.
pub const IMAGES_MET: [(Effect, TextureSlot); 3] = [
    (Effect::BaseColorTexture, TextureSlot::BaseColor),
    (Effect::NormalTexture, TextureSlot::Normal),
    (Effect::TransmissionTexture, TextureSlot::Transmission),
];

/// Whether a body's surface varies by the image in a slot.
pub(crate) fn shows(object: &Object, slot: TextureSlot) -> bool {
    object.material.effective(slot).is_some() && !object.mesh.uvs.is_empty()
}

/// Whether a share of the light does not enter a clear body, somewhere.
pub(crate) fn is_partly_clear(object: &Object) -> bool {
    let material = &object.material;
    material.is_clear() && (material.clear_share() < 1.0 || shows(object, TextureSlot::Transmission))
}

/// Returns the first body that is not clear and whose box reaches around a clear one's middle.
fn stands_in<'a>(object: &'a Object, scene: &'a Scene) -> Option<&'a Object> {
    let middle = bounds(object).centre();
    let reaches = |bounds: &Bounds| bounds.min.cmple(middle).all() && bounds.max.cmpge(middle).all();
    let found = others(object, scene).find(|(other, bounds)| !other.material.is_clear() && reaches(bounds));
    found.map(|(other, _)| other)
}

/// Returns the smallest rectangle of the picture around a box, from -1 to 1; `None` if nothing of it is in the picture.
pub(crate) fn seen(bounds: Bounds, matrix: Mat4) -> Option<(Vec2, Vec2)> {
    let (mut least, mut most) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for corner in 0..8 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        let clip = matrix * Vec3::new(pick(0), pick(1), pick(2)).extend(1.0);
        if clip.w <= 0.0 {
            return Some((Vec2::NEG_ONE, Vec2::ONE));
        }
        let place = clip.truncate().truncate() / clip.w;
        (least, most) = (least.min(place), most.max(place));
    }
    let (least, most) = (least.max(Vec2::NEG_ONE), most.min(Vec2::ONE));
    least.cmplt(most).all().then_some((least, most))
}
