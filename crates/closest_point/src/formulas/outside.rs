//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::oracle as closest_point;
use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, accurate, any_vector, close, finite, holds, of_length, that};

/// Returns all promises of the module.
pub(super) fn promises() -> Vec<Promise> {
    const DIRECTION: &str = "closest_point_direction";
    const PARAMETERS: &str = "closest_point_parameters";
    const FALLBACK: &str = "closest_point_fallback";
    const CENTRE: &str = "closest_point_centre";
    let normals = |draws: &mut Draws<'_>| (draws.unit_vector(), draws.unit_vector(), draws.unit_vector());
    vec![
        accurate("closest_point_largest_component", "nothing", |draws| (any_vector(draws),)),
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
            "(0, 0) below an angle of 1e-20",
            |draws| {
                (
                    draws.in_cube(),
                    Vec3::X,
                    draws.in_cube(),
                    Vec3::new(1.0, draws.signed(-126, -67), draws.signed(-126, -67)),
                )
            },
            |_: (Vec3, Vec3, Vec3, Vec3), t: Vec2| that(t == Vec2::ZERO, || format!("the parameters are {t}")),
        ),
        finite(PARAMETERS, "finite wherever |origin_j - origin_i| / angle < 1e37", |draws| {
            let angle = draws.magnitude(-60, 0);
            let across = Vec3::Y * angle;
            // Half of f32's range, which leaves the other half for the products.
            let offset = draws.magnitude(-60, 60) * draws.in_cube();
            (Vec3::ZERO, Vec3::X, offset, Vec3::new(1.0 / (1.0 + angle * angle).sqrt(), across.y, 0.0))
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
            "Opposed normals give o too, with up to four thousand ulp",
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
                // The fallback uses the face normal, which is the less certain the thinner the
                // triangle is.
                let fat = (b - a).cross(c - a).length() / (b - a).length().max((c - a).length()).powi(2);
                let bound = 4000.0 * 2f64.powi(-23) * wanted.abs().max_element().max(1.0) / fat.clamp(1e-3, 1.0);
                close(&o.to_array(), &wanted.to_array(), bound)
            },
        )
        .at_nearest(),
    ]
}
