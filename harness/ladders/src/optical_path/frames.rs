//! The frames of a rung, which the ladder's errors belong to: their times, those of the bunny's
//! separate stages, and the memory that they use.

use super::measured::Measured;
use super::rungs::{GREY, MEASURES, RGB, STAGED};
use super::views::{COMPARED, VIEWS, WALKED, grey, scene, settings};
use crate::error::CostError;
use crate::options::Options;
use crate::report::{Report, Row};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_render::{FrameTimer, Stage};
use std::time::Duration;

/// A frame that takes longer than this gets fewer rounds of timing.
pub(super) const SLOW: Duration = Duration::from_secs(2);
/// Rounds of timing for a slow frame.
pub(super) const SLOW_ROUNDS: u32 = 2;

/// A frame and its times so far.
struct Timed<'gpu> {
    frame: FrameTimer<'gpu>,
    /// Whether the stages are also timed separately.
    staged: bool,
    totals: Vec<Duration>,
    stages: Vec<[Duration; Stage::ALL.len()]>,
}

impl Timed<'_> {
    /// Whether the frame is slow and needs no further rounds.
    fn done(&self) -> bool {
        self.totals.len() >= SLOW_ROUNDS as usize && self.totals.iter().min().is_some_and(|least| *least > SLOW)
    }

    fn round(&mut self) -> Result<(), CostError> {
        self.totals.push(self.frame.run()?.total);
        if self.staged {
            self.stages.extend(self.frame.run_stages()?);
        }
        Ok(())
    }

    /// Returns the minimum and the median time in milliseconds.
    fn ms(&self) -> Option<[f64; 2]> {
        let mut totals = self.totals.clone();
        totals.sort_unstable();
        let middle = totals.get(totals.len() / 2)?;
        Some([totals.first()?, middle].map(|time| milliseconds(*time)))
    }

    /// Returns the rows of the frame: its median, the number of rounds if there were fewer than of
    /// other frames, and for a frame timed in stages the least of each and the solver's final state.
    fn rows(&self, name: &str, view: &str, measure: &str, rounds: u32) -> Result<Vec<Row>, CostError> {
        let row = |measure: &str, value: f64, unit: &str| Row::new(name, view, measure, value, unit);
        let bytes = self.staged.then(|| self.frame.path_bytes());
        let (least, median) = self.ms().map(|[least, median]| (least, median)).unzip();
        let time = Row { value: median, ..row(measure, 0.0, "ms") };
        let mut rows = vec![Row { bytes, ..time.timed(least) }];
        if (1..rounds as usize).contains(&self.totals.len()) {
            rows.push(row(&format!("rounds of {measure}"), self.totals.len() as f64, ""));
        }
        if self.staged {
            for (place, stage) in Stage::ALL.into_iter().enumerate() {
                let least = self.stages.iter().map(|times| times[place]).min();
                rows.extend(least.map(|least| row(stage.name(), milliseconds(least), "ms")));
            }
            if let Some(status) = self.frame.solved()?.first() {
                let state = [("passes", status.passes), ("updates", status.updates), ("active", status.active)];
                rows.extend(state.map(|(measure, count)| row(measure, count.into(), "")));
            }
        }
        Ok(rows)
    }
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Draws and times every rung's frames: all rungs of a view interleaved, in white or in its own
/// colours. `errors` has the errors by [`MEASURES`], view by view in the order of `measured`.
///
/// Bytes are those of maps, voxels, costs and solver.
pub(super) fn measure(
    gpu: &Gpu,
    options: &Options,
    measured: &[Measured],
    errors: &[[Option<f64>; MEASURES.len()]],
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let drawn: Vec<Measured> = measured.iter().copied().filter(|variant| variant.rung != Rung::Reference).collect();
    let total = (COMPARED.len() + WALKED.len()) as u64 * drawn.len() as u64 * (u64::from(options.rounds) + 1);
    let mut done = 0;
    for (view, errors) in VIEWS.into_iter().zip(errors.chunks_exact(measured.len().max(1))) {
        let mut rows = Vec::new();
        for (kind, views) in [(GREY, &COMPARED[..]), (RGB, &WALKED)] {
            if !views.contains(&view) {
                continue;
            }
            let scene = scene(view)?;
            let scene = if kind == GREY { grey(scene) } else { scene };
            let mut timed = Vec::new();
            for &variant in &drawn {
                let frame = FrameTimer::new(gpu, &scene, &settings(view, variant, options.frame), None, false)?;
                // The first frame includes compilation.
                frame.run()?;
                let staged = kind == GREY && view == STAGED;
                timed.push(Timed { frame, staged, totals: Vec::new(), stages: Vec::new() });
                done += 1;
                progress(done, total);
            }
            for _ in 0..options.rounds {
                for timed in &mut timed {
                    if !timed.done() {
                        timed.round()?;
                    }
                    done += 1;
                    progress(done, total);
                }
            }
            for (variant, timed) in drawn.iter().zip(&timed) {
                rows.extend(timed.rows(&variant.name(), view, kind, options.rounds)?);
            }
        }
        for (variant, errors) in measured.iter().zip(errors) {
            let name = variant.name();
            for (measure, error) in MEASURES.into_iter().zip(*errors) {
                let kind = if measure == "walks" { RGB } else { GREY };
                let ms = rows.iter().find(|row| row.rung == name && row.measure == kind).and_then(|row| row.ms);
                let unit = if measure == "nats" { "nats" } else { "" };
                report.rows.push(Row::new(&name, view, measure, error, unit).timed(ms));
            }
        }
        report.rows.append(&mut rows);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_gpu::AdapterChoice;
    use lapidary_plan::{Decisions, Effect};
    use lapidary_scene::Scene;

    fn of(rung: &str) -> Measured {
        Measured { rung: rung.parse().expect(rung), unscaled: false }
    }

    /// The goal of ten frames per second is for pictures in the colours of a plan: three solves.
    #[test]
    fn views_in_their_own_colours_have_a_solve_for_each() {
        for view in WALKED {
            let scene = scene(view).expect("built in");
            let settings = settings(view, of("godunov-64"), [64; 2]);
            for (scene, colored) in [(scene.clone(), true), (grey(scene), false)] {
                let decisions = Decisions::of(&scene.objects[0], &scene, &settings.request());
                assert!(decisions.has(Effect::Color) == colored && decisions.has(Effect::OpticalPath), "{view}");
            }
        }
    }

    #[test]
    fn memory_is_what_is_allocated() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let bunny = Scene::named(STAGED).expect("built in");
        let grey = grey(bunny.clone());
        let bytes = |scene: &Scene, rung: &str| {
            FrameTimer::new(gpu, scene, &settings(STAGED, of(rung), [64; 2]), None, false).expect(rung).path_bytes()
        };
        assert_eq!(bytes(&grey, "lambert"), 0);
        let one = bytes(&grey, "godunov-32");
        // Green and blue each need another float per voxel.
        assert_eq!(bytes(&bunny, "godunov-32") - one, 2 * 4 * 32 * 32 * 32);
        // Besides the maps and the costs, ping-pong has a second buffer, and each tile has five
        // words.
        assert_eq!(bytes(&grey, "ping-pong-26-32") - one, 4 * 32 * 32 * 32 - 20 * 8 * 8 * 8);
        assert!(one > 128 * 128 * 20 + 4 * 32 * 32 * 32, "{one}");
    }

    /// Timing the stages separately runs the same passes: the solver ends in the same state.
    #[test]
    fn stages_are_the_frame() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let scene = Scene::named(STAGED).expect("built in");
        let frame =
            |rung: &str| FrameTimer::new(gpu, &scene, &settings(STAGED, of(rung), [64; 2]), None, false).expect(rung);
        let paths = frame("tiled-26-16");
        paths.run().expect("drawn");
        let whole = paths.solved().expect("a device");
        assert!(whole.len() == 1 && whole[0].active == 0 && whole[0].passes > 1, "{whole:?}");
        assert!(paths.run_stages().expect("drawn").is_some());
        let staged = paths.solved().expect("a device");
        assert_eq!((staged[0].active, staged[0].least), (0, whole[0].least));
        let lambert = frame("lambert");
        assert!(lambert.run_stages().expect("nothing to do").is_none() && lambert.solved().expect("none").is_empty());
    }
}
