//! Packs drawings into the unit square: each where it fits lowest, the largest first, as bitmaps.

use glam::DVec2;
use std::f64::consts::FRAC_PI_2;

/// Cells along a side of the square, of which half a one stays empty at each border. A row of them is a `u128`.
const CELLS: usize = 127;

/// The least distance between two drawings, also where the texture repeats, as a share of the square's side: that of two
/// cells with one between them, 8 texels of 1024.
pub(super) const GUTTER: f64 = 1.0 / (CELLS + 1) as f64;

/// The turns within a quarter that are tried for the smallest box.
const TURNS: u32 = 24;

/// The share of the square to fill at which the search for the scale starts: more than is ever reached.
const FIRST_SHARE: f64 = 0.8;
/// The scale's factor from one attempt to the next, until one succeeds; then this step is halved so often.
const STEP: f64 = 0.92;
const HALVINGS: usize = 3;

/// Triangles in a plane.
#[derive(Debug)]
pub(super) struct Drawing {
    /// At the turn at which their box is smallest.
    triangles: Vec<[DVec2; 3]>,
    /// Cosine and sine of that turn.
    turn: DVec2,
    size: DVec2,
    area: f64,
}

impl Drawing {
    pub(super) fn new(mut triangles: Vec<[DVec2; 3]>) -> Self {
        let area = triangles.iter().map(|[a, b, c]| 0.5 * (b - a).perp_dot(c - a).abs()).sum();
        let turned = (0..TURNS).map(|k| {
            let turn = DVec2::from_angle(FRAC_PI_2 * f64::from(k) / f64::from(TURNS));
            let (lower, upper) = extent(&triangles, turn);
            (turn, upper - lower)
        });
        let smallest = turned.min_by(|a, b| a.1.element_product().total_cmp(&b.1.element_product()));
        let (turn, size) = smallest.unwrap_or((DVec2::X, DVec2::ZERO));
        triangles.iter_mut().flatten().for_each(|point| *point = turn.rotate(*point));
        Self { triangles, turn, size, area }
    }
}

/// The corners of the box about turned triangles.
fn extent(triangles: &[[DVec2; 3]], turn: DVec2) -> (DVec2, DVec2) {
    let points = triangles.iter().flatten().map(|point| turn.rotate(*point));
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lower, upper), point| (lower.min(point), upper.max(point)))
}

/// Where a drawing goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placement {
    /// The scale times cosine and sine of the turn.
    turn: DVec2,
    offset: DVec2,
}

impl Placement {
    /// The texture coordinates of a point of the drawing.
    pub(super) fn apply(&self, point: DVec2) -> DVec2 {
        self.turn.rotate(point) + self.offset
    }
}

/// A place for each drawing, all at one scale; nothing if there are so many that they do not fit as single cells.
pub(super) fn pack(drawings: &[Drawing]) -> Option<Vec<Placement>> {
    let area: f64 = drawings.iter().map(|drawing| drawing.area).sum();
    let longest = drawings.iter().map(|drawing| drawing.size.max_element()).fold(0.0, f64::max);
    let largest = (CELLS as f64 * (FIRST_SHARE / area).sqrt()).min(CELLS as f64 / longest);
    let mut scale = if largest.is_finite() { largest } else { 1.0 };
    let mut order: Vec<usize> = (0..drawings.len()).collect();
    order.sort_by(|&a, &b| drawings[b].area.total_cmp(&drawings[a].area));
    let mut packed = attempt(drawings, &order, scale);
    while packed.is_none() && longest * scale >= 1.0 {
        scale *= STEP;
        packed = attempt(drawings, &order, scale);
    }
    let mut step = STEP;
    for _ in 0..HALVINGS {
        step = step.sqrt();
        if let Some(larger) = attempt(drawings, &order, scale / step) {
            packed = Some(larger);
            scale /= step;
        }
    }
    packed
}

/// Places at this scale, in cells per unit of length.
fn attempt(drawings: &[Drawing], order: &[usize], scale: f64) -> Option<Vec<Placement>> {
    let mut square = [0; CELLS];
    let mut placements = vec![Placement { turn: DVec2::X, offset: DVec2::ZERO }; drawings.len()];
    for &number in order {
        let drawing = &drawings[number];
        let quarters = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        let fitting = quarters.into_iter().filter_map(|quarter| {
            let turn = quarter * scale;
            let (lower, upper) = extent(&drawing.triangles, turn);
            let mask = Mask::of(&drawing.triangles, turn, lower, upper)?;
            let (x, y) = mask.lowest(&square)?;
            Some((x, y, turn, lower, mask))
        });
        let (x, y, turn, lower, mask) = fitting.min_by_key(|(x, y, .., mask)| (y + mask.rows.len(), *x))?;
        mask.take(&mut square, x, y);
        let corner = DVec2::new(x as f64, y as f64) + 0.5;
        placements[number] = Placement { turn: drawing.turn.rotate(turn) * GUTTER, offset: (corner - lower) * GUTTER };
    }
    Some(placements)
}

/// The cells that a drawing touches, with its lower corner in a cell's.
#[derive(Debug)]
struct Mask {
    width: usize,
    rows: Vec<u128>,
}

impl Mask {
    /// Nothing if the drawing is larger than the square.
    fn of(triangles: &[[DVec2; 3]], turn: DVec2, lower: DVec2, upper: DVec2) -> Option<Self> {
        let size = (upper - lower).floor() + 1.0;
        if size.max_element() > CELLS as f64 {
            return None;
        }
        let mut mask = Self { width: size.x as usize, rows: vec![0; size.y as usize] };
        for triangle in triangles {
            let corners = triangle.map(|point| turn.rotate(point) - lower);
            let [a, b, c] = corners.map(|corner| corner.y);
            for row in a.min(b).min(c) as usize..=a.max(b).max(c) as usize {
                let (from, to) = crossed(&corners, row as f64);
                mask.rows[row] |= ones(to as usize - from as usize + 1) << from as usize;
            }
        }
        Some(mask)
    }

    /// The lowest place, and of these the leftmost, that is free in the square.
    fn lowest(&self, square: &[u128; CELLS]) -> Option<(usize, usize)> {
        let inside = ones(CELLS - self.width + 1);
        (0..=CELLS - self.rows.len()).find_map(|y| {
            let mut free = inside;
            for (&row, &taken) in self.rows.iter().zip(&square[y..]) {
                free &= !hits(taken, row);
                if free == 0 {
                    return None;
                }
            }
            Some((free.trailing_zeros() as usize, y))
        })
    }

    /// Takes its cells at this place, and those about them.
    fn take(&self, square: &mut [u128; CELLS], x: usize, y: usize) {
        for (row, &cells) in self.rows.iter().enumerate() {
            let cells = cells << x;
            let grown = cells | cells << 1 | cells >> 1;
            let (first, last) = ((y + row).saturating_sub(1), (y + row + 1).min(CELLS - 1));
            square[first..=last].iter_mut().for_each(|near| *near |= grown);
        }
    }
}

/// The moves up at which one of a row's cells is `taken`, each a bit.
fn hits(taken: u128, mut row: u128) -> u128 {
    let mut hits = 0;
    while taken != 0 && row != 0 {
        let first = row.trailing_zeros() as usize;
        let length = (row >> first).trailing_ones() as usize;
        let mut run = taken;
        let mut reached = 1;
        while 2 * reached <= length {
            run |= run >> reached;
            reached *= 2;
        }
        run |= run >> (length - reached);
        hits |= run >> first;
        row &= !(ones(length) << first);
    }
    hits
}

/// The lowest `count` bits, at least one and at most all.
fn ones(count: usize) -> u128 {
    u128::MAX >> (128 - count)
}

/// The least and largest x of a triangle between `y` and `y + 1`.
fn crossed(corners: &[DVec2; 3], y: f64) -> (f64, f64) {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    let mut meet = |x: f64| range = (range.0.min(x), range.1.max(x));
    for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(k, l)| (corners[k], corners[l])) {
        if (y..=y + 1.0).contains(&from.y) {
            meet(from.x);
        }
        for line in [y, y + 1.0] {
            if (from.y < line) != (to.y < line) {
                meet(from.x + (to.x - from.x) * ((line - from.y) / (to.y - from.y)).clamp(0.0, 1.0));
            }
        }
    }
    range
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_are_the_moves_at_which_a_cell_meets_a_taken_one() {
        let rows = [1, 0b1011, ones(64), ones(127) & !(1 << 5), 0b1110_0111_0001 << 90, u128::MAX];
        let squares = [0, 1, 1 << 127, 0b1001 << 60, ones(30) << 50, u128::MAX, 0x5555_0000_ffff << 40];
        for row in rows {
            for taken in squares {
                for x in 0..128 {
                    let met = (row << x) & taken != 0;
                    assert_eq!(hits(taken, row) >> x & 1 == 1, met, "{row:x} {taken:x} {x}");
                }
            }
        }
    }

    #[test]
    fn a_mask_holds_every_cell_that_a_triangle_touches() {
        let triangle = [DVec2::new(0.0, 3.5), DVec2::new(6.2, 0.0), DVec2::new(2.5, 7.9)];
        let (lower, upper) = extent(&[triangle], DVec2::X);
        let mask = Mask::of(&[triangle], DVec2::X, lower, upper).unwrap();
        assert_eq!((mask.width, mask.rows.len()), (7, 8));
        for k in 0..=100 {
            for l in 0..=100 - k {
                let [u, v] = [f64::from(k) / 100.0, f64::from(l) / 100.0];
                let point = triangle[0] * (1.0 - u - v) + triangle[1] * u + triangle[2] * v;
                assert!(mask.rows[point.y as usize] >> point.x as usize & 1 == 1, "{point}");
            }
        }
        let count: u32 = mask.rows.iter().map(|row| row.count_ones()).sum();
        // Its area is 26.6 cells, and about it run some 20 cells of border.
        assert!((27..=42).contains(&count), "{count}");
    }
}
