//! What light that leaves a stone meets: the error that each way leaves in stones among other bodies,
//! and its time.

use glam::Vec3;
use lapidary_gpu::Gpu;
use lapidary_ladders::error::CostError;
use lapidary_ladders::gem::Errors;
use lapidary_ladders::ladder::Ladder;
use lapidary_ladders::options::{Options, Progress};
use lapidary_ladders::report::{Report, Row};
use lapidary_ladders::table::{Table, figure, mean};
use lapidary_ladders::timing::{self, Timed};
use lapidary_plan::{Outside, Rung};
use lapidary_render as render;
use lapidary_render::{GemOptions, Picture, SCREEN_STEPS, Settings};
use lapidary_scene::{Material, Object, Scene};

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: "outside", tables: |report| vec![table(report)], plots: |_| Vec::new(), whole };

/// Scenes of stones and matte bodies close to one another: bodies that fill their bounds, and a band
/// that does not.
const SCENES: [&str; 2] = ["tray", "solitaire"];
/// The camera's angles in degrees: aslant, from above, and low from the side.
const VIEWS: [(f32, f32); 3] = [(60.0, 12.0), (35.0, -25.0), (78.0, 40.0)];
/// Samples along each side of a pixel of the reference.
const REFERENCE_SAMPLES: u32 = 4;

/// A way.
#[derive(Clone, Copy)]
enum Way {
    /// By the default rung for a stone alone, with the steps over the picture.
    Meets(Outside, u32),
    /// By a rung that follows light through all bodies.
    Among(&'static str),
}

/// The ways.
const WAYS: [Way; 11] = [
    Way::Meets(Outside::Environment, SCREEN_STEPS),
    Way::Meets(Outside::Bodies, SCREEN_STEPS),
    Way::Meets(Outside::Screen, SCREEN_STEPS),
    Way::Meets(Outside::Screen, 16),
    Way::Meets(Outside::Screen, 32),
    Way::Meets(Outside::Screen, 64),
    Way::Meets(Outside::Triangles, SCREEN_STEPS),
    Way::Among("scene-8"),
    Way::Among("scene-8+3"),
    Way::Among("scene-16+3"),
    Way::Among("scene-32+3"),
];

/// The reference without what stones send to one another.
const ALONE: &str = "everything but other stones, exactly";

/// What is measured: errors over the pixels that show a stone.
const MEASURES: [&str; 3] = ["flip", "rmse", "energy"];

/// Returns how to measure by default; there are no rungs to choose.
pub fn options() -> Options {
    Options { rounds: 5, frame: [256, 192], rungs: Vec::new() }
}

impl Way {
    /// Returns the name in the report.
    fn name(self) -> String {
        match self {
            Self::Meets(Outside::Screen, steps) => format!("{}, {steps} steps", Outside::Screen),
            Self::Meets(outside, _) => outside.to_string(),
            Self::Among(rung) => format!("all bodies, `{rung}`"),
        }
    }

    fn settings(self, usual: &Settings) -> Settings {
        match self {
            Self::Meets(outside, screen_steps) => {
                let gem = GemOptions { outside: Some(outside), screen_steps, ..GemOptions::default() };
                Settings { gem, ..usual.clone() }
            }
            Self::Among(rung) => Settings { rung: rung.parse().expect("a rung"), ..usual.clone() },
        }
    }
}

/// Measures every way in every view, with one sample per pixel.
///
/// # Errors
/// Returns an error if the scene cannot be drawn or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings = [("width", width), ("height", height), ("rounds", options.rounds)];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    let usual = Settings { rung: Rung::ByMaterial, samples: 1, ..Settings::of_size(width, height) };
    let views = SCENES.into_iter().flat_map(|name| VIEWS.map(|from| (name, from)));
    let total = (SCENES.len() * VIEWS.len()) as u64;
    for (done, (name, (polar, azimuth))) in (0..).zip(views) {
        progress("comparing and timing views", done, total);
        let scene = Scene::named(name)?.seen_from(polar, azimuth);
        let view = format!("{name}, {polar}°, {azimuth}°");
        let shows_stone = shows(gpu, &scene, &usual, &clear(&scene).collect::<Vec<_>>())?;
        let exact = Settings { rung: Rung::Reference, samples: REFERENCE_SAMPLES, ..usual.clone() };
        let reference = kept(render::render_means(gpu, &scene, &exact)?, &shows_stone);
        let alone = kept(each_alone(gpu, &scene, &exact, &usual)?, &shows_stone);
        for (measure, value) in MEASURES.into_iter().zip(errors(&alone, &reference)) {
            report.rows.push(Row::new(ALONE, &view, measure, value, ""));
        }
        let timed: Vec<Timed<'_>> = WAYS.iter().map(|way| Timed::new(&scene, way.settings(&usual))).collect();
        let timings = timing::time(gpu, &timed, options.rounds, &mut |_, _| {})?;
        for (way, timing) in WAYS.into_iter().zip(timings) {
            let picture = kept(render::render_means(gpu, &scene, &way.settings(&usual))?, &shows_stone);
            let ms = timing.map(|timing| timing.ms);
            for (measure, value) in MEASURES.into_iter().zip(errors(&picture, &reference)) {
                report.rows.push(Row::new(&way.name(), &view, measure, value, "").timed(ms));
            }
        }
    }
    Ok(report)
}

/// Returns what is measured of a picture against the reference.
fn errors(picture: &Picture, reference: &Picture) -> [f64; MEASURES.len()] {
    let Errors { flip, rmse, energy } = Errors::between(picture, reference);
    [flip, rmse, energy]
}

/// Returns the reference's picture of a scene's stones, each among the matte bodies alone: what a way
/// shows at best that meets all but other stones.
fn each_alone(gpu: &Gpu, scene: &Scene, exact: &Settings, usual: &Settings) -> Result<Picture, CostError> {
    let mut together = render::render_means(gpu, scene, exact)?;
    let clear: Vec<usize> = clear(scene).collect();
    for only in clear.iter().copied() {
        let mut alone = scene.clone();
        for other in clear.iter().rev().copied().filter(|other| *other != only) {
            alone.objects.remove(other);
        }
        let shows_it = shows(gpu, scene, usual, &[only])?;
        let picture = render::render_means(gpu, &alone, exact)?;
        for (place, _) in shows_it.iter().enumerate().filter(|(_, shows_it)| **shows_it) {
            together.linear[place] = picture.linear[place];
            together.encoded[place] = picture.encoded[place];
        }
    }
    Ok(together)
}

/// Returns the places of a scene's stones among its objects.
fn clear(scene: &Scene) -> impl Iterator<Item = usize> {
    let is_clear = |(place, object): (usize, &Object)| object.material.is_clear().then_some(place);
    scene.objects.iter().enumerate().filter_map(is_clear)
}

/// Returns which pixels show one of some stones: those that change with its colour, were all stones
/// matte.
fn shows(gpu: &Gpu, scene: &Scene, settings: &Settings, stones: &[usize]) -> Result<Vec<bool>, CostError> {
    let with = |color: Vec3| {
        let mut scene = scene.clone();
        for place in clear(&scene).collect::<Vec<_>>() {
            let base_color = if stones.contains(&place) { color } else { Vec3::ZERO };
            scene.objects[place].material = Material { base_color, ior: 1.0, roughness: 1.0, ..Material::standard() };
        }
        render::render(gpu, &scene, settings)
    };
    let (black, white) = (with(Vec3::ZERO)?, with(Vec3::ONE)?);
    Ok(black.linear.iter().zip(&white.linear).map(|(black, white)| black != white).collect())
}

/// Returns the picture with nothing but some pixels.
fn kept(mut picture: Picture, is_kept: &[bool]) -> Picture {
    for (place, _) in is_kept.iter().enumerate().filter(|(_, is_kept)| !**is_kept) {
        picture.linear[place] = [0.0; 4];
        picture.encoded[place] = [0, 0, 0, 255];
    }
    picture
}

fn whole(report: &Report) -> Result<(), String> {
    if report.rungs(MEASURES[0]).len() == WAYS.len() + 1
        && report.views(MEASURES[0]).len() == SCENES.len() * VIEWS.len()
    {
        return Ok(());
    }
    Err("the report does not hold all ways and views".to_owned())
}

fn table(report: &Report) -> Table {
    let views = |scene: &str| -> Vec<&str> {
        report.views(MEASURES[0]).into_iter().filter(|view| view.split(',').next() == Some(scene)).collect()
    };
    let mean_of = |way: &str, scene: &str, measure: &str| {
        let values = views(scene).into_iter().map(|view| report.value(way, view, measure));
        mean(&values.collect::<Option<Vec<_>>>()?)
    };
    let ms = |way: &str, scene: &str| {
        let times = views(scene).into_iter().map(|view| report.ms(way, view, MEASURES[0]));
        mean(&times.collect::<Option<Vec<_>>>()?)
    };
    let usual = WAYS[0].name();
    let mut lines = Table::of("outside", "What light that leaves a stone meets", report.rungs(MEASURES[0]))
        .column("meets", |way| (*way).to_owned());
    for scene in SCENES {
        lines = lines
            .column(format!("{scene}: FLIP, RMSE, energy"), |way| {
                MEASURES.map(|measure| figure(mean_of(way, scene, measure), 3)).join(", ")
            })
            .column("ms", |way| figure(ms(way, scene), 1))
            .column("× environment", |way| {
                figure(ms(way, scene).zip(ms(&usual, scene)).map(|(ms, usual)| ms / usual), 2)
            });
    }
    lines.note(format!(
        "Each scene from {} angles, {} pixels of one sample, stones by `walk-8+tracker` where no other rung is named: errors against the reference \
         over the pixels that show a stone; times of the whole frame; means over the angles. Times: {}.",
        VIEWS.len(),
        report.size(),
        report.run()
    ))
}
