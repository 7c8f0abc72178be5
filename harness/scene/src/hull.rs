//! The convex hull of points, exactly: quickhull (Barber, Dobkin and Huhdanpaa 1996) in whole numbers.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3, Vec3};

/// Steps of the lattice on which points are put, along the longest side of their box: finer than f32 keeps them.
const STEPS: f64 = (1u64 << 26) as f64;

/// The convex hull of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// Triangles of the hull, as numbers of points, counter-clockwise seen from outside. None is without area, and points within a
    /// triangle or on an edge are left out.
    pub triangles: Vec<[usize; 3]>,
}

impl Hull {
    /// Returns the hull of `points`, or `None` if all lie in one plane, to a 2²⁶th of their extent, or one is not finite.
    #[must_use]
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let points = lattice(points)?;
        let mut growing = Growing::simplex(&points)?;
        while let Some(face) = growing.waiting.pop() {
            growing.widen(face);
        }
        let alive = growing.faces.into_iter().filter(|face| face.is_alive);
        Some(Self { triangles: alive.map(|face| face.corners).collect() })
    }
}

/// Puts points on the lattice.
fn lattice(points: &[Vec3]) -> Option<Vec<I64Vec3>> {
    let first = points.first()?.as_dvec3();
    let (least, greatest) =
        points.iter().map(|point| point.as_dvec3()).fold((first, first), |(a, b), p| (a.min(p), b.max(p)));
    let step = (greatest - least).max_element() / STEPS;
    let all_finite = points.iter().all(|point| point.is_finite());
    (all_finite && step > 0.0)
        .then(|| points.iter().map(|point| ((point.as_dvec3() - least) / step).round().as_i64vec3()).collect())
}

/// Which side of the plane through `a`, `b` and `c` a point lies on, as six times the volume between them: above 0 outside.
fn side([a, b, c]: [I64Vec3; 3], point: I64Vec3) -> i128 {
    let wide = |v: I64Vec3| [i128::from(v.x), i128::from(v.y), i128::from(v.z)];
    let ([ux, uy, uz], [vx, vy, vz], [wx, wy, wz]) = (wide(b - a), wide(c - a), wide(point - a));
    (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz
}

/// A triangle of the hull of the points that were taken so far.
struct Face {
    corners: [usize; 3],
    /// Points outside it, each counted at one face, with the farthest one last.
    outside: Vec<usize>,
    is_alive: bool,
}

struct Growing<'a> {
    points: &'a [I64Vec3],
    faces: Vec<Face>,
    /// Face at the left of each directed edge.
    left: HashMap<[usize; 2], usize>,
    /// Faces with points outside.
    waiting: Vec<usize>,
}

impl<'a> Growing<'a> {
    /// Starts from four points that span a volume.
    fn simplex(points: &'a [I64Vec3]) -> Option<Self> {
        let farthest = |key: &dyn Fn(I64Vec3) -> f64| {
            (0..points.len()).max_by(|&a, &b| key(points[a]).total_cmp(&key(points[b]))).unwrap_or(0)
        };
        let from = |k: usize| move |point: I64Vec3| (point - points[k]).as_dvec3();
        let a = farthest(&|point| point.x as f64);
        let b = farthest(&|point| from(a)(point).length_squared());
        let along = from(a)(points[b]);
        let c = farthest(&|point| from(a)(point).cross(along).length_squared());
        let normal = along.cross(from(a)(points[c]));
        let d = farthest(&|point| from(a)(point).dot(normal).abs());
        let [a, b, c] = match side([points[a], points[b], points[c]], points[d]).signum() {
            0 => return None,
            1 => [a, c, b],
            _ => [a, b, c],
        };
        let mut all = Self { points, faces: Vec::new(), left: HashMap::new(), waiting: Vec::new() };
        let points = (0..points.len()).collect();
        all.add(vec![[a, b, c], [a, d, b], [b, d, c], [c, d, a]], points);
        Some(all)
    }

    fn side(&self, corners: [usize; 3], point: usize) -> i128 {
        side(corners.map(|corner| self.points[corner]), self.points[point])
    }

    /// Adds faces, and gives each the points outside it that no earlier one of them has.
    fn add(&mut self, faces: Vec<[usize; 3]>, mut points: Vec<usize>) {
        for corners in faces {
            let mut outside = Vec::new();
            let mut farthest = (0, 0);
            points.retain(|&point| {
                let height = self.side(corners, point);
                if height > farthest.0 {
                    farthest = (height, outside.len());
                }
                if height > 0 {
                    outside.push(point);
                }
                height <= 0
            });
            let number = self.faces.len();
            if let Some(last) = outside.len().checked_sub(1) {
                outside.swap(farthest.1, last);
                self.waiting.push(number);
            }
            let [a, b, c] = corners;
            for edge in [[a, b], [b, c], [c, a]] {
                self.left.insert(edge, number);
            }
            self.faces.push(Face { corners, outside, is_alive: true });
        }
    }

    /// Takes the farthest point outside a face into the hull: the faces that it sees make way for those from it to their rim.
    fn widen(&mut self, face: usize) {
        let Some(&point) = self.faces[face].outside.last().filter(|_| self.faces[face].is_alive) else { return };
        self.faces[face].is_alive = false;
        let (mut seen, mut rim, mut points) = (vec![face], Vec::new(), Vec::new());
        while let Some(number) = seen.pop() {
            points.append(&mut self.faces[number].outside);
            let [a, b, c] = self.faces[number].corners;
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let Some(&beyond) = self.left.get(&[to, from]) else { continue };
                if !self.faces[beyond].is_alive {
                    continue;
                }
                if self.side(self.faces[beyond].corners, point) > 0 {
                    self.faces[beyond].is_alive = false;
                    seen.push(beyond);
                } else {
                    rim.push([from, to, point]);
                }
            }
        }
        points.retain(|&other| other != point);
        self.add(rim, points);
    }
}

/// Returns the volume that triangles enclose, and its centroid.
#[must_use]
pub fn volume(points: &[Vec3], triangles: impl IntoIterator<Item = [usize; 3]>) -> (f64, DVec3) {
    let middle = points.iter().map(|point| point.as_dvec3()).sum::<DVec3>() / points.len().max(1) as f64;
    let corner = |number: usize| points[number].as_dvec3() - middle;
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for [a, b, c] in triangles.into_iter().map(|corners| corners.map(corner)) {
        let part = a.dot(b.cross(c)) / 6.0;
        volume += part;
        moment += 0.25 * part * (a + b + c);
    }
    (volume, middle + moment / volume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_assay::draws::Draws;

    /// Every point lies inside, and every edge has its opposite.
    fn check(points: &[Vec3]) -> Hull {
        let hull = Hull::of(points).expect("a volume");
        let on_lattice = lattice(points).unwrap();
        let mut edges = HashMap::new();
        for &corners in &hull.triangles {
            let [a, b, c] = corners;
            for edge in [[a, b], [b, c], [c, a]] {
                assert!(edges.insert(edge, ()).is_none());
            }
            let plane = corners.map(|corner| on_lattice[corner]);
            assert!((plane[1] - plane[0]).as_dvec3().cross((plane[2] - plane[0]).as_dvec3()).length() > 0.0);
            assert!(on_lattice.iter().all(|point| side(plane, *point) <= 0));
        }
        assert!(edges.keys().all(|[from, to]| edges.contains_key(&[*to, *from])));
        hull
    }

    #[test]
    fn points_on_faces_and_edges_of_a_cube_are_left_out() {
        let mut points = Vec::new();
        for k in 0..125 {
            points.push(Vec3::new((k % 5) as f32, (k / 5 % 5) as f32, (k / 25) as f32));
        }
        points.extend(points.clone());
        let hull = check(&points);
        assert_eq!(hull.triangles.len(), 12);
        let (volume, centroid) = volume(&points, hull.triangles);
        assert!((volume - 64.0).abs() < 1e-9 && centroid.distance(DVec3::splat(2.0)) < 1e-9);
    }

    #[test]
    fn hulls_of_random_points_hold_them_all() {
        for row in 0..40 {
            let mut draws = Draws::of_row(3, row);
            let count = 5 + draws.below(200);
            // Few different coordinates, so that many points share planes and lines.
            let steps = [3, 10, 1_000_000][row as usize % 3];
            let mut points: Vec<Vec3> =
                (0..count).map(|_| Vec3::from_array([0; 3].map(|_| draws.below(steps) as f32))).collect();
            points.extend([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
            check(&points);
        }
    }

    #[test]
    fn every_point_of_a_ball_is_a_corner() {
        let mut draws = Draws::of_row(5, 1);
        let points: Vec<Vec3> = (0..20_000)
            .map(|_| {
                let (z, angle) = (draws.between(-1.0, 1.0), draws.between(0.0, std::f32::consts::TAU));
                ((1.0 - z * z).sqrt() * Vec3::new(angle.cos(), angle.sin(), 0.0)).with_z(z)
            })
            .collect();
        let hull = Hull::of(&points).unwrap();
        assert_eq!(hull.triangles.len(), 2 * 20_000 - 4);
    }

    #[test]
    fn flat_and_broken_points_have_none() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE.with_z(0.0)];
        for points in [&[][..], &[Vec3::ONE], &[Vec3::ONE; 9], &square, &[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN]] {
            assert_eq!(Hull::of(points), None, "{points:?}");
        }
    }
}
