//! Why there is no picture.

use super::MOST_SAMPLES;
use lapidary_gpu::GpuError;
use lapidary_plan::Rung;
use lapidary_reference::random_walk::mesh;
use lapidary_reference::spectral;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// Width or height out of range.
    #[error("size {width}x{height} is out of range; each side must be 1 to {largest} pixels on this device")]
    Size {
        /// What was asked for.
        width: u32,
        /// What was asked for.
        height: u32,
        /// What is possible.
        largest: u32,
    },
    /// Too few or too many samples.
    #[error("{0} samples a side are out of range; take 1 to {MOST_SAMPLES}")]
    Samples(u32),
    /// A mesh or an environment map that this device cannot hold.
    #[error("{what} needs {bytes} bytes in one buffer, and this device offers {limit}; use a smaller one")]
    TooLarge {
        /// Which.
        what: String,
        /// How large it is.
        bytes: u64,
        /// What is possible.
        limit: u64,
    },
    /// An exact rung for convex stones, and a stone that is not.
    #[error("object `{object}` {reason}, and the convex rungs need a closed convex stone; use a bvh rung")]
    NotConvex {
        /// Its name.
        object: String,
        /// What is wrong with it, as `is not convex`.
        reason: String,
    },
    /// A body that the reference of clear stones would turn to glass.
    #[error(
        "object `{object}` is opaque, and the reference draws clear stones, or scattering bodies, alone; take another rung, or leave the object out"
    )]
    OpaqueReference {
        /// Its name.
        object: String,
    },
    /// A rung whose loops a driver would end before they are done.
    #[error(
        "rung `{rung}` may take {steps} turns of its loops for one pixel, and lavapipe ends them silently after {limit}; \
         take fewer hits or wavelengths, or another adapter"
    )]
    TooManySteps {
        /// Which.
        rung: Rung,
        /// How many.
        steps: u64,
        /// What the driver allows.
        limit: u64,
    },
    /// More lights than maps.
    #[error(
        "the lights need {views} shadow maps, and this device offers {limit}; take fewer lights, or move lamps out of the scene"
    )]
    TooManyViews {
        /// How many.
        views: usize,
        /// What is possible.
        limit: u32,
    },
    /// A recipe is not valid.
    #[error(transparent)]
    Kernel(#[from] crate::shader::ShaderError),
    /// A geometry buffer holds clear stones alone.
    #[error(
        "object `{object}` is drawn by rung `{rung}`, and only clear stones are drawn by way of a geometry buffer; leave --deferred out"
    )]
    NotDeferred {
        /// Its name.
        object: String,
        /// Its rung.
        rung: Rung,
    },
    /// A material that a rung for scattering cannot draw.
    #[error(
        "object `{object}`: its material `{material}` has no sigma0, which rung `{rung}` needs; add extras.lapidary.sigma0, or take a \
         rung for clear stones"
    )]
    NoSigma0 {
        /// The object's name.
        object: String,
        /// The material's.
        material: String,
        /// The rung.
        rung: Rung,
    },
    /// A material through which no light can be followed.
    #[error(
        "object `{object}`: its material `{material}` has no scattering and absorption, which rung `{rung}` needs; add \
         extras.lapidary.scattering and .absorption, or take another rung"
    )]
    NoMedium {
        /// The object's name.
        object: String,
        /// The material's.
        material: String,
        /// Which rung.
        rung: Rung,
    },
    /// Texture coordinates that a blur cannot use.
    #[error(
        "object `{object}` has texture coordinates outside 0 to 1, where rung `blur` draws nothing; unwrap it anew, or take another rung"
    )]
    TextureCoordinatesOutside {
        /// The object's name.
        object: String,
    },
    /// A mesh that a blur in its texture cannot draw.
    #[error(
        "object `{object}` has no texture coordinates, which rung `blur` needs; add TEXCOORD_0, or take another rung"
    )]
    NoTextureCoordinates {
        /// The object's name.
        object: String,
    },
    /// The reference refuses.
    #[error(transparent)]
    Reference(#[from] spectral::ReferenceError),
    /// The reference of what scatters light refuses.
    #[error(transparent)]
    Walk(#[from] mesh::WalkError),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
