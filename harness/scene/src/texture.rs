//! Textures of materials: an image, and how a mesh's texture coordinates find their place in it.

use std::sync::{Arc, LazyLock};

use glam::{Affine2, Vec2, Vec4};

mod texels;

pub use texels::Texels;

/// An image as a material uses it.
///
/// Uses of one image share its texels, also in different encodings, so a renderer needs one upload
/// for each [`Arc`] (`Arc::as_ptr` tells them apart).
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// The image.
    pub texels: Arc<Texels>,
    /// What the bytes of a texel stand for.
    pub encoding: Encoding,
    /// How the image goes on beyond its left and right, and beyond its upper and lower edges.
    pub wrap: [Wrap; 2],
    /// Map from the mesh's texture coordinates to those of the image.
    pub transform: TextureTransform,
}

/// What the bytes of a texel stand for. Alpha is linear in both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// Red, green and blue are sRGB code values: colours.
    Srgb,
    /// All channels are shares of 255: data.
    Linear,
}

/// How an image goes on beyond its edges: a sampler's `wrapS` or `wrapT`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The image again: glTF's default.
    #[default]
    Repeat,
    /// The image again, every second one mirrored.
    MirroredRepeat,
    /// The texels at the edge.
    ClampToEdge,
}

/// `KHR_texture_transform`: texture coordinates are scaled, then turned about the origin, then
/// moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureTransform {
    /// Where the origin goes.
    pub offset: Vec2,
    /// Angle of the turn in radians. With v down, as images are shown, a positive one turns
    /// coordinates counter-clockwise and the picture on the mesh clockwise.
    pub rotation: f32,
    /// Factors of u and v.
    pub scale: Vec2,
}

impl TextureTransform {
    /// The map that leaves coordinates where they are.
    pub const IDENTITY: Self = Self { offset: Vec2::ZERO, rotation: 0.0, scale: Vec2::ONE };

    /// Returns the map as translation · rotation · scale.
    ///
    /// The GLSL of the extension's text turns the other way than its words, its example and the
    /// programs that read it ([glTF issue 1563](https://github.com/KhronosGroup/glTF/issues/1563));
    /// this follows the words.
    #[must_use]
    pub fn affine(&self) -> Affine2 {
        // A turn by a positive angle takes u towards -v, which is up.
        Affine2::from_scale_angle_translation(Vec2::ONE, -self.rotation, self.offset) * Affine2::from_scale(self.scale)
    }
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Texture {
    /// Returns a texture that repeats its image once per unit of the mesh's texture coordinates.
    #[must_use]
    pub fn new(texels: Arc<Texels>, encoding: Encoding) -> Self {
        Self { texels, encoding, wrap: [Wrap::Repeat; 2], transform: TextureTransform::IDENTITY }
    }

    /// Returns the texture's linear value at a mesh's texture coordinates, each channel 0 to 1:
    /// decoded first, then interpolated bilinearly between the centres of texels, without mipmaps.
    /// Coordinates that are not finite after the transform count as 0.
    #[must_use]
    pub fn at(&self, uv: Vec2) -> Vec4 {
        let place = self.transform.affine().transform_point2(uv);
        let (columns, right) = self.wrap[0].neighbours(place.x, self.texels.width());
        let (rows, down) = self.wrap[1].neighbours(place.y, self.texels.height());
        let [upper, lower] = rows.map(|row| {
            let [left, next] = columns.map(|column| self.encoding.decoded(self.texels.at(column, row)));
            left.lerp(next, right)
        });
        upper.lerp(lower, down)
    }

    /// Returns what is invalid and what to do, or `None` if the texture is valid.
    #[must_use]
    pub fn problem(&self) -> Option<&'static str> {
        let TextureTransform { offset, rotation, scale } = self.transform;
        let finite = offset.is_finite() && rotation.is_finite() && scale.is_finite();
        (!finite).then_some("a texture's transform is not finite; mend it")
    }
}

impl Encoding {
    /// Returns the linear value of a texel, each channel 0 to 1.
    #[must_use]
    pub fn decoded(self, texel: [u8; 4]) -> Vec4 {
        static SRGB: LazyLock<[f32; 256]> =
            LazyLock::new(|| std::array::from_fn(|code| lapidary_srgb::oracle::decode(code as f64 / 255.0) as f32));
        let share = |byte: u8| f32::from(byte) / 255.0;
        let [red, green, blue, alpha] = texel;
        let color = match self {
            Self::Srgb => [red, green, blue].map(|code| SRGB[usize::from(code)]),
            Self::Linear => [red, green, blue].map(share),
        };
        Vec4::new(color[0], color[1], color[2], share(alpha))
    }

    /// Returns the texel whose linear value is nearest to this; channels below 0 or above 1 count as these.
    #[must_use]
    pub fn encoded(self, linear: Vec4) -> [u8; 4] {
        let code = |light: f32| match self {
            Self::Srgb => lapidary_srgb::encode(light),
            Self::Linear => light,
        };
        let [red, green, blue, alpha] = linear.to_array();
        [code(red), code(green), code(blue), alpha].map(|share| (255.0 * share).round() as u8)
    }
}

impl Wrap {
    /// Returns the texels on both sides of a coordinate in units of the image's side, and how far
    /// the coordinate lies from the first one's centre towards the second's, 0 to 1.
    fn neighbours(self, coordinate: f32, side: u32) -> ([u32; 2], f32) {
        let coordinate = if coordinate.is_finite() { coordinate } else { 0.0 };
        // First into one period, so that f32 keeps its digits for the texel.
        let within = match self {
            Self::Repeat => coordinate - coordinate.floor(),
            Self::MirroredRepeat => coordinate - 2.0 * (0.5 * coordinate).floor(),
            Self::ClampToEdge => coordinate.clamp(0.0, 1.0),
        };
        let place = within * side as f32 - 0.5;
        let first = place.floor();
        let texels = [first as i64, first as i64 + 1];
        (texels.map(|texel| self.texel(texel, i64::from(side))), place - first)
    }

    /// Returns the texel of an image with this many on a side, at least one, that stands at `texel` of the plane.
    #[must_use]
    pub fn texel(self, texel: i64, side: i64) -> u32 {
        let inside = match self {
            Self::Repeat => texel.rem_euclid(side),
            Self::MirroredRepeat => {
                let place = texel.rem_euclid(2 * side);
                place.min(2 * side - 1 - place)
            }
            Self::ClampToEdge => texel.clamp(0, side - 1),
        };
        inside as u32
    }
}

/// A material's place for a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TextureSlot {
    /// Factor of the base colour, in red, green and blue.
    BaseColor,
    /// Direction of the normal in tangent space, as 2 · RGB - 1.
    Normal,
    /// Factors of the roughness, in green, and of the metallic share, in blue.
    MetallicRoughness,
    /// Factor of the thickness, in green.
    Thickness,
    /// Factor of the transmission, in red.
    Transmission,
    /// Factor of the diffuse transmission, in alpha.
    DiffuseTransmission,
}

impl TextureSlot {
    /// All slots, each once.
    pub const ALL: [Self; 6] = [
        Self::BaseColor,
        Self::Normal,
        Self::MetallicRoughness,
        Self::Thickness,
        Self::Transmission,
        Self::DiffuseTransmission,
    ];

    /// Returns the name of its member in a glTF file.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "baseColorTexture",
            Self::Normal => "normalTexture",
            Self::MetallicRoughness => "metallicRoughnessTexture",
            Self::Thickness => "thicknessTexture",
            Self::Transmission => "transmissionTexture",
            Self::DiffuseTransmission => "diffuseTransmissionTexture",
        }
    }

    /// Returns what the texels of its textures stand for.
    #[must_use]
    pub const fn encoding(self) -> Encoding {
        match self {
            Self::BaseColor => Encoding::Srgb,
            Self::Normal
            | Self::MetallicRoughness
            | Self::Thickness
            | Self::Transmission
            | Self::DiffuseTransmission => Encoding::Linear,
        }
    }
}

#[cfg(test)]
mod tests;
