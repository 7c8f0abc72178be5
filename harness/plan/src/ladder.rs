//! The committed ladders, as far as they matter for choosing a rung: each rung's error and time,
//! and the rule that the defaults obey.

use super::quality::{Quality, Technique, figure};
use serde::Deserialize;
use std::sync::LazyLock;

/// A rung of a ladder.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Name of the rung.
    pub rung: String,
    /// Mean error over the views.
    pub error: f64,
    /// Largest error of any view.
    pub worst: f64,
    /// Time in milliseconds.
    pub ms: f64,
}

impl Step {
    /// Whether the step takes longer than `other` by more than times vary between runs.
    fn is_dearer_than(&self, other: &Self) -> bool {
        self.ms > (1.0 + SAME_TIME) * other.ms
    }
}

/// A ladder under the single measure that decides its defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct Ladder {
    /// Name of the error measure, written before its value.
    pub measure: &'static str,
    /// All rungs with an error and a time, in the ladder's order.
    pub steps: Vec<Step>,
}

/// A more expensive rung becomes a default only if it cuts the error of the next cheaper rung by
/// this share.
pub const CUT: f64 = 0.1;
/// Times within this share of each other count as equal: the shortest times on a busy machine vary
/// by as much.
pub const SAME_TIME: f64 = 0.1;
/// Ratio of errors that count as equal: the same geometry gives the same picture up to rounding.
const ALIKE: f64 = 1.001;

/// The views of the gem ladder that show bodies which are not convex; not every rung draws them.
pub const CONCAVE: [&str; 2] = ["bunny_stone", "prism_chain"];

/// What the ladders of scattering bodies measure.
const WALKS: &str = "distance from walks";

const GEM: &str = include_str!("../../../docs/measurements/lavapipe/gem.json");
const CDRF: &str = include_str!("../../../docs/measurements/lavapipe/cdrf.json");
const TRANSLUCENT: &str = include_str!("../../../docs/measurements/lavapipe/translucent.json");
const OPTICAL_PATH: &str = include_str!("../../../docs/measurements/lavapipe/optical_path.json");

/// The techniques that have a ladder, in their own order, and the committed reports.
const REPORTS: [(Technique, &str); 6] = [
    (Technique::Convex, GEM),
    (Technique::Concave, GEM),
    (Technique::Cdrf, CDRF),
    (Technique::Translucent, TRANSLUCENT),
    (Technique::OpticalPath, OPTICAL_PATH),
    (Technique::Diffusion, TRANSLUCENT),
];

static COMMITTED: LazyLock<[Option<Ladder>; 6]> =
    LazyLock::new(|| REPORTS.map(|(technique, record)| Ladder::of_record(technique, record).ok()));

impl Ladder {
    /// Returns the committed ladder of a technique; `None` for a technique with a single rung.
    #[must_use]
    pub fn committed(technique: Technique) -> Option<&'static Self> {
        COMMITTED.get(technique as usize)?.as_ref()
    }

    /// Reads the ladder of a technique from a report of `cook cost`: the mean error and the mean time
    /// over the views that the technique is judged by. Rungs that lack either in one of the views
    /// are left out, such as the one that made the views' reference.
    ///
    /// # Errors
    /// Returns an error if the record is not a report.
    pub fn of_record(technique: Technique, record: &str) -> Result<Self, serde_json::Error> {
        let Record { rows } = serde_json::from_str(record)?;
        let (measure, name): (_, fn(&Row) -> bool) = match technique {
            Technique::Convex => ("FLIP", |row| row.measure == "flip" && !CONCAVE.contains(&&*row.view)),
            Technique::Concave => ("FLIP", |row| row.measure == "flip" && CONCAVE.contains(&&*row.view)),
            // Whole pictures by the law of a half space, with shadows, as a default draws them.
            Technique::Cdrf => (WALKS, |row| row.measure == "as drawn"),
            Technique::Translucent | Technique::Diffusion => (WALKS, |row| row.measure == "walks"),
            Technique::OpticalPath => ("nats of error", |row| row.measure == "nats"),
            Technique::Opaque | Technique::ThinWall | Technique::Among => ("", |_| false),
        };
        let judged: Vec<&Row> = rows.iter().filter(|row| name(row)).collect();
        let mut names: Vec<&str> = Vec::new();
        for row in &judged {
            if !names.contains(&&*row.rung) {
                names.push(&row.rung);
            }
        }
        let measured = |rung: &str| -> Vec<(f64, f64)> {
            judged.iter().filter(|row| row.rung == rung).filter_map(|row| row.value.zip(row.ms)).collect()
        };
        let views = names.iter().map(|rung| measured(rung).len()).max().unwrap_or(0);
        let step = |rung: &&str| {
            let measured = measured(rung);
            let (error, ms) = measured.iter().fold((0.0, 0.0), |(error, ms), row| (error + row.0, ms + row.1));
            let worst = measured.iter().map(|row| row.0).reduce(f64::max)?;
            let count = measured.len() as f64;
            (measured.len() == views).then(|| Step {
                rung: (*rung).to_owned(),
                error: error / count,
                worst,
                ms: ms / count,
            })
        };
        Ok(Self { measure, steps: names.iter().filter_map(step).collect() })
    }

    /// Returns the rung with the given name; `None` if the ladder lacks it.
    #[must_use]
    pub fn step(&self, rung: &str) -> Option<&Step> {
        self.steps.iter().find(|step| step.rung == rung)
    }

    /// Returns the Pareto front, the rungs to choose from, by increasing time: no faster rung has a smaller error,
    /// and no rung of about the same time has an error smaller by [`CUT`].
    #[must_use]
    pub fn front(&self) -> Vec<&Step> {
        let beaten = |step: &Step| {
            self.steps.iter().any(|other| {
                let nearer = other.ms <= step.ms && other.error < step.error;
                nearer || !other.is_dearer_than(step) && other.error <= (1.0 - CUT) * step.error
            })
        };
        let mut front: Vec<&Step> = self.steps.iter().filter(|step| !beaten(step)).collect();
        front.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        // If pictures are the same up to rounding, keep the cheapest.
        front.dedup_by(|dear, cheap| ALIKE * dear.error >= cheap.error);
        front
    }

    /// Returns the rung on the front that a default has to beat; `None` for the cheapest.
    #[must_use]
    pub fn next_cheaper(&self, step: &Step) -> Option<&Step> {
        self.front().into_iter().rev().find(|other| step.is_dearer_than(other))
    }

    /// Checks that `rung` may be a default: it is on the Pareto front, cuts the error by [`CUT`] compared
    /// with the next cheaper rung there, and its worst view is no worse than that rung's.
    ///
    /// # Errors
    /// The reason why not, with the rung to use instead.
    pub fn judge(&self, rung: &str) -> Result<(), String> {
        let step = self.step(rung).ok_or_else(|| format!("`{rung}` is not in the ladder, or was not timed"))?;
        let front = self.front();
        let shown =
            |step: &Step| format!("`{}` ({} {}, {:.1} ms)", step.rung, self.measure, figure(step.error), step.ms);
        if !front.iter().any(|other| other.rung == rung) {
            let better = front.iter().rev().find(|other| !other.is_dearer_than(step));
            let better = better.map_or_else(String::new, |better| format!("; take {}", shown(better)));
            return Err(format!("{} is dominated{better}", shown(step)));
        }
        let Some(cheaper) = self.next_cheaper(step) else { return Ok(()) };
        if step.error > (1.0 - CUT) * cheaper.error {
            return Err(format!(
                "{} cuts the error of {} by less than a tenth; take that",
                shown(step),
                shown(cheaper)
            ));
        }
        if step.worst > cheaper.worst {
            return Err(format!("{} is farther off than {} in its worst view; take that", shown(step), shown(cheaper)));
        }
        Ok(())
    }

    /// Checks that this ladder allows the rungs of all the technique's qualities.
    ///
    /// # Errors
    /// The first rung that is not allowed, and what to use instead.
    pub fn judge_qualities(&self, technique: Technique) -> Result<(), String> {
        for quality in Quality::ALL {
            let rung = technique.rung(quality).to_string();
            self.judge(&rung).map_err(|reason| {
                format!("plan/quality.rs: {technique:?} by quality {quality} can no longer be `{rung}`: {reason}")
            })?;
        }
        let errors = Quality::ALL.map(|quality| self.step(&technique.rung(quality).to_string()).map(|step| step.error));
        let falls = errors.windows(2).all(|pair| pair[1] <= pair[0]);
        if falls { Ok(()) } else { Err(format!("{technique:?}: a better quality errs more: {errors:?}")) }
    }
}

impl Technique {
    /// Returns the committed ladder; `None` for a technique with a single rung.
    #[must_use]
    pub fn ladder(self) -> Option<&'static Ladder> {
        Ladder::committed(self)
    }
}

/// A report of `cook cost`, as far as it is read here.
#[derive(Debug, Deserialize)]
pub struct Record {
    rows: Vec<Row>,
}

impl Record {
    /// Returns the committed report that a technique is judged by; `None` for a technique with a single rung.
    #[must_use]
    pub fn committed(technique: Technique) -> Option<Self> {
        serde_json::from_str(REPORTS.get(technique as usize)?.1).ok()
    }

    /// Returns a measurement of a rung in a view, and the milliseconds of its frame; `None` if it was not taken or not
    /// timed.
    #[must_use]
    pub fn timed(&self, rung: &str, view: &str, measure: &str) -> Option<(f64, f64)> {
        let is_it = |row: &&Row| row.rung == rung && row.view == view && row.measure == measure;
        self.rows.iter().find(is_it).and_then(|row| row.value.zip(row.ms))
    }
}

#[derive(Debug, Deserialize)]
struct Row {
    rung: String,
    view: String,
    measure: String,
    value: Option<f64>,
    #[serde(default)]
    ms: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder(steps: &[(&str, f64, f64, f64)]) -> Ladder {
        let step = |&(rung, ms, error, worst): &(&str, f64, f64, f64)| Step { rung: rung.to_owned(), error, worst, ms };
        Ladder { measure: "error", steps: steps.iter().map(step).collect() }
    }

    #[test]
    fn the_hull_is_what_nothing_as_fast_errs_less_than() {
        let ladder = ladder(&[
            ("a", 1.0, 0.9, 0.9),
            ("beaten", 3.0, 0.95, 0.95),
            ("hardly cheaper", 1.95, 0.5, 0.5),
            ("b", 2.0, 0.4, 0.4),
            ("hardly dearer", 2.1, 0.38, 0.4),
            ("twin", 4.0, 0.38, 0.4),
            ("c", 5.0, 0.37, 0.5),
            ("d", 9.0, 0.1, 0.6),
        ]);
        let front: Vec<&str> = ladder.front().iter().map(|step| step.rung.as_str()).collect();
        assert_eq!(front, ["a", "b", "hardly dearer", "c", "d"]);
        let refused = |rung: &str| ladder.judge(rung).expect_err(rung);
        // A rung of the same cost up to noise is not one that a default has to beat.
        assert_eq!(["a", "b", "hardly dearer"].map(|rung| ladder.judge(rung)), [Ok(()), Ok(()), Ok(())]);
        assert!(refused("beaten").contains("dominated; take `hardly dearer`"), "{}", refused("beaten"));
        assert!(refused("twin").contains("dominated; take `hardly dearer`"), "{}", refused("twin"));
        assert!(refused("c").contains("less than a tenth; take that") && refused("c").contains("`hardly dearer`"));
        assert!(refused("d").contains("worst view"), "{}", refused("d"));
        assert!(refused("e").contains("not in the ladder"));
    }

    /// Checks every default against the committed ladders. A failure says which default to change
    /// in `plan/quality.rs`.
    #[test]
    fn every_default_is_what_its_ladder_allows() {
        let mut judged = 0;
        for technique in Technique::ALL {
            let Some(ladder) = technique.ladder() else { continue };
            judged += 1;
            assert!(ladder.steps.len() >= 5, "{technique:?}: {}", ladder.steps.len());
            if let Err(reason) = ladder.judge_qualities(technique) {
                panic!("{reason}");
            }
        }
        assert_eq!(judged, 6);
    }

    /// The rule refuses the former defaults.
    #[test]
    fn the_rule_refuses_a_dominated_default() {
        let gem = Ladder::committed(Technique::Convex).expect("committed");
        for rung in ["proxy-4+tracker", "bvh-8+tracker", "triangles-8+tracker", "convex-8+tracker", "walk-8+paper"] {
            assert!(gem.judge(rung).expect_err(rung).contains("dominated"), "{rung}");
        }
        let cdrf = Ladder::committed(Technique::Cdrf).expect("committed");
        assert!(cdrf.judge("accurate").expect_err("dominated").contains("dominated; take `drift`"));
    }
}
