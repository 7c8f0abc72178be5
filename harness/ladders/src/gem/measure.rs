//! Measures the gem ladder: errors and times of its rungs in all views, and of frames that a stone fills.

use super::choices;
use super::dispersion::{self, Colours};
use super::options::Options;
use super::rungs::{FILLED, NAME};
use super::seen::{self, SAMPLES, Watched};
use super::views::{self, View};
use crate::error::CostError;
use crate::options::Progress;
use crate::report::{Report, Row};
use crate::timing::{self, Timed};
use lapidary_gpu::Gpu;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::shader::Shader;
use lapidary_render::{GemOptions, Settings};
use lapidary_scene::Scene;

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
    let mut report = Report::new(NAME, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
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
