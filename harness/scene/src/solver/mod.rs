//! Techniques that a scattering material may request: the words of `extras.lapidary.solver`, and
//! the limits of their parameters.

mod method;
mod reflectance;

pub use method::{Method, Stencil, UnknownMethod};
pub use reflectance::{Format, REFLECTANCES, Reflectance};

use std::fmt;
use std::str::FromStr;

/// Number of voxels along an edge of the smallest grid.
pub const LEAST_CELLS: u32 = 16;
/// Number of voxels along an edge of the largest grid.
pub const MOST_CELLS: u32 = 256;
/// Number of cells along an edge of the largest grid for diffusion, which is voxelized at twice as
/// many.
pub const MOST_DIFFUSION_CELLS: u32 = MOST_CELLS / 2;
/// What the names of rungs by diffusion begin with.
const DIFFUSION: &str = "diffusion";
/// The same with the flux limiter.
const LIMITED: &str = "diffusion-limited";
/// The number of voxels along an edge is a multiple of this, because the passes over voxels work in
/// blocks that divide it along any axis.
pub const MULTIPLE: u32 = 8;

/// How paths of light through bodies are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paths {
    /// Number of voxels along each edge of a body's grid: a multiple of [`MULTIPLE`] from
    /// [`LEAST_CELLS`] to [`MOST_CELLS`].
    pub cells: u32,
    /// Solver for the path costs.
    pub method: Method,
}

/// How a scattering body is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// Reflectance at the surface.
    Diffuse(Reflectance),
    /// Cheapest optical paths through the body.
    OpticalPath(Paths),
    /// Diffusion through the body.
    Diffusion(Diffusion),
}

/// How light diffuses through a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Diffusion {
    /// Number of cells along each edge of a body's grid: a multiple of [`MULTIPLE`] from [`LEAST_CELLS`] to
    /// [`MOST_DIFFUSION_CELLS`].
    pub cells: u32,
    /// Whether a flux limiter keeps the flux below the fluence. It takes more time, and the light of several lights no
    /// longer adds up.
    pub limited: bool,
}

impl Diffusion {
    /// Returns diffusion without a limiter, on a grid with this number of cells along each edge.
    #[must_use]
    pub const fn of(cells: u32) -> Self {
        Self { cells, limited: false }
    }
}

/// Why a text names no solver.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoSolver {
    /// A solver on a grid of an invalid size.
    #[error("`{cells}` cells; a grid has a multiple of {MULTIPLE} from {LEAST_CELLS} to {most} along each edge")]
    Cells {
        /// The size that was given.
        cells: String,
        /// The largest size.
        most: u32,
    },
    /// Not a solver's name.
    #[error("no such solver")]
    Unknown,
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diffuse(reflectance) => f.write_str(reflectance.name()),
            Self::OpticalPath(Paths { cells, method }) => write!(f, "{method}-{cells}"),
            Self::Diffusion(Diffusion { cells, limited: false }) => write!(f, "{DIFFUSION}-{cells}"),
            Self::Diffusion(Diffusion { cells, limited: true }) => write!(f, "{LIMITED}-{cells}"),
        }
    }
}

impl FromStr for Solver {
    type Err = NoSolver;

    fn from_str(text: &str) -> Result<Self, NoSolver> {
        if let Some((_, reflectance)) = REFLECTANCES.iter().find(|(name, _)| *name == text) {
            return Ok(Self::Diffuse(*reflectance));
        }
        let (method, cells) = text.rsplit_once('-').filter(|_| text != LIMITED).ok_or(NoSolver::Unknown)?;
        let grid = |most: u32| {
            let is_grid = |cells: &u32| (LEAST_CELLS..=most).contains(cells) && cells.is_multiple_of(MULTIPLE);
            let is_number = cells.bytes().all(|byte| byte.is_ascii_digit());
            let number = cells.parse().ok().filter(|_| is_number).filter(is_grid);
            number.ok_or_else(|| NoSolver::Cells { cells: cells.to_owned(), most })
        };
        if let Some((_, limited)) = [(DIFFUSION, false), (LIMITED, true)].into_iter().find(|(name, _)| *name == method)
        {
            return Ok(Self::Diffusion(Diffusion { cells: grid(MOST_DIFFUSION_CELLS)?, limited }));
        }
        let method: Method = method.parse().map_err(|_| NoSolver::Unknown)?;
        Ok(Self::OpticalPath(Paths { cells: grid(MOST_CELLS)?, method }))
    }
}
