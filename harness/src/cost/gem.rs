//! The gem ladder.

use super::timing::{self, Timed};
use super::views::{self, View};
use super::{Colours, CostError, Errors, Report, RungReport, choices, dispersion, reflection};
use crate::cookbook;
use crate::gpu::Gpu;
use crate::render::{self, Picture, Rung, Settings, Spectrum};
use crate::scene::Scene;
use crate::shader::Shader;

/// The ladder from cheap to exact. Where a rung follows the paper's dispersion, it is measured at the best-fit strength too. The hierarchy and
/// the loop over triangles give the planes' pictures, so a few rungs show what they take.
pub const RUNGS: [&str; 42] = [
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
    "convex-1",
    "convex-2",
    "convex-2+paper",
    "convex-2+tracker",
    "convex-2+3",
    "convex-4",
    "convex-4+paper",
    "convex-4+tracker",
    "convex-4+3",
    "convex-4+31",
    "convex-8",
    "convex-8+paper",
    "convex-8+tracker",
    "convex-8+3",
    "convex-8+31",
    "bvh-1",
    "bvh-4+tracker",
    "bvh-8",
    "bvh-8+tracker",
    "bvh-8+3",
    "triangles-1",
    "triangles-8+tracker",
];

/// What is measured, and how carefully.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; none leaves times out.
    pub rounds: u32,
    /// Width and height of the timed frame.
    pub frame: [u32; 2],
    /// The views to compare in.
    pub views: Vec<View>,
    /// Names of rungs.
    pub rungs: Vec<Rung>,
}

impl Default for Options {
    fn default() -> Self {
        let rungs = RUNGS.iter().filter_map(|name| name.parse().ok()).collect();
        Self { rounds: 7, frame: [1920, 1080], views: views::VIEWS.to_vec(), rungs }
    }
}

/// A rung with its name in the report, its settings, and the strength of the paper's dispersion in each view.
struct Entry {
    name: String,
    settings: Settings,
    strengths: Vec<f32>,
}

fn entries(options: &Options, colours: &[Vec<Colours>]) -> Vec<Entry> {
    let views = options.views.len();
    let mut entries = Vec::new();
    let mut fitted = papers(options).zip(colours);
    for &rung in &options.rungs {
        let settings = Settings { rung, ..Settings::of_size(views::SIDE, views::SIDE) };
        entries.push(Entry { name: rung.to_string(), settings: settings.clone(), strengths: vec![1.0; views] });
        if rung.spectrum() == Spectrum::Paper {
            let strengths = fitted.next().map(|(_, found)| found.iter().map(|c| c.strength).collect());
            entries.extend(strengths.map(|strengths| Entry { name: format!("{rung}-fitted"), settings, strengths }));
        }
    }
    entries
}

/// The rungs that follow the paper's dispersion.
fn papers(options: &Options) -> impl Iterator<Item = Rung> + '_ {
    options.rungs.iter().copied().filter(|rung| rung.spectrum() == Spectrum::Paper)
}

/// Measures the ladder. `progress` is told what is done, and how much of it.
pub fn run(
    gpu: &Gpu,
    options: &Options,
    progress: &mut dyn FnMut(&'static str, u64, u64),
) -> Result<Report, CostError> {
    let scenes: Vec<Scene> = options.views.iter().map(View::open).collect::<Result<_, _>>()?;
    let references: Vec<Picture> = options.views.iter().map(|view| view.reference(gpu)).collect::<Result<_, _>>()?;
    let fits = (papers(options).count() * scenes.len()) as u64;
    let mut colours: Vec<Vec<Colours>> = Vec::new();
    for rung in papers(options) {
        let mut found = Vec::new();
        for (view, scene) in options.views.iter().zip(&scenes) {
            found.push(dispersion::colours(gpu, rung, view, scene)?);
            progress("fitting the paper's dispersion", (colours.len() * scenes.len() + found.len()) as u64, fits);
        }
        colours.push(found);
    }
    let entries = entries(options, &colours);
    let total = (entries.len() * scenes.len()) as u64;
    let brilliant = Scene::named("brilliant")?;
    let mut rungs = Vec::new();
    for entry in &entries {
        let mut errors = Vec::new();
        for ((scene, reference), &dispersion_strength) in scenes.iter().zip(&references).zip(&entry.strengths) {
            let settings = Settings { dispersion_strength, ..entry.settings.clone() };
            errors.push(Some(Errors::between(&render::render_means(gpu, scene, &settings)?, reference)));
            progress("comparing", (rungs.len() * scenes.len() + errors.len()) as u64, total);
        }
        rungs.push(count(&brilliant, entry, errors)?);
    }
    if options.rounds > 0 {
        let filled = views::filled(&brilliant);
        let [width, height] = options.frame;
        let timed: Vec<Timed<'_>> = entries
            .iter()
            .map(|entry| Timed {
                settings: Settings { width, height, samples: 1, ..entry.settings.clone() },
                scene: &filled,
                source: None,
                displayed: false,
                scales: true,
            })
            .collect();
        let timings = timing::time(gpu, &timed, options.rounds, &mut |done, total| progress("timing", done, total))?;
        for (rung, timing) in rungs.iter_mut().zip(timings) {
            rung.timing = Some(timing);
        }
    }
    progress("comparing how rays end", 0, 1);
    let choices = choices::measure(gpu, &options.views, &scenes, &references)?;
    Ok(Report {
        adapter: gpu.describe(),
        views: options.views.iter().map(|view| view.name.to_owned()).collect(),
        frame: options.frame,
        rungs,
        colours: colours.concat(),
        choices,
        reflections: reflection::measure()?,
    })
}

/// The rung's shaders for the brilliant, specialised to what it uses, counted in SPIR-V.
fn count(brilliant: &Scene, entry: &Entry, errors: Vec<Option<Errors>>) -> Result<RungReport, CostError> {
    let rung = entry.settings.rung;
    let source = cookbook::recipe_source(rung.recipe());
    let constants = render::gem_constants(brilliant, &entry.settings);
    let shader = Shader::new(rung.recipe(), &source, &["gem_vertex", "gem_fragment"], &constants);
    let counts = shader.map_err(render::RenderError::from)?.counts()?;
    Ok(RungReport {
        rung: entry.name.clone(),
        errors,
        timing: None,
        fragment_instructions: counts.fragment_instructions,
        vertex_instructions: counts.vertex_instructions,
        geometry_bytes: render::geometry_bytes(&brilliant.objects[0], rung)?,
        dominated: false,
    })
}
