//! Mode ATTRIBUTES: elements of bytes, each as its difference from the one before.

use super::stream::{LONG, SHORT, Stream};

/// Elements that share a header, at most.
const BLOCK: usize = 256;
/// Bytes of a block, at most.
const BLOCK_BYTES: usize = 8192;
/// Elements whose differences are stored together.
const GROUP: usize = 16;

/// How the four bytes of a channel follow from those of the element before.
#[derive(Debug, Clone, Copy)]
enum Channel {
    Bytes,
    Shorts,
    /// Exclusive or, turned by so many bits.
    Bits(u32),
}

/// Decodes `count` elements of `stride` bytes, a multiple of 4 up to 256.
pub(super) fn decode(stream: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    let version = match stream.first() {
        Some(0xa0) => 0,
        Some(0xa1) => 1,
        _ => return Err("it is no attribute stream of version 0 or 1"),
    };
    // The tail has the element that precedes the first one, and the channels; it is filled up in front.
    let tail = if version == 0 { stride } else { stride + stride / 4 };
    let padded = tail.max(if version == 0 { 32 } else { 24 });
    let data = stream.len().checked_sub(padded + 1).ok_or(SHORT)?;
    let mut data = Stream::new(&stream[1..1 + data]);
    let (before, channels) = stream[stream.len() - tail..].split_at(stride);
    let mut last = before.to_vec();
    let channels: Vec<Channel> = match version {
        0 => vec![Channel::Bytes; stride / 4],
        _ => channels.iter().map(|channel| Channel::of(*channel)).collect::<Result<_, _>>()?,
    };

    let block = (BLOCK_BYTES / stride / GROUP * GROUP).min(BLOCK);
    let mut elements = Vec::new();
    let mut deltas = vec![0; stride * BLOCK];
    let mut done = 0;
    while done < count {
        let length = block.min(count - done);
        let controls = if version == 0 { &[][..] } else { data.take(stride / 4)? };
        for (byte, column) in deltas.chunks_exact_mut(BLOCK).enumerate() {
            let control = controls.get(byte / 4).map(|controls| controls >> (2 * (byte % 4)) & 3);
            let widths = match control {
                None => [0, 2, 4, 8],
                Some(0) => [0, 1, 2, 4],
                Some(1) => [1, 2, 4, 8],
                Some(2) => {
                    column.fill(0);
                    continue;
                }
                Some(_) => {
                    column[..length].copy_from_slice(data.take(length)?);
                    continue;
                }
            };
            grouped(&mut data, &mut column[..length.next_multiple_of(GROUP)], widths)?;
        }
        for element in 0..length {
            for (place, (channel, bytes)) in channels.iter().zip(last.as_chunks_mut::<4>().0).enumerate() {
                let delta = std::array::from_fn(|byte| deltas[(4 * place + byte) * BLOCK + element]);
                *bytes = channel.next(*bytes, delta);
            }
            elements.extend_from_slice(&last);
        }
        done += length;
    }
    if data.is_empty() { Ok(elements) } else { Err(LONG) }
}

/// Decodes a column of differences in groups; a header has two bits for each, which choose the number of bits of its differences.
fn grouped(data: &mut Stream<'_>, column: &mut [u8], widths: [u32; 4]) -> Result<(), &'static str> {
    let header = data.take((column.len() / GROUP).div_ceil(4))?;
    for (place, group) in column.chunks_exact_mut(GROUP).enumerate() {
        let width = widths[usize::from(header[place / 4] >> (2 * (place % 4)) & 3)];
        match width {
            0 => group.fill(0),
            8 => group.copy_from_slice(data.take(GROUP)?),
            _ => {
                let packed = data.take(GROUP * width as usize / 8)?;
                // The largest number stands for a byte that follows.
                let largest = (1 << width) - 1;
                let per_byte = 8 / width;
                for (number, delta) in (0..).zip(group) {
                    let place = number % per_byte;
                    // Single bits begin with the lowest, wider numbers with the highest.
                    let shift = if width == 1 { place } else { 8 - width * (place + 1) };
                    let bits = packed[(number / per_byte) as usize] >> shift & largest;
                    *delta = if bits == largest { data.byte()? } else { bits };
                }
            }
        }
    }
    Ok(())
}

impl Channel {
    fn of(byte: u8) -> Result<Self, &'static str> {
        match byte & 3 {
            0 => Ok(Self::Bytes),
            1 => Ok(Self::Shorts),
            2 => Ok(Self::Bits(u32::from(byte >> 4))),
            _ => Err("a channel of it is unknown"),
        }
    }

    /// The bytes that follow `last` by `delta`.
    fn next(&self, last: [u8; 4], delta: [u8; 4]) -> [u8; 4] {
        let short = |of: [u8; 4], place: usize| u16::from_le_bytes([of[place], of[place + 1]]);
        match *self {
            Self::Bytes => std::array::from_fn(|byte| {
                let unsigned = delta[byte];
                last[byte].wrapping_add(unsigned >> 1 ^ (unsigned & 1).wrapping_neg())
            }),
            Self::Shorts => {
                let sum = |place| {
                    let unsigned = short(delta, place);
                    short(last, place).wrapping_add(unsigned >> 1 ^ (unsigned & 1).wrapping_neg())
                };
                let ([a, b], [c, d]) = (sum(0).to_le_bytes(), sum(2).to_le_bytes());
                [a, b, c, d]
            }
            Self::Bits(turn) => (u32::from_le_bytes(last) ^ u32::from_le_bytes(delta).rotate_right(turn)).to_le_bytes(),
        }
    }
}
