//! A tree of boxes over numbered items, split at the median, in f64.

use glam::DVec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) least: DVec3,
    pub(super) greatest: DVec3,
}

impl Extent {
    /// The smallest box around `points`; without points, one that no ray meets.
    pub(super) fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        let nothing = Self { least: DVec3::INFINITY, greatest: DVec3::NEG_INFINITY };
        points.into_iter().fold(nothing, |extent, point| extent.with(&Self { least: point, greatest: point }))
    }

    /// The smallest box around all `extents`.
    pub(super) fn union<'a>(extents: impl IntoIterator<Item = &'a Self>) -> Self {
        extents.into_iter().fold(Self::of([]), |all, extent| all.with(extent))
    }

    fn with(&self, other: &Self) -> Self {
        Self { least: self.least.min(other.least), greatest: self.greatest.max(other.greatest) }
    }

    /// The box enlarged by `margin` on every side.
    pub(super) fn padded(&self, margin: f64) -> Self {
        Self { least: self.least - margin, greatest: self.greatest + margin }
    }

    /// Whether two boxes have a point in common.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.least.cmple(other.greatest).all() && other.least.cmple(self.greatest).all()
    }

    /// Largest absolute value of a coordinate; 0 for an empty box.
    pub(super) fn largest_coordinate(&self) -> f64 {
        if self.least.x > self.greatest.x {
            return 0.0;
        }
        self.least.abs().max(self.greatest.abs()).max_element()
    }

    /// Finds the t at which the line origin + t / inverse enters the box, if its interior is met at
    /// a t from `from` to `to`. A line within one of the box's sides may count as a miss.
    pub(super) fn entry(&self, origin: DVec3, inverse: DVec3, from: f64, to: f64) -> Option<f64> {
        let (a, b) = ((self.least - origin) * inverse, (self.greatest - origin) * inverse);
        let near = a.min(b).max_element().max(from);
        let far = a.max(b).min_element().min(to);
        (near <= far).then_some(near)
    }
}

/// Largest number of items in a leaf.
const LEAF: usize = 4;

struct Node {
    extent: Extent,
    content: Content,
}

enum Content {
    /// Range of the leaf's items in the order.
    Leaf { first: usize, end: usize },
    /// Index of the second child; the first comes right after the node.
    Inner { second: usize },
}

/// A bounding volume hierarchy.
pub(super) struct Bvh {
    nodes: Vec<Node>,
    /// Item numbers, leaf by leaf.
    order: Vec<usize>,
}

impl Bvh {
    /// Builds the tree over items with these boxes, numbered by index. A box must contain its item
    /// in its interior.
    pub(super) fn new(extents: &[Extent]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(2 * extents.len()), order: (0..extents.len()).collect() };
        tree.split(extents, 0, extents.len());
        tree
    }

    fn split(&mut self, extents: &[Extent], first: usize, end: usize) {
        let items = &mut self.order[first..end];
        let extent = Extent::union(items.iter().map(|&item| &extents[item]));
        let place = self.nodes.len();
        self.nodes.push(Node { extent, content: Content::Leaf { first, end } });
        if items.len() <= LEAF {
            return;
        }
        // Twice the centre; halving it would not change the order.
        let centre = |item: usize| extents[item].least + extents[item].greatest;
        let spread = Extent::of(items.iter().map(|&item| centre(item)));
        let axis = (spread.greatest - spread.least).max_position();
        let middle = items.len() / 2;
        // Equal centres are ordered by number, so that every machine builds the same tree.
        items.select_nth_unstable_by(middle, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
        self.split(extents, first, first + middle);
        self.nodes[place].content = Content::Inner { second: self.nodes.len() };
        self.split(extents, first + middle, end);
    }

    /// Calls `visit` with the items whose boxes a ray meets at a t from `from` to `to`, roughly
    /// from near to far. `visit` returns the t beyond which nothing matters any more.
    pub(super) fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        (from, mut to): (f64, f64),
        mut visit: impl FnMut(usize, f64) -> f64,
    ) {
        // A component of 0 would give 0 · ∞ = NaN for an origin on a side of the box.
        let inverse = direction.to_array().map(|part| if part.abs() < 1e-300 { 1e300 } else { 1.0 / part });
        let inverse = DVec3::from_array(inverse);
        let entry = |node: usize, to: f64| self.nodes[node].extent.entry(origin, inverse, from, to);
        let mut waiting = Waiting::default();
        waiting.push(0, entry(0, to));
        while let Some((place, near)) = waiting.pop() {
            if near > to {
                continue;
            }
            match self.nodes[place].content {
                Content::Leaf { first, end } => {
                    for &item in &self.order[first..end] {
                        to = to.min(visit(item, to));
                    }
                }
                Content::Inner { second } => {
                    let (left, right) = (entry(place + 1, to), entry(second, to));
                    // The nearer child goes on top.
                    if left.unwrap_or(f64::INFINITY) < right.unwrap_or(f64::INFINITY) {
                        waiting.push(second, right);
                        waiting.push(place + 1, left);
                    } else {
                        waiting.push(place + 1, left);
                        waiting.push(second, right);
                    }
                }
            }
        }
    }
}

/// Stack of nodes still to be visited, with the t at which the ray enters each.
struct Waiting {
    /// One entry for each level of the tree; each level halves the items.
    nodes: [(usize, f64); 64],
    count: usize,
}

impl Default for Waiting {
    fn default() -> Self {
        Self { nodes: [(0, 0.0); 64], count: 0 }
    }
}

impl Waiting {
    fn push(&mut self, place: usize, near: Option<f64>) {
        if let Some(near) = near {
            self.nodes[self.count] = (place, near);
            self.count += 1;
        }
    }

    fn pop(&mut self) -> Option<(usize, f64)> {
        self.count = self.count.checked_sub(1)?;
        Some(self.nodes[self.count])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes() -> Vec<Extent> {
        let place = |k: u32| DVec3::new(f64::from(k * 37 % 101), f64::from(k * 53 % 97), f64::from(k * 71 % 89));
        (0..500).map(|k| Extent { least: place(k), greatest: place(k) + f64::from(1 + k % 5) }).collect()
    }

    #[test]
    fn every_box_on_the_way_is_visited_once() {
        let boxes = boxes();
        let tree = Bvh::new(&boxes);
        for k in 0..200u32 {
            let origin = DVec3::new(f64::from(k % 7) * 17.3, f64::from(k % 11) * 9.1, -5.0 + f64::from(k % 3) * 40.0);
            let direction = (DVec3::new(50.0, 50.0, 45.0 + f64::from(k % 5)) - origin).normalize();
            let mut visited = Vec::new();
            tree.visit(origin, direction, (0.0, 60.0), |item, to| {
                visited.push(item);
                to
            });
            visited.sort_unstable();
            let met = |extent: &Extent| extent.entry(origin, direction.recip(), 0.0, 60.0).is_some();
            let missing = (0..boxes.len()).filter(|&item| met(&boxes[item]) && visited.binary_search(&item).is_err());
            assert_eq!(missing.count(), 0);
            assert!(visited.windows(2).all(|pair| pair[0] != pair[1]));
            assert!(visited.len() < 200);
        }
    }

    #[test]
    fn a_ray_along_an_axis_meets_a_padded_boxs_side() {
        let tree = Bvh::new(&[Extent { least: DVec3::ZERO, greatest: DVec3::ONE }.padded(1e-12)]);
        let mut visits = 0;
        tree.visit(DVec3::new(0.0, 1.0, -3.0), DVec3::Z, (0.0, f64::INFINITY), |_, to| {
            visits += 1;
            to
        });
        assert_eq!(visits, 1);
        tree.visit(DVec3::new(0.0, 1.0, -3.0), DVec3::Z, (0.0, 2.5), |_, _| panic!("it lies beyond"));
        Bvh::new(&[]).visit(DVec3::ZERO, DVec3::Z, (0.0, 1.0), |_, _| panic!("there is nothing"));
    }
}
