//! A rendered picture.

use lapidary_plan::Note;
use lapidary_reference::spectral::Lost;

/// A rendered picture, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear radiance and coverage.
    pub linear: Vec<[f32; 4]>,
    /// sRGB: the mean of the tone-mapped samples, if there are samples. Opaque, or, without a backdrop, with straight alpha.
    pub encoded: Vec<[u8; 4]>,
    /// Energy that the reference of clear stones did not follow; `None` if it did not render the
    /// picture.
    pub lost: Option<Lost>,
    /// Quality of the reference of scattering bodies; `None` if it did not render the picture.
    pub walked: Option<WalkedPicture>,
    /// Warnings.
    pub notes: Vec<Note>,
}

/// Quality of a picture rendered by random walks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkedPicture {
    /// Root mean square of the pixels' standard errors, relative to the mean brightness, both over
    /// pixels that show a body.
    pub error: f64,
    /// Number of samples that met a body.
    pub walks: u64,
    /// Number of walks that slipped through a surface by rounding and were dropped.
    pub lost: u64,
}
