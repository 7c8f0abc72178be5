use super::*;
use glam::{Vec2, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_scene::{Bounds, MeshDiagnosis};

#[test]
fn the_candle_is_closed_smooth_and_right_side_out() {
    let mesh = mesh();
    println!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangle_count());
    assert!(MeshDiagnosis::of(&mesh).is_closed() && mesh.normals.iter().all(|normal| normal.is_normalized()));
    assert_eq!(mesh.uvs.len(), mesh.positions.len());
    let mut widest: f32 = 0.0;
    for triangle in mesh.indices.chunks_exact(3) {
        let [a, b, c]: [Vec3; 3] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize]);
        let across = (b - a).cross(c - a).normalize();
        for vertex in triangle {
            widest = larger(widest, across.angle_between(mesh.normals[*vertex as usize]));
        }
        let [a, b, c]: [Vec2; 3] = [0, 1, 2].map(|k| mesh.uvs[triangle[k] as usize]);
        assert!((b - a).perp_dot(c - a) < 0.0);
    }
    // A triangle's normal is off by about its half width divided by the radius of curvature.
    println!("normals at most {:.1}° off their triangles", widest.to_degrees());
    assert!(widest.to_degrees() < 30.0);
}

/// Pappus's theorem gives the volume: 2π times the integral of r²/2 over the height, without the
/// runs and the sag, which add and remove wax.
#[test]
fn the_candle_has_the_outlines_volume_and_stands_on_the_table() {
    let mesh = mesh();
    let steps = 100_000;
    let places = (0..=steps).map(|k| outline(f64::from(k) / f64::from(steps)));
    let parts = places.clone().zip(places.skip(1)).map(|(a, b)| {
        let middle = 0.5 * (a.x + b.x);
        PI * middle * middle * (a.y - b.y)
    });
    let expected: f64 = parts.sum();
    let (volume, _) = mesh.volume_and_area();
    println!("{volume} of {expected}");
    // Runs of some 25 by 5 by 1 mm add up to a few hundredths.
    assert!((1.0..1.05).contains(&(volume / expected)), "{volume}, {expected}");
    let bounds = Bounds::of(mesh.positions.iter().copied());
    // Remainder of the rim's sag at the foot: 1 mm by exp(-45 / 2.5).
    assert!(bounds.min.y.abs() < 2e-8 && (59.0..62.0).contains(&bounds.max.y), "{bounds:?}");
    assert!(bounds.max.with_y(0.0).max_element() < 17.5 && bounds.max.x > 15.0);
}

#[test]
fn the_outline_ends_on_the_axis_and_bends_evenly() {
    assert_eq!((outline(0.0).x, outline(1.0).x), (0.0, 0.0));
    assert_eq!(outline(1.0).y, 0.0);
    // On both sides of each control point, the second derivatives with respect to the point number
    // agree to within 2h times a third derivative of at most 8 times the distance between two
    // points.
    let (h, spans) = (1e-3, (OUTLINE.len() - 1) as f64);
    for k in 1..OUTLINE.len() - 1 {
        let point = |offset: f64| outline((k as f64 + offset * h) / spans);
        let second = |from: f64| (point(from) - 2.0 * point(from + 1.0) + point(from + 2.0)) / (h * h);
        let jump = (second(-2.0) - second(0.0)).length();
        assert!(jump < 8.0 * 13.0 * 2.0 * h && second(0.0).length() < 20.0, "{k}: {jump}");
    }
}

#[test]
fn wax_has_run_over_the_rim_and_gathered_in_drops() {
    for run in &RUNS {
        let out = |height: f64| run.depth(run.azimuth, height);
        let (middle, drop) = (out(run.end + 12.0), out(run.end + 2.5));
        assert!((1.25..1.35).contains(&middle) && drop > 1.4 * middle, "{middle} {drop}");
        assert!(out(run.end - 8.0) < 0.01);
        assert!(run.depth(run.azimuth + PI, run.end + 2.5) < 1e-12);
        // The surface is continuous all around.
        assert!((run.depth(run.azimuth - 0.1, 40.0) - run.depth(run.azimuth - 0.1 + TAU, 40.0)).abs() < 1e-12);
    }
    // The bowl lies below its rim on all sides.
    for k in 0..32 {
        assert!(point(dvec2(f64::from(k) / 32.0, RIM)).y > point(dvec2(0.0, 0.0)).y + 6.0);
    }
}
