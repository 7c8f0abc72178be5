//! The frames of a rung, which the ladder's errors belong to: their times, those of the bunny's
//! separate stages, and the memory that they use.

use super::views::{grey, scene, settings};
use super::{COMPARED, CostError, Measured, Options, RungReport, VIEWS, WALKED};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_render::{FrameTimer, Stage};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The view whose stages are timed separately.
const STAGED: &str = "bunny";
/// A frame that takes longer than this gets fewer rounds of timing.
pub(super) const SLOW: Duration = Duration::from_secs(2);
/// Rounds of timing for a slow frame.
pub(super) const SLOW_ROUNDS: u32 = 2;

/// The times of a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathTiming {
    /// Minimum over the rounds in milliseconds.
    pub ms: f64,
    /// Median over the rounds in milliseconds.
    pub median_ms: f64,
    /// Number of rounds.
    pub rounds: u32,
    /// Minimum time of each of [`Stage::ALL`], submitted and waited for separately, in
    /// milliseconds; `None` if there are no stages or they were not timed.
    pub stages: Option<[f64; Stage::ALL.len()]>,
}

/// Final state of a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Solved {
    /// Number of passes that had work to do.
    pub passes: u32,
    /// Number of tile updates in these passes, or of voxel updates for untiled solvers.
    pub updates: u32,
    /// Number of updates that another pass would make: 0 if the costs are final.
    pub active: u32,
}

/// A frame and its times so far.
struct Timed<'gpu> {
    /// Index of the rung.
    rung: usize,
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

    fn timing(&self) -> Option<PathTiming> {
        let milliseconds = |time: Duration| 1e3 * time.as_secs_f64();
        let mut totals = self.totals.clone();
        totals.sort_unstable();
        let least = |stage: usize| milliseconds(self.stages.iter().map(|times| times[stage]).min().unwrap_or_default());
        Some(PathTiming {
            ms: milliseconds(*totals.first()?),
            median_ms: milliseconds(totals[totals.len() / 2]),
            rounds: totals.len() as u32,
            stages: (!self.stages.is_empty()).then(|| std::array::from_fn(least)),
        })
    }
}

/// Draws and times every rung's frames: all rungs of a view interleaved, in one colour or in its
/// own. `measured` and `rungs` correspond by index.
pub(super) fn measure(
    gpu: &Gpu,
    options: &Options,
    measured: &[Measured],
    rungs: &mut [RungReport],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let drawn: Vec<(usize, Measured)> =
        measured.iter().copied().enumerate().filter(|(_, of)| of.rung != Rung::Reference).collect();
    let kinds = COMPARED.map(|view| (view, true)).into_iter().chain(WALKED.map(|view| (view, false)));
    let total = (COMPARED.len() + WALKED.len()) as u64 * drawn.len() as u64 * (u64::from(options.rounds) + 1);
    let mut done = 0;
    for (view, is_grey) in kinds {
        let scene = scene(view)?;
        let scene = if is_grey { grey(scene) } else { scene };
        let staged = is_grey && view == STAGED;
        let mut timed = Vec::new();
        for &(rung, of) in &drawn {
            let frame = FrameTimer::new(gpu, &scene, &settings(view, of, options.frame), None, false)?;
            // The first frame includes compilation.
            frame.run()?;
            if staged {
                rungs[rung].bytes = frame.path_bytes();
                rungs[rung].solved = frame.solved()?.first().map(|status| Solved {
                    passes: status.passes,
                    updates: status.updates,
                    active: status.active,
                });
            }
            timed.push(Timed { rung, frame, staged, totals: Vec::new(), stages: Vec::new() });
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
        let Some(place) = VIEWS.iter().position(|name| *name == view) else { continue };
        for timed in &timed {
            let times = &mut rungs[timed.rung].times[place];
            *(if is_grey { &mut times.grey } else { &mut times.rgb }) = timed.timing();
        }
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
