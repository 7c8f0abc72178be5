//! A plot's drawing: its grid, its lines, and its points with their labels, whose colours are those of classes.

use super::axis::{Axis, Room, Scale};
use super::labels::{self, Label, Line, Place, Wanted, Weight};
use super::markup::{self, add, escaped, four_digits, path, rounded};
use super::series::{Marker, Plot, Point, Series};

/// What a drawing has room for, in pixels, of which a letter is 14 high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Format {
    /// Left, top, right and bottom of the plot's area.
    pub area: [f64; 4],
    /// Whether points are labelled that are not chosen.
    pub labels: bool,
}

/// A plot's drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// What is in the `svg` element, of classes `grid`, `line`, `front` and `point`.
    pub markup: String,
    /// Attributes that tell a script where a further point stands: the ends of the axes as `data-x0`, `data-x1`,
    /// `data-y0` and `data-y1`, their pixels as `data-left`, `data-right`, `data-top` and `data-bottom`, and in
    /// `data-ticks` the labels of the horizontal axis if its ends move apart: each a text, a colon, and the powers of
    /// ten between the ends up to which it has room.
    pub data: String,
}

impl Plot {
    /// Draws the plot.
    #[must_use]
    pub fn drawing(&self, format: &Format) -> Drawing {
        let [left, top, right, bottom] = format.area;
        let across = self.x.scale(self.points().map(|point| point.at.0), [left, right], Room::Across);
        let up = self.y.scale(self.points().map(|point| point.at.1), [bottom, top], Room::Up);
        let mut sheet = Sheet { plot: self, format, across, up, markup: String::new() };
        sheet.draw();
        let ([x0, x1], [y0, y1]) = (sheet.across.ends, sheet.up.ends);
        let data = format!(
            r#"data-x0="{x0}" data-x1="{x1}" data-y0="{y0}" data-y1="{y1}" data-left="{left}" data-right="{right}" data-top="{top}" data-bottom="{bottom}" data-ticks="{}""#,
            sheet.across.growing()
        );
        Drawing { markup: sheet.markup, data }
    }
}

/// A drawing under way.
struct Sheet<'p> {
    plot: &'p Plot,
    format: &'p Format,
    across: Scale,
    up: Scale,
    markup: String,
}

impl Sheet<'_> {
    fn draw(&mut self) {
        self.draw_grid();
        let plot = self.plot;
        let marked: Vec<&Point> = plot.points().filter(|point| point.marker != Marker::None).collect();
        let wanted: Vec<(usize, Wanted<'_>)> = marked
            .iter()
            .enumerate()
            .filter_map(|(index, point)| {
                let weight = Weight::of(point);
                let is_named = !point.label.is_empty() && (self.format.labels || weight == Weight::Always);
                is_named.then(|| (index, Wanted { text: &point.label, at: self.place(point), weight }))
            })
            .collect();
        let places: Vec<Place> = marked.iter().map(|point| self.place(point)).collect();
        let lines: Vec<Line> = plot
            .series
            .iter()
            .filter(|series| series.line > 0)
            .flat_map(|series| self.corners(series).windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>())
            .collect();
        let only: Vec<Wanted<'_>> = wanted.iter().map(|(_, wanted)| *wanted).collect();
        let placed = labels::place(&only, &places, &lines, &self.format.area);
        let mut labels: Vec<Option<Label>> = vec![None; marked.len()];
        wanted.iter().zip(placed).for_each(|((index, _), label)| labels[*index] = label);
        let mut labels = labels.into_iter();
        for stairs in plot.series.iter().filter(|series| series.stairs) {
            self.draw_line(stairs);
        }
        for series in &plot.series {
            if !series.stairs {
                self.draw_line(series);
            }
            for point in plot.shown(series).filter(|point| point.marker != Marker::None) {
                let markup = markup::point(series.color, point, self.place(point), labels.next().flatten());
                self.markup.push_str(&markup);
            }
        }
    }

    /// Returns where a point stands.
    fn place(&self, point: &Point) -> Place {
        [self.across.at(point.at.0), self.up.at(point.at.1)].map(rounded)
    }

    /// Returns the corners of the line of a series.
    fn corners(&self, series: &Series) -> Vec<Place> {
        let places: Vec<Place> = self.plot.shown(series).map(|point| self.place(point)).collect();
        let [_, top, right, _] = self.format.area;
        if series.stairs { stairs(&places, top, right) } else { places }
    }

    fn draw_grid(&mut self) {
        let Format { area: [left, top, right, bottom], .. } = *self.format;
        let mut grid = String::from("<g class=\"grid\" aria-hidden=\"true\">\n");
        for tick in self.up.ticks() {
            let y = rounded(self.up.at(tick.value));
            let (beside, below, text) = (left - 8.0, rounded(y + 5.0), &tick.text);
            add(
                &mut grid,
                format_args!(
                    r#"<line x1="{left}" x2="{right}" y1="{y}" y2="{y}"/><text x="{beside}" y="{below}" text-anchor="end">{text}</text>"#
                ),
            );
        }
        for tick in self.across.ticks() {
            let x = rounded(self.across.at(tick.value));
            let (value, below, text) = (tick.value, bottom + 22.0, &tick.text);
            add(
                &mut grid,
                format_args!(
                    r#"<g class="column" data-x="{value}" transform="translate({x} 0)"><line y1="{top}" y2="{bottom}"/><text y="{below}" text-anchor="middle">{text}</text></g>"#
                ),
            );
        }
        let Axis { label, limit, .. } = &self.plot.x;
        if let Some((value, text)) = limit.filter(|(value, _)| self.across.holds(*value)) {
            let (x, above) = (rounded(self.across.at(value)), top - 8.0);
            add(
                &mut grid,
                format_args!(
                    r#"<line class="limit" x1="{x}" x2="{x}" y1="{top}" y2="{bottom}"/><text x="{x}" y="{above}" text-anchor="middle">{}</text>"#,
                    escaped(text)
                ),
            );
        }
        add(
            &mut grid,
            format_args!(
                r#"<line class="axis" x1="{left}" x2="{right}" y1="{bottom}" y2="{bottom}"/><text class="axis-title" x="{right}" y="{}" text-anchor="end">{} →</text>"#,
                bottom + 44.0,
                escaped(label)
            ),
        );
        grid.push_str("</g>\n");
        self.markup.push_str(&grid);
    }

    fn draw_line(&mut self, series: &Series) {
        let path = path(&self.corners(series));
        if series.line == 0 || path.is_empty() {
            return;
        }
        let (class, width) = (if series.stairs { "front" } else { "line" }, series.line);
        let color = series.color.class();
        let steps =
            self.plot.shown(series).map(|point| format!("{},{}", four_digits(point.at.0), four_digits(point.at.1)));
        let steps = steps.collect::<Vec<_>>().join(" ");
        let data = if series.stairs { format!(r#" data-front="{steps}""#) } else { String::new() };
        add(
            &mut self.markup,
            format_args!(
                r#"<path class="{class} {color}" stroke-width="{width}" d="{path}"{data} aria-hidden="true"/>"#
            ),
        );
    }
}

/// Returns the corners of a staircase down through places that come from the left, as lines from one to the next.
fn stairs(places: &[Place], top: f64, right: f64) -> Vec<Place> {
    let (Some([x, _]), Some([_, last])) = (places.first(), places.last()) else { return Vec::new() };
    let mut corners = vec![[*x, top]];
    for [x, y] in places {
        let before = corners[corners.len() - 1][1];
        corners.extend([[*x, before], [*x, *y]]);
    }
    corners.push([right, *last]);
    corners.dedup();
    corners
}

#[cfg(test)]
mod tests {
    use super::super::series::{COLORS, GREY, Link};
    use super::*;

    const FORMAT: Format = Format { area: [58.0, 34.0, 946.0, 484.0], labels: true };

    #[test]
    fn points_stand_where_the_axes_say() {
        let points = [(1.0, 0.9), (10.0, 0.3), (30.0, 0.1)];
        let series = vec![Series::line("a", COLORS[2], 0, points).dotted()];
        let [x, y] = ["", ""].map(Axis::log);
        let plot = Plot { file: "", caption: String::new(), x, y, series };
        let Drawing { markup, data } = plot.drawing(&FORMAT);
        let number = |name: &str| -> f64 {
            let (_, rest) = data.split_once(&format!("data-{name}=\"")).expect("an attribute");
            rest.split('"').next().and_then(|value| value.parse().ok()).expect("a number")
        };
        for (value, error) in points {
            let share = (value / number("x0")).ln() / (number("x1") / number("x0")).ln();
            let x = rounded(number("left") + share * (number("right") - number("left")));
            let share = (error / number("y0")).ln() / (number("y1") / number("y0")).ln();
            let y = rounded(number("bottom") + share * (number("top") - number("bottom")));
            let point = format!(
                "<g class=\"point series-3\" data-x=\"{value}\" data-y=\"{error}\" transform=\"translate({x} {y})\">"
            );
            assert!(markup.contains(&point), "{point}: {markup}");
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
    fn a_page_gets_links_titles_and_the_chosen_labels() {
        let link = Link { href: "a&b".to_owned(), attributes: vec![("data-rung", "<x>".to_owned())] };
        let point = |label: &str, chosen| Point {
            at: (1.0, 2.0),
            marker: Marker::Disc,
            label: label.to_owned(),
            chosen,
            title: "it's \"a\"".to_owned(),
            link: Some(link.clone()),
            ..Point::default()
        };
        let points = vec![point("fast: a", true), point("b", false)];
        let series = vec![Series { points, ..Series::line("", GREY, 0, []) }];
        let x = Axis { limit: Some((1.0, "a limit")), ..Axis::log("") };
        let plot = Plot { file: "", caption: String::new(), x, y: Axis::log(""), series };
        let markup = plot.drawing(&Format { labels: false, ..FORMAT }).markup;
        let first = "<a href=\"a&amp;b\" data-rung=\"&lt;x&gt;\"><title>it's &quot;a&quot;</title>";
        assert!(markup.contains(first), "{markup}");
        assert!(markup.contains(">fast: a</text>") && !markup.contains(">b</text>"), "{markup}");
        assert!(markup.contains("a limit") && markup.contains("tabindex=\"-1\""));
    }
}
