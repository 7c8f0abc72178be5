use std::collections::HashMap;

use glam::{DVec2, Vec2, Vec3};

use super::*;
use lapidary_scene::{Averaging, Scene};

/// Number of texels along a side of the square in which drawings are compared.
const SIDE: usize = 1024;

fn mesh_of(scene: &str) -> Mesh {
    Scene::named(scene).unwrap().objects.remove(0).mesh
}

/// Builds three turns of a spiral staircase without steps: all of it faces up, and hides the turns
/// below.
fn spiral() -> Mesh {
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for k in 0..=120u32 {
        let angle = k as f32 / 40.0 * std::f32::consts::TAU;
        let across = Vec3::new(angle.cos(), 0.0, -angle.sin());
        let height = 0.2 * angle / std::f32::consts::TAU * Vec3::Y;
        positions.extend([0.3 * across + height, across + height]);
        if k > 0 {
            let [a, b, c, d] = [2 * k - 2, 2 * k - 1, 2 * k, 2 * k + 1];
            indices.extend([a, b, c, c, b, d]);
        }
    }
    Mesh::with_shared_normals(positions, indices, Averaging::Angle)
}

/// Returns the number of each triangle's chart: triangles that share a point of the drawing are in
/// one.
fn chart_numbers(mesh: &Mesh) -> Vec<usize> {
    let mut first_at = HashMap::new();
    let points: Vec<usize> = mesh
        .uvs
        .iter()
        .enumerate()
        .map(|(vertex, uv)| *first_at.entry(uv.to_array().map(f32::to_bits)).or_insert(vertex))
        .collect();
    let mut numbers: Vec<usize> = (0..points.len()).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for triangle in mesh.indices.chunks_exact(3) {
            let corners = corners_of(&points, triangle);
            let least = corners.map(|point| numbers[point]).into_iter().min().unwrap();
            for point in corners {
                changed |= std::mem::replace(&mut numbers[point], least) != least;
            }
        }
    }
    mesh.indices.chunks_exact(3).map(|triangle| numbers[points[triangle[0] as usize]]).collect()
}

fn corners_of<T: Copy>(list: &[T], triangle: &[u32]) -> [T; 3] {
    [0, 1, 2].map(|k| list[triangle[k] as usize])
}

/// Returns, for each texel, the charts of the triangles that contain its centre. A centre on an
/// edge belongs to one side only.
fn drawn(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut texels = vec![Vec::new(); SIDE * SIDE];
    for (triangle, chart) in mesh.indices.chunks_exact(3).zip(chart_numbers(mesh)) {
        let corners = corners_of(&mesh.uvs, triangle).map(|uv| uv.as_dvec2() * SIDE as f64);
        let [a, b, c] = corners;
        let (lower, upper) = (a.min(b).min(c).floor().as_usizevec2(), a.max(b).max(c).ceil().as_usizevec2());
        for y in lower.y..upper.y {
            for x in lower.x..upper.x {
                let middle = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let inside = [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
                    // From the lesser end, so that both sides of an edge compute the same number.
                    let flipped = (from.y, from.x) > (to.y, to.x);
                    let (low, high) = if flipped { (to, from) } else { (from, to) };
                    let side = (high - low).perp_dot(middle - low);
                    if flipped { side > 0.0 } else { side <= 0.0 }
                });
                if inside {
                    texels[y * SIDE + x].push(chart);
                }
            }
        }
    }
    texels
}

/// Asserts all guarantees of [`unwrap`], and returns the used fraction of the square, halos
/// included.
fn check(name: &str, mesh: &Mesh, halo: f32) -> f64 {
    let unwrapped = unwrap(mesh, halo);
    assert_eq!(unwrapped.triangle_count(), mesh.triangle_count());
    assert_eq!(unwrapped.uvs.len(), unwrapped.positions.len());
    assert_eq!(unwrapped.normals.len(), unwrapped.positions.len());
    assert!(unwrapped.uvs.iter().all(|uv| uv.min_element() >= 0.0 && uv.max_element() <= 1.0));
    for (before, after) in mesh.indices.chunks_exact(3).zip(unwrapped.indices.chunks_exact(3)) {
        assert_eq!(corners_of(&mesh.positions, before), corners_of(&unwrapped.positions, after));
        assert_eq!(corners_of(&mesh.normals, before), corners_of(&unwrapped.normals, after));
    }
    check_halo(name, &unwrapped, halo);
    let whole = with_halo_drawn(&unwrapped);
    check_scale(&whole);
    let texels = drawn(&whole);
    assert!(texels.iter().all(|charts| charts.len() <= 1), "{name}: a texel is drawn twice");
    check_gutters(name, &texels);
    texels.iter().filter(|charts| !charts.is_empty()).count() as f64 / (SIDE * SIDE) as f64
}

/// Returns the mesh with the halo's triangles as its own, after all others.
fn with_halo_drawn(mesh: &Mesh) -> Mesh {
    Mesh { indices: [&mesh.indices[..], &mesh.halo].concat(), halo: Vec::new(), ..mesh.clone() }
}

/// Asserts that each triangle of a halo is a second copy of one in another chart, and no farther
/// from the chart that it surrounds than allowed.
fn check_halo(name: &str, mesh: &Mesh, halo: f32) {
    let numbers = chart_numbers(&with_halo_drawn(mesh));
    let (charted, about) = numbers.split_at(mesh.triangle_count());
    let parts = |triangle: &[u32]| {
        [corners_of(&mesh.positions, triangle), corners_of(&mesh.normals, triangle)]
            .map(|part| part.map(|vector| vector.to_array().map(f32::to_bits)))
    };
    let mut charts_of: HashMap<_, Vec<usize>> = HashMap::new();
    let mut corners: HashMap<usize, Vec<Vec3>> = HashMap::new();
    for (triangle, &chart) in mesh.indices.chunks_exact(3).zip(charted) {
        charts_of.entry(parts(triangle)).or_default().push(chart);
        corners.entry(chart).or_default().extend(corners_of(&mesh.positions, triangle));
    }
    for (triangle, &chart) in mesh.halo.chunks_exact(3).zip(about) {
        assert!(charts_of[&parts(triangle)].iter().any(|&other| other != chart), "{name}: {triangle:?}");
        // The distance along edges is at least as large; sums are rounded.
        let nearest =
            |position: Vec3| corners[&chart].iter().map(|&p| p.distance(position)).fold(f32::INFINITY, f32::min);
        assert!(corners_of(&mesh.positions, triangle).into_iter().all(|p| nearest(p) <= halo * 1.00001), "{name}");
    }
}

/// Seen along an axis, a triangle keeps its length in one direction and is shortened in the other:
/// the larger singular value of its map into the square is the scale, and the smaller one the scale
/// times a cosine.
fn check_scale(mesh: &Mesh) {
    let maps = mesh.indices.chunks_exact(3).map(|triangle| {
        let [a, b, c] = corners_of(&mesh.positions, triangle).map(Vec3::as_dvec3);
        let [p, q, r] = corners_of(&mesh.uvs, triangle).map(Vec2::as_dvec2);
        // Clockwise with v down.
        assert!((q - p).perp_dot(r - p) < 0.0);
        let along = (b - a).normalize();
        let across = (c - a).reject_from_normalized(along);
        let first = (q - p) / (b - a).length();
        let second = (r - p - first * along.dot(c - a)) / across.length();
        let (sum, product) = (first.length_squared() + second.length_squared(), first.perp_dot(second).abs());
        let larger = (0.5 * (sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt())).sqrt();
        (larger, product / larger)
    });
    let maps: Vec<(f64, f64)> = maps.collect();
    let scale = maps[0].0;
    for (larger, smaller) in maps {
        assert!((larger / scale - 1.0).abs() < 1e-3, "{larger}, {scale}");
        assert!(smaller / scale > charts::surface::LEAST_COSINE - 1e-3, "{smaller}, {scale}");
    }
}

/// Any two texels less than 8 apart lie in a square of 8 by 8; none of these contains two charts,
/// not even across the borders of the texture.
fn check_gutters(name: &str, texels: &[Vec<usize>]) {
    const GAP: usize = 8;
    let numbers: Vec<Option<usize>> = texels.iter().map(|charts| charts.first().copied()).collect();
    // The least and largest number of each row of 8 texels.
    let row = |y: usize, x: usize| {
        let numbers = (0..GAP).filter_map(|k| numbers[y * SIDE + (x + k) % SIDE]);
        numbers.fold(None, |range: Option<(usize, usize)>, number| {
            Some(range.map_or((number, number), |(least, most)| (least.min(number), most.max(number))))
        })
    };
    let rows: Vec<Option<(usize, usize)>> = (0..SIDE * SIDE).map(|k| row(k / SIDE, k % SIDE)).collect();
    for y in 0..SIDE {
        for x in 0..SIDE {
            let mut ranges = (0..GAP).filter_map(|k| rows[(y + k) % SIDE * SIDE + x]);
            if let Some((first, _)) = ranges.clone().next() {
                assert!(ranges.all(|range| range == (first, first)), "{name}: two charts near texel {x}, {y}");
            }
        }
    }
}

#[test]
fn the_bunny_is_drawn_once_in_few_charts_that_fill_half_the_square() {
    let mesh = mesh_of("bunny_stone");
    let start = std::time::Instant::now();
    let count = charts::charts(&mesh, 0.0).len();
    println!("{count} charts in {:?}", start.elapsed());
    let unwrapped = unwrap(&mesh, 0.0);
    println!(
        "{} vertices of {} in {:?} with packing",
        unwrapped.positions.len(),
        mesh.positions.len(),
        start.elapsed()
    );
    let used = check("bunny", &mesh, 0.0);
    println!("{:.1} % of the square used", 100.0 * used);
    assert!(count <= 12 && used > 0.5, "{count} charts, {used}");
}

#[test]
fn stones_are_drawn_once() {
    for name in ["octahedron", "brilliant", "brilliant_sliver", "prism_chain", "skin_ring"] {
        let used = check(name, &mesh_of(name), 0.0);
        println!("{name}: {:.1} % of the square used", 100.0 * used);
        assert!(used > 0.3, "{name}: {used}");
    }
}

#[test]
fn a_cube_has_a_chart_for_each_side_that_one_view_hides() {
    let corner = |k: u8| Vec3::new(f32::from(k & 1), f32::from(k >> 1 & 1), f32::from(k >> 2));
    let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    let cube = Mesh::with_shared_normals((0..8).map(corner).collect(), indices, Averaging::Angle);
    // A view along a diagonal shows three sides at once.
    assert_eq!(charts::charts(&cube, 0.0).len(), 2);
    check("cube", &cube, 0.0);
    // The same holds for a soup of triangles: equal positions count as one vertex.
    let positions: Vec<Vec3> = cube.triangles().flatten().collect();
    let soup = Mesh::with_shared_normals(positions, (0..36).collect(), Averaging::Angle);
    assert_eq!(charts::charts(&soup, 0.0).len(), 2);
    check("soup", &soup, 0.0);
}

#[test]
fn what_hides_itself_is_split() {
    let spiral = spiral();
    // Three turns on top of one another, and no triangle that leans.
    assert!(charts::charts(&spiral, 0.0).len() >= 3);
    check("spiral", &spiral, 0.0);
    check("spiral", &spiral, 0.5);
}

/// Returns the fraction of a mesh's area that halos draw again.
fn share_in_halos(mesh: &Mesh) -> f64 {
    let area = |mesh: &Mesh| mesh.volume_and_area().1;
    area(&with_halo_drawn(mesh)) / area(mesh) - 1.0
}

#[test]
fn halos_grow_with_their_reach_and_cost_little_scale() {
    let mesh = mesh_of("bunny_stone");
    let length = mesh.volume_and_area().1.sqrt() as f32;
    let none = unwrap(&mesh, 0.0);
    assert!(none.halo.is_empty() && [-1.0, f32::NAN].into_iter().all(|reach| unwrap(&mesh, reach) == none));
    let mut shares = vec![0.0];
    for part in [0.02, 0.05, 0.1, 0.2] {
        let used = check("bunny", &mesh, part * length);
        let with_halos = unwrap(&mesh, part * length);
        // The visible part is the same, and comes first.
        assert_eq!(with_halos.positions[..none.positions.len()], none.positions);
        assert_eq!((&with_halos.indices, with_halos.without_halo().positions), (&none.indices, none.positions.clone()));
        let scale = |mesh: &Mesh| {
            let [a, b] = [mesh.indices[0], mesh.indices[1]].map(|vertex| mesh.uvs[vertex as usize]);
            a.distance(b)
        };
        let (share, scale) = (share_in_halos(&with_halos), scale(&with_halos) / scale(&none));
        println!("{part}: {share:.3} of the area once more, {:.1} % used, scale {scale:.3}", 100.0 * used);
        assert!(share > shares[shares.len() - 1] && scale > 0.75, "{shares:?} {share}, {scale}");
        shares.push(share);
    }
}

#[test]
fn texture_coordinates_do_not_depend_on_size_or_earlier_ones() {
    let mesh = mesh_of("bunny_stone");
    let unwrapped = unwrap(&mesh, 0.0);
    assert_eq!(unwrap(&unwrapped, 0.0).uvs, unwrapped.uvs);
    let mut larger = mesh.clone();
    larger.positions.iter_mut().for_each(|position| *position *= 1024.0);
    // The factor is a power of two, so every number is scaled exactly.
    assert_eq!(unwrap(&larger, 0.0).uvs, unwrapped.uvs);
}

#[test]
fn triangles_without_area_do_no_harm() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, 2.0 * Vec3::X];
    for indices in [vec![], vec![0, 0, 0], vec![0, 1, 3], vec![0, 1, 2, 0, 1, 1, 0, 1, 3], vec![0, 1, 2, 0, 2, 1]] {
        let mesh = Mesh::with_shared_normals(positions.clone(), indices.clone(), Averaging::Angle);
        let unwrapped = unwrap(&mesh, 0.0);
        assert_eq!(unwrapped.triangle_count(), mesh.triangle_count());
        assert_eq!(unwrapped.uvs.len(), unwrapped.positions.len(), "{indices:?}");
        assert!(unwrapped.uvs.iter().all(|uv| uv.min_element() >= 0.0 && uv.max_element() <= 1.0), "{indices:?}");
    }
    let placed = vec![Vec3::splat(7.0); 3];
    let mesh = Mesh::with_shared_normals(placed, vec![0, 1, 2], Averaging::Angle);
    assert_eq!(unwrap(&mesh, 0.0).uvs.len(), 3);
}

#[test]
fn more_charts_than_gutters_leave_room_for_get_none() {
    let many = |count: u32| {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let positions = (0..count).flat_map(|k| corners.map(|corner| corner + 3.0 * k as f32 * Vec3::Z)).collect();
        Mesh::with_shared_normals(positions, (0..3 * count).collect(), Averaging::Angle)
    };
    assert_eq!(unwrap(&many(4096), 0.0).uvs.len(), 3 * 4096);
    let mesh = many(4097);
    assert_eq!(unwrap(&mesh, 0.0), mesh);
}
