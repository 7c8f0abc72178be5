//! Translucent bodies in motion: what a frame takes if it is computed from nothing, and if it keeps what the
//! motion does not change and begins with the fluence of the frame before.

use lapidary_gpu::Gpu;
use lapidary_ladders::table::{Goal, Table, figure, scientific};
use lapidary_ladders::{CostError, Ladder, Options, Progress, Report, Row};
use lapidary_plan::Rung;
use lapidary_render::{DiffusionOptions, FrameTimer, RenderError, Settings, Stage};
use lapidary_snapshots::motion::Motion;
use std::time::Duration;

/// The ladder.
pub const LADDER: Ladder = Ladder { name: "dynamic", tables, plots: |_| Vec::new(), whole };

/// The rungs.
pub const RUNGS: [&str; 2] = ["godunov-64", DIFFUSION];
const DIFFUSION: &str = "diffusion-64";
/// What is left of diffusion's equations in every channel and frame, as a share of the right side.
pub const RESIDUAL: f64 = 1e-3;
/// More cycles than that are not tried.
const MOST_CYCLES: u32 = 6;
/// Frames in a row that are timed, and the time from one to the next: 30 frames a second take a light or a camera
/// round in six.
const FRAMES: u32 = 8;
const STEP: f64 = 1.0 / 80.0;
/// The time of the first.
const START: f64 = 0.42;

/// How a frame begins.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// From nothing.
    Cold,
    /// With what the motion leaves as it was, and with the fluence of the frame before.
    Warm,
}

impl Start {
    const ALL: [Self; 2] = [Self::Cold, Self::Warm];

    fn name(self) -> &'static str {
        match self {
            Self::Cold => "cold",
            Self::Warm => "warm",
        }
    }
}

/// The name in reports of a rung whose frames begin in one way.
fn named(rung: impl std::fmt::Display, start: Start) -> String {
    format!("{rung}, {}", start.name())
}

/// Returns what to measure by default.
pub fn options() -> Options {
    Options { rounds: 5, frame: [128, 128], rungs: RUNGS.iter().filter_map(|name| name.parse().ok()).collect() }
}

/// A row of frames that begin in one way.
struct Sequence<'gpu> {
    motion: Motion,
    start: Start,
    cycles: u32,
    frames: Vec<FrameTimer<'gpu>>,
    /// The least time of each frame.
    times: Vec<Duration>,
    residual: f64,
}

impl<'gpu> Sequence<'gpu> {
    fn new(
        gpu: &'gpu Gpu,
        (motion, rung): (Motion, Rung),
        (start, cycles, residual): (Start, u32, bool),
        options: &Options,
    ) -> Result<Self, CostError> {
        let [width, height] = options.frame;
        let warm = start == Start::Warm;
        let diffusion = DiffusionOptions { cycles, most_cycles: cycles, warm, residual };
        let settings = Settings { rung, samples: 1, diffusion, ..Settings::of_size(width, height) };
        // The first frame only gives the others something to begin with.
        let mut frames: Vec<FrameTimer<'_>> = Vec::new();
        for number in 0..=FRAMES {
            let scene = motion.scene(START + STEP * f64::from(number))?;
            let frame = FrameTimer::new(gpu, &scene, &settings, None, false)?;
            // What the motion does not change must be there, and shaders be compiled.
            match frames.last() {
                Some(before) => frame.continue_from(before)?,
                None => (1..MOST_CYCLES).try_for_each(|_| frame.run().map(drop))?,
            }
            frame.run()?;
            frames.push(frame);
        }
        let times = vec![Duration::MAX; FRAMES as usize];
        Ok(Self { motion, start, cycles, frames, times, residual: 0.0 })
    }

    /// Draws all frames in turn.
    fn round(&mut self) -> Result<(), RenderError> {
        for (pair, least) in self.frames.windows(2).zip(&mut self.times) {
            let [before, frame] = pair else { continue };
            let time = match self.start {
                Start::Cold => frame.run()?,
                Start::Warm => {
                    frame.continue_from(before)?;
                    match frame.run_from(self.motion.changes())? {
                        Some(time) => time,
                        None => frame.run()?,
                    }
                }
            };
            *least = (*least).min(time.total);
            self.residual = frame.residuals()?.into_iter().flatten().fold(self.residual, f64::max);
        }
        Ok(())
    }

    /// Cycles of each timed frame.
    fn cycles_run(&self) -> u32 {
        if self.start == Start::Warm && self.motion.changes() == Stage::Shade { 0 } else { self.cycles }
    }

    /// The mean over the frames of their least times, in milliseconds.
    fn ms(&self) -> f64 {
        self.times.iter().map(|time| 1e3 * time.as_secs_f64()).sum::<f64>() / f64::from(FRAMES)
    }
}

/// Returns the sequence with the fewest cycles that leave less than [`RESIDUAL`], or with the most, and what they leave.
fn solved<'gpu>(
    gpu: &'gpu Gpu,
    drawn: (Motion, Rung),
    start: Start,
    options: &Options,
) -> Result<Sequence<'gpu>, CostError> {
    let mut cycles = 1;
    loop {
        let mut sequence = Sequence::new(gpu, drawn, (start, cycles, true), options)?;
        sequence.round()?;
        if sequence.residual <= RESIDUAL || cycles == MOST_CYCLES {
            // Frames that are timed measure nothing.
            let timed = Sequence::new(gpu, drawn, (start, cycles, false), options)?;
            return Ok(Sequence { residual: sequence.residual, ..timed });
        }
        cycles += 1;
    }
}

/// Measures the frames of each motion.
///
/// # Errors
/// Returns an error if a scene does not load or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings_of = [("width", width), ("height", height), ("rounds", options.rounds), ("frames", FRAMES)];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings_of.map(|(name, value)| (name, value.into())));
    for (done, motion) in (0..).zip(Motion::ALL) {
        progress("drawing motions", done, Motion::ALL.len() as u64);
        let mut sequences = Vec::new();
        for rung in &options.rungs {
            for start in Start::ALL {
                sequences.push((rung, solved(gpu, (motion, *rung), start, options)?));
            }
        }
        for _ in 0..options.rounds {
            for (_, sequence) in &mut sequences {
                sequence.round()?;
            }
        }
        for (rung, sequence) in &sequences {
            let name = named(rung, sequence.start);
            let diffuses = matches!(rung, Rung::Diffusion(_));
            let ms = (options.rounds > 0).then(|| sequence.ms());
            let row =
                |measure: &str, value: f64| Row::new(&name, motion.name(), measure, diffuses.then_some(value), "");
            report.rows.push(row("residual", sequence.residual).timed(ms));
            report.rows.push(row("cycles", sequence.cycles_run().into()));
        }
    }
    Ok(report)
}

fn tables(report: &Report) -> Vec<Table> {
    vec![table(report), goals(report)]
}

fn whole(report: &Report) -> Result<(), String> {
    let lacks = |rung: &str, motion: Motion| report.ms(rung, motion.name(), "residual").is_none();
    for rung in RUNGS {
        for start in Start::ALL {
            let name = named(rung, start);
            if let Some(motion) = Motion::ALL.into_iter().find(|motion| lacks(&name, *motion)) {
                return Err(format!("the report has no time of `{name}` for the {}", motion.name()));
            }
        }
    }
    Ok(())
}

fn table(report: &Report) -> Table {
    let mut lines =
        Table::of("dynamic", "A frame in motion", report.rungs("residual")).column("frame", |rung| (*rung).to_owned());
    for motion in Motion::ALL.map(Motion::name) {
        lines = lines.column(motion, |rung| {
            let ms = figure(report.ms(rung, motion, "residual"), 1);
            match (report.value(rung, motion, "cycles"), report.value(rung, motion, "residual")) {
                (Some(cycles), residual) => format!("{ms} ({cycles}, {})", scientific(residual)),
                _ => ms,
            }
        });
    }
    lines.note(format!(
        "Milliseconds a frame of {} pixels of one sample in three channels: the mean of {} frames in a row, of each the \
         least of the rounds. In parentheses the fewest cycles of multigrid, up to {MOST_CYCLES}, that leave at most {RESIDUAL} of the \
         equations in every frame, and what they leave. Cold: all is computed anew. Warm: a frame keeps what the motion \
         leaves as it is (voxels, if the light moves; all but shading, if the camera does) and begins with the fluence \
         of the one before. Times: {}.",
        report.size(),
        report.setting("frames"),
        report.run()
    ))
}

fn goals(report: &Report) -> Table {
    let ms = |start: Start| report.ms(&named(DIFFUSION, start), Motion::Light.name(), "residual");
    let mut goals = Vec::new();
    if let [Some(cold), Some(warm)] = Start::ALL.map(ms) {
        let goal =
            format!("the light's orbit, `{DIFFUSION}` at a residual of {RESIDUAL}: a warm frame takes at most half");
        goals.push(Goal::new(goal, format!("{:.2}: {warm:.1} of {cold:.1} ms", warm / cold), warm <= 0.5 * cold));
    }
    Goal::table("dynamic_goals", goals)
}
