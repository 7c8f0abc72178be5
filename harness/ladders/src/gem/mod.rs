//! The gem ladder: each rung's picture of several stones against the spectral reference, and its
//! time.

mod choices;
mod dispersion;
mod error;
mod growth;
mod profile;
pub mod proxy_sizes;
mod reflection;
mod seen;
mod tables;
pub mod views;

pub use error::Errors;
pub use profile::profile;
pub use seen::change;

use super::timing::{self, Timed};
use super::{CostError, Ladder, Progress, Report, Row};
use dispersion::Colours;
use lapidary_gpu::Gpu;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::shader::Shader;
use lapidary_render::{GemOptions, Settings};
use lapidary_scene::Scene;
use seen::{SAMPLES, Watched};
use views::View;

/// The ladder.
pub const LADDER: Ladder = Ladder { name: "gem", tables: tables::tables, plots: tables::plots, whole: tables::whole };

/// The measures of a rung in a view: FLIP, RMSE, energy and the change to the next frame.
pub const MEASURES: [&str; 4] = ["flip", "rmse", "energy", "change"];
/// The frame that the paper times: the brilliant fills it.
pub const FILLED: &str = "filled";

/// The ladder from cheap to exact; the number of hits doubles from rung to rung.
///
/// A rung with the paper's dispersion is also measured at its best-fit strength. The planes, the
/// hierarchy and the loop over triangles give the same pictures as the walk, so a few rungs are
/// enough to show their cost; those of the hierarchy include colours, which make it a twentieth
/// slower.
pub const RUNGS: [&str; 51] = [
    "surface",
    "proxy-0",
    "proxy-1",
    "proxy-1+paper",
    "proxy-1+tracker",
    "proxy-1+3",
    "proxy-1+31",
    "proxy-2",
    "proxy-2+paper",
    "proxy-2+tracker",
    "proxy-2+3",
    "proxy-4",
    "proxy-4+paper",
    "proxy-4+tracker",
    "proxy-4+3",
    "proxy-8",
    "proxy-8+paper",
    "proxy-8+tracker",
    "proxy-8+3",
    "proxy-8+31",
    "walk-1",
    "walk-2",
    "walk-2+paper",
    "walk-2+tracker",
    "walk-2+3",
    "walk-4",
    "walk-4+paper",
    "walk-4+tracker",
    "walk-4+split",
    "walk-4+3",
    "walk-4+31",
    "walk-8",
    "walk-8+paper",
    "walk-8+tracker",
    "walk-8+split",
    "walk-8+3",
    "walk-8+31",
    "walk-16+tracker",
    "convex-1",
    "convex-4",
    "convex-8",
    "convex-8+tracker",
    "convex-16+tracker",
    "bvh-1",
    "bvh-2+tracker",
    "bvh-4+tracker",
    "bvh-8+tracker",
    "bvh-8+3",
    "bvh-16+tracker",
    "triangles-1",
    "triangles-8+tracker",
];

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// The views to compare all rungs in.
    pub views: Vec<View>,
    /// Additional views for rungs that draw bodies of any shape.
    pub concave: Vec<View>,
    /// Whether the proxy is also measured at small sizes, and stones of more and more facets are
    /// timed, which takes some minutes.
    pub sizes: bool,
    /// The rungs to measure.
    pub rungs: Vec<Rung>,
}

impl Default for Options {
    fn default() -> Self {
        let rungs = RUNGS.iter().filter_map(|name| name.parse().ok()).collect();
        Self {
            rounds: 7,
            frame: [1920, 1080],
            views: views::VIEWS.to_vec(),
            concave: views::CONCAVE.to_vec(),
            sizes: true,
            rungs,
        }
    }
}

/// A rung with its name in the report, its settings, and the strength of the paper's dispersion in
/// each view (1 if not given).
struct Entry {
    name: String,
    settings: Settings,
    strengths: Vec<f32>,
}

impl Entry {
    /// Returns the settings for the ladder's view with that index; `None` is any other view.
    fn settings_in(&self, view: Option<usize>) -> Settings {
        let dispersion_strength = view.and_then(|view| self.strengths.get(view)).copied().unwrap_or(1.0);
        Settings { gem: GemOptions { dispersion_strength, ..self.settings.gem }, ..self.settings.clone() }
    }

    /// Whether the rung draws bodies of any shape, in few enough steps for lavapipe.
    fn draws_concave(&self) -> bool {
        let drawn = !matches!(self.settings.rung.geometry(), Geometry::Convex | Geometry::Walk | Geometry::Triangles);
        drawn && !self.name.ends_with(FITTED)
    }
}

/// Suffix of a rung whose strength of the paper's dispersion is the best fit in each view.
const FITTED: &str = "-fitted";

fn entries(options: &Options, colours: &[Vec<Colours>]) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut fitted = papers(options).zip(colours);
    for &rung in &options.rungs {
        let settings = Settings { rung, samples: SAMPLES, ..Settings::of_size(views::SIDE, views::SIDE) };
        entries.push(Entry { name: rung.to_string(), settings: settings.clone(), strengths: Vec::new() });
        if rung.spectrum() == Spectrum::Paper {
            let strengths = fitted.next().map(|(_, found)| found.iter().map(|c| c.strength).collect());
            entries.extend(strengths.map(|strengths| Entry { name: format!("{rung}{FITTED}"), settings, strengths }));
        }
    }
    entries
}

/// Returns the rungs with the paper's dispersion.
fn papers(options: &Options) -> impl Iterator<Item = Rung> + '_ {
    options.rungs.iter().copied().filter(|rung| rung.spectrum() == Spectrum::Paper)
}

/// Measures the ladder. A row of a view has the errors and the time of the same picture; the rows of
/// [`FILLED`] have the shaders' instructions, and the bytes of constants and storage that the
/// stone's geometry needs besides the mesh.
///
/// # Errors
/// Returns an error if a committed reference is damaged or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings = [
        ("width", width),
        ("height", height),
        ("rounds", options.rounds),
        ("side", views::SIDE),
        ("samples", SAMPLES * SAMPLES),
    ];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    let open = |views: &[View]| views.iter().map(|view| Watched::open(gpu, view)).collect::<Result<Vec<_>, _>>();
    let (watched, concave) = (open(&options.views)?, open(&options.concave)?);
    let fits = (papers(options).count() * watched.len()) as u64;
    let mut colours: Vec<Vec<Colours>> = Vec::new();
    for rung in papers(options) {
        let mut found = Vec::new();
        for Watched { view, scene, .. } in &watched {
            found.push(dispersion::colours(gpu, rung, view, scene)?);
            progress("fitting the paper's dispersion", (colours.len() * watched.len() + found.len()) as u64, fits);
        }
        colours.push(found);
    }
    let entries = entries(options, &colours);
    let total = (watched.len() + concave.len()) as u64;
    for (view, watched) in watched.iter().enumerate() {
        progress("comparing and timing views", view as u64, total);
        let drawn = entries.iter().map(|entry| (&*entry.name, entry.settings_in(Some(view))));
        watched.see(gpu, options.rounds, &drawn.collect::<Vec<_>>(), &mut report)?;
    }
    for (done, watched) in (watched.len() as u64..).zip(&concave) {
        progress("comparing and timing views", done, total);
        let drawing = entries.iter().filter(|entry| entry.draws_concave());
        let drawn = drawing.map(|entry| (&*entry.name, entry.settings_in(None)));
        watched.see(gpu, options.rounds, &drawn.collect::<Vec<_>>(), &mut report)?;
    }
    let brilliant = Scene::named("brilliant")?;
    let filled = views::filled(&brilliant);
    let timed: Vec<Timed<'_>> = entries
        .iter()
        .map(|entry| Timed {
            scales: true,
            ..Timed::new(&filled, Settings { width, height, ..entry.settings.clone() })
        })
        .collect();
    let timings = timing::time(gpu, &timed, options.rounds, &mut |done, total| progress("timing", done, total))?;
    for (entry, timing) in entries.iter().zip(timings) {
        report.add_time(entry.counted(&brilliant)?, timing.as_ref());
        let encode = timing.map(|timing| timing.encode_us);
        report.rows.push(Row::new(&entry.name, FILLED, "encode", encode, "µs"));
    }
    progress("comparing how rays end", 0, 1);
    choices::measure(gpu, &watched, &mut report)?;
    seen::steadiness(gpu, (options.rounds, options.frame), &watched, &mut report)?;
    report.rows.extend(colours.concat().iter().flat_map(Colours::rows));
    if options.sizes {
        growth::measure(gpu, options, &mut report, progress)?;
        let mut small = |done| progress("following small references", done, proxy_sizes::FOLLOWED);
        proxy_sizes::measure(gpu, &mut report, &mut small)?;
    }
    reflection::measure(&mut report)?;
    Ok(report)
}

impl Entry {
    /// Returns a row with the SPIR-V instructions of the rung's shaders for the brilliant, vertex and
    /// fragment, and the bytes of its geometry.
    fn counted(&self, brilliant: &Scene) -> Result<Row, CostError> {
        let rung = self.settings.rung;
        let source = lapidary_wgsl::recipe_source(rung.recipe());
        let constants = render::gem_constants(brilliant, &self.settings);
        let shader = Shader::new(rung.recipe(), &source, &["gem_vertex", "gem_fragment"], &constants);
        let counts = shader.map_err(render::RenderError::from)?.counts()?;
        Ok(Row {
            bytes: Some(render::geometry_bytes(&brilliant.objects[0], rung)?),
            instructions: vec![counts.vertex_instructions, counts.fragment_instructions],
            ..Row::new(&self.name, FILLED, "", None, "")
        })
    }
}
