//! All ladders.

use crate::ladder::Ladder;
use crate::{cdrf, effects, gem, optical_path, translucent};

/// All ladders.
pub const LADDERS: [Ladder; 5] =
    [gem::LADDER, cdrf::LADDER, optical_path::LADDER, effects::LADDER, translucent::LADDER];
