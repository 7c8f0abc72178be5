//! Decoded images of textures.

use std::fmt;

/// An image of 8-bit RGBA texels, row by row from the top: at least one, and at most
/// [`Texels::LARGEST_SIDE`] on a side.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Texels {
    width: u32,
    height: u32,
    bytes: Vec<u8>,
}

impl Texels {
    /// Largest width and height: what every WebGPU device accepts.
    pub const LARGEST_SIDE: u32 = 8192;

    /// Returns an image, or `None` if a side is 0 or above [`Texels::LARGEST_SIDE`], or there are
    /// not four bytes for each texel.
    #[must_use]
    pub fn new(width: u32, height: u32, bytes: Vec<u8>) -> Option<Self> {
        let sides = 1..=Self::LARGEST_SIDE;
        let fits = sides.contains(&width) && sides.contains(&height);
        (fits && bytes.len() as u64 == Self::byte_size(width, height)).then_some(Self { width, height, bytes })
    }

    /// Returns the number of bytes that an image of this size takes.
    #[must_use]
    pub const fn byte_size(width: u32, height: u32) -> u64 {
        (width as u64 * height as u64).saturating_mul(4)
    }

    /// Returns the number of texels in a row.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Returns red, green, blue and alpha of each texel, row by row from the top.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns red, green, blue and alpha of a texel.
    ///
    /// # Panics
    /// Panics if the texel lies outside of the image.
    #[must_use]
    pub fn at(&self, column: u32, row: u32) -> [u8; 4] {
        assert!(column < self.width && row < self.height, "texel ({column}, {row}) of {self:?}");
        let start = 4 * (row as usize * self.width as usize + column as usize);
        std::array::from_fn(|channel| self.bytes[start + channel])
    }

    /// Whether every texel has alpha 255.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.bytes.iter().skip(3).step_by(4).all(|alpha| *alpha == u8::MAX)
    }
}

/// The size alone: the texels of one image would fill a book.
impl fmt::Debug for Texels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Texels({} x {})", self.width, self.height)
    }
}
