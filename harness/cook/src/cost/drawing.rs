//! Shared parts of plots: size and colours, frame and legend, axis ticks, point labels, and the
//! staircase line of the best rungs.

use super::CostError;
use plotters::coord::{CoordTranslate, Shift};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width and height of a plot in pixels.
pub const SIZE: (u32, u32) = (1200, 760);
/// Colours of the series, safe for colour-blind readers (Okabe and Ito 2008).
pub(super) const COLORS: [RGBColor; 5] = [
    RGBColor(0x00, 0x00, 0x00),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
];
/// Colour of lines that others are compared with.
pub(super) const GREY: RGBColor = RGBColor(0x99, 0x99, 0x99);
/// Colour of the grid.
pub(super) const LIGHT: RGBColor = RGBColor(0xee, 0xee, 0xee);
/// Colour of a legend's border.
const FRAME: RGBColor = RGBColor(0xcc, 0xcc, 0xcc);

/// The result of drawing a plot.
pub(super) type Drawn = Result<(), Box<dyn std::error::Error>>;

/// The surface that a plot is drawn on.
pub(super) type Root<'text> = DrawingArea<SVGBackend<'text>, Shift>;

/// Returns what `draw` draws on a white background, as SVG.
pub(super) fn written(draw: impl FnOnce(&Root<'_>) -> Drawn) -> Result<String, CostError> {
    let mut text = String::new();
    let drawn = || -> Drawn {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
        Ok(())
    };
    drawn().map_err(|error| CostError::Plot(error.to_string()))?;
    Ok(text)
}

/// Returns a chart builder with a caption and room for the axes.
pub(super) fn captioned<'root, 'text>(
    root: &'root Root<'text>,
    caption: impl AsRef<str>,
) -> ChartBuilder<'root, 'text, SVGBackend<'text>> {
    let mut builder = ChartBuilder::on(root);
    builder.caption(caption, ("sans-serif", 18)).margin(16).x_label_area_size(44).y_label_area_size(64);
    builder
}

/// Returns a line symbol for a legend.
pub(super) fn line(color: RGBColor, width: u32) -> impl Fn((i32, i32)) -> PathElement<(i32, i32)> {
    move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(width))
}

/// Returns a disc symbol for a legend.
pub(super) fn disc(color: RGBColor) -> impl Fn((i32, i32)) -> Circle<(i32, i32), i32> {
    move |(x, y)| Circle::new((x + 9, y), 5, color.filled())
}

/// Draws the legend of all labelled series.
pub(super) fn legend<'text, C: CoordTranslate>(
    chart: &mut ChartContext<'text, SVGBackend<'text>, C>,
    position: SeriesLabelPosition,
) -> Drawn {
    chart
        .configure_series_labels()
        .position(position)
        .border_style(FRAME)
        .background_style(WHITE.mix(0.9))
        .label_font(("sans-serif", 13))
        .draw()?;
    Ok(())
}

/// Returns the limits of a logarithmic axis around `values`, with a margin.
pub(super) fn span(values: impl Iterator<Item = f64> + Clone, margin: f64) -> std::ops::Range<f64> {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(0.0, f64::max);
    low / margin..high * margin
}

/// Returns the labels that lie within the axis.
pub(super) fn ticks(labels: &[f64], axis: &std::ops::Range<f64>) -> Vec<f64> {
    labels.iter().copied().filter(|label| axis.contains(label)).collect()
}

/// A point and its label.
pub(super) struct Label<'a> {
    pub(super) name: &'a str,
    /// Position of the point in pixels of the drawing.
    pub(super) at: (i32, i32),
    /// Whether the point is one of the best; the others are drawn less prominently.
    pub(super) front: bool,
}

impl Label<'_> {
    /// Returns the font size and the grey level.
    fn font(&self) -> (i32, u8) {
        if self.front { (13, 0x11) } else { (10, 0x88) }
    }
}

/// A rectangle of the drawing: left, top, right, bottom.
type Area = [i32; 4];

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Places the labels beside their points and returns their lower left corners. The best points come
/// first; labels overlap neither each other nor the `markers`. If there is no room, a point that is
/// not one of the best gets no label.
fn placed<'l, 'a>(labels: &'l [Label<'a>], markers: &[(i32, i32)]) -> Vec<(&'l Label<'a>, (i32, i32))> {
    let mut taken: Vec<Area> = markers.iter().map(|&(x, y)| [x - 5, y - 5, x + 5, y + 5]).collect();
    let mut order: Vec<&Label<'a>> = labels.iter().collect();
    order.sort_by_key(|label| !label.front);
    let mut found = Vec::new();
    for label in order {
        let (x, y) = label.at;
        let (size, _) = label.font();
        // A letter's width is about 0.6 of the font size.
        let width = 3 * size * label.name.len() as i32 / 5;
        // To the right or left, above or below, then farther up and down.
        let sides = [x + 7, x - 7 - width, x - width / 2];
        let mut corners: Vec<(i32, i32)> = Vec::new();
        for away in [0, 16, 32] {
            corners.extend(sides.map(|left| (left, y - 3 - away)));
            corners.extend(sides.map(|left| (left, y + size + 3 + away)));
        }
        let area = |&(left, bottom): &(i32, i32)| [left, bottom - size, left + width, bottom];
        let free = |corner: &(i32, i32)| {
            let area = area(corner);
            area[2] < SIZE.0 as i32 && !taken.iter().any(|other| overlap(&area, other))
        };
        let near = if label.front { corners.len() } else { 6 };
        let place = corners[..near].iter().copied().find(free).or(label.front.then_some(corners[0]));
        if let Some(corner) = place {
            taken.push(area(&corner));
            found.push((label, corner));
        }
    }
    found
}

/// Draws the labels; `markers` are the centres of all points.
pub(super) fn draw(root: &Root<'_>, labels: &[Label<'_>], markers: &[(i32, i32)]) -> Drawn {
    for (label, at) in placed(labels, markers) {
        let (size, shade) = label.font();
        let style = ("sans-serif", size).into_font().color(&RGBColor(shade, shade, shade));
        root.draw(&Text::new(label.name.to_owned(), at, style.pos(Pos::new(HPos::Left, VPos::Bottom))))?;
    }
    Ok(())
}

/// Returns the staircase line through the best points of time and error: the smallest error that
/// each amount of time buys.
pub(super) fn stairs(mut front: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut stairs = Vec::new();
    for pair in front.windows(2) {
        stairs.extend([pair[0], (pair[1].0, pair[0].1)]);
    }
    stairs.extend(front.last());
    stairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_lie_on_no_other_and_on_no_marker() {
        let at = |k: i32| (600 + 9 * (k % 3), 300 + 9 * (k / 3));
        let markers: Vec<(i32, i32)> = (0..6).map(at).collect();
        let labels: Vec<Label<'_>> = (0..6).map(|k| Label { name: "a rung's name", at: at(k), front: k < 2 }).collect();
        let areas: Vec<Area> = placed(&labels, &markers)
            .iter()
            .map(|(label, (left, bottom))| {
                let (size, _) = label.font();
                [*left, bottom - size, left + 3 * size * label.name.len() as i32 / 5, *bottom]
            })
            .collect();
        assert!(areas.len() >= 2, "the choices have labels");
        for (index, area) in areas.iter().enumerate() {
            assert!(areas[..index].iter().all(|other| !overlap(area, other)), "{areas:?}");
            assert!(markers.iter().all(|&(x, y)| !overlap(area, &[x - 5, y - 5, x + 5, y + 5])), "{areas:?}");
        }
    }

    #[test]
    fn stairs_go_right_before_they_go_down() {
        assert_eq!(stairs(vec![(3.0, 1.0), (1.0, 5.0)]), [(1.0, 5.0), (3.0, 5.0), (3.0, 1.0)]);
        assert!(stairs(Vec::new()).is_empty());
    }
}
