//! The ladder of solvers, by name.

use lapidary_files::nearest;
use std::fmt;
use std::str::FromStr;

/// The neighbours that a voxel shares graph edges with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stencil {
    /// Voxels that share a face: 6.
    Faces,
    /// Voxels that share a face or an edge: 18.
    Edges,
    /// Voxels that share a face, an edge or a corner: 26.
    Corners,
}

impl Stencil {
    /// Returns the number of neighbours.
    #[must_use]
    pub fn neighbours(self) -> u32 {
        match self {
            Self::Faces => 6,
            Self::Edges => 18,
            Self::Corners => 26,
        }
    }
}

/// How the least costs are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The paper's method: voxels that were just written offer their cost and the extinction to
    /// their six neighbours, regardless of the edge's length.
    Paper,
    /// Every voxel takes the least of its neighbours' offers, in every pass.
    PingPong(Stencil),
    /// The same costs, but only tiles that change are updated.
    Tiled(Stencil),
    /// The Eikonal equation by tiles: paths in any direction.
    Godunov,
}

impl Method {
    /// All methods, from the first rung to the last.
    pub const ALL: [Self; 8] = [
        Self::Paper,
        Self::PingPong(Stencil::Faces),
        Self::PingPong(Stencil::Edges),
        Self::PingPong(Stencil::Corners),
        Self::Tiled(Stencil::Faces),
        Self::Tiled(Stencil::Edges),
        Self::Tiled(Stencil::Corners),
        Self::Godunov,
    ];

    /// Returns the name that a user types.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::PingPong(Stencil::Faces) => "ping-pong-6",
            Self::PingPong(Stencil::Edges) => "ping-pong-18",
            Self::PingPong(Stencil::Corners) => "ping-pong-26",
            Self::Tiled(Stencil::Faces) => "tiled-6",
            Self::Tiled(Stencil::Edges) => "tiled-18",
            Self::Tiled(Stencil::Corners) => "tiled-26",
            Self::Godunov => "godunov",
        }
    }

    /// Returns the stencil of the graph that the method solves; faces for Godunov's update, which
    /// reads no other neighbours.
    #[must_use]
    pub fn stencil(self) -> Stencil {
        match self {
            Self::PingPong(stencil) | Self::Tiled(stencil) => stencil,
            Self::Paper | Self::Godunov => Stencil::Faces,
        }
    }

    /// Whether the method works by tiles.
    #[must_use]
    pub fn is_tiled(self) -> bool {
        matches!(self, Self::Tiled(_) | Self::Godunov)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that belongs to no solver.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no solver `{name}`{suggestion}")]
pub struct UnknownMethod {
    /// The name that was given.
    pub name: String,
    /// `; did you mean ...?` or a list of the valid names.
    pub suggestion: String,
}

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(text: &str) -> Result<Self, UnknownMethod> {
        let unknown =
            || UnknownMethod { name: text.to_owned(), suggestion: nearest::suggest(text, &Self::ALL.map(Self::name)) };
        Self::ALL.into_iter().find(|method| method.name() == text).ok_or_else(unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for method in Method::ALL {
            assert_eq!(method.to_string().parse(), Ok(method));
        }
        let error = "tiled-8".parse::<Method>().expect_err("no such solver").to_string();
        assert!(error.contains("`tiled-8`") && error.contains("did you mean `tiled-"), "{error}");
    }
}
