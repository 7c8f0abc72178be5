//! The rotation and scale that take one form to another.

use glam::{DMat3, DQuat, DVec3};

use super::form::Form;
use crate::weld::Grid;

/// Least sine of the angle between the two corners by which a rotation is found.
const LEAST_SINE: f64 = 0.2;
/// Least distance of these from the middle.
const LEAST_RADIUS: f64 = 0.25;
/// Pairs of corners, and rotations, that are tried for two forms.
const MOST_PAIRS: usize = 1 << 16;
const MOST_ROTATIONS: usize = 1 << 10;
/// How often corners are paired anew.
const ROUNDS: usize = 4;
/// Largest difference of two mean normals that count as the same: twice what 6 bits a part leave.
const NORMALS: f64 = 1.0 / 16.0;
/// How many times wider than the noise a corner is looked for by the rotation of two corners: their own error turns the farthest
/// by about 1 / (LEAST_RADIUS LEAST_SINE) times as much.
const COARSE: f64 = 16.0;

/// How one form becomes another.
#[derive(Debug, Clone)]
pub(super) struct Alignment {
    pub(super) rotation: DQuat,
    /// Ratio of the two, in each one's unit, near 1.
    pub(super) scale: f64,
    /// Number of the other form's corner for each corner.
    pub(super) partners: Vec<usize>,
}

/// A form with which others are compared.
#[derive(Debug)]
pub(super) struct Reference {
    pub(super) form: Form,
    /// Two corners of which as few others as possible are as far from the middle.
    anchors: Option<[usize; 2]>,
    measures: [f64; 3],
    /// Its corners, for a tolerance.
    grid: Option<(f64, Grid)>,
}

/// Steps that are left for looking up corners.
#[derive(Debug)]
pub(super) struct Budget(pub(super) usize);

impl Budget {
    /// Takes the steps of looking up a corner in a grid of which the fullest cell has so many.
    fn take(&mut self, fullest: usize) -> Option<()> {
        self.0 = self.0.checked_sub(1 + fullest / 4)?;
        Some(())
    }
}

impl Reference {
    pub(super) fn of(form: Form) -> Self {
        Self { anchors: anchors(&form), measures: form.measures(), form, grid: None }
    }

    /// Returns how this form becomes another with as many corners; `None` if it does not.
    pub(super) fn align(&mut self, other: &Form, budget: &mut Budget) -> Option<Alignment> {
        let own = &self.form;
        let noise = own.noise + other.noise;
        // A corner's error, that of the middle, and that of the unit, which grows with the distance.
        let is_near = |(one, other): (&f64, &f64)| (one - other).abs() <= (2.0 + one) * noise;
        if own.normals.is_empty() != other.normals.is_empty() || !own.radii.iter().zip(&other.radii).all(is_near) {
            return None;
        }
        let [a, b] = self.anchors?.map(|number| own.points[number]);
        let wide = COARSE * noise;
        if self.grid.as_ref().is_none_or(|(tolerance, _)| *tolerance != wide) {
            let mut grid = Grid::new(wide);
            own.points.iter().for_each(|point| {
                grid.add(*point);
            });
            self.grid = Some((wide, grid));
        }
        let grid = &self.grid.as_ref()?.1;
        let fullest = grid.fullest();
        let own_frame = frame(a, b);
        let (mut pairs, mut rotations) = (0, 0);
        let radius = |point: DVec3| (point.length(), (2.0 + point.length()) * noise);
        let ((a_radius, a_within), (b_radius, b_within)) = (radius(a), radius(b));
        let seconds = other.at_radius(b_radius, b_within);
        for first in other.at_radius(a_radius, a_within) {
            for &second in &seconds {
                pairs += 1;
                if pairs > MOST_PAIRS || rotations > MOST_ROTATIONS {
                    return None;
                }
                let (first, second) = (other.points[first], other.points[second]);
                if (first.distance(second) - a.distance(b)).abs() > a_within + b_within {
                    continue;
                }
                rotations += 1;
                let rotation = frame(first, second) * own_frame.transpose();
                let found = self.settled(grid, fullest, other, rotation, budget);
                if let Some(found) = found.filter(|found| self.is_same(other, found)) {
                    return Some(found);
                }
            }
        }
        None
    }

    /// Returns the alignment to which a first rotation leads: of noisy corners the nearest may be wrong, until all together
    /// have turned the form.
    fn settled(
        &self,
        grid: &Grid,
        fullest: usize,
        other: &Form,
        mut rotation: DMat3,
        budget: &mut Budget,
    ) -> Option<Alignment> {
        for _ in 0..ROUNDS {
            let pairs = nearest(grid, fullest, other, rotation, budget)?;
            if let Some(found) = refined(&self.form, other, &pairs) {
                return Some(found);
            }
            rotation = fitted(&self.form, other, &pairs)?.0;
        }
        None
    }

    /// Whether corners that agree are joined by the same surface, with the same normals.
    fn is_same(&self, other: &Form, alignment: &Alignment) -> bool {
        let own = &self.form;
        let noise = own.noise + other.noise;
        let turned = |number: usize| alignment.rotation * own.normals[number];
        let normals = (0..own.normals.len())
            .all(|number| turned(number).distance(other.normals[alignment.partners[number]]) <= NORMALS);
        let place = |triangle: &[usize; 3]| {
            let mut places = triangle.map(|number| alignment.partners[number]);
            let least = (0..3).min_by_key(|&k| places[k]).unwrap_or_default();
            places.rotate_left(least);
            places
        };
        let mut triangles: Vec<[usize; 3]> = own.triangles.iter().map(place).collect();
        triangles.sort_unstable();
        // Facets may be cut into triangles otherwise: then volume and area tell, to what moving the corners changes.
        let by_measure = || {
            let ([volume, area, length], [of_volume, of_area, _]) = (self.measures, other.measures());
            (volume - of_volume).abs() <= 4.0 * noise * area && (area - of_area).abs() <= 4.0 * noise * length
        };
        normals && (triangles == other.triangles || triangles.len() == other.triangles.len() && by_measure())
    }
}

/// Returns two corners by which a form's rotation is known.
fn anchors(form: &Form) -> Option<[usize; 2]> {
    let alike = |number: usize| {
        let radius = form.points[number].length();
        form.within(radius, (2.0 + radius) * 2.0 * form.noise).len()
    };
    let far = || form.order.iter().copied().filter(|&number| form.points[number].length() >= LEAST_RADIUS);
    let counted: Vec<(usize, usize)> = far().map(|number| (alike(number), number)).collect();
    let &(_, first) = counted.iter().min()?;
    let a = form.points[first].normalize();
    let is_aside = |number: usize| a.cross(form.points[number].normalize()).length() >= LEAST_SINE;
    let &(_, second) = counted.iter().filter(|(_, number)| is_aside(*number)).min()?;
    Some([first, second])
}

/// Returns right-handed axes, the first along `a` and the second in the plane of both.
fn frame(a: DVec3, b: DVec3) -> DMat3 {
    let x = a.normalize_or_zero();
    let z = x.cross(b).normalize_or_zero();
    DMat3::from_cols(x, z.cross(x), z)
}

/// Returns for each corner of a form the nearest one of that in `grid` which `rotation` takes there.
fn nearest(grid: &Grid, fullest: usize, other: &Form, rotation: DMat3, budget: &mut Budget) -> Option<Vec<usize>> {
    let back = rotation.transpose();
    let nearest = |point: &DVec3| {
        budget.take(fullest)?;
        grid.nearest(back * *point)
    };
    other.points.iter().map(nearest).collect()
}

/// Returns the rotation and scale that take the corners nearest to their partners (Kabsch, 1976). `pairs` has for each corner of
/// the other form that of this one.
fn fitted(own: &Form, other: &Form, pairs: &[usize]) -> Option<(DMat3, f64)> {
    let pairs = || pairs.iter().zip(&other.points).map(|(&number, partner)| (own.points[number], *partner));
    let mut covariance = DMat3::ZERO;
    for (point, partner) in pairs() {
        covariance += DMat3::from_cols(partner * point.x, partner * point.y, partner * point.z);
    }
    let rotation = nearest_rotation(covariance)?;
    let along: f64 = pairs().map(|(point, partner)| partner.dot(rotation * point)).sum();
    Some((rotation, along / pairs().map(|(point, _)| point.length_squared()).sum::<f64>()))
}

/// Returns the alignment by pairs, if each corner is in one and all agree within twice the noise: that of the corners, and what
/// it leaves of rotation, scale and middle.
fn refined(own: &Form, other: &Form, pairs: &[usize]) -> Option<Alignment> {
    let mut partners = vec![usize::MAX; own.points.len()];
    for (number, &pair) in pairs.iter().enumerate() {
        if partners[pair] != usize::MAX {
            return None;
        }
        partners[pair] = number;
    }
    let (rotation, scale) = fitted(own, other, pairs)?;
    let most = 2.0 * (own.noise + other.noise);
    let away = |(point, &partner): (&DVec3, &usize)| other.points[partner].distance(scale * (rotation * *point));
    let agrees = own.points.iter().zip(&partners).all(|pair| away(pair) <= most);
    agrees.then_some(Alignment { rotation: DQuat::from_mat3(&rotation), scale, partners })
}

/// Returns the rotation nearest to a matrix, by Newton's iteration for its polar factor (Higham, 1986).
fn nearest_rotation(matrix: DMat3) -> Option<DMat3> {
    const STEPS: usize = 40;
    let mut rotation = matrix;
    for _ in 0..STEPS {
        let determinant = rotation.determinant();
        if !(determinant.abs() > f64::MIN_POSITIVE && determinant.is_finite()) {
            return None;
        }
        let next = 0.5 * (rotation + rotation.inverse().transpose());
        let is_done = next.abs_diff_eq(rotation, 1e-15);
        rotation = next;
        if is_done {
            break;
        }
    }
    (rotation.determinant() > 0.5).then_some(rotation)
}
