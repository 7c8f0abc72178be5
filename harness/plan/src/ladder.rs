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

const GEM: &str = include_str!("../../../docs/measurements/lavapipe/gem.json");
const CDRF: &str = include_str!("../../../docs/measurements/lavapipe/cdrf.json");
const OPTICAL_PATH: &str = include_str!("../../../docs/measurements/lavapipe/optical_path.json");

static COMMITTED: LazyLock<[Option<Ladder>; 4]> = LazyLock::new(|| {
    [
        (Technique::Convex, GEM),
        (Technique::Concave, GEM),
        (Technique::Cdrf, CDRF),
        (Technique::OpticalPath, OPTICAL_PATH),
    ]
    .map(|(technique, record)| Ladder::of_record(technique, record).ok())
});

impl Ladder {
    /// Returns the committed ladder of a technique; `None` for a technique with a single rung.
    #[must_use]
    pub fn committed(technique: Technique) -> Option<&'static Self> {
        COMMITTED.get(technique as usize)?.as_ref()
    }

    /// Reads the ladder of a technique from a record of `cook cost`.
    ///
    /// # Errors
    /// Returns an error if the record is not one of this technique.
    pub fn of_record(technique: Technique, record: &str) -> Result<Self, serde_json::Error> {
        let (measure, steps) = match technique {
            Technique::Convex | Technique::Concave => {
                let record: Record<GemRung> = serde_json::from_str(record)?;
                let concave = technique == Technique::Concave;
                ("FLIP", record.rungs.iter().filter_map(|rung| rung.step(concave)).collect())
            }
            Technique::Cdrf => {
                let record: Record<CdrfRung> = serde_json::from_str(record)?;
                ("largest error of the function", record.rungs.iter().filter_map(CdrfRung::step).collect())
            }
            Technique::OpticalPath => {
                let record: Record<PathRung> = serde_json::from_str(record)?;
                let views = record.rungs.iter().map(|rung| rung.nats().count()).max().unwrap_or(0);
                ("nats of error", record.rungs.iter().filter_map(|rung| rung.step(views)).collect())
            }
            Technique::Opaque | Technique::ThinWall => ("", Vec::new()),
        };
        Ok(Self { measure, steps })
    }

    /// Returns the rung with the given name; `None` if the ladder lacks it.
    #[must_use]
    pub fn step(&self, rung: &str) -> Option<&Step> {
        self.steps.iter().find(|step| step.rung == rung)
    }

    /// Returns the rungs to choose from, by increasing time: no faster rung has a smaller error,
    /// and no rung of about the same time has an error smaller by [`CUT`].
    #[must_use]
    pub fn hull(&self) -> Vec<&Step> {
        let beaten = |step: &Step| {
            self.steps.iter().any(|other| {
                let nearer = other.ms <= step.ms && other.error < step.error;
                nearer || !other.is_dearer_than(step) && other.error <= (1.0 - CUT) * step.error
            })
        };
        let mut hull: Vec<&Step> = self.steps.iter().filter(|step| !beaten(step)).collect();
        hull.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        // If pictures are the same up to rounding, keep the cheapest.
        hull.dedup_by(|dear, cheap| ALIKE * dear.error >= cheap.error);
        hull
    }

    /// Returns the rung on the hull that a default has to beat; `None` for the cheapest.
    #[must_use]
    pub fn next_cheaper(&self, step: &Step) -> Option<&Step> {
        self.hull().into_iter().rev().find(|other| step.is_dearer_than(other))
    }

    /// Checks that `rung` may be a default: it is on the hull, cuts the error by [`CUT`] compared
    /// with the next cheaper rung there, and its worst view is no worse than that rung's.
    ///
    /// # Errors
    /// The reason why not, with the rung to use instead.
    pub fn judge(&self, rung: &str) -> Result<(), String> {
        let step = self.step(rung).ok_or_else(|| format!("`{rung}` is not in the ladder, or was not timed"))?;
        let hull = self.hull();
        let shown =
            |step: &Step| format!("`{}` ({} {}, {:.1} ms)", step.rung, self.measure, figure(step.error), step.ms);
        if !hull.iter().any(|other| other.rung == rung) {
            let better = hull.iter().rev().find(|other| !other.is_dearer_than(step));
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

/// Returns a step from a rung's errors, one per view; `None` without errors or a time.
fn step(rung: &str, errors: impl Iterator<Item = f64> + Clone, ms: Option<f64>) -> Option<Step> {
    let count = errors.clone().count();
    let worst = errors.clone().reduce(f64::max)?;
    Some(Step { rung: rung.to_owned(), error: errors.sum::<f64>() / count as f64, worst, ms: ms? })
}

#[derive(Deserialize)]
struct Record<R> {
    rungs: Vec<R>,
}

#[derive(Deserialize)]
struct GemRung {
    rung: String,
    views: Vec<Option<GemView>>,
    concave: Vec<Option<GemView>>,
}

#[derive(Deserialize)]
struct GemView {
    errors: GemErrors,
    ms: Option<f64>,
}

#[derive(Deserialize)]
struct GemErrors {
    flip: f64,
}

impl GemRung {
    /// Returns the mean error and the mean time over the same views.
    fn step(&self, concave: bool) -> Option<Step> {
        let views: Vec<&GemView> = if concave { &self.concave } else { &self.views }.iter().flatten().collect();
        let times = views.iter().map(|view| view.ms).sum::<Option<f64>>();
        step(&self.rung, views.iter().map(|view| view.errors.flip), times.map(|sum| sum / views.len() as f64))
    }
}

#[derive(Deserialize)]
struct CdrfRung {
    rung: String,
    distance: Option<CdrfDistance>,
    frames: Vec<CdrfFrame>,
}

#[derive(Deserialize)]
struct CdrfDistance {
    largest: f64,
}

#[derive(Deserialize)]
struct CdrfFrame {
    part: String,
    curvature: Option<String>,
    timing: Option<CdrfTiming>,
}

#[derive(Deserialize)]
struct CdrfTiming {
    ms: f64,
}

impl CdrfRung {
    /// Returns the step of the lit part, with curvature from the screen. `None` for the spherical
    /// form: it is a different function, and its error relative to its own definition is not
    /// comparable.
    fn step(&self) -> Option<Step> {
        if self.rung == "spherical" {
            return None;
        }
        let is_lit =
            |frame: &&CdrfFrame| frame.part == "lit" && frame.curvature.as_ref().is_none_or(|of| of == "screen");
        let timing = self.frames.iter().find(is_lit)?.timing.as_ref();
        step(&self.rung, self.distance.iter().map(|distance| distance.largest), timing.map(|timing| timing.ms))
    }
}

#[derive(Deserialize)]
struct PathRung {
    rung: String,
    distances: Vec<PathDistance>,
    times: Vec<PathTimes>,
}

#[derive(Deserialize)]
struct PathTimes {
    grey: Option<CdrfTiming>,
}

#[derive(Deserialize)]
struct PathDistance {
    nats: Option<f64>,
}

impl PathRung {
    fn nats(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.distances.iter().filter_map(|distance| distance.nats)
    }

    /// Returns the mean error and mean time of the views that have an error. `None` if a view lacks
    /// one: this excludes the finest grid, which is the others' reference, and the walks.
    fn step(&self, views: usize) -> Option<Step> {
        let compared = self.distances.iter().zip(&self.times).filter(|(distance, _)| distance.nats.is_some());
        let times: Option<Vec<f64>> = compared.map(|(_, times)| times.grey.as_ref().map(|timing| timing.ms)).collect();
        let times = times.filter(|times| times.len() == views)?;
        step(&self.rung, self.nats(), Some(times.iter().sum::<f64>() / views as f64))
    }
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
        let hull: Vec<&str> = ladder.hull().iter().map(|step| step.rung.as_str()).collect();
        assert_eq!(hull, ["a", "b", "hardly dearer", "c", "d"]);
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
        assert_eq!(judged, 4);
    }

    /// The rule refuses the former defaults.
    #[test]
    fn the_rule_refuses_a_dominated_default() {
        let gem = Ladder::committed(Technique::Convex).expect("committed");
        for rung in ["proxy-4+tracker", "bvh-8+tracker", "triangles-8+tracker", "convex-8+paper"] {
            assert!(gem.judge(rung).expect_err(rung).contains("dominated"), "{rung}");
        }
        let cdrf = Ladder::committed(Technique::Cdrf).expect("committed");
        assert!(cdrf.judge("quadrature").is_err());
    }
}
