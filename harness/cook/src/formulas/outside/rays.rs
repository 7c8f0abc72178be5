//! Of rays in stones: bvh_trace, closest_point, convex_trace, dispersion, proxy_geometry, refraction.

use super::{any_vector, close, finite_values, of_length, that, vector_up_to};
use glam::{DVec3, IVec2, Mat3, Quat, Vec2, Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, accurate, finite, holds, like, nothing};
use lapidary_bvh_trace::{self as bvh, BVH_TRACE_NONE, BvhTraceBox, BvhTraceHit, BvhTraceRay};
use lapidary_closest_point::oracle as closest_point;
use lapidary_convex_trace::{self as convex, CONVEX_TRACE_FAR, CONVEX_TRACE_NONE, ConvexTraceHit};
use lapidary_dispersion::{DispersionSellmeier, oracle as dispersion};
use lapidary_proxy_geometry::{ProxyGeometryCell, ProxyGeometryPlane};
use lapidary_refraction::RefractionHit;

pub(super) fn promises() -> Vec<Promise> {
    [trees(), centres(), planes(), spectra(), proxies(), refractions()].into_iter().flatten().collect()
}

/// A ray of a box, coordinates up to 2^`high`.
fn ray(draws: &mut Draws<'_>, high: i32) -> (BvhTraceRay, Vec3, Vec3) {
    let (one, other) = (vector_up_to(draws, high), vector_up_to(draws, high));
    let (lower, upper) = (one.min(other), one.max(other));
    let direction = draws.unit_vector();
    (bvh::ray(vector_up_to(draws, high), direction, lower, upper), lower, upper)
}

fn trees() -> Vec<Promise> {
    const TRIANGLE: &str = "bvh_trace_triangle";
    const HUGE: &str = "finite for coordinates up to 1e30";
    // 2^99 is below 1e30.
    let huge = 99;
    vec![
        like(
            "bvh_trace_turn",
            "3 and more count as 2",
            |draws| (any_vector(draws), 3 + draws.below(u32::MAX - 3)),
            |(vector, _): (Vec3, u32)| (vector, 2),
        ),
        finite("bvh_trace_ray", "finite for |direction| in [1e-6, 1e6] and coordinates up to 1e30", move |draws| {
            let (one, other) = (vector_up_to(draws, huge), vector_up_to(draws, huge));
            (vector_up_to(draws, huge), of_length(draws, -19, 19), one.min(other), one.max(other))
        }),
        nothing("bvh_trace_ray", "a zero direction divides by 0"),
        // Rows no shorter than 1e-3 and square to each other turn no direction into 0.
        finite("bvh_trace_to_object", "finite while the direction is not turned into 0", move |draws| {
            let turn = Mat3::from_quat(Quat::from_rotation_arc(Vec3::Z, draws.unit_vector()));
            let rows = turn.transpose() * Mat3::from_diagonal(Vec3::splat(draws.magnitude(-9, 40)));
            let place = vector_up_to(draws, 50);
            (vector_up_to(draws, 50), of_length(draws, -10, 30), place, rows.x_axis, rows.y_axis, rows.z_axis)
        }),
        finite("bvh_trace_box", HUGE, move |draws| {
            let (ray, lower, upper) = ray(draws, huge);
            (ray, lower, upper, draws.magnitude(-20, 120))
        }),
        holds(
            "bvh_trace_box",
            "where lower > upper, the box between them less the margin",
            |draws| {
                let upper = draws.in_cube();
                let lower = upper + draws.between(0.1, 2.0);
                // Aimed at its middle from outside of it.
                let middle = 0.5 * (lower + upper);
                let direction = draws.unit_vector();
                let ray = bvh::ray(middle - 8.0 * direction, direction, -4.0 * Vec3::ONE, 4.0 * Vec3::ONE);
                (ray, lower, upper, 1e37f32)
            },
            |(_, lower, upper, _): (BvhTraceRay, Vec3, Vec3, f32), found: BvhTraceBox| {
                // The ray ends in the box's middle after 8; its faces are at most a diagonal's half before that.
                let nearest = 8.0 - 0.51 * (lower - upper).length();
                that(found.hit && found.entry > nearest && found.entry < 8.0, || format!("{found:?}"))
            },
        ),
        holds(
            "bvh_trace_start",
            "negative: nothing will be met",
            |draws| (-draws.magnitude(-126, 120),),
            |(limit,): (f32,), hit: BvhTraceHit| {
                that(hit.distance == limit && hit.triangle == BVH_TRACE_NONE, || format!("{hit:?}"))
            },
        ),
        finite("bvh_trace_shear", HUGE, move |draws| {
            let (ray, ..) = ray(draws, huge);
            (ray, vector_up_to(draws, huge))
        }),
        holds(
            TRIANGLE,
            "`triangle` equal to `left`, the one just left, never counts",
            |draws| {
                let triangle = draws.below(100);
                let (ray, ..) = ray(draws, 2);
                let hit = BvhTraceHit { distance: draws.magnitude(-2, 100), ..bvh::start(1e37) };
                (hit, ray, draws.in_cube(), draws.in_cube(), draws.in_cube(), triangle, triangle)
            },
            |(before, ..): (BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32), hit: BvhTraceHit| {
                that(hit == before, || format!("{hit:?}"))
            },
        ),
        nothing(
            TRIANGLE,
            "A triangle without area in the frame of the ray need not: its neighbours, of which it is an edge there, do",
        ),
        holds(
            TRIANGLE,
            "Of thin ones none is refused that the ray meets, but the point in it is less sure",
            |draws| {
                // Thin, and met in the middle by a ray that comes from in front of it.
                let (along, across) = (Vec3::X, draws.magnitude(-14, -5) * Vec3::Y);
                let [a, b, c] = [-along - across, along - across, 0.2 * along + across];
                let middle = (a + b + c) / 3.0;
                let direction = (draws.direction() + 1.2 * DVec3::Z).normalize().as_vec3();
                let ray = bvh::ray(middle - direction, direction, -2.0 * Vec3::ONE, 2.0 * Vec3::ONE);
                (bvh::start(1e37), ray, a, b, c, 7u32, BVH_TRACE_NONE)
            },
            |_: (BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32), hit: BvhTraceHit| {
                that(hit.triangle == 7 && (hit.distance - 1.0).abs() < 0.01, || format!("{hit:?}"))
            },
        ),
    ]
}

fn centres() -> Vec<Promise> {
    const DIRECTION: &str = "closest_point_direction";
    const PARAMETERS: &str = "closest_point_parameters";
    const FALLBACK: &str = "closest_point_fallback";
    const CENTRE: &str = "closest_point_centre";
    let normals = |draws: &mut Draws<'_>| (draws.unit_vector(), draws.unit_vector(), draws.unit_vector());
    vec![
        accurate("closest_point_largest_component", "none", |draws| (any_vector(draws),)),
        finite(DIRECTION, "finite", |draws| (any_vector(draws),)),
        holds(
            DIRECTION,
            "smaller vectors may count as 0",
            |draws| (of_length(draws, -126, -100),),
            |_: (Vec3,), direction: Vec3| {
                let length = direction.as_dvec3().length();
                that(length <= 1.000_01, || format!("its length is {length}"))
            },
        ),
        holds(
            PARAMETERS,
            "(0, 0) below an angle of 1e-23",
            |draws| {
                (
                    draws.in_cube(),
                    Vec3::X,
                    draws.in_cube(),
                    Vec3::new(1.0, draws.signed(-126, -78), draws.signed(-126, -78)),
                )
            },
            |_: (Vec3, Vec3, Vec3, Vec3), t: Vec2| that(t == Vec2::ZERO, || format!("the parameters are {t}")),
        ),
        finite(PARAMETERS, "finite wherever |origin_j - origin_i| / angle < 1e37", |draws| {
            let angle = draws.magnitude(-60, 0);
            let across = Vec3::Y * angle;
            // Half of f32's range for the other products.
            let apart = draws.magnitude(-60, 60) * draws.in_cube();
            (Vec3::ZERO, Vec3::X, apart, Vec3::new(1.0 / (1.0 + angle * angle).sqrt(), across.y, 0.0))
        }),
        finite(FALLBACK, "finite for positions up to 1e37", |draws| {
            let size = draws.magnitude(-126, 121);
            (size * draws.in_cube(), size * draws.in_cube(), size * draws.in_cube())
        }),
        holds(
            FALLBACK,
            "smaller triangles may count as a point",
            |draws| {
                let size = draws.magnitude(-120, -68);
                (size * draws.in_cube(), size * draws.in_cube(), size * draws.in_cube())
            },
            |(a, b, c): (Vec3, Vec3, Vec3), point: Vec3| {
                let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
                let extent = (b - a).length().max((c - a).length()).max((c - b).length());
                let off = point.as_dvec3().distance((a + b + c) / 3.0);
                that(off <= 1.5 * extent + 1e-36, || format!("{off:e} from the centroid, the edges {extent:e}"))
            },
        ),
        finite(CENTRE, "finite for positions up to 1e30", move |draws| {
            let (size, (n_a, n_b, n_c)) = (draws.magnitude(-126, 98), normals(draws));
            (size * draws.in_cube(), n_a, size * draws.in_cube(), n_b, size * draws.in_cube(), n_c)
        }),
        holds(
            CENTRE,
            "Opposed normals give o too, with up to a thousand ulp",
            |draws| {
                let axis = draws.unit_vector();
                let aside = |draws: &mut Draws<'_>, sign: f64| {
                    (sign * axis.as_dvec3() + 0.3 * draws.direction()).normalize().as_vec3()
                };
                let (n_a, n_b, n_c) = (aside(draws, 1.0), aside(draws, -1.0), aside(draws, 1.0));
                (draws.in_cube(), n_a, draws.in_cube(), n_b, draws.in_cube(), n_c)
            },
            |(a, n_a, b, n_b, c, n_c): (Vec3, Vec3, Vec3, Vec3, Vec3, Vec3), o: Vec3| {
                let [a, n_a, b, n_b, c, n_c] = [a, n_a, b, n_b, c, n_c].map(Vec3::as_dvec3);
                let wanted = closest_point::centre(a, n_a, b, n_b, c, n_c);
                // The face's normal, which the fallback takes, is as sure as the triangle is fat.
                let fat = (b - a).cross(c - a).length() / (b - a).length().max((c - a).length()).powi(2);
                let bound = 1000.0 * 2f64.powi(-23) * wanted.abs().max_element().max(1.0) / fat.clamp(1e-3, 1.0);
                close(&o.to_array(), &wanted.to_array(), bound)
            },
        ),
    ]
}

fn planes() -> Vec<Promise> {
    const STEP: &str = "convex_trace_step";
    vec![
        holds(
            "convex_trace_start",
            "from a negative limit on nothing is hit",
            |draws| (-draws.magnitude(-126, 127),),
            |(limit,): (f32,), hit: ConvexTraceHit| {
                that(hit.distance == limit && hit.face == CONVEX_TRACE_NONE, || format!("{hit:?}"))
            },
        ),
        finite(STEP, "finite for sizes up to 1e18", |draws| {
            let plane = draws.unit_vector().extend(draws.signed(-126, 58));
            let hit = convex::start(CONVEX_TRACE_FAR);
            (hit, vector_up_to(draws, 58), draws.unit_vector(), plane, draws.below(9), CONVEX_TRACE_NONE)
        }),
        holds(
            STEP,
            "for other directions distances in units of their length",
            |draws| {
                let length = 2f32.powi(draws.below(21) as i32 - 10);
                let plane = draws.unit_vector().extend(draws.between(1.0, 3.0));
                (
                    convex::start(CONVEX_TRACE_FAR),
                    Vec3::ZERO,
                    length * draws.unit_vector(),
                    plane,
                    3u32,
                    CONVEX_TRACE_NONE,
                )
            },
            |(hit, position, direction, plane, face, left): (ConvexTraceHit, Vec3, Vec3, Vec4, u32, u32),
             met: ConvexTraceHit| {
                let length = direction.length().log2().round().exp2();
                let unit = convex::step(hit, position, direction / length, plane, face, left);
                let right = unit.face == met.face
                    && (met.face == CONVEX_TRACE_NONE
                        || close(
                            &[met.distance * length],
                            &[f64::from(unit.distance)],
                            1e-6 * f64::from(unit.distance),
                        )
                        .is_ok());
                that(right, || format!("{met:?}, in units of a length of {length}: {unit:?}"))
            },
        ),
        finite("convex_trace_point", "finite up to 1e18", |draws| {
            let plane = draws.unit_vector().extend(draws.signed(-126, 58));
            (vector_up_to(draws, 58), draws.unit_vector(), draws.magnitude(-126, 58), plane)
        }),
    ]
}

fn spectra() -> Vec<Promise> {
    const SAME: &str = "the same formula, while the wavelength is in [1e-3, 1e9]";
    const ENTER: &str = "dispersion_enter";
    const REFRACT: &str = "dispersion_refract";
    const FACES_AWAY: &str = "A normal that faces away is taken to be at grazing incidence, as refraction.wgsl does";
    let away = |draws: &mut Draws<'_>| {
        let (direction, normal) = (draws.unit_vector(), draws.unit_vector());
        (direction, if normal.dot(direction) < 0.0 { -normal } else { normal })
    };
    let refracted = move |draws: &mut Draws<'_>| {
        let (direction, normal) = away(draws);
        let gradient = draws.magnitude(-40, 39) * draws.unit_vector();
        (direction, gradient, normal, draws.between(0.25, 4.0), draws.signed(-40, -1))
    };
    vec![
        holds(
            "dispersion_sellmeier",
            "the same formula while no resonance is met",
            |draws| {
                let resonances =
                    Vec3::new(draws.between(0.001, 0.02), draws.between(0.001, 0.02), draws.between(100.0, 200.0));
                let material = DispersionSellmeier {
                    constant: draws.between(0.0, 2.0),
                    strengths: draws.in_cube().abs(),
                    resonances,
                };
                (material, draws.between(200.0, 4000.0))
            },
            |(material, wavelength): (DispersionSellmeier, f32), index: f32| {
                let squared = (f64::from(wavelength) / 1000.0).powi(2);
                let term = |place: usize| {
                    f64::from(material.strengths[place]) * squared / (squared - f64::from(material.resonances[place]))
                };
                let wanted = 1.0 + f64::from(material.constant) + (0..3).map(term).sum::<f64>();
                let wanted = wanted.max(1.0).sqrt();
                close(&[index], &[wanted], 1e-5 * wanted)
            },
        ),
        nothing("dispersion_sellmeier", "infinite or not a number where wavelength^2 is a resonance"),
        holds(
            "dispersion_cauchy",
            SAME,
            |draws| {
                (
                    Vec3::new(draws.between(1.0, 4.0), draws.between(0.0, 0.1), draws.between(0.0, 0.01)),
                    draws.magnitude(-9, 29),
                )
            },
            |(coefficients, wavelength): (Vec3, f32), index: f32| {
                let [a, b, c] = coefficients.as_dvec3().to_array();
                let inverse = (f64::from(wavelength) / 1000.0).powi(-2);
                let wanted = a + inverse * (b + inverse * c);
                close(&[index], &[wanted], 1e-5 * wanted)
            },
        ),
        holds(
            "dispersion_abbe",
            SAME,
            |draws| (draws.between(1.0, 4.0), draws.between(0.0, 64.0), draws.magnitude(-9, 29)),
            |(index_d, strength, wavelength): (f32, f32, f32), index: f32| {
                let wanted = dispersion::abbe(index_d.into(), strength.into(), wavelength.into());
                let squared = (f64::from(wavelength) / 1000.0).powi(-2);
                close(&[index], &[wanted], 1e-5 * (wanted.abs() + f64::from(strength) * (1.0 + squared)))
            },
        ),
        holds(
            "dispersion_abbe_number",
            "the same quotient",
            |draws| {
                let middle = draws.signed(-6, 10);
                (middle, middle + draws.magnitude(0, 4), middle - draws.magnitude(0, 4))
            },
            |(d, f, c): (f32, f32, f32), number: f32| {
                let [d, f, c] = [d, f, c].map(f64::from);
                let wanted = (d - 1.0) / (f - c);
                close(&[number], &[wanted], 4e-6 * ((d.abs() + 1.0) / (f - c)).abs() + 1e-6 * wanted.abs())
            },
        ),
        finite(ENTER, "finite", |draws| (draws.unit_vector(), draws.unit_vector(), draws.between(0.25, 4.0))),
        finite(ENTER, FACES_AWAY, move |draws| {
            let (direction, normal) = away(draws);
            (direction, normal, draws.between(1.0, 4.0))
        }),
        nothing(ENTER, "A gem in a denser medium takes dispersion_refract, which knows total internal reflection"),
        finite(REFRACT, "finite", refracted),
        finite(REFRACT, FACES_AWAY, refracted),
        holds(
            "dispersion_reflect",
            "for other lengths of the normal the same linear map, which then is no reflection",
            |draws| (of_length(draws, -20, 20), of_length(draws, -20, 20)),
            |(gradient, normal): (Vec3, Vec3), reflected: Vec3| linear(gradient, normal, reflected),
        ),
        nothing(
            "dispersion_direction",
            "not a number where the sum is 0, which a perpendicular gradient cannot bring about",
        ),
        holds(
            "dispersion_paper_enter",
            "the same quotient",
            |draws| (of_length(draws, -3, 3), of_length(draws, -3, 3)),
            |(direction, refracted): (Vec3, Vec3), unit: Vec3| {
                let chord = refracted.as_dvec3() - direction.as_dvec3();
                let size = direction.length().max(refracted.length());
                if chord.length() < 1e-3 {
                    return Ok(());
                }
                close(&unit.to_array(), &chord.normalize().to_array(), 2e-6 * (1.0 + f64::from(size) / chord.length()))
            },
        ),
    ]
}

/// r - 2 (n . r) n, in f64.
fn linear(vector: Vec3, normal: Vec3, reflected: Vec3) -> Result<(), String> {
    let (r, n) = (vector.as_dvec3(), normal.as_dvec3());
    let wanted = r - 2.0 * n.dot(r) * n;
    close(&reflected.to_array(), &wanted.to_array(), 2e-6 * r.length() * (1.0 + 2.0 * n.length_squared()))
}

fn proxies() -> Vec<Promise> {
    const BEYOND: &str = "overflows beyond";
    const CELL: &str = "proxy_geometry_cell";
    let sized = |draws: &mut Draws<'_>, low: i32, high: i32| {
        let size = draws.magnitude(low, high);
        let (one, two) = (size * draws.in_cube(), size * draws.in_cube());
        // Degenerate in every way.
        match draws.below(6) {
            0 => (one, one, one),
            1 => (one, one, two),
            2 => (one, two, one),
            3 => (one, two, 0.5 * (one + two)),
            _ => (one, two, size * draws.in_cube()),
        }
    };
    vec![
        nothing("proxy_geometry_image", BEYOND),
        nothing("proxy_geometry_plane", BEYOND),
        nothing("proxy_geometry_facet_normal", BEYOND),
        nothing("proxy_geometry_next_plane", BEYOND),
        nothing("proxy_geometry_intersect", "for positions beyond, overflows"),
        finite("proxy_geometry_face_normal", "finite; zero or ill-conditioned", move |draws| sized(draws, -126, 99)),
        finite("proxy_geometry_coordinates", "finite; ill-conditioned", move |draws| {
            let (point, first, second) = sized(draws, -89, 88);
            (point, Vec3::ZERO, first, second)
        }),
        holds(
            CELL,
            "as the formula gives",
            |draws| (Vec2::new(draws.signed(23, 29), draws.signed(23, 29)),),
            |(at,): (Vec2,), cell: ProxyGeometryCell| {
                let wanted = IVec2::new(at.x.floor() as i32, at.y.floor() as i32);
                that(cell.steps == wanted, || format!("{:?}, not {wanted}", cell.steps))
            },
        ),
        holds(
            CELL,
            "cells beyond 2^31 are clamped to it",
            |draws| (Vec2::new(draws.signed(31, 126), draws.signed(31, 126)),),
            |(at,): (Vec2,), cell: ProxyGeometryCell| {
                let clamped = |at: f32, step: i32| {
                    // The largest f32 that an i32 holds is 2^31 - 128.
                    if at > 0.0 { step >= i32::MAX - 127 } else { step == i32::MIN }
                };
                that(clamped(at.x, cell.steps.x) && clamped(at.y, cell.steps.y), || format!("{:?}", cell.steps))
            },
        ),
        finite("proxy_geometry_facet", "exact steps up to 2^24", |draws| {
            let size = draws.magnitude(-89, 88);
            let mut vector = || size * draws.in_cube();
            let plane = ProxyGeometryPlane { origin: vector(), edge_first: vector(), edge_second: vector() };
            let mut step = || (draws.below(1 << 25) as i32) - (1 << 24);
            let steps = IVec2::new(step(), step());
            (plane, ProxyGeometryCell { steps, turned: draws.below(2) == 0 })
        }),
        nothing("proxy_geometry_facet", "overflows beyond 1e37"),
    ]
}

fn refractions() -> Vec<Promise> {
    const RADICAND: &str = "refraction_radicand";
    vec![
        holds(
            "refraction_relative_index",
            "the quotient, while index_incident is not 0",
            |draws| (draws.signed(-60, 60), draws.signed(-60, 60)),
            |(incident, transmitted): (f32, f32), index: f32| {
                let wanted = f64::from(transmitted) / f64::from(incident);
                close(&[index], &[wanted], 4e-7 * wanted.abs())
            },
        ),
        holds(
            "refraction_reflect",
            "for other lengths the linear map r - 2 (n . r) n, which then is no reflection",
            |draws| (of_length(draws, -20, 20), of_length(draws, -20, 20)),
            |(incident, normal): (Vec3, Vec3), reflected: Vec3| linear(incident, normal, reflected),
        ),
        holds(
            RADICAND,
            "the same quotient",
            |draws| (draws.signed(-10, 10), draws.magnitude(-10, 10)),
            |(cosine, index): (f32, f32), radicand: f32| {
                let (cosine, index) = (f64::from(cosine), f64::from(index));
                let wanted = ((index - 1.0) * (index + 1.0) + cosine * cosine) / (index * index);
                let terms = (cosine * cosine + index * index + 1.0) / (index * index);
                close(&[radicand], &[wanted], 2e-6 * terms)
            },
        ),
        finite(RADICAND, "finite for |cosine| < 1e9 and relative_index in [1e-9, 1e18]", |draws| {
            (draws.signed(-126, 28), draws.magnitude(-29, 58))
        }),
        holds(
            "refraction_refract",
            "a normal that faces away from the ray is taken to be at grazing incidence (c = 0): finite, but not unit",
            |draws| {
                let (incident, normal) = (draws.unit_vector(), draws.unit_vector());
                (incident, if normal.dot(incident) < 0.0 { -normal } else { normal }, draws.between(0.25, 4.0))
            },
            |_: (Vec3, Vec3, f32), hit: RefractionHit| finite_values(&hit.direction.to_array()),
        ),
    ]
}
