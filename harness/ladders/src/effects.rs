//! What each effect costs in time, SPIR-V instructions and bytes of resources: frames with the
//! effect alone, without any effect, and with all of them.

use crate::error::CostError;
use crate::ladder::Ladder;
use crate::options::{Options, Progress};
use crate::report::{Report, Row};
use crate::table::{Table, figure};
use crate::timing::{self, Timed};
use glam::Vec3;
use lapidary_gpu::Gpu;
use lapidary_plan::{Decisions, Effect, Effects, Outside, Rung};
use lapidary_render::plan::Plan;
use lapidary_render::{Curvature, DiffuseOptions, GemOptions, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Copies, Coverage, Dispersion, Environment, Light, Material, Object, Place, Scene};

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: "effects", tables: |report| vec![table(report)], plots: |_| Vec::new(), whole };

/// Returns how to measure by default; there are no rungs to choose.
pub fn options() -> Options {
    Options { rounds: 7, frame: [480, 270], rungs: Vec::new() }
}

/// A scene and settings in which every listed effect is on.
struct Case {
    name: &'static str,
    scene: Scene,
    settings: Settings,
    /// The effects that are switched one by one.
    effects: &'static [Effect],
    /// Pairs of an effect and its prerequisite, without which it would be off itself.
    stands_on: &'static [(Effect, Effect)],
}

/// Returns a small sky; its size is not meant to be typical.
fn sky() -> Environment {
    let pixel = |index: u32| {
        let height = 1.0 - (index / 64) as f32 / 32.0;
        [0.2 + 0.3 * height, 0.3 + 0.4 * height, 0.5 + 0.5 * height, 1.0]
    };
    Environment::Map(EnvironmentMap { width: 64, height: 32, pixels: (0..64 * 32).map(pixel).collect() })
}

/// Returns the scene with only its first object.
fn one(name: &str) -> Result<Scene, CostError> {
    let scene = Scene::named(name).map_err(CostError::from)?;
    Ok(Scene { objects: scene.objects.into_iter().take(1).collect(), ..scene })
}

/// Returns the vitrine with only its table and one body on it.
fn behind(body: &str) -> Result<Scene, CostError> {
    let mut scene = Scene::named("vitrine").map_err(CostError::from)?;
    scene.objects.retain(|object| object.name == "table" || object.name == body);
    Ok(scene)
}

/// Returns the scene with only its first object, as one copy at its own place.
fn copied(name: &str) -> Result<Scene, CostError> {
    let scene = one(name)?;
    let copies = |mesh| Copies { shape: mesh, places: vec![Place::IDENTITY] };
    let object = |object: Object| Object::of_copies(object.name, copies(object.mesh), object.material);
    Ok(Scene { objects: scene.objects.into_iter().map(object).collect(), ..scene })
}

/// Returns the scene with only its first object, and a spot in place of each sun.
fn spotlit(name: &str) -> Result<Scene, CostError> {
    let scene = one(name)?;
    let bounds = scene.bounds();
    let spot = |light: &Light| match *light {
        Light::Directional { toward, irradiance } => {
            let distance = 4.0 * bounds.radius();
            Light::Spot {
                position: bounds.centre() + distance * toward,
                direction: -toward,
                intensity: distance * distance * irradiance,
                inner_angle: 0.3,
                outer_angle: 0.5,
            }
        }
        other => other,
    };
    Ok(Scene { lights: scene.lights.iter().map(spot).collect(), ..scene })
}

/// Returns the scene with only its first object, under a sun.
fn sunlit(name: &str) -> Result<Scene, CostError> {
    let sun = Light::Directional { toward: Vec3::new(0.6, 0.8, 0.0), irradiance: Vec3::splat(3.0) };
    Ok(Scene { lights: vec![sun], ..one(name)? })
}

/// Returns a stone in its setting within a smooth ball of tinted glass, under a sun.
fn in_glass() -> Result<Scene, CostError> {
    let mut scene = Scene::named("solitaire").map_err(CostError::from)?;
    let stone = scene.objects.iter().find(|object| object.material.is_clear());
    let material = stone.map(|stone| stone.material.clone()).unwrap_or_else(Material::standard);
    let tint = Vec3::new(0.9, 0.95, 1.0);
    let glass = Material {
        ior: 1.5,
        dispersion: Dispersion::None,
        attenuation_color: tint,
        attenuation_distance: 10.0,
        ..material
    };
    let bounds = scene.bounds();
    let ball = sphere(f64::from(bounds.radius()), 48).placed(glam::DQuat::IDENTITY, bounds.centre().as_dvec3());
    scene.objects.insert(0, Object::new("glass", ball, glass));
    Ok(Scene { lights: sunlit("brilliant")?.lights, ..scene })
}

/// Returns a ball of glass, whose images are those of the head, with wax inside.
fn painted_glass() -> Result<Scene, CostError> {
    let [images, wax] = [one("head")?, one("wax")?].map(|mut scene| scene.objects.remove(0).material);
    let material = Material {
        ior: 1.5,
        transmission: 1.0,
        roughness: 0.0,
        thickness: 1.0,
        transmission_texture: images.base_color_texture.clone(),
        base_color_texture: images.base_color_texture,
        normal_texture: images.normal_texture,
        ..Material::standard()
    };
    let mut mesh = sphere(1.0, 48);
    mesh.colors = vec![Vec3::ONE; mesh.positions.len()];
    let within = Object::new("wax", sphere(0.5, 48), wax);
    Ok(Scene { objects: vec![Object::new("glass", mesh, material), within], ..sunlit("brilliant")? })
}

fn cases(frame: [u32; 2]) -> Result<Vec<Case>, CostError> {
    let settings = |rung: &str| {
        let rung: Rung = rung.parse().unwrap_or(Rung::ByMaterial);
        Settings { samples: 1, rung, environment: sky(), ..Settings::of_size(frame[0], frame[1]) }
    };
    let mut frosted = one("ruby")?;
    for object in &mut frosted.objects {
        (object.material.roughness, object.material.transmission) = (0.5, 0.8);
    }
    let sheer = Scene {
        objects: one("wax")?
            .objects
            .into_iter()
            .map(|object| {
                let coverage = Some(Coverage { share: 0.5, cutoff: None });
                Object { material: Material { coverage, ..Material::standard() }, ..object }
            })
            .collect(),
        ..one("wax")?
    };
    let mut thin = one("ruby")?;
    for object in &mut thin.objects {
        object.material.thickness = 0.0;
    }
    let mut coloured = one("head")?;
    for object in &mut coloured.objects {
        object.mesh.colors = vec![Vec3::ONE; object.mesh.positions.len()];
        object.material.thickness = 1.0;
        object.material.thickness_texture = object.material.base_color_texture.clone();
        object.material.diffuse_transmission = 1.0;
        object.material.diffuse_transmission_texture = object.material.base_color_texture.clone();
    }
    let mut gilded = one("head")?;
    for object in &mut gilded.objects {
        let image = object.material.base_color_texture.clone();
        object.material = Material { metallic: 0.5, roughness: 0.5, ..Material::standard() };
        object.material.metallic_roughness_texture = image;
    }
    let mut lantern = one("wax")?;
    let position = lantern.bounds().centre();
    lantern.lights.push(Light::Point { position, intensity: Vec3::ONE });
    let mut veined = spotlit("dragon")?;
    for object in &mut veined.objects {
        object.material.roughness = 0.3;
    }
    Ok(vec![
        Case {
            name: "ruby",
            scene: one("ruby")?,
            settings: settings("proxy-4+tracker"),
            effects: &[Effect::ProxyGeometry, Effect::Absorption, Effect::Dispersion, Effect::EnvironmentMap],
            stands_on: &[(Effect::Absorption, Effect::ProxyGeometry), (Effect::Dispersion, Effect::ProxyGeometry)],
        },
        Case {
            name: "ruby",
            scene: one("ruby")?,
            settings: settings("convex-4+tracker"),
            effects: &[Effect::ConvexTrace, Effect::Absorption, Effect::Dispersion, Effect::EnvironmentMap],
            stands_on: &[(Effect::Absorption, Effect::ConvexTrace), (Effect::Dispersion, Effect::ConvexTrace)],
        },
        Case {
            name: "ruby",
            scene: one("ruby")?,
            settings: settings("bvh-4+tracker"),
            effects: &[Effect::BvhTrace, Effect::Absorption, Effect::Dispersion, Effect::EnvironmentMap],
            stands_on: &[(Effect::Absorption, Effect::BvhTrace), (Effect::Dispersion, Effect::BvhTrace)],
        },
        Case {
            name: "ruby, one copy",
            scene: copied("ruby")?,
            settings: Settings {
                gem: GemOptions { footprint: true, ..GemOptions::default() },
                ..settings("walk-4+tracker")
            },
            effects: &[
                Effect::ConvexTrace,
                Effect::Absorption,
                Effect::Dispersion,
                Effect::Instances,
                Effect::Footprint,
                Effect::EnvironmentMap,
            ],
            stands_on: &[
                (Effect::Absorption, Effect::ConvexTrace),
                (Effect::Dispersion, Effect::ConvexTrace),
                (Effect::Footprint, Effect::ConvexTrace),
            ],
        },
        Case {
            name: "solitaire in a glass ball, a sun",
            scene: in_glass()?,
            settings: settings("scene-16+3"),
            effects: &[
                Effect::Nested,
                Effect::Behind,
                Effect::Around,
                Effect::Smooth,
                Effect::Light,
                Effect::Absorption,
                Effect::Dispersion,
                Effect::EnvironmentMap,
            ],
            stands_on: &[],
        },
        Case {
            name: "ruby, frosted, clear in part",
            scene: frosted,
            settings: settings("scene-16+3"),
            effects: &[Effect::Rough, Effect::PartialTransmission, Effect::Absorption, Effect::EnvironmentMap],
            stands_on: &[],
        },
        Case {
            name: "wax in a glass ball with images, a sun",
            scene: painted_glass()?,
            settings: Settings { half_space: true, ..settings("scene-16") },
            effects: &[
                Effect::Nested,
                Effect::Around,
                Effect::Cdrf,
                Effect::HalfSpace,
                Effect::BaseColorTexture,
                Effect::NormalTexture,
                Effect::PartialTransmission,
                Effect::TransmissionTexture,
                Effect::VertexColor,
                Effect::EnvironmentMap,
            ],
            stands_on: &[
                (Effect::Cdrf, Effect::Around),
                (Effect::HalfSpace, Effect::Cdrf),
                (Effect::TransmissionTexture, Effect::PartialTransmission),
            ],
        },
        Case {
            name: "brilliant, a sun",
            scene: sunlit("brilliant")?,
            settings: settings("by-material"),
            effects: &[Effect::ConvexTrace, Effect::Light, Effect::EnvironmentMap],
            stands_on: &[],
        },
        Case {
            name: "tray, bodies",
            scene: Scene::named("tray")?,
            settings: Settings {
                gem: GemOptions { outside: Some(Outside::Bodies), ..GemOptions::default() },
                ..settings("by-material")
            },
            effects: &[Effect::ConvexTrace, Effect::BoundsTrace, Effect::EnvironmentMap],
            stands_on: &[(Effect::BoundsTrace, Effect::ConvexTrace)],
        },
        Case {
            name: "tray, screen",
            scene: Scene::named("tray")?,
            settings: Settings {
                gem: GemOptions { outside: Some(Outside::Screen), ..GemOptions::default() },
                ..settings("by-material")
            },
            effects: &[Effect::ConvexTrace, Effect::ScreenTrace, Effect::EnvironmentMap],
            stands_on: &[(Effect::ScreenTrace, Effect::ConvexTrace)],
        },
        Case {
            name: "ruby, a thin wall",
            scene: thin,
            settings: settings("by-material"),
            effects: &[Effect::ThinWall, Effect::EnvironmentMap],
            stands_on: &[],
        },
        Case {
            name: "wax_ring, spots for suns",
            scene: spotlit("wax_ring")?,
            settings: Settings { half_space: true, ..settings("accurate") },
            effects: &[Effect::Cdrf, Effect::HalfSpace, Effect::Environment, Effect::Microfacet, Effect::Spot],
            stands_on: &[],
        },
        Case {
            name: "jade_ring",
            scene: one("jade_ring")?,
            settings: Settings {
                diffuse: DiffuseOptions { curvature: Curvature::Vertex, ..DiffuseOptions::default() },
                ..settings("table-256-rgba8")
            },
            effects: &[Effect::Cdrf, Effect::Environment, Effect::Reflection, Effect::EnvironmentMap],
            stands_on: &[(Effect::EnvironmentMap, Effect::Reflection)],
        },
        Case {
            name: "wax, opaque, half covering",
            scene: sheer,
            settings: settings("by-material"),
            effects: &[Effect::Coverage, Effect::Environment, Effect::Microfacet],
            stands_on: &[],
        },
        Case {
            name: "wax_bunny",
            scene: one("wax_bunny")?,
            settings: settings("lambert-shadowed"),
            effects: &[Effect::Shadow, Effect::Environment, Effect::Microfacet],
            stands_on: &[],
        },
        Case {
            name: "wax_bunny",
            scene: one("wax_bunny")?,
            settings: Settings { half_space: true, shadows: true, ..settings("drift") },
            effects: &[Effect::TranslucentShadow],
            stands_on: &[],
        },
        Case {
            name: "head",
            scene: coloured,
            settings: settings("accurate"),
            effects: &[
                Effect::Cdrf,
                Effect::BaseColorTexture,
                Effect::NormalTexture,
                Effect::ThicknessTexture,
                Effect::PartialTransmission,
                Effect::TransmissionTexture,
                Effect::VertexColor,
                Effect::Microfacet,
                Effect::SecondLobe,
            ],
            stands_on: &[
                (Effect::SecondLobe, Effect::Microfacet),
                (Effect::ThicknessTexture, Effect::Cdrf),
                (Effect::PartialTransmission, Effect::Cdrf),
                (Effect::TransmissionTexture, Effect::PartialTransmission),
            ],
        },
        Case {
            name: "head, a metal in part",
            scene: gilded,
            settings: settings("lambert"),
            effects: &[Effect::Metal, Effect::RoughnessTexture, Effect::Microfacet],
            stands_on: &[(Effect::RoughnessTexture, Effect::Metal)],
        },
        Case {
            name: "vitrine, table and ruby",
            scene: behind("ruby")?,
            settings: settings("by-material"),
            effects: &[Effect::ColoredShadow],
            stands_on: &[],
        },
        Case {
            name: "wax_ring",
            scene: one("wax_ring")?,
            settings: settings("blur"),
            effects: &[Effect::TextureDiffusion, Effect::Environment, Effect::Microfacet],
            stands_on: &[],
        },
        Case {
            name: "dragon, rough, spots for suns",
            scene: veined.clone(),
            settings: settings("godunov-64"),
            effects: &[
                Effect::OpticalPath,
                Effect::Surface,
                Effect::Color,
                Effect::ExtinctionPerVoxel,
                Effect::Environment,
                Effect::Microfacet,
                Effect::Spot,
            ],
            stands_on: &[
                (Effect::Surface, Effect::OpticalPath),
                (Effect::Color, Effect::OpticalPath),
                (Effect::ExtinctionPerVoxel, Effect::OpticalPath),
            ],
        },
        Case {
            name: "dragon, rough, spots for suns",
            scene: veined,
            settings: settings("diffusion-64"),
            effects: &[
                Effect::Diffusion,
                Effect::ExtinctionPerVoxel,
                Effect::Environment,
                Effect::Dielectric,
                Effect::Microfacet,
                Effect::Spot,
            ],
            stands_on: &[(Effect::ExtinctionPerVoxel, Effect::Diffusion)],
        },
        Case {
            name: "wax with a lamp inside",
            scene: lantern,
            settings: settings("diffusion-64"),
            effects: &[Effect::Diffusion, Effect::LampInside],
            stands_on: &[(Effect::LampInside, Effect::Diffusion)],
        },
    ])
}

impl Case {
    /// Returns the names and settings of the frames.
    fn frames(&self) -> Vec<(String, Settings)> {
        let without = |kept: &[Effect]| {
            let gone = self.effects.iter().filter(|effect| !kept.contains(effect));
            let gone = gone.fold(Effects::NONE, |all, effect| all.and(Effects::of(&[*effect])));
            Settings { without: gone, ..self.settings.clone() }
        };
        let mut frames = vec![("none".to_owned(), without(&[]))];
        frames.extend(self.effects.iter().map(|effect| {
            let below =
                |above: &Effect| self.stands_on.iter().find(|(upper, _)| upper == above).map(|(_, under)| *under);
            let kept: Vec<Effect> = std::iter::successors(Some(*effect), below).collect();
            let under = below(effect);
            (under.map_or_else(|| effect.to_string(), |under| format!("{effect} on {under}")), without(&kept))
        }));
        frames.push(("all".to_owned(), without(self.effects)));
        frames
    }
}

/// The measure of a row: the number of draws and dispatches.
const STEPS: &str = "draws and dispatches";

/// Measures each scene without any effect, with each effect alone, and with all. The effects follow
/// the rung's name; a row's value counts draws and dispatches; bytes are those of all resources of a
/// picture of the timed size, instructions those of each pipeline.
///
/// # Errors
///
/// Returns an error if a scene cannot be made or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings = [("width", width), ("height", height), ("rounds", options.rounds)];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    let cases = cases(options.frame)?;
    let mut timed = Vec::new();
    for case in &cases {
        let drawn =
            case.scene.objects.iter().map(|object| Decisions::of(object, &case.scene, &case.settings.request()));
        let rung = drawn.map(|decisions| decisions.rung).next().unwrap_or(case.settings.rung).to_string();
        for (effects, settings) in case.frames() {
            let listing = Plan::of(&case.scene, &settings)?.listing;
            let steps: u32 = listing.steps.iter().map(|step| step.times).sum();
            report.rows.push(Row {
                bytes: Some(listing.bytes()),
                instructions: listing.pipelines.iter().map(|pipeline| pipeline.instructions as u32).collect(),
                ..Row::new(&format!("{rung}, {effects}"), case.name, STEPS, f64::from(steps), "")
            });
            timed.push(Timed { displayed: true, ..Timed::new(&case.scene, settings) });
        }
    }
    let timings = timing::time(gpu, &timed, options.rounds, &mut |done, total| progress("timing", done, total))?;
    for (row, timing) in report.rows.iter_mut().zip(timings) {
        row.ms = timing.map(|timing| timing.ms);
    }
    Ok(report)
}

/// Checks that all frames were timed.
fn whole(report: &Report) -> Result<(), String> {
    if report.rows.is_empty() || report.rows.iter().any(|row| row.ms.is_none()) {
        return Err("the report has no times; only a whole report fills a page".to_owned());
    }
    Ok(())
}

fn table(report: &Report) -> Table {
    // The frame to compare with: the one with only the prerequisite, or else without effects.
    let below = |row: &Row| {
        let (rung, effects) = row.rung.split_once(", ")?;
        let under = effects.split_once(" on ").map_or("none", |(_, under)| under);
        report.row(&format!("{rung}, {under}"), &row.view, STEPS).filter(|below| below.rung != row.rung)
    };
    let part = |row: &Row, index: usize| row.rung.splitn(2, ", ").nth(index).unwrap_or_default().to_owned();
    let shown = |value: Option<f64>, decimals| value.map_or("–".to_owned(), |value| format!("{value:+.decimals$}"));
    let more = |row: &Row, value_of: fn(&Row) -> Option<f64>, decimals| {
        shown(value_of(row).zip(below(row).and_then(value_of)).map(|(value, below)| value - below), decimals)
    };
    let ms = |row: &Row| row.ms;
    let instructions = |row: &Row| Some(f64::from(row.instructions.iter().sum::<u32>()));
    let kibi = |row: &Row| row.bytes.map(|bytes| bytes as f64 / 1024.0);
    Table::of("effects", "What each effect takes", &report.rows[..])
        .column("scene and rung", |row| {
            if part(row, 1) == "none" { format!("{} by `{}`", row.view, part(row, 0)) } else { String::new() }
        })
        .column("effects", |row| part(row, 1))
        .column("ms", |row| figure(row.ms, 1))
        .column("more", |row| more(row, ms, 1))
        .column("instructions", |row| figure(instructions(row), 0))
        .column("more", |row| more(row, instructions, 0))
        .column("KiB", |row| figure(kibi(row), 0))
        .column("more", |row| more(row, kibi, 1))
        .column("draws, dispatches", |row| figure(row.value, 0))
        .note(format!(
            "Frames of {} pixels, displayed; {}. `more` is beyond the frame without effects, or with what the effect \
             stands on.",
            report.size(),
            report.run()
        ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_is_studied_where_it_is_on() {
        let mut studied = Effects::NONE;
        for case in cases([16, 16]).expect("built in") {
            let decisions = Decisions::all(&case.scene, &case.settings.request());
            for effect in case.effects {
                assert!(decisions.iter().any(|decided| decided.has(*effect)), "{}: {effect} is off", case.name);
                studied = studied.and(Effects::of(&[*effect]));
            }
        }
        for effect in Effect::ALL {
            assert!(studied.has(effect), "{effect} is studied nowhere");
        }
    }

    #[test]
    #[ignore = "long; .ci/full runs it"]
    fn more_effects_take_more() {
        for case in cases([16, 16]).expect("built in") {
            let cost_of = |settings: &Settings| {
                let listing = Plan::of(&case.scene, settings).expect("a plan").listing;
                let instructions: usize = listing.pipelines.iter().map(|pipeline| pipeline.instructions).sum();
                (instructions, listing.bytes())
            };
            let frames = case.frames();
            let counts: Vec<(usize, u64)> = frames.iter().map(|(_, settings)| cost_of(settings)).collect();
            let (none, all) = (counts[0], counts[counts.len() - 1]);
            for ((name, _), (instructions, bytes)) in frames.iter().zip(&counts).skip(1) {
                assert!(*instructions > none.0 && *instructions <= all.0, "{}: {name}: {counts:?}", case.name);
                assert!(*bytes >= none.1 && *bytes <= all.1, "{}: {name}: {counts:?}", case.name);
            }
        }
    }
}
