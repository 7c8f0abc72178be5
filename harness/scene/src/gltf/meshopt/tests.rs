//! Streams of meshoptimizer 1.3's own encoder, whose contents are formulas.

use super::*;

const ATTRIBUTES: [&[u8]; 2] = [include_bytes!("tests/attributes_0.bin"), include_bytes!("tests/attributes_1.bin")];
const TRIANGLES: &[u8] = include_bytes!("tests/triangles.bin");
const SEQUENCE: &[u8] = include_bytes!("tests/sequence.bin");

/// 270 elements of 16 bytes, more than a block: a constant, ramps, noise of few values, rare noise, noise of all values, and bits that
/// change by exclusive or.
fn elements() -> Vec<u8> {
    let mut state: u32 = 7;
    let mut bytes = Vec::new();
    for i in 0..270_u32 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = state >> 16;
        bytes.extend(0x0102_0304_u32.to_le_bytes());
        bytes.extend((3 * i as u16).to_le_bytes());
        bytes.extend((i as u16 / 40 * 257).to_le_bytes());
        bytes.push(100 + (noise / 7 % 3) as u8);
        bytes.push(if noise.is_multiple_of(37) { (noise >> 8) as u8 } else { 50 });
        bytes.extend((if !(20..256).contains(&i) { noise as u16 } else { 500 }).to_le_bytes());
        bytes.extend((0x3f00_0000 ^ (i * i * 64)).to_le_bytes());
    }
    bytes
}

/// A grid of 6 x 6 squares, and triangles that share nothing with the one before.
fn corners() -> Vec<u32> {
    let squares = (0..6).flat_map(|y| (0..6).map(move |x| 7 * y + x));
    let grid = squares.flat_map(|k| [k, k + 1, k + 7, k + 1, k + 8, k + 7]);
    grid.chain([0, 48, 24, 48, 0, 24, 70000, 3, 48, 5, 70000, 1]).collect()
}

/// Two runs by turns, and jumps.
fn indices() -> Vec<u32> {
    let runs = (0..40).map(|i| if i % 2 == 1 { 1000 + 3 * i } else { 7 * i });
    runs.chain([70000, 0, 4_000_000_000]).collect()
}

fn bytes(numbers: &[u32], size: usize) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes().into_iter().take(size)).collect()
}

#[test]
fn attributes_of_both_versions() {
    for stream in ATTRIBUTES {
        assert!(attributes::decode(stream, 270, 16) == Ok(elements()), "version {}", stream[0]);
    }
}

/// The orders of a triangle's corners may differ, but not their turn.
#[test]
fn triangles_in_integers_of_two_sizes() {
    let turned = |list: &[u8], size: usize| -> Vec<[u32; 3]> {
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte));
        let triangle = |bytes: &[u8]| {
            let mut corners = [0, 1, 2].map(|place| number(&bytes[place * size..][..size]));
            let least = (0..3).min_by_key(|place| corners[*place]).unwrap();
            corners.rotate_left(least);
            corners
        };
        list.chunks(3 * size).map(triangle).collect()
    };
    let corners = corners();
    for size in [2, 4] {
        let decoded = indices::triangles(TRIANGLES, corners.len(), size).unwrap();
        assert_eq!(turned(&decoded, size), turned(&bytes(&corners, size), size));
    }
}

#[test]
fn sequences_in_integers_of_two_sizes() {
    for size in [2, 4] {
        assert_eq!(indices::sequence(SEQUENCE, 43, size).unwrap(), bytes(&indices(), size));
    }
}

/// No stream that is shorter or longer than its elements is taken for one of them.
#[test]
fn cut_and_lengthened_streams_are_refused() {
    type Decode = fn(&[u8]) -> Result<Vec<u8>, &'static str>;
    let all: [(&[u8], Decode); 4] = [
        (ATTRIBUTES[0], |stream| attributes::decode(stream, 270, 16)),
        (ATTRIBUTES[1], |stream| attributes::decode(stream, 270, 16)),
        (TRIANGLES, |stream| indices::triangles(stream, 228, 4)),
        (SEQUENCE, |stream| indices::sequence(stream, 43, 4)),
    ];
    for (stream, decode) in all {
        assert!(decode(stream).is_ok());
        for length in 0..stream.len() {
            assert!(decode(&stream[..length]).is_err(), "{} of {}", length, stream.len());
        }
        let longer = [&stream[..20], &[0], &stream[20..]].concat();
        assert!(decode(&longer).is_err());
        // More elements than there are, without memory for them.
        let other = [&[0x55], &stream[1..]].concat();
        assert!(decode(&other).is_err(), "another kind of stream");
    }
    assert_eq!(attributes::decode(ATTRIBUTES[1], 1 << 28, 16), Err(stream::SHORT));
    assert_eq!(indices::triangles(TRIANGLES, 3 << 28, 4), Err(stream::SHORT));
    assert_eq!(indices::sequence(SEQUENCE, 1 << 30, 4), Err(stream::SHORT));
}

/// Whatever a stream holds, what is decoded has the length that was asked for, or there is a fault.
#[test]
fn broken_streams_are_refused_or_decoded_whole() {
    let mut state: u64 = 1;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut decoded = 0;
    for trial in 0..20_000 {
        let original = [ATTRIBUTES[0], ATTRIBUTES[1], TRIANGLES, SEQUENCE][trial % 4];
        let mut stream = original.to_vec();
        for _ in 0..1 + random(4) {
            let place = 1 + random(stream.len() - 1);
            match random(8) {
                0 => stream.truncate(place + 1),
                1 => stream.insert(place, random(256) as u8),
                _ => stream[place] = [0, 255, random(256) as u8][random(3)],
            }
        }
        let (length, found) = match trial % 4 {
            0 | 1 => (270 * 16, attributes::decode(&stream, 270, 16)),
            2 => (228 * 4, indices::triangles(&stream, 228, 4)),
            _ => (43 * 4, indices::sequence(&stream, 43, 4)),
        };
        if let Ok(bytes) = found {
            assert_eq!(bytes.len(), length);
            decoded += 1;
        }
    }
    assert!((2_000..18_000).contains(&decoded), "{decoded} of 20000");
}

/// Bytes of filtered elements, as the same encoder wrote them, and what they stand for.
fn unfiltered<const N: usize>(
    filter: Filter,
    stored: &[[i16; 4]],
    size: usize,
    number: impl Fn(&[u8]) -> f32,
) -> Vec<[f32; N]> {
    let mut elements: Vec<u8> =
        stored.iter().flatten().flat_map(|part| part.to_le_bytes().into_iter().take(size)).collect();
    filter.undo(&mut elements, 4 * size);
    let element = |bytes: &[u8]| std::array::from_fn(|place| number(&bytes[place * size..][..size]));
    elements.chunks(4 * size).map(element).collect()
}

fn assert_near<const N: usize>(found: &[[f32; N]], expected: &[[f32; N]], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let near = found.iter().zip(expected).all(|(x, y)| (x - y).abs() <= tolerance);
        assert!(near, "{found:?} is not {expected:?} within {tolerance}");
    }
}

#[test]
fn directions_on_an_octahedron() {
    let byte = |bytes: &[u8]| f32::from(bytes[0] as i8) / 127.0;
    let short = |bytes: &[u8]| f32::from(i16::from_le_bytes([bytes[0], bytes[1]])) / 32767.0;
    let expected = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [0.6, -0.48, 0.64], [-0.36, 0.48, -0.8]];
    let stored = [[127, 0, 127, 0], [0, -127, 127, 0], [127, 127, 127, 0], [44, -35, 127, 0], [-90, 99, 127, 127]];
    // Half a step of either coordinate moves the point by √6 halves, which the sphere may show √3 times larger; then half a step of the result.
    let tolerance = |steps: f32, largest: f32| 18.0_f32.sqrt() / 2.0 / steps + 0.5 / largest;
    assert_near(&unfiltered::<3>(Filter::Octahedral, &stored, 1, byte), &expected, tolerance(127.0, 127.0));
    assert_eq!(unfiltered::<4>(Filter::Octahedral, &stored, 1, byte)[4][3], 1.0);
    let stored = [
        [2047, 0, 2047, 0],
        [0, -2047, 2047, 0],
        [2047, 2047, 2047, 0],
        [714, -571, 2047, 0],
        [-1448, 1598, 2047, 32767],
    ];
    assert_near(&unfiltered::<3>(Filter::Octahedral, &stored, 2, short), &expected, tolerance(2047.0, 32767.0));
}

#[test]
fn quaternions_without_their_greatest_component() {
    let short = |bytes: &[u8]| f32::from(i16::from_le_bytes([bytes[0], bytes[1]])) / 32767.0;
    let stored = [[0, 0, 0, 2047], [0, 0, 0, 2044], [-1447, 1447, -1447, 2044], [-289, 2026, 289, 2045]];
    let found = unfiltered::<4>(Filter::Quaternion, &stored, 2, short);
    let expected = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.5, -0.5, 0.5, -0.5], [0.1, 0.7, -0.1, 0.7]];
    // A quaternion and its opposite turn alike.
    let dot = |a: &[f32; 4], b: &[f32; 4]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f32>();
    let found: Vec<[f32; 4]> =
        found.iter().zip(&expected).map(|(one, other)| one.map(|part| part * dot(one, other).signum())).collect();
    // The greatest component, at least 1/2, errs by the sum of the others' errors at most √2 times.
    assert_near(
        &found,
        &expected,
        3.0 * 0.5 * std::f32::consts::FRAC_1_SQRT_2 / 2047.0 * std::f32::consts::SQRT_2 + 1.0 / 32767.0,
    );
}

#[test]
fn floats_by_mantissa_and_exponent() {
    let stored = [
        -218_095_616_i32,
        -184_559_616,
        -385_867_579,
        50_347_080,
        -218_103_808,
        -201_313_724,
        285_201_991,
        -285_199_565,
    ];
    let mut elements: Vec<u8> = stored.iter().flat_map(|bits| bits.to_le_bytes()).collect();
    Filter::Exponential.undo(&mut elements, 16);
    let found: Vec<f32> = elements.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    for (found, expected) in found.into_iter().zip([1.0, -2.5, 1e-3, 123_456.0, 0.0, 3.141_59, -7e8, 0.1_f32]) {
        // Fifteen bits, one of them the sign, of which the highest is set.
        assert!((found - expected).abs() <= expected.abs() / 8192.0, "{found} is not {expected}");
    }
}

#[test]
fn colours_by_luma() {
    let expected = [[1.0, 1.0, 1.0, 1.0], [1.0, 0.0, 0.0, 0.5], [0.0, 0.25, 1.0, 0.0], [0.2, 0.4, 0.6, 0.8]];
    let stored = [[255, 0, 0, 255], [64, 127, 193, 192], [96, 129, 224, 128], [102, 205, 0, 230]];
    let byte = |bytes: &[u8]| f32::from(bytes[0]) / 255.0;
    // Three roundings by half a step each, one of the sums and one of the result; alpha has a bit less.
    assert_near(&unfiltered::<4>(Filter::Color, &stored, 1, byte), &expected, 2.5 / 255.0);
    let short = |bytes: &[u8]| f32::from(u16::from_le_bytes([bytes[0], bytes[1]])) / 65535.0;
    let stored = [[4095, 0, 0, 4095], [1024, 2047, -1023, 3072], [1536, -2047, -512, 2048], [1638, -819, 0, 3686]];
    assert_near(&unfiltered::<4>(Filter::Color, &stored, 2, short), &expected, 2.5 / 4095.0);
}

/// Numbers that no encoder writes stop nothing.
#[test]
fn any_bytes_can_be_unfiltered() {
    let mut state: u32 = 1;
    for filter in [Filter::Octahedral, Filter::Quaternion, Filter::Exponential, Filter::Color] {
        for stride in [4, 8] {
            let mut all = vec![0; 8];
            for _ in 0..8000 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                all.push((state >> 24) as u8);
            }
            filter.undo(&mut all, stride);
            assert_eq!(all.len(), 8008);
        }
    }
}
