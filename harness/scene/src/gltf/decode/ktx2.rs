//! KTX2 images in Basis Universal, as `KHR_texture_basisu` allows them: ETC1S with BasisLZ, and UASTC with Zstandard or without.
//!
//! The decoder trusts the lengths and counts of a file, so it is given a container of our own, with the first level alone, whose
//! numbers are known to fit.

use std::io::Read;

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use ruzstd::decoding::StreamingDecoder;

use crate::Texels;
use crate::gltf::budget::ImageBudget;

/// First bytes of a KTX2 file.
pub(super) const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// Bytes of a header, of the entry of one level, and of what precedes the code books of ETC1S images: a header, and a record for each.
const HEADER: usize = 80;
const LEVEL: usize = 24;
const BOOKS_HEADER: usize = 20;
const BOOKS_RECORD: usize = 20;

/// Bytes of a UASTC block of 4 x 4 texels.
const BLOCK: usize = 16;

/// Greatest number of levels: those of the largest side.
const LEVELS: u32 = Texels::LARGEST_SIDE.ilog2() + 1;

/// Numbers of the colour models and of the schemes of compression in the standard.
const ETC1S: u8 = 163;
const UASTC: u8 = 166;
const BASIS_LZ: u32 = 1;
const ZSTANDARD: u32 = 2;

/// What is wrong with a file that ends before it should.
const SHORT: &str = "its KTX2 data end too early; export or download it again";

/// Decodes the first level; `None` if the texels are not in Basis Universal.
pub(super) fn decode(bytes: &[u8], budget: &mut ImageBudget) -> Result<Option<Texels>, String> {
    let file = File(bytes);
    let [format, width, height, depth, layers, faces, levels] =
        [12, 20, 24, 28, 32, 36, 40].map(|offset| file.word(offset));
    let (width, height, levels) = (width?, height?, levels?);
    if (depth?, layers?.max(1), faces?) != (0, 1, 1) {
        return Err("its KTX2 holds more than one flat picture; export one".to_owned());
    }
    if width == 0 || height == 0 || !(1..=LEVELS).contains(&levels) {
        return Err("its KTX2 has no texels, or an impossible number of levels; export it again".to_owned());
    }
    let description = file.range(u64::from(file.word(48)?), u64::from(file.word(52)?))?;
    // The descriptions of one channel, or of colour and alpha.
    let model = description.get(12).filter(|_| [44, 60].contains(&description.len())).copied();
    let scheme = file.word(44)?;
    if format? != 0 || !matches!((model, scheme), (Some(ETC1S), BASIS_LZ) | (Some(UASTC), 0 | ZSTANDARD)) {
        return Ok(None);
    }
    budget.take([width, height])?;

    let level = file.range(file.long(HEADER)?, file.long(HEADER + 8)?)?;
    let blocks = width.div_ceil(4) as usize * height.div_ceil(4) as usize;
    let (books, level) = match scheme {
        BASIS_LZ => (first_books(file.range(file.long(64)?, file.long(72)?)?, levels as usize)?, level.to_vec()),
        ZSTANDARD => (Vec::new(), inflated(level, blocks * BLOCK)?),
        _ => (Vec::new(), level.to_vec()),
    };
    if scheme != BASIS_LZ && level.len() != blocks * BLOCK {
        return Err(SHORT.to_owned());
    }
    let container = container([width, height], scheme == BASIS_LZ, description, &books, &level);
    let undecodable = |_| "its KTX2 cannot be decoded; export or download it again".to_owned();
    let decoder = Transcoder::new(&container).map_err(undecodable)?;
    let texels = decoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(undecodable)?;
    Texels::new(width, height, texels).map(Some).ok_or_else(|| SHORT.to_owned())
}

struct File<'a>(&'a [u8]);

impl<'a> File<'a> {
    fn word(&self, offset: usize) -> Result<u32, String> {
        let word = self.0.get(offset..).and_then(|tail| tail.first_chunk());
        word.map(|word| u32::from_le_bytes(*word)).ok_or_else(|| SHORT.to_owned())
    }

    fn long(&self, offset: usize) -> Result<u64, String> {
        Ok(u64::from(self.word(offset)?) | u64::from(self.word(offset + 4)?) << 32)
    }

    fn range(&self, start: u64, length: u64) -> Result<&'a [u8], String> {
        crate::gltf::buffers::range(self.0, start, length).ok_or_else(|| SHORT.to_owned())
    }
}

/// Returns the global data of ETC1S images with the record of the first level alone.
fn first_books(all: &[u8], levels: usize) -> Result<Vec<u8>, String> {
    let records = levels * BOOKS_RECORD;
    let (first, books) = all.split_at_checked(BOOKS_HEADER + records).ok_or_else(|| SHORT.to_owned())?;
    Ok([&first[..BOOKS_HEADER + BOOKS_RECORD], books].concat())
}

/// Decompresses a level by Zstandard, up to one byte more than it should have.
fn inflated(level: &[u8], length: usize) -> Result<Vec<u8>, String> {
    let damaged = |reason: String| {
        format!(
            "its KTX2 cannot be decompressed: {}; export or download it again",
            crate::gltf::error::excerpt(&reason)
        )
    };
    let decoder = StreamingDecoder::new(level).map_err(|error| damaged(error.to_string()))?;
    let mut bytes = Vec::new();
    decoder.take(length as u64 + 1).read_to_end(&mut bytes).map_err(|error| damaged(error.to_string()))?;
    Ok(bytes)
}

/// Returns a file of one level.
fn container([width, height]: [u32; 2], is_etc1s: bool, description: &[u8], books: &[u8], level: &[u8]) -> Vec<u8> {
    let scheme = if is_etc1s { BASIS_LZ } else { 0 };
    // No overflow: the parts lie in a file, and a level has the bytes of an image that is read.
    let description_at = HEADER + LEVEL;
    let books_at = description_at + description.len();
    let level_at = books_at + books.len();
    let mut bytes = MAGIC.to_vec();
    let words = [0, 1, width, height, 0, 0, 1, 1, scheme, description_at as u32, description.len() as u32, 0, 0];
    bytes.extend(words.into_iter().flat_map(u32::to_le_bytes));
    let unpacked = if is_etc1s { 0 } else { level.len() };
    let books_at = if is_etc1s { books_at } else { 0 };
    let longs = [books_at, books.len(), level_at, level.len(), unpacked];
    bytes.extend(longs.into_iter().flat_map(|number| (number as u64).to_le_bytes()));
    bytes.extend([description, books, level].concat());
    bytes
}
