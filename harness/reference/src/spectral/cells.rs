//! A grid of cubic cells that list the items in them, for short rays: a tree is traversed from its
//! root, while a short ray visits only a few cells.

use super::bvh::Extent;
use glam::{DVec3, IVec3, USizeVec3};

/// Largest number of cells along an axis.
const MOST_CELLS: f64 = 192.0;
/// Longest ray in cells; longer rays use the tree.
const LONGEST: f64 = 16.0;
/// Margin around an item's box, in cells: steps from cell to cell are subject to rounding.
const MARGIN: f64 = 1e-6;

/// A uniform grid of items.
pub(super) struct Cells {
    least: DVec3,
    per_length: f64,
    size: USizeVec3,
    /// Start of each cell's items, x fastest; the last entry is the end of the last cell's.
    begin: Vec<u32>,
    items: Vec<u32>,
}

impl Cells {
    /// Builds the grid over items with these boxes, numbered by index; no cell is narrower than
    /// `width`.
    pub(super) fn new(extents: &[Extent], width: f64) -> Self {
        let all = Extent::union(extents);
        let lengths = (all.greatest - all.least).max(DVec3::ZERO);
        let width = width.max(lengths.max_element() / MOST_CELLS);
        if extents.is_empty() || !(width > 0.0 && width.is_finite()) {
            return Self {
                least: DVec3::ZERO,
                per_length: 0.0,
                size: USizeVec3::ZERO,
                begin: vec![0],
                items: Vec::new(),
            };
        }
        let margin = MARGIN * width;
        let least = all.least - margin;
        let per_length = width.recip();
        let size = ((lengths + 2.0 * margin) * per_length).floor().as_usizevec3() + 1;
        let mut grid = Self { least, per_length, size, begin: vec![0; size.element_product() + 1], items: Vec::new() };
        // Count, accumulate, list.
        for extent in extents {
            grid.for_cells(&extent.padded(margin), |grid, cell| grid.begin[cell + 1] += 1);
        }
        for cell in 1..grid.begin.len() {
            grid.begin[cell] += grid.begin[cell - 1];
        }
        grid.items = vec![0; grid.begin.last().map_or(0, |&end| end as usize)];
        let mut next = grid.begin.clone();
        for (item, extent) in (0..).zip(extents) {
            grid.for_cells(&extent.padded(margin), |grid, cell| {
                grid.items[next[cell] as usize] = item;
                next[cell] += 1;
            });
        }
        grid
    }

    fn for_cells(&mut self, extent: &Extent, mut visit: impl FnMut(&mut Self, usize)) {
        let last = self.size - 1;
        let [from, to] = [extent.least, extent.greatest]
            .map(|corner| ((corner - self.least) * self.per_length).max(DVec3::ZERO).as_usizevec3().min(last));
        for z in from.z..=to.z {
            for y in from.y..=to.y {
                for x in from.x..=to.x {
                    visit(self, (z * self.size.y + y) * self.size.x + x);
                }
            }
        }
    }

    /// Calls `visit` with the items listed along a ray of unit `direction` up to the distance `to`,
    /// cell by cell from near to far, some of them more than once.
    ///
    /// `visit` returns the distance beyond which nothing matters any more. The result is false, and
    /// nothing is visited, if the ray is too long or starts outside the grid.
    pub(super) fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        mut to: f64,
        mut visit: impl FnMut(usize, f64) -> f64,
    ) -> bool {
        let place = (origin - self.least) * self.per_length;
        let inside = place.cmpge(DVec3::ZERO).all() && place.cmplt(self.size.as_dvec3()).all();
        if !inside || to * self.per_length > LONGEST {
            return false;
        }
        let step = direction.map(f64::signum);
        let cell = place.floor();
        // Distances at which the ray leaves the cell across each axis, and from one crossing to the
        // next. A component of 0 never crosses.
        let spacing = direction.abs().max(DVec3::splat(1e-300)).recip() / self.per_length;
        let mut next = (step * (cell - place) + 0.5 * (step + 1.0)) * spacing;
        let (step, size) = (step.as_ivec3(), self.size.as_ivec3());
        let mut cell = cell.as_ivec3();
        loop {
            let place = (cell.z as usize * self.size.y + cell.y as usize) * self.size.x + cell.x as usize;
            for &item in &self.items[self.begin[place] as usize..self.begin[place + 1] as usize] {
                to = to.min(visit(item as usize, to));
            }
            let axis = next.min_position();
            if next[axis] >= to {
                return true;
            }
            cell[axis] += step[axis];
            next[axis] += spacing[axis];
            if cell.cmplt(IVec3::ZERO).any() || cell.cmpge(size).any() {
                return true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::Xoshiro256PlusPlus;
    use rand::{RngExt as _, SeedableRng as _};

    fn generator(seed: u64) -> Xoshiro256PlusPlus {
        Xoshiro256PlusPlus::seed_from_u64(seed)
    }

    fn point(random: &mut Xoshiro256PlusPlus) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| random.random()))
    }

    /// Small boxes, densely scattered.
    fn boxes() -> Vec<Extent> {
        let mut random = generator(3);
        let box_at = |_| {
            let least = 10.0 * point(&mut random);
            Extent { least, greatest: least + 0.2 + 0.5 * random.random::<f64>() }
        };
        (0..800).map(box_at).collect()
    }

    #[test]
    fn every_box_on_a_short_way_is_visited_from_near_to_far() {
        let boxes = boxes();
        let cells = Cells::new(&boxes, 0.4);
        let mut random = generator(4);
        let (mut met, mut ended) = (0, 0);
        for _ in 0..5000 {
            let origin = 0.5 + 9.0 * point(&mut random);
            let direction = (point(&mut random) - 0.5).normalize();
            let to = 0.1 + 3.0 * random.random::<f64>();
            let mut visited = Vec::new();
            let served = cells.visit(origin, direction, to, |item, to| {
                visited.push(item);
                to
            });
            assert!(served);
            for (item, extent) in boxes.iter().enumerate() {
                if extent.entry(origin, direction.recip(), 0.0, to).is_some() {
                    assert!(visited.contains(&item), "{origin} {direction} {to} {item}");
                    met += 1;
                }
            }
            // After an immediate hit, no items beyond those of the first cell.
            let mut few = Vec::new();
            cells.visit(origin, direction, to, |item, _| {
                few.push(item);
                0.0
            });
            assert!(visited.starts_with(&few));
            ended += usize::from(few.len() < visited.len());
        }
        assert!(met > 2000 && ended > 2500, "{met} {ended}");
    }

    #[test]
    fn along_an_axis_and_on_a_border_nothing_is_missed() {
        let unit = Extent { least: DVec3::ZERO, greatest: DVec3::ONE };
        let far = Extent { least: DVec3::splat(3.0), greatest: DVec3::splat(4.0) };
        let cells = Cells::new(&[unit, far], 1.0);
        let mut visited = Vec::new();
        assert!(cells.visit(DVec3::new(3.5, 3.5, 0.0), DVec3::Z, 3.2, |item, to| {
            visited.push(item);
            to
        }));
        assert_eq!(visited, [1]);
        assert!(cells.visit(DVec3::ONE, -DVec3::X, 0.5, |_, to| to));
    }

    #[test]
    fn what_is_not_for_the_grid_is_refused() {
        let unit = Extent { least: DVec3::ZERO, greatest: DVec3::ONE };
        let nothing = |_: usize, _: f64| -> f64 { panic!("nothing is visited") };
        let cells = Cells::new(&[unit], 0.1);
        assert!(!cells.visit(DVec3::splat(-1.0), DVec3::X, 0.5, nothing));
        assert!(!cells.visit(DVec3::splat(0.5), DVec3::X, 2.0, nothing));
        assert!(!cells.visit(DVec3::splat(f64::NAN), DVec3::X, 0.1, nothing));
        assert!(!Cells::new(&[], 0.1).visit(DVec3::ZERO, DVec3::X, 0.1, nothing));
        let flat = Extent { least: DVec3::ZERO, greatest: DVec3::ZERO };
        assert!(!Cells::new(&[flat], 0.0).visit(DVec3::ZERO, DVec3::X, 0.1, nothing));
    }
}
