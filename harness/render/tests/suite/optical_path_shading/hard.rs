//! Bodies, lights and media that are difficult for a voxel renderer.

use super::{RADIUS, apart, ball, coarse, covered, draw, lamp, scene, settings, spot, stone, sun};
use glam::{BVec3, DQuat, DVec3, UVec3, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_plan::Note;
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_render::voxelization;
use lapidary_render::{OpticalPathOptions, Picture, Settings};
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Averaging, Bounds, Light, Mesh, Scene};
use lapidary_testing::pixels::on_the_ball;
use std::f64::consts::PI;

fn is_black(picture: &Picture) -> bool {
    picture.linear.iter().all(|pixel| pixel[..3] == [0.0; 3])
}

fn cuboid(half: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let first = mesh.positions.len() as u32;
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            for corner in 0..4 {
                let mut place = Vec3::ZERO;
                place[axis] = side * half[axis];
                place[u] = if corner & 1 == 1 { half[u] } else { -half[u] };
                place[v] = if corner & 2 == 2 { half[v] } else { -half[v] };
                mesh.positions.push(place);
                mesh.normals.push(side * Vec3::AXES[axis]);
            }
            let order = if side > 0.0 { [0, 1, 2, 2, 1, 3] } else { [0, 2, 1, 1, 2, 3] };
            mesh.indices.extend(order.map(|corner| first + corner));
        }
    }
    mesh
}

fn inside_out(mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
    mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
    mesh
}

#[test]
fn a_lamp_buried_in_a_solid_body_lights_nothing() {
    for position in [Vec3::ZERO, Vec3::new(1.0, 9.0, 0.5), Vec3::new(0.0, 9.999, 0.0)] {
        let picture = draw(&ball(1.0, vec![Light::Point { position, intensity: Vec3::splat(100.0) }]), &coarse());
        assert!(covered("buried", &picture) > 1000 && is_black(&picture), "{position}");
        let both = draw(&ball(1.0, vec![Light::Point { position, intensity: Vec3::ONE }, sun()]), &coarse());
        assert!(covered("buried, and a sun", &both) > 1000 && !is_black(&both), "{position}");
    }
}

/// A lamp on the surface is as near as possible: distances of 0, and the largest possible
/// irradiance.
#[test]
fn lamps_on_the_surface_and_beyond_all_measure_stay_finite() {
    let places = [Vec3::Y * 10.0, Vec3::Y * 10.0001, Vec3::Y * 1e6];
    for position in places {
        for intensity in [0.0, 1e-30, 1.0, 1e20] {
            let picture =
                draw(&ball(1.0, vec![Light::Point { position, intensity: Vec3::splat(intensity) }]), &coarse());
            assert!(covered(&format!("a lamp of {intensity} at {position}"), &picture) > 1000);
        }
    }
}

/// A shell between two spheres with a lamp at its centre: uniform light, attenuated by the shell.
#[test]
fn a_hollow_ball_glows_from_inside() {
    let (inner, extinction) = (6.0, 0.5f32);
    let mut mesh = sphere(RADIUS, 256);
    mesh.append(&inside_out(&sphere(inner, 192)));
    let intensity = 100.0;
    let light = Light::Point { position: Vec3::ZERO, intensity: Vec3::splat(intensity) };
    let scene = scene(vec![stone("shell", mesh, Vec3::splat(extinction))], vec![light]);
    let picture = draw(&scene, &settings("godunov-64"));
    let wanted = f64::from(intensity) / (inner * inner) * (-f64::from(extinction) * (RADIUS - inner)).exp();
    let (mut squares, mut worst) = (0.0, 0.0f64);
    let pixels = on_the_ball(&scene, &picture);
    for (_, found) in &pixels {
        let off = (PI * found.x / wanted).ln();
        squares += off * off;
        worst = larger(worst, off.abs());
    }
    let rms = (squares / pixels.len() as f64).sqrt();
    println!("rms {rms:.3} nats, {worst:.3} at most");
    // Two optical depths; a voxel is 0.16.
    assert!(rms < 0.1 && worst < 0.3, "{rms} {worst}");
    assert!(picture.notes.is_empty(), "{:?}", picture.notes);
}

#[test]
fn light_that_grazes_everywhere_lights_nothing() {
    let mut scene = ball(1.0, vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::ONE }]);
    scene.objects[0].mesh.normals.fill(Vec3::X);
    let picture = draw(&scene, &coarse());
    assert!(covered("grazing", &picture) > 1000 && is_black(&picture));
    // Normals of length zero leave every pixel finite and not negative.
    scene.objects[0].mesh.normals.fill(Vec3::ZERO);
    assert!(covered("no normals", &draw(&scene, &coarse())) > 1000);
}

#[test]
fn extinctions_of_every_size_have_their_limit() {
    let radiances = |extinction_scale: f32| {
        let scene = ball(8.0, vec![sun()]);
        let picture =
            draw(&scene, &Settings { optical_path: OpticalPathOptions { extinction_scale }, ..settings("godunov-32") });
        assert!(covered(&format!("{extinction_scale}"), &picture) > 5000);
        on_the_ball(&scene, &picture)
    };
    // No loss: all is as bright as the brightest voxel.
    for scale in [0.0, 1e-8] {
        for (_, found) in radiances(scale) {
            assert!((PI * found.x / 2.0 - 1.0).abs() < 1e-3, "{scale}: {found}");
        }
    }
    // No transmission: Lambert's law.
    let toward = Vec3::new(-0.8, 0.6, 0.0).as_dvec3();
    for scale in [1e8, 1e30, f32::MAX] {
        for (position, found) in radiances(scale) {
            let wanted = 2.0 * (position / RADIUS).dot(toward).max(0.0);
            assert!((PI * found.x - wanted).abs() < 3e-3, "{scale}: {found} {wanted}");
        }
    }
}

/// Checks bodies that fill the grid, are rotated, or lie far away, with 16 to 256 voxels a side.
#[test]
fn a_body_leaves_the_grids_outermost_voxels_free() {
    let mut solid = 0;
    let gpu = lapidary_testing::gpu();
    let turned = cuboid(Vec3::ONE).placed(DQuat::from_rotation_y(0.5), DVec3::ZERO);
    for mesh in [cuboid(Vec3::new(3.0, 3.0, 3.0)), turned, cuboid(Vec3::new(0.1, 7.0, 0.02)), sphere(1.0, 64)] {
        for (cells, offset) in [(16, 0.0), (40, 1.0), (64, 1000.0), (128, -0.3), (256, 30_000.0)] {
            let mesh = mesh.placed(DQuat::IDENTITY, DVec3::splat(offset));
            let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), cells);
            // Voxels that only the surface touches may be outermost by rounding: a face lies on
            // their border.
            let effects = [("EFFECT_SURFACE", 0.0)];
            let matter = voxelization::matter(gpu, grid, &mesh, &effects).expect("made");
            let mut filled = 0;
            for index in 0..grid.count() {
                let UVec3 { x, y, z } = grid.voxel(index);
                let word = matter[(grid.words_per_row() * (y + cells * z) + x / 32) as usize];
                if word >> (x % 32) & 1 == 1 {
                    filled += 1;
                    let free = [x, y, z].map(|place| (1..cells - 1).contains(&place));
                    assert!(BVec3::from_array(free).all(), "{cells} voxels at {offset}: voxel ({x}, {y}, {z})");
                }
            }
            solid += filled;
        }
    }
    assert!(solid > 10_000, "{solid}");
}

/// A body far from the world's origin looks the same as at the origin.
#[test]
fn a_body_that_stands_far_away_looks_the_same() {
    let lit = |offset: Vec3| {
        let mut object = stone("box", cuboid(Vec3::new(10.0, 4.0, 6.0)), Vec3::splat(0.2));
        object.mesh = object.mesh.placed(DQuat::IDENTITY, offset.as_dvec3());
        let light = Light::Directional { toward: Vec3::new(-0.6, 0.8, 0.0), irradiance: Vec3::ONE };
        draw(&scene(vec![object], vec![light]).seen_from(70.0, 40.0), &coarse())
    };
    let (near, far) = (lit(Vec3::ZERO), lit(Vec3::new(1024.0, -512.0, 256.0)));
    let pairs = near.linear.iter().zip(&far.linear).filter(|(near, far)| near[3] == 1.0 && far[3] == 1.0);
    let off: Vec<f32> = pairs.map(|(near, far)| (far[0] / near[0] - 1.0).abs()).collect();
    let many = off.iter().filter(|off| **off > 0.02).count();
    println!("{many} of {} pixels differ by more than 2 %", off.len());
    assert!(off.len() > 1000 && many < off.len() / 50, "{many} of {}", off.len());
}

/// A plate of a sixth of a voxel: its dark side is lit through it.
#[test]
fn light_passes_a_plate_thinner_than_a_voxel() {
    let extinction = 0.5;
    for (axis, rotation) in [("z", DQuat::IDENTITY), ("slant", DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.3, 0.2))] {
        let mesh = cuboid(Vec3::new(10.0, 10.0, 0.05)).placed(rotation, DVec3::ZERO);
        let away = (rotation * DVec3::NEG_Z).as_vec3();
        let light = Light::Directional { toward: away, irradiance: Vec3::ONE };
        let scene = scene(vec![stone("plate", mesh, Vec3::splat(extinction))], vec![light]).seen_from(85.0, 5.0);
        let picture = draw(&scene, &settings("godunov-32"));
        assert!(covered(axis, &picture) > 5000);
        let bright = picture.linear.iter().filter(|pixel| pixel[3] == 1.0).map(|pixel| pixel[0] * PI as f32);
        let [least, most] =
            bright.fold([f32::INFINITY, 0.0], |[least, most], value| [least.min(value), most.max(value)]);
        println!("{axis}: {least:.3} to {most:.3} through the plate");
        // The shortest way is the plate's thickness. The longest is from the lit side to a voxel's
        // centre and back: at most a voxel's diagonal, for voxels of 0.58 to 0.67.
        assert!(
            most <= (-extinction * 0.1).exp() * 1.001 && least > (-extinction * 1.2).exp(),
            "{axis}: {least} {most}"
        );
    }
}

#[test]
fn a_mesh_of_nothing_is_a_picture_of_nothing() {
    let nothing = stone("nothing", Mesh::default(), Vec3::ONE);
    let picture = draw(&scene(vec![nothing.clone()], vec![sun(), lamp(), spot()]), &coarse());
    assert_eq!(covered("nothing", &picture), 0);
    let alone = draw(&scene(Vec::new(), vec![sun()]), &coarse());
    assert_eq!(covered("nobody", &alone), 0);
    // Neither an empty mesh nor vertices without triangles change another body.
    let mut points = nothing.clone();
    points.mesh.positions = vec![Vec3::ONE; 3];
    points.mesh.normals = vec![Vec3::X; 3];
    let one = ball(4.0, vec![sun()]);
    let mut three = one.clone();
    three.objects.extend([nothing, points]);
    // The costs of this rung are the same to the bit in every run.
    let settings = Settings { rung: "tiled-26-32".parse().expect("a rung"), ..coarse() };
    assert!(draw(&three, &settings).linear == draw(&one, &settings).linear);
}

/// Checks a triangle without area, and one that is a single point.
#[test]
fn broken_triangles_break_nothing_else() {
    let one = ball(4.0, vec![sun()]);
    let mut broken = one.clone();
    let mesh = &mut broken.objects[0].mesh;
    let [a, b] = [mesh.indices[0], mesh.indices[600]];
    mesh.indices.extend([a, b, a, b, b, b]);
    let (one, broken) = (draw(&one, &coarse()), draw(&broken, &coarse()));
    assert!(covered("broken", &broken) > 1000);
    assert!(apart(&broken, &one) < 1e-3);
}

/// The small body's voxels are a fifteenth of the large one's, and both share a shadow map.
#[test]
fn a_small_body_beside_a_large_one_is_lit_all_over() {
    let mut small = stone("small", sphere(0.7, 128), Vec3::splat(6.0));
    small.mesh = small.mesh.placed(DQuat::IDENTITY, DVec3::new(12.0, 0.0, 0.0));
    let large = stone("large", sphere(RADIUS, 128), Vec3::splat(1.0));
    let light = Light::Directional { toward: Vec3::new(0.3, 0.9, 0.3).normalize(), irradiance: Vec3::ONE };
    let alone = scene(vec![small.clone()], vec![light]);
    let both = Scene { objects: vec![small, large], ..alone.clone() };
    let [alone, both] = [alone, both].map(|scene| draw(&scene, &settings("godunov-64")));
    // Nothing is in front of the small body: it is the first that the camera sees.
    let pairs = alone.linear.iter().zip(&both.linear).filter(|(pixel, _)| pixel[3] == 1.0);
    let (mut squares, mut count) = (0.0, 0);
    for (alone, both) in pairs {
        squares += f64::from((both[0] / alone[0]).ln()).powi(2);
        count += 1;
    }
    let rms = (squares / f64::from(count)).sqrt();
    println!("{count} pixels, {rms:.3} nats");
    // Voxels without a seeding texel are reached from others, and cost up to a voxel's 0.13 nats
    // more.
    assert!(count > 3000 && rms < 0.05, "{count} {rms}");
}

#[test]
fn a_body_in_anothers_shadow_stays_black() {
    let mut behind = stone("behind", sphere(6.0, 128), Vec3::splat(1e-3));
    behind.mesh = behind.mesh.placed(DQuat::IDENTITY, DVec3::new(20.0, 0.0, 0.0));
    let before = stone("before", sphere(RADIUS, 128), Vec3::splat(1e-3));
    let light = |position: f32| Light::Directional { toward: Vec3::new(position, 0.0, 0.0), irradiance: Vec3::ONE };
    let lamp = Light::Point { position: Vec3::new(-30.0, 0.0, 0.0), intensity: Vec3::splat(900.0) };
    let brightest = |picture: &Picture, right: bool| {
        let halves = picture.linear.iter().enumerate().filter(|(place, pixel)| {
            let column = *place as u32 % picture.width;
            pixel[3] == 1.0 && (column >= picture.width * 7 / 10) == right
        });
        halves.map(|(_, pixel)| pixel[0]).fold(0.0, larger)
    };
    for light in [light(-1.0), lamp] {
        let scene = scene(vec![before.clone(), behind.clone()], vec![light]).seen_from(90.0, 0.0);
        let picture = draw(&scene, &coarse());
        covered("two", &picture);
        assert!(brightest(&picture, false) > 0.3, "{light:?}");
        // In grazing light, the front body rises out of the tangent plane of the other by less than
        // the shadow bias of a texel, plus the offset of the looked-up texels, another texel. Each
        // is about 0.33 wide, at a distance of 20. At most that share of the light remains.
        let leak = brightest(&picture, true);
        println!("in the shadow at most {leak:.1e}");
        assert!(leak <= 0.66 / 20.0 / PI as f32, "{light:?}: {leak}");
        let (mut black, mut other) = (0, 0);
        for (place, pixel) in picture.linear.iter().enumerate().filter(|(_, pixel)| pixel[3] == 1.0) {
            if place as u32 % picture.width >= picture.width * 7 / 10 {
                if pixel[0] == 0.0 { black += 1 } else { other += 1 }
            }
        }
        assert!(black > 10 * other && black > 100, "{light:?}: {black} black, {other} not");
    }
    // From the other side both are lit: almost no light is lost inside.
    let scene = scene(vec![before, behind], vec![light(1.0)]).seen_from(90.0, 0.0);
    let picture = draw(&scene, &coarse());
    assert!(brightest(&picture, true) > 0.3 && brightest(&picture, false) > 0.2);
}

/// Returns the closed bunny, the bunny with a hole, and the hole's centre: the farthest point to a
/// side. A ball of this radius about it cuts the hole.
fn open_bunny(side: Vec3, radius: f32) -> (Scene, Scene, Vec3) {
    let closed = Scene::named("bunny").expect("built in");
    let mut open = closed.clone();
    let mesh = &mut open.objects[0].mesh;
    let farthest = |a: &&Vec3, b: &&Vec3| a.dot(side).total_cmp(&b.dot(side));
    let middle = *mesh.positions.iter().max_by(farthest).expect("a vertex");
    let near =
        |triangle: &[u32]| triangle.iter().any(|corner| mesh.positions[*corner as usize].distance(middle) < radius);
    let kept: Vec<u32> = mesh.indices.chunks_exact(3).filter(|triangle| !near(triangle)).flatten().copied().collect();
    assert!(kept.len() < mesh.indices.len());
    mesh.indices = kept;
    (closed, open, middle)
}

#[test]
fn a_hole_in_the_bunny_leaves_no_streaks() {
    for side in [Vec3::X, Vec3::NEG_Z] {
        let (closed, open, middle) = open_bunny(side, 5.0);
        let settings =
            Settings { optical_path: OpticalPathOptions { extinction_scale: 0.05 }, ..settings("godunov-64") };
        let (whole, holed) = (draw(&closed, &settings), draw(&open, &settings));
        covered("holed", &holed);
        assert!(whole.notes.is_empty(), "{:?}", whole.notes);
        let [Note::Open { odd_columns, columns, .. }] = &holed.notes[..] else { panic!("{:?}", holed.notes) };
        assert!(*odd_columns > 10 && columns / odd_columns > 10, "{odd_columns} of {columns}");
        // The hole may show within three of its radii.
        let to_clip = lapidary_scene::clip_from_world(&open, whole.width, whole.height);
        let on_screen = |point: Vec3| {
            let clip = to_clip.project_point3(point);
            0.5 * whole.width as f32 * (clip.truncate() * glam::Vec2::new(1.0, -1.0) + 1.0)
        };
        let hole = on_screen(middle);
        let reach = 3.0 * on_screen(middle + 5.0 * Vec3::Y).distance(hole);
        let (mut seen, mut changed, mut brightest) = (0, 0, 0.0f32);
        for (index, (holed, whole)) in (0..).zip(holed.linear.iter().zip(&whole.linear)) {
            let (column, row): (u32, u32) = (index % 160, index / 160);
            let place = glam::Vec2::new(column as f32, row as f32) + 0.5;
            if place.distance(hole) > reach && whole[3] == 1.0 && holed[3] == 1.0 {
                seen += 1;
                changed += i32::from((holed[1] - whole[1]).abs() > 0.1 * whole[1]);
                brightest = larger(brightest, holed[1] - whole[1]);
            }
        }
        println!(
            "{side}: {odd_columns} odd columns; {changed} of {seen} pixels change by a tenth, brighter by {brightest:.3} at most"
        );
        assert!(seen > 4000 && changed < seen / 50, "{side}: {changed} of {seen}");
        assert!(brightest < 0.05, "{side}: {brightest}");
    }
}

/// Returns a tube of this radius about a path, closed at its ends.
fn tube(path: impl Fn(f64) -> DVec3, radius: f64, rings: u32) -> Mesh {
    const SIDES: u32 = 12;
    let mut positions = Vec::new();
    for ring in 0..=rings {
        let along = |offset: f64| path((f64::from(ring) + offset) / f64::from(rings));
        let tangent = (along(1e-3) - along(-1e-3)).normalize();
        let right = tangent.cross(DVec3::Y).normalize();
        let up = right.cross(tangent);
        for side in 0..SIDES {
            let (sine, cosine) = (2.0 * PI * f64::from(side) / f64::from(SIDES)).sin_cos();
            positions.push((along(0.0) + radius * (cosine * right + sine * up)).as_vec3());
        }
    }
    let mut indices = Vec::new();
    for ring in 0..rings {
        for side in 0..SIDES {
            let next = (side + 1) % SIDES;
            let [a, b] = [ring, ring + 1].map(|ring| SIDES * ring + side);
            let [c, d] = [ring, ring + 1].map(|ring| SIDES * ring + next);
            indices.extend([a, b, c, c, b, d]);
        }
    }
    for side in 1..SIDES - 1 {
        let last = SIDES * rings;
        indices.extend([0, side, side + 1, last, last + side + 1, last + side]);
    }
    let mesh = Mesh::with_shared_normals(positions, indices, Averaging::default());
    if mesh.volume_and_area().0 > 0.0 { mesh } else { inside_out(&mesh) }
}

/// Radius of the spring, radius of its tube, and pitch.
const SPRING: [f64; 3] = [26.0, 2.2, 8.0];

/// Returns a spring about the y axis, lit from above only near its upper end, and its path.
fn spring(turns: f64, extinction: f32) -> (Scene, impl Fn(f64) -> DVec3) {
    let [radius, thickness, pitch] = SPRING;
    let path = move |share: f64| {
        let (sine, cosine) = (2.0 * PI * turns * share).sin_cos();
        DVec3::new(radius * cosine, pitch * turns * share, radius * sine)
    };
    let lit = path(lit_share(turns)).as_vec3();
    let light = Light::Spot {
        position: lit + 100.0 * Vec3::Y,
        direction: Vec3::NEG_Y,
        // Irradiance 1 at the top of the tube.
        intensity: Vec3::splat((100.0 - thickness as f32).powi(2)),
        inner_angle: 0.005,
        outer_angle: 0.01,
    };
    let body = stone("spring", tube(path, thickness, (64.0 * turns) as u32), Vec3::splat(extinction));
    (scene(vec![body], vec![light]).seen_from(75.0, 10.0), path)
}

/// Returns the position of the light along the spring, from 0 to 1.
fn lit_share(turns: f64) -> f64 {
    1.0 - 0.05 / turns
}

#[test]
fn a_spring_that_winds_on_says_how_far_off_its_picture_is() {
    if !lapidary_testing::on_lavapipe("the passes that a frame takes depend on the order of tiles") {
        return;
    }
    let (turns, extinction) = (7.0, 0.01f32);
    let [radius, thickness, pitch] = SPRING;
    let (scene, path) = spring(turns, extinction);
    let picture = draw(&scene, &coarse_of(64));
    covered("spring", &picture);
    let [Note::StoppedEarly { object, bound }] = &picture.notes[..] else { panic!("{:?}", picture.notes) };
    assert!(object == "spring" && *bound > 0.0 && *bound < 0.1, "{bound}");

    // The position of each pixel along the spring, and the light that the longest and the shortest
    // way through the tube would leave for it.
    let samples: Vec<DVec3> = (0..2000).map(|k| path(f64::from(k) / 2000.0)).collect();
    let nearest = |point: DVec3| {
        let distances = samples.iter().map(|sample| sample.distance_squared(point)).enumerate();
        distances.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, squared)| (k as f64 / 2000.0, squared.sqrt()))
    };
    let eye = scene.camera.eye.as_dvec3();
    let turn = (2.0 * PI * radius).hypot(pitch);
    let (mut black, mut right) = (0, 0);
    for (direction, pixel) in
        lapidary_testing::pixels::rays(&scene, &picture).into_iter().filter(|(_, pixel)| pixel[3] == 1.0)
    {
        // The mesh's tube has twelve sides: pixels between its inscribed and circumscribed circles
        // are skipped.
        let hits = [1.0, (PI / 12.0).cos()].map(|inscribed| {
            let mut along = eye.length() - 70.0;
            (0..60).find_map(|_| {
                let (share, distance) = nearest(eye + along * direction)?;
                let free = distance - inscribed * thickness;
                along += free;
                (free < 0.02).then_some(share)
            })
        });
        let [Some(share), Some(inner)] = hits else { continue };
        if (share - inner).abs() > 0.01 {
            continue;
        }
        let length = turn * turns * (lit_share(turns) - share).abs();
        let light = |length: f64| (-f64::from(extinction) * length).exp() / PI;
        // The longest way is along the outer wall, with the solver's own excess and the way across.
        // The shortest is along the inner wall, less its ends, which are near the light.
        let least = light(1.1 * length * (radius + thickness) / radius + 15.0);
        let most = light((length - 8.0).max(0.0) * (radius - thickness) / radius);
        let found = f64::from(pixel[0]);
        assert!(found <= 1.02 * most, "{found} at {length} from the light, at most {most}");
        assert!(found + f64::from(*bound) >= least, "{found} at {length} from the light, at least {least}");
        black += i32::from(found == 0.0);
        right += i32::from(found >= least);
    }
    println!("bound {bound:.1e}; {black} pixels that no path reached, {right} that are right");
    assert!(black > 50 && right > 50, "{black} {right}");

    // Two turns are within the granted passes.
    let picture = draw(&spring(2.0, extinction).0, &coarse_of(64));
    assert!(picture.notes.is_empty() && !is_black(&picture), "{:?}", picture.notes);
}

fn coarse_of(cells: u32) -> Settings {
    Settings { width: 96, height: 96, ..settings(&format!("godunov-{cells}")) }
}
