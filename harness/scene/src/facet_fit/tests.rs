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

/// Half the step of the lattice, along the diagonal of a cell: how far a corner may be off.
fn half_step(mesh: &Mesh, bits: u32) -> f64 {
    let bounds = Bounds::of(mesh.positions.iter().copied());
    0.5 * f64::from((bounds.max - bounds.min).length()) / f64::from((1u32 << bits) - 1)
}

/// A table of what rounding does, and that each plane is found: turned by at most twice what half a step over its facet's least
/// width allows, and the solid convex, its corners where those of the cut are.
#[test]
fn planes_of_rounded_cuts_are_found_again() {
    for (name, mesh) in cuts() {
        for bits in [16, 14, 12, 11, 10] {
            let mut largest = (0.0_f64, 0.0_f64);
            for row in 0..8 {
                let mut draws = Draws::of_row(11, row);
                let turn = if row == 0 { DQuat::IDENTITY } else { turn(&mut draws) };
                let turned = mesh.placed(turn, DVec3::ZERO);
                let truth = planes_of_convex(&turned).unwrap();
                let rounded = rounded(&mesh, turn, bits);
                let half_step = half_step(&turned, bits);
                let Ok(found) = recover(&rounded) else { panic!("{name}, {bits} bits, {row}") };
                let planes: Vec<Plane> = found.facets.iter().map(|facet| facet.plane).collect();
                assert_eq!(planes.len(), truth.len(), "{name}, {bits} bits, {row}");
                assert_eq!(
                    planes_of_convex(&found.mesh).map(|planes| planes.len()),
                    Some(truth.len()),
                    "{name} {bits}"
                );
                for (plane, angle) in truth.iter().zip(angles(&truth, &planes)) {
                    let on = turned.positions.iter().map(|point| point.as_dvec3());
                    let on: Vec<DVec3> = on.filter(|point| plane.height(*point).abs() < 1e-5).collect();
                    let allowed = (2.0 * half_step / width(&on, plane.normal)).to_degrees();
                    // f32 rounds the corners of the cut itself.
                    assert!(angle <= allowed + 0.002, "{name}, {bits} bits, {row}: {angle} {allowed}");
                    largest = (largest.0.max(angle), largest.1.max(angle / allowed));
                }
                for corner in &turned.positions {
                    let off = highest(&truth, corner.as_dvec3()) - highest(&planes, corner.as_dvec3());
                    assert!(off.abs() <= 3.0 * half_step + 1e-6, "{name}, {bits} bits, {row}: {off} {half_step}");
                }
            }
            let (angle, share) = largest;
            println!("{name}, {bits} bits: planes turned by up to {angle:.3}°, {share:.2} of what is allowed");
            if (name, bits) == ("brilliant", 14) {
                assert!(angle < 0.1, "{angle}");
            }
        }
    }
}

/// Without it, no plane of a mesh's own triangles bounds the others, and those of its hull are as many as bends.
#[test]
fn triangles_of_rounded_cuts_are_no_facets() {
    let [(_, brilliant), ..] = cuts();
    let mut draws = Draws::of_row(5, 1);
    for bits in [16, 14, 11] {
        let rounded = rounded(&brilliant, turn(&mut draws), bits);
        assert_eq!(planes_of_convex(&rounded), None);
        let hull = Hull::of(&rounded.positions).unwrap();
        let mut normals: Vec<DVec3> = Vec::new();
        for plane in hull.triangles.iter().filter_map(|t| through(t.map(|k| rounded.positions[k].as_dvec3()))) {
            if normals.iter().all(|normal| normal.distance(plane.normal) > 1e-6) {
                normals.push(plane.normal);
            }
        }
        assert!(normals.len() > 100, "{bits}: {}", normals.len());
        assert_eq!(recover(&rounded).unwrap().facets.len(), 73);
    }
}

#[test]
fn noise_that_is_no_lattice_is_found_out() {
    let [(_, brilliant), (_, step), _] = cuts();
    for (mesh, facets) in [(brilliant, 73), (step, 57)] {
        let size = f64::from(2.0 * Bounds::of(mesh.positions.iter().copied()).radius());
        for (row, noise) in [1e-6, 1e-5, 1e-4, 2e-4].into_iter().enumerate() {
            let mut draws = Draws::of_row(23, row as u64);
            let mut noisy = mesh.clone();
            for position in &mut noisy.positions {
                let by = Vec3::from_array([0; 3].map(|_| draws.between(-1.0, 1.0)));
                *position += by * (noise * size) as f32;
            }
            let found = recover(&noisy).unwrap();
            assert_eq!(found.facets.len(), facets, "{noise}");
            assert!((0.4..1.8).contains(&(found.noise / noise)), "{noise}: {}", found.noise);
        }
    }
}

/// Stones between planes in random directions, without symmetry: those whose facets are wider than rounding come back.
#[test]
fn random_cuts_come_back() {
    for row in 0..24 {
        let mut draws = Draws::of_row(31, row);
        let mut planes = Vec::new();
        for _ in 0..8 + draws.below(40) {
            let normal = DVec3::from_array([0; 3].map(|_| f64::from(draws.between(-1.0, 1.0)))).normalize();
            planes.push(Plane { normal, distance: f64::from(draws.between(0.9, 1.1)) });
        }
        let Some(mesh) = solid::between(&planes, DVec3::ZERO).filter(|mesh| !mesh.indices.is_empty()) else { continue };
        let Some(truth) = planes_of_convex(&mesh) else { continue };
        let rounded = rounded(&mesh, DQuat::IDENTITY, 14);
        let half_step = half_step(&mesh, 14);
        let found = recover(&rounded).unwrap_or_else(|error| panic!("{row}: {error}"));
        let planes: Vec<Plane> = found.facets.iter().map(|facet| facet.plane).collect();
        for (plane, angle) in truth.iter().zip(angles(&truth, &planes)) {
            let on = mesh.positions.iter().map(|point| point.as_dvec3());
            let on: Vec<DVec3> = on.filter(|point| plane.height(*point).abs() < 1e-5).collect();
            let width = width(&on, plane.normal);
            let allowed = (2.0 * half_step / width).to_degrees() + 0.002;
            assert!(width < 16.0 * half_step || angle <= allowed, "{row}: {angle} {allowed}");
        }
        assert!(planes.len() <= truth.len(), "{row}: {} {}", planes.len(), truth.len());
    }
}

#[test]
fn what_is_no_rounded_cut_says_why() {
    let [(_, brilliant), ..] = cuts();
    let change = |edit: &dyn Fn(&mut Mesh)| {
        let mut mesh = rounded(&brilliant, DQuat::IDENTITY, 12);
        edit(&mut mesh);
        recover(&mesh).map(|found| found.facets.len()).map_err(|error| error.to_string())
    };
    assert_eq!(change(&|_| {}), Ok(73));
    let says = |found: Result<usize, String>, start: &str| {
        let message = found.unwrap_err();
        assert!(message.starts_with(start) && !message.contains('\n'), "{message}");
    };
    says(change(&|mesh| mesh.colors = vec![Vec3::ONE; mesh.positions.len()]), "has colours");
    says(change(&|mesh| mesh.positions.iter_mut().for_each(|p| p.y = 0.0)), "is flat");
    says(change(&|mesh| mesh.positions.clear()), "is flat");
    // Inside out, so that the hull is no part of it.
    says(change(&|mesh| mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(0, 1))), "is not convex: 200.0 %");
    let two = |mesh: &mut Mesh| {
        let mut other = mesh.clone();
        other.positions.iter_mut().for_each(|p| *p += 3.0);
        mesh.append(&other);
    };
    says(change(&two), "is not convex: ");
    let bunny = crate::Scene::named("bunny_stone").unwrap().objects.remove(0).mesh;
    says(recover(&bunny).map(|_| 0).map_err(|error| error.to_string()), "is not convex: ");
    let ball = crate::surfaces::sphere(1.0, 200);
    says(recover(&ball).map(|_| 0).map_err(|error| error.to_string()), "has more triangles than a cut stone");
}

/// A stone whose corners were modelled unevenly is none that rounding bent: it keeps its mesh if they turn much of it.
#[test]
fn dents_that_were_modelled_are_no_rounding() {
    let [(_, brilliant), ..] = cuts();
    let size = f64::from(2.0 * Bounds::of(brilliant.positions.iter().copied()).radius());
    let dented = |row, share: f64| {
        let mut draws = Draws::of_row(41, row);
        let mut dented = brilliant.clone();
        for position in &mut dented.positions {
            *position += Vec3::from_array([0; 3].map(|_| draws.between(-1.0, 1.0))) * (share * size) as f32;
        }
        recover(&dented)
    };
    let is_turned = |found: Result<Recovered, NotRecovered>| matches!(found, Err(NotRecovered::Turned { .. }));
    let turned = (0..8).filter(|&row| is_turned(dented(row, 6e-3))).count();
    assert!(turned >= 3, "{turned}");
    // Facets are some .3 of the diameter wide: a thousandth turns them by less than a degree, but those of the girdle.
    for row in 0..8 {
        let found = dented(row, 1e-3);
        assert!(found.is_ok(), "{row}: {found:?}");
    }
}
