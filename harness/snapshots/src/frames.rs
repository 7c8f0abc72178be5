//! Pictures of the same size side by side.

use lapidary_render::Picture;

/// Arranges the pictures in rows of `columns` each.
pub(super) fn side_by_side(frames: &[Picture], columns: u32) -> Picture {
    let (wide, high) = frames.first().map_or((0, 0), |frame| (frame.width, frame.height));
    let [width, height] = [columns * wide, frames.len() as u32 / columns * high];
    let pixel = |index: u32| {
        let (column, row) = (index % width, index / width);
        let frame = &frames[(row / high * columns + column / wide) as usize];
        (frame, (row % high * wide + column % wide) as usize)
    };
    Picture {
        width,
        height,
        linear: (0..width * height).map(pixel).map(|(frame, place)| frame.linear[place]).collect(),
        encoded: (0..width * height).map(pixel).map(|(frame, place)| frame.encoded[place]).collect(),
        lost: None,
        walked: None,
        notes: frames.iter().flat_map(|frame| frame.notes.clone()).collect(),
    }
}

/// Averages each block of two by two pixels; linear radiance only.
#[must_use]
pub fn halved(picture: &Picture) -> Picture {
    let [width, height] = [picture.width / 2, picture.height / 2];
    let mean = |index: u32| {
        let first = (index / width * 2 * picture.width + index % width * 2) as usize;
        let below = first + picture.width as usize;
        let four = [first, first + 1, below, below + 1].map(|place| picture.linear[place]);
        std::array::from_fn(|channel| 0.25 * four.iter().map(|pixel| pixel[channel]).sum::<f32>())
    };
    let linear: Vec<[f32; 4]> = (0..width * height).map(mean).collect();
    let encoded = vec![[0; 4]; linear.len()];
    Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: u32 = 128;

    fn frame(number: u32) -> Picture {
        let pixels = (SIDE * SIDE) as usize;
        let linear = vec![[number as f32, 0.0, 0.0, 1.0]; pixels];
        let encoded = vec![[number as u8, 0, 0, 255]; pixels];
        Picture { width: SIDE, height: SIDE, linear, encoded, lost: None, walked: None, notes: Vec::new() }
    }

    #[test]
    fn frames_lie_in_rows() {
        let frames: Vec<Picture> = (0..20).map(frame).collect();
        let mut strip = side_by_side(&frames, 5);
        assert_eq!((strip.width, strip.height), (640, 512));
        for (column, row, number) in [(0, 0, 0), (127, 127, 0), (128, 0, 1), (639, 0, 4), (0, 128, 5), (639, 511, 19)] {
            let place = row * 640 + column;
            assert_eq!((strip.encoded[place][0], strip.linear[place][0]), (number, f32::from(number)));
        }
        strip.linear[641][0] = 4.0;
        let half = halved(&strip);
        assert_eq!((half.width, half.height, half.linear.len()), (320, 256, 320 * 256));
        assert_eq!((half.linear[0][0], half.linear[64][0], half.linear[320 * 64][0]), (1.0, 1.0, 5.0));
    }
}
