//! Text on pictures.

use lapidary_render::Picture;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

const HEIGHT: RasterHeight = RasterHeight::Size16;
const WEIGHT: FontWeight = FontWeight::Regular;
/// Distance of the text from the picture's upper left corner, in pixels.
const MARGIN: usize = 6;
/// Share of the light that the ground of the text keeps, of 255.
const GROUND: u32 = 90;
/// Code value of the text.
const SHADE: u8 = 225;

/// Writes lines of text on a dark ground into the upper left corner of the encoded picture. What does not fit is cut off.
pub(super) fn label(picture: &mut Picture, lines: &[&str]) {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let lines: Vec<&str> = lines.iter().copied().filter(|line| !line.is_empty()).collect();
    let Some(letters) = lines.iter().map(|line| line.chars().count()).max() else { return };
    let right = 2 * MARGIN + letters * get_raster_width(WEIGHT, HEIGHT);
    let below = 2 * MARGIN + lines.len() * HEIGHT.val();
    for row in 0..below.min(height) {
        for pixel in &mut picture.encoded[row * width..][..right.min(width)] {
            pixel[..3].iter_mut().for_each(|value| *value = (u32::from(*value) * GROUND / 255) as u8);
        }
    }
    for (number, line) in lines.iter().enumerate() {
        for (place, letter) in line.chars().enumerate() {
            let Some(raster) = get_raster(letter, WEIGHT, HEIGHT) else { continue };
            let [left, top] = [MARGIN + place * get_raster_width(WEIGHT, HEIGHT), MARGIN + number * HEIGHT.val()];
            for (y, row) in raster.raster().iter().enumerate() {
                for (x, &weight) in row.iter().enumerate() {
                    let (x, y) = (left + x, top + y);
                    if x < width && y < height {
                        let pixel = &mut picture.encoded[y * width + x];
                        pixel[..3].iter_mut().for_each(|value| *value = over(*value, weight));
                    }
                }
            }
        }
    }
}

fn over(below: u8, weight: u8) -> u8 {
    let (below, weight, shade) = (u32::from(below), u32::from(weight), u32::from(SHADE));
    ((below * (255 - weight) + shade * weight + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_written_and_what_does_not_fit_is_cut_off() {
        for (side, line, is_written) in
            [(64u32, "walks", true), (64, "", false), (4, "walks", false), (16, "walks", true)]
        {
            let pixels = (side * side) as usize;
            let (linear, encoded) = (vec![[0.0; 4]; pixels], vec![[7, 7, 7, 255]; pixels]);
            let mut picture =
                Picture { width: side, height: side, linear, encoded, lost: None, walked: None, notes: Vec::new() };
            label(&mut picture, &[line, line]);
            assert_eq!(picture.encoded.iter().any(|pixel| pixel[0] > 150), is_written, "{side} {line}");
            assert!(picture.encoded.iter().all(|pixel| pixel[3] == 255 && pixel[0] <= SHADE));
        }
    }
}
