//! `cook render`.

use super::asked::Asked;
use super::{Context, Failure, Outcome, number, output, progress};
use lapidary_plan as plan;
use lapidary_plan::{Decisions, Geometry, Note, Rung, Spectrum};
use lapidary_reference::random_walk::mesh::{Boundary, Origin};
use lapidary_reference::spectral::Lost;
use lapidary_render as render;
use lapidary_render::file::{self, Format};
use lapidary_render::{
    Curvature, DiffuseOptions, GemOptions, OpticalPathOptions, ReferenceOptions, Settings, WalkOptions, WalkedPicture,
};
use lapidary_scene::Scene;
use lapidary_scene::nearest::suggest;
use std::path::PathBuf;

/// Renders a scene: a built-in by name, or a .glb or .gltf file.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook render brilliant\n  ./cook render ruby --quality best --from 0,0\n  ./cook render brilliant --rung proxy-1+paper\n  ./cook render quartz --rung reference --size 256x256 --out quartz.exr\n  ./cook render my_stone.glb --size 1920x1080 --out stone.exr --environment studio.hdr"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// Output file, PNG (tone-mapped sRGB) or EXR (linear, half float); SCENE.png in the current
    /// folder by default.
    #[arg(long, value_name = "F.png|F.exr")]
    out: Option<PathBuf>,
    /// Camera direction in degrees off the vertical, and from +z towards +x; the scene's own camera
    /// by default.
    #[arg(long, value_name = "POLAR,AZIMUTH", value_parser = parse_from, allow_hyphen_values = true)]
    from: Option<(f32, f32)>,
    /// Factor on radiance before the tone curve.
    #[arg(long, default_value_t = 1.0, value_parser = parse_positive)]
    exposure: f32,
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = lapidary_scene::SAMPLES, value_parser = number::whole(1..=render::MOST_SAMPLES))]
    samples: u32,
    #[command(flatten)]
    gem: Option<Gem>,
    #[command(flatten)]
    diffuse: Option<Diffuse>,
    #[command(flatten)]
    optical_path: Option<OpticalPath>,
    #[command(flatten)]
    reference: Option<Reference>,
    #[command(flatten)]
    walks: Option<Walks>,
}

/// Options of the gem recipes.
#[derive(clap::Args)]
#[command(next_help_heading = "Gem recipes")]
struct Gem {
    /// Factor on the paper's dispersion, eq. (12), for rungs with +paper; 1 by default.
    #[arg(long, value_name = "FACTOR", value_parser = parse_positive)]
    strength: Option<f32>,
    /// Energy that a ray still carries at its last hit: replaced by the environment in the ray's
    /// direction (the default), or dropped.
    #[arg(long, value_name = "WAY", value_parser = ["environment", "dropped"])]
    rest: Option<String>,
    /// Maximum distance that a ray travels inside, in units of length.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    distance_limit: Option<f32>,
    /// Whether a ray inside ends when its contribution can no longer be seen. On by default for
    /// rungs of 16 hits or more, which it makes faster.
    #[arg(long, value_name = "WHETHER", value_parser = ["on", "off"])]
    throughput_limit: Option<String>,
    /// Draw with a geometry buffer and a lighting pass, as a deferred renderer does.
    #[arg(long)]
    deferred: bool,
    /// Centre of the proxy: stable (the default), or the paper's eq. (4).
    #[arg(long, value_name = "FORM", value_parser = ["stable", "paper"])]
    centre: Option<String>,
}

/// Options for scattering bodies drawn by their curvature.
#[derive(clap::Args)]
#[command(next_help_heading = "Scattering bodies by their curvature")]
struct Diffuse {
    /// Curvature that spreads the light. From the pixel's derivatives: mean (the default), towards
    /// (towards each light) or naive (|dN| / |dP|). From the mesh: vertex, its mean curvature.
    #[arg(long, value_name = "FORM", value_parser = parse_curvature)]
    curvature: Option<Curvature>,
}

/// Options for translucent scattering bodies.
#[derive(clap::Args)]
#[command(next_help_heading = "Scattering bodies by optical paths")]
struct OpticalPath {
    /// Share of scattering and absorption that attenuates light along its path through a body; 0.18
    /// by default.
    #[arg(long, value_name = "SHARE", value_parser = parse_positive)]
    extinction_scale: Option<f32>,
}

/// Options of the reference for clear stones.
#[derive(clap::Args)]
#[command(next_help_heading = "The reference of clear stones")]
struct Reference {
    /// Number of wavelengths; 31 by default.
    #[arg(long, value_parser = number::whole(0..=usize::MAX))]
    wavelengths: Option<usize>,
    /// Share of a camera ray's energy that may be left untraced; 1e-4 by default.
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    energy_bound: Option<f64>,
}

/// Options of the reference for scattering bodies.
#[derive(clap::Args)]
#[command(next_help_heading = "The reference of scattering bodies")]
struct Walks {
    /// Walks per pixel; 256 by default.
    #[arg(long, value_parser = number::whole(0..=u32::MAX))]
    walks: Option<u32>,
    /// Where the walks start: starting from the lights gives less noise, but leaves out the
    /// environment.
    #[arg(long, value_name = "END", value_parser = parse_origin)]
    walks_from: Option<Origin>,
    /// Seed of the walks; 1 by default.
    #[arg(long, value_parser = number::whole(0..=u64::MAX))]
    seed: Option<u64>,
    /// Effect of surfaces on walks: none (matched), or refraction and reflection by the material's
    /// ior (dielectric).
    #[arg(long, value_parser = ["matched", "dielectric"])]
    boundary: Option<String>,
}

impl Gem {
    fn options(&self) -> GemOptions {
        let usual = GemOptions::default();
        GemOptions {
            paper_centre: self.centre.as_deref() == Some("paper"),
            dispersion_strength: self.strength.unwrap_or(usual.dispersion_strength),
            rest_from_environment: self.rest.as_deref() != Some("dropped"),
            distance_limit: self.distance_limit,
            limit_throughput: self.throughput_limit.as_deref().map(|whether| whether == "on"),
            deferred: self.deferred,
        }
    }
}

impl Walks {
    fn options(&self) -> WalkOptions {
        let usual = WalkOptions::default();
        WalkOptions {
            walks: self.walks.unwrap_or(usual.walks),
            from: self.walks_from.unwrap_or(usual.from),
            seed: self.seed.unwrap_or(usual.seed),
            boundary: match self.boundary.as_deref() {
                Some("dielectric") => Boundary::Dielectric,
                _ => usual.boundary,
            },
        }
    }
}

impl Arguments {
    /// Returns the requested settings with the options of each technique.
    fn settings(&self, asked: Settings) -> Settings {
        let (diffuse, reference) = (DiffuseOptions::default(), ReferenceOptions::default());
        let curvature = self.diffuse.as_ref().and_then(|of| of.curvature).unwrap_or(diffuse.curvature);
        let extinction_scale = self.optical_path.as_ref().and_then(|of| of.extinction_scale);
        let wavelengths = self.reference.as_ref().and_then(|of| of.wavelengths);
        let energy_bound = self.reference.as_ref().and_then(|of| of.energy_bound);
        Settings {
            exposure: self.exposure,
            samples: self.samples,
            gem: self.gem.as_ref().map_or(asked.gem, Gem::options),
            diffuse: DiffuseOptions { curvature, ..diffuse },
            optical_path: extinction_scale
                .map_or(asked.optical_path, |extinction_scale| OpticalPathOptions { extinction_scale }),
            reference: ReferenceOptions {
                wavelengths: wavelengths.unwrap_or(reference.wavelengths),
                energy_bound: energy_bound.unwrap_or(reference.energy_bound),
            },
            walks: self.walks.as_ref().map_or(asked.walks, Walks::options),
            ..asked
        }
    }
}

fn parse_from(text: &str) -> Result<(f32, f32), String> {
    let number = |text: &str| text.trim().parse::<f32>().ok().filter(|angle| angle.is_finite());
    let parsed = text.split_once(',').and_then(|(polar, azimuth)| Some((number(polar)?, number(azimuth)?)));
    parsed.ok_or_else(|| "expected two angles in degrees, such as 20,11".to_owned())
}

fn parse_curvature(text: &str) -> Result<Curvature, String> {
    let names = Curvature::ALL.map(Curvature::name);
    let found = Curvature::ALL.into_iter().find(|curvature| curvature.name() == text);
    found.ok_or_else(|| format!("no such curvature{}", suggest(text, &names)))
}

fn parse_origin(text: &str) -> Result<Origin, String> {
    let names = Origin::ALL.map(Origin::name);
    let found = Origin::ALL.into_iter().find(|origin| origin.name() == text);
    found.ok_or_else(|| format!("no such end of a walk{}", suggest(text, &names)))
}

fn parse_positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(exposure) if exposure.is_finite() && exposure > 0.0 => Ok(exposure),
        _ => Err("expected a number above 0".to_owned()),
    }
}

/// Refuses options of a technique that draws no object: the user would believe that they took
/// effect.
fn refuse_what_is_ignored(arguments: &Arguments, scene: &Scene, settings: &Settings) -> Result<(), Failure> {
    let usual = Settings::of_size(1, 1);
    let inside = GemOptions { deferred: false, ..settings.gem } != usual.gem;
    type Draws = fn(Rung, bool) -> bool;
    let asked: [(&str, bool, Draws); 8] = [
        ("the gem recipes", arguments.gem.is_some(), |rung, _| matches!(rung, Rung::Inside { .. } | Rung::Surface)),
        ("rays inside clear stones", inside, |rung, _| matches!(rung, Rung::Inside { .. })),
        ("the proxy", settings.gem.paper_centre, |rung, _| {
            matches!(rung, Rung::Inside { geometry: Geometry::Proxy, .. })
        }),
        ("the paper's dispersion", settings.gem.dispersion_strength != usual.gem.dispersion_strength, |rung, _| {
            rung.spectrum() == Spectrum::Paper
        }),
        ("curvature", arguments.diffuse.is_some(), |rung, _| matches!(rung, Rung::Diffuse(of) if !of.is_lambert())),
        ("optical paths", arguments.optical_path.is_some(), |rung, _| matches!(rung, Rung::OpticalPath(_))),
        ("the reference of clear stones", arguments.reference.is_some(), |rung, scatters| {
            rung == Rung::Reference && !scatters
        }),
        ("the reference of scattering bodies", arguments.walks.is_some(), |rung, scatters| {
            rung == Rung::Reference && scatters
        }),
    ];
    let asked: Vec<_> = asked.into_iter().filter(|(_, is_asked, _)| *is_asked).collect();
    // Returns early, because deciding measures bodies.
    if asked.is_empty() {
        return Ok(());
    }
    let scatters = render::scatters(scene);
    let rungs: Vec<Rung> =
        scene.objects.iter().map(|object| Decisions::of(object, scene, &settings.request()).rung).collect();
    match asked.iter().find(|(_, _, draws)| !rungs.iter().any(|rung| draws(*rung, scatters))) {
        Some((what, ..)) => Err(Failure(format!(
            "scene `{}` by rung `{}`: options of {what} have no meaning, since nothing is drawn so; leave them out or take another rung",
            scene.name, settings.rung
        ))),
        None => Ok(()),
    }
}

/// Whether a note from before drawing is repeated with more detail by a note from drawing.
fn is_told_again(note: &Note, found: &[Note]) -> bool {
    let Note::NotSolid { objects, rung: Rung::OpticalPath(_), .. } = note else { return false };
    objects.count == 1
        && found.iter().any(|found| matches!(found, Note::Open { object, .. } if *object == objects.first))
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut scene = Scene::open(&arguments.asked.scene)?;
    if let Some((polar, azimuth)) = arguments.from {
        scene = scene.seen_from(polar, azimuth);
    }
    let (asked, mut notes) = arguments.asked.settings(&scene)?;
    let settings = arguments.settings(asked);
    refuse_what_is_ignored(arguments, &scene, &settings)?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        // Not the scene's name, which comes from the file: it would decide where the picture is
        // written.
        let mut name = Scene::stem(&arguments.asked.scene);
        name.push(".png");
        PathBuf::from(name)
    });
    Format::of_path(&out)?;
    file::check_writable(&out)?;
    let bar = progress::bar(0, "rendering");
    let picture = render::render_reporting(context.gpu()?, &scene, &settings, &mut |done, total| {
        bar.set_length(total);
        bar.set_position(done);
    })?;
    bar.finish_and_clear();
    file::write(&picture, &out)?;
    let decisions = Decisions::all(&scene, &settings.request());
    notes.extend(plan::notes(&scene, &settings.request(), &decisions.iter().collect::<Vec<_>>()));
    notes.retain(|note| !is_told_again(note, &picture.notes));
    notes.extend(picture.notes);
    for note in &notes {
        eprintln!("cook: {note}");
    }
    for lacking in &scene.lacking {
        eprintln!("cook: not drawn, though the file asks for it: {lacking}");
    }
    output::line(&out.display().to_string())?;
    if let Some(Lost { max, mean }) = picture.lost {
        output::line(&format!("not followed: {max:.1e} of a ray's energy at most, {mean:.1e} in the mean"))?;
    }
    if let Some(WalkedPicture { error, walks, lost }) = picture.walked {
        output::line(&format!(
            "standard error {:.1} % of the mean brightness; {walks} walks, {lost} lost",
            100.0 * error
        ))?;
    }
    Ok(Outcome::Passed)
}
