//! Places: positions within a tolerance of one another count as one.

use std::collections::HashMap;

use glam::DVec3;

/// Distance, relative to the mesh's largest coordinate, below which corners count as one: four
/// times the 2^-24 by which f32 rounds. If a surface is a grid that closes upon itself, its seam is
/// open by that much.
pub(crate) const TOLERANCE: f64 = 1.0 / (1 << 22) as f64;

/// Points by cells of a grid, in which those near a position are found.
#[derive(Debug)]
pub(crate) struct Grid {
    tolerance: f64,
    cells: HashMap<[i64; 3], Vec<usize>>,
    /// The points, by number.
    pub(crate) points: Vec<DVec3>,
}

impl Grid {
    /// Returns an empty grid, in which points within `tolerance`, at least 0, of a position are found.
    pub(crate) fn new(tolerance: f64) -> Self {
        Self { tolerance, cells: HashMap::new(), points: Vec::new() }
    }

    /// A cell is twice as wide as the tolerance, so that near points lie in one of the eight cells
    /// around one of its corners.
    fn cell(&self, position: DVec3) -> [i64; 3] {
        (position / (2.0 * self.tolerance).max(f64::MIN_POSITIVE)).floor().to_array().map(|x| x as i64)
    }

    /// Returns the number of a point within the tolerance of a position.
    pub(crate) fn find(&self, position: DVec3) -> Option<usize> {
        let (least, greatest) = (self.cell(position - self.tolerance), self.cell(position + self.tolerance));
        (0..8).find_map(|corner| {
            let cell = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { least[axis] } else { greatest[axis] });
            let mut here = self.cells.get(&cell)?.iter().copied();
            here.find(|&number| self.points[number].distance(position) <= self.tolerance)
        })
    }

    /// Returns the number of the nearest point within the tolerance of a position.
    pub(crate) fn nearest(&self, position: DVec3) -> Option<usize> {
        let (least, greatest) = (self.cell(position - self.tolerance), self.cell(position + self.tolerance));
        let cells = (0..8).filter_map(|corner| {
            let cell = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { least[axis] } else { greatest[axis] });
            self.cells.get(&cell)
        });
        let away = |number: usize| self.points[number].distance_squared(position);
        let nearest = cells.flatten().copied().min_by(|&one, &other| away(one).total_cmp(&away(other)))?;
        (away(nearest) <= self.tolerance * self.tolerance).then_some(nearest)
    }

    /// Returns the largest number of points in a cell.
    pub(crate) fn fullest(&self) -> usize {
        self.cells.values().map(Vec::len).max().unwrap_or_default()
    }

    /// Adds a point and returns its number.
    pub(crate) fn add(&mut self, point: DVec3) -> usize {
        let number = self.points.len();
        self.points.push(point);
        self.cells.entry(self.cell(point)).or_default().push(number);
        number
    }
}

/// Returns the places of positions, and for each position the number of its place. A place is the first of its positions.
pub(crate) fn weld(positions: impl Iterator<Item = DVec3>, tolerance: f64) -> (Vec<DVec3>, Vec<usize>) {
    let mut grid = Grid::new(tolerance);
    // Most vertices repeat a position exactly.
    let mut exact: HashMap<[u64; 3], usize> = HashMap::new();
    let numbers = positions.map(|position| {
        let key = (position + 0.0).to_array().map(f64::to_bits);
        *exact.entry(key).or_insert_with(|| grid.find(position).unwrap_or_else(|| grid.add(position)))
    });
    let numbers = numbers.collect();
    (grid.points, numbers)
}
