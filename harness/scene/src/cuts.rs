//! Gem cuts as lists of planes: z up, the table or the upper cap towards +z, size about 1.

use glam::{DVec2, DVec3};
use thiserror::Error;

use super::polyhedron::{Plane, Polyhedron, PolyhedronError};

mod brilliant;
mod step;

pub use brilliant::{BrilliantParameters, round_brilliant};
pub use step::{Step, StepCutParameters, step_cut};

/// Why parameters do not make a stone.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CutError {
    /// A parameter outside its range.
    #[error("{cut}: {parameter} is {value}, but must lie {range}")]
    Parameter {
        /// Name of the cut.
        cut: &'static str,
        /// Name of the parameter's field.
        parameter: &'static str,
        /// The value that was given.
        value: f64,
        /// The valid range, as in "above 0 and below 1".
        range: &'static str,
    },
    /// Each parameter is in range, but together they make some facets vanish.
    #[error(
        "{cut}: these proportions give {found} facets instead of {expected}; \
         move them closer to the cut's usual ones"
    )]
    Facets {
        /// Name of the cut.
        cut: &'static str,
        /// Number of facets of the cut.
        expected: usize,
        /// Number of facets that remain.
        found: usize,
    },
    /// The planes do not form a closed solid.
    #[error("{cut}: {problem}")]
    Open {
        /// Name of the cut.
        cut: &'static str,
        /// What is wrong with the planes.
        problem: PolyhedronError,
    },
}

/// Checks one cut's parameters and names the cut in their errors.
#[derive(Debug, Clone, Copy)]
struct Checked(&'static str);

impl Checked {
    fn fraction(self, parameter: &'static str, value: f64) -> Result<(), CutError> {
        let proper = value > 0.0 && value < 1.0;
        self.require(proper, parameter, value, "above 0 and below 1")
    }

    fn slope(self, parameter: &'static str, degrees: f64) -> Result<(), CutError> {
        let proper = degrees > 0.0 && degrees < 90.0;
        self.require(proper, parameter, degrees, "above 0 and below 90 degrees")
    }

    fn length(self, parameter: &'static str, value: f64) -> Result<(), CutError> {
        let proper = value > 0.0 && value <= 100.0;
        self.require(proper, parameter, value, "above 0 and at most 100")
    }

    fn require(self, proper: bool, parameter: &'static str, value: f64, range: &'static str) -> Result<(), CutError> {
        let error = CutError::Parameter { cut: self.0, parameter, value, range };
        if proper { Ok(()) } else { Err(error) }
    }

    /// Returns the solid of `planes`, which must have `expected` facets.
    fn solid(self, planes: &[Plane], expected: usize) -> Result<Polyhedron, CutError> {
        let solid = Polyhedron::from_planes(planes).map_err(|problem| CutError::Open { cut: self.0, problem })?;
        let found = solid.planes().len();
        if found == expected { Ok(solid) } else { Err(CutError::Facets { cut: self.0, expected, found }) }
    }
}

/// Returns the unit vector at `azimuth` radians from x towards y.
fn outward(azimuth: f64) -> DVec2 {
    DVec2::from_angle(azimuth)
}

/// Returns a regular octahedron, the usual form of rough diamond, with its corners at distance 1 on
/// the axes.
///
/// # Errors
/// None with these fixed planes; the type is that of the other cuts.
pub fn octahedron() -> Result<Polyhedron, CutError> {
    let signs = [1.0, -1.0];
    let planes = signs.map(|x| signs.map(|y| signs.map(|z| DVec3::new(x, y, z))));
    let planes: Vec<Plane> = planes.iter().flatten().flatten().map(|&normal| Plane { normal, distance: 1.0 }).collect();
    Checked("octahedron").solid(&planes, 8)
}

/// A regular prism along z, closed by a pyramid or a flat face at each end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrismParameters {
    /// Number of side faces, 3 to 64.
    pub sides: u32,
    /// Distance of the side edges from the axis, above 0 and at most 100.
    pub radius: f64,
    /// Half the length of a side edge, above 0 and at most 100.
    pub half_length: f64,
    /// Slope of the cap faces against the horizontal in degrees, 0 (one flat face) to below 90.
    pub cap_degrees: f64,
}

impl PrismParameters {
    /// A closed pentagonal prism, about 2 long. Its caps have the slope of quartz's rhombohedral
    /// faces, 51.8°.
    pub const PENTAGONAL: Self = Self { sides: 5, radius: 0.45, half_length: 0.6, cap_degrees: 51.8 };
}

/// Returns a regular prism with `sides` side faces and as many cap faces at each end, or one if
/// flat.
///
/// # Errors
/// Returns [`CutError::Parameter`] for a parameter outside its range.
pub fn prism(parameters: &PrismParameters) -> Result<Polyhedron, CutError> {
    let check = Checked("prism");
    let &PrismParameters { sides, radius, half_length, cap_degrees } = parameters;
    check.require((3..=64).contains(&sides), "sides", sides.into(), "from 3 to 64")?;
    check.length("radius", radius)?;
    check.length("half_length", half_length)?;
    let sloped = (0.0..90.0).contains(&cap_degrees);
    check.require(sloped, "cap_degrees", cap_degrees, "from 0 to below 90 degrees")?;

    let half_turn = std::f64::consts::PI / f64::from(sides);
    let apothem = radius * half_turn.cos();
    let (sine, cosine) = cap_degrees.to_radians().sin_cos();
    let mut planes = Vec::with_capacity(3 * sides as usize);
    for side in 0..sides {
        let across = outward(2.0 * half_turn * f64::from(side));
        planes.push(Plane { normal: across.extend(0.0), distance: apothem });
        for up in [1.0, -1.0] {
            let edge = (across * apothem).extend(up * half_length);
            planes.push(Plane::through(edge, (across * sine).extend(up * cosine)));
        }
    }
    let caps = if cap_degrees == 0.0 { 2 } else { 2 * sides };
    check.solid(&planes, (sides + caps) as usize)
}

#[cfg(test)]
mod tests;
