//! `wgsl/reflective_shadow_map.wgsl`.

mod outside;

use crate::{self as mirror, ReflectiveShadowMapBasis, ReflectiveShadowMapView, oracle};
use glam::{Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, ReflectiveShadowMapView { origin, lamp, axis, extent, near, far });
mirror_struct!(crate, ReflectiveShadowMapBasis { right, up });

const M: &str = "reflective_shadow_map";

/// Error of a length or a cosine from the rounding of a basis formula and of the axis itself, with
/// room for the portable bounds.
const SQUARE: f64 = 32.0 / (1 << 24) as f64;

/// Draws an axis: anywhere, along a coordinate axis, or at a distance of any magnitude from the
/// equator or a pole.
fn axis(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(4) {
        0 => {
            let level = draws.perpendicular(glam::DVec3::Z);
            (level + f64::from(draws.signed(-40, -1)) * glam::DVec3::Z).normalize().as_vec3()
        }
        1 => {
            let pole = if draws.below(2) == 0 { Vec3::Z } else { Vec3::NEG_Z };
            (pole.as_dvec3() + f64::from(draws.magnitude(-40, -1)) * draws.direction()).normalize().as_vec3()
        }
        _ => draws.unit_vector(),
    }
}

/// Draws a position near the origin or far from it.
fn place(draws: &mut Draws<'_>) -> Vec3 {
    let size = if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-10, 19) };
    size * draws.in_cube()
}

/// Draws a normal: unit, shortened by interpolation, of any length, or 0.
fn normal(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(8) {
        0 => draws.magnitude(-39, 39) * draws.unit_vector(),
        1 if draws.below(4) == 0 => Vec3::ZERO,
        2 => draws.between(0.1, 1.0) * draws.unit_vector(),
        _ => draws.unit_vector(),
    }
}

/// Draws a light's view and a point: within the map, anywhere, or at the view's origin.
fn seen(draws: &mut Draws<'_>) -> (ReflectiveShadowMapView, Vec3) {
    let origin = place(draws);
    let lamp = draws.below(2);
    let axis = axis(draws);
    let extent = if lamp == 1 { draws.between(0.05, 1.5) } else { draws.magnitude(-13, 13) };
    let reach = if lamp == 1 { draws.magnitude(-10, 13) } else { extent };
    let (near, far) = match (lamp, draws.below(3)) {
        (0, _) => (-reach, reach),
        (_, 0) => (0.999 * reach, reach),
        (_, 1) => (1e-3 * reach, reach),
        _ => (draws.between(0.01, 0.9) * reach, reach),
    };
    let position = match draws.below(8) {
        0 => origin,
        1 => place(draws),
        _ => origin + 1.5 * reach * draws.in_cube(),
    };
    (ReflectiveShadowMapView { origin, lamp, axis, extent, near, far }, position)
}

/// Draws a seen point at any distance from a point, and the normal at the point: in the tangent
/// plane, in any direction, straight above, or the point itself.
fn above(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3) {
    let (position, normal) = (place(draws), normal(draws));
    let distance = draws.magnitude(-16, 8);
    let beside = match draws.below(4) {
        0 if normal != Vec3::ZERO => draws.perpendicular(normal.as_dvec3().normalize()).as_vec3(),
        1 => draws.unit_vector(),
        2 if draws.below(4) == 0 => Vec3::ZERO,
        _ => normal.normalize_or_zero(),
    };
    (position + distance * beside, position, normal)
}

fn square(basis: &ReflectiveShadowMapBasis, axis: Vec3) -> Result<(), String> {
    let [right, up, axis] = [basis.right, basis.up, axis].map(|vector| vector.as_dvec3());
    near("|right|", right.length(), 1.0, SQUARE)?;
    near("|up|", up.length(), 1.0, SQUARE)?;
    near("right . up", right.dot(up), 0.0, SQUARE)?;
    near("right x up . axis", right.cross(up).dot(axis), 1.0, SQUARE)
}

/// Returns every function of the module, bound to its mirror and its oracle, with its promises
/// outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    vec![basis(), basis_naive(), clip(), texel(), cosine(), height(), height_naive()]
}

fn basis() -> Formula {
    const NAIVE: &str = "reflective_shadow_map_basis_naive";
    formula(M, "reflective_shadow_map_basis", mirror::basis, oracle::basis, |draws| (axis(draws),))
        .edge("along +y", |(axis,)| axis == Vec3::Y)
        .edge("along +z", |(axis,)| axis == Vec3::Z)
        .edge("along -z", |(axis,)| axis == Vec3::NEG_Z)
        .edge("on the equator", |(axis,)| axis.z == 0.0)
        .edge("just above the equator", |(axis,)| axis.z > 0.0 && axis.z < 1e-6)
        .edge("just below the equator", |(axis,)| axis.z < 0.0 && axis.z > -1e-6)
        .edge("next to -z", |(axis,)| axis.z == -1.0 && (axis.x != 0.0 || axis.y != 0.0))
        .invariant("unit, square, right-handed", |(axis,), basis| square(&basis, axis))
        .invariant("on the equator as above it", |(axis,), basis: ReflectiveShadowMapBasis| {
            if axis.z != 0.0 || basis.right.z == -axis.x { Ok(()) } else { Err(format!("{}", basis.right)) }
        })
        .hard_case("straight up", (Vec3::Y,), (&[1.0, 0.0, 0.0, 0.0, 0.0, -1.0], 0.0), (NAIVE, f64::INFINITY))
        .hard_case("straight down", (Vec3::NEG_Y,), (&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0], 0.0), (NAIVE, f64::INFINITY))
        .build()
}

fn basis_naive() -> Formula {
    formula(M, "reflective_shadow_map_basis_naive", mirror::basis_naive, oracle::basis_naive, |draws| {
        let level = draws.perpendicular(glam::DVec3::Y);
        ((level + f64::from(draws.between(-1.0, 1.0)) * glam::DVec3::Y).normalize().as_vec3(),)
    })
    .benign(2e-6)
    .build()
}

fn clip() -> Formula {
    formula(M, "reflective_shadow_map_clip", mirror::clip, oracle::clip, seen)
        .edge("a sun", |(view, _)| view.lamp == 0)
        .edge("a lamp", |(view, _)| view.lamp == 1)
        .edge("behind a lamp", |(view, position)| {
            view.lamp == 1 && (position - view.origin).dot(view.axis) < -0.1 * view.far
        })
        .edge("at the origin", |(view, position)| position == view.origin)
        .edge("far from the world's origin", |(view, _)| view.origin.length() > 1e4)
        .edge("a thin slice", |(view, _)| view.far - view.near < 0.002 * view.far)
        .edge("light from straight above", |(view, _)| view.axis == Vec3::NEG_Y)
        .invariant("w is 1 for a sun", |(view, _), clip: Vec4| {
            if view.lamp == 1 || clip.w == 1.0 { Ok(()) } else { Err(format!("w {}", clip.w)) }
        })
        .build()
}

fn texel() -> Formula {
    formula(M, "reflective_shadow_map_texel", mirror::texel, oracle::texel, |draws| {
        let w = match draws.below(4) {
            0 => 1.0,
            1 if draws.below(2) == 0 => draws.pick(&[0.0, -1.0]),
            _ => draws.magnitude(-13, 13),
        };
        let across = |draws: &mut Draws<'_>| match draws.below(4) {
            0 => w * draws.pick(&[1.0, -1.0, 0.0]),
            _ => 1.5 * w * draws.between(-1.0, 1.0),
        };
        let clip = Vec4::new(across(draws), across(draws), draws.between(0.0, 1.0), w);
        (clip, draws.pick(&[1.0, 256.0, 1000.0, 16384.0]))
    })
    .edge("upper left corner", |(clip, _)| clip.w > 0.0 && clip.x == -clip.w && clip.y == clip.w)
    .edge("lower right corner", |(clip, _)| clip.w > 0.0 && clip.x == clip.w && clip.y == -clip.w)
    .edge("beside the map", |(clip, _)| clip.w > 0.0 && clip.x > clip.w)
    .edge("behind a lamp", |(clip, _)| clip.w < 0.0)
    .edge("in a lamp's plane", |(clip, _)| clip.w == 0.0)
    .build()
}

fn cosine() -> Formula {
    formula(M, "reflective_shadow_map_cosine", mirror::cosine, oracle::cosine, |draws| {
        let (normal, light) = (normal(draws), draws.unit_vector());
        match draws.below(4) {
            // Near the horizon, at every magnitude of the elevation.
            0 => {
                let across = draws.perpendicular(light.as_dvec3().normalize());
                let up = f64::from(draws.signed(-30, -1));
                ((across + up * light.as_dvec3()).as_vec3(), light)
            }
            1 => (light * normal.length(), light),
            _ => (normal, light),
        }
    })
    .edge("no normal", |(normal, _)| normal == Vec3::ZERO)
    .edge("facing the light", |(normal, light)| normal == light)
    .edge("away from the light", |(normal, light)| normal.dot(light) < -0.5 * normal.length())
    .edge("square to the light", |(normal, light)| normal != Vec3::ZERO && normal.dot(light) == 0.0)
    .edge("a very short normal", |(normal, _)| normal != Vec3::ZERO && normal.length() < 1e-9)
    .edge("a very long normal", |(normal, _)| normal.length() > 1e9)
    .invariant(
        "in [0, 1]",
        |_, cosine: f32| {
            if (0.0..=1.0).contains(&cosine) { Ok(()) } else { Err(format!("{cosine}")) }
        },
    )
    .build()
}

fn height() -> Formula {
    const NAIVE: &str = "reflective_shadow_map_height_naive";
    // The plane of x and y. The seen point lies half a unit beside the point, towards the light,
    // which is at grazing incidence.
    let (beside, grazing) = (Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.99995, 0.0, 0.01));
    formula(M, "reflective_shadow_map_height", mirror::height, oracle::height, above)
        .edge("the point itself", |(seen, position, _)| seen == position)
        .edge("straight above", |(seen, position, normal): (Vec3, Vec3, Vec3)| {
            (seen - position).normalize_or_zero().dot(normal.normalize_or_zero()) > 0.999
        })
        .edge("no normal", |(.., normal)| normal == Vec3::ZERO)
        .edge("far from the world's origin", |(_, position, _)| position.length() > 1e4)
        .invariant("no farther than the way is long", |(seen, position, _), height: f32| {
            let most = seen.as_dvec3().distance(position.as_dvec3());
            if f64::from(height.abs()) <= most * (1.0 + SQUARE) { Ok(()) } else { Err(format!("{height} of {most}")) }
        })
        .hard_case_with(
            "beside the point, on a plane that light grazes",
            (beside, Vec3::ZERO, Vec3::Z),
            (&[0.0], 0.0),
            (NAIVE, (beside, Vec3::ZERO, grazing), 0.49),
        )
        .hard_case_with(
            "a small step square to the light, 1e4 from the world's origin",
            (Vec3::new(1e4, 0.5, 0.0078125), Vec3::new(1e4, 0.0, 0.0), Vec3::new(0.6, 0.0, 0.8)),
            (&[0.00625], 1e-8),
            (NAIVE, (Vec3::new(1e4, 0.5, 0.0078125), Vec3::new(1e4, 0.0, 0.0), Vec3::new(0.6, 0.0, 0.8)), 5e-5),
        )
        .build()
}

fn height_naive() -> Formula {
    formula(M, "reflective_shadow_map_height_naive", mirror::height_naive, oracle::height_naive, |draws| {
        let light = draws.unit_vector();
        // Far apart along the light, near the world's origin: nothing cancels.
        (draws.between(2.0, 8.0) * light, 0.1 * draws.in_cube(), light)
    })
    .benign(1e-6)
    .build()
}
