//! All ladders.

use crate::ladder::Ladder;
use crate::{cdrf, dynamic, effects, gem, optical_path, outside, restraint, sphere, translucent};

/// All ladders.
pub const LADDERS: [Ladder; 9] = [
    gem::LADDER,
    cdrf::LADDER,
    optical_path::LADDER,
    effects::LADDER,
    outside::LADDER,
    translucent::LADDER,
    dynamic::LADDER,
    restraint::LADDER,
    sphere::LADDER,
];
