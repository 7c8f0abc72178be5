//! What a diagram consists of: lines, areas, dots and labels on a sheet, in the order in which they are
//! drawn. The template `diagram.xml` writes it.

use super::label::{self, Run};
use super::number::Number;
use glam::DVec2;
use serde::{Serialize, Serializer};

/// A place on the sheet, x to the right and y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point(pub DVec2);

impl Serialize for Point {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        [Number(self.0.x), Number(self.0.y)].serialize(serializer)
    }
}

/// What something is drawn with. The page's style sheet says which colour that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Paint {
    /// Bodies and text.
    Ink,
    /// Guides, and what is not the subject.
    Dim,
    /// The subject: light, results.
    Accent,
    /// A second subject beside it.
    Second,
    /// What is lost, rejected or a hazard.
    Warm,
}

/// A line's paint and form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Pen {
    /// The paint.
    pub paint: Paint,
    /// The style sheet's name of its width.
    pub width: &'static str,
    /// Whether it is dashed.
    pub dashed: bool,
}

impl Pen {
    /// A line of usual width.
    pub const fn new(paint: Paint) -> Self {
        Self { paint, width: "middle", dashed: false }
    }

    /// The same line, wide.
    pub const fn wide(self) -> Self {
        Self { width: "wide", ..self }
    }

    /// The same line, thin.
    pub const fn thin(self) -> Self {
        Self { width: "thin", ..self }
    }

    /// The same line, dashed.
    pub const fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }
}

/// Pens by their paint.
pub const INK: Pen = Pen::new(Paint::Ink);
/// For guides.
pub const DIM: Pen = Pen::new(Paint::Dim);
/// For the subject.
pub const ACCENT: Pen = Pen::new(Paint::Accent);
/// For a second subject.
pub const SECOND: Pen = Pen::new(Paint::Second);
/// For what is rejected.
pub const WARM: Pen = Pen::new(Paint::Warm);

/// Which part of a label stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// One thing on the sheet.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Shape {
    /// A filled polygon.
    Area {
        /// Its corners.
        points: Vec<Point>,
        /// Its paint.
        paint: Paint,
        /// Its opacity.
        opacity: Number,
    },
    /// A filled rectangle.
    Cell {
        /// Upper left corner.
        at: Point,
        /// Width and height.
        size: Point,
        /// Its paint.
        paint: Paint,
        /// Its opacity.
        opacity: Number,
    },
    /// A polyline, or the outline of a polygon.
    Line {
        /// Its corners.
        points: Vec<Point>,
        /// How it is drawn.
        pen: Pen,
        /// Whether the last corner joins the first.
        closed: bool,
        /// Corners of the arrow's head; none for a plain line.
        head: Vec<Point>,
    },
    /// An arc of a circle.
    Arc {
        /// Where it begins.
        from: Point,
        /// Where it ends.
        to: Point,
        /// The circle's radius.
        radius: Number,
        /// 1 if it takes the longer way.
        large: u8,
        /// 1 if it runs clockwise on the sheet.
        sweep: u8,
        /// How it is drawn.
        pen: Pen,
    },
    /// A circle.
    Ring {
        /// Its middle.
        at: Point,
        /// Its radius.
        radius: Number,
        /// How it is drawn.
        pen: Pen,
    },
    /// A filled circle.
    Dot {
        /// Its middle.
        at: Point,
        /// Its radius.
        radius: Number,
        /// Its paint.
        paint: Paint,
    },
    /// A line of text.
    Label {
        /// The place of its baseline.
        at: Point,
        /// Which part of it stands there.
        anchor: Anchor,
        /// Size of its letters.
        size: Number,
        /// Its paint.
        paint: Paint,
        /// Its parts.
        runs: Vec<Run>,
    },
}

/// A shape, and its name if it states a fact that a test checks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Item {
    /// The fact's name.
    pub name: Option<&'static str>,
    /// The shape.
    #[serde(flatten)]
    pub shape: Shape,
}

/// A drawing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// Width of the sheet.
    pub width: u32,
    /// Height of the sheet.
    pub height: u32,
    /// What is on it, from the lowest up.
    pub items: Vec<Item>,
}

/// Size of notes in words.
pub const NOTE: f64 = 19.0;
/// Size of symbols.
pub const SYMBOL: f64 = 23.0;

/// Length and half width of an arrow's head.
const HEAD: (f64, f64) = (13.0, 5.0);

impl Scene {
    /// An empty sheet.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height, items: Vec::new() }
    }

    fn push(&mut self, shape: Shape) -> &mut Self {
        self.items.push(Item { name: None, shape });
        self
    }

    /// Names what was drawn last.
    pub fn named(&mut self, name: &'static str) {
        if let Some(item) = self.items.last_mut() {
            item.name = Some(name);
        }
    }

    /// Returns all shapes with this name.
    pub fn of_name(&self, name: &str) -> impl Iterator<Item = &Shape> {
        self.items.iter().filter(move |item| item.name == Some(name)).map(|item| &item.shape)
    }

    /// Fills a polygon.
    pub fn area(&mut self, points: &[DVec2], paint: Paint, opacity: f64) -> &mut Self {
        self.push(Shape::Area { points: on_sheet(points), paint, opacity: Number(opacity) })
    }

    /// Fills a rectangle between two opposite corners.
    pub fn cell(&mut self, one: DVec2, other: DVec2, paint: Paint, opacity: f64) -> &mut Self {
        let (corner, size) = (Point(one.min(other)), Point((one - other).abs()));
        self.push(Shape::Cell { at: corner, size, paint, opacity: Number(opacity) })
    }

    /// Draws a polyline.
    pub fn line(&mut self, points: &[DVec2], pen: Pen) -> &mut Self {
        self.push(Shape::Line { points: on_sheet(points), pen, closed: false, head: Vec::new() })
    }

    /// Draws the outline of a polygon.
    pub fn outline(&mut self, points: &[DVec2], pen: Pen) -> &mut Self {
        self.push(Shape::Line { points: on_sheet(points), pen, closed: true, head: Vec::new() })
    }

    /// Draws a polyline with an arrow's head at its end, and with the tip exactly there.
    pub fn arrow(&mut self, points: &[DVec2], pen: Pen) -> &mut Self {
        let (mut points, mut head) = (points.to_vec(), Vec::new());
        if let [.., before, tip] = points[..] {
            let along = (tip - before).normalize_or_zero();
            let base = tip - HEAD.0.min((tip - before).length()) * along;
            head = on_sheet(&[tip, base + HEAD.1 * along.perp(), base - HEAD.1 * along.perp()]);
            if let Some(last) = points.last_mut() {
                *last = tip - 0.8 * (tip - base);
            }
        }
        self.push(Shape::Line { points: on_sheet(&points), pen, closed: false, head })
    }

    /// Draws the arc about `centre` from one direction to another, the shorter way.
    pub fn angle(&mut self, centre: DVec2, radius: f64, from: DVec2, to: DVec2, pen: Pen) -> &mut Self {
        let [start, end] = [from, to].map(|direction| direction.normalize_or_zero());
        let sweep = u8::from(start.perp_dot(end) > 0.0);
        let [from, to] = [start, end].map(|direction| Point(centre + radius * direction));
        self.push(Shape::Arc { from, to, radius: Number(radius), large: 0, sweep, pen })
    }

    /// Draws a circle.
    pub fn ring(&mut self, middle: DVec2, radius: f64, pen: Pen) -> &mut Self {
        self.push(Shape::Ring { at: Point(middle), radius: Number(radius), pen })
    }

    /// Fills a circle.
    pub fn dot(&mut self, middle: DVec2, radius: f64, paint: Paint) -> &mut Self {
        self.push(Shape::Dot { at: Point(middle), radius: Number(radius), paint })
    }

    /// Writes words, with `$symbols$` between dollars. `place` is halfway up the small letters.
    pub fn note(&mut self, place: DVec2, anchor: Anchor, paint: Paint, text: &str) -> &mut Self {
        self.text(place, anchor, NOTE, paint, text)
    }

    /// Writes a symbol, without dollars.
    pub fn symbol(&mut self, place: DVec2, anchor: Anchor, paint: Paint, text: &str) -> &mut Self {
        self.text(place, anchor, SYMBOL, paint, &format!("${text}$"))
    }

    fn text(&mut self, place: DVec2, anchor: Anchor, size: f64, paint: Paint, text: &str) -> &mut Self {
        let baseline = Point(place + DVec2::new(0.0, 0.27 * size));
        self.push(Shape::Label { at: baseline, anchor, size: Number(size), paint, runs: label::runs(text, size) })
    }
}

fn on_sheet(points: &[DVec2]) -> Vec<Point> {
    points.iter().map(|point| Point(*point)).collect()
}
