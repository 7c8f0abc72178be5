//! The frames that a rung draws of the bunny: timed as wholes and stage by stage, and the memory that they take.

use super::views::{grey, settings};
use super::{CostError, Options, RungReport};
use crate::gpu::Gpu;
use crate::render::{Frame, Rung, Settings, Stage};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The scene that is timed.
const SCENE: &str = "bunny";
/// A frame that takes longer is timed in fewer rounds, ...
pub(super) const SLOW: Duration = Duration::from_secs(2);
/// ... in so many.
pub(super) const SLOW_ROUNDS: u32 = 2;

/// A frame's time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathTiming {
    /// The least of the rounds, in milliseconds.
    pub ms: f64,
    /// The median of the rounds.
    pub median_ms: f64,
    /// How many rounds.
    pub rounds: u32,
    /// Of each of [`Stage::ALL`] submitted and waited for by itself, the least of the rounds; none where there are no stages or they were not
    /// timed.
    pub stages: Option<[f64; Stage::ALL.len()]>,
}

/// How far a solver came.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Solved {
    /// Passes in which anything was left to do.
    pub passes: u32,
    /// Tiles, or for untiled solvers voxels, that these took up.
    pub updates: u32,
    /// What another pass would take up: 0 where the costs are final.
    pub active: u32,
}

/// One frame and its times so far.
struct Timed<'gpu> {
    /// Its rung's number.
    rung: usize,
    frame: Frame<'gpu>,
    grey: bool,
    totals: Vec<Duration>,
    stages: Vec<[Duration; Stage::ALL.len()]>,
}

impl Timed<'_> {
    /// Whether the rounds that it has are all that it gets.
    fn done(&self) -> bool {
        self.totals.len() >= SLOW_ROUNDS as usize && self.totals.iter().min().is_some_and(|least| *least > SLOW)
    }

    fn round(&mut self) -> Result<(), CostError> {
        self.totals.push(self.frame.run()?.total);
        // Once is enough to know where the time goes.
        if self.grey {
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

/// Draws every rung's frames, and times them, interleaved. `rungs` are those of the options, in their order.
pub(super) fn measure(
    gpu: &Gpu,
    options: &Options,
    rungs: &mut [RungReport],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let colored = Scene::named(SCENE)?;
    let scenes = [(grey(colored.clone()), true), (colored, false)];
    let [width, height] = options.frame;
    let drawn: Vec<(usize, Rung)> =
        options.rungs.iter().copied().enumerate().filter(|(_, rung)| *rung != Rung::Reference).collect();
    let total = (scenes.len() * drawn.len()) as u64 * (u64::from(options.rounds) + 1);
    let (mut timed, mut done) = (Vec::new(), 0);
    for &(rung, of) in &drawn {
        for (scene, grey) in &scenes {
            let frame = Frame::new(gpu, scene, &Settings { width, height, ..settings(of, width) })?;
            // The first frame compiles.
            frame.run()?;
            if *grey {
                rungs[rung].bytes = frame.path_bytes();
                rungs[rung].solved = frame.solved()?.first().map(|status| Solved {
                    passes: status.passes,
                    updates: status.updates,
                    active: status.active,
                });
            }
            timed.push(Timed { rung, frame, grey: *grey, totals: Vec::new(), stages: Vec::new() });
            done += 1;
            progress(done, total);
        }
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
    for timed in &timed {
        let report = &mut rungs[timed.rung];
        *(if timed.grey { &mut report.grey } else { &mut report.rgb }) = timed.timing();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::AdapterChoice;

    #[test]
    fn memory_is_what_is_allocated() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let bunny = Scene::named(SCENE).expect("built in");
        let grey = grey(bunny.clone());
        let bytes = |scene: &Scene, rung: &str| {
            Frame::new(gpu, scene, &settings(rung.parse().expect(rung), 64)).expect(rung).path_bytes()
        };
        assert_eq!(bytes(&grey, "lambert"), 0);
        let one = bytes(&grey, "godunov-32");
        // Red, green and blue cost a float for each voxel more, twice.
        assert_eq!(bytes(&bunny, "godunov-32") - one, 2 * 4 * 32 * 32 * 32);
        // Beside the maps and the costs, ping-pong has a second buffer, tiles have five words each.
        assert_eq!(bytes(&grey, "ping-pong-26-32") - one, 4 * 32 * 32 * 32 - 20 * 8 * 8 * 8);
        assert!(one > 128 * 128 * 20 + 4 * 32 * 32 * 32, "{one}");
    }

    /// A frame drawn stage by stage is drawn by the same passes: the solver comes as far.
    #[test]
    fn stages_are_the_frame() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let scene = Scene::named(SCENE).expect("built in");
        let frame = |rung: &str| Frame::new(gpu, &scene, &settings(rung.parse().expect(rung), 64)).expect(rung);
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
