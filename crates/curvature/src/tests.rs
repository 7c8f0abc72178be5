//! Tests on surfaces of known curvature, seen from many views: differentials and finite pixels, f32
//! and f64. The tables of docs/curvature.md are made here.

use super::*;
use glam::{DMat3, DVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;

/// A surface as the zero set of a function, with its curvatures in closed form.
#[derive(Clone, Copy, Debug)]
enum Surface {
    /// Sphere of this radius.
    Sphere(f64),
    /// Cylinder of this radius, along z.
    Cylinder(f64),
    /// Torus of these radii, around z.
    Torus(f64, f64),
    /// z = (x² - y²) / 2.
    Saddle,
    /// Ellipsoid with these half axes: a sphere under a non-uniform scale.
    Ellipsoid(DVec3),
}

/// Surfaces of the tests, with a size of about 1.
const SURFACES: [(&str, Surface); 5] = [
    ("sphere", Surface::Sphere(0.3)),
    ("cylinder", Surface::Cylinder(0.7)),
    ("torus", Surface::Torus(1.0, 0.4)),
    ("saddle", Surface::Saddle),
    ("ellipsoid", Surface::Ellipsoid(DVec3::new(1.0, 0.5, 2.0))),
];

impl Surface {
    fn value(self, p: DVec3) -> f64 {
        match self {
            Surface::Sphere(radius) => 0.5 * (p.length_squared() - radius * radius),
            Surface::Cylinder(radius) => 0.5 * (p.x * p.x + p.y * p.y - radius * radius),
            Surface::Torus(large, small) => 0.5 * ((p.x.hypot(p.y) - large).powi(2) + p.z * p.z - small * small),
            Surface::Saddle => p.z - 0.5 * (p.x * p.x - p.y * p.y),
            Surface::Ellipsoid(axes) => 0.5 * ((p / axes).length_squared() - 1.0),
        }
    }

    fn gradient(self, p: DVec3) -> DVec3 {
        match self {
            Surface::Sphere(_) => p,
            Surface::Cylinder(_) => DVec3::new(p.x, p.y, 0.0),
            Surface::Torus(large, _) => {
                let share = 1.0 - large / p.x.hypot(p.y);
                DVec3::new(share * p.x, share * p.y, p.z)
            }
            Surface::Saddle => DVec3::new(-p.x, p.y, 1.0),
            Surface::Ellipsoid(axes) => p / (axes * axes),
        }
    }

    fn hessian(self, p: DVec3) -> DMat3 {
        let diagonal = DMat3::from_diagonal;
        match self {
            Surface::Sphere(_) => DMat3::IDENTITY,
            Surface::Cylinder(_) => diagonal(DVec3::new(1.0, 1.0, 0.0)),
            Surface::Torus(large, _) => {
                let radius = p.x.hypot(p.y);
                let across = DVec3::new(p.y, -p.x, 0.0) / radius;
                // 1 - R / ρ around the axis, 1 along the other two directions.
                let outer = DMat3::from_cols(across.x * across, across.y * across, across.z * across);
                DMat3::IDENTITY - large / radius * outer
            }
            Surface::Saddle => diagonal(DVec3::new(-1.0, 1.0, 0.0)),
            Surface::Ellipsoid(axes) => diagonal(1.0 / (axes * axes)),
        }
    }

    fn normal(self, p: DVec3) -> DVec3 {
        self.gradient(p).normalize()
    }

    /// Returns the derivative of the unit normal along a tangent.
    fn bend(self, p: DVec3, tangent: DVec3) -> DVec3 {
        let gradient = self.gradient(p);
        let change = self.hessian(p) * tangent;
        change.reject_from(gradient) / gradient.length()
    }

    /// Returns mean and Gaussian curvature as listed in geometry books; positive if the surface
    /// bends away from the normal.
    fn curvature(self, p: DVec3) -> (f64, f64) {
        match self {
            Surface::Sphere(radius) => (1.0 / radius, 1.0 / (radius * radius)),
            Surface::Cylinder(radius) => (0.5 / radius, 0.0),
            Surface::Torus(large, small) => {
                let cosine = (p.x.hypot(p.y) - large) / small;
                let around = cosine / (large + small * cosine);
                (0.5 * (1.0 / small + around), around / small)
            }
            Surface::Saddle => {
                let squared = 1.0 + p.x * p.x + p.y * p.y;
                ((p.x * p.x - p.y * p.y) / (2.0 * squared.powf(1.5)), -1.0 / (squared * squared))
            }
            Surface::Ellipsoid(axes) => {
                let volume = axes.x * axes.y * axes.z;
                let height = (p / (axes * axes)).length_squared();
                let mean = (axes.length_squared() - p.length_squared()) / (2.0 * volume * volume * height.powf(1.5));
                (mean, 1.0 / (volume * height).powi(2))
            }
        }
    }

    /// Returns the normal curvature along a direction, from the second derivative of the function
    /// along it.
    fn towards(self, p: DVec3, light: DVec3) -> f64 {
        let tangent = light.reject_from(self.gradient(p)).normalize();
        tangent.dot(self.hessian(p) * tangent) / self.gradient(p).length()
    }

    fn point(self, random: &mut Draws<'_>) -> DVec3 {
        let turn = random.between_f64(0.0, std::f64::consts::TAU);
        match self {
            Surface::Sphere(radius) => radius * random.direction(),
            Surface::Cylinder(radius) => {
                DVec3::new(radius * turn.cos(), radius * turn.sin(), random.between_f64(-1.0, 1.0))
            }
            Surface::Torus(large, small) => {
                let other = random.between_f64(0.0, std::f64::consts::TAU);
                let radius = large + small * other.cos();
                DVec3::new(radius * turn.cos(), radius * turn.sin(), small * other.sin())
            }
            Surface::Saddle => {
                let (x, y) = (random.between_f64(-1.0, 1.0), random.between_f64(-1.0, 1.0));
                DVec3::new(x, y, 0.5 * (x * x - y * y))
            }
            Surface::Ellipsoid(axes) => axes * random.direction(),
        }
    }
}

/// A perspective camera that looks at a point. The ray of screen coordinates (x, y), in radians, is
/// eye + t (ahead + x right + y up).
#[derive(Clone, Copy, Debug)]
struct View {
    eye: DVec3,
    ahead: DVec3,
    right: DVec3,
    up: DVec3,
}

impl View {
    /// Draws a view from `distance` away, with the surface's normal at the given cosine to the line
    /// of sight, at any roll.
    fn of(random: &mut Draws<'_>, point: DVec3, normal: DVec3, cosine: f64, distance: f64) -> View {
        let side = random.direction().reject_from(normal).normalize();
        let back = (cosine * normal + (1.0 - cosine * cosine).sqrt() * side).normalize();
        let right = random.direction().reject_from(back).normalize();
        View { eye: point + distance * back, ahead: -back, right, up: right.cross(-back) }
    }

    /// Returns the derivatives of position and normal at `point`, in the centre of the view, per
    /// radian: those of the ray's position on the tangent plane.
    fn differentials(&self, surface: Surface, point: DVec3) -> [DVec3; 4] {
        let normal = surface.normal(point);
        let distance = (point - self.eye).dot(self.ahead);
        let along = |side: DVec3| distance * (side - normal.dot(side) / normal.dot(self.ahead) * self.ahead);
        let [p_x, p_y] = [along(self.right), along(self.up)];
        [p_x, p_y, surface.bend(point, p_x), surface.bend(point, p_y)]
    }

    /// Returns the intersection of a pixel's ray with the surface, by Newton's method from `start`.
    fn hit(&self, surface: Surface, x: f64, y: f64, start: DVec3) -> DVec3 {
        let ray = self.ahead + x * self.right + y * self.up;
        let mut distance = (start - self.eye).dot(self.ahead);
        for _ in 0..20 {
            let point = self.eye + distance * ray;
            distance -= surface.value(point) / surface.gradient(point).dot(ray);
        }
        self.eye + distance * ray
    }

    /// Returns the differences within a quad of pixels of `size` radians: positions relative to the
    /// eye and unit normals, rounded to f32 if `single`.
    fn quad(&self, surface: Surface, point: DVec3, size: f64, single: bool) -> [DVec3; 4] {
        let round = |v: DVec3| if single { v.as_vec3().as_dvec3() } else { v };
        let [here, beside, above] = [(0.0, 0.0), (size, 0.0), (0.0, size)].map(|(x, y)| {
            let hit = self.hit(surface, x, y, point);
            (round(hit - self.eye), round(surface.normal(hit)))
        });
        [beside.0 - here.0, above.0 - here.0, beside.1 - here.1, above.1 - here.1]
    }
}

fn sine(x: DVec3, y: DVec3) -> f64 {
    x.cross(y).length() / (x.length() * y.length())
}

/// Returns the sensitivity of a curvature to rounding of its inputs: |n_x| / |p_x| + |n_y| / |p_y|,
/// divided by the sine of the angle between p_x and p_y.
fn condition([p_x, p_y, n_x, n_y]: [DVec3; 4]) -> f64 {
    (n_x.length() / p_x.length() + n_y.length() / p_y.length()) / sine(p_x, p_y)
}

const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// Checks that the invariant form gives the known curvature from every view, down to a cosine of
/// 0.02 and at scales of 1e-4, 1 and 1e4.
#[test]
fn known_curvatures_come_out_at_every_view() {
    let mut random = Draws::of_row(1, 0);
    for (name, surface) in SURFACES {
        let mut worst = [0f64; 3];
        for _ in 0..20_000 {
            let point = surface.point(&mut random);
            let cosine = random.between_f64(0.02, 1.0);
            let view = View::of(&mut random, point, surface.normal(point), cosine, 4.0);
            let light = random.direction();
            let (mean, gaussian) = surface.curvature(point);
            for scale in [1e-4, 1.0, 1e4] {
                let pixel = 1e-3;
                let [p_x, p_y, n_x, n_y] = view.differentials(surface, point).map(|v| v * pixel);
                let inputs = [scale * p_x, scale * p_y, n_x, n_y];
                let [p_x, p_y, n_x, n_y] = inputs.map(|v| v.as_vec3());
                let condition = condition(inputs);
                let found = f64::from(super::mean(p_x, p_y, n_x, n_y));
                worst[0] = larger(worst[0], (found - mean / scale).abs() / condition);
                let found = f64::from(super::gaussian(p_x, p_y, n_x, n_y));
                worst[1] = larger(worst[1], (found - gaussian / (scale * scale)).abs() / (condition * condition));
                let tangent = light.reject_from(surface.normal(point)).length();
                if tangent > 0.2 {
                    let found = f64::from(towards(p_x, p_y, n_x, n_y, light.as_vec3()));
                    let exact = surface.towards(point, light) / scale;
                    // The share of the mean near the zenith first, then rounding; the rounding of
                    // the light is magnified near the zenith.
                    let mixed = f64::from(CURVATURE_ZENITH) / (tangent * tangent) * (exact - mean / scale).abs();
                    worst[2] = larger(worst[2], ((found - exact).abs() - mixed) * tangent / condition);
                }
            }
        }
        println!("{name}: off by {:?} units of rounding times the condition", worst.map(|error| error / UNIT));
        // Each of the 12 inputs is rounded by half an ulp, and so is each of about 10 operations on
        // the longest path from input to result.
        assert!(worst.iter().all(|error| *error <= 16.0 * UNIT), "{name} {worst:?}");
    }
}

/// Smallest and largest |dN| / |dP| relative to the larger principal curvature, and the largest
/// relative error of the mean curvature in f32.
struct Row {
    low: f64,
    high: f64,
    error: f64,
}

/// Evaluates one point of a surface from 1000 views with a cosine of at least 1/4.
fn row(surface: Surface, point: DVec3, seed: u64) -> Row {
    let mut random = Draws::of_row(seed, 0);
    let (mean, gaussian) = surface.curvature(point);
    let largest = mean.abs() + (mean * mean - gaussian).max(0.0).sqrt();
    let mut row = Row { low: f64::INFINITY, high: 0.0, error: 0.0 };
    for _ in 0..1000 {
        let cosine = random.between_f64(0.25, 1.0);
        let view = View::of(&mut random, point, surface.normal(point), cosine, 4.0);
        let [p_x, p_y, n_x, n_y] = view.differentials(surface, point).map(|v| (1e-3 * v).as_vec3());
        let usual = f64::from(naive(p_x, p_y, n_x, n_y)) / largest;
        row.low = row.low.min(usual);
        row.high = larger(row.high, usual);
        row.error = larger(row.error, (f64::from(super::mean(p_x, p_y, n_x, n_y)) - mean).abs() / largest);
    }
    row
}

/// Returns a generic point of each surface.
fn places() -> [(&'static str, Surface, DVec3); 5] {
    let torus = Surface::Torus(1.0, 0.4);
    let Surface::Ellipsoid(axes) = SURFACES[4].1 else { unreachable!("the fifth is the ellipsoid") };
    [
        ("sphere, R = 0.3", SURFACES[0].1, 0.3 * DVec3::new(0.48, 0.6, 0.64)),
        ("cylinder, R = 0.7", SURFACES[1].1, 0.7 * DVec3::new(0.6, 0.8, 0.3)),
        ("torus, inner side", torus, DVec3::new(-0.8 * 0.76, 0.6 * 0.76, 0.32)),
        ("saddle, beside its middle", SURFACES[3].1, DVec3::new(0.8, 0.2, 0.3)),
        ("ellipsoid, axes 1 : 0.5 : 2", SURFACES[4].1, axes * DVec3::new(0.48, 0.6, 0.64)),
    ]
}

/// Checks the first table of docs/curvature.md.
#[test]
fn the_usual_form_depends_on_the_view_and_the_invariant_one_does_not() {
    let mut table = String::new();
    for (index, (name, surface, point)) in places().into_iter().enumerate() {
        assert!(surface.value(point).abs() < 1e-12, "{name}");
        let row = row(surface, point, 10 + index as u64);
        let (mean, gaussian) = surface.curvature(point);
        table += &format!(
            "| {name} | {mean:.3} | {gaussian:.3} | {:.0e} | {:.2} to {:.2} |\n",
            row.error, row.low, row.high
        );
        assert!(row.error <= 2e-6, "{name} {}", row.error);
        assert_eq!(row.high - row.low > 0.2, index != 0, "{name} {} {}", row.low, row.high);
    }
    println!("{table}");
    let page = include_str!("../../../docs/curvature.md");
    assert!(page.contains(&table), "docs/curvature.md should hold:\n{table}");
}

/// Checks a cylinder seen perpendicular to its axis: between 1/√2 and 1 of the curvature, depending
/// on the angle around it.
#[test]
fn around_an_upright_cylinder_the_usual_form_gives_071_to_1() {
    let surface = Surface::Cylinder(1.0);
    for (cosine, expected) in [(1.0f64, 0.5f64.sqrt()), (0.5, 0.894_427), (0.1, 0.995_037), (0.01, 0.999_95)] {
        let point = DVec3::new(cosine, (1.0 - cosine * cosine).sqrt(), 0.0);
        let view = View { eye: point + 100.0 * DVec3::X, ahead: DVec3::NEG_X, right: DVec3::Y, up: DVec3::Z };
        let [p_x, p_y, n_x, n_y] = view.differentials(surface, point).map(|v| (1e-3 * v).as_vec3());
        // fwidth adds magnitudes per component: √(|p_x|² + |p_y|²) here, because the two lie along
        // different axes.
        assert!((f64::from(naive(p_x, p_y, n_x, n_y)) - expected).abs() < 1e-5, "{cosine}");
        assert!((super::mean(p_x, p_y, n_x, n_y) - 0.5).abs() < 1e-5);
    }
    // Nothing bends along the axis: seen at a slant, the usual form becomes arbitrarily small.
    let point = DVec3::X;
    let slanted = DVec3::new(0.1, 0.0, (1.0f64 - 0.01).sqrt());
    let right = DVec3::Y;
    let view = View { eye: point + 100.0 * slanted, ahead: -slanted, right, up: right.cross(-slanted) };
    let [p_x, p_y, n_x, n_y] = view.differentials(surface, point).map(|v| (1e-3 * v).as_vec3());
    assert!(naive(p_x, p_y, n_x, n_y) < 0.11);
    assert!((super::mean(p_x, p_y, n_x, n_y) - 0.5).abs() < 1e-5);
}

/// Returns the median of the values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Checks the second table of docs/curvature.md. Pixels have a size: the difference of two
/// neighbours has a first-order error, which halves with the size, until the rounding of positions
/// and normals, 2⁻²⁴ divided by the size, takes over.
#[test]
fn finite_pixels_cost_their_size() {
    let mut table = String::new();
    let mut last = f64::INFINITY;
    for pixels in [128, 512, 2048, 8192, 32768] {
        // That many pixels per radian, from a distance of 4.
        let size = 1.0 / f64::from(pixels);
        let mut errors = [Vec::new(), Vec::new()];
        let mut random = Draws::of_row(3, 0);
        // On the sphere, positions and normals differ only by a factor, and no pixel is too large.
        for (_, surface) in &SURFACES[1..] {
            for _ in 0..400 {
                let point = surface.point(&mut random);
                let cosine = random.between_f64(0.25, 1.0);
                let view = View::of(&mut random, point, surface.normal(point), cosine, 4.0);
                let (mean, gaussian) = surface.curvature(point);
                let largest = mean.abs() + (mean * mean - gaussian).max(0.0).sqrt();
                for (single, errors) in [false, true].into_iter().zip(&mut errors) {
                    let quad = view.quad(*surface, point, size, single);
                    let found = if single {
                        let [p_x, p_y, n_x, n_y] = quad.map(|v| v.as_vec3());
                        f64::from(super::mean(p_x, p_y, n_x, n_y))
                    } else {
                        oracle::mean(quad[0], quad[1], quad[2], quad[3])
                    };
                    errors.push((found - mean).abs() / largest);
                }
            }
        }
        let [exact, single] = errors.map(median);
        table += &format!("| {pixels} | {:.3} % | {:.3} % |\n", 100.0 * exact, 100.0 * single);
        // First order: a quarter of the pixel size gives a quarter of the error.
        assert!(last.is_infinite() || (3.6..5.0).contains(&(last / exact)), "{pixels}: {last} {exact}");
        last = exact;
    }
    println!("{table}");
    let page = include_str!("../../../docs/curvature.md");
    assert!(page.contains(&table), "docs/curvature.md should hold:\n{table}");
}

/// Checks a unit sphere under a non-uniform scale: positions are scaled, normals are transformed by
/// the inverse transpose. Renormalised by `normal_derivative`, they give the ellipsoid's curvature;
/// as they are, or with the sphere's normals, they do not.
#[test]
fn non_uniform_scale_is_right_with_renormalised_normals() {
    let mut random = Draws::of_row(4, 0);
    for axes in [DVec3::new(1.0, 0.5, 2.0), DVec3::new(1e-4, 3e-4, 2e-4), DVec3::new(1e4, 1e4, 5e3)] {
        let ellipsoid = Surface::Ellipsoid(axes);
        let (mut raw, mut old) = (0f64, 0f64);
        for _ in 0..5000 {
            let unit = random.direction();
            let point = axes * unit;
            let cosine = random.between_f64(0.1, 1.0);
            let view = View::of(&mut random, point, ellipsoid.normal(point), cosine, 4.0 * axes.max_element());
            let [p_x, p_y, ..] = view.differentials(ellipsoid, point).map(|v| 1e-3 * v);
            // The normal of the sphere is its position; both move with the point of the ellipsoid.
            let [s_x, s_y] = [p_x / axes, p_y / axes];
            let normal = (unit / axes).as_vec3();
            let n_x = normal_derivative(normal, (s_x / axes).as_vec3());
            let n_y = normal_derivative(normal, (s_y / axes).as_vec3());
            let [p, q] = [p_x, p_y].map(|v| v.as_vec3());
            let (mean, gaussian) = ellipsoid.curvature(point);
            let condition = condition([p_x, p_y, n_x.as_dvec3(), n_y.as_dvec3()]);
            let found = f64::from(super::mean(p, q, n_x, n_y));
            assert!((found - mean).abs() <= 32.0 * UNIT * condition, "{found} {mean}");
            let found = f64::from(super::gaussian(p, q, n_x, n_y));
            assert!((found - gaussian).abs() <= 32.0 * UNIT * condition * condition, "{found} {gaussian}");
            let wrong = super::mean(p, q, (s_x / axes).as_vec3(), (s_y / axes).as_vec3());
            raw = larger(raw, (f64::from(wrong) / mean - 1.0).abs());
            let wrong = super::mean(p, q, s_x.as_vec3(), s_y.as_vec3());
            old = larger(old, (f64::from(wrong) / mean - 1.0).abs());
        }
        println!("{axes}: not renormalised off by {raw:.2}, untransformed by {old:.2} of the mean curvature");
        assert!(raw > 0.4 && old > 0.4, "{raw} {old}");
    }
}

/// Checks facets, points, needles and nonsense: the result is always a number, and 0 if there is no
/// surface or no bend.
#[test]
fn degenerate_pixels_are_finite() {
    let lengths = [0.0, 1e-45, 1e-38, 1e-30, 1e-18, 1e-15, 1e-4, 1.0, 1e4, 1e15, 1e30, 1e38];
    let vectors: Vec<Vec3> = lengths
        .iter()
        .flat_map(|length| {
            [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.6, 0.8, 1e-7), Vec3::ONE].map(|v| length * v)
        })
        .collect();
    let normals = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::Y, Vec3::new(1.0, -1.0, 1.0), 1e-30 * Vec3::ONE];
    for p_x in &vectors {
        for p_y in &vectors {
            for n_x in &normals {
                for n_y in &normals {
                    let mut all = vec![mean(*p_x, *p_y, *n_x, *n_y), gaussian(*p_x, *p_y, *n_x, *n_y)];
                    all.extend([Vec3::X, Vec3::Z].map(|light| towards(*p_x, *p_y, *n_x, *n_y, light)));
                    assert!(all.iter().all(|value| value.is_finite()), "{p_x} {p_y} {n_x} {n_y}: {all:?}");
                    let flat = *n_x == Vec3::ZERO && *n_y == Vec3::ZERO;
                    if flat || *p_x == Vec3::ZERO || *p_y == Vec3::ZERO || p_x == p_y {
                        assert!(all.iter().all(|value| *value == 0.0), "{p_x} {p_y} {n_x} {n_y}: {all:?}");
                    }
                }
            }
        }
    }
}

/// Checks that towards the silhouette the mean curvature holds until the pixel is edge-on, then
/// falls to 0 without a jump.
#[test]
fn edge_on_the_curvature_fades() {
    let mut last = 1f32;
    for step in 0..400 {
        let sine = 10f32.powf(-0.02 * step as f32);
        // A sphere of radius 1, whose normal is its position.
        let (p_x, p_y) = (Vec3::new(1.0, 0.25, 0.0), Vec3::new(1.0, 0.25, sine));
        let mean = mean(p_x, p_y, p_x, p_y);
        if sine > 1.1e-3 {
            assert!((mean - 1.0).abs() < 1e-5, "{sine} {mean}");
        } else {
            assert!(mean <= last && last - mean < 0.1, "{sine} {mean}");
        }
        last = mean;
    }
    assert!(last < 1e-6, "{last}");
}

/// Edge-on, the determinant of the textbook form is a difference of nearly equal products.
#[test]
fn the_textbook_fails_edge_on() {
    let mut random = Draws::of_row(5, 0);
    let (mut textbook, mut stable) = (0f32, 0f32);
    for _ in 0..1000 {
        let first = random.direction();
        let second = (first + 2e-3 * random.direction().reject_from(first).normalize()).as_vec3();
        let first = first.as_vec3();
        textbook = larger(textbook, (mean_textbook(first, second, 0.3 * first, 0.3 * second) - 0.3).abs());
        stable = larger(stable, (mean(first, second, 0.3 * first, 0.3 * second) - 0.3).abs());
    }
    println!("off by {textbook} (textbook), {stable} (stable) of 0.3");
    assert!(textbook > 0.01 && stable < 1e-4, "{textbook} {stable}");
}

/// Checks that a light at the zenith gets the mean curvature, and that the normal curvature takes
/// over as it sinks.
#[test]
fn at_the_zenith_the_mean_takes_over() {
    let (p_x, p_y, n_x, n_y) = (Vec3::X, Vec3::Y, Vec3::X, Vec3::ZERO);
    assert_eq!(towards(p_x, p_y, n_x, n_y, Vec3::Z), 0.5);
    let mut last = 0.5;
    for step in 0..200 {
        let sine = 10f32.powf(-6.0 + 0.03 * step as f32);
        let light = Vec3::new(sine, 0.0, (1.0 - sine * sine).sqrt());
        let found = towards(p_x, p_y, n_x, n_y, light);
        assert!(found >= last - 1e-6 && found - last < 0.05 && found <= 1.0 + 1e-6, "{sine} {found}");
        last = found;
    }
    assert!((last - 1.0).abs() < 1e-5);
    assert_eq!(towards(p_x, p_y, n_x, n_y, Vec3::Y), 0.0 + 0.5 * CURVATURE_ZENITH / (1.0 + CURVATURE_ZENITH));
}
