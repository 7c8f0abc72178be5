//! What `cook render` and `cook plan` ask alike: a scene, and what of it is drawn how.

use super::Failure;
use lapidary_harness::nearest::suggest;
use lapidary_harness::plan::{Decisions, Effect, Effects, Quality, Scattering};
use lapidary_harness::render::{Environment, GRAMMAR, Rung, Settings};
use lapidary_harness::scene::environment_map::EnvironmentMap;
use lapidary_harness::scene::{self, Scene};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Asked {
    #[arg(help = format!("{}, or a glTF 2.0 file", scene::names()))]
    pub(super) scene: String,
    /// In pixels.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = parse_size)]
    pub(super) size: (u32, u32),
    #[arg(
        long,
        value_parser = |text: &str| text.parse::<Rung>(),
        help = format!("How much of the light's way is followed: {GRAMMAR}. Where left out, by-material: each object as `cook plan` explains")
    )]
    rung: Option<Rung>,
    /// How much time each object's technique may take: fast, good or best. The ladders' pages name the rungs; `cook plan` says which one
    /// and how far off it is. Good where left out.
    #[arg(long, value_name = "QUALITY", value_parser = parse_quality)]
    quality: Option<Quality>,
    /// How what scatters light is drawn, whatever its thickness against the mean free path: cdrf or optical_path.
    #[arg(long = "with", value_name = "EFFECT", value_parser = ["cdrf", "optical_path"])]
    scattering: Option<String>,
    /// An effect that is left out though the scene calls for it, by the name that `cook plan` gives it.
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    without: Vec<Effect>,
    /// A latitude-longitude .exr or .hdr image; the procedural studio where left out.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten();
    let parsed = text.split_once('x').and_then(|(width, height)| Some((digits(width)?, digits(height)?)));
    parsed.ok_or_else(|| "expected WIDTHxHEIGHT in pixels, such as 512x512".to_owned())
}

fn parse_quality(text: &str) -> Result<Quality, String> {
    let names = Quality::ALL.map(Quality::name);
    let found = Quality::ALL.into_iter().find(|quality| quality.name() == text);
    found.ok_or_else(|| format!("no such quality{}", suggest(text, &names)))
}

impl Asked {
    /// The rung that was asked for, else each material's own.
    pub(super) fn rung(&self) -> Rung {
        self.rung.unwrap_or(Rung::ByMaterial)
    }

    /// The settings of what is asked, the rest as usual.
    pub(super) fn settings(&self, scene: &Scene) -> Result<Settings, Failure> {
        let environment = match &self.environment {
            None => Environment::Studio,
            Some(path) => Environment::Map(EnvironmentMap::load(path)?),
        };
        let scattering = match self.scattering.as_deref() {
            Some("cdrf") => Some(Scattering::Cdrf),
            Some(_) => Some(Scattering::OpticalPath),
            None => None,
        };
        let (width, height) = self.size;
        let (rung, quality) = (self.rung(), self.quality.unwrap_or_default());
        if let (Some(quality), true) = (self.quality, rung != Rung::ByMaterial) {
            return Err(Failure(format!(
                "--rung {rung} names the rung of every object, so --quality {quality} has nothing to choose; leave one out"
            )));
        }
        let settings = Settings { rung, quality, scattering, environment, ..Settings::of_size(width, height) };
        self.refuse_what_is_ignored(scene, &settings)?;
        Ok(Settings { without: Effects::of(&self.without), ..settings })
    }

    /// An effect that is left out where nothing has it, and a technique for what scatters light where nothing does, would be believed to matter.
    fn refuse_what_is_ignored(&self, scene: &Scene, settings: &Settings) -> Result<(), Failure> {
        // The reference has no recipes, but can do without the environment's diffuse light.
        if settings.rung == Rung::Reference {
            let other = self.without.iter().find(|effect| **effect != Effect::Environment);
            return other.map_or(Ok(()), |effect| {
                Err(Failure(format!("rung `reference` knows no --without {effect}; leave it out or take another rung")))
            });
        }
        // Deciding measures bodies.
        if self.without.is_empty() && self.scattering.is_none() {
            return Ok(());
        }
        let all: Vec<Decisions> = scene.objects.iter().map(|object| Decisions::of(object, scene, settings)).collect();
        let is_called = |effect: &Effect| all.iter().any(|decisions| decisions.has(*effect));
        if let Some(effect) = self.without.iter().find(|effect| !is_called(effect)) {
            return Err(Failure(format!(
                "nothing in scene `{}` calls for {effect} by rung `{}`, so --without {effect} has no meaning; leave it out",
                scene.name, settings.rung
            )));
        }
        let scatters = scene.objects.iter().any(|object| object.material.medium.is_some());
        if let Some(name) = self.scattering.as_ref().filter(|_| !scatters || settings.rung != Rung::ByMaterial) {
            let reason = if scatters { "a rung is asked for" } else { "nothing there has scattering and absorption" };
            return Err(Failure(format!(
                "scene `{}`: --with {name} has no meaning, since {reason}; leave one out",
                scene.name
            )));
        }
        Ok(())
    }
}
