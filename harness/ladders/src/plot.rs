//! Plots of series of points, as SVG: both axes are logarithmic or linear, points have labels, and
//! the points that nothing faster beats lie on a staircase.

use super::CostError;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

/// Width and height of a plot in pixels.
const SIZE: (u32, u32) = (1200, 760);
/// Colours of the series, safe for colour-blind readers (Okabe and Ito 2008).
pub const COLORS: [RGBColor; 6] = [
    RGBColor(0x00, 0x00, 0x00),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x8c, 0x51, 0x0a),
];
/// Colour of lines that others are compared with.
pub const GREY: RGBColor = RGBColor(0x99, 0x99, 0x99);
/// Colour of the grid.
const LIGHT: RGBColor = RGBColor(0xee, 0xee, 0xee);
/// Colour of a legend's border.
const FRAME: RGBColor = RGBColor(0xcc, 0xcc, 0xcc);

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
    /// A filled triangle.
    Triangle,
    /// A cross.
    Cross,
    /// A square.
    Square,
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
}

/// Points of one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; empty to leave it out.
    pub name: String,
    /// The colour.
    pub color: RGBColor,
    /// Width in pixels of the line through the points; 0 for none.
    pub line: u32,
    /// The points.
    pub points: Vec<Point>,
}

impl Series {
    /// Returns a line.
    pub fn line(name: &str, color: RGBColor, width: u32, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let points = points.into_iter().map(|at| Point { at, ..Point::default() }).collect();
        Self { name: name.to_owned(), color, line: width, points }
    }

    /// Returns the series with a disc at each point.
    #[must_use]
    pub fn dotted(mut self) -> Self {
        self.points.iter_mut().for_each(|point| point.marker = Marker::Disc);
        self
    }
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is shown, with its unit.
    pub label: String,
    /// The limits of a linear axis; `None` for a logarithmic one that has room for all points.
    pub linear: Option<(f64, f64)>,
    /// The labelled values; empty for round numbers.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// Returns a logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// Returns a linear axis.
    pub fn linear(label: &str, limits: (f64, f64)) -> Self {
        Self { label: label.to_owned(), linear: Some(limits), ticks: Vec::new() }
    }

    /// Returns the axis with labels at these values.
    #[must_use]
    pub fn with_ticks(self, ticks: impl Into<Vec<f64>>) -> Self {
        Self { ticks: ticks.into(), ..self }
    }

    /// Whether the axis can show a value: a logarithmic one shows numbers above 0.
    fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.linear.is_some() || value > 0.0)
    }

    /// Returns the axis laid out for values that it can show.
    fn scale(&self, values: impl Iterator<Item = f64> + Clone) -> Scale {
        if let Some((low, high)) = self.linear {
            // Ten steps or so, of 1, 2 or 5 times a power of ten.
            let rough = (high - low) / 10.0;
            let power = 10f64.powf(rough.log10().floor());
            let step = [1.0, 2.0, 5.0, 10.0].map(|part| part * power).into_iter().find(|step| *step >= rough);
            let step = step.unwrap_or(rough);
            let count = ((high - low) / step + 1e-9).floor() as u32;
            let ticks = (0..=count).map(|k| low + f64::from(k) * step).collect();
            let decimals = (-step.log10().floor()).max(0.0) as usize;
            return Scale { range: low..high, log: false, ticks, decimals };
        }
        let margin = 10f64.powf(MARGIN);
        let low = values.clone().fold(f64::INFINITY, f64::min) / margin;
        let high = values.fold(0.0, f64::max) * margin;
        let parts: &[u32] = match high / low {
            ..FEW => &[1, 2, 3, 4, 5, 6, 8],
            ..MANY => &[1, 2, 5],
            _ => &[1],
        };
        let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let ticks = powers
            .flat_map(|power| parts.iter().map(move |part| format!("{part}e{power}").parse().unwrap_or(f64::NAN)));
        let ticks: Vec<f64> = if self.ticks.is_empty() { ticks.collect() } else { self.ticks.clone() };
        Scale {
            ticks: ticks.into_iter().filter(|tick| (low..=high).contains(tick)).collect(),
            range: low..high,
            log: true,
            decimals: 0,
        }
    }
}

/// An axis with its limits and its labelled values.
struct Scale {
    range: Range<f64>,
    log: bool,
    ticks: Vec<f64>,
    /// Decimals of the labels of a linear axis.
    decimals: usize,
}

impl Ranged for Scale {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let place = |value: f64| if self.log { value.log10() } else { value };
        let Range { start: low, end: high } = self.range;
        let share = (place(*value) - place(low)) / (place(high) - place(low));
        start + (share * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Scale {
    fn format(value: &f64) -> String {
        value.to_string()
    }

    fn format_ext(&self, value: &f64) -> String {
        match self.log {
            false => format!("{value:.0$}", self.decimals),
            true if (1e-3..1e6).contains(value) => value.to_string(),
            true => format!("{value:e}"),
        }
    }
}

/// Room beyond the outermost points of a logarithmic axis, in powers of ten.
const MARGIN: f64 = 0.12;
/// Ratio of a logarithmic axis's limits below which almost every digit is labelled.
const FEW: f64 = 30.0;
/// Ratio of a logarithmic axis's limits from which powers of ten alone are labelled.
const MANY: f64 = 1e4;

/// Where the legend stands.
pub type Corner = SeriesLabelPosition;

/// A plot.
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
    /// Where the legend stands.
    pub legend: Corner,
}

/// A rung as a point of error against time.
pub struct Dot<'a> {
    /// The rung's name.
    pub rung: &'a str,
    /// Milliseconds and error.
    pub at: (f64, f64),
    /// Index of the group that gives the colour.
    pub group: usize,
    /// The symbol.
    pub marker: Marker,
    /// Whether its error can be compared with the others'.
    pub compared: bool,
}

impl<'a> Dot<'a> {
    /// Returns a point; `None` if a figure is missing or cannot be shown on a logarithmic axis.
    pub fn new(rung: &'a str, ms: Option<f64>, error: Option<f64>, group: usize) -> Option<Self> {
        let at = ms.filter(|ms| *ms > 0.0).zip(error.filter(|error| *error > 0.0))?;
        Some(Self { rung, at, group, marker: Marker::Disc, compared: true })
    }
}

/// Returns the series of a ladder: the staircase through the rungs that no faster one beats, up to
/// the factor `alike` between errors, then the rungs by group. A group's index is that of its
/// colour.
pub fn ladder(dots: &[Dot<'_>], groups: &[&str], front: (&str, u32), alike: f64) -> Vec<Series> {
    let beaten = |dot: &Dot<'_>| {
        dots.iter().any(|other| other.compared && other.at.0 < dot.at.0 && other.at.1 <= alike * dot.at.1)
    };
    let is_front: Vec<bool> = dots.iter().map(|dot| dot.compared && !beaten(dot)).collect();
    let best = dots.iter().zip(&is_front).filter(|(_, front)| **front).map(|(dot, _)| dot.at).collect();
    let mut series = vec![Series::line(front.0, GREY, front.1, stairs(best))];
    for (group, name) in groups.iter().enumerate() {
        let own = dots.iter().zip(&is_front).filter(|(dot, _)| dot.group == group);
        let points: Vec<Point> = own
            .map(|(dot, &front)| Point { at: dot.at, marker: dot.marker, label: dot.rung.to_owned(), front })
            .collect();
        if !points.is_empty() {
            series.push(Series { name: (*name).to_owned(), color: COLORS[group], line: 0, points });
        }
    }
    series
}

/// Returns the staircase line through the best points of time and error: the smallest error that
/// each amount of time buys.
fn stairs(mut front: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut stairs = Vec::new();
    for pair in front.windows(2) {
        stairs.extend([pair[0], (pair[1].0, pair[0].1)]);
    }
    stairs.extend(front.last());
    stairs
}

impl Plot {
    /// Whether the plot has a point besides lines of comparison.
    pub fn is_empty(&self) -> bool {
        !self.points().any(|point| point.marker != Marker::None)
    }

    /// Returns the points that the axes can show.
    fn points(&self) -> impl Iterator<Item = &Point> + Clone {
        self.series.iter().flat_map(|series| self.shown(series))
    }

    fn shown<'s>(&'s self, series: &'s Series) -> impl Iterator<Item = &'s Point> + Clone {
        series.points.iter().filter(|point| self.x.shows(point.at.0) && self.y.shows(point.at.1))
    }

    /// Returns the plot as SVG.
    ///
    /// # Errors
    /// Returns an error if there is nothing to draw or if plotters fails.
    pub fn svg(&self) -> Result<String, CostError> {
        let mut text = String::new();
        let drawn = if self.is_empty() { Err("nothing was timed".into()) } else { self.draw(&mut text) };
        drawn.map_err(|error| CostError::Plot(format!("{}: {error}", self.file)))?;
        Ok(text)
    }

    fn draw(&self, text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let across = self.x.scale(self.points().map(|point| point.at.0));
        let up = self.y.scale(self.points().map(|point| point.at.1));
        let mut chart = ChartBuilder::on(&root)
            .caption(&self.caption, ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(across, up)?;
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .bold_line_style(LIGHT)
            .label_style(("sans-serif", 13))
            .draw()?;
        for series in &self.series {
            let color = series.color;
            let style = color.stroke_width(series.line);
            let anno =
                chart
                    .draw_series((series.line > 0).then(|| {
                        PathElement::new(self.shown(series).map(|point| point.at).collect::<Vec<_>>(), style)
                    }))?;
            let is_line = series.line > 0;
            if !series.name.is_empty() {
                anno.label(&series.name).legend(move |(x, y)| {
                    let line = PathElement::new([(x, y), (x + 18, y)], style);
                    let disc = Circle::new((x + 9, y), 5, color.filled());
                    if is_line { line.into_dyn() } else { disc.into_dyn() }
                });
            }
            for point in self.shown(series) {
                let (at, size) = (point.at, if point.front { 7 } else { 4 });
                match point.marker {
                    Marker::None => continue,
                    Marker::Disc => chart.draw_series([Circle::new(at, size, color.filled())])?,
                    Marker::Ring => chart.draw_series([Circle::new(at, size, color.stroke_width(2))])?,
                    Marker::Triangle => chart.draw_series([TriangleMarker::new(at, size + 1, color.filled())])?,
                    Marker::Cross => chart.draw_series([Cross::new(at, size, color.stroke_width(2))])?,
                    Marker::Square => {
                        let square = Rectangle::new([(-size, -size), (size, size)], color.filled());
                        chart.draw_series([EmptyElement::at(at) + square])?
                    }
                };
            }
        }
        let marked: Vec<(&Point, (i32, i32))> = self
            .points()
            .filter(|point| point.marker != Marker::None)
            .map(|point| (point, chart.backend_coord(&point.at)))
            .collect();
        for (label, at) in placed(&marked) {
            let (size, shade) = font(label);
            let style = ("sans-serif", size).into_font().color(&RGBColor(shade, shade, shade));
            root.draw(&Text::new(label.label.clone(), at, style.pos(Pos::new(HPos::Left, VPos::Bottom))))?;
        }
        chart
            .configure_series_labels()
            .position(self.legend.clone())
            .border_style(FRAME)
            .background_style(WHITE.mix(0.9))
            .label_font(("sans-serif", 13))
            .draw()?;
        root.present()?;
        Ok(())
    }
}

/// Returns a label's font size and grey level.
fn font(point: &Point) -> (i32, u8) {
    if point.front { (13, 0x11) } else { (10, 0x88) }
}

/// A rectangle of the drawing: left, top, right, bottom.
type Area = [i32; 4];

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Returns a label's rectangle from its lower left corner.
fn area(point: &Point, (left, bottom): (i32, i32)) -> Area {
    let (size, _) = font(point);
    // A letter's width is about 0.6 of the font size.
    [left, bottom - size, left + 3 * size * point.label.len() as i32 / 5, bottom]
}

/// Places the labels of `points`, each with its pixel, and returns their lower left corners. The
/// best points come first; labels overlap neither each other nor the points. If there is no room, a
/// point that is not one of the best gets no label.
fn placed<'p>(points: &[(&'p Point, (i32, i32))]) -> Vec<(&'p Point, (i32, i32))> {
    let mut taken: Vec<Area> = points.iter().map(|(_, (x, y))| [x - 5, y - 5, x + 5, y + 5]).collect();
    let mut order: Vec<_> = points.iter().filter(|(point, _)| !point.label.is_empty()).collect();
    order.sort_by_key(|(point, _)| !point.front);
    let mut found = Vec::new();
    for &&(point, (x, y)) in &order {
        let [left, top, right, bottom] = area(point, (0, 0));
        let (width, size) = (right - left, bottom - top);
        // To the right or left, above or below, then farther up and down.
        let sides = [x + 7, x - 7 - width, x - width / 2];
        let mut corners: Vec<(i32, i32)> = Vec::new();
        for away in [0, 16, 32] {
            corners.extend(sides.map(|left| (left, y - 3 - away)));
            corners.extend(sides.map(|left| (left, y + size + 3 + away)));
        }
        let free = |corner: &(i32, i32)| {
            let area = area(point, *corner);
            area[2] < SIZE.0 as i32 && !taken.iter().any(|other| overlap(&area, other))
        };
        let near = if point.front { corners.len() } else { 6 };
        let place = corners[..near].iter().copied().find(free).or(point.front.then_some(corners[0]));
        if let Some(corner) = place {
            taken.push(area(point, corner));
            found.push((point, corner));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(series: Vec<Series>) -> Plot {
        let [x, y] = ["milliseconds", "error"].map(Axis::log);
        Plot { file: "a.svg", caption: "A ladder".to_owned(), x, y, series, legend: Corner::UpperRight }
    }

    #[test]
    fn labels_lie_on_no_other_and_on_no_point() {
        let at = |k: i32| (600 + 9 * (k % 3), 300 + 9 * (k / 3));
        let point =
            |k| Point { label: "a rung's name".to_owned(), front: k < 2, marker: Marker::Disc, ..Point::default() };
        let points: Vec<Point> = (0..6).map(point).collect();
        let marked: Vec<(&Point, (i32, i32))> = points.iter().zip((0..6).map(at)).collect();
        let areas: Vec<Area> = placed(&marked).into_iter().map(|(point, corner)| area(point, corner)).collect();
        assert!(areas.len() >= 2, "the best have labels");
        for (index, area) in areas.iter().enumerate() {
            assert!(areas[..index].iter().all(|other| !overlap(area, other)), "{areas:?}");
            assert!((0..6).map(at).all(|(x, y)| !overlap(area, &[x - 5, y - 5, x + 5, y + 5])), "{areas:?}");
        }
    }

    #[test]
    fn stairs_go_right_before_they_go_down() {
        assert_eq!(stairs(vec![(3.0, 1.0), (1.0, 5.0)]), [(1.0, 5.0), (3.0, 5.0), (3.0, 1.0)]);
        assert!(stairs(Vec::new()).is_empty());
    }

    #[test]
    fn a_ladder_shows_every_rung_and_the_best_on_the_stairs() {
        let rungs = [("fast", 1.0, 0.5, 0), ("slow", 2.0, 0.5, 1), ("near", 3.0, 1e-5, 1)];
        let mut dots: Vec<Dot<'_>> =
            rungs.iter().filter_map(|&(rung, ms, error, group)| Dot::new(rung, Some(ms), Some(error), group)).collect();
        let stairs = |dots: &[Dot<'_>]| ladder(dots, &["plain", "better"], ("the best", 2), 1.0)[0].points.len();
        assert_eq!(stairs(&dots), 3);
        let series = ladder(&dots, &["plain", "better"], ("the best", 2), 1.0);
        assert_eq!(series[2].points.iter().map(|point| point.front).collect::<Vec<_>>(), [false, true]);
        let svg = plot(series).svg().expect("drawn");
        for text in ["fast", "slow", "near", "plain", "better", "the best", "milliseconds", "1e-5"] {
            assert!(svg.contains(&format!("\n{text}\n")), "{text}: {svg}");
        }
        dots[2].compared = false;
        assert_eq!(stairs(&dots), 1);
        assert!(Dot::new("none", None, Some(1.0), 0).is_none() && Dot::new("exact", Some(1.0), Some(0.0), 0).is_none());
        // A logarithmic axis cannot show zero.
        let zero = plot(vec![Series::line("growth", GREY, 2, [(0.0, 1.0), (2.0, 2.0), (3.0, 0.0)]).dotted()]);
        assert!(!zero.is_empty() && zero.svg().expect("drawn").contains("growth"));
        assert!(plot(vec![Series::line("nothing", GREY, 2, [(0.0, 1.0)]).dotted()]).is_empty());
        let empty = plot(vec![Series::line("law", GREY, 2, [(1.0, 1.0), (2.0, 2.0)])]).svg();
        assert!(empty.expect_err("no rung").to_string().contains("nothing was timed"));
    }

    #[test]
    fn axes_are_labelled_by_round_numbers() {
        let names = |axis: Axis, values: [f64; 2]| -> Vec<String> {
            let scale = axis.scale(values.into_iter());
            scale.ticks.iter().map(|tick| scale.format_ext(tick)).collect()
        };
        assert_eq!(names(Axis::log(""), [0.3, 1.0]), ["0.3", "0.4", "0.5", "0.6", "0.8", "1"]);
        assert_eq!(names(Axis::log(""), [0.01, 1.0]), ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(names(Axis::log(""), [1e-7, 0.1]), ["1e-7", "1e-6", "1e-5", "1e-4", "0.001", "0.01", "0.1"]);
        let linear = Axis::linear("", (0.0, 0.9));
        assert_eq!(names(Axis::log("").with_ticks([16.0, 32.0, 512.0]), [16.0, 256.0]), ["16", "32"]);
        assert_eq!(names(linear, [0.0; 2]).last().map(String::as_str), Some("0.9"));
    }
}
