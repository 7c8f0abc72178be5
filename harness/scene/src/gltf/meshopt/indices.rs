//! Modes TRIANGLES and INDICES: vertex indices, by what was used before and by differences.

use super::stream::{LONG, SHORT, Stream};

/// Decodes `count` corners of triangles, a multiple of 3, to integers of `size` bytes.
pub(super) fn triangles(stream: &[u8], count: usize, size: usize) -> Result<Vec<u8>, &'static str> {
    let body = stream.strip_prefix(&[0xe1]).ok_or("it is no stream of triangles of version 1")?;
    // A byte for each triangle, what these call for, and pairs that are frequent.
    let rest = body.len().checked_sub(16).ok_or(SHORT)?;
    let (codes, data) = body[..rest].split_at_checked(count / 3).ok_or(SHORT)?;
    let mut decoder =
        Triangles { data: Stream::new(data), edges: Recent::new(), vertices: Recent::new(), next: 0, last: 0 };
    let mut corners = Vec::with_capacity(count * size);
    for code in codes {
        for corner in decoder.triangle(*code, &body[rest..])? {
            corners.extend_from_slice(&corner.to_le_bytes()[..size]);
        }
    }
    if decoder.data.is_empty() { Ok(corners) } else { Err(LONG) }
}

/// Decodes `count` indices to integers of `size` bytes.
pub(super) fn sequence(stream: &[u8], count: usize, size: usize) -> Result<Vec<u8>, &'static str> {
    let body = stream.strip_prefix(&[0xd1]).ok_or("it is no stream of indices of version 1")?;
    let data = body.len().checked_sub(4).ok_or(SHORT)?;
    // An index takes a byte at least.
    if data < count {
        return Err(SHORT);
    }
    let mut data = Stream::new(&body[..data]);
    let mut indices = Vec::with_capacity(count * size);
    // Two runs, whose differences may alternate.
    let mut last = [0u32; 2];
    for _ in 0..count {
        let number = data.number()?;
        let run = &mut last[(number & 1) as usize];
        *run = run.wrapping_add(signed(number >> 1));
        indices.extend_from_slice(&run.to_le_bytes()[..size]);
    }
    if data.is_empty() { Ok(indices) } else { Err(LONG) }
}

/// The difference, in two's complement, that an unsigned number stands for: 0, -1, 1, -2 and so on.
fn signed(number: u32) -> u32 {
    number >> 1 ^ (number & 1).wrapping_neg()
}

/// The last `N` items, a power of 2; 0 before there are any.
struct Recent<T, const N: usize> {
    items: [T; N],
    next: usize,
}

impl<T: Copy + Default, const N: usize> Recent<T, N> {
    fn new() -> Self {
        Self { items: [T::default(); N], next: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.next % N] = item;
        self.next += 1;
    }

    /// The item before the last `back` ones.
    fn get(&self, back: u8) -> T {
        self.items[self.next.wrapping_sub(1 + usize::from(back)) % N]
    }
}

struct Triangles<'a> {
    data: Stream<'a>,
    edges: Recent<[u32; 2], 16>,
    vertices: Recent<u32, 16>,
    /// The vertex that follows the greatest.
    next: u32,
    /// The vertex from which differences count.
    last: u32,
}

impl Triangles<'_> {
    /// Decodes a triangle by its code and the table of pairs.
    fn triangle(&mut self, code: u8, pairs: &[u8]) -> Result<[u32; 3], &'static str> {
        let (edge, corner) = (code >> 4, code & 15);
        if edge < 15 {
            let [a, b] = self.edges.get(edge);
            let c = match corner {
                0 => self.fresh(),
                1..=12 => self.vertices.get(corner),
                13 => self.moved(u32::MAX),
                14 => self.moved(1),
                _ => self.by_difference()?,
            };
            if !(1..=12).contains(&corner) {
                self.vertices.push(c);
            }
            self.edges.push([c, b]);
            self.edges.push([a, c]);
            return Ok([a, b, c]);
        }
        let (pair, follows) = match corner {
            0..=13 => (pairs[usize::from(corner)], false),
            _ => (self.data.byte()?, true),
        };
        if follows && pair == 0 {
            self.next = 0;
        }
        let a = if corner == 15 { None } else { Some(self.fresh()) };
        let [b, c] = [pair >> 4, pair & 15].map(|place| match place {
            0 => Some(self.fresh()),
            15 if follows => None,
            _ => Some(self.vertices.get(place - 1)),
        });
        let [a, b, c] = [self.or_by_difference(a)?, self.or_by_difference(b)?, self.or_by_difference(c)?];
        self.vertices.push(a);
        for (place, vertex) in [(pair >> 4, b), (pair & 15, c)] {
            if place == 0 || (follows && place == 15) {
                self.vertices.push(vertex);
            }
        }
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        Ok([a, b, c])
    }

    fn fresh(&mut self) -> u32 {
        let vertex = self.next;
        self.next = vertex.wrapping_add(1);
        vertex
    }

    fn moved(&mut self, by: u32) -> u32 {
        self.last = self.last.wrapping_add(by);
        self.last
    }

    fn by_difference(&mut self) -> Result<u32, &'static str> {
        let difference = signed(self.data.number()?);
        Ok(self.moved(difference))
    }

    fn or_by_difference(&mut self, vertex: Option<u32>) -> Result<u32, &'static str> {
        vertex.map_or_else(|| self.by_difference(), Ok)
    }
}
