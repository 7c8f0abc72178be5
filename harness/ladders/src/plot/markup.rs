//! The elements of a drawing: points, paths and text.

use super::labels::{Label, Place, Weight};
use super::series::{Color, Marker, Point};
use std::fmt::Write as _;

/// Draws a point of a colour at its place: its symbol, and its label if that has room.
pub(super) fn point(color: Color, point: &Point, [x, y]: Place, label: Option<Label>) -> String {
    let mut class = format!("point {}", color.class());
    for (name, has) in [("on-front", point.front), ("default", point.chosen), ("hollow", point.marker == Marker::Ring)]
    {
        if has {
            class.extend([" ", name]);
        }
    }
    let mut inside = String::new();
    if !point.title.is_empty() {
        inside.extend(["<title>", &escaped(&point.title), "</title><circle class=\"reach\" r=\"12\"/>"]);
    }
    if point.chosen {
        inside.push_str("<circle class=\"ring\" r=\"10\"/>");
    }
    inside.extend(["<path class=\"mark\" d=\"", point.marker.path(), "\"/>"]);
    if let Some(Label { from_point, ends, led, .. }) = label {
        let [right, down] = from_point.map(rounded);
        if led {
            inside.push_str(&format!(r#"<line class="leader" x2="{right}" y2="{down}"/>"#));
        }
        let (class, anchor) = (
            if Weight::of(point) == Weight::Small { "label small" } else { "label" },
            if ends { "end" } else { "start" },
        );
        let (below, text) = (rounded(down + 5.0), escaped(&point.label));
        inside.push_str(&format!(
            r#"<text class="{class}" x="{right}" y="{below}" text-anchor="{anchor}">{text}</text>"#
        ));
    }
    if let Some(link) = &point.link {
        let mut attributes = format!(r#"href="{}""#, escaped(&link.href));
        for (name, value) in &link.attributes {
            attributes.push_str(&format!(r#" {name}="{}""#, escaped(value)));
        }
        // The keyboard goes to what matters.
        if !point.front && !point.chosen {
            attributes.push_str(" tabindex=\"-1\"");
        }
        inside = format!("<a {attributes}>{inside}</a>");
    }
    let (value, error) = (four_digits(point.at.0), four_digits(point.at.1));
    format!(
        "<g class=\"{class}\" data-x=\"{value}\" data-y=\"{error}\" transform=\"translate({x} {y})\">{inside}</g>\n"
    )
}

/// Adds a line of markup.
pub(super) fn add(markup: &mut String, line: std::fmt::Arguments<'_>) {
    writeln!(markup, "{line}").unwrap_or_default();
}

/// Returns a path through corners.
pub(super) fn path(corners: &[Place]) -> String {
    let Some([x, y]) = corners.first() else { return String::new() };
    let line = |pair: &[Place]| match pair {
        [[x, _], [next, y]] if x == next => format!("V{y}"),
        [[_, y], [x, next]] if y == next => format!("H{x}"),
        [_, [x, y]] => format!("L{x} {y}"),
        _ => String::new(),
    };
    format!("M{x} {y}{}", corners.windows(2).map(line).collect::<String>())
}

/// Rounds to a tenth of a pixel, so that files stay small.
pub(super) fn rounded(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// Returns a value with four digits, as drawings have it, so that they stay small.
#[must_use]
pub fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Returns text as it stands in elements and in attributes.
pub(super) fn escaped(text: &str) -> String {
    let entity = |sign: char| match sign {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        other => other.to_string(),
    };
    text.chars().map(entity).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_across_up_and_aslant() {
        assert_eq!(path(&[[1.0, 2.0], [3.0, 4.5], [3.0, 1.0], [0.0, 1.0]]), "M1 2L3 4.5V1H0");
        assert_eq!(path(&[]), "");
    }

    #[test]
    fn no_text_becomes_markup() {
        assert_eq!(escaped("<a b=\"c\">'&amp;'</a>"), "&lt;a b=&quot;c&quot;&gt;'&amp;amp;'&lt;/a&gt;");
    }
}
