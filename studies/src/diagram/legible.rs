//! Whether every label of a drawing can be read: it lies on the sheet, and neither a label nor a line crosses it.

use super::label;
use super::scene::{Anchor, Point, Scene, Shape};
use glam::DVec2;

/// What a label covers, by rather too wide letters.
struct Covered {
    text: String,
    lower: DVec2,
    upper: DVec2,
}

/// Returns what hinders reading, a sentence each.
pub fn faults(scene: &Scene) -> Vec<String> {
    let labels: Vec<Covered> = scene.items.iter().filter_map(|item| covered(&item.shape)).collect();
    let sheet = DVec2::new(f64::from(scene.width), f64::from(scene.height));
    let mut faults = Vec::new();
    for (index, label) in labels.iter().enumerate() {
        if label.lower.cmplt(DVec2::ZERO).any() || label.upper.cmpgt(sheet).any() {
            faults.push(format!("`{}` leaves the sheet", label.text));
        }
        for other in &labels[..index] {
            if label.lower.cmplt(other.upper).all() && other.lower.cmplt(label.upper).all() {
                faults.push(format!("`{}` lies over `{}`", label.text, other.text));
            }
        }
        if scene.items.iter().any(|item| crosses(&item.shape, label)) {
            faults.push(format!("a line crosses `{}`", label.text));
        }
    }
    faults
}

fn covered(shape: &Shape) -> Option<Covered> {
    let Shape::Label { at: place, anchor, size, runs, .. } = shape else { return None };
    let width = label::width(runs, size.0);
    let before = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width,
        Anchor::End => width,
    };
    let text = runs.iter().map(|run| run.text.as_str()).collect();
    let lower = place.0 - DVec2::new(before, 0.7 * size.0);
    Some(Covered { text, lower, upper: lower + DVec2::new(width, 0.8 * size.0) })
}

/// Whether a line that is not thin, or any arrow, passes through a label.
fn crosses(shape: &Shape, label: &Covered) -> bool {
    match shape {
        Shape::Line { points, closed, pen, .. } if pen.width != "thin" => {
            let next = points.iter().skip(1).chain(points.first().filter(|_| *closed));
            points.iter().zip(next).any(|(from, to)| passes(*from, *to, label))
        }
        Shape::Dot { at: middle, radius, .. } | Shape::Ring { at: middle, radius, .. } => {
            middle.0.clamp(label.lower, label.upper).distance(middle.0) < radius.0 && radius.0 < 12.0
        }
        _ => false,
    }
}

/// Whether a segment passes through a label's rectangle.
fn passes(Point(from): Point, Point(to): Point, label: &Covered) -> bool {
    let way = to - from;
    let (first, second) = ((label.lower - from) / way, (label.upper - from) / way);
    let (enter, leave) = (first.min(second), first.max(second));
    // A segment along an axis divides by 0, and 0 / 0 lies on a side: it doesn't count.
    enter.max_element().max(0.0) < leave.min_element().min(1.0)
}
