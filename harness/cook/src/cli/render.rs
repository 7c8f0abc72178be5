//! `cook render`.

use super::asked::Asked;
use super::{Context, Failure, Outcome, number, output, progress};
use lapidary_plan as plan;
use lapidary_plan::{Decisions, Geometry, Note, Rung, Spectrum};
use lapidary_reference::random_walk::mesh::{Boundary, Origin};
use lapidary_reference::spectral::Lost;
use lapidary_render as render;
use lapidary_render::file::{self, Format};
use lapidary_render::{Curvature, Settings, WalkedPicture};
use lapidary_scene::Scene;
use lapidary_scene::nearest::suggest;
use std::path::PathBuf;

/// Renders a scene: a built-in's name, or a .glb or .gltf file.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook render brilliant\n  ./cook render ruby --quality best --from 0,0\n  ./cook render brilliant --rung proxy-1+paper\n  ./cook render quartz --rung reference --size 256x256 --out quartz.exr\n  ./cook render my_stone.glb --size 1920x1080 --out stone.exr --environment studio.hdr"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// PNG (tone-mapped sRGB) or EXR (linear, half float); SCENE.png in this folder where left out.
    #[arg(long, value_name = "F.png|F.exr")]
    out: Option<PathBuf>,
    /// Degrees off the vertical, and from +z towards +x; the scene's own camera where left out.
    #[arg(long, value_name = "POLAR,AZIMUTH", value_parser = parse_from, allow_hyphen_values = true)]
    from: Option<(f32, f32)>,
    /// Which curvature spreads the light of what scatters it: from the pixel's derivatives mean, towards
    /// (each light) or naive (|dN| / |dP|); or vertex, the mesh's mean curvature.
    #[arg(long, value_name = "FORM", default_value = "mean", value_parser = parse_curvature)]
    curvature: Curvature,
    /// What light loses along its way through a body: this share of what scattering and absorption take; 0.18 where left out.
    #[arg(long, value_name = "SHARE", value_parser = parse_positive)]
    extinction_scale: Option<f32>,
    /// Factor of the paper's dispersion, eq. (12), for rungs +paper.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_positive)]
    strength: f32,
    /// What a ray still carries at its last hit: taken from the environment along it, or dropped.
    #[arg(long, value_name = "WAY", default_value = "environment", value_parser = ["environment", "dropped"])]
    rest: String,
    /// In units of length: a ray ends that has travelled farther inside.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    distance_limit: Option<f32>,
    /// Whether a ray inside ends when what it carries can no longer be seen; where left out, from 16 hits
    /// on, which that makes faster.
    #[arg(long, value_name = "WHETHER", value_parser = ["on", "off"])]
    throughput_limit: Option<String>,
    /// By a geometry buffer and a lighting pass, as a deferred renderer does.
    #[arg(long)]
    deferred: bool,
    /// The proxy's centre: stable, or the paper's eq. (4).
    #[arg(long, value_name = "FORM", default_value = "stable", value_parser = ["stable", "paper"])]
    centre: String,
    /// Radiance is multiplied by this before the tone curve.
    #[arg(long, default_value_t = 1.0, value_parser = parse_positive)]
    exposure: f32,
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = lapidary_scene::SAMPLES, value_parser = number::whole(1..=render::MOST_SAMPLES))]
    samples: u32,
    /// Wavelengths of the reference; 31 where left out.
    #[arg(long, value_parser = number::whole(0..=usize::MAX))]
    wavelengths: Option<usize>,
    /// Walks for each pixel that the reference of what scatters light follows; 256 where left out.
    #[arg(long, value_parser = number::whole(0..=u32::MAX))]
    walks: Option<u32>,
    /// Where those walks set out: from the lights there is less noise, but no environment.
    #[arg(long, value_name = "END", value_parser = parse_origin)]
    walks_from: Option<Origin>,
    /// Another seed gives other walks; 1 where left out.
    #[arg(long, value_parser = number::whole(0..=u64::MAX))]
    seed: Option<u64>,
    /// What surfaces do to those walks: nothing (matched), or bend and reflect light by the material's ior (dielectric).
    #[arg(long, value_parser = ["matched", "dielectric"])]
    boundary: Option<String>,
    /// The share of a camera ray's energy that the reference need not follow; 1e-4 where left out.
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    energy_bound: Option<f64>,
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

/// A flag that no object's rung obeys would be believed to have been obeyed.
fn refuse_what_is_ignored(arguments: &Arguments, scene: &Scene, settings: &Settings) -> Result<(), Failure> {
    // Of each flag: whether it is given, and whether a rung obeys it, in a scene that scatters light or not.
    type Obeys = fn(Rung, bool) -> bool;
    let follows: Obeys = |rung, scatters| rung == Rung::Reference && !scatters;
    let walks: Obeys = |rung, scatters| rung == Rung::Reference && scatters;
    let inside: Obeys = |rung, _| matches!(rung, Rung::Inside { .. });
    let flags: [(&str, bool, Obeys); 14] = [
        ("--wavelengths", arguments.wavelengths.is_some(), follows),
        ("--energy-bound", arguments.energy_bound.is_some(), follows),
        ("--walks", arguments.walks.is_some(), walks),
        ("--walks-from", arguments.walks_from.is_some(), walks),
        ("--seed", arguments.seed.is_some(), walks),
        ("--boundary", arguments.boundary.is_some(), walks),
        (
            "--curvature",
            arguments.curvature != Curvature::Mean,
            |rung, _| matches!(rung, Rung::Diffuse(of) if !of.is_lambert()),
        ),
        ("--rest dropped", arguments.rest == "dropped", inside),
        ("--distance-limit", arguments.distance_limit.is_some(), inside),
        ("--throughput-limit", arguments.throughput_limit.is_some(), inside),
        ("--deferred", arguments.deferred, |rung, _| matches!(rung, Rung::Inside { .. } | Rung::Surface)),
        ("--centre paper", arguments.centre == "paper", |rung, _| {
            matches!(rung, Rung::Inside { geometry: Geometry::Proxy, .. })
        }),
        ("--extinction-scale", arguments.extinction_scale.is_some(), |rung, _| matches!(rung, Rung::OpticalPath(_))),
        ("--strength", arguments.strength != 1.0, |rung, _| rung.spectrum() == Spectrum::Paper),
    ];
    let given: Vec<_> = flags.into_iter().filter(|(_, given, _)| *given).collect();
    // Deciding measures bodies.
    if given.is_empty() {
        return Ok(());
    }
    let scatters = render::scatters(scene);
    let rungs: Vec<Rung> =
        scene.objects.iter().map(|object| Decisions::of(object, scene, &settings.request()).rung).collect();
    match given.iter().find(|(_, _, obeys)| !rungs.iter().any(|rung| obeys(*rung, scatters))) {
        Some((flag, ..)) => {
            let rung = settings.rung;
            Err(Failure(format!("rung `{rung}` knows no {flag} here; leave it out or take another rung")))
        }
        None => Ok(()),
    }
}

/// Whether what was found before drawing is said more closely by what was found in it.
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
    refuse_what_is_ignored(arguments, &scene, &asked)?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        // Not the scene's name, which a file may give itself: it would choose where the picture goes.
        let mut name = Scene::stem(&arguments.asked.scene);
        name.push(".png");
        PathBuf::from(name)
    });
    Format::of_path(&out)?;
    file::check_writable(&out)?;
    let settings = Settings {
        paper_centre: arguments.centre == "paper",
        curvature: arguments.curvature,
        extinction_scale: arguments.extinction_scale.unwrap_or(asked.extinction_scale),
        dispersion_strength: arguments.strength,
        rest_from_environment: arguments.rest == "environment",
        distance_limit: arguments.distance_limit,
        limit_throughput: arguments.throughput_limit.as_deref().map(|whether| whether == "on"),
        deferred: arguments.deferred,
        exposure: arguments.exposure,
        samples: arguments.samples,
        wavelengths: arguments.wavelengths.unwrap_or(asked.wavelengths),
        energy_bound: arguments.energy_bound.unwrap_or(asked.energy_bound),
        walks: arguments.walks.unwrap_or(asked.walks),
        walks_from: arguments.walks_from.unwrap_or(asked.walks_from),
        seed: arguments.seed.unwrap_or(asked.seed),
        boundary: match arguments.boundary.as_deref() {
            Some("dielectric") => Boundary::Dielectric,
            _ => Boundary::Matched,
        },
        ..asked
    };
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
