//! Agreement with the published implementation: NVIDIA's C++, as built by the crates nv-flip 0.1.2 and
//! nv-flip-sys 0.1.1. The expected means are those of its error maps at 67 pixels per degree, summed in f64. The
//! pictures are made here. Together they see a change of each constant of the algorithm.

use lapidary_flip::{flip, mean};

const WIDTH: u32 = 48;
const HEIGHT: u32 = 40;

/// A picture of a colour for each column and row.
fn picture(color: impl Fn(i32, i32) -> [i32; 3]) -> Vec<u8> {
    let places = (0..HEIGHT as i32).flat_map(|y| (0..WIDTH as i32).map(move |x| (x, y)));
    places.flat_map(|(x, y)| color(x, y).map(|value| value.clamp(0, 255) as u8)).collect()
}

/// A wave of triangles, -1 to 1 times `height`.
fn wave(x: i32, period: i32, height: i32) -> i32 {
    let phase = 4 * x.rem_euclid(period) - 2 * period;
    height * (phase.abs() - period) / period
}

fn disc(x: i32, y: i32, (center_x, center_y): (i32, i32), radius: i32) -> i32 {
    i32::from((x - center_x).pow(2) + (y - center_y).pow(2) <= radius * radius)
}

/// A name, a reference and a test picture, and the mean of the published implementation.
type Case = (&'static str, Vec<u8>, Vec<u8>, f64);

fn cases() -> Vec<Case> {
    let gray = |_, _| [128; 3];
    let ramp = |x, y| [60 + 3 * x, 200 - 4 * y, 40 + 2 * x + 2 * y];
    vec![
        ("a ramp, little brighter", picture(ramp), picture(|x, y| ramp(x, y).map(|value| value + 3)), 0.0855801),
        ("a ramp, other hues", picture(ramp), picture(|x, y| [ramp(x, y)[1], ramp(x, y)[2], ramp(x, y)[0]]), 0.7590720),
        ("gray waves", picture(gray), picture(|x, _| [128 + wave(x, 5, 60); 3]), 0.2556281),
        (
            "red and green waves",
            picture(gray),
            picture(|x, y| [128 + wave(x + y, 7, 80), 128 - wave(x + y, 7, 40), 128]),
            0.2415004,
        ),
        ("blue and yellow waves", picture(gray), picture(|_, y| [128, 128, 128 + wave(y, 16, 120)]), 0.4037734),
        (
            "a disc that moves",
            picture(|x, y| [50 + 150 * disc(x, y, (20, 18), 9); 3]),
            picture(|x, y| [50 + 150 * disc(x, y, (22, 19), 9); 3]),
            0.0884473,
        ),
        (
            "bright points",
            picture(ramp),
            picture(|x, y| ramp(x, y).map(|value| if (x % 13, y % 11) == (6, 5) { 255 } else { value })),
            0.0507436,
        ),
        (
            "a yellow disc on blue",
            picture(|_, _| [10, 20, 230]),
            picture(|x, y| if disc(x, y, (46, 3), 14) == 1 { [240, 250, 5] } else { [10, 20, 230] }),
            0.1676550,
        ),
        (
            "the dark",
            picture(|x, y| [x / 2, y / 3, 4 + x / 3]),
            picture(|x, y| [4 + x / 3, 3 + y / 2, x / 4]),
            0.0764480,
        ),
        // Filtered, these leave the range of RGB.
        (
            "saturated stripes",
            picture(|x, _| if x % 12 < 4 { [0, 0, 255] } else { [255, 255, 0] }),
            picture(|_, y| if y % 12 < 4 { [255, 0, 0] } else { [0, 255, 255] }),
            0.9374643,
        ),
    ]
}

#[test]
fn means_agree_with_the_published_implementation() {
    for (name, reference, test, expected) in cases() {
        let found = f64::from(mean(&flip((WIDTH, HEIGHT), &reference, &test)));
        assert!((found - expected).abs() < 1e-5, "{name}: {found:.7}, not {expected:.7}");
    }
}
