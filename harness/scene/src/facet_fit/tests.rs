//! Cuts rounded as files round them, and their planes found again.

use glam::{DQuat, DVec3, Vec3};
use lapidary_assay::draws::Draws;

use super::*;
use crate::Averaging;
use crate::convex::planes_of_convex;
use crate::cuts::{BrilliantParameters, StepCutParameters, octahedron, round_brilliant, step_cut};

fn cuts() -> [(&'static str, Mesh); 3] {
    let brilliant = round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap();
    let step = step_cut(&StepCutParameters::EMERALD).unwrap();
    [("brilliant", brilliant), ("step cut", step), ("octahedron", octahedron().unwrap())]
        .map(|(name, solid)| (name, solid.to_mesh(Averaging::Angle)))
}

/// Returns a mesh turned, its corners rounded to so many bits of its box.
fn rounded(mesh: &Mesh, turn: DQuat, bits: u32) -> Mesh {
    let mut mesh = mesh.placed(turn, DVec3::ZERO);
    let bounds = Bounds::of(mesh.positions.iter().copied());
    let step = (bounds.max - bounds.min) / ((1u32 << bits) - 1) as f32;
    for position in &mut mesh.positions {
        *position = bounds.min + ((*position - bounds.min) / step).round() * step;
    }
    mesh
}

fn turn(draws: &mut Draws<'_>) -> DQuat {
    let mut part = || f64::from(draws.between(-1.0, 1.0));
    DQuat::from_xyzw(part(), part(), part(), part() + 0.01).normalize()
}

/// Angles in degrees between each true plane and the nearest one found.
fn angles(truth: &[Plane], found: &[Plane]) -> Vec<f64> {
    let angle = |a: &Plane, b: &Plane| 2.0 * (0.5 * a.normal.distance(b.normal)).asin().to_degrees();
    truth.iter().map(|plane| found.iter().map(|other| angle(plane, other)).fold(180.0, f64::min)).collect()
}

#[test]
fn try_it() {
    for (name, mesh) in cuts() {
        for bits in [16, 14, 12, 11, 10] {
            for row in 0..3 {
                let mut draws = Draws::of_row(11, row);
                let turn = if row == 0 { DQuat::IDENTITY } else { turn(&mut draws) };
                let truth = planes_of_convex(&mesh.placed(turn, DVec3::ZERO)).unwrap();
                let mesh = rounded(&mesh, turn, bits);
                match recover(&mesh) {
                    Err(error) => println!("{name} {bits} {row}: {error}"),
                    Ok(found) => {
                        let planes: Vec<Plane> = found.facets.iter().map(|facet| facet.plane).collect();
                        let mut angles = angles(&truth, &planes);
                        angles.sort_by(f64::total_cmp);
                        println!(
                            "{name} {bits} {row}: {} of {} planes, noise {:.1e}, moved {:.1e}, {:?}, angles median {:.3} most {:.3}, stated {:.3}, convex {:?}",
                            planes.len(),
                            truth.len(),
                            found.noise,
                            found.moved,
                            found.symmetry,
                            angles[angles.len() / 2],
                            angles[angles.len() - 1],
                            found.uncertainty().to_degrees(),
                            planes_of_convex(&found.mesh).map(|planes| planes.len())
                        );
                    }
                }
            }
        }
    }
    assert_ne!(Vec3::X, Vec3::Y);
}
