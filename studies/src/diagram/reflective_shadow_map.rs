//! What a lamp sees of a scene, texel by texel, and a point in shadow.

use super::plane::{Section, at};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, SECOND, Scene, WARM};
use super::sheet::Diagram;
use glam::{DVec2, Vec3};
use lapidary_reflective_shadow_map::{ReflectiveShadowMapView, clip, cosine, height, texel};

pub const DIAGRAM: Diagram = Diagram {
    name: "reflective_shadow_map",
    module: "reflective_shadow_map",
    title: "A map from the light, and the seeds it gives",
    caption: "Each texel of a lamp's map holds the place x that the light meets first and its N·L, here as a stroke \
              along the normal: the seeds from which light sets out through the body. The point p sees another place \
              at its texel. That place lies above the plane that touches the surface at p, so p is in shadow.",
    draw,
};

/// Texels across the map.
pub const SIZE: u32 = 18;

/// A circle of the section: its middle and its radius.
pub type Body = (DVec2, f64);
/// A large body and a small one before it.
pub const BODIES: [Body; 2] = [(at(0.85, -1.3), 1.72), (at(-0.32, 0.98), 0.38)];
/// The lamp.
pub const LAMP: DVec2 = at(-2.35, 1.95);

/// A point of the section in space: the section is the plane y = 0.
pub fn space(point: DVec2) -> Vec3 {
    at(point.x, 0.0).extend(point.y).as_vec3()
}

/// Returns the lamp's view of the scene.
pub fn view() -> ReflectiveShadowMapView {
    let axis = space(at(0.1, -0.05) - LAMP).normalize();
    ReflectiveShadowMapView { origin: space(LAMP), lamp: 1, axis, extent: 0.56, near: 0.5, far: 6.0 }
}

/// Where the light meets the scene at a texel.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// The place.
    pub place: DVec2,
    /// The unit normal there.
    pub normal: DVec2,
    /// N·L.
    pub cosine: f32,
}

/// Returns a point's texel across the map, and its depth.
pub fn across(point: DVec2) -> (f32, f32) {
    let clip = clip(view(), space(point));
    (texel(clip, SIZE as f32).x, clip.w)
}

/// Returns what the map holds: the nearest point of an outline that the module puts into the middle of each texel.
pub fn map() -> Vec<Option<Seen>> {
    let mut map: Vec<Option<(f32, Seen)>> = vec![None; SIZE as usize];
    for (middle, radius) in BODIES {
        let count = 4000;
        let point =
            |k: i32| middle + radius * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / f64::from(count));
        for k in 0..count {
            let ((from, _), (to, depth)) = (across(point(k)), across(point(k + 1)));
            let (low, high) = (from.min(to), from.max(to));
            let index = (low - 0.5).ceil();
            if index < 0.0 || index >= SIZE as f32 || index + 0.5 >= high {
                continue;
            }
            let held = &mut map[index as usize];
            if held.is_none_or(|(nearest, _)| depth < nearest) {
                let share = f64::from((index + 0.5 - from) / (to - from));
                *held = Some((depth, seen(point(k).lerp(point(k + 1), share), middle)));
            }
        }
    }
    map.into_iter().map(|held| held.map(|(_, seen)| seen)).collect()
}

fn seen(place: DVec2, middle: DVec2) -> Seen {
    let normal = (place - middle).normalize();
    Seen { place, normal, cosine: cosine(space(normal), space(LAMP - place).normalize()) }
}

/// Returns a point in the shadow, its normal, and what the light sees at its texel.
pub fn shadowed() -> (DVec2, DVec2, Option<Seen>) {
    let (middle, radius) = BODIES[0];
    // The middle of the small body's shadow: straight on from the lamp through it.
    let way = (BODIES[1].0 - LAMP).normalize();
    let along = (middle - LAMP).dot(way);
    let off = (middle - LAMP).perp_dot(way);
    let point = LAMP + (along - (radius * radius - off * off).sqrt()) * way;
    let normal = (point - middle).normalize();
    let (place, _) = across(point);
    (point, normal, map()[place as usize])
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 430);
    let sheet = Section::new(330.0, 262.0, 112.0);
    bodies(&mut scene, &sheet);
    let map = map();
    for seen in map.iter().flatten() {
        scene.line(&sheet.all(&[LAMP, seen.place]), ACCENT.thin());
    }
    texels(&mut scene, &sheet);
    for seen in map.iter().flatten() {
        let tip = seen.place + 0.42 * f64::from(seen.cosine) * seen.normal;
        scene.line(&sheet.all(&[seen.place, tip]), SECOND.wide());
        scene.dot(sheet.at(seen.place), 4.5, Paint::Second).named("seed");
    }
    scene.dot(sheet.at(LAMP), 8.0, Paint::Accent);
    scene.note(sheet.at(LAMP) + at(18.0, -6.0), Anchor::Start, Paint::Accent, "lamp");
    shadow(&mut scene, &sheet);
    scene.dot(at(516.0, 34.0), 4.5, Paint::Second).line(&[at(516.0, 34.0), at(516.0, 14.0)], SECOND.wide());
    scene.note(at(534.0, 28.0), Anchor::Start, Paint::Ink, "seed, with $'N'·'L$");
    scene
}

fn bodies(scene: &mut Scene, sheet: &Section) {
    for (middle, radius) in BODIES {
        let point = |k: i32| middle + radius * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 180.0);
        let outline: Vec<DVec2> = (0..180).map(point).collect();
        scene.area(&sheet.all(&outline), Paint::Ink, 0.08);
        scene.outline(&sheet.all(&outline), INK);
    }
}

/// The map's texels, on a line across the light.
fn texels(scene: &mut Scene, sheet: &Section) {
    let view = view();
    let axis = at(f64::from(view.axis.x), f64::from(view.axis.z));
    // To the right on the map, as the module has it.
    let right = lapidary_reflective_shadow_map::basis(-view.axis).right;
    let right = at(f64::from(right.x), f64::from(right.z));
    let edge = |k: u32| {
        let place = 2.0 * f64::from(k) / f64::from(SIZE) - 1.0;
        LAMP + 0.9 * (axis + f64::from(view.extent) * place * right)
    };
    scene.line(&sheet.all(&[edge(0), edge(SIZE)]), ACCENT.wide());
    for k in 0..=SIZE {
        scene.line(&sheet.all(&[edge(k), edge(k) - 0.07 * axis]), ACCENT);
    }
    let end = if right.x > 0.0 { edge(SIZE) } else { edge(0) };
    scene.note(sheet.at(end) + at(12.0, -8.0), Anchor::Start, Paint::Accent, "map");
}

/// The point in shadow, and how high what the light sees lies over its plane.
fn shadow(scene: &mut Scene, sheet: &Section) {
    let (point, normal, seen) = shadowed();
    let Some(seen) = seen else { return };
    let along = normal.perp();
    scene.line(&sheet.all(&[point - 1.5 * along, point + 1.56 * along]), DIM.thin().dashed());
    let above = f64::from(height(space(seen.place), space(point), space(normal)));
    let foot = seen.place - above * normal;
    scene.line(&sheet.all(&[foot, seen.place]), WARM).named("height");
    scene.line(&sheet.all(&[seen.place, point]), WARM.thin().dashed());
    scene.dot(sheet.at(point), 6.0, Paint::Warm).named("shadowed");
    scene.symbol(sheet.at(point) + at(6.0, 24.0), Anchor::Middle, Paint::Warm, "'p");
    scene.symbol(sheet.at(seen.place) + at(30.0, -10.0), Anchor::Middle, Paint::Second, "'x");
    let formula = "$('x − 'p)·'n_p$ > $b$: shadow";
    scene.note(sheet.at(BODIES[0].0) + at(0.0, -86.0), Anchor::Middle, Paint::Warm, formula);
}
