use super::*;
use crate::implicit::tests::survey;

#[test]
fn the_figure_is_one_closed_body_without_slivers() {
    let mesh = mesh();
    let survey = survey(&mesh);
    println!("{} triangles, {survey:?}", mesh.triangle_count());
    assert!(survey.bodies == 1 && survey.least_angle > 6.0, "{survey:?}");
    // The turned normals lie in creases narrower than a triangle.
    assert!(survey.turned < 0.006, "{survey:?}");
    assert!((10_000..15_000).contains(&mesh.triangle_count()));
}

/// Tests points within each part and in the open air next to it.
#[test]
fn arms_wings_and_wreath_are_free_of_the_body() {
    let inside = |x: f64, y: f64, z: f64| field(dvec3(x, y, z)) < 0.0;
    // Between the arm on the hip and the waist, through the wreath, and between the raised arm and
    // the head.
    for (x, y, z) in [(12.0, 70.0, 0.0), (-15.0, 110.5, 6.4), (-13.0, 97.0, 5.0)] {
        assert!(!inside(x, y, z), "{x} {y} {z}");
    }
    for (x, y, z) in
        [(19.5, 70.5, -1.0), (-15.0, 116.1, 6.4), (-20.8, 95.0, 4.0), (30.0, 95.0, -11.6), (-30.0, 95.0, -11.6)]
    {
        assert!(inside(x, y, z), "{x} {y} {z}");
    }
}

/// The depth is the path length inside the figure along z.
#[test]
fn wings_are_thin_and_the_robe_is_not() {
    let depth = |x: f64, y: f64| {
        let step = 0.05;
        step * (-600..600).filter(|k| field(dvec3(x, y, step * f64::from(*k))) < 0.0).count() as f64
    };
    let (wing, robe) = (depth(34.0, 95.0), depth(0.0, 30.0));
    println!("wing {wing}, robe {robe}");
    assert!((1.5..4.5).contains(&wing) && robe > 12.0);
}
