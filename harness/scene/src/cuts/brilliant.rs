//! The round brilliant.

use glam::DVec3;

use super::{Checked, CutError, outward};
use crate::polyhedron::{Plane, Polyhedron};

/// The proportions of a round brilliant with girdle radius 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrilliantParameters {
    /// Radius of the table's corners, above 0 and below 1.
    pub table: f64,
    /// Slope of the bezel facets in degrees, above 0 and below 90.
    pub crown_degrees: f64,
    /// Slope of the pavilion mains in degrees, above 0 and below 90.
    pub pavilion_degrees: f64,
    /// How far a star facet reaches from the table towards the girdle, as a fraction above 0 and
    /// below 1.
    pub star: f64,
    /// How far a lower half reaches from the girdle towards the culet, as a fraction above 0 and
    /// below 1.
    pub lower_halves: f64,
    /// Half the girdle's thickness, above 0 and below 1.
    pub girdle: f64,
}

impl BrilliantParameters {
    /// Tolkowsky's ideal cut (Diamond Design, 1919), with modern star and lower-half lengths.
    pub const TOLKOWSKY: Self =
        Self { table: 0.53, crown_degrees: 34.5, pavilion_degrees: 40.75, star: 0.5, lower_halves: 0.77, girdle: 0.02 };
}

/// Returns a round brilliant with a pointed culet: table, 8 stars, 8 bezels, 16 upper halves, 16
/// girdle facets, 16 lower halves, 8 pavilion mains; 73 facets in this order.
///
/// # Errors
/// Returns [`CutError::Parameter`] for a parameter outside its range, and [`CutError::Facets`] if
/// the parameters together make facets vanish.
pub fn round_brilliant(parameters: &BrilliantParameters) -> Result<Polyhedron, CutError> {
    let check = Checked("round brilliant");
    let &BrilliantParameters { table, crown_degrees, pavilion_degrees, star, lower_halves, girdle } = parameters;
    check.fraction("table", table)?;
    check.slope("crown_degrees", crown_degrees)?;
    check.slope("pavilion_degrees", pavilion_degrees)?;
    check.fraction("star", star)?;
    check.fraction("lower_halves", lower_halves)?;
    check.fraction("girdle", girdle)?;

    // Sixteen corners on the girdle, half of them above mains; the step between two is A.
    let a = std::f64::consts::PI / 8.0;
    let point = |radius: f64, azimuth: f64, z: f64| (outward(azimuth) * radius).extend(z);
    let crown = crown_degrees.to_radians().tan();
    let pavilion = pavilion_degrees.to_radians().tan();
    let table_height = girdle + (1.0 - table) * crown;
    let star_radius = table * a.cos() + star * (1.0 - table * a.cos());
    // The tips of stars and lower halves lie on the two adjacent bezels and mains.
    let star_height = girdle + (1.0 - star_radius * a.cos()) * crown;
    let lower_radius = 1.0 - lower_halves;
    let lower_height = -girdle - (1.0 - lower_radius * a.cos()) * pavilion;

    let turns = (0..8).map(|k| 2.0 * a * f64::from(k));
    // The two halves beside each tip: from the girdle corner over a main to the one in between.
    let halves = |tip_radius: f64, tip_height: f64, z: f64| {
        turns.clone().flat_map(move |azimuth| {
            [-1.0, 1.0].map(|side| {
                facing_out(
                    point(tip_radius, azimuth + side * a, tip_height),
                    point(1.0, azimuth, z),
                    point(1.0, azimuth + side * a, z),
                )
            })
        })
    };
    let mut planes = vec![Plane::through(DVec3::Z * table_height, DVec3::Z)];
    planes.extend(turns.clone().map(|azimuth| {
        facing_out(
            point(table, azimuth, table_height),
            point(table, azimuth + 2.0 * a, table_height),
            point(star_radius, azimuth + a, star_height),
        )
    }));
    planes.extend(turns.clone().map(|azimuth| {
        let normal = (outward(azimuth) * crown).extend(1.0);
        Plane::through(point(1.0, azimuth, girdle), normal)
    }));
    planes.extend(halves(star_radius, star_height, girdle));
    planes.extend((0..16).map(|k| {
        let azimuth = a * (f64::from(k) + 0.5);
        let normal = outward(azimuth).extend(0.0);
        Plane::through(point((0.5 * a).cos(), azimuth, 0.0), normal)
    }));
    planes.extend(halves(lower_radius, lower_height, -girdle));
    planes.extend(turns.map(|azimuth| {
        let normal = (outward(azimuth) * pavilion).extend(-1.0);
        Plane::through(point(1.0, azimuth, -girdle), normal)
    }));
    check.solid(&planes, 73)
}

/// Returns the plane through three points, facing away from the stone's centre at the origin.
fn facing_out(p: DVec3, q: DVec3, r: DVec3) -> Plane {
    let normal = (q - p).cross(r - p);
    let towards = if normal.dot(p) < 0.0 { -normal } else { normal };
    Plane::through(p, towards)
}
