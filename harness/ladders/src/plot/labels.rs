//! Where the labels of points stand: off lines, points and each other.

use super::series::Point;

/// A place of the drawing: pixels to the right and down.
pub(super) type Place = [f64; 2];
/// A rectangle: left, top, right, bottom.
pub(super) type Area = [f64; 4];
/// A line's ends.
pub(super) type Line = [Place; 2];

/// A point's label to be placed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted<'p> {
    pub text: &'p str,
    /// The point's place.
    pub at: Place,
    pub weight: Weight,
}

impl Wanted<'_> {
    /// Whether a point is in the way of the label in an area: it is covered, or a small label would seem to name it, for
    /// it is about as near as the own one and not at the same place.
    fn is_blocked(&self, area: &Area, point: &Place) -> bool {
        let [x, y] = point;
        let is_other = (x - self.at[0]).hypot(y - self.at[1]) > 6.0;
        let seems_named =
            self.weight == Weight::Small && is_other && distance(point, area) < NEARER * distance(&self.at, area);
        seems_named || overlap(area, &[x - 6.0, y - 6.0, x + 6.0, y + 6.0])
    }
}

/// How much a label matters: the first have their places first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Weight {
    /// It is always there; its point has a ring.
    Always,
    /// It comes before the usual ones.
    Early,
    /// It may stand away from its point, with a line that leads to it.
    Usual,
    /// It is small, and stands beside its point, off all lines, or nowhere.
    Small,
}

/// A label beside its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Label {
    /// From the point to the middle of the nearer end.
    pub from_point: Place,
    /// Whether it ends there, to the left of the point.
    pub ends: bool,
    /// Whether a line leads from the point to it.
    pub led: bool,
    pub area: Area,
}

impl Weight {
    /// Returns the weight of a point's label.
    pub fn of(point: &Point) -> Self {
        match point {
            Point { chosen: true, .. } => Self::Always,
            Point { early: true, .. } => Self::Early,
            Point { front: true, .. } => Self::Usual,
            _ => Self::Small,
        }
    }

    /// Returns the mean width of its letters, and its height.
    fn letter(self) -> [f64; 2] {
        if self == Self::Small { [6.7, 12.0] } else { [8.0, 15.0] }
    }
}

/// What a label costs on a line, on another's leader or with a leader across another label, on a point, on another
/// label, and outside the plot.
const COSTS: [usize; 5] = [1, 10, 1000, 100_000, 10_000_000];
/// From this on a label has no room; a small one has none on a line either.
const NO_ROOM: usize = COSTS[2];
/// How far from its point a label begins, in the order in which places are tried.
const REACHES: [f64; 4] = [10.0, 22.0, 36.0, 52.0];
/// The same of a small label, to which no line leads.
const SMALL_REACHES: [f64; 2] = [10.0, 14.0];
/// How many times farther than its own all other points are from a small label.
const NEARER: f64 = 1.1;
/// How far from lines and from others a small label stands.
const APART: f64 = 2.0;

/// Places labels in a plot's area so that they overlap neither each other nor points, and lines only where there is no
/// other room. `points` are the places of all points.
pub(super) fn place(wanted: &[Wanted<'_>], points: &[Place], lines: &[Line], room: &Area) -> Vec<Option<Label>> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|index| wanted[*index].weight);
    let mut taken: Vec<Area> = Vec::new();
    let mut leaders: Vec<Line> = Vec::new();
    let mut labels = vec![None; wanted.len()];
    for index in order {
        let current = &wanted[index];
        let leader = |label: &Label| {
            let [[x, y], [right, down]] = [current.at, label.from_point];
            label.led.then_some([[x, y], [x + right, y + down]])
        };
        let cost = |label: &Label| {
            let (led, area) = (leader(label), &label.area);
            let [left, top, right, bottom] = *area;
            let gap = if current.weight == Weight::Small { APART } else { 0.0 };
            let around = [left - gap, top - gap, right + gap, bottom + gap];
            let counts = [
                lines.iter().filter(|line| crosses(line, &around)).count(),
                leaders.iter().filter(|other| crosses(other, area)).count()
                    + taken.iter().filter(|other| led.is_some_and(|led| crosses(&led, other))).count(),
                points.iter().filter(|point| current.is_blocked(area, point)).count(),
                taken.iter().filter(|other| overlap(&around, other)).count(),
                usize::from(!is_within(area, room)),
            ];
            counts.iter().zip(COSTS).map(|(count, cost)| count * cost).sum::<usize>()
        };
        let Some(best) = candidates(current).into_iter().min_by_key(cost) else { continue };
        let room = match current.weight {
            Weight::Always => usize::MAX,
            Weight::Small => 1,
            _ => NO_ROOM,
        };
        if cost(&best) >= room {
            continue;
        }
        leaders.extend(leader(&best));
        taken.push(best.area);
        labels[index] = Some(best);
    }
    labels
}

/// Returns the places for a label about its point, the best first.
fn candidates(wanted: &Wanted<'_>) -> Vec<Label> {
    let [letter, height] = wanted.weight.letter();
    let width = letter * wanted.text.chars().count() as f64;
    let ring: f64 = if wanted.weight == Weight::Always { 5.0 } else { 0.0 };
    let [x, y] = wanted.at;
    let is_small = wanted.weight == Weight::Small;
    let reaches = if is_small { &SMALL_REACHES[..] } else { &REACHES[..] };
    let mut all = Vec::new();
    for &reach in reaches {
        let side = reach.min(22.0);
        for (right, down) in [(side, -reach), (side, 0.0), (-side, reach), (-side, 0.0), (side, reach), (-side, -reach)]
        {
            let is_beside = reach == REACHES[0];
            let (right, down) = if is_beside && down != 0.0 { (right * 0.6, down * 1.1) } else { (right, down) };
            let right = right + ring.copysign(right);
            let left = if right > 0.0 { x + right } else { x + right - width };
            let middle = y + down;
            let area = [left, middle - 0.5 * height, left + width, middle + 0.5 * height];
            all.push(Label { from_point: [right, down], ends: right < 0.0, led: !is_beside && !is_small, area });
        }
    }
    all
}

pub(super) fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Returns how far a point is from an area.
fn distance([x, y]: &Place, [left, top, right, bottom]: &Area) -> f64 {
    (x - x.clamp(*left, *right)).hypot(y - y.clamp(*top, *bottom))
}

/// Whether a label is in the plot's area, or just above it.
fn is_within(label: &Area, room: &Area) -> bool {
    label[0] >= room[0] && label[1] >= room[1] - 14.0 && label[2] <= room[2] && label[3] <= room[3]
}

/// Whether a line passes through an area: the parts of it between left and right and between top and bottom meet.
fn crosses([from, to]: &Line, area: &Area) -> bool {
    let [mut start, mut end] = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        let (origin, length) = (from[axis], to[axis] - from[axis]);
        let [low, high] = [area[axis], area[axis + 2]];
        if length == 0.0 {
            if origin <= low || origin >= high {
                return false;
            }
            continue;
        }
        let [first, last] = [low, high].map(|side| (side - origin) / length);
        start = start.max(first.min(last));
        end = end.min(first.max(last));
    }
    start < end
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: Area = [50.0, 30.0, 940.0, 480.0];

    #[test]
    fn labels_lie_on_no_other_and_on_no_point() {
        let points: Vec<Place> = (0..12).map(|index| [400.0 + 20.0 * f64::from(index), 200.0]).collect();
        let weight = |index: usize| if index < 2 { Weight::Always } else { Weight::Usual };
        let wanted: Vec<Wanted<'_>> = points
            .iter()
            .enumerate()
            .map(|(index, point)| Wanted { text: "walk-8+tracker", at: *point, weight: weight(index) })
            .collect();
        let labels = place(&wanted, &points, &[], &ROOM);
        assert!(labels[0].is_some() && labels[1].is_some(), "those are always there");
        let areas: Vec<Area> = labels.iter().flatten().map(|label| label.area).collect();
        for (index, area) in areas.iter().enumerate() {
            assert!(areas[..index].iter().all(|other| !overlap(area, other)), "{areas:?}");
            assert!(points.iter().all(|[x, y]| !overlap(area, &[x - 5.0, y - 5.0, x + 5.0, y + 5.0])), "{areas:?}");
        }
    }

    #[test]
    fn a_label_takes_a_place_off_the_lines() {
        // Both below the point on the left and above it on the right there is room.
        let corner = [300.0, 200.0];
        let lines = [[[300.0, 30.0], corner], [corner, [940.0, 200.0]]];
        for weight in [Weight::Always, Weight::Early, Weight::Usual, Weight::Small] {
            let labels = place(&[Wanted { text: "one", at: corner, weight }], &[corner], &lines, &ROOM);
            let label = labels[0].expect("there is room");
            assert!(lines.iter().all(|line| !crosses(line, &label.area)), "{label:?}");
        }
    }

    #[test]
    fn a_small_label_stands_beside_its_point_or_nowhere() {
        let centre = [500.0, 200.0];
        let around: Vec<Place> = (0..25)
            .map(|index| {
                [centre[0] - 30.0 + 12.0 * f64::from(index % 5), centre[1] - 30.0 + 12.0 * f64::from(index / 5)]
            })
            .collect();
        let label_of = |weight| place(&[Wanted { text: "name", at: centre, weight }], &around, &[], &ROOM)[0];
        assert_eq!(label_of(Weight::Small), None);
        assert!(label_of(Weight::Usual).expect("farther away").led);
    }

    #[test]
    fn lines_cross_what_they_pass_through() {
        let area = [10.0, 10.0, 20.0, 20.0];
        let crossing = [[[0.0, 0.0], [30.0, 30.0]], [[15.0, 0.0], [15.0, 12.0]], [[12.0, 12.0], [13.0, 12.0]]];
        let passing = [[[0.0, 0.0], [9.0, 9.0]], [[10.0, 0.0], [10.0, 30.0]], [[0.0, 15.0], [30.0, 60.0]]];
        assert!(crossing.iter().all(|line| crosses(line, &area)) && !passing.iter().any(|line| crosses(line, &area)));
    }
}
