//! Many prisms in one mesh, so that one draw call shows them all: the paper's Fig. 6, and a
//! chandelier.
//!
//! Each prism has its own vertices, and so its own shared normals. That is all the proxy geometry
//! needs to tell prisms apart: it takes no data per prism.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::cuts::{CutError, PrismParameters, prism};
use crate::{Averaging, Mesh};

/// Number of links in the chain.
pub(super) const LINKS: usize = 7;

/// A link: a short prism between flat pyramids.
const LINK: PrismParameters = PrismParameters { sides: 5, radius: 0.5, half_length: 0.2, cap_degrees: 30.0 };
/// Angle of each link from the vertical. Two that lean opposite ways are 20° apart, and touch only
/// at their tips, since the pyramids slope by 30°.
const LEAN_DEGREES: f64 = 10.0;
/// Rotation of each link about its axis relative to the one above. Of the turns 0° to 186° no two
/// are alike under the pentagon's 72°.
const TURN_DEGREES: f64 = 31.0;
/// The golden angle. As the change in lean direction from link to link, it keeps the chain near one
/// vertical line.
const GOLDEN_DEGREES: f64 = 137.507_764;
/// Distance between the tips of two links.
const LINK_GAP: f64 = 0.02;

/// Builds a chain of closed pentagonal prisms that hang from one another by their tips, each at
/// another angle.
pub(super) fn chain() -> Result<Mesh, CutError> {
    let link = prism(&LINK)?.to_mesh(Averaging::default());
    let half_height = DVec3::Y * half_height(&LINK);
    let mut mesh = Mesh::default();
    let mut hook = DVec3::ZERO;
    for k in 0..LINKS {
        let degrees = |step: f64| (step * k as f64).to_radians();
        let lean_about = DQuat::from_rotation_y(degrees(GOLDEN_DEGREES)) * DVec3::X;
        let rotation = DQuat::from_axis_angle(lean_about, LEAN_DEGREES.to_radians())
            * DQuat::from_rotation_y(degrees(TURN_DEGREES));
        let down = rotation * half_height;
        mesh.append(&link.placed(rotation, hook - down));
        hook -= 2.0 * down + DVec3::Y * LINK_GAP;
    }
    Ok(mesh)
}

/// The small prism at the top of each pendant of the chandelier.
const BEAD: PrismParameters = PrismParameters { sides: 5, radius: 0.12, half_length: 0.06, cap_degrees: 45.0 };
/// The long prism below the bead.
const DROP: PrismParameters = PrismParameters { sides: 5, radius: 0.14, half_length: 0.3, cap_degrees: 60.0 };
/// Distance between the tips of bead and drop.
const PENDANT_GAP: f64 = 0.03;

/// Number of rings of the chandelier, including the single pendant in the middle.
const TIERS: u32 = 7;
/// Radius of the outermost ring, which is the highest.
const RADIUS: f64 = 3.0;
/// How much smaller and lower each next ring is.
const INWARDS: f64 = 0.5;
const DOWNWARDS: f64 = 0.75;
/// Distance between neighbours on a ring: drops 0.28 across hang free.
const SPACING: f64 = 0.34;
/// A pendant is turned from facing out by at most half of this.
const SWAY_DEGREES: f64 = 18.0;

/// Returns the number of pendants, of two prisms each, on each ring, from the outermost inwards.
pub(super) fn pendants_by_tier() -> impl Iterator<Item = u32> {
    (0..TIERS).map(|tier| ((TAU * ring_radius(tier) / SPACING) as u32).max(1))
}

/// Builds a chandelier: rings of pendants from wide and high to narrow and low, each with a bead
/// and a drop.
pub(super) fn chandelier() -> Result<Mesh, CutError> {
    let bead = prism(&BEAD)?.to_mesh(Averaging::default());
    let drop = prism(&DROP)?.to_mesh(Averaging::default());
    let drop_centre = DVec3::NEG_Y * (2.0 * half_height(&BEAD) + PENDANT_GAP + half_height(&DROP));
    let bead_centre = DVec3::NEG_Y * half_height(&BEAD);
    let mut mesh = Mesh::default();
    let mut sway = 0.5;
    for (tier, pendants) in (0..TIERS).zip(pendants_by_tier()) {
        let spoke = DVec3::new(0.0, -DOWNWARDS * f64::from(tier), ring_radius(tier));
        for pendant in 0..pendants {
            let azimuth = TAU * f64::from(pendant) / f64::from(pendants);
            let hook = DQuat::from_rotation_y(azimuth) * spoke;
            for (prism, centre) in [(&bead, bead_centre), (&drop, drop_centre)] {
                // Multiples of the golden ratio spread evenly without a pattern.
                sway = (sway + GOLDEN_DEGREES / 360.0) % 1.0;
                let turn = azimuth + (sway - 0.5) * SWAY_DEGREES.to_radians();
                mesh.append(&prism.placed(DQuat::from_rotation_y(turn), hook + centre));
            }
        }
    }
    Ok(mesh)
}

fn ring_radius(tier: u32) -> f64 {
    RADIUS - INWARDS * f64::from(tier)
}

/// Returns the distance from the middle of a prism to the tip of its pyramid.
fn half_height(parameters: &PrismParameters) -> f64 {
    let apothem = parameters.radius * (0.5 * TAU / f64::from(parameters.sides)).cos();
    parameters.half_length + apothem * parameters.cap_degrees.to_radians().tan()
}
