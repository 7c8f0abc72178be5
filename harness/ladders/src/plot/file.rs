//! A plot as a file of its own: caption, colours and legend about the drawing.

use super::drawing::Format;
use super::markup::{add, escaped};
use super::series::{Marker, Plot, Series};

/// Width in pixels of a file's drawing.
const WIDTH: f64 = 1200.0;
/// Left, top, right and bottom of the plot's area.
const AREA: [f64; 4] = [72.0, 84.0, 1180.0, 684.0];
/// Height of a line of the legend.
const LINE: f64 = 26.0;
/// Width of a letter of the legend at most, and of what else an entry takes: the sample, and the room around it.
const LETTER: f64 = 8.4;
const SAMPLE: f64 = 54.0;

/// The fonts are the site's, and the colours of the series are safe for colour-blind readers (Okabe and Ito 2008).
const STYLE: &str = r##"
text { font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", sans-serif; font-size: 14px; fill: #4a4f59; }
.caption { font-size: 15px; font-weight: 500; fill: #0d1014; }
.ground { fill: #fff; }
.grid line { stroke: #e6e3dc; }
.grid .axis { stroke: #5a606b; }
.line, .front { fill: none; stroke: currentColor; stroke-linejoin: round; }
.mark { fill: currentColor; stroke: #fff; stroke-width: 1; }
.hollow .mark { fill: none; stroke: currentColor; stroke-width: 2; }
.point .mark { transform: scale(.8); }
.point.on-front .mark { transform: scale(1.15); }
.leader { stroke: #5a606b; }
.label { font-family: ui-monospace, "SF Mono", "Cascadia Code", Menlo, Consolas, "DejaVu Sans Mono", monospace; font-size: 13px; fill: #0d1014; paint-order: stroke; stroke: #fff; stroke-width: 4px; stroke-linejoin: round; }
.label.small { font-size: 11px; fill: #5a606b; }
.series-0 { color: #999; }
.series-1 { color: #000; }
.series-2 { color: #d55e00; }
.series-3 { color: #0072b2; }
.series-4 { color: #009e73; }
.series-5 { color: #cc79a7; }
.series-6 { color: #8c510a; }
"##;

impl Plot {
    /// Returns the plot as an SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        let [left, top, right, bottom] = AREA;
        let legend = self.legend([left, bottom + 76.0], right);
        let height = bottom + 76.0 + LINE * legend.lines + 4.0;
        let drawing = self.drawing(&Format { area: AREA, labels: true });
        let mut text = String::new();
        add(
            &mut text,
            format_args!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}">"#
            ),
        );
        add(&mut text, format_args!("<style>{STYLE}</style>"));
        add(&mut text, format_args!(r#"<rect class="ground" width="{WIDTH}" height="{height}"/>"#));
        add(&mut text, format_args!(r#"<text class="caption" x="20" y="30">{}</text>"#, escaped(&self.caption)));
        add(&mut text, format_args!(r#"<text x="20" y="{}">↑ {}</text>"#, top - 24.0, escaped(&self.y.label)));
        text.extend([&drawing.markup, &legend.markup, "</svg>\n"]);
        text
    }

    /// Draws the legend in lines between two pixels: for each series that has a name a sample and the name.
    fn legend(&self, [left, top]: [f64; 2], right: f64) -> Legend {
        let (mut x, mut lines, mut markup) = (left, 1.0, String::new());
        for series in self.series.iter().filter(|series| !series.name.is_empty()) {
            let width = SAMPLE + LETTER * series.name.chars().count() as f64;
            if x > left && x + width > right {
                (x, lines) = (left, lines + 1.0);
            }
            let y = top + LINE * (lines - 1.0);
            let (color, sample, name) = (series.color.class(), sample(series), escaped(&series.name));
            add(
                &mut markup,
                format_args!(
                    r#"<g class="{color}" transform="translate({x:.0} {y})">{sample}<text x="28" y="5">{name}</text></g>"#
                ),
            );
            x += width;
        }
        Legend { markup, lines }
    }
}

struct Legend {
    markup: String,
    /// How many lines it has.
    lines: f64,
}

/// Draws what a series looks like.
fn sample(series: &Series) -> String {
    if series.line > 0 {
        return format!(r#"<path class="line" stroke-width="{}" d="M0 0H20"/>"#, series.line);
    }
    format!(r#"<path class="mark" transform="translate(10 0)" d="{}"/>"#, Marker::Disc.path())
}

#[cfg(test)]
mod tests {
    use super::super::axis::Axis;
    use super::super::ladder::{Dot, ladder};
    use super::super::series::{GREY, Plot, Series};

    fn plot(series: Vec<Series>) -> Plot {
        let [x, y] = ["milliseconds", "error"].map(Axis::log);
        Plot { file: "a.svg", caption: "A ladder of a < b".to_owned(), x, y, series }
    }

    #[test]
    fn a_ladder_shows_every_rung_the_axes_and_the_legend() {
        let rungs = [("fast", 1.0, 0.5, 0), ("slow", 2.0, 0.5, 1), ("near", 3.0, 1e-5, 1)];
        let dots: Vec<Dot<'_>> =
            rungs.iter().filter_map(|&(rung, ms, error, group)| Dot::new(rung, Some(ms), Some(error), group)).collect();
        let svg = plot(ladder(&dots, &["plain", "better"], ("the best", 2), 1.0)).svg();
        for text in
            ["fast", "slow", "near", "plain", "better", "the best", "milliseconds →", "1e-5", "A ladder of a &lt; b"]
        {
            assert!(svg.contains(&format!(">{text}</text>")), "{text}: {svg}");
        }
        assert!(svg.contains("<svg xmlns=") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches("<g class=\"point ").count(), 3);
        assert_eq!(svg.matches("class=\"front series-0\"").count(), 1);
    }

    #[test]
    fn a_logarithmic_axis_cannot_show_zero() {
        let zero = plot(vec![Series::line("growth", GREY, 2, [(0.0, 1.0), (2.0, 2.0), (3.0, 0.0)]).dotted()]);
        assert!(!zero.is_empty() && zero.svg().contains("growth"));
        assert_eq!(zero.svg().matches("<g class=\"point ").count(), 1);
        assert!(plot(vec![Series::line("nothing", GREY, 2, [(0.0, 1.0)]).dotted()]).is_empty());
        assert!(plot(vec![Series::line("law", GREY, 2, [(1.0, 1.0), (2.0, 2.0)])]).is_empty());
    }
}
