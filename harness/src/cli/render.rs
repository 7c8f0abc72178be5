//! `cook render`.

use super::{Context, Failure, Outcome, output, progress};
use lapidary_harness::cookbook;
use lapidary_harness::nearest::suggest;
use lapidary_harness::random_walk::mesh::{Boundary, Origin};
use lapidary_harness::reference::Lost;
use lapidary_harness::render::file::{self, Format};
use lapidary_harness::render::{
    self, Curvature, Environment, GRAMMAR, Geometry, Reflectance, Rung, Settings, Spectrum, WalkedPicture,
};
use lapidary_harness::scene::environment_map::EnvironmentMap;
use lapidary_harness::scene::{self, Scene};
use std::path::PathBuf;

/// Renders a scene: a built-in's name, or a .glb or .gltf file.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook render brilliant\n  ./cook render ruby --rung convex-8+tracker --from 0,0\n  ./cook render quartz --rung reference --size 256x256 --out quartz.exr\n  ./cook render my_stone.glb --size 1920x1080 --out stone.exr --environment studio.hdr"
)]
pub(super) struct Arguments {
    #[arg(help = format!("{}, or a glTF 2.0 file", scene::names()))]
    scene: String,
    /// In pixels.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = parse_size)]
    size: (u32, u32),
    /// PNG (tone-mapped sRGB) or EXR (linear, half float); SCENE.png where left out.
    #[arg(long, value_name = "F.png|F.exr")]
    out: Option<PathBuf>,
    #[arg(
        long,
        value_parser = |text: &str| text.parse::<Rung>(),
        help = format!("How much of the light's way is followed: {GRAMMAR}. Where left out: proxy-4+tracker, accurate or godunov-64, by what the materials say")
    )]
    rung: Option<Rung>,
    /// Degrees off the vertical, and from +z towards +x; the scene's own camera where left out.
    #[arg(long, value_name = "POLAR,AZIMUTH", value_parser = parse_from, allow_hyphen_values = true)]
    from: Option<(f32, f32)>,
    /// An effect that is left out though the scene calls for it: absorption in clear stones; environment (its light) or reflection (the
    /// surface's) on what scatters light.
    #[arg(long, value_name = "EFFECT", value_delimiter = ',', value_parser = ["absorption", "environment", "reflection"])]
    without: Vec<String>,
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
    /// A latitude-longitude .exr or .hdr image; the procedural studio where left out.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Radiance is multiplied by this before the tone curve.
    #[arg(long, default_value_t = 1.0, value_parser = parse_positive)]
    exposure: f32,
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = render::SAMPLES, value_parser = clap::value_parser!(u32).range(1..=4))]
    samples: u32,
    /// Wavelengths of the reference; 31 where left out.
    #[arg(long)]
    wavelengths: Option<usize>,
    /// Walks for each pixel that the reference of what scatters light follows; 256 where left out.
    #[arg(long)]
    walks: Option<u32>,
    /// Where those walks set out: from the lights there is less noise, but no environment.
    #[arg(long, value_name = "END", value_parser = parse_origin)]
    walks_from: Option<Origin>,
    /// Another seed gives other walks; 1 where left out.
    #[arg(long)]
    seed: Option<u64>,
    /// What surfaces do to those walks: nothing (matched), or bend and reflect light by the material's ior (dielectric).
    #[arg(long, value_parser = ["matched", "dielectric"])]
    boundary: Option<String>,
    /// The share of a camera ray's energy that the reference need not follow; 1e-4 where left out.
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    energy_bound: Option<f64>,
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten();
    let parsed = text.split_once('x').and_then(|(width, height)| Some((digits(width)?, digits(height)?)));
    parsed.ok_or_else(|| "expected WIDTHxHEIGHT in pixels, such as 512x512".to_owned())
}

fn parse_from(text: &str) -> Result<(f32, f32), String> {
    let number = |text: &str| text.trim().parse::<f32>().ok().filter(|angle| angle.is_finite());
    let parsed = text.split_once(',').and_then(|(polar, azimuth)| Some((number(polar)?, number(azimuth)?)));
    parsed.ok_or_else(|| "expected two angles in degrees, such as 20,11".to_owned())
}

fn parse_curvature(text: &str) -> Result<Curvature, String> {
    let names = Curvature::ALL.map(Curvature::name);
    let found = Curvature::ALL.into_iter().find(|curvature| curvature.name() == text);
    found.ok_or_else(|| format!("no such curvature{}; there is {}", suggest(text, &names), names.join(", ")))
}

fn parse_origin(text: &str) -> Result<Origin, String> {
    let names = Origin::ALL.map(Origin::name);
    let found = Origin::ALL.into_iter().find(|origin| origin.name() == text);
    found.ok_or_else(|| format!("no such end of a walk{}; there is {}", suggest(text, &names), names.join(" and ")))
}

fn parse_positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(exposure) if exposure.is_finite() && exposure > 0.0 => Ok(exposure),
        _ => Err("expected a number above 0".to_owned()),
    }
}

/// A flag that the rung does not obey would be believed to have been obeyed.
fn refuse_what_is_ignored(arguments: &Arguments, rung: Rung, scatters: bool) -> Result<(), Failure> {
    let reference = rung == Rung::Reference;
    let proxy = matches!(rung, Rung::Inside { geometry: Geometry::Proxy, .. });
    // Nothing of the recipes' way inside.
    let outside = reference || rung == Rung::Surface;
    let diffuse = matches!(rung, Rung::Diffuse(_));
    let paths = matches!(rung, Rung::OpticalPath(_));
    let scattered = diffuse || paths;
    let blurs = diffuse && rung != Rung::Diffuse(Reflectance::Lambert);
    let without = |effect: &str| arguments.without.iter().any(|left_out| left_out == effect);
    let ignored = [
        ("--wavelengths", (!reference || scatters) && arguments.wavelengths.is_some()),
        ("--energy-bound", (!reference || scatters) && arguments.energy_bound.is_some()),
        ("--walks", !(reference && scatters) && arguments.walks.is_some()),
        ("--walks-from", !(reference && scatters) && arguments.walks_from.is_some()),
        ("--seed", !(reference && scatters) && arguments.seed.is_some()),
        ("--boundary", !(reference && scatters) && arguments.boundary.is_some()),
        ("--without absorption", (outside || scattered) && without("absorption")),
        ("--without environment", !(scattered || reference && scatters) && without("environment")),
        ("--without reflection", !scattered && without("reflection")),
        ("--curvature", !blurs && arguments.curvature != Curvature::Mean),
        ("--rest dropped", (outside || scattered) && arguments.rest == "dropped"),
        ("--distance-limit", (outside || scattered) && arguments.distance_limit.is_some()),
        ("--throughput-limit", (outside || scattered) && arguments.throughput_limit.is_some()),
        ("--deferred", (reference || scattered) && arguments.deferred),
        ("--centre paper", !proxy && arguments.centre == "paper"),
        ("--extinction-scale", !paths && arguments.extinction_scale.is_some()),
        ("--strength", rung.spectrum() != Spectrum::Paper && arguments.strength != 1.0),
    ];
    match ignored.iter().find(|(_, ignored)| *ignored) {
        Some((flag, _)) => Err(Failure(format!("rung `{rung}` knows no {flag}; leave it out or take another rung"))),
        None => Ok(()),
    }
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut scene = Scene::open(&arguments.scene)?;
    if let Some((polar, azimuth)) = arguments.from {
        scene = scene.seen_from(polar, azimuth);
    }
    let rung = arguments.rung.unwrap_or_else(|| Rung::usual(&scene));
    refuse_what_is_ignored(arguments, rung, render::scatters(&scene))?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.png", scene.name)));
    Format::of_path(&out)?;
    file::check_writable(&out)?;
    let environment = match &arguments.environment {
        None => Environment::Studio,
        Some(path) => Environment::Map(EnvironmentMap::load(path)?),
    };
    let (width, height) = arguments.size;
    let usual = Settings::of_size(width, height);
    let without = |effect: &str| arguments.without.iter().any(|left_out| left_out == effect);
    let settings = Settings {
        rung,
        paper_centre: arguments.centre == "paper",
        absorption: !without("absorption"),
        light_from_environment: !without("environment"),
        reflection: !without("reflection"),
        curvature: arguments.curvature,
        extinction_scale: arguments.extinction_scale.unwrap_or(usual.extinction_scale),
        dispersion_strength: arguments.strength,
        rest_from_environment: arguments.rest == "environment",
        distance_limit: arguments.distance_limit,
        limit_throughput: arguments.throughput_limit.as_deref().map(|whether| whether == "on"),
        deferred: arguments.deferred,
        environment,
        exposure: arguments.exposure,
        samples: arguments.samples,
        wavelengths: arguments.wavelengths.unwrap_or(usual.wavelengths),
        energy_bound: arguments.energy_bound.unwrap_or(usual.energy_bound),
        walks: arguments.walks.unwrap_or(usual.walks),
        walks_from: arguments.walks_from.unwrap_or(usual.walks_from),
        seed: arguments.seed.unwrap_or(usual.seed),
        boundary: match arguments.boundary.as_deref() {
            Some("dielectric") => Boundary::Dielectric,
            _ => Boundary::Matched,
        },
        ..usual
    };
    let source = cookbook::recipe_source(rung.recipe());
    let bar = progress::bar(0, "rendering");
    let picture = render::render_with(context.gpu()?, &scene, &settings, &source, &mut |done, total| {
        bar.set_length(total);
        bar.set_position(done);
    })?;
    bar.finish_and_clear();
    file::write(&picture, &out)?;
    for note in &picture.notes {
        eprintln!("cook: {note}");
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
