//! The gem ladder's tables and plots.

use super::dispersion::Colours;
use super::growth::power_of;
use super::rungs::{FILLED, MEASURES, RUNGS};
use super::seen::{MEAN, STEADINESS, STEADY};
use super::views::{self, VIEWS};
use crate::plot::{self, Axis, Dot, Marker, Plot};
use crate::quality;
use crate::report::{Report, Row, TIME, all_pairs, distinct, dominated};
use crate::table::{Goal, Table, beyond, figure, marked, mean, sum};
use lapidary_plan::ladder::CONCAVE;
use lapidary_plan::{Geometry, Rung, Spectrum, Technique};

/// The factor by which a rung's error may exceed a faster one's and still count as equal: equal
/// geometry gives equal pictures except for rounding.
const ALIKE: f64 = 1.001;

/// Checks that a report is the whole ladder, timed.
pub(super) fn whole(report: &Report) -> Result<(), String> {
    report.all_timed(RUNGS, &[FILLED])?;
    let views = report.views("flip");
    if VIEWS.iter().chain(&views::CONCAVE).any(|view| !views.contains(&view.name)) {
        return Err("the report does not hold all views; only the whole ladder fills a page".to_owned());
    }
    Ok(())
}

/// A report with its rungs and its views of convex bodies.
struct Gem<'r> {
    report: &'r Report,
    rungs: Vec<&'r str>,
    views: Vec<&'r str>,
    concave: Vec<&'r str>,
}

impl<'r> Gem<'r> {
    fn new(report: &'r Report) -> Self {
        let is_concave = |view: &&str| CONCAVE.contains(view);
        let (concave, views) = report.views("change").into_iter().partition(is_concave);
        Self { report, rungs: report.rungs(TIME), views, concave }
    }

    /// Returns the magnitudes of a rung's errors, one per view.
    fn errors(&self, rung: &str, measure: &str) -> Vec<f64> {
        self.views.iter().filter_map(|view| Some(self.report.value(rung, view, measure)?.abs())).collect()
    }

    /// Returns the mean error over the views.
    fn mean(&self, rung: &str, measure: &str) -> Option<f64> {
        mean(&self.errors(rung, measure))
    }

    /// Returns the mean time of the pictures whose errors [`Self::mean`] averages.
    fn ms(&self, rung: &str) -> Option<f64> {
        let times = self.views.iter().map(|view| self.report.ms(rung, view, "flip"));
        mean(&times.collect::<Option<Vec<_>>>()?)
    }

    /// Returns the rungs than which another one is faster and, averaged over the views, no worse in
    /// either FLIP or RMSE, up to rounding.
    fn dominated(&self) -> Vec<&'r str> {
        dominated(&self.rungs, |other, rung| {
            let errors = ["flip", "rmse"].map(|measure| (self.mean(other, measure), self.mean(rung, measure)));
            all_pairs([(self.ms(other), self.ms(rung))], |other, ms| other < ms)
                && all_pairs(errors, |other, error| other <= ALIKE * error)
        })
    }

    /// Returns the time of a rung's frame that the stone fills.
    fn filled(&self, rung: &str) -> Option<f64> {
        self.report.ms(rung, FILLED, TIME)
    }

    /// Returns the time of `slow` divided by the time of `fast`, of frames that the stone fills.
    fn ratio(&self, slow: &str, fast: &str) -> Option<f64> {
        Some(self.filled(slow)? / self.filled(fast)?)
    }

    fn instructions(&self, rung: &str) -> String {
        self.report.row(rung, FILLED, TIME).map_or("-".to_owned(), |row| sum(&row.instructions))
    }

    fn bytes(&self, rung: &str) -> String {
        let bytes = self.report.row(rung, FILLED, TIME).and_then(|row| row.bytes);
        bytes.map_or("-".to_owned(), |bytes| bytes.to_string())
    }
}

pub(super) fn tables(report: &Report) -> Vec<Table> {
    let gem = Gem::new(report);
    let mut tables = vec![
        ladder(&gem),
        quality::table("gem_quality", report, &[Technique::Convex, Technique::Concave]),
        concave(&gem),
        steadiness(&gem),
        goals(&gem),
        paper(&gem),
        colours(report),
        ends(report),
    ];
    for (name, measure) in ["gem_flip", "gem_rmse", "gem_energy", "gem_change"].into_iter().zip(MEASURES) {
        let value = |rung: &str, view: &str| report.value(rung, view, measure);
        tables.push(each_view(name, &format!("{measure}, by view"), &gem, &value));
    }
    tables.push(each_view("gem_ms", "Milliseconds, by view", &gem, &|rung, view| report.ms(rung, view, "flip")));
    tables
}

fn ladder(gem: &Gem<'_>) -> Table {
    let report = gem.report;
    let dominated = gem.dominated();
    Table::of("ladder", "Gem ladder", &gem.rungs[..])
        .column("rung", |rung| (*rung).to_owned())
        .column("ms", |rung| figure(gem.ms(rung), 1))
        .column("× proxy-1", |rung| figure(gem.ms(rung).zip(gem.ms("proxy-1")).map(|(ms, proxy)| ms / proxy), 2))
        .column("FLIP", |rung| figure(gem.mean(rung, "flip"), 3))
        .column("worst FLIP", |rung| figure(gem.errors(rung, "flip").into_iter().reduce(f64::max), 3))
        .column("RMSE", |rung| figure(gem.mean(rung, "rmse"), 3))
        .column("energy", |rung| figure(gem.mean(rung, "energy"), 3))
        .column("change at 0.05°", |rung| figure(gem.mean(rung, "change"), 3))
        .column("ms, filled", |rung| report.shown_ms(rung, FILLED))
        .column("SPIR-V vertex + fragment", |rung| gem.instructions(rung))
        .column("bytes", |rung| gem.bytes(rung))
        .column("", |rung| marked(rung, &dominated))
        .note(format!(
            "Errors, change and ms are of the same pictures: {0} × {0} pixels, samples a pixel: {1}, means over the \
             views, against the spectral reference. Change is from this frame to one turned by 0.05°, RMS over the \
             reference's. `ms, filled` is of {2} pixels that the brilliant fills, as the paper has it; `*` timed on 1/16 \
             of them and scaled. Bytes: what the geometry needs besides positions and indices. Dominated: another rung \
             is faster and, averaged over the views, no worse by FLIP or by RMSE. Times: {3}.",
            report.setting("side"),
            report.setting("samples"),
            report.size(),
            report.run()
        ))
}

/// Shows the figures of every view that the means of the ladder are of.
fn each_view(name: &'static str, title: &str, gem: &Gem<'_>, value: &dyn Fn(&str, &str) -> Option<f64>) -> Table {
    let mut lines = Table::of(name, title, &gem.rungs[..]).column("rung", |rung| (*rung).to_owned());
    for view in gem.views.iter().chain(&gem.concave) {
        lines = lines.column(*view, |rung| figure(value(rung, view), 4));
    }
    lines.note("")
}

/// Shows the results in the views of concave bodies, for every rung that draws them.
fn concave(gem: &Gem<'_>) -> Table {
    let report = gem.report;
    let draws = |rung: &&str| gem.concave.iter().any(|view| report.row(rung, view, "flip").is_some());
    let rungs: Vec<&str> = gem.rungs.iter().copied().filter(draws).collect();
    let mut lines = Table::of("concave", "Concave bodies", rungs).column("rung", |rung| (*rung).to_owned());
    for view in &gem.concave {
        lines = lines.column(format!("{view}: ms, FLIP, RMSE, change"), |rung| {
            let errors = ["flip", "rmse", "change"].map(|measure| figure(report.value(rung, view, measure), 3));
            format!("{}, {}", figure(report.ms(rung, view, "flip"), 1), errors.join(", "))
        });
    }
    lines.note("")
}

fn steadiness(gem: &Gem<'_>) -> Table {
    let report = gem.report;
    let [flip, rmse, changes] = STEADINESS;
    let with = |row: &&Row| row.rung == STEADY && row.view == MEAN;
    let ways: Vec<&str> = report.rows.iter().filter(with).filter_map(|row| row.measure.strip_prefix(changes)).collect();
    let value =
        |view: &str, measure: &str, way: &str| figure(report.value(STEADY, view, &format!("{measure}{way}")), 3);
    let ms = |way: &str| report.ms(STEADY, MEAN, &format!("{changes}{way}"));
    let filled = |way: &str| report.ms(STEADY, FILLED, &format!("time with {way}"));
    Table::of("steadiness", "One rung by the way a pixel is sampled", ways)
        .column("rung", |_| STEADY.to_owned())
        .column("samples a pixel", |way| (*way).to_owned())
        .column("FLIP", |way| value(MEAN, flip, way))
        .column("RMSE to 64 samples", |way| value(MEAN, rmse, way))
        .column("the same, `brilliant`", |way| value("brilliant", rmse, way))
        .column("change at 0.05°", |way| value(MEAN, changes, way))
        .column("change, `brilliant`", |way| value("brilliant", changes, way))
        .column("ms", |way| figure(ms(way), 1))
        .column("ms, filled", |way| figure(filled(way), 1))
        .note("")
}

fn goals(gem: &Gem<'_>) -> Table {
    let mut goals = Vec::new();
    let mut judge = |goal: &str, measured: Option<f64>, met: &dyn Fn(f64) -> bool, show: &dyn Fn(f64) -> String| {
        goals.extend(measured.map(|measured| Goal::new(goal, show(measured), met(measured))));
    };
    let factor = |value: f64| format!("{value:.1} times");
    let loops = "proxy at least 20 times as fast as the loop over all triangles, one hit each";
    judge(loops, gem.ratio("triangles-1", "proxy-1"), &|value| value >= 20.0, &factor);
    let planes = "proxy at least 8 times as fast as the loop over the facet planes";
    judge(planes, gem.ratio("convex-1", "proxy-1"), &|value| value >= 8.0, &factor);
    let four = "four exact hits at most 4 times the proxy's one";
    judge(four, gem.ratio("walk-4", "proxy-1"), &|value| value <= 4.0, &factor);
    let eight = "eight exact hits at most 6 times the proxy's one";
    judge(eight, gem.ratio("walk-8", "proxy-1"), &|value| value <= 6.0, &factor);
    let power = "the walk's time growing with less than the 0.3rd power of the number of facets";
    judge(power, power_of(gem.report, "walk-8"), &|value| value < 0.3, &|value| format!("power {value:.2}"));
    judge("proxy faster than the BVH", gem.ratio("bvh-1", "proxy-1"), &|value| value > 1.0, &factor);
    for rung in ["proxy-1", "walk-8"] {
        // The paper's tracker is one shader at two strengths: its time is the lower one.
        let tracker = format!("{rung}+tracker");
        let [one, other] = ["paper", "paper-fitted"].map(|paper| gem.ratio(&tracker, &format!("{rung}+{paper}")));
        let goal = format!("exact tracker's time within 10 % of the paper's tracker's, `{rung}`");
        let slower = one.zip(other).map(|(one, other)| one.max(other));
        judge(&goal, slower, &|value| value <= 1.1, &|value| beyond(Some(value)));
    }
    let least = tracked(gem.report).into_iter().map(|(rung, view)| gain(gem.report, rung, view)).reduce(f64::min);
    judge(
        "its colours at least 5 times as close to separate wavelengths' as the paper's at its best strength, in the \
         view where they gain least",
        least,
        &|value| value >= 5.0,
        &factor,
    );
    Goal::table("goals", goals)
}

fn paper(gem: &Gem<'_>) -> Table {
    let ms = |rung: &str| format!("{} ms", gem.report.shown_ms(rung, FILLED));
    let compared =
        |rung: &str, what: &str| format!("{}, {} times ({what})", ms(rung), figure(gem.ratio(rung, "proxy-1"), 1));
    let encodes = || gem.rungs.iter().filter_map(|rung| gem.report.value(rung, FILLED, "encode"));
    let polygons = format!("{}; {}", compared("triangles-1", "all triangles"), compared("convex-1", "facet planes"));
    let shaders = format!(
        "{} SPIR-V instructions (vertex, fragment); +paper {}; +tracker {}",
        gem.instructions("proxy-1"),
        gem.instructions("proxy-1+paper"),
        gem.instructions("proxy-1+tracker")
    );
    let rows = [
        ["proxy, one hit", "3 ms", &ms("proxy-1")],
        ["exact: all polygons in a loop", "15 ms, 5 times", &polygons],
        ["BVH", "-", &compared("bvh-1", "112 triangles")],
        [
            "CPU for a frame",
            "20 µs for both",
            &format!("{} µs, recording and submitting through wgpu", range(encodes(), |us| format!("{us:.0}"))),
        ],
        ["shaders, proxy", "16 + 160 + 181 slots (vertex, geometry, pixel)", &shaders],
        ["shaders, exact", "16 + 160 + 152 slots", &gem.instructions("convex-1")],
        [
            "constants",
            "2304 bytes; exact 15056 bytes",
            &format!("80 bytes of uniforms, 64 of the material in storage; exact {} bytes more", gem.bytes("convex-1")),
        ],
    ];
    let timed = if gem.filled("proxy-1").is_some() { &rows[..] } else { &[] };
    Table::of("paper", "The paper's figures: section 5 and Table 1, 1920 × 1080 filled by the stone", timed)
        .column("", |row| row[0].to_owned())
        .column("the paper (GeForce GTX 760)", |row| row[1].to_owned())
        .column("here", |row| row[2].to_owned())
        .note("")
}

/// Returns the geometries and views in which tracked colours are compared with separate wavelengths.
fn tracked(report: &Report) -> Vec<(&str, &str)> {
    let rows = report.rows.iter().filter(|row| row.measure == Colours::MEASURES[0]);
    rows.map(|row| (&*row.rung, &*row.view)).collect()
}

/// Returns how many times closer the exact tracker is than the paper's at its best strength.
fn gain(report: &Report, rung: &str, view: &str) -> f64 {
    let [fitted, tracker] = ["fitted", "tracker"].map(|measure| report.value(rung, view, measure));
    fitted.zip(tracker).map_or(f64::NAN, |(fitted, tracker)| fitted / tracker)
}

/// Shows the range of the values as `least to most`.
fn range(values: impl Iterator<Item = f64>, show: impl Fn(f64) -> String) -> String {
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
    if least > most { "-".to_owned() } else { format!("{} to {}", show(least), show(most)) }
}

fn colours(report: &Report) -> Table {
    let tracked = tracked(report);
    let rungs = distinct(tracked.iter().map(|(rung, _)| *rung));
    let views = |rung: &str| -> Vec<&str> {
        tracked.iter().filter(|(other, _)| *other == rung).map(|(_, view)| *view).collect()
    };
    let spread = |rung: &str, measure: &str, show: &dyn Fn(f64) -> String| {
        range(views(rung).into_iter().filter_map(|view| report.value(rung, view, measure)), show)
    };
    let digits = |count: usize| move |value: f64| format!("{value:.count$}");
    let title = "Colours where the three wavelengths meet the same facets: RMS difference from separate wavelengths, \
                 least to most over the views";
    Table::of("colours", title, rungs)
        .column("geometry", |rung| (*rung).to_owned())
        .column("pixels that keep together", |rung| spread(rung, "shared", &|value| format!("{:.0} %", 100.0 * value)))
        .column("no dispersion", |rung| spread(rung, "undispersed", &digits(4)))
        .column("the paper's, literal", |rung| spread(rung, "paper", &digits(3)))
        .column("best strength", |rung| spread(rung, "strength", &digits(4)))
        .column("the paper's at it", |rung| spread(rung, "fitted", &digits(4)))
        .column("exact tracker", |rung| spread(rung, "tracker", &digits(5)))
        .column("gain", |rung| {
            range(views(rung).into_iter().map(|view| gain(report, rung, view)), |gain| format!("{gain:.0} times"))
        })
        .note("")
}

fn ends(report: &Report) -> Table {
    let rungs: Vec<&str> = report.rungs("energy").into_iter().filter(|rung| rung.contains(", ")).collect();
    let part = |rung: &str, index: usize| rung.splitn(2, ", ").nth(index).unwrap_or_default().to_owned();
    let shown = |rung: &str, measure: &str| {
        let rows = report.rows.iter().filter(|row| row.rung == rung && row.measure == measure);
        mean(&rows.filter_map(|row| row.value).collect::<Vec<_>>()).unwrap_or(f64::NAN)
    };
    Table::of("ends", "How a ray ends, means over the views", rungs)
        .column("rung", |rung| part(rung, 0))
        .column("end", |rung| part(rung, 1))
        .column("FLIP", |rung| format!("{:.4}", shown(rung, "flip")))
        .column("RMSE", |rung| format!("{:.4}", shown(rung, "rmse")))
        .column("energy", |rung| format!("{:+.4}", shown(rung, "energy")))
        .note("")
}

pub(super) fn plots(report: &Report) -> Vec<Plot> {
    let gem = Gem::new(report);
    vec![plot(&gem, "gem_flip.svg", "flip"), plot(&gem, "gem_rmse.svg", "rmse")]
}

/// Plots the mean of a measure against the mean time of the views.
fn plot(gem: &Gem<'_>, file: &'static str, measure: &str) -> Plot {
    let report = gem.report;
    let groups = ["surface alone", "proxy geometry", "convex planes", "BVH", "all triangles", "convex walk"];
    let dot = |rung| {
        let drawn: Option<Rung> = str::trim_end_matches(rung, "-fitted").parse().ok();
        let group = drawn.map_or(0, |rung| match rung {
            Rung::Inside { geometry: Geometry::Proxy, .. } => 1,
            Rung::Inside { geometry: Geometry::Convex, .. } => 2,
            Rung::Inside { geometry: Geometry::Bvh, .. } => 3,
            Rung::Inside { geometry: Geometry::Triangles, .. } => 4,
            Rung::Inside { geometry: Geometry::Walk, .. } => 5,
            _ => 0,
        });
        let marker = match drawn.map(Rung::spectrum) {
            Some(Spectrum::Paper) => Marker::Ring,
            Some(Spectrum::Tracker) => Marker::Triangle,
            Some(Spectrum::Split) => Marker::Square,
            Some(Spectrum::Separate(_)) => Marker::Cross,
            _ => Marker::Disc,
        };
        Some(Dot { marker, ..Dot::new(rung, gem.ms(rung), gem.mean(rung, measure), group)? })
    };
    let dots: Vec<Dot<'_>> = gem.rungs.iter().copied().filter_map(dot).collect();
    Plot {
        file,
        caption: format!(
            "Gem ladder: error ({measure}) against time, {0} × {0}, samples a pixel: {1}, {2}",
            report.setting("side"),
            report.setting("samples"),
            report.adapter
        ),
        x: Axis::log("milliseconds a view (least of interleaved rounds, mean over the views)"),
        y: Axis::log(format!("mean {measure} against the spectral reference")),
        series: plot::ladder(&dots, &groups, ("nothing faster is better", 2), ALIKE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Timing;

    /// Returns a report of one view, in which each rung has a time, a FLIP and an RMSE.
    fn report(rungs: &[(&str, Option<f64>, f64, f64)]) -> Report {
        let mut report = Report::new("gem", "a device".to_owned(), &[("side", 256)]);
        for &(rung, ms, flip, rmse) in rungs {
            for (measure, value) in MEASURES.into_iter().zip([flip, rmse, 0.0, 0.0]) {
                report.rows.push(Row::new(rung, "brilliant", measure, value, "").timed(ms));
            }
            let timing = ms.map(|ms| Timing { ms, median_ms: ms, share: 1.0, encode_us: 1.0 });
            report.add_time(Row::new(rung, FILLED, "", None, ""), timing.as_ref());
        }
        report
    }

    #[test]
    fn a_rung_is_dominated_by_a_faster_one_that_errs_no_more() {
        let rungs = [
            ("cheap", Some(1.0), 0.5, 0.5),
            ("slow", Some(2.0), 0.5, 0.5),
            ("mixed", Some(3.0), 0.4, 0.6),
            ("best", Some(4.0), 0.1, 0.1),
            ("worse", Some(5.0), 0.2, 0.2),
            ("untimed", None, 0.9, 0.9),
        ];
        assert_eq!(Gem::new(&report(&rungs)).dominated(), ["slow", "worse"]);
        let text = super::super::LADDER.text(&report(&rungs));
        assert_eq!(text.lines().filter(|line| line.ends_with("dominated")).count(), 2, "{text}");
    }

    #[test]
    fn a_plot_shows_every_timed_rung() {
        let timed = report(&[("surface", Some(1.0), 0.5, 0.5), ("convex-4+tracker", Some(3.0), 0.4, 0.6)]);
        let plots_of_rungs = || plots(&timed).into_iter().filter(|plot| !plot.is_empty());
        assert_eq!(plots_of_rungs().count(), 2);
        for plot in plots_of_rungs() {
            let svg = plot.svg();
            assert!(svg.contains("surface") && svg.contains("convex-4+tracker") && svg.ends_with("</svg>\n"), "{svg}");
        }
        assert!(plots(&report(&[("surface", None, 0.9, 0.9)])).iter().all(Plot::is_empty));
    }

    #[test]
    fn the_concave_views_are_those_that_plans_are_judged_by() {
        assert_eq!(views::CONCAVE.map(|view| view.name), CONCAVE);
    }

    #[test]
    fn a_part_of_the_ladder_is_not_whole() {
        let part = report(&[("surface", Some(1.0), 0.5, 0.5)]);
        assert!(whole(&part).expect_err("a part").contains("no time of `proxy-0`"));
        assert!(whole(&report(&[])).expect_err("nothing").contains("`surface`"));
    }
}
