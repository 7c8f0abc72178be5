//! Arguments shared by `cook render` and `cook plan`: a scene, and how its objects are drawn.

use super::Failure;
use super::environment::EnvironmentAsked;
use super::named::named;
use super::opened::{Opened, distinct, refuse_twice};
use lapidary_files::nearest;
use lapidary_plan::{Decisions, Effect, Effects, GRAMMAR, Note, Quality, Rung, Scattering};
use lapidary_render::Settings;
use lapidary_scene as scene;
use lapidary_scene::normals::Normals;
use lapidary_scene::{Object, PRESETS, Preset, Scene};
use std::path::{Path, PathBuf};

#[derive(clap::Args, Default)]
pub(super) struct Asked {
    #[arg(help = format!("{}, or a glTF 2.0 file", scene::names()))]
    pub(super) scene: String,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = parse_size)]
    pub(super) size: (u32, u32),
    #[arg(
        long,
        value_name = "[NODE=]RUNG",
        value_parser = parse_rung,
        help = format!("How much of the light's way is followed, for all objects or one node's, and several times for several: {GRAMMAR}. Where left out, by-material: each object as `cook plan` explains")
    )]
    pub(super) rung: Vec<(Option<String>, Rung)>,
    /// Material in place of the scene's, fitted to the body's size: of all bodies, or of those that WHICH names: their node, their
    /// material, the number of one without a name, or a pattern of either name, with * and ?, such as 'Gem*=diamond'. Several times for
    /// several. `cook list --materials` names them.
    #[arg(long, value_name = "[WHICH=]PRESET", value_parser = parse_material)]
    pub(super) material: Vec<(Option<String>, &'static Preset)>,
    /// Give bodies that look like stones or metals, and are not marked so, the preset of what they look like: by their names, in
    /// several languages, and by their shapes. Each choice is said. Bodies that --material names keep what it gives.
    #[arg(long)]
    pub(super) jewellery: bool,
    /// Draw the clear stones of a file with its very triangles: neither mended, parted, joined nor given exact facets.
    #[arg(long)]
    pub(super) as_modelled: bool,
    /// Time budget of each object's technique: fast, good or best; good by default. The ladders'
    /// pages name the rungs; `cook plan` shows the chosen rung and its error.
    #[arg(long, value_name = "QUALITY", value_parser = parse_quality)]
    pub(super) quality: Option<Quality>,
    /// Which normals refract in clear bodies: those of the file, between a triangle's corners, or those of
    /// the facets. The file's by default, unless its facets are those of a cut stone.
    #[arg(long, value_name = "WHICH", value_parser = parse_normals)]
    pub(super) normals: Option<Normals>,
    /// Draw effects that a named rung leaves out. shadow: lights cast shadows on everything that is
    /// drawn by its surface alone. half_space: scattering bodies follow the law of a half space. light:
    /// clear bodies show the discs of lights. cdrf, optical_path, diffusion: draw all scattering materials by this
    /// technique, whatever their thickness relative to the mean free path.
    #[arg(long = "with", value_name = "EFFECT", value_delimiter = ',', value_parser = [CDRF, OPTICAL_PATH, DIFFUSION, SHADOW, HALF_SPACE, LIGHT])]
    pub(super) with: Vec<String>,
    /// Leave out an effect that the scene calls for, by its name in `cook plan`.
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    pub(super) without: Vec<Effect>,
    /// Light from far away: studio, jeweller (softboxes, black flags and small bright lights), or a latitude-longitude .exr or
    /// .hdr image; by default the scene's own, which is the studio unless it names another.
    #[arg(long, value_name = "NAME|FILE", value_parser = EnvironmentAsked::parser())]
    pub(super) environment: Option<EnvironmentAsked>,
    /// Camera of the file: its name, its node's name, or its number; the first one by default.
    #[arg(long, value_name = "NAME|N")]
    pub(super) camera: Option<String>,
    /// Time of the file's animations in seconds; without it, bodies are at rest.
    #[arg(long, value_name = "SECONDS", value_parser = parse_time)]
    pub(super) time: Option<f32>,
}

const CDRF: &str = "cdrf";
const OPTICAL_PATH: &str = "optical_path";
const DIFFUSION: &str = "diffusion";
const SHADOW: &str = "shadow";
const HALF_SPACE: &str = "half_space";
const LIGHT: &str = "light";

pub(super) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten();
    // One number is a square's.
    let (width, height) = text.split_once('x').unwrap_or((text, text));
    let parsed = digits(width).zip(digits(height));
    parsed.ok_or_else(|| "expected WIDTHxHEIGHT in pixels, such as 512x512, or a square's side".to_owned())
}

fn parse_time(text: &str) -> Result<f32, String> {
    let time = text.parse::<f32>().ok().filter(|time| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| "expected seconds of at least 0, such as 1.5".to_owned())
}

pub(super) fn parse_quality(text: &str) -> Result<Quality, String> {
    named("quality", text, Quality::ALL, Quality::name)
}

fn parse_rung(text: &str) -> Result<(Option<String>, Rung), String> {
    let (node, rung) = of_node(text);
    Ok((node, rung.parse()?))
}

fn parse_material(text: &str) -> Result<(Option<String>, &'static Preset), String> {
    let (node, name) = of_node(text);
    Ok((node, named("material", name, &PRESETS, |preset| preset.name)?))
}

/// Splits NODE=VALUE; a value holds no `=`, and a node's name may.
fn of_node(text: &str) -> (Option<String>, &str) {
    text.rsplit_once('=').map_or((None, text), |(node, value)| (Some(node.to_owned()), value))
}

impl Asked {
    /// Returns the files that are read.
    pub(super) fn inputs(&self) -> Vec<PathBuf> {
        let mut files = Scene::sources(&self.scene);
        files.extend(self.environment.iter().filter_map(EnvironmentAsked::file).map(Path::to_path_buf));
        files
    }

    /// Returns the rung that was asked for all objects, or each material's own by default, and those of
    /// single ones.
    fn rungs(&self, Opened { scene, nodes, .. }: &Opened) -> Result<(Rung, Vec<(String, Rung)>), Failure> {
        refuse_twice("--rung", self.rung.iter().map(|(node, _)| node.as_deref()))?;
        let mut all = None;
        let mut single: Vec<(String, Rung)> = Vec::new();
        for (node, rung) in &self.rung {
            let Some(node) = node else {
                all = Some(*rung);
                continue;
            };
            // A node may have become several bodies.
            let is_of = |number: usize| nodes[number] == *node || scene.objects[number].name == *node;
            let of_node: Vec<&Object> = scene
                .objects
                .iter()
                .enumerate()
                .filter(|(number, _)| is_of(*number))
                .map(|(_, object)| object)
                .collect();
            if of_node.is_empty() {
                let known = distinct(nodes.iter().chain(scene.objects.iter().map(|object| &object.name)));
                let (scene, near) = (&scene.name, nearest::suggest(node, &known));
                return Err(Failure(format!("scene `{scene}` has no node `{node}` for --rung{near}")));
            }
            if *rung == Rung::Reference {
                return Err(Failure(format!(
                    "--rung {node}={rung}: the reference draws a whole scene; leave `{node}=` out, or take another rung"
                )));
            }
            // Nodes may share a name; a note tells of those that the rung is not for.
            if rung.is_for_clear_stones() && of_node.iter().all(|object| !object.material.is_clear()) {
                let material = of_node.first().map_or("", |object| &object.material.name);
                return Err(Failure(format!(
                    "--rung {node}={rung}: the rung is for clear stones, and `{node}` is of {material}; take another"
                )));
            }
            let names = distinct(of_node.into_iter().map(|object| &object.name));
            single.extend(names.into_iter().map(|name| (name.to_owned(), *rung)));
        }
        if let (Some(Rung::Reference), Some((node, rung))) = (all, single.first()) {
            return Err(Failure(format!("--rung {node}={rung}: the reference draws the whole scene; leave one out")));
        }
        Ok((all.unwrap_or(Rung::ByMaterial), single))
    }

    fn is_with(&self, name: &str) -> bool {
        self.with.iter().any(|with| with == name)
    }

    /// Returns the settings for these arguments, with defaults for the rest, and notes on the
    /// environment.
    pub(super) fn settings(&self, opened: &Opened) -> Result<(Settings, Vec<Note>), Failure> {
        let scene = &opened.scene;
        let (environment, negative) = match &self.environment {
            None => (scene.environment.make(), None),
            Some(asked) => asked.make()?,
        };
        let techniques =
            [(CDRF, Scattering::Cdrf), (OPTICAL_PATH, Scattering::OpticalPath), (DIFFUSION, Scattering::Diffusion)];
        let mut asked = techniques.into_iter().filter(|(name, _)| self.is_with(name));
        let scattering = match (asked.next(), asked.next()) {
            (Some((one, _)), Some((other, _))) => {
                return Err(Failure(format!("--with {one} and {other}: a body is drawn by one of them")));
            }
            (one, _) => one.map(|(_, scattering)| scattering),
        };
        let (shadows, half_space) = (self.is_with(SHADOW), self.is_with(HALF_SPACE));
        let lights = self.is_with(LIGHT);
        let (width, height) = self.size;
        let (rung, rungs) = self.rungs(opened)?;
        let quality = self.quality.unwrap_or_default();
        let is_named = |object: &Object| rungs.iter().any(|(name, _)| *name == object.name);
        let all_are_named = !rungs.is_empty() && scene.objects.iter().all(is_named);
        if let (Some(quality), true) = (self.quality, rung != Rung::ByMaterial || all_are_named) {
            let rung = if rung == Rung::ByMaterial { String::new() } else { format!(" {rung}") };
            return Err(Failure(format!(
                "--rung{rung} names the rung of every object, so --quality {quality} has nothing to choose; leave one out"
            )));
        }
        let settings = Settings {
            rung,
            rungs,
            quality,
            scattering,
            shadows,
            half_space,
            lights,
            environment,
            ..Settings::of_size(width, height)
        };
        self.refuse_what_is_ignored(scene, &settings)?;
        Ok((Settings { without: Effects::of(&self.without), ..settings }, negative.into_iter().collect()))
    }

    /// Refuses a rung or technique that cannot draw any body: the user would believe that it
    /// matters. Leaving out an effect that nothing calls for is accepted, since the result is what
    /// was wanted.
    fn refuse_what_is_ignored(&self, scene: &Scene, settings: &Settings) -> Result<(), Failure> {
        if settings.rung.is_for_clear_stones() && !scene.objects.iter().any(|object| object.material.is_clear()) {
            return Err(Failure(format!(
                "scene `{}`: rung `{}` is for clear stones, and nothing there is one: no material has a transmission; leave --rung out, or take \
                 another",
                scene.name, settings.rung
            )));
        }
        // The reference has no recipes, but can leave out the environment's diffuse light.
        if settings.rung == Rung::Reference {
            if settings.shadows {
                return Err(Failure(format!(
                    "rung `reference` knows no --with {SHADOW}: what scatters light, alone in a scene, has shadows there anyway, and what is \
                     matte has none; leave it out"
                )));
            }
            let others: Vec<&Effect> =
                self.without.iter().filter(|effect| ![Effect::Environment, Effect::Light].contains(effect)).collect();
            // A scene's materials decide what it calls for. Evaluated lazily, because deciding
            // measures bodies.
            let usual = Settings { rung: Rung::ByMaterial, ..settings.clone() };
            let calls_for = |effect: &Effect| {
                scene.objects.iter().any(|object| Decisions::of(object, scene, &usual.request()).has(*effect))
            };
            return others.into_iter().find(|effect| calls_for(effect)).map_or(Ok(()), |effect| {
                Err(Failure(format!("rung `reference` knows no --without {effect}; leave it out or take another rung")))
            });
        }
        if settings.shadows {
            refuse_without_meaning(scene, settings, Effect::Shadow, &format!("--with {SHADOW}"))?;
        }
        if settings.half_space {
            refuse_without_meaning(scene, settings, Effect::HalfSpace, &format!("--with {HALF_SPACE}"))?;
        }
        if settings.lights {
            refuse_without_meaning(scene, settings, Effect::Light, &format!("--with {LIGHT}"))?;
        }
        let scatters = scene.objects.iter().any(|object| object.material.medium.is_some());
        let is_open = |object: &Object| {
            object.material.medium.is_some() && settings.request().rung_of(object) == Rung::ByMaterial
        };
        let technique = self.with.iter().find(|name| ![SHADOW, HALF_SPACE, LIGHT].contains(&name.as_str()));
        if let Some(name) = technique.filter(|_| !scene.objects.iter().any(is_open)) {
            let reason = if scatters { "a rung is asked for" } else { "nothing there has scattering and absorption" };
            return Err(Failure(format!(
                "scene `{}`: --with {name} has no meaning, since {reason}; leave one out",
                scene.name
            )));
        }
        Ok(())
    }
}

fn parse_normals(text: &str) -> Result<Normals, String> {
    Normals::named(text).ok_or_else(|| "expected file or facets".to_owned())
}

/// Refuses an option that asks for an effect which no object has. Call it only if needed, because
/// deciding measures bodies.
pub(super) fn refuse_without_meaning(
    scene: &Scene,
    settings: &Settings,
    effect: Effect,
    option: &str,
) -> Result<(), Failure> {
    let all = Decisions::all(scene, &settings.request());
    if all.iter().any(|decisions| decisions.has(effect)) {
        return Ok(());
    }
    let decision = all.iter().flat_map(|decisions| &decisions.effects).find(|decision| decision.effect == effect);
    let reason = decision.map_or("it has no object", |decision| &decision.reason);
    let (scene, rung) = (&scene.name, settings.rung);
    Err(Failure(format!("scene `{scene}` by rung `{rung}`: {option} has no meaning: {reason}; leave it out")))
}
