//! Shared options of `cook render` and `cook frame`: the scene, its camera, exposure and samples, and
//! each technique's own.

use super::asked::{Asked, refuse_without_meaning};
use super::named::named;
use super::opened::Opened;
use super::{Failure, number, output};
use lapidary_plan::{Decisions, Effect, Geometry, Note, Outside, Quality, Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::{
    Curvature, DiffuseOptions, DiffusionOptions, GemOptions, OpticalPathOptions, Settings, ShadowForm,
};
use lapidary_scene::Scene;

#[derive(clap::Args)]
pub(super) struct Drawn {
    #[command(flatten)]
    pub(super) asked: Asked,
    /// Camera direction in degrees off the vertical, and from +z towards +x; the scene's own camera
    /// by default.
    #[arg(long, value_name = "POLAR,AZIMUTH", value_parser = parse_from, allow_hyphen_values = true, conflicts_with = "camera")]
    from: Option<(f32, f32)>,
    /// Factor on radiance before the tone curve.
    #[arg(long, default_value_t = 1.0, value_parser = parse_positive)]
    exposure: f32,
    /// What is behind the bodies: dark paper, or nothing, for a PNG with straight alpha.
    #[arg(long, default_value = "paper", value_parser = ["paper", "none"])]
    background: String,
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
    diffusion: Option<Diffusion>,
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
    /// End rays where any of their light can leave, with all of it.
    #[arg(long)]
    first_exit: bool,
    /// Draw with a geometry buffer and a lighting pass, as a deferred renderer does.
    #[arg(long)]
    deferred: bool,
    /// Smooth facets' edges inside stones from one sample per pixel, which mixes neighbours in a second
    /// pass; for the rungs walk-HITS, except with separate wavelengths. With --samples 1, on by default
    /// unless a rung or --quality fast is asked for; --without footprint leaves it out.
    #[arg(long, conflicts_with = "deferred")]
    footprint: bool,
    /// What light that leaves a stone meets: the environment alone, the bounds of a few other bodies, or
    /// other bodies as the picture shows them (screen). Bodies by default, environment with --quality
    /// fast.
    #[arg(long, value_name = "WHAT")]
    outside: Option<Outside>,
    /// How far bodies of the picture reach behind their front, for --outside screen, in units of length.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    thickness: Option<f32>,
    /// Centre of the proxy: stable (the default), or the paper's eq. (4).
    #[arg(long, value_name = "FORM", value_parser = ["stable", "paper"])]
    centre: Option<String>,
}

/// Options for scattering bodies drawn by their curvature.
#[derive(clap::Args)]
#[command(next_help_heading = "Scattering bodies by their curvature")]
struct Diffuse {
    /// Curvature that spreads the light. From the mesh: vertex, its mean curvature (the default). From
    /// the pixel's derivatives, for meshes that deform: mean, towards (towards each light) or naive
    /// (|dN| / |dP|).
    #[arg(long, value_name = "FORM", value_parser = parse_curvature)]
    curvature: Option<Curvature>,
    /// Shadows on matter that scatters: soft edges, edges of each colour's width (colors), or these and
    /// light through thin parts (through, the default). `--without translucent_shadow` leaves hard ones.
    #[arg(long, value_name = "FORM", value_parser = parse_shadows)]
    shadows: Option<ShadowForm>,
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

/// Options for bodies through which light diffuses.
#[derive(clap::Args)]
#[command(next_help_heading = "Scattering bodies by diffusion")]
struct Diffusion {
    /// Cycles of multigrid for each body; 2 by default.
    #[arg(long, value_name = "N", value_parser = number::whole(1..=MOST_CYCLES))]
    cycles: Option<u32>,
    /// Tell what is left of each body's equations after the cycles.
    #[arg(long)]
    residual: bool,
}

/// More cycles than that change nothing, even if each leaves half.
const MOST_CYCLES: u32 = 100;

/// Options that were given, and the technique that they are for.
pub(super) struct Given {
    /// The technique.
    pub(super) technique: &'static str,
    /// The options.
    pub(super) flags: Vec<&'static str>,
    /// Whether a rung draws by this technique, in a scene that scatters light or not.
    pub(super) draws: fn(Rung, bool) -> bool,
}

/// The options that were given of these.
pub(super) fn given<const COUNT: usize>(flags: [(&'static str, bool); COUNT]) -> Vec<&'static str> {
    flags.into_iter().filter(|(_, is_given)| *is_given).map(|(flag, _)| flag).collect()
}

fn parse_from(text: &str) -> Result<(f32, f32), String> {
    let number = |text: &str| text.trim().parse::<f32>().ok().filter(|angle| angle.is_finite());
    let parsed = text.split_once(',').and_then(|(polar, azimuth)| Some((number(polar)?, number(azimuth)?)));
    parsed.ok_or_else(|| "expected two angles in degrees, such as 20,11".to_owned())
}

fn parse_curvature(text: &str) -> Result<Curvature, String> {
    named("curvature", text, Curvature::ALL, Curvature::name)
}

fn parse_shadows(text: &str) -> Result<ShadowForm, String> {
    named("form of shadows", text, ShadowForm::ALL, ShadowForm::name)
}

fn parse_positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(exposure) if exposure.is_finite() && exposure > 0.0 => Ok(exposure),
        _ => Err("expected a number above 0".to_owned()),
    }
}

impl Gem {
    fn options(&self) -> GemOptions {
        let usual = GemOptions::default();
        GemOptions {
            paper_centre: self.centre.as_deref() == Some("paper"),
            dispersion_strength: self.strength.unwrap_or(usual.dispersion_strength),
            rest_from_environment: self.rest.as_deref() != Some("dropped"),
            end_at_first_exit: self.first_exit,
            distance_limit: self.distance_limit,
            limit_throughput: self.throughput_limit.as_deref().map(|whether| whether == "on"),
            deferred: self.deferred,
            footprint: self.footprint,
            outside: self.outside,
            thickness: self.thickness,
            ..usual
        }
    }

    fn given(&self) -> [Given; 4] {
        let centre = self.centre.as_deref() == Some("paper");
        let strength = self.strength.is_some();
        let inside = || {
            given([
                ("--strength", strength),
                ("--rest", self.rest.is_some()),
                ("--distance-limit", self.distance_limit.is_some()),
                ("--first-exit", self.first_exit),
                ("--throughput-limit", self.throughput_limit.is_some()),
                ("--centre paper", centre),
            ])
        };
        let around = given([
            ("--deferred", self.deferred),
            ("--footprint", self.footprint),
            ("--outside", self.outside.is_some()),
            ("--thickness", self.thickness.is_some()),
        ]);
        let all = [inside(), around].concat();
        [
            Given {
                technique: "the gem recipes",
                flags: all,
                draws: |rung, _| matches!(rung, Rung::Inside { .. } | Rung::Surface),
            },
            Given {
                technique: "rays inside clear stones",
                flags: inside(),
                draws: |rung, _| matches!(rung, Rung::Inside { .. }),
            },
            Given {
                technique: "the proxy",
                flags: given([("--centre paper", centre)]),
                draws: |rung, _| matches!(rung, Rung::Inside { geometry: Geometry::Proxy, .. }),
            },
            Given {
                technique: "the paper's dispersion",
                flags: given([("--strength", strength)]),
                draws: |rung, _| rung.spectrum() == Spectrum::Paper,
            },
        ]
    }
}

impl Drawn {
    /// Opens the scene, and makes the settings and the environment's warnings. `others` are further
    /// options that were given.
    pub(super) fn open(&self, others: Vec<Given>) -> Result<(Scene, Settings, Vec<Note>), Failure> {
        let mut opened = self.asked.open()?;
        if let Some((polar, azimuth)) = self.from {
            opened.scene = opened.scene.seen_from(polar, azimuth);
        }
        let (asked, more) = self.asked.settings(&opened)?;
        let Opened { scene, mut notes, .. } = opened;
        notes.extend(more);
        let curvature = self.diffuse.as_ref().and_then(|options| options.curvature);
        let shadows = self.diffuse.as_ref().and_then(|options| options.shadows);
        let extinction_scale = self.optical_path.as_ref().and_then(|options| options.extinction_scale);
        let settings = Settings {
            exposure: self.exposure,
            backdrop: self.background != "none",
            samples: self.samples,
            gem: self.gem.as_ref().map_or(asked.gem, Gem::options),
            diffuse: DiffuseOptions {
                curvature: curvature.unwrap_or(asked.diffuse.curvature),
                shadows: shadows.unwrap_or(asked.diffuse.shadows),
                ..asked.diffuse
            },
            diffusion: self.diffusion.as_ref().map_or(asked.diffusion, |options| DiffusionOptions {
                cycles: options.cycles.unwrap_or(asked.diffusion.cycles),
                most_cycles: options.cycles.unwrap_or(asked.diffusion.most_cycles),
                residual: options.residual,
                ..asked.diffusion
            }),
            optical_path: extinction_scale
                .map_or(asked.optical_path, |extinction_scale| OpticalPathOptions { extinction_scale }),
            ..asked
        };
        let techniques = [
            Given {
                technique: "curvature",
                flags: given([("--curvature", curvature.is_some())]),
                draws: |rung, _| matches!(rung, Rung::Diffuse(reflectance) if !reflectance.is_lambert()),
            },
            Given {
                technique: "optical paths",
                flags: given([("--extinction-scale", extinction_scale.is_some())]),
                draws: |rung, _| matches!(rung, Rung::OpticalPath(_)),
            },
            Given {
                technique: "diffusion",
                flags: self.diffusion.as_ref().map_or_else(Vec::new, |options| {
                    given([("--cycles", options.cycles.is_some()), ("--residual", options.residual)])
                }),
                draws: |rung, _| matches!(rung, Rung::Diffusion(_)),
            },
        ];
        if shadows.is_some() {
            refuse_without_meaning(&scene, &settings, Effect::TranslucentShadow, "--shadows")?;
        }
        let gem = self.gem.iter().flat_map(Gem::given);
        refuse_what_is_ignored(gem.chain(techniques).chain(others), &scene, &settings)?;
        if let Some(outside) = settings.gem.outside
            && let Some(effect) = outside.effect()
            && !settings.without.has(effect)
        {
            refuse_without_meaning(&scene, &settings, effect, &format!("--outside {outside}"))?;
        }
        if settings.gem.thickness.is_some() && settings.gem.outside != Some(Outside::Screen) {
            return Err(Failure("--thickness is for --outside screen; add that, or leave --thickness out".to_owned()));
        }
        let settings = smoothed_at_one_sample(&scene, settings);
        Ok((scene, settings, notes))
    }
}

/// Smooths facets' edges where one sample per pixel is all there is, unless a rung is named, or the
/// quality is fast: docs/gem_ladder.md.
fn smoothed_at_one_sample(scene: &Scene, settings: Settings) -> Settings {
    let is_chosen = settings.rung == Rung::ByMaterial && settings.rungs.is_empty() && settings.quality != Quality::Fast;
    if settings.samples > 1 || !is_chosen || settings.gem.deferred {
        return settings;
    }
    let smooth = Settings { gem: GemOptions { footprint: true, ..settings.gem }, ..settings.clone() };
    let all = Decisions::all(scene, &smooth.request());
    if all.iter().any(|decisions| decisions.has(Effect::Footprint)) { smooth } else { settings }
}

/// Refuses options of techniques that draw no object: they would be believed to have been obeyed.
fn refuse_what_is_ignored(
    given: impl Iterator<Item = Given>,
    scene: &Scene,
    settings: &Settings,
) -> Result<(), Failure> {
    let given: Vec<Given> = given.filter(|given| !given.flags.is_empty()).collect();
    // Deciding measures bodies.
    if given.is_empty() {
        return Ok(());
    }
    let scatters = render::scatters(scene);
    let rungs: Vec<Rung> =
        Decisions::all(scene, &settings.request()).into_iter().map(|decisions| decisions.rung).collect();
    match given.iter().find(|given| !rungs.iter().any(|rung| (given.draws)(*rung, scatters))) {
        Some(Given { technique, flags, .. }) => Err(Failure(format!(
            "scene `{}` by rung `{}`: {} {} no meaning, since nothing there is drawn by {technique}; leave {} out or take another rung",
            scene.name,
            settings.rung,
            flags.join(", "),
            if flags.len() == 1 { "has" } else { "have" },
            if flags.len() == 1 { "it" } else { "them" },
        ))),
        None => Ok(()),
    }
}

/// Returns what a plan warns of.
pub(super) fn planned(scene: &Scene, settings: &Settings) -> Vec<Note> {
    let decisions = Decisions::all(scene, &settings.request());
    lapidary_plan::notes(scene, &settings.request(), &decisions.iter().collect::<Vec<_>>())
}

/// Most lines of warnings: with the command's own output they fit on a screen.
const MOST_LINES: usize = 20;

/// Prints warnings on stderr, the gravest first, and what of the scene's file is not drawn.
pub(super) fn tell(notes: &[Note], lacking: &[String]) {
    for line in said(notes, lacking) {
        output::remark(&line);
    }
}

/// Returns the lines of warnings. Of too many the last are counted.
fn said(notes: &[Note], lacking: &[String]) -> Vec<String> {
    let mut notes: Vec<&Note> = notes.iter().collect();
    notes.sort_by_key(|note| note.gravity());
    let lacking = lacking.iter().map(|lacking| format!("not drawn, though the file asks for it: {lacking}"));
    let mut lines: Vec<String> = notes.into_iter().map(ToString::to_string).chain(lacking).collect();
    if lines.len() > MOST_LINES {
        let more = lines.len() - (MOST_LINES - 1);
        lines.truncate(MOST_LINES - 1);
        lines.push(format!("and {more} warnings more; `cook plan` lists all"));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gravest_come_first_and_all_fit_on_a_screen() {
        let negative = |pixels| Note::NegativeRadiance { file: "sky.exr".to_owned(), pixels, least: -1.0 };
        let few = said(&[negative(1), Note::NothingInView], &["skins".to_owned()]);
        assert!(few.len() == 3 && few[0].starts_with("nothing is in view") && few[2].ends_with("skins"), "{few:?}");
        let notes: Vec<Note> = (0..30).map(negative).chain([Note::NothingInView]).collect();
        let many = said(&notes, &vec!["skins".to_owned(); 9]);
        assert!(many.len() == MOST_LINES && many[0].starts_with("nothing is in view"), "{many:?}");
        assert_eq!(many[MOST_LINES - 1], "and 21 warnings more; `cook plan` lists all");
    }
}
