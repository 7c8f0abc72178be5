//! Time of one frame by the number of a stone's facets.

use glam::DVec3;
use lapidary_gpu::Gpu;
use lapidary_ladders::gem::growth::GROWTH;
use lapidary_ladders::gem::{SAMPLES, views};
use lapidary_ladders::timing::{self, Timed};
use lapidary_ladders::{CostError, Progress, Report, Row};
use lapidary_render::Settings;
use lapidary_scene::cuts::CutError;
use lapidary_scene::polyhedron::{Plane, Polyhedron};
use lapidary_scene::{Averaging, Scene, SceneError};
use std::f64::consts::TAU;

/// The rungs that are timed.
pub(super) const RUNGS: [&str; 4] = ["proxy-1", "walk-8", "convex-8", "bvh-8"];
/// Facets around the stone, and rings of them on the crown and on the pavilion.
const STONES: [[u32; 3]; 6] = [[4, 1, 2], [6, 2, 3], [8, 3, 4], [14, 5, 7], [24, 9, 13], [44, 18, 25]];

/// Adds the times of stones of one outline with 21 to 1,981 facets, which fill the frame.
pub(super) fn measure(
    gpu: &Gpu,
    (rounds, [width, height]): (u32, [u32; 2]),
    report: &mut Report,
    progress: Progress<'_>,
) -> Result<(), CostError> {
    let brilliant = Scene::named("brilliant")?;
    let mut scenes = Vec::new();
    for stone in STONES {
        let open = |problem| SceneError::from(CutError::Open { cut: "brilliant of many facets", problem });
        let solid = Polyhedron::from_planes(&planes(stone)).map_err(open)?;
        let mut scene = brilliant.clone();
        scene.objects[0].mesh = solid.to_mesh(Averaging::default());
        scenes.push((format!("{} facets", solid.planes().len()), views::filled(&scene)));
    }
    let rungs: Vec<_> = RUNGS.iter().filter_map(|name| Some((*name, name.parse().ok()?))).collect();
    let frames = || scenes.iter().flat_map(|scene| rungs.iter().map(move |rung| (scene, rung)));
    let timed: Vec<Timed<'_>> = frames()
        .map(|((_, scene), (_, rung))| Timed {
            scales: true,
            ..Timed::new(scene, Settings { rung: *rung, samples: SAMPLES, ..Settings::of_size(width, height) })
        })
        .collect();
    let mut step = |done, total| progress("timing more and more facets", done, total);
    let timings = timing::time(gpu, &timed, rounds, &mut step)?;
    for (((view, _), (rung, _)), timing) in frames().zip(timings) {
        report.rows.push(Row::new(rung, view, GROWTH, None, "").timed(timing.map(|timing| timing.ms)));
    }
    Ok(())
}

/// Returns the planes of a stone with the outline of a brilliant: a table, a girdle, and rings of
/// facets that touch the curved sides of a crown and a pavilion. Each ring is turned by half a facet
/// against the one below it, as a brilliant's facets are.
fn planes([around, crown, pavilion]: [u32; 3]) -> Vec<Plane> {
    // From the girdle to the table and to the culet, by slopes in degrees and heights.
    let (up, down) = (Side { first: 41.0, last: 23.0, end: 0.53 }, Side { first: 42.5, last: 40.5, end: 0.0 });
    let half_girdle = 0.02;
    let turned = |angle: f64, radial: DVec3| glam::DQuat::from_rotation_z(angle) * radial;
    let mut planes = vec![Plane::through(DVec3::Z * (half_girdle + up.place(1.0).1), DVec3::Z)];
    for (side, rings, sign) in [(&up, crown, 1.0), (&down, pavilion, -1.0)] {
        for ring in 0..rings {
            let along = (f64::from(ring) + 0.5) / f64::from(rings);
            let (radius, height) = side.place(along);
            let slope = side.slope(along);
            for facet in 0..around {
                let angle = TAU * (f64::from(facet) + 0.5 * f64::from(ring % 2)) / f64::from(around);
                let point = DVec3::new(radius, 0.0, sign * (half_girdle + height));
                let normal = DVec3::new(slope.sin(), 0.0, sign * slope.cos());
                planes.push(Plane::through(turned(angle, point), turned(angle, normal)));
            }
        }
    }
    let sides = 2 * around;
    let girdle = (0..sides).map(|side| turned(TAU * f64::from(side) / f64::from(sides), DVec3::X));
    planes.extend(girdle.map(|normal| Plane { normal, distance: 1.0 }));
    planes
}

/// A curve from the girdle inwards, whose slope changes evenly with the way along it.
struct Side {
    /// Slopes at the girdle and at the end in degrees.
    first: f64,
    last: f64,
    /// Radius at the end; 1 at the girdle.
    end: f64,
}

impl Side {
    fn slope(&self, along: f64) -> f64 {
        (self.first + (self.last - self.first) * along).to_radians()
    }

    /// Returns the radius, and the height above the girdle, at a part of the way.
    fn place(&self, along: f64) -> (f64, f64) {
        // With slopes s = a + (b - a) t, the integrals of cos s and sin s over t.
        let turn = (self.last - self.first).to_radians();
        let inwards = |along: f64| (self.slope(along).sin() - self.slope(0.0).sin()) / turn;
        let upwards = |along: f64| (self.slope(0.0).cos() - self.slope(along).cos()) / turn;
        let length = (1.0 - self.end) / inwards(1.0);
        (1.0 - length * inwards(along), length * upwards(along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_plane_is_a_facet_and_the_outline_is_that_of_a_brilliant() {
        for stone in STONES {
            let all = planes(stone);
            let solid = Polyhedron::from_planes(&all).expect("closed");
            assert_eq!(solid.planes().len(), all.len(), "{stone:?}");
            let widest = solid.vertices().iter().map(|corner| corner.truncate().length()).fold(0.0, f64::max);
            assert!((1.0..1.09).contains(&widest), "{widest}");
            let mesh = solid.to_mesh(Averaging::default());
            let convex = lapidary_scene::Convex::of_mesh(&mesh).expect("convex");
            assert_eq!(convex.planes.len(), all.len(), "{stone:?}");
        }
    }
}
