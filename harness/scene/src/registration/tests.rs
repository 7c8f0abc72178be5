use super::*;
use crate::Averaging;
use crate::cuts::{BrilliantParameters, StepCutParameters, octahedron, round_brilliant, step_cut};
use crate::normals::Normals;
use crate::surfaces::sphere;
use glam::{DMat4, DQuat, Vec3};

fn cuts() -> [Mesh; 3] {
    let cuts = [
        round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap(),
        step_cut(&StepCutParameters::EMERALD).unwrap(),
        octahedron().unwrap(),
    ];
    cuts.map(|cut| cut.to_mesh(Averaging::Angle))
}

/// A rotation, scale and place for each number, no two alike.
fn transform(number: usize) -> DMat4 {
    let k = number as f64;
    let rotation = DQuat::from_euler(glam::EulerRot::XYZ, 0.7 * k, 1.9 * k + 0.3, 2.3 * k);
    DMat4::from_scale_rotation_translation(
        DVec3::splat(0.3 + 0.1 * (k % 13.0)),
        rotation,
        DVec3::new(5.0 * (k % 7.0) - 15.0, 0.3 * k, 4.0 * (k / 7.0).floor()),
    )
}

fn found(meshes: &[Mesh]) -> Vec<Group> {
    let noise: Vec<f64> = meshes.iter().map(noise).collect();
    let smooth: Vec<bool> = meshes.iter().map(|mesh| Normals::Decided.are_smooth(mesh)).collect();
    groups(&meshes.iter().collect::<Vec<_>>(), &noise, &smooth)
}

/// Largest distance of a group's copies from the meshes that they stand for.
fn error(group: &Group, meshes: &[Mesh]) -> f64 {
    let of_member = |(place, &member): (&Place, &usize)| {
        let copy = group.copies.shape.transformed(place.transform());
        let away = |at: &Vec3| copy.positions.iter().map(|other| at.distance(*other)).fold(f32::MAX, f32::min);
        meshes[member].positions.iter().map(away).fold(0.0, f32::max)
    };
    f64::from(group.copies.places.iter().zip(&group.members).map(of_member).fold(0.0, f32::max))
}

#[test]
fn fifty_three_stones_of_three_cuts_are_three_groups() {
    let cuts = cuts();
    let stones: Vec<Mesh> = (0..53).map(|k| cuts[k % 3].transformed(transform(k))).collect();
    let groups = found(&stones);
    assert_eq!(groups.iter().map(|group| group.members.len()).collect::<Vec<_>>(), [18, 18, 17]);
    for (kind, group) in groups.iter().enumerate() {
        assert!(group.members.iter().all(|member| member % 3 == kind));
        // Coordinates below 32 are rounded by 2^-20 each.
        assert!(error(group, &stones) < 4.0 * 2f64.powi(-20), "{}", error(group, &stones));
    }
}

/// A cut turned over is the same; its mirror image is not, unless it is symmetric.
#[test]
fn mirror_images_are_one_shape_if_they_are_symmetric() {
    let mirrored = |mesh: &Mesh| {
        let mut mesh = mesh.clone();
        mesh.positions.iter_mut().chain(&mut mesh.normals).for_each(|at| at.x = -at.x);
        mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
        mesh
    };
    for cut in cuts() {
        let other = mirrored(&cut).transformed(transform(5));
        assert_eq!(found(&[cut.clone(), other]).len(), 1);
        // With one corner cut off aside, no rotation takes it to its image.
        let mut chiral = cut.clone();
        let at = chiral.positions[0];
        let same: Vec<usize> = (0..chiral.positions.len()).filter(|&k| chiral.positions[k] == at).collect();
        same.iter().for_each(|&k| chiral.positions[k] += Vec3::new(0.01, 0.02, 0.03));
        assert_eq!(found(&[chiral.clone(), chiral.transformed(transform(3))]).len(), 1);
        assert_eq!(found(&[chiral.clone(), mirrored(&chiral).transformed(transform(3))]).len(), 0);
    }
}

#[test]
fn shapes_that_differ_by_more_than_noise_stay_apart() {
    for cut in cuts() {
        let noise = noise(&cut);
        for (factor, alike) in [(0.5, true), (16.0, false)] {
            let mut other = cut.clone();
            let at = other.positions[0];
            let all = other.positions.iter_mut().filter(|position| **position == at);
            all.for_each(|position| *position += (factor * noise) as f32 * Vec3::Y);
            assert_eq!(found(&[cut.clone(), other]).len(), usize::from(alike), "{factor} times the noise");
        }
        let uneven = cut.transformed(DMat4::from_scale(DVec3::new(1.0, 1.0, 1.001)));
        assert!(found(&[cut, uneven]).is_empty());
    }
}

/// Two cubes with the same corners, of which one is dented along a diagonal: another surface.
#[test]
fn the_same_corners_in_another_surface_stay_apart() {
    let middle = |up: f32| {
        let mut mesh = cuts()[2].clone();
        let top =
            (0..mesh.positions.len()).max_by(|&a, &b| mesh.positions[a].y.total_cmp(&mesh.positions[b].y)).unwrap();
        let at = mesh.positions[top];
        mesh.positions.iter_mut().filter(|position| **position == at).for_each(|position| *position = Vec3::Y * up);
        mesh
    };
    assert_eq!(found(&[middle(0.5), middle(0.5)]).len(), 1);
    assert_eq!(found(&[middle(0.5), middle(-0.5)]).len(), 0);
}

/// The facets of a stone cut into triangles otherwise are the same facets.
#[test]
fn another_triangulation_is_the_same_shape() {
    let stone = &cuts()[1];
    let facets = crate::Convex::of_mesh(stone).expect("convex");
    let mut other = stone.clone();
    // Flips the diagonal of the first two triangles of a facet that share an edge.
    let corners = |triangle: usize| [0, 1, 2].map(|k| stone.indices[3 * triangle + k]);
    let pair = (0..stone.triangle_count() - 1).find_map(|k| {
        let ([a, b, c], [d, e, f]) = (corners(k), corners(k + 1));
        (facets.face_of_triangle[k] == facets.face_of_triangle[k + 1] && a == d && c == e).then_some((k, [a, b, c, f]))
    });
    let (k, [a, b, c, d]) = pair.expect("a quadrilateral");
    other.indices[3 * k..3 * k + 6].copy_from_slice(&[a, b, d, b, c, d]);
    assert_eq!(found(&[stone.clone(), other.transformed(transform(4))]).len(), 1);
}

#[test]
fn smooth_bodies_are_one_shape_only_with_the_same_normals() {
    let ball = sphere(1.0, 12);
    let mut other = ball.transformed(DMat4::from_translation(DVec3::splat(3.0)));
    assert_eq!(found(&[ball.clone(), other.clone()]).len(), 1);
    other.normals.iter_mut().for_each(|normal| *normal = (*normal + Vec3::new(0.0, 0.3, 0.0)).normalize());
    assert_eq!(found(&[ball, other]).len(), 0);
}

/// Stones on one lattice, as if packed together with so many bits.
#[test]
fn quantised_stones_are_found_and_their_mean_has_less_noise_than_one() {
    let cut = &cuts()[0];
    for bits in [11, 12, 14, 16] {
        let step = 40.0 / f64::from(1 << bits);
        let rounded = |mesh: &Mesh| {
            let round = |at: &Vec3| ((at.as_dvec3() / step).round() * step).as_vec3();
            Mesh { positions: mesh.positions.iter().map(round).collect(), ..mesh.clone() }
        };
        let exact: Vec<Mesh> = (0..24)
            .map(|k| {
                let at = DVec3::new(5.0 * f64::from(k % 6), 0.2 * f64::from(k), 5.0 * f64::from(k / 6));
                let turn = DQuat::from_euler(glam::EulerRot::XYZ, f64::from(k), 0.3 * f64::from(k), 0.0);
                cut.transformed(DMat4::from_scale_rotation_translation(DVec3::splat(1.0), turn, at))
            })
            .collect();
        let all: Vec<Mesh> = exact.iter().map(rounded).collect();
        let noise_of_all = {
            let mut joined = Mesh::default();
            all.iter().for_each(|mesh| joined.append(mesh));
            noise(&joined)
        };
        let expected = 0.5 * 3f64.sqrt() * step;
        assert!((noise_of_all / expected - 1.0).abs() < 0.01, "{bits} bits: {noise_of_all}, not {expected}");
        let groups = groups(&all.iter().collect::<Vec<_>>(), &vec![noise_of_all; all.len()], &vec![false; all.len()]);
        assert_eq!(groups.iter().map(|group| group.members.len()).collect::<Vec<_>>(), [24], "{bits} bits");
        // Root mean squares: the rounding of one stone is a twelfth of a step squared along each axis. The mean of 24 has the
        // 24th part of it; of each copy's place, and of the first one's, 7 numbers come from 3 of each corner.
        let corners = crate::normals::weld(&cut.positions).1 as f64;
        let expected = (3.0 / 12.0 * step * step * (1.0 / 24.0 + 2.0 * 7.0 / (3.0 * corners))).sqrt();
        let found = root_mean_square(&groups[0], &exact);
        assert!(found < 1.1 * expected && found < 0.4 * 0.5 * step, "{bits} bits: {found}, not {expected}");
    }
}

/// Root mean square of the distances of a group's copies from what they stand for.
fn root_mean_square(group: &Group, exact: &[Mesh]) -> f64 {
    let pairs = group.copies.places.iter().zip(&group.members).flat_map(|(place, &member)| {
        let copy = group.copies.shape.transformed(place.transform());
        let away =
            move |at: &Vec3| copy.positions.iter().map(|other| at.distance_squared(*other)).fold(f32::MAX, f32::min);
        exact[member].positions.iter().map(away)
    });
    let squares: Vec<f64> = pairs.map(f64::from).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn a_stone_of_its_own_proportions_lies_on_no_lattice() {
    for cut in cuts() {
        let largest = cut.positions.iter().map(|at| f64::from(at.abs().max_element())).fold(0.0, f64::max);
        assert!(noise(&cut) <= 1.01 * largest / f64::from(1 << 22), "{}", noise(&cut) / largest);
    }
}

#[test]
fn hostile_meshes_take_bounded_time() {
    let ball = sphere(1.0, 120);
    let other = ball.transformed(transform(2));
    let begun = std::time::Instant::now();
    let _ = found(&[ball.clone(), other, ball]);
    let flat = Mesh {
        positions: vec![Vec3::ZERO; 9],
        normals: vec![Vec3::Y; 9],
        indices: (0..9).collect(),
        ..Mesh::default()
    };
    let nan = Mesh { positions: vec![Vec3::NAN; 9], ..flat.clone() };
    assert!(found(&[flat.clone(), flat, nan.clone(), nan, Mesh::default()]).is_empty());
    assert!(begun.elapsed().as_secs_f64() < 10.0, "{:?}", begun.elapsed());
}
