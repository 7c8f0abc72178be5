//! Images of textures, decoded: PNG, JPEG, WebP and KTX2.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::budget::ImageBudget;
use super::error::excerpt;
use crate::Texels;

mod ktx2;

/// An image's data: decoded, or the name of another format.
#[derive(Debug, Clone)]
pub(super) enum Decoded<T> {
    Texels(T),
    Format(&'static str),
}

/// Formats that files hold, and that the `image` crate does not know.
const OTHERS: [(&[u8], &str); 1] = [(b"\xabKTX 11\xbb\r\n\x1a\n", "KTX")];

/// Memory that a decoder may take for itself: the largest image in 16 bits per channel, and as much
/// again for what it keeps beside it.
const DECODER_BYTES: u64 = 2 * 8 * (Texels::LARGEST_SIDE as u64) * (Texels::LARGEST_SIDE as u64);

/// Decodes an image. Its first bytes tell the format, whatever a MIME type says: writers mix up
/// PNG and JPEG.
///
/// Colour profiles, gamma and orientation are passed over, as glTF requires. Grey becomes equal red,
/// green and blue, and a missing alpha 255; 16 bits per channel are rounded to 8.
pub(super) fn decode(bytes: &[u8], budget: &mut ImageBudget) -> Result<Decoded<Texels>, String> {
    if bytes.starts_with(ktx2::MAGIC) {
        let texels = ktx2::decode(bytes, budget)?;
        return Ok(texels.map_or(Decoded::Format("KTX2 without Basis Universal"), Decoded::Texels));
    }
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) => format,
        Ok(other) => return Ok(Decoded::Format(name_of(other))),
        Err(_) => {
            let known = OTHERS.iter().find(|(start, _)| bytes.starts_with(start));
            let unknown = || format!("its {} bytes are no image; export it as PNG or JPEG", bytes.len());
            return known.map(|(_, name)| Decoded::Format(name)).ok_or_else(unknown);
        }
    };
    // Read here first, because the PNG decoder takes memory for a row before it tells the size.
    let stated = (format == ImageFormat::Png).then(|| png_size(bytes)).flatten();
    if let Some(size) = stated {
        budget.take(size)?;
    }
    let undecodable = |reason: &str| format!("it cannot be decoded: {}; save it again as PNG or JPEG", excerpt(reason));
    let failed = |error: image::ImageError| undecodable(&error.to_string());
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(DECODER_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(failed)?;
    let (width, height) = decoder.dimensions();
    if stated != Some([width, height]) {
        budget.take([width, height])?;
    }
    // The decoder fills up what is missing with grey.
    if format == ImageFormat::Jpeg && !is_whole_jpeg(bytes) {
        return Err(undecodable("its data end too early"));
    }
    let image = DynamicImage::from_decoder(decoder).map_err(failed)?.into_rgba8();
    let texels = Texels::new(width, height, image.into_raw());
    texels.map(Decoded::Texels).ok_or_else(|| undecodable("it has no texels"))
}

/// Width and height in a PNG's header, which comes first.
fn png_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let number = |offset: usize| bytes.get(offset..offset + 4)?.try_into().ok().map(u32::from_be_bytes);
    (bytes.get(12..16)? == b"IHDR").then_some([number(16)?, number(20)?])
}

/// Whether a marker ends the image after the start of its last scan. Neither marker occurs within
/// the data of a scan.
fn is_whole_jpeg(bytes: &[u8]) -> bool {
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|pair| pair == marker);
    let (scan, end) = (last([0xff, 0xda]), last([0xff, 0xd9]));
    scan.zip(end).is_some_and(|(scan, end)| scan < end)
}

fn name_of(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Avif => "AVIF",
        ImageFormat::Dds => "DDS",
        ImageFormat::Gif => "GIF",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Tiff => "TIFF",
        ImageFormat::Hdr => "Radiance",
        ImageFormat::OpenExr => "OpenEXR",
        _ => "another format than PNG, JPEG and WebP",
    }
}
