//! The step cut with cut corners: the emerald cut.

use std::f64::consts::SQRT_2;

use glam::{DVec2, DVec3};

use super::{Checked, CutError};
use crate::polyhedron::{Plane, Polyhedron};

/// One step: a ring of eight facets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Slope of the four straight sides' facets against the girdle plane, in degrees, above 0 and
    /// below 90.
    pub degrees: f64,
    /// Relative share of the inward distance from the girdle, above 0; the shares of a crown or a
    /// pavilion are scaled to add up to the whole distance.
    pub share: f64,
}

/// The proportions of an emerald cut of half-length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepCutParameters {
    /// Width of the outline divided by its length, above 0 and below 1.
    pub width: f64,
    /// Length that the cut corner removes from each side, divided by half the width, above 0 and
    /// below 1.
    pub corner: f64,
    /// Width of the table divided by the width of the outline, above 0 and below 1.
    pub table: f64,
    /// Half the girdle's thickness, above 0 and below 1.
    pub girdle: f64,
    /// The crown's steps from the girdle to the table; slopes must fall.
    pub crown: [Step; 3],
    /// The pavilion's steps from the girdle to the keel; slopes must fall.
    pub pavilion: [Step; 3],
}

impl StepCutParameters {
    /// An emerald with a length-to-width ratio of 1.4, table 62 %, depth 67 % of the width. The
    /// last pavilion step is steeper than beryl's critical angle of 39.4°, so light through the
    /// table returns.
    pub const EMERALD: Self = Self {
        width: 1.0 / 1.4,
        corner: 0.3,
        table: 0.62,
        girdle: 0.02,
        crown: steps([(42.0, 1.0), (34.0, 1.0), (26.0, 1.0)]),
        pavilion: steps([(52.0, 0.25), (46.0, 0.35), (42.0, 0.40)]),
    };
}

const fn steps(steps: [(f64, f64); 3]) -> [Step; 3] {
    let [(a, b), (c, d), (e, f)] = steps;
    [Step { degrees: a, share: b }, Step { degrees: c, share: d }, Step { degrees: e, share: f }]
}

/// Returns an emerald cut with its length along x: table, 24 crown facets from the girdle up, 8
/// girdle facets, 24 pavilion facets from the girdle down to a keel; 57 facets in this order.
///
/// All facets of a step lie between two level octagons with parallel sides. The corner facets move
/// inwards a little faster than the sides, so that they narrow to a point exactly at the ends of
/// the keel.
///
/// # Errors
/// Returns [`CutError::Parameter`] for a parameter outside its range, with steps counted from the
/// girdle, and [`CutError::Facets`] if the parameters together make facets vanish.
pub fn step_cut(parameters: &StepCutParameters) -> Result<Polyhedron, CutError> {
    let check = Checked("step cut");
    let &StepCutParameters { width, corner, table, girdle, crown, pavilion } = parameters;
    check.fraction("width", width)?;
    check.fraction("corner", corner)?;
    check.fraction("table", table)?;
    check.fraction("girdle", girdle)?;
    check_steps(check, "crown", &crown)?;
    check_steps(check, "pavilion", &pavilion)?;

    let outline = Outline::new(width, corner);
    let (crown_planes, table_height) = outline.ring(&crown, (1.0 - table) * width, girdle, 1.0);
    let (pavilion_planes, _) = outline.ring(&pavilion, width, girdle, -1.0);
    let mut planes = vec![Plane::through(DVec3::Z * table_height, DVec3::Z)];
    planes.extend(crown_planes);
    planes.extend(outline.sides.iter().map(|side| Plane { normal: side.outward.extend(0.0), distance: side.distance }));
    planes.extend(pavilion_planes);
    check.solid(&planes, 57)
}

fn check_steps(check: Checked, part: &'static str, steps: &[Step; 3]) -> Result<(), CutError> {
    let mut before = 90.0;
    for step in steps {
        check.slope(part, step.degrees)?;
        let falls = step.degrees < before;
        check.require(falls, part, step.degrees, "below the slope of the step before it")?;
        check.length(part, step.share)?;
        before = step.degrees;
    }
    Ok(())
}

/// One side of the girdle's outline.
#[derive(Debug, Clone, Copy)]
struct Side {
    outward: DVec2,
    distance: f64,
    /// Distance that this side moves inwards while a straight side moves by 1.
    pace: f64,
}

#[derive(Debug, Clone, Copy)]
struct Outline {
    sides: [Side; 8],
}

impl Outline {
    fn new(width: f64, corner: f64) -> Self {
        let corner_distance = (1.0 + width - corner * width) / SQRT_2;
        // At the keel, an inset of `width`, the outline has shrunk to a segment that ends at
        // x = 1 - width; a corner side that passes there meets both neighbours in one point.
        let corner_pace = (corner_distance - (1.0 - width) / SQRT_2) / width;
        let sides = std::array::from_fn(|k| {
            let (distance, pace) = match k % 4 {
                0 => (1.0, 1.0),
                2 => (width, 1.0),
                _ => (corner_distance, corner_pace),
            };
            Side { outward: super::outward(std::f64::consts::FRAC_PI_4 * k as f64), distance, pace }
        });
        Self { sides }
    }

    /// Returns the facets of a crown (`up` = 1) or pavilion (`up` = -1) that moves inwards by
    /// `depth` in all, and the height at which it ends.
    fn ring(&self, steps: &[Step; 3], depth: f64, girdle: f64, up: f64) -> (Vec<Plane>, f64) {
        let shares: f64 = steps.iter().map(|step| step.share).sum();
        let (mut inset, mut height) = (0.0, girdle);
        let mut planes = Vec::with_capacity(steps.len() * self.sides.len());
        for step in steps {
            let run = depth * step.share / shares;
            let rise = run * step.degrees.to_radians().tan();
            planes.extend(self.sides.iter().map(|side| {
                let foot = side.outward * (side.distance - inset * side.pace);
                let normal = (side.outward * rise).extend(up * run * side.pace);
                Plane::through(foot.extend(up * height), normal)
            }));
            inset += run;
            height += rise;
        }
        (planes, up * height)
    }
}
