//! Tests of whole paths of 64 reflections in a round brilliant, f32 against f64, and of difficult
//! paths: vertices, edges, grazing incidence, stones of every size and far from the origin. The
//! numbers of docs/convex_trace.md are asserted here.

use super::*;
use glam::{DVec3, DVec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use std::f64::consts::PI;

const BOUNCES: usize = 64;
/// Distance that a path must keep inside all planes except the one that it meets, in units of the
/// girdle's radius, for its facets to be the same in f32 and in f64. A direction is off by up to
/// 2e-6 after 64 reflections, and the distances add up.
const CLEARANCE: f64 = 2e-5;

/// Returns the point with these cylindrical coordinates.
fn at(radius: f64, azimuth: f64, z: f64) -> DVec3 {
    DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
}

/// Returns the plane through a point.
fn plane_at(point: DVec3, normal: DVec3) -> DVec4 {
    let normal = normal.normalize();
    normal.extend(normal.dot(point))
}

/// Returns the plane through three points, with the origin inside.
fn plane_through(points: [DVec3; 3]) -> DVec4 {
    let normal = (points[1] - points[0]).cross(points[2] - points[0]);
    plane_at(points[0], normal * normal.dot(points[0]).signum())
}

/// Returns the 73 planes of Tolkowsky's round brilliant, girdle radius 1: table 0.53, crown 34.5°,
/// pavilion 40.75°, stars 0.5, lower halves 0.77, girdle 0.04 thick.
fn brilliant() -> Vec<DVec4> {
    let a = PI / 8.0;
    let (table, girdle) = (0.53, 0.02);
    let [crown, pavilion] = [34.5f64, 40.75].map(|angle| angle.to_radians().tan());
    let table_height = girdle + (1.0 - table) * crown;
    let star_radius = 0.5 * (table * a.cos() + 1.0);
    // The tips of stars and lower halves lie on the bezels and on the mains.
    let star_height = girdle + (1.0 - star_radius * a.cos()) * crown;
    let lower_radius = 1.0 - 0.77;
    let lower_height = -girdle - (1.0 - lower_radius * a.cos()) * pavilion;
    let mut planes = vec![DVec3::Z.extend(table_height)];
    for azimuth in (0..8).map(|k| 2.0 * a * f64::from(k)) {
        let star_tip = at(star_radius, azimuth + a, star_height);
        let corners = [azimuth, azimuth + 2.0 * a].map(|azimuth| at(table, azimuth, table_height));
        planes.push(plane_through([corners[0], corners[1], star_tip]));
        planes.push(plane_at(at(1.0, azimuth, girdle), at(crown, azimuth, 1.0)));
        planes.push(plane_at(at(1.0, azimuth, -girdle), at(pavilion, azimuth, -1.0)));
        for beside in [azimuth - a, azimuth + a] {
            let halves = |radius, height, z| [at(radius, beside, height), at(1.0, azimuth, z), at(1.0, beside, z)];
            planes.push(plane_through(halves(star_radius, star_height, girdle)));
            planes.push(plane_through(halves(lower_radius, lower_height, -girdle)));
            let normal = at(1.0, 0.5 * (azimuth + beside), 0.0);
            planes.push(plane_at((0.5 * a).cos() * normal, normal));
        }
    }
    planes
}

/// Returns the corners of a solid with the planes that meet there.
fn vertices(planes: &[DVec4]) -> Vec<(DVec3, Vec<usize>)> {
    let mut found: Vec<(DVec3, Vec<usize>)> = Vec::new();
    for i in 0..planes.len() {
        for j in 0..i {
            for k in 0..j {
                let normals = glam::DMat3::from_cols(planes[i].xyz(), planes[j].xyz(), planes[k].xyz()).transpose();
                if normals.determinant().abs() < 1e-9 {
                    continue;
                }
                let corner = normals.inverse() * DVec3::new(planes[i].w, planes[j].w, planes[k].w);
                let outside = |plane: &DVec4| plane.xyz().dot(corner) - plane.w;
                let inside = planes.iter().all(|plane| outside(plane) < 1e-9);
                if inside && found.iter().all(|(other, _)| other.distance(corner) > 1e-6) {
                    let meeting = (0..planes.len()).filter(|index| outside(&planes[*index]).abs() < 1e-9).collect();
                    found.push((corner, meeting));
                }
            }
        }
    }
    found
}

/// A stone of a given size, away from the origin, in f32, and exactly the same planes in f64.
struct Stone {
    planes: Vec<Vec4>,
    exact: Vec<DVec4>,
    size: f64,
    centre: DVec3,
}

impl Stone {
    fn brilliant(size: f64, centre: DVec3) -> Self {
        let moved = |plane: &DVec4| plane.xyz().extend(size * plane.w + plane.xyz().dot(centre)).as_vec4();
        let planes: Vec<Vec4> = brilliant().iter().map(moved).collect();
        let exact = planes.iter().map(|plane| plane.as_dvec4()).collect();
        Self { planes, exact, size, centre }
    }

    /// Returns the distance of a point outside the stone, divided by the size.
    fn outside(&self, point: DVec3) -> f64 {
        self.exact.iter().map(|plane| plane.xyz().dot(point) - plane.w).fold(f64::NEG_INFINITY, f64::max) / self.size
    }

    /// Returns the distance of a point inside all planes except one, divided by the size.
    fn clearance(&self, point: DVec3, face: u32) -> f64 {
        let others = (0..).zip(&self.exact).filter(|(index, _)| *index != face);
        others.map(|(_, plane)| plane.w - plane.xyz().dot(point)).fold(f64::INFINITY, f64::min) / self.size
    }
}

/// State of a ray between two facets.
#[derive(Clone, Copy)]
struct Ray<V> {
    position: V,
    direction: V,
    left: u32,
}

impl Ray<Vec3> {
    /// Moves to the next facet and reflects there. Returns the distance, or `None` if the ray
    /// escapes.
    fn bounce(&mut self, planes: &[Vec4], point: fn(Vec3, Vec3, f32, Vec4) -> Vec3) -> Option<f32> {
        let hit = trace(planes, self.position, self.direction, self.left);
        let plane = *planes.get(hit.face as usize)?;
        let way = hit.distance;
        self.position = point(self.position, self.direction, way, plane);
        self.direction -= 2.0 * plane.xyz().dot(self.direction) * plane.xyz();
        self.left = hit.face;
        Some(way)
    }

    fn exact(self) -> Ray<DVec3> {
        Ray { position: self.position.as_dvec3(), direction: self.direction.as_dvec3(), left: self.left }
    }
}

impl Ray<DVec3> {
    fn bounce(&mut self, planes: &[DVec4]) {
        let (way, face) = oracle::trace(planes, self.position, self.direction, self.left);
        let plane = planes[face as usize];
        self.position = oracle::point(self.position, self.direction, way, plane);
        self.direction -= 2.0 * plane.xyz().dot(self.direction) * plane.xyz();
        self.left = face;
    }
}

/// Statistics of paths of 64 reflections.
#[derive(Debug, Default)]
struct Paths {
    /// Number of rays.
    rays: usize,
    /// Number of paths that met the same facets as in f64.
    same: usize,
    /// Number of rays that escaped.
    escaped: usize,
    /// Largest clearance of a path that met other facets.
    clearance: f64,
    /// Largest difference of the last direction, over the paths that met the same facets.
    direction: f64,
    /// Largest distance from the plane that was met, divided by the size.
    residual: f64,
    /// Sums of those distances over the first and over the last eight reflections.
    early_and_late: [f64; 2],
}

/// Traces rays in all directions from a sphere of 0.3 of the radius about the centre.
fn paths(stone: &Stone, rays: usize, point: fn(Vec3, Vec3, f32, Vec4) -> Vec3) -> Paths {
    let mut random = Draws::of_row(1, 0);
    let mut paths = Paths { rays, ..Paths::default() };
    for _ in 0..rays {
        let position = (stone.centre + 0.3 * stone.size * random.direction()).as_vec3();
        let mut ray = Ray { position, direction: random.direction().as_vec3(), left: CONVEX_TRACE_NONE };
        let mut truth = ray.exact();
        let mut clearance = f64::INFINITY;
        let mut same = true;
        for bounce in 0..BOUNCES {
            if ray.bounce(&stone.planes, point).is_none() {
                paths.escaped += 1;
                same = false;
                break;
            }
            let plane = stone.exact[ray.left as usize];
            let residual = (plane.xyz().dot(ray.position.as_dvec3()) - plane.w).abs() / stone.size;
            paths.residual = larger(paths.residual, residual);
            paths.early_and_late[0] += if bounce < 8 { residual } else { 0.0 };
            paths.early_and_late[1] += if bounce >= BOUNCES - 8 { residual } else { 0.0 };
            if same {
                truth.bounce(&stone.exact);
                clearance = clearance.min(stone.clearance(truth.position, truth.left));
                same = ray.left == truth.left;
            }
        }
        if same {
            paths.same += 1;
            let off = ray.direction.as_dvec3().normalize().distance(truth.direction.normalize());
            paths.direction = larger(paths.direction, off);
        } else {
            paths.clearance = paths.clearance.max(clearance);
        }
    }
    paths
}

fn unprojected(position: Vec3, direction: Vec3, distance: f32, _: Vec4) -> Vec3 {
    point_naive(position, direction, distance)
}

#[test]
fn the_brilliant_is_the_brilliant() {
    let planes = brilliant();
    let corners = vertices(&planes);
    assert_eq!((planes.len(), corners.len()), (73, 57));
    // Euler: a corner of k facets is an end of k edges.
    let ends: usize = corners.iter().map(|(_, meeting)| meeting.len()).sum();
    assert_eq!(ends, 2 * 128);
}

#[test]
fn sixty_four_reflections_meet_the_same_facets_in_f32_as_in_f64() {
    for size in [1.0, 1e-4, 1e4] {
        let paths = paths(&Stone::brilliant(size, DVec3::ZERO), 4_000, point);
        assert_eq!(paths.escaped, 0);
        assert!(paths.clearance < CLEARANCE, "size {size}: {paths:?}");
        assert!(paths.same as f64 >= 0.997 * paths.rays as f64, "size {size}: {paths:?}");
        assert!(paths.direction < 2e-6, "size {size}: {paths:?}");
    }
}

#[test]
fn errors_off_the_plane_do_not_build_up_and_projection_takes_most_of_them() {
    let stone = Stone::brilliant(1.0, DVec3::ZERO);
    let [projected, plain] = [point, unprojected].map(|point| paths(&stone, 1_000, point));
    for paths in [&projected, &plain] {
        let [early, late] = paths.early_and_late;
        assert!((0.8..1.2).contains(&(late / early)), "{paths:?}");
    }
    assert!(projected.residual < 1.3e-7 && plain.residual > 2.5e-7, "{projected:?} {plain:?}");
}

#[test]
fn far_from_the_origin_facets_are_lost_unless_the_stone_keeps_its_own_coordinates() {
    let centre = 1e4 * DVec3::new(0.6, 0.48, 0.64);
    let far = paths(&Stone::brilliant(1.0, centre), 1_000, point);
    assert_eq!(far.escaped, 0);
    assert!((far.same as f64) < 0.5 * far.rays as f64, "{far:?}");
    // The same rays, with starts given in world coordinates and transformed to the stone's: the
    // start moves by its own rounding, and everything after it keeps its digits.
    let stone = Stone::brilliant(1.0, DVec3::ZERO);
    let mut random = Draws::of_row(1, 0);
    let (mut same, mut clearest) = (0, 0.0);
    for _ in 0..1_000 {
        let world = (centre + 0.3 * random.direction()).as_vec3();
        let direction = random.direction().as_vec3();
        let mut ray = Ray { position: world - centre.as_vec3(), direction, left: CONVEX_TRACE_NONE };
        let mut truth = ray.exact();
        let mut clearance = f64::INFINITY;
        let met = (0..BOUNCES).all(|_| {
            ray.bounce(&stone.planes, point).expect("a closed stone");
            truth.bounce(&stone.exact);
            clearance = clearance.min(stone.clearance(truth.position, truth.left));
            ray.left == truth.left
        });
        if met {
            same += 1;
        } else {
            clearest = f64::max(clearest, clearance);
        }
    }
    assert!(same >= 995 && clearest < CLEARANCE, "{same}, {clearest:e}");
}

/// Follows a ray that starts on the surface: it must neither leave the stone nor stand still.
fn stays_inside(stone: &Stone, mut ray: Ray<Vec3>) {
    let start = ray;
    let mut way = 0.0;
    for bounce in 0..BOUNCES {
        let step = ray.bounce(&stone.planes, point);
        let context = format!("bounce {bounce} from {:?} along {:?}", start.position, start.direction);
        let step = step.unwrap_or_else(|| panic!("{context} escapes"));
        assert!(step.is_finite() && step >= 0.0 && f64::from(step) < 3.0 * stone.size, "{context}: {step:e}");
        way += f64::from(step) / stone.size;
        let outside = stone.outside(ray.position.as_dvec3());
        // Units in the last place of the position, of d, and of the distance along a facet of
        // shallow slope.
        assert!(outside < 4e-7, "{context} is outside by {outside:e}");
    }
    assert!(way > 1.0, "from {:?} along {:?} it goes {way:e}", start.position, start.direction);
}

#[test]
fn rays_that_enter_at_a_vertex_stay_inside() {
    let corners = vertices(&brilliant());
    let mut random = Draws::of_row(2, 0);
    for size in [1.0, 1e-4, 1e4] {
        let stone = Stone::brilliant(size, DVec3::ZERO);
        for (corner, meeting) in &corners {
            for left in meeting {
                let towards = 0.3 * random.direction() - *corner;
                stays_inside(
                    &stone,
                    Ray {
                        position: (size * *corner).as_vec3(),
                        direction: towards.normalize().as_vec3(),
                        left: *left as u32,
                    },
                );
            }
        }
    }
}

#[test]
fn rays_that_enter_along_an_edge_stay_inside() {
    let corners = vertices(&brilliant());
    let mut random = Draws::of_row(3, 0);
    let mut edges = 0;
    for size in [1.0, 1e-4, 1e4] {
        let stone = Stone::brilliant(size, DVec3::ZERO);
        for (corner, meeting) in &corners {
            for (end, others) in &corners {
                let shared: Vec<usize> = meeting.iter().copied().filter(|face| others.contains(face)).collect();
                if corner == end || shared.len() != 2 {
                    continue;
                }
                edges += 1;
                // From the middle of the edge, along the edge and inwards.
                for towards in [*end - *corner, 0.3 * random.direction() - 0.5 * (*corner + *end)] {
                    stays_inside(
                        &stone,
                        Ray {
                            position: (0.5 * size * (*corner + *end)).as_vec3(),
                            direction: towards.normalize().as_vec3(),
                            left: shared[0] as u32,
                        },
                    );
                }
            }
        }
    }
    assert_eq!(edges, 3 * 2 * 128);
}

#[test]
fn at_grazing_incidence_to_the_last_ulp_the_face_that_was_left_is_not_met() {
    let mut random = Draws::of_row(4, 0);
    let mut towards_it = 0;
    for size in [1.0, 1e-4, 1e4] {
        let stone = Stone::brilliant(size, DVec3::ZERO);
        for (face, plane) in (0..).zip(&stone.exact) {
            // From the foot point of an inner point that lies over the facet.
            let over = (0..).map(|_| oracle::point(0.5 * size * random.direction(), DVec3::ZERO, 0.0, *plane));
            let foot = over.into_iter().find(|foot| stone.clearance(*foot, face) > 1e-3).expect("facets have a middle");
            for _ in 0..64 {
                let tangent = plane.xyz().cross(random.direction()).normalize();
                let direction = tangent.as_vec3();
                let slope = plane.xyz().dot(direction.as_dvec3());
                assert!(slope.abs() < 1.2e-7);
                towards_it += u32::from(slope > 0.0);
                let hit = trace(&stone.planes, foot.as_vec3(), direction, face);
                let (way, truth) = oracle::trace(&stone.exact, foot.as_vec3().as_dvec3(), direction.as_dvec3(), face);
                assert_ne!(hit.face, face);
                // At an edge, two neighbours may be met at the same distance.
                let off = (f64::from(hit.distance) - way).abs() / size;
                assert!(hit.face == truth || off < 1e-6, "face {face}: {} for {truth}, {off:e} apart", hit.face);
                stays_inside(&stone, Ray { position: foot.as_vec3(), direction, left: face });
            }
        }
    }
    assert!(towards_it > 1_000, "{towards_it}");
}

/// Returns the planes of a cube of side 2: ±x, ±y, ±z.
fn cube() -> Vec<Vec4> {
    [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].map(|normal| normal.extend(1.0)).to_vec()
}

#[test]
fn parallel_to_planes_after_each_bounce() {
    let mut ray = Ray { position: Vec3::new(-1.0, 0.25, 1.0), direction: Vec3::X, left: 1 };
    for bounce in 0..BOUNCES {
        assert_eq!(ray.bounce(&cube(), point), Some(2.0));
        assert_eq!(ray.left, (bounce % 2) as u32);
        // Between ±x within the plane +z itself: parallel to it, and on it.
        assert_eq!((ray.position.y, ray.position.z), (0.25, 1.0));
    }
}

#[test]
fn at_equal_distances_the_lower_face_wins() {
    let corner = trace(&cube(), Vec3::ZERO, Vec3::ONE, CONVEX_TRACE_NONE);
    assert_eq!((corner.face, corner.distance), (0, 1.0));
    let edge = trace(&cube(), Vec3::ZERO, Vec3::new(0.0, -1.0, -1.0), CONVEX_TRACE_NONE);
    assert_eq!((edge.face, edge.distance), (3, 1.0));
}

#[test]
fn outside_by_rounding_and_going_out_it_is_met_at_once() {
    let outside = Vec3::new(1.0f32.next_up(), 0.0, 0.0);
    let hit = trace(&cube(), outside, Vec3::new(0.6, 0.8, 0.0), 2);
    assert_eq!((hit.face, hit.distance), (0, 0.0));
    // A ray that runs inwards does not meet it.
    let hit = trace(&cube(), outside, Vec3::new(-0.6, 0.8, 0.0), CONVEX_TRACE_NONE);
    assert_eq!(hit.face, 2);
}

#[test]
fn a_limit_ends_the_ray() {
    let mut hit = start(0.5);
    for (face, plane) in (0..).zip(&cube()) {
        hit = step(hit, Vec3::ZERO, Vec3::X, *plane, face, CONVEX_TRACE_NONE);
    }
    assert_eq!((hit.face, hit.distance), (CONVEX_TRACE_NONE, 0.5));
    assert_eq!(start(f32::INFINITY), start(CONVEX_TRACE_FAR));
}

#[test]
fn without_planes_ahead_there_is_no_hit() {
    let hit = trace(&cube()[1..2], Vec3::ZERO, Vec3::X, CONVEX_TRACE_NONE);
    assert_eq!((hit.face, hit.distance), (CONVEX_TRACE_NONE, CONVEX_TRACE_FAR));
    assert_eq!(oracle::trace(&[], DVec3::ZERO, DVec3::X, CONVEX_TRACE_NONE), (f64::from(1e30f32), CONVEX_TRACE_NONE));
}

#[test]
fn the_oracles_trace_is_the_fold_of_its_steps() {
    let planes = brilliant();
    let mut random = Draws::of_row(5, 0);
    for _ in 0..20_000 {
        let (position, direction) = (0.4 * random.direction(), random.direction());
        let hit = (0..).zip(&planes).fold(oracle::start(1e30), |hit, (face, plane)| {
            oracle::step(hit, position, direction, *plane, face, CONVEX_TRACE_NONE)
        });
        let (way, face) = oracle::trace(&planes, position, direction, CONVEX_TRACE_NONE);
        assert_eq!(face, hit.face);
        assert!((way - hit.distance).abs() < 1e-13);
    }
}
