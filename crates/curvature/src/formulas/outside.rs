//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{CurvatureFrame, CurvaturePixel};
use glam::Vec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, any_vector, finite, holds, of_length, that};

/// Returns all promises of the module.
pub(super) fn promises() -> Vec<Promise> {
    const DERIVATIVE: &str = "curvature_normal_derivative";
    const STEEPEST: &str = "finite for |normal_x|, |normal_y| <= 2";
    let pixel = |draws: &mut Draws<'_>| {
        let position = |draws: &mut Draws<'_>| if draws.below(8) == 0 { Vec3::ZERO } else { any_vector(draws) };
        let normal = |draws: &mut Draws<'_>| 2.0 * draws.between(0.0, 1.0) * draws.unit_vector();
        (position(draws), position(draws), normal(draws), normal(draws))
    };
    let huge = |draws: &mut Draws<'_>| {
        let component = draws.pick(&[1.0, -1.0]) * draws.magnitude(127, 127);
        let other = draws.signed(-100, 126);
        draws.pick(&[
            Vec3::new(component, other, 0.0),
            Vec3::new(other, other, component),
            Vec3::new(0.0, component, other),
        ])
    };
    vec![
        holds(
            "curvature_scale",
            "0 from 2^127 on, which makes the pixel degenerate",
            move |draws| (huge(draws),),
            |_: (Vec3,), scale: f32| that(scale == 0.0, || format!("the scale is {scale}")),
        ),
        holds(
            DERIVATIVE,
            "fades to 0 for shorter normals",
            |draws| {
                // Shorter than the length that CURVATURE_SMALLEST scales to 1.
                let length = draws.magnitude(-126, -52);
                (length * draws.unit_vector(), length * draws.magnitude(-20, 20) * draws.unit_vector())
            },
            |(normal, derivative): (Vec3, Vec3), result: Vec3| {
                // The bound of a normal of that length that does not fade: derivative / normal.
                let (normal, derivative) = (normal.as_dvec3().length(), derivative.as_dvec3().length());
                let most = 1.000_01 * derivative / normal.max(f64::MIN_POSITIVE) + 1e-30;
                that(result.as_dvec3().length() <= most, || format!("{result}, longer than {most:e}"))
            },
        ),
        finite(DERIVATIVE, "finite while |derivative| < 1e10", |draws| {
            (of_length(draws, -126, 126), of_length(draws, -126, 32))
        }),
        holds(
            "curvature_pixel",
            "as curvature_scale",
            move |draws| (huge(draws), huge(draws), draws.in_cube(), draws.in_cube()),
            |_: (Vec3, Vec3, Vec3, Vec3), pixel: CurvaturePixel| {
                let gone = [pixel.p_x, pixel.p_y, pixel.n_x, pixel.n_y].into_iter().all(|vector| vector == Vec3::ZERO);
                that(gone, || format!("{pixel:?}"))
            },
        ),
        holds(
            "curvature_frame",
            "`first` and `second` shrink for shorter ones",
            |draws| (of_length(draws, -126, -24), of_length(draws, -126, 0)),
            |_: (Vec3, Vec3), frame: CurvatureFrame| {
                let longest = frame.first.length().max(frame.second.length());
                that(longest <= 1.000_01, || format!("a vector of length {longest}"))
            },
        ),
        finite("curvature_mean", STEEPEST, pixel),
        finite("curvature_gaussian", STEEPEST, pixel),
        finite("curvature_towards", "finite for |normal_x|, |normal_y| <= 2 and |light| <= 2", move |draws| {
            let (p_x, p_y, n_x, n_y) = pixel(draws);
            (p_x, p_y, n_x, n_y, 2.0 * draws.between(0.0, 1.0) * draws.unit_vector())
        }),
    ]
}
