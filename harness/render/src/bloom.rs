//! The glow around bright places, as a lens and an eye spread light: for a picture that is looked at, and for nothing else.
//!
//! A share of each pixel's linear radiance goes to its surroundings, by Gaussians of three widths, before the tone curve. Each
//! Gaussian is three running means after one another in each direction (Wells, "Efficient synthesis of Gaussian filters by
//! cascaded uniform filters", 1986). The picture's edges reflect, so that every pixel gives away and receives the
//! same share: no energy is lost or won, and an even picture stays as it is.

use crate::picture::Picture;
use crate::pixel::display::backdrop;
use glam::{DVec3, Vec2, Vec3};
use lapidary_srgb as srgb;
use rayon::prelude::*;

/// Default share of the light that is spread.
pub const BLOOM: f32 = 0.06;

/// Standard deviations as shares of the picture's shorter side, and how the spread light is divided among them; chosen by eye.
const WIDTHS: [(f64, f64); 3] = [(0.004, 0.5), (0.016, 0.3), (0.06, 0.2)];

/// Exposed radiance of which no more is spread: a picture is white far below it, and sums over a line stay exact.
const BRIGHTEST: f32 = 65536.0;

/// Adds the glow to the pixels that are shown, of a picture before the backdrop; the linear picture stays as it is. `strength` is the
/// share of light that is spread, 0 to 1, and `exposure` that of the picture.
///
/// The shown pixels are means of tone-mapped samples. What is added is the difference that the spread makes to
/// the tone-mapped mean, so that edges stay as smooth as they were.
pub fn bloom(picture: &mut Picture, exposure: f32, strength: f32) {
    let size = [picture.width as usize, picture.height as usize];
    let most = BRIGHTEST / exposure.max(f32::MIN_POSITIVE);
    // The least of a number and no number is the number.
    let light = |part: &f32| part.min(most).max(0.0);
    let sharp: Vec<DVec3> =
        picture.linear.iter().map(|[r, g, b, _]| Vec3::new(light(r), light(g), light(b)).as_dvec3()).collect();
    let spread = spread(&sharp, size, f64::from(strength));
    let whole = Vec2::new(picture.width as f32, picture.height as f32);
    for (place, encoded) in picture.encoded.iter_mut().enumerate() {
        let pixel = Vec2::new((place % size[0]) as f32, (place / size[0]) as f32) + 0.5;
        let behind = (1.0 - picture.linear[place][3]) * backdrop(pixel, whole);
        let light = |radiance: DVec3| srgb::tone_curve(exposure * radiance.as_vec3() + behind);
        let [red, green, blue, _] = *encoded;
        let shown = srgb::decode_color(Vec3::new(red.into(), green.into(), blue.into()) / 255.0);
        let glowing = (shown + light(spread[place]) - light(sharp[place])).clamp(Vec3::ZERO, Vec3::ONE);
        let codes = (255.0 * srgb::encode_color(glowing)).round();
        encoded[..3].copy_from_slice(&codes.to_array().map(|code| code as u8));
    }
}

/// Returns the radiance of which a share is spread.
fn spread(sharp: &[DVec3], size: [usize; 2], strength: f64) -> Vec<DVec3> {
    let mut all: Vec<DVec3> = sharp.iter().map(|light| (1.0 - strength) * *light).collect();
    for (width, share) in WIDTHS {
        let blurred = gaussian(sharp, size, width * size[0].min(size[1]) as f64);
        all.iter_mut().zip(blurred).for_each(|(light, blurred)| *light += strength * share * blurred);
    }
    all
}

/// Returns the radiance blurred with this standard deviation in pixels.
fn gaussian(sharp: &[DVec3], [width, height]: [usize; 2], deviation: f64) -> Vec<DVec3> {
    // The variance of a mean over 2r + 1 pixels is r(r + 1)/3; three of them add up to r(r + 1).
    let radius = ((deviation * deviation + 0.25).sqrt() - 0.5).round() as usize;
    if radius == 0 {
        return sharp.to_vec();
    }
    let along = |lines: Vec<DVec3>, length: usize| {
        let mut lines = lines;
        lines.par_chunks_exact_mut(length).for_each(|line| (0..3).for_each(|_| running_mean(line, radius)));
        lines
    };
    let rows = along(sharp.to_vec(), width);
    transposed(&along(transposed(&rows, width, height), height), height, width)
}

/// Returns `height` rows of `width` as columns.
fn transposed(pixels: &[DVec3], width: usize, height: usize) -> Vec<DVec3> {
    (0..width * height).map(|place| pixels[place % height * width + place / height]).collect()
}

/// Replaces each value by the mean of those up to `radius` from it. Beyond its ends the line goes back.
fn running_mean(line: &mut [DVec3], radius: usize) {
    let count = line.len() as isize;
    let whole = line.to_vec();
    let at = |place: isize| {
        let turned = place.rem_euclid(2 * count);
        whole[turned.min(2 * count - 1 - turned) as usize]
    };
    let radius = radius as isize;
    let share = 1.0 / (2 * radius + 1) as f64;
    let mut sum: DVec3 = (-radius..=radius).map(at).sum();
    for (place, value) in (0..).zip(line) {
        *value = share * sum;
        sum += at(place + radius + 1) - at(place - radius);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [37, 23];

    /// One bright pixel on a dim ground, near a corner.
    fn spark() -> Vec<DVec3> {
        let mut pixels = vec![DVec3::splat(0.01); SIZE[0] * SIZE[1]];
        pixels[3 * SIZE[0] + 2] = DVec3::new(80.0, 40.0, 20.0);
        pixels
    }

    fn picture(linear: &[DVec3]) -> Picture {
        let shown = |light: &DVec3| srgb::encode_color(srgb::tone_curve(light.as_vec3()));
        let encoded =
            linear.iter().map(|light| (255.0 * shown(light)).round().extend(255.0).to_array().map(|part| part as u8));
        Picture {
            width: SIZE[0] as u32,
            height: SIZE[1] as u32,
            linear: linear.iter().map(|light| light.as_vec3().extend(1.0).to_array()).collect(),
            encoded: encoded.collect(),
            lost: None,
            walked: None,
            notes: Vec::new(),
        }
    }

    #[test]
    fn no_energy_is_lost_or_won_even_at_the_edges() {
        let sharp = spark();
        for strength in [0.06, 1.0] {
            let all = spread(&sharp, SIZE, strength);
            let [before, after]: [DVec3; 2] = [&sharp, &all].map(|pixels| pixels.iter().sum());
            // Some thousand sums, each rounded to 2^-53 of 80 at most.
            assert!((after - before).abs().max_element() < 1e-9, "{before} {after}");
            assert!(all.iter().all(|light| light.min_element() > 0.0));
        }
    }

    #[test]
    fn an_even_picture_stays_as_it_is() {
        let even = vec![DVec3::new(0.3, 0.2, 0.7); SIZE[0] * SIZE[1]];
        for light in spread(&even, SIZE, 0.5) {
            assert!(light.abs_diff_eq(even[0], 1e-12));
        }
        let mut shown = picture(&even);
        let before = shown.clone();
        bloom(&mut shown, 1.0, 0.5);
        assert_eq!(shown, before);
    }

    #[test]
    fn a_bright_place_glows_and_its_radiance_is_kept_for_errors() {
        let mut shown = picture(&spark());
        let before = shown.clone();
        bloom(&mut shown, 1.0, BLOOM);
        assert_eq!(shown.linear, before.linear);
        let red = |picture: &Picture, column: usize| picture.encoded[3 * SIZE[0] + column][0];
        assert!(red(&shown, 5) > red(&before, 5) + 10, "{} {}", red(&shown, 5), red(&before, 5));
        assert!((5..SIZE[0] - 1).all(|column| red(&shown, column + 1) <= red(&shown, column)));
    }

    #[test]
    fn pixels_of_any_radiance_darken_no_others() {
        for bright in [1e36, f64::INFINITY] {
            let mut pixels = spark();
            pixels[3 * SIZE[0] + 2] = DVec3::splat(bright);
            let mut shown = picture(&pixels);
            let before = shown.clone();
            bloom(&mut shown, 1.0, BLOOM);
            assert!(shown.encoded.iter().zip(&before.encoded).all(|(after, before)| after >= before), "{bright}");
        }
    }

    #[test]
    fn a_blur_has_the_width_that_is_asked_for() {
        let size = [201, 1];
        let mut line = vec![DVec3::ZERO; 201];
        line[100] = DVec3::ONE;
        for deviation in [3.0, 8.0, 14.0] {
            let blurred = gaussian(&line, [size[0], 1], deviation);
            let found: f64 = blurred.iter().zip(-100..).map(|(light, at)| light.x * f64::from(at * at)).sum();
            // Radii are whole, half a pixel off at most: r(r + 1) is within r* + 3/4 of r*(r* + 1), the variance asked for.
            assert!((found - deviation * deviation).abs() <= deviation + 0.3, "{found} for {deviation}");
        }
    }
}
