//! What a plot shows: series of points, each with its symbol and its label.

use super::axis::Axis;

/// A colour: a class, to which a file's or a page's style gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(u8);

/// Colours of the series.
pub const COLORS: [Color; 6] = [Color(1), Color(2), Color(3), Color(4), Color(5), Color(6)];
/// Colour of lines that others are compared with.
pub const GREY: Color = Color(0);

impl Color {
    /// Returns the class.
    #[must_use]
    pub fn class(self) -> String {
        format!("series-{}", self.0)
    }
}

/// A point's symbol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marker {
    /// Nothing: a corner of a line.
    #[default]
    None,
    /// A filled circle.
    Disc,
    /// A circle.
    Ring,
    /// A square.
    Square,
    /// A triangle.
    Triangle,
    /// A square on its tip.
    Diamond,
    /// A cross.
    Cross,
    /// A triangle on its tip.
    Tip,
}

impl Marker {
    /// Returns its path about the origin.
    #[must_use]
    pub fn path(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Disc | Self::Ring => "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z",
            Self::Square => "M-4.5 -4.5H4.5V4.5H-4.5Z",
            Self::Triangle => "M0 -6L5.5 4.2H-5.5Z",
            Self::Diamond => "M0 -6.4L5.4 0L0 6.4L-5.4 0Z",
            Self::Cross => "M-5.4 -3L-3 -5.4L0 -2.4L3 -5.4L5.4 -3L2.4 0L5.4 3L3 5.4L0 2.4L-3 5.4L-5.4 3L-2.4 0Z",
            Self::Tip => "M0 6L5.5 -4.2H-5.5Z",
        }
    }
}

/// Where a point leads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The address.
    pub href: String,
    /// Further attributes: names and values.
    pub attributes: Vec<(&'static str, String)>,
}

/// A point of a series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// The point in the units of the axes.
    pub at: (f64, f64),
    /// The symbol.
    pub marker: Marker,
    /// The label beside it; empty for none.
    pub label: String,
    /// Whether the point is one of the best; the others are drawn less prominently.
    pub front: bool,
    /// Whether it is chosen by default: it has a ring, and always its label.
    pub chosen: bool,
    /// Whether its label has a place before those of the best.
    pub early: bool,
    /// What a page tells of it; may be empty.
    pub title: String,
    /// Where it leads on a page.
    pub link: Option<Link>,
}

/// Points of one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; empty to leave it out.
    pub name: String,
    /// The colour.
    pub color: Color,
    /// Width in pixels of the line through the points; 0 for none.
    pub line: u32,
    /// Whether the line is a staircase: from the top of the plot down to each point, across to the next, and from the
    /// last to the right end. Points come from the left.
    pub stairs: bool,
    /// The points.
    pub points: Vec<Point>,
}

impl Series {
    /// Returns a line.
    pub fn line(name: &str, color: Color, width: u32, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let points = points.into_iter().map(|position| Point { at: position, ..Point::default() }).collect();
        Self { name: name.to_owned(), color, line: width, stairs: false, points }
    }

    /// Returns the series with a disc at each point.
    #[must_use]
    pub fn dotted(mut self) -> Self {
        self.points.iter_mut().for_each(|point| point.marker = Marker::Disc);
        self
    }
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Name of the plot's file.
    pub file: &'static str,
    /// Caption.
    pub caption: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The series, the first at the bottom.
    pub series: Vec<Series>,
}

impl Plot {
    /// Whether the plot has a point besides lines of comparison.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.points().any(|point| point.marker != Marker::None)
    }

    /// Returns the points that the axes can show.
    pub(super) fn points(&self) -> impl Iterator<Item = &Point> + Clone {
        self.series.iter().flat_map(|series| self.shown(series))
    }

    /// Returns the points of a series that the axes can show.
    pub(super) fn shown<'s>(&'s self, series: &'s Series) -> impl Iterator<Item = &'s Point> + Clone {
        series.points.iter().filter(|point| self.x.shows(point.at.0) && self.y.shows(point.at.1))
    }
}
