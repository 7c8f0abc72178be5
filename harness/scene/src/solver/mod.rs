//! What a material may ask to be drawn by, where it scatters light: the words of `extras.lapidary.solver`, and the limits of what they name.

mod method;
mod reflectance;

pub use method::{Method, Stencil, UnknownMethod};
pub use reflectance::{REFLECTANCES, Reflectance};

use std::fmt;
use std::str::FromStr;

/// Voxels along an edge of the smallest grid.
pub const LEAST_CELLS: u32 = 16;
/// Voxels along an edge of the largest grid.
pub const MOST_CELLS: u32 = 256;
/// The voxels along an edge are a multiple of this: what the passes over voxels take at a time, along any axis, goes into it.
pub const MULTIPLE: u32 = 8;

/// What a table's texture keeps of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits a channel, the paper's.
    Rgba8,
    /// Half floats.
    Rgba16Float,
    /// Single floats; its one channel is looked up once for each of the material's.
    R32Float,
}

/// How light's ways through bodies are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paths {
    /// Voxels along each edge of a body's grid: a multiple of [`MULTIPLE`] from [`LEAST_CELLS`] to [`MOST_CELLS`].
    pub cells: u32,
    /// The solver.
    pub method: Method,
}

/// How a body that scatters light is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// By what the surface sends back.
    Diffuse(Reflectance),
    /// By the cheapest ways through it.
    OpticalPath(Paths),
}

/// Why a text names no solver.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoSolver {
    /// A solver of optical paths with a grid that there is none of.
    #[error("`{0}` cells; a grid has a multiple of {MULTIPLE} from {LEAST_CELLS} to {MOST_CELLS} along each edge")]
    Cells(String),
    /// No solver's name.
    #[error("no such solver")]
    Unknown,
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diffuse(reflectance) => f.write_str(reflectance.name()),
            Self::OpticalPath(Paths { cells, method }) => write!(f, "{method}-{cells}"),
        }
    }
}

impl FromStr for Solver {
    type Err = NoSolver;

    fn from_str(text: &str) -> Result<Self, NoSolver> {
        if let Some((_, reflectance)) = REFLECTANCES.iter().find(|(name, _)| *name == text) {
            return Ok(Self::Diffuse(*reflectance));
        }
        let (method, cells) = text.rsplit_once('-').ok_or(NoSolver::Unknown)?;
        let method: Method = method.parse().map_err(|_| NoSolver::Unknown)?;
        let is_grid = |cells: &u32| (LEAST_CELLS..=MOST_CELLS).contains(cells) && cells.is_multiple_of(MULTIPLE);
        let is_number = cells.bytes().all(|byte| byte.is_ascii_digit());
        let number = cells.parse().ok().filter(|_| is_number).filter(is_grid);
        Ok(Self::OpticalPath(Paths { cells: number.ok_or_else(|| NoSolver::Cells(cells.to_owned()))?, method }))
    }
}
