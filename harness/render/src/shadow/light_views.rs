//! Views of reflective shadow maps: one for a sun, for a spot and for a lamp at a distance, six for
//! a lamp among the objects that it lights.

use glam::Vec3;
use lapidary_reflective_shadow_map::ReflectiveShadowMapView;
use lapidary_scene::{Bounds, Light};

/// One view of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightView {
    pub(crate) view: ReflectiveShadowMapView,
    /// Index of the light.
    pub(crate) light: u32,
}

/// Tangent of half the widest angle that one view of a lamp covers; a lamp that sees the scene's
/// sphere under a wider angle has six views.
const WIDEST: f32 = 1.5;
/// Smallest ratio of a lamp's near distance to its far distance.
const NEAREST: f32 = 1e-3;
/// Margin around the contents of a view, so that rounding puts nothing beyond its edge.
const MARGIN: f32 = 1.0 + 1e-4;

/// Returns the views of all lights, light by light, for a scene within `bounds`, in front of which bodies
/// within `before` stand, if any.
pub(crate) fn views(lights: &[Light], bounds: Bounds, before: Option<Bounds>) -> Vec<LightView> {
    (0..)
        .zip(lights)
        .flat_map(|(number, light)| {
            views_of(light, bounds, before).into_iter().map(move |view| LightView { view, light: number })
        })
        .collect()
}

fn views_of(light: &Light, bounds: Bounds, before: Option<Bounds>) -> Vec<ReflectiveShadowMapView> {
    let (centre, radius) = (bounds.centre(), bounds.radius().max(f32::MIN_POSITIVE) * MARGIN);
    match *light {
        Light::Directional { toward, .. } => {
            let reach = |before: Bounds| toward.dot(before.centre() - centre) + before.radius() * MARGIN;
            let near = -before.map_or(radius, |before| reach(before).max(radius));
            vec![ReflectiveShadowMapView { origin: centre, lamp: 0, axis: -toward, extent: radius, near, far: radius }]
        }
        Light::Point { position, .. } => lamp(position, (centre, radius), before.is_some(), None),
        Light::Spot { position, direction, outer_angle, .. } => {
            lamp(position, (centre, radius), before.is_some(), Some((direction, outer_angle.tan())))
        }
    }
}

/// Returns the views of a lamp that sees a sphere, in front of which other bodies may stand; `cone` is
/// `None` if its light is not bounded by a cone.
fn lamp(
    position: Vec3,
    (centre, radius): (Vec3, f32),
    before: bool,
    cone: Option<(Vec3, f32)>,
) -> Vec<ReflectiveShadowMapView> {
    let way = centre - position;
    let distance = way.length();
    let far = (distance + radius) * MARGIN;
    let near = if before { NEAREST * far } else { (distance - radius).max(NEAREST * far) };
    let view = |axis, extent, near| ReflectiveShadowMapView { origin: position, lamp: 1, axis, extent, near, far };
    // The cone that touches the scene's sphere.
    let about =
        (distance > radius).then(|| (way / distance, radius / ((distance - radius) * (distance + radius)).sqrt()));
    let narrowest = [about, cone].into_iter().flatten().filter(|(_, tangent)| (0.0..=WIDEST).contains(tangent));
    match narrowest.min_by(|a, b| a.1.total_cmp(&b.1)) {
        // Depth along a spot's axis may be less than the distance to the scene's sphere.
        Some((axis, tangent)) => {
            let near = if about.is_some_and(|about| about.0 == axis) { near } else { NEAREST * far };
            vec![view(axis, (tangent * MARGIN).max(NEAREST), near)]
        }
        None => {
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            axes.into_iter().flat_map(|axis| [axis, -axis]).map(|axis| view(axis, 1.0, NEAREST * far)).collect()
        }
    }
}

/// Returns the largest irradiance from any single light on a surface within `bounds` that faces it,
/// linear RGB. Distances to a lamp below a hundredth of the bounds' radius count as that far.
pub(crate) fn largest_irradiance(lights: &[Light], bounds: Bounds) -> Vec3 {
    let least = 0.01 * bounds.radius();
    let brightest = |light: &Light| match *light {
        Light::Directional { irradiance, .. } => irradiance,
        Light::Point { position, intensity } | Light::Spot { position, intensity, .. } => {
            let distance = position.distance(position.clamp(bounds.min, bounds.max)).max(least);
            intensity / (distance * distance)
        }
    };
    lights.iter().map(brightest).fold(Vec3::ZERO, Vec3::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_reflective_shadow_map::clip;

    const BOUNDS: Bounds = Bounds { min: Vec3::new(99.0, -1.0, -2.0), max: Vec3::new(101.0, 1.0, 2.0) };

    fn corners() -> impl Iterator<Item = Vec3> {
        let Bounds { min, max } = BOUNDS;
        (0..8).map(move |corner| {
            Vec3::select(glam::BVec3::new(corner & 1 == 0, corner & 2 == 0, corner & 4 == 0), min, max)
        })
    }

    /// Returns how many of a light's views contain a point.
    fn holding(light: Light, point: Vec3) -> usize {
        let seen = |from: &LightView| {
            let clip = clip(from.view, point);
            clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z)
        };
        views(&[light], BOUNDS, None).iter().filter(|view| seen(view)).count()
    }

    fn lamp_at(position: Vec3) -> Light {
        Light::Point { position, intensity: Vec3::ONE }
    }

    #[test]
    fn every_light_sees_all_of_the_scene() {
        let sun = Light::Directional { toward: Vec3::new(0.6, 0.8, 0.0), irradiance: Vec3::ONE };
        let lamps = [Vec3::new(110.0, 0.0, 0.0), Vec3::new(100.0, 2.6, 0.0), Vec3::new(100.1, 0.2, 0.3), Vec3::ZERO];
        for light in [sun].into_iter().chain(lamps.map(lamp_at)) {
            for corner in corners() {
                assert_eq!(holding(light, corner), 1, "{light:?} {corner}");
            }
        }
    }

    /// A triangle that is counter-clockwise as seen by its light is so in clip space too.
    #[test]
    fn what_faces_the_light_is_a_front() {
        let toward = Vec3::new(0.48, 0.6, 0.64);
        let centre = BOUNDS.centre();
        for light in [Light::Directional { toward, irradiance: Vec3::ONE }, lamp_at(centre + 10.0 * toward)] {
            let right = Vec3::Y.cross(toward).normalize();
            let corners = [Vec3::ZERO, right, toward.cross(right)].map(|corner| {
                let clip = clip(views(&[light], BOUNDS, None)[0].view, centre + corner);
                clip.truncate().truncate() / clip.w
            });
            assert!((corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) > 0.0, "{corners:?}");
        }
    }

    /// What stands between the scene and the light is beyond no view's nearest depth.
    #[test]
    fn every_light_sees_what_stands_before_the_scene() {
        let toward = Vec3::new(0.6, 0.8, 0.0);
        let sun = Light::Directional { toward, irradiance: Vec3::ONE };
        let place = BOUNDS.centre() + 30.0 * toward;
        let before = Bounds { min: place - 1.0, max: place + 1.0 };
        for light in [sun, lamp_at(BOUNDS.centre() + 50.0 * toward)] {
            for corner in corners() {
                let shifted = corner - BOUNDS.centre() + place;
                let seen = |before| {
                    let view = views(&[light], BOUNDS, before)[0].view;
                    let clip = clip(view, shifted.clamp(place - 0.7, place + 0.7));
                    (0.0..=clip.w).contains(&clip.z)
                };
                assert!(seen(Some(before)) && !seen(None), "{light:?} {corner}");
            }
        }
    }

    #[test]
    fn only_a_lamp_that_is_near_has_six_views() {
        let count = |position| views(&[lamp_at(position)], BOUNDS, None).len();
        assert_eq!(
            [Vec3::new(100.0, 0.0, 0.0), Vec3::new(103.0, 0.0, 0.0), Vec3::new(103.2, 0.0, 0.0)].map(count),
            [6, 1, 1]
        );
        assert_eq!(count(Vec3::new(102.0, 0.0, 0.0)), 6);
    }

    #[test]
    fn a_spot_sees_its_cone_or_the_scene_whichever_is_less() {
        let spot = |outer_angle| Light::Spot {
            position: Vec3::new(120.0, 0.0, 0.0),
            direction: Vec3::NEG_X,
            intensity: Vec3::ONE,
            inner_angle: 0.0,
            outer_angle,
        };
        let extent = |light| views(&[light], BOUNDS, None)[0].view.extent;
        assert!((extent(spot(0.05)) / 0.05f32.tan() - 1.0).abs() < 1e-3);
        assert!(extent(spot(1.5)) < 0.13);
        // Points within its cone.
        assert_eq!(holding(spot(0.05), Vec3::new(100.0, 0.9, 0.0)), 1);
        assert_eq!(holding(spot(0.05), Vec3::new(100.0, 0.0, 1.5)), 0);
    }

    #[test]
    fn the_largest_irradiance_is_that_of_the_nearest_corner() {
        let lights = [
            Light::Directional { toward: Vec3::Y, irradiance: Vec3::new(1.0, 0.2, 0.2) },
            Light::Point { position: Vec3::new(103.0, 0.0, 0.0), intensity: Vec3::new(0.4, 4.0, 0.0) },
        ];
        assert!(largest_irradiance(&lights, BOUNDS).distance(Vec3::new(1.0, 1.0, 0.2)) < 1e-6);
        assert!(largest_irradiance(&[lamp_at(BOUNDS.centre())], BOUNDS).is_finite());
        assert_eq!(largest_irradiance(&[], BOUNDS), Vec3::ZERO);
    }
}
