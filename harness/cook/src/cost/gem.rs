//! The gem ladder.

use super::seen::{SAMPLES, Seen, Watched, steadiness};
use super::timing::{self, Timed};
use super::views::{self, View};
use super::{Colours, CostError, Report, RungReport, choices, dispersion, proxy_sizes, reflection};
use lapidary_gpu::Gpu;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::shader::Shader;
use lapidary_render::{GemOptions, Settings};
use lapidary_scene::Scene;

/// The ladder from cheap to exact; the number of hits doubles from rung to rung.
///
/// A rung with the paper's dispersion is also measured at its best-fit strength. The hierarchy and
/// the loop over triangles give the same pictures as the planes, so a few rungs are enough to show
/// their cost; those of the hierarchy include colours, which make it a twentieth slower.
pub const RUNGS: [&str; 44] = [
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
    /// Whether the proxy is also measured at small sizes, which takes a minute or two.
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
        let drawn = !matches!(self.settings.rung.geometry(), Geometry::Convex | Geometry::Triangles);
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

/// Measures the ladder. `progress` receives the current step, the work done and the total.
pub fn run(
    gpu: &Gpu,
    options: &Options,
    progress: &mut dyn FnMut(&'static str, u64, u64),
) -> Result<Report, CostError> {
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
    let brilliant = Scene::named("brilliant")?;
    let mut rungs = entries.iter().map(|entry| count(&brilliant, entry)).collect::<Result<Vec<_>, _>>()?;
    let total = (watched.len() + concave.len()) as u64;
    for (done, (view, watched)) in (0..).zip(watched.iter().enumerate()) {
        progress("comparing and timing views", done, total);
        for (rung, seen) in rungs.iter_mut().zip(see(gpu, options, watched, &entries, Some(view))?) {
            rung.views.push(Some(seen));
        }
    }
    for (done, watched) in (options.views.len() as u64..).zip(&concave) {
        progress("comparing and timing views", done, total);
        let (drawing, drawn): (Vec<_>, Vec<_>) =
            entries.iter().zip(&mut rungs).partition(|(entry, _)| entry.draws_concave());
        drawn.into_iter().for_each(|(_, rung)| rung.concave.push(None));
        let (entries, rungs): (Vec<&Entry>, Vec<&mut RungReport>) = drawing.into_iter().unzip();
        for (rung, seen) in rungs.into_iter().zip(see(gpu, options, watched, entries, None)?) {
            rung.concave.push(Some(seen));
        }
    }
    if options.rounds > 0 {
        let filled = views::filled(&brilliant);
        let [width, height] = options.frame;
        let timed: Vec<Timed<'_>> = entries
            .iter()
            .map(|entry| Timed {
                settings: Settings { width, height, ..entry.settings.clone() },
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
    let choices = choices::measure(gpu, &watched)?;
    let steadiness = steadiness(gpu, &watched)?;
    let mut small = |done| progress("following small references", done, proxy_sizes::FOLLOWED);
    let sizes = if options.sizes { proxy_sizes::measure(gpu, &mut small)? } else { Vec::new() };
    let names = |watched: &[Watched]| watched.iter().map(|watched| watched.view.name.to_owned()).collect();
    Ok(Report {
        adapter: gpu.describe(),
        views: names(&watched),
        concave: names(&concave),
        side: views::SIDE,
        samples: SAMPLES * SAMPLES,
        frame: options.frame,
        rungs,
        colours: colours.concat(),
        choices,
        steadiness,
        sizes,
        reflections: reflection::measure()?,
    })
}

/// Compares every rung in a view, and times it on the same picture.
fn see<'a>(
    gpu: &Gpu,
    options: &Options,
    watched: &Watched,
    entries: impl IntoIterator<Item = &'a Entry>,
    view: Option<usize>,
) -> Result<Vec<Seen>, CostError> {
    let settings: Vec<Settings> = entries.into_iter().map(|entry| entry.settings_in(view)).collect();
    let mut seen = settings.iter().map(|settings| watched.see(gpu, settings)).collect::<Result<Vec<_>, _>>()?;
    if options.rounds > 0 {
        let timed = |settings: Settings| Timed {
            settings,
            scene: &watched.scene,
            source: None,
            displayed: false,
            scales: false,
        };
        let timed: Vec<Timed<'_>> = settings.into_iter().map(timed).collect();
        let timings = timing::time(gpu, &timed, options.rounds, &mut |_, _| {})?;
        for (seen, timing) in seen.iter_mut().zip(timings) {
            seen.ms = Some(timing.ms);
        }
    }
    Ok(seen)
}

/// Specialises the rung's shaders for the brilliant and counts their SPIR-V instructions.
fn count(brilliant: &Scene, entry: &Entry) -> Result<RungReport, CostError> {
    let rung = entry.settings.rung;
    let source = lapidary_wgsl::recipe_source(rung.recipe());
    let constants = render::gem_constants(brilliant, &entry.settings);
    let shader = Shader::new(rung.recipe(), &source, &["gem_vertex", "gem_fragment"], &constants);
    let counts = shader.map_err(render::RenderError::from)?.counts()?;
    Ok(RungReport {
        rung: entry.name.clone(),
        views: Vec::new(),
        concave: Vec::new(),
        timing: None,
        fragment_instructions: counts.fragment_instructions,
        vertex_instructions: counts.vertex_instructions,
        geometry_bytes: render::geometry_bytes(&brilliant.objects[0], rung)?,
        dominated: false,
    })
}
