//! What `cook render` and `cook plan` ask alike: a scene, and what of it is drawn how.

use super::Failure;
use lapidary_plan::{Decisions, Effect, Effects, GRAMMAR, Note, Quality, Rung, Scattering};
use lapidary_render::Settings;
use lapidary_scene as scene;
use lapidary_scene::environment_map::{Clamped, EnvironmentMap};
use lapidary_scene::nearest::suggest;
use lapidary_scene::{Environment, Scene};
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
    /// What is drawn though no material calls for it: shadow, which lights then cast on all that is drawn by its surface alone; and how
    /// what scatters light is drawn, whatever its thickness against the mean free path: cdrf or optical_path.
    #[arg(long = "with", value_name = "EFFECT", value_delimiter = ',', value_parser = [CDRF, OPTICAL_PATH, SHADOW])]
    with: Vec<String>,
    /// An effect that is left out though the scene calls for it, by the name that `cook plan` gives it.
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    without: Vec<Effect>,
    /// A latitude-longitude .exr or .hdr image; the procedural studio where left out.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
}

const CDRF: &str = "cdrf";
const OPTICAL_PATH: &str = "optical_path";
const SHADOW: &str = "shadow";

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

    fn is_with(&self, name: &str) -> bool {
        self.with.iter().any(|with| with == name)
    }

    /// The settings of what is asked, the rest as usual, and what should be known of the environment.
    pub(super) fn settings(&self, scene: &Scene) -> Result<(Settings, Vec<Note>), Failure> {
        let mut notes = Vec::new();
        let environment = match &self.environment {
            None => Environment::Studio,
            Some(path) => {
                let (map, Clamped { pixels, least }) = EnvironmentMap::load_counting(path)?;
                if pixels > 0 {
                    notes.push(Note::NegativeRadiance { file: path.display().to_string(), pixels, least });
                }
                Environment::Map(map)
            }
        };
        let scattering = match [CDRF, OPTICAL_PATH].map(|name| self.is_with(name)) {
            [true, true] => {
                return Err(Failure(format!("--with {CDRF} and {OPTICAL_PATH}: a body is drawn by one of them")));
            }
            [true, false] => Some(Scattering::Cdrf),
            [false, true] => Some(Scattering::OpticalPath),
            [false, false] => None,
        };
        let shadows = self.is_with(SHADOW);
        let (width, height) = self.size;
        let (rung, quality) = (self.rung(), self.quality.unwrap_or_default());
        if let (Some(quality), true) = (self.quality, rung != Rung::ByMaterial) {
            return Err(Failure(format!(
                "--rung {rung} names the rung of every object, so --quality {quality} has nothing to choose; leave one out"
            )));
        }
        let settings = Settings { rung, quality, scattering, shadows, environment, ..Settings::of_size(width, height) };
        self.refuse_what_is_ignored(scene, &settings)?;
        Ok((Settings { without: Effects::of(&self.without), ..settings }, notes))
    }

    /// A rung or technique that no body can be drawn by would be believed to matter. To leave out an effect that nothing calls for is to have what was
    /// wanted.
    fn refuse_what_is_ignored(&self, scene: &Scene, settings: &Settings) -> Result<(), Failure> {
        if settings.rung.is_for_clear_stones() && !scene.objects.iter().any(|object| object.material.is_clear()) {
            return Err(Failure(format!(
                "scene `{}`: rung `{}` is for clear stones, and nothing there is one: no material has a transmission; leave --rung out, or take \
                 another",
                scene.name, settings.rung
            )));
        }
        // The reference has no recipes, but can do without the environment's diffuse light.
        if settings.rung == Rung::Reference {
            if settings.shadows {
                return Err(Failure(format!("rung `reference` casts shadows anyway; leave --with {SHADOW} out")));
            }
            let others: Vec<&Effect> = self.without.iter().filter(|effect| **effect != Effect::Environment).collect();
            // What a scene calls for is what its materials do; and deciding measures bodies.
            let usual = Settings { rung: Rung::ByMaterial, ..settings.clone() };
            let calls_for = |effect: &Effect| {
                scene.objects.iter().any(|object| Decisions::of(object, scene, &usual.request()).has(*effect))
            };
            return others.into_iter().find(|effect| calls_for(effect)).map_or(Ok(()), |effect| {
                Err(Failure(format!("rung `reference` knows no --without {effect}; leave it out or take another rung")))
            });
        }
        // Deciding measures bodies.
        if settings.shadows {
            let all: Vec<Decisions> =
                scene.objects.iter().map(|object| Decisions::of(object, scene, &settings.request())).collect();
            if !all.iter().any(|decisions| decisions.has(Effect::Shadow)) {
                let decisions = all.iter().flat_map(|decisions| &decisions.effects);
                let shadow = decisions.into_iter().find(|decision| decision.effect == Effect::Shadow);
                let reason = shadow.map_or("it has no object", |decision| &decision.reason);
                return Err(Failure(format!(
                    "scene `{}` by rung `{}`: --with {SHADOW} has no meaning: {reason}; leave it out",
                    scene.name, settings.rung
                )));
            }
        }
        let scatters = scene.objects.iter().any(|object| object.material.medium.is_some());
        let technique = self.with.iter().find(|name| *name != SHADOW);
        if let Some(name) = technique.filter(|_| !scatters || settings.rung != Rung::ByMaterial) {
            let reason = if scatters { "a rung is asked for" } else { "nothing there has scattering and absorption" };
            return Err(Failure(format!(
                "scene `{}`: --with {name} has no meaning, since {reason}; leave one out",
                scene.name
            )));
        }
        Ok(())
    }
}
