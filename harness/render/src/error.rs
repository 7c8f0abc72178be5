//! Errors of rendering.

use crate::settings::MOST_SAMPLES;
use lapidary_gpu::GpuError;
use lapidary_plan::Rung;
use lapidary_reference::random_walk::mesh;
use lapidary_reference::spectral;

/// Reason why a picture could not be rendered.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// Width or height out of range.
    #[error("size {width}x{height} is out of range; each side must be 1 to {largest} pixels on this device")]
    Size {
        /// Requested width in pixels.
        width: u32,
        /// Requested height in pixels.
        height: u32,
        /// Largest possible side in pixels.
        largest: u32,
    },
    /// Number of samples out of range.
    #[error("{0} samples a side are out of range; take 1 to {MOST_SAMPLES}")]
    Samples(u32),
    /// A mesh or an environment map beyond the limits that every device offers (`wgpu`'s defaults).
    #[error("{what} needs {bytes} bytes in one buffer, and this device offers {limit}; use a smaller one")]
    TooLarge {
        /// The mesh or the map.
        what: String,
        /// Its size in bytes.
        bytes: u64,
        /// Largest possible size in bytes.
        limit: u64,
    },
    /// A stone that is not convex, drawn by an exact rung for convex stones.
    #[error("object `{object}` {reason}, and the convex rungs need a closed convex stone; use a bvh rung")]
    NotConvex {
        /// Name of the object.
        object: String,
        /// Its defect, such as `is not convex`.
        reason: String,
    },
    /// A polished opaque body, which the reference of clear stones would draw without its mirror
    /// image.
    #[error(
        "object `{object}` is opaque and polished, and the reference draws opaque bodies matte; give it a roughness above 0, take another \
         rung, or leave the object out"
    )]
    OpaqueReference {
        /// Name of the object.
        object: String,
    },
    /// A rung whose loops a driver would end early.
    #[error(
        "rung `{rung}` may take {steps} turns of its loops for one pixel, and lavapipe ends them silently after {limit}; \
         take fewer hits or wavelengths, or another adapter"
    )]
    TooManySteps {
        /// The rung.
        rung: Rung,
        /// Number of loop iterations per pixel.
        steps: u64,
        /// Largest number of iterations that the driver allows.
        limit: u64,
    },
    /// More views of lights than shadow maps.
    #[error(
        "the lights need {views} shadow maps, and this device offers {limit}; take fewer lights, or move lamps out of the scene"
    )]
    TooManyViews {
        /// Number of views that the lights need.
        views: usize,
        /// Largest possible number of views.
        limit: u32,
    },
    /// More images of clear bodies, and of others that light from them meets, than a texture has layers.
    #[error(
        "the bodies' materials have more than {limit} images, which light through clear bodies would meet; take fewer, or leave them out: \
         --without base_color_texture,normal_texture,transmission_texture"
    )]
    TooManyImages {
        /// Largest possible number of images.
        limit: usize,
    },
    /// A recipe is not valid.
    #[error(transparent)]
    Kernel(#[from] crate::frame::shader::ShaderError),
    /// An object other than a clear stone; only clear stones can be drawn with a geometry buffer.
    #[error(
        "object `{object}` is drawn by rung `{rung}`, and only clear stones are drawn by way of a geometry buffer; leave --deferred out"
    )]
    NotDeferred {
        /// Name of the object.
        object: String,
        /// Its rung.
        rung: Rung,
    },
    /// A rung that draws no object whose facets' edges can be smoothed.
    #[error(
        "--footprint smooths nothing here: rung {rung} does not find the edges of facets; take --rung walk-8+tracker for a convex stone, or \
         leave --footprint out"
    )]
    NoFootprint {
        /// The rung asked for.
        rung: Rung,
    },
    /// A material that a rung for scattering bodies cannot draw.
    #[error(
        "object `{object}`: its material `{material}` has no sigma0, which rung `{rung}` needs; add extras.lapidary.sigma0, or take a \
         rung for clear stones"
    )]
    NoSigma0 {
        /// Name of the object.
        object: String,
        /// Name of its material.
        material: String,
        /// The rung.
        rung: Rung,
    },
    /// A material without the medium that a rung for light paths needs.
    #[error(
        "object `{object}`: its material `{material}` has no scattering and absorption, which rung `{rung}` needs; add \
         extras.lapidary.scattering and .absorption, give it another --material, or take another rung"
    )]
    NoMedium {
        /// Name of the object.
        object: String,
        /// Name of its material.
        material: String,
        /// The rung.
        rung: Rung,
    },
    /// Texture coordinates that rung `blur` cannot use.
    #[error(
        "object `{object}` has texture coordinates outside 0 to 1, where rung `blur` draws nothing; unwrap it anew, or take another rung"
    )]
    TextureCoordinatesOutside {
        /// Name of the object.
        object: String,
    },
    /// A mesh without texture coordinates, which rung `blur` cannot draw.
    #[error(
        "object `{object}` has no texture coordinates, which rung `blur` needs; add TEXCOORD_0, or take another rung"
    )]
    NoTextureCoordinates {
        /// Name of the object.
        object: String,
    },
    /// An error of the reference of clear stones.
    #[error(transparent)]
    Reference(#[from] spectral::ReferenceError),
    /// An error of the reference of scattering bodies.
    #[error(transparent)]
    Walk(#[from] mesh::WalkError),
    /// An error of the device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl RenderError {
    /// Returns an error if so many bytes are more than a storage buffer holds on every device; `what` names them.
    pub(crate) fn unless_bound(bytes: u64, what: impl FnOnce() -> String) -> Result<(), Self> {
        if bytes > largest_binding() { Err(Self::too_large(bytes, what())) } else { Ok(()) }
    }

    /// Returns that so many bytes are more than a storage buffer holds on every device.
    pub(crate) fn too_large(bytes: u64, what: String) -> Self {
        Self::TooLarge { what, bytes, limit: largest_binding() }
    }
}

/// Returns the largest number of bytes that a storage buffer holds on every device.
fn largest_binding() -> u64 {
    let limits = wgpu::Limits::default();
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}
