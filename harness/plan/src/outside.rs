//! What light that leaves a clear stone meets.

use crate::Effect;
use lapidary_files::nearest::suggest;
use std::fmt;
use std::str::FromStr;

/// Most bodies whose bounds are met, the largest ones: each ray that leaves a stone is tested against
/// all of them.
pub const MOST_BODIES: usize = 16;

/// What light that leaves a clear stone meets before the environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// Nothing: the environment alone.
    Environment,
    /// Other bodies as the picture shows them.
    Screen,
    /// The bounds of a few other bodies.
    Bodies,
    /// The triangles of other bodies.
    Triangles,
}

impl Outside {
    /// Every way, from cheap to dear.
    pub const ALL: [Self; 4] = [Self::Environment, Self::Bodies, Self::Screen, Self::Triangles];

    /// Returns the effect that this way needs; `None` for the environment alone.
    #[must_use]
    pub const fn effect(self) -> Option<Effect> {
        match self {
            Self::Environment => None,
            Self::Bodies => Some(Effect::BoundsTrace),
            Self::Screen => Some(Effect::ScreenTrace),
            Self::Triangles => Some(Effect::Around),
        }
    }

    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Environment => "environment",
            Self::Screen => "screen",
            Self::Bodies => "bodies",
            Self::Triangles => "triangles",
        }
    }
}

impl fmt::Display for Outside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Outside {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name);
        let unknown = || format!("expected {}{}", names.join(", "), suggest(text, &names));
        Self::ALL.into_iter().find(|outside| outside.name() == text).ok_or_else(unknown)
    }
}
