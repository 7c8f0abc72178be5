//! A ladder's rungs as points of error against time, and the staircase through the best.

use super::series::{COLORS, GREY, Marker, Point, Series};

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
        let figures = ms.filter(|ms| *ms > 0.0).zip(error.filter(|error| *error > 0.0))?;
        Some(Self { rung, at: figures, group, marker: Marker::Disc, compared: true })
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
    let mut best: Vec<(f64, f64)> =
        dots.iter().zip(&is_front).filter(|(_, front)| **front).map(|(dot, _)| dot.at).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut series = vec![Series { stairs: true, ..Series::line(front.0, GREY, front.1, best) }];
    for (group, name) in groups.iter().enumerate() {
        let members = dots.iter().zip(&is_front).filter(|(dot, _)| dot.group == group);
        let point = |(dot, &front): (&Dot<'_>, &bool)| Point {
            at: dot.at,
            marker: dot.marker,
            label: dot.rung.to_owned(),
            front,
            ..Point::default()
        };
        let points: Vec<Point> = members.map(point).collect();
        if !points.is_empty() {
            let name = (*name).to_owned();
            series.push(Series { name, color: COLORS[group], line: 0, stairs: false, points });
        }
    }
    series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_are_on_the_stairs_from_the_left() {
        let rungs = [("near", 3.0, 1e-5, 1), ("slow", 2.0, 0.5, 1), ("fast", 1.0, 0.5, 0)];
        let mut dots: Vec<Dot<'_>> =
            rungs.iter().filter_map(|&(rung, ms, error, group)| Dot::new(rung, Some(ms), Some(error), group)).collect();
        let stairs = |dots: &[Dot<'_>]| -> Vec<(f64, f64)> {
            let series = ladder(dots, &["plain", "better"], ("the best", 2), 1.0);
            assert!(series[0].stairs && series[0].name == "the best");
            series[0].points.iter().map(|point| point.at).collect()
        };
        assert_eq!(stairs(&dots), [(1.0, 0.5), (3.0, 1e-5)]);
        let series = ladder(&dots, &["plain", "better"], ("the best", 2), 1.0);
        assert_eq!(series[2].points.iter().map(|point| point.front).collect::<Vec<_>>(), [true, false]);
        dots[0].compared = false;
        assert_eq!(stairs(&dots), [(1.0, 0.5)]);
        assert!(Dot::new("none", None, Some(1.0), 0).is_none() && Dot::new("exact", Some(1.0), Some(0.0), 0).is_none());
    }
}
