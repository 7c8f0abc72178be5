//! Connections between a point inside a body and a place outside, refracted once on the way.
//!
//! On a flat triangle, Snell's law leaves one path between two points on either side of its plane
//! (the shortest optical path), and the point may or may not lie within the triangle. All triangles
//! together give all paths of one refraction, so that nothing is left to chance. A tree finds them:
//! each triangle sends light into the body in known directions, all of them within a small box, and
//! a point is lit through a group of triangles only if it lies in the beam that the group's box
//! casts along its directions.

use crate::spectral::geometry::Bodies;
use glam::DVec3;
use lapidary_fresnel::oracle::dielectric;

/// A place outside all bodies: a light or the eye.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// Infinitely far away, in this unit direction.
    Far(DVec3),
    /// At this position.
    At(DVec3),
}

/// A path from a point inside a body to a place outside, refracted where it crosses the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    /// Length inside the body.
    pub(super) distance: f64,
    /// Unit direction inside, towards the surface.
    pub(super) direction: DVec3,
    /// Point on the surface.
    pub(super) crossing: DVec3,
    /// Triangle of the crossing.
    pub(super) face: usize,
    /// Irradiance at the point inside, perpendicular to the path, divided by n² and by the
    /// irradiance at the crossing, perpendicular to the path outside: Fresnel's transmittance times
    /// the change of the beam's cross section. The n² is that of the radiance on its way out, if
    /// the source is a light, or of the solid angle under which the eye's pupil is seen.
    pub(super) gain: f64,
}

/// The triangles of a body that face a place outside.
#[derive(Debug)]
pub(super) struct Facing {
    source: Source,
    /// Refractive index of the body relative to its surroundings, above 0.
    index: f64,
    /// In the order of the tree's leaves.
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [DVec3; 3],
    normal: DVec3,
    face: usize,
    beam: Beam,
}

/// A box of positions on the surface, and a box of the unit directions into the body in which light
/// from the source is refracted there.
#[derive(Clone, Copy, Debug)]
struct Beam {
    least: DVec3,
    greatest: DVec3,
    least_direction: DVec3,
    greatest_direction: DVec3,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    reach: Reach,
    content: Content,
}

/// A beam, made ready to be tested for points.
#[derive(Clone, Copy, Debug)]
struct Reach {
    /// The greatest corner of the box of positions and the least.
    corners: [DVec3; 2],
    /// Reciprocals of the greatest directions and the least.
    inverse: [DVec3; 2],
}

#[derive(Clone, Copy, Debug)]
enum Content {
    Leaf(usize),
    /// Index of the second child; the first comes right after the node.
    Inner(usize),
}

/// Boxes are wider than their contents by this share of the coordinates: thousands of roundings.
const MARGIN: f64 = 1e-12;
/// Largest number of steps of a solution, which doubles its digits with each.
const MOST_STEPS: u32 = 60;

impl Facing {
    /// Lists the triangles of a body that face `source`; the body's relative `index` is
    /// above 0.
    pub(super) fn new(bodies: &Bodies, body: usize, source: Source, index: f64) -> Self {
        let triangle = |(face, (corners, normal)): (usize, (&[DVec3; 3], &DVec3))| {
            let (corners, normal) = (*corners, *normal);
            let beam = Beam::new(corners, normal, source, index)?;
            Some(Triangle { corners, normal, face, beam })
        };
        let triangles: Vec<Triangle> = bodies.triangles(body).enumerate().filter_map(triangle).collect();
        let mut facing = Self { source, index, nodes: Vec::with_capacity(2 * triangles.len()), triangles };
        if !facing.triangles.is_empty() {
            facing.split(0, facing.triangles.len());
        }
        facing
    }

    fn split(&mut self, first: usize, end: usize) {
        let triangles = &mut self.triangles[first..end];
        let beam = triangles[1..].iter().fold(triangles[0].beam, |beam, triangle| beam.with(&triangle.beam));
        let place = self.nodes.len();
        self.nodes.push(Node { reach: Reach::of(&beam), content: Content::Leaf(first) });
        if triangles.len() == 1 {
            return;
        }
        let axis = (beam.greatest - beam.least).max_position();
        let middle = triangles.len() / 2;
        let centre = |triangle: &Triangle| triangle.beam.least[axis] + triangle.beam.greatest[axis];
        // Equal centres are ordered by number, so that every machine builds the same tree.
        triangles.select_nth_unstable_by(middle, |a, b| centre(a).total_cmp(&centre(b)).then(a.face.cmp(&b.face)));
        self.split(first, first + middle);
        self.nodes[place].content = Content::Inner(self.nodes.len());
        self.split(first + middle, end);
    }

    /// Calls `visit` with every path to the source from `position` that is at most `limit` long
    /// inside the body. Whether another surface is in the way is not tested.
    pub(super) fn visit(&self, position: DVec3, limit: f64, mut visit: impl FnMut(Path)) {
        // Each level of the tree halves the triangles.
        let (mut waiting, mut count) = ([0; 64], usize::from(!self.nodes.is_empty()));
        while count > 0 {
            count -= 1;
            let place = waiting[count];
            if !self.nodes[place].reach.contains(position, limit) {
                continue;
            }
            match self.nodes[place].content {
                Content::Leaf(triangle) => {
                    if let Some(path) = self.path(&self.triangles[triangle], position, limit) {
                        visit(path);
                    }
                }
                Content::Inner(second) => {
                    (waiting[count], waiting[count + 1]) = (second, place + 1);
                    count += 2;
                }
            }
        }
    }

    /// Finds the path through a triangle.
    fn path(&self, triangle: &Triangle, position: DVec3, limit: f64) -> Option<Path> {
        let &Triangle { corners, normal, face, .. } = triangle;
        let depth = normal.dot(corners[0] - position);
        // Written so that NaN fails.
        if !(depth > 0.0 && depth <= limit) {
            return None;
        }
        let (direction, gain) = match self.source {
            Source::Far(toward) => {
                let direction = -refracted(-toward, normal, self.index)?;
                (direction, self.far_gain(toward.dot(normal), direction.dot(normal)))
            }
            Source::At(place) => {
                let height = normal.dot(place - corners[0]);
                let aside = (place - position) - (depth + height) * normal;
                let width = aside.length();
                let near = crossing(depth, height, width, self.index);
                let aside = if width > 0.0 { aside / width } else { DVec3::ZERO };
                let direction = (near * aside + depth * normal).normalize();
                (direction, self.near_gain(depth, height, (near, width - near)))
            }
        };
        let distance = depth / direction.dot(normal);
        let crossing = position + distance * direction;
        let [a, b, c] = corners;
        let inside = |from: DVec3, to: DVec3| normal.dot((to - from).cross(crossing - from)) >= 0.0;
        let meets = distance <= limit && inside(a, b) && inside(b, c) && inside(c, a);
        meets.then_some(Path { distance, direction, crossing, face, gain })
    }

    /// A beam's cross section changes as its cosine with the surface.
    fn far_gain(&self, outside: f64, inside: f64) -> f64 {
        (1.0 - dielectric(outside, self.index)) * outside / (inside * self.index * self.index)
    }

    /// The cross section of a cone of rays, refracted at a plane.
    ///
    /// Let H and h be the distances from the plane outside and inside, θ and t the angles, l and m
    /// the lengths. Across the plane of incidence, the rays seem to come from the distance
    /// l + m / n; in the plane of incidence, the width at the point changes with θ by
    /// cos t (H / cos² θ + h cos θ / (n cos³ t)). Without a surface, both are l at the crossing.
    fn near_gain(&self, depth: f64, height: f64, (near, far): (f64, f64)) -> f64 {
        let (inner, outer) = (near.hypot(depth), far.hypot(height));
        let (inside, outside) = (depth / inner, height / outer);
        let across = outer + inner / self.index;
        let within =
            inside * (height / (outside * outside) + depth * outside / (self.index * inside * inside * inside));
        (1.0 - dielectric(outside, self.index)) * outer * outer / (across * within * self.index * self.index)
    }
}

impl Beam {
    /// The beam of a triangle; `None` if it faces away from the source.
    fn new(corners: [DVec3; 3], normal: DVec3, source: Source, index: f64) -> Option<Self> {
        let [a, b, c] = corners;
        let directions = match source {
            Source::Far(toward) => refracted(-toward, normal, index).map(|direction| [direction; 2]),
            // Written so that the normal 0 of a triangle without area fails.
            Source::At(place) => (normal.dot(place - a) > 0.0).then(|| {
                let from = |point: DVec3| (place - point).normalize();
                let middle = from((a + b + c) / 3.0);
                // The directions from a triangle are a spherical triangle, no point of which is
                // further from the middle than its corners if they are within a right angle.
                let spread = corners.map(|corner| from(corner).distance(middle)).into_iter().fold(0.0, f64::max);
                if spread > 1.4 {
                    return [DVec3::NEG_ONE, DVec3::ONE];
                }
                let tangential = -(middle - middle.dot(normal) * normal);
                let sine = |sine: f64| (sine / index).clamp(0.0, 1.0);
                let cosine = |sine: f64| ((1.0 - sine) * (1.0 + sine)).sqrt();
                let ends = [sine(tangential.length() - spread), sine(tangential.length() + spread)].map(cosine);
                let [one, other] = ends.map(|cosine| tangential / index - cosine * normal);
                [one.min(other) - spread / index, one.max(other) + spread / index]
            }),
        };
        let [least_direction, greatest_direction] = directions?;
        let (least, greatest) = (a.min(b).min(c), a.max(b).max(c));
        let margin = MARGIN * least.abs().max(greatest.abs()).max_element();
        Some(Self {
            least: least - margin,
            greatest: greatest + margin,
            least_direction: least_direction - MARGIN,
            greatest_direction: greatest_direction + MARGIN,
        })
    }

    fn with(&self, other: &Self) -> Self {
        Self {
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
            least_direction: self.least_direction.min(other.least_direction),
            greatest_direction: self.greatest_direction.max(other.greatest_direction),
        }
    }
}

impl Reach {
    fn of(beam: &Beam) -> Self {
        let (least, greatest) = (beam.least, beam.greatest);
        // A component of 0 sets a bound at infinity.
        let inverse = |direction: DVec3| direction.map(|part| if part.abs() < 1e-300 { 1e300 } else { 1.0 / part });
        Self { corners: [greatest, least], inverse: [inverse(beam.greatest_direction), inverse(beam.least_direction)] }
    }

    /// Whether `position` may be in the beam, at most `limit` from the surface. The coordinates are
    /// tested one by one, as if their directions had nothing to do with each other.
    ///
    /// A coordinate x is reached at the distances d for which a corner + d · direction are not all
    /// on the same side of x: greatest + d · greatest direction >= x >= least + d · least direction.
    fn contains(&self, position: DVec3, limit: f64) -> bool {
        let [greatest, least] = [0, 1].map(|end| (position - self.corners[end]) * self.inverse[end]);
        let [rises, rises_least] = self.inverse.map(|inverse| inverse.cmpgt(DVec3::ZERO));
        let nothing = (DVec3::NEG_INFINITY, DVec3::INFINITY);
        let near = DVec3::select(rises, greatest, nothing.0).max(DVec3::select(rises_least, nothing.0, least));
        let far = DVec3::select(rises, nothing.1, greatest).min(DVec3::select(rises_least, least, nothing.1));
        near.max_element().max(0.0) <= far.min_element().min(limit)
    }
}

/// The unit direction of light refracted into matter of `index`; `None` if it does not come from
/// the normal's side or is reflected totally.
fn refracted(incident: DVec3, normal: DVec3, index: f64) -> Option<DVec3> {
    let cosine = -incident.dot(normal);
    if cosine.is_nan() || cosine <= 0.0 {
        return None;
    }
    let along = (incident + cosine * normal) / index;
    let square = 1.0 - along.length_squared();
    (square > 0.0).then(|| along - square.sqrt() * normal)
}

/// Where the path between two points on either side of a plane crosses it: the width from the foot
/// of the point inside, of `depth`, to the crossing, if the whole `width` leads to the foot of the
/// point outside, of `height`.
///
/// Snell's law n sin t = sin θ. The difference of its sides grows with the crossing's width, so that
/// Newton's method with a bracket finds its one zero. The width inside is the unknown because it has
/// all its digits even if the point outside is far away.
fn crossing(depth: f64, height: f64, width: f64, index: f64) -> f64 {
    let (mut least, mut most) = (0.0, width);
    // Of rays almost along the normal.
    let mut near = width * depth / (depth + index * height);
    for _ in 0..MOST_STEPS {
        let (inner, outer) = (near.hypot(depth), (width - near).hypot(height));
        let excess = index * near / inner - (width - near) / outer;
        if excess > 0.0 {
            most = near;
        } else {
            least = near;
        }
        let slope = index * (depth / inner).powi(2) / inner + (height / outer).powi(2) / outer;
        let next = near - excess / slope;
        let next = if next >= least && next <= most { next } else { 0.5 * (least + most) };
        let step = (next - near).abs();
        near = next;
        if step <= 4.0 * f64::EPSILON * near {
            break;
        }
    }
    near
}

#[cfg(test)]
mod tests;
