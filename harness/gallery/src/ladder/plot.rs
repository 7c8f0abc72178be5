//! A ladder's plot: where its points, lines and labels stand. `templates/ladder.html` draws them.

use super::axis::Axis;
use serde::Serialize;

/// A rung as a point.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    pub rung: String,
    pub ms: f64,
    pub error: f64,
    /// Number of its series, from 1.
    pub series: usize,
    /// Whether no faster rung is better.
    pub front: bool,
    /// The qualities that choose it.
    pub qualities: Vec<&'static str>,
    /// Whether it is the paper's.
    pub paper: bool,
    /// Its picture, relative to the page; `None` if there is none.
    pub href: Option<String>,
    /// What a reader is told of it.
    pub title: String,
}

/// Width, height and margins of a drawing, in its own units, of which a letter is 14 high.
#[derive(Clone, Copy, Debug)]
struct Format {
    name: &'static str,
    size: [f64; 2],
    /// Left, top, right and bottom of the plot's area.
    area: [f64; 4],
    /// Whether rungs that are no defaults are labelled.
    labels: bool,
}

/// For wide columns and for phones.
const FORMATS: [Format; 2] = [
    Format { name: "wide", size: [960.0, 540.0], area: [58.0, 34.0, 946.0, 484.0], labels: true },
    Format { name: "narrow", size: [380.0, 460.0], area: [42.0, 34.0, 372.0, 402.0], labels: false },
];

/// A drawing of a plot.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Drawing {
    name: &'static str,
    width: f64,
    height: f64,
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
    /// Milliseconds at the left and right end.
    x0: f64,
    x1: f64,
    /// Errors at the bottom and at the top.
    y0: f64,
    y1: f64,
    columns: Vec<Tick>,
    /// Where the limit stands, if within the axis.
    limit: Option<f64>,
    lines: Vec<Tick>,
    /// The staircase: its path, and the points of the front as `ms,error` with spaces between.
    front: String,
    front_of: String,
    points: Vec<Placed>,
}

#[derive(Clone, Debug, Serialize)]
struct Tick {
    value: f64,
    at: f64,
    text: String,
}

#[derive(Clone, Debug, Serialize)]
struct Placed {
    #[serde(flatten)]
    point: Point,
    x: f64,
    y: f64,
    mark: &'static str,
    label: Option<Label>,
}

/// A label beside its point.
#[derive(Clone, Debug, Serialize)]
struct Label {
    text: String,
    dx: f64,
    dy: f64,
    anchor: &'static str,
    /// Whether a line leads from the point to it.
    led: bool,
}

/// The marks by series, about the origin: disc, square, triangle, diamond, cross and triangle on its tip.
pub(super) const MARKS: [&str; 6] = [
    "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z",
    "M-4.5 -4.5H4.5V4.5H-4.5Z",
    "M0 -6L5.5 4.2H-5.5Z",
    "M0 -6.4L5.4 0L0 6.4L-5.4 0Z",
    "M-5.4 -3L-3 -5.4L0 -2.4L3 -5.4L5.4 -3L2.4 0L5.4 3L3 5.4L0 2.4L-3 5.4L-5.4 3L-2.4 0Z",
    "M0 6L5.5 -4.2H-5.5Z",
];

/// Returns a plot's drawings, for wide columns and for phones, with a line at the milliseconds of a limit.
pub(super) fn drawings(points: &[Point], limit: Option<f64>) -> Vec<Drawing> {
    FORMATS.iter().map(|format| drawing(points, limit, format)).collect()
}

fn drawing(points: &[Point], limit: Option<f64>, format: &Format) -> Drawing {
    let [left, top, right, bottom] = format.area;
    let across = Axis::of(points.iter().map(|point| point.ms), [left, right]);
    let up = Axis::of(points.iter().map(|point| point.error), [bottom, top]);
    let at = |point: &Point| [across.at(point.ms), up.at(point.error)].map(rounded);
    let front: Vec<&Point> = points.iter().filter(|point| point.front).collect();
    let places: Vec<[f64; 2]> = points.iter().map(at).collect();
    let steps: Vec<[f64; 2]> = front.iter().map(|point| at(point)).collect();
    let corners = stairs(&steps, top, right);
    let labels = labels(points, &places, &corners, format);
    let tick = |axis: &Axis, value: &f64| Tick { value: *value, at: rounded(axis.at(*value)), text: short(*value) };
    Drawing {
        name: format.name,
        width: format.size[0],
        height: format.size[1],
        left,
        top,
        right,
        bottom,
        x0: across.ends[0],
        x1: across.ends[1],
        y0: up.ends[0],
        y1: up.ends[1],
        columns: apart(across.ticks.iter().map(|value| tick(&across, value))),
        limit: limit.filter(|ms| across.ends[0] < *ms && *ms < across.ends[1]).map(|ms| rounded(across.at(ms))),
        lines: up.ticks.iter().map(|value| tick(&up, value)).collect(),
        front: path(&corners),
        front_of: front.iter().map(|point| format!("{},{}", point.ms, point.error)).collect::<Vec<_>>().join(" "),
        points: points
            .iter()
            .zip(places)
            .zip(labels)
            .map(|((point, [x, y]), label)| Placed {
                point: point.clone(),
                x,
                y,
                mark: MARKS[(point.series - 1) % MARKS.len()],
                label,
            })
            .collect(),
    }
}

/// Returns the corners of the staircase of the least error that each time buys, as lines from one to the next. Points
/// come by increasing time.
fn stairs(front: &[[f64; 2]], top: f64, right: f64) -> Vec<[f64; 2]> {
    let (Some([x, _]), Some([_, last])) = (front.first(), front.last()) else { return Vec::new() };
    let mut corners = vec![[*x, top]];
    for [x, y] in front {
        let before = corners[corners.len() - 1][1];
        corners.extend([[*x, before], [*x, *y]]);
    }
    corners.push([right, *last]);
    corners.dedup();
    corners
}

/// Returns a path through corners, of which each line goes across or down.
fn path(corners: &[[f64; 2]]) -> String {
    let Some([x, y]) = corners.first() else { return String::new() };
    let line = |pair: &[[f64; 2]]| match pair {
        [[x, _], [next, y]] if x == next => format!("V{y}"),
        [_, [x, _]] => format!("H{x}"),
        _ => String::new(),
    };
    format!("M{x} {y}{}", corners.windows(2).map(line).collect::<String>())
}

/// Shows a value of an axis.
fn short(value: f64) -> String {
    if (1e-3..1e6).contains(&value) { value.to_string() } else { format!("{value:e}") }
}

/// Rounds to a tenth of a unit, so that pages stay small.
fn rounded(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// Width of a digit of an axis, and the room between its labels.
const DIGIT: [f64; 2] = [8.5, 6.0];

/// Leaves out ticks whose labels would touch the one before.
fn apart(ticks: impl Iterator<Item = Tick>) -> Vec<Tick> {
    let half = |tick: &Tick| 0.5 * DIGIT[0] * tick.text.len() as f64;
    let mut kept: Vec<Tick> = Vec::new();
    for tick in ticks {
        if kept.last().is_none_or(|last| last.at + half(last) + DIGIT[1] <= tick.at - half(&tick)) {
            kept.push(tick);
        }
    }
    kept
}

/// A rectangle: left, top, right, bottom.
type Area = [f64; 4];

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Height of a label, and the mean width of its letters.
const LETTER: [f64; 2] = [8.0, 15.0];
/// What a label costs on a line of the front, on another's leader or with a leader across another label, on a point, on
/// another label, and outside the plot.
const COSTS: [usize; 5] = [1, 10, 1000, 100_000, 10_000_000];
/// From this on a label has no room.
const NO_ROOM: usize = COSTS[2];

/// Whether a line across or down passes through an area.
fn passes([from, to]: &[[f64; 2]; 2], area: &Area) -> bool {
    let [left, right] = [from[0].min(to[0]), from[0].max(to[0])];
    let [top, bottom] = [from[1].min(to[1]), from[1].max(to[1])];
    overlap(&[left, top, right, bottom], area)
}

/// Whether a line passes through an area: by points of it, closer than areas are wide.
fn crosses([from, to]: &[[f64; 2]; 2], area: &Area) -> bool {
    const PARTS: u32 = 16;
    (0..=PARTS).any(|part| {
        let share = f64::from(part) / f64::from(PARTS);
        let [x, y] = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        area[0] < x && x < area[2] && area[1] < y && y < area[3]
    })
}

/// How far from its point a label begins, in the order in which places are tried.
const REACHES: [f64; 4] = [10.0, 22.0, 36.0, 52.0];

/// Places labels so that they overlap neither each other nor points, and lines only where there is no other room.
/// Defaults come first; a rung of the front that has no room gets none.
fn labels(points: &[Point], places: &[[f64; 2]], corners: &[[f64; 2]], format: &Format) -> Vec<Option<Label>> {
    let is_named = |at: &usize| points[*at].front || points[*at].paper || !points[*at].qualities.is_empty();
    let mut order: Vec<usize> = (0..points.len()).filter(is_named).collect();
    order.sort_by_key(|at| (points[*at].qualities.is_empty(), !points[*at].paper));
    let marks: Vec<Area> = places.iter().map(|[x, y]| [x - 6.0, y - 6.0, x + 6.0, y + 6.0]).collect();
    let lines: Vec<[[f64; 2]; 2]> = corners.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let mut taken: Vec<Area> = Vec::new();
    let mut leaders: Vec<[[f64; 2]; 2]> = Vec::new();
    let mut labels = vec![None; points.len()];
    for at in order {
        let point = &points[at];
        if point.qualities.is_empty() && !format.labels {
            continue;
        }
        let named = if point.paper { format!("{} (the paper)", point.rung) } else { point.rung.clone() };
        let text = match point.qualities.as_slice() {
            [] => named,
            qualities => format!("{}: {named}", qualities.join(", ")),
        };
        let width = LETTER[0] * text.chars().count() as f64;
        // A default has a ring.
        let ring = if point.qualities.is_empty() { 0.0 } else { 5.0 };
        let candidates = candidates(width, ring, places[at]);
        let fits = |area: &Area| {
            let [left, top, right, bottom] = format.area;
            area[0] >= left && area[1] >= top - 14.0 && area[2] <= right && area[3] <= bottom
        };
        let leader = |label: &Label| {
            let [x, y] = places[at];
            label.led.then_some([[x, y], [x + label.dx, y + label.dy]])
        };
        let costs = |(label, area): &(Label, Area)| {
            let own = leader(label);
            let of = [
                lines.iter().filter(|line| passes(line, area)).count(),
                leaders.iter().filter(|other| crosses(other, area)).count()
                    + taken.iter().filter(|other| own.is_some_and(|own| crosses(&own, other))).count(),
                marks.iter().filter(|mark| overlap(area, mark)).count(),
                taken.iter().filter(|other| overlap(area, other)).count(),
                usize::from(!fits(area)),
            ];
            of.iter().zip(COSTS).map(|(count, cost)| count * cost).sum::<usize>()
        };
        let Some(best) = candidates.into_iter().min_by_key(costs) else { continue };
        // A default is always named.
        if point.qualities.is_empty() && costs(&best) >= NO_ROOM {
            continue;
        }
        let (best, area) = best;
        leaders.extend(leader(&best));
        taken.push(area);
        labels[at] = Some(Label { text, ..best });
    }
    labels
}

/// Returns the places for a label of this width about a point with a ring of this width, the best first.
fn candidates(width: f64, ring: f64, [x, y]: [f64; 2]) -> Vec<(Label, Area)> {
    let mut all = Vec::new();
    for reach in REACHES {
        let side = reach.min(22.0);
        for (dx, dy) in [(side, -reach), (side, 0.0), (-side, reach), (-side, 0.0), (side, reach), (-side, -reach)] {
            let (dx, dy) = if reach == REACHES[0] && dy != 0.0 { (dx * 0.6, dy * 1.1) } else { (dx, dy) };
            let dx = dx + ring.copysign(dx);
            let [left, anchor] = if dx > 0.0 { [x + dx, 0.0] } else { [x + dx - width, 1.0] };
            let middle = y + dy;
            let area = [left, middle - 0.5 * LETTER[1], left + width, middle + 0.5 * LETTER[1]];
            let anchor = if anchor == 0.0 { "start" } else { "end" };
            all.push((
                Label { text: String::new(), dx: rounded(dx), dy: rounded(dy), anchor, led: reach > 12.0 },
                area,
            ));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(rung: &str, ms: f64, error: f64, front: bool, qualities: &[&'static str]) -> Point {
        let title = format!("{rung}: {error}");
        Point {
            rung: rung.to_owned(),
            ms,
            error,
            series: 1,
            front,
            qualities: qualities.into(),
            paper: false,
            href: None,
            title,
        }
    }

    #[test]
    fn points_stand_where_the_axes_say_and_labels_stand_apart() {
        let many: Vec<Point> =
            (0..12).map(|k| point("walk-8+tracker", 1.0 + 0.2 * f64::from(k), 0.5, true, &[])).collect();
        let defaults = [point("a", 1.0, 0.9, true, &["fast"]), point("b", 1.1, 0.89, true, &["good", "best"])];
        let points = [many, defaults.into()].concat();
        for drawing in drawings(&points, None) {
            for placed in &drawing.points {
                let share = (placed.point.ms / drawing.x0).ln() / (drawing.x1 / drawing.x0).ln();
                assert!((drawing.left + share * (drawing.right - drawing.left) - placed.x).abs() < 0.06);
                assert!(placed.y > drawing.top && placed.y < drawing.bottom);
            }
            let labelled: Vec<&Placed> = drawing.points.iter().filter(|placed| placed.label.is_some()).collect();
            let has = |text: &str| {
                labelled.iter().any(|placed| placed.label.as_ref().is_some_and(|label| label.text == text))
            };
            assert!(has("fast: a") && has("good, best: b"), "defaults are always named");
            let areas: Vec<Area> = labelled
                .iter()
                .filter_map(|placed| {
                    let label = placed.label.as_ref()?;
                    let width = LETTER[0] * label.text.chars().count() as f64;
                    let left = placed.x + label.dx - if label.anchor == "end" { width } else { 0.0 };
                    let middle = placed.y + label.dy;
                    Some([left, middle - 7.0, left + width, middle + 7.0])
                })
                .collect();
            for (at, area) in areas.iter().enumerate() {
                assert!(areas[..at].iter().all(|other| !overlap(area, other)), "{}: {areas:?}", drawing.name);
            }
        }
    }

    #[test]
    fn the_front_is_a_staircase() {
        let corners = stairs(&[[10.0, 50.0], [30.0, 80.0]], 5.0, 99.0);
        assert_eq!(corners, [[10.0, 5.0], [10.0, 50.0], [30.0, 50.0], [30.0, 80.0], [99.0, 80.0]]);
        assert_eq!(path(&corners), "M10 5V50H30V80H99");
        assert_eq!(path(&stairs(&[], 5.0, 99.0)), "");
    }

    #[test]
    fn a_label_takes_a_place_off_the_front() {
        // Both below the point on the left and above it on the right there is room.
        let points = [point("one", 1.0, 0.9, true, &[]), point("two", 10.0, 0.3, true, &[])];
        for drawing in drawings(&points, None).iter().filter(|drawing| drawing.name == "wide") {
            let steps: Vec<[f64; 2]> = drawing.points.iter().map(|placed| [placed.x, placed.y]).collect();
            let corners = stairs(&steps, drawing.top, drawing.right);
            for placed in &drawing.points {
                let label = placed.label.as_ref().expect("there is room");
                let width = LETTER[0] * label.text.len() as f64;
                let left = placed.x + label.dx - if label.anchor == "end" { width } else { 0.0 };
                let [above, below] = [-0.5, 0.5].map(|half| placed.y + label.dy + half * LETTER[1]);
                let area = [left, above, left + width, below];
                let on = corners.windows(2).filter(|pair| passes(&[pair[0], pair[1]], &area)).count();
                assert_eq!(on, 0, "{}: {area:?} on {corners:?}", label.text);
            }
        }
    }

    #[test]
    fn labels_of_an_axis_do_not_touch() {
        let tick = |at: f64, text: &str| Tick { value: 1.0, at, text: text.to_owned() };
        let kept = apart([tick(10.0, "500"), tick(40.0, "1000"), tick(60.0, "2000"), tick(95.0, "5000")].into_iter());
        assert_eq!(kept.iter().map(|tick| tick.text.as_str()).collect::<Vec<_>>(), ["500", "2000"]);
    }
}
