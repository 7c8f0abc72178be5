//! Packs the boxes of drawings into the unit square, the largest first, each at the lowest free
//! place.

use glam::DVec2;
use std::f64::consts::FRAC_PI_2;

/// Number of cells along a side of the square, with half a cell left empty at each border. A row of
/// cells is a `u128`.
const CELLS: usize = 127;

/// Smallest distance between two drawings, also across the borders if the texture repeats, as a
/// fraction of the square's side: that between two cells with one between them, 8 texels of 1024.
pub(super) const GUTTER: f64 = 1.0 / (CELLS + 1) as f64;

/// Number of rotations within a quarter turn that are tried for the smallest box.
const TURNS: u32 = 24;

/// Filled fraction of the square at which the search for the scale starts: more than is ever
/// reached.
const FIRST_SHARE: f64 = 0.8;
/// Factor of the scale from one attempt to the next until one succeeds, and how often this step is
/// then halved.
const STEP: f64 = 0.92;
const HALVINGS: usize = 3;

/// Triangles in a plane.
#[derive(Debug)]
pub(super) struct Drawing {
    /// Triangles, rotated so that their box is smallest.
    triangles: Vec<[DVec2; 3]>,
    /// Cosine and sine of that rotation.
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

/// Returns the lower and upper corner of the box around the rotated triangles.
fn extent(triangles: &[[DVec2; 3]], turn: DVec2) -> (DVec2, DVec2) {
    let points = triangles.iter().flatten().map(|point| turn.rotate(*point));
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lower, upper), point| (lower.min(point), upper.max(point)))
}

/// Where a drawing is placed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placement {
    /// The scale times the cosine and sine of the rotation.
    turn: DVec2,
    offset: DVec2,
}

impl Placement {
    /// Returns the texture coordinates of a point of the drawing.
    pub(super) fn apply(&self, point: DVec2) -> DVec2 {
        self.turn.rotate(point) + self.offset
    }
}

/// Returns a place for each drawing, all at one scale, or `None` if there are so many that they do
/// not fit even as single cells.
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

/// Returns placements at this scale, in cells per unit of length, or `None` if they do not fit.
fn attempt(drawings: &[Drawing], order: &[usize], scale: f64) -> Option<Vec<Placement>> {
    let mut square = [0; CELLS];
    let mut placements = vec![Placement { turn: DVec2::X, offset: DVec2::ZERO }; drawings.len()];
    for &number in order {
        let drawing = &drawings[number];
        let fitting = [DVec2::X, DVec2::Y].into_iter().filter_map(|quarter| {
            let turn = quarter * scale;
            let (lower, upper) = extent(&drawing.triangles, turn);
            let cells = Cells::of(upper - lower)?;
            let (x, y) = cells.lowest(&square)?;
            Some((x, y, turn, lower, cells))
        });
        let (x, y, turn, lower, cells) = fitting.min_by_key(|(x, y, .., cells)| (y + cells.height, *x))?;
        cells.take(&mut square, x, y);
        let corner = DVec2::new(x as f64, y as f64) + 0.5;
        placements[number] = Placement { turn: drawing.turn.rotate(turn) * GUTTER, offset: (corner - lower) * GUTTER };
    }
    Some(placements)
}

/// The cells of a drawing's box. Whole boxes are kept apart, not just outlines, because a blur
/// knows a chart only by its box.
#[derive(Clone, Copy, Debug)]
struct Cells {
    width: usize,
    height: usize,
}

impl Cells {
    /// Returns `None` if the box is larger than the square.
    fn of(size: DVec2) -> Option<Self> {
        let cells = size.floor() + 1.0;
        (cells.max_element() <= CELLS as f64).then_some(Self { width: cells.x as usize, height: cells.y as usize })
    }

    /// Returns the lowest free place in the square, the leftmost if there are several.
    fn lowest(self, square: &[u128; CELLS]) -> Option<(usize, usize)> {
        (0..=CELLS - self.height).find_map(|y| {
            let taken = square[y..y + self.height].iter().fold(0, |all, row| all | row);
            let x = (0..=CELLS - self.width).find(|x| taken & ones(self.width) << x == 0)?;
            Some((x, y))
        })
    }

    /// Marks the cells at this place, and those around them, as taken.
    fn take(self, square: &mut [u128; CELLS], x: usize, y: usize) {
        let cells = ones(self.width) << x;
        let grown = cells | cells << 1 | cells >> 1;
        let (first, last) = (y.saturating_sub(1), (y + self.height).min(CELLS - 1));
        square[first..=last].iter_mut().for_each(|near| *near |= grown);
    }
}

/// Returns the lowest `count` bits, at least one and at most all.
fn ones(count: usize) -> u128 {
    u128::MAX >> (128 - count)
}
