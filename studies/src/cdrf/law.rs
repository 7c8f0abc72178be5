//! What the law of a half space and the measured widths leave of the distance from the committed
//! random walks, by how the light falls.

use glam::Vec3;
use lapidary_gpu::Gpu;
use lapidary_ladders::cdrf::scenes::{self, SCENES, SIDE, add_timed};
use lapidary_ladders::table::{Goal, Table, figure};
use lapidary_ladders::timing::Timed;
use lapidary_ladders::{CostError, Report, Row};
use lapidary_plan::{Effect, Effects};
use lapidary_render as render;
use lapidary_render::{DiffuseOptions, Settings, ShadowForm};
use lapidary_scene::solver::Reflectance;
use lapidary_scene::{Light, Scene};
use lapidary_snapshots::WalkedReference;
use lapidary_snapshots::exposure::{best_exposure, distance, exposed_distance};
use lapidary_snapshots::frames::halved;
use std::f32::consts::PI;

/// The compared pictures: name, reflectance, and whether the law of a half space is on. All have
/// shadows. Each reflectance comes without the law, then with it.
pub(super) const LOOKS: [(&str, Reflectance, bool); 12] = [
    (LAMBERT, Reflectance::Lambert, false),
    ("lambert, half space", Reflectance::Lambert, true),
    ("wrap", Reflectance::Wrap, false),
    ("wrap, half space", Reflectance::Wrap, true),
    ("cheap", Reflectance::Cheap, false),
    ("cheap, half space", Reflectance::Cheap, true),
    ("accurate", Reflectance::Accurate, false),
    ("accurate, half space", Reflectance::Accurate, true),
    ("power", Reflectance::Power, false),
    ("power, half space", Reflectance::Power, true),
    ("drift", Reflectance::Drift, false),
    (GOAL, Reflectance::Drift, true),
];
/// What one would use without scattering.
const LAMBERT: &str = "lambert, shadowed";
/// The picture that has the goals.
const GOAL: &str = "drift, half space";
/// Largest share of the distance of Lambert's law with shadows that is a goal.
const MOST: f64 = 0.5;

/// The shadows of the compared pictures by the goal's reflectance: name, whether there are any, what is left out, and
/// the form of what is not.
const SHADOWS: [(&str, bool, &[Effect], ShadowForm); 5] = [
    ("none", false, &[], ShadowForm::Through),
    ("hard", true, &[Effect::TranslucentShadow], ShadowForm::Through),
    ("soft", true, &[], ShadowForm::Soft),
    ("colors", true, &[], ShadowForm::Colors),
    ("through", true, &[], ShadowForm::Through),
];
/// The measure of these pictures.
const SHADOW: &str = "shadow";

/// The measures of a picture: distance after the best exposure and as it is, and the same behind a boundary.
pub(super) const MEASURES: [&str; 4] = ["law", "law, exposure 1", "boundary", "boundary, exposure 1"];

/// The zones: name, and the range of the cosine of the scene's first light; the shadowed one holds what
/// faces the light and does not see it, in no other zone.
const ZONES: [(&str, f32, f32); 6] = [
    ("below -.2", -1.1, -0.2),
    ("-.2 to 0", -0.2, 0.0),
    ("0 to .2", 0.0, 0.2),
    (".2 to .6", 0.2, 0.6),
    (".6 to 1", 0.6, 1.1),
    ("in shadow", 1.1, 1.2),
];
/// Name of the walks, whose zones are shares of the picture's power.
const WALKS: &str = "random walks";

fn zone_measure(zone: &str) -> String {
    format!("zone {zone}")
}

/// Returns settings for one sample per pixel, the scene's lights alone, and per-vertex curvature.
fn settings(reflectance: Reflectance, half_space: bool, sheen: bool) -> Settings {
    let usual = scenes::settings(reflectance, true);
    let without = if sheen { Effects::of(&[Effect::Environment]) } else { usual.without };
    Settings { half_space, without, ..usual }
}

fn drawn(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Vec<[f32; 4]>, CostError> {
    Ok(halved(&render::render(gpu, scene, settings)?).linear)
}

/// Returns a picture with the sheen's effects on but without the highlights themselves, which the walks
/// leave out: they are what a black body shows.
fn behind_boundary(
    gpu: &Gpu,
    scene: &Scene,
    (reflectance, law): (Reflectance, bool),
) -> Result<Vec<[f32; 4]>, CostError> {
    let settings = settings(reflectance, law, true);
    let mut black = scene.clone();
    black.objects.iter_mut().for_each(|object| object.material.base_color = Vec3::ZERO);
    let mut picture = drawn(gpu, scene, &settings)?;
    for (pixel, highlight) in picture.iter_mut().zip(drawn(gpu, &black, &settings)?) {
        (0..3).for_each(|channel| pixel[channel] -= highlight[channel]);
    }
    Ok(picture)
}

/// Returns the zone of each pixel of the halved picture; `None` beside the bodies.
fn zones(gpu: &Gpu, scene: &Scene) -> Result<Vec<Option<usize>>, CostError> {
    let mut lit = scene.clone();
    lit.objects.iter_mut().for_each(|object| object.material.base_color = Vec3::ONE);
    let Some(Light::Directional { toward, .. }) = scene.lights.first().copied() else {
        return Ok(vec![None; (SIDE / 2 * SIDE / 2) as usize]);
    };
    // Under an irradiance of pi a white surface by Lambert's law is as bright as its cosine.
    let mut by = |toward: Vec3, shadows: bool| {
        lit.lights = vec![Light::Directional { toward, irradiance: Vec3::splat(PI) }];
        drawn(gpu, &lit, &Settings { shadows, ..settings(Reflectance::Lambert, false, false) })
    };
    let (facing, seen, away) = (by(toward, false)?, by(toward, true)?, by(-toward, false)?);
    let zone = |((facing, seen), away): ((&[f32; 4], &[f32; 4]), &[f32; 4])| {
        let covered = facing[3];
        if covered < 0.5 {
            return None;
        }
        if facing[0] > 0.0 && seen[0] < 0.5 * facing[0] {
            return Some(ZONES.len() - 1);
        }
        let cosine = (facing[0] - away[0]) / covered;
        ZONES.iter().position(|(_, least, most)| (*least..*most).contains(&cosine))
    };
    Ok(facing.iter().zip(&seen).zip(&away).map(zone).collect())
}

/// Returns the root of each zone's share of the squared difference after the best exposure, or of the
/// walks' own square if there is no picture, relative to the root mean square of the walks.
fn by_zone(picture: Option<&[[f32; 4]]>, truth: &[[f32; 4]], zones: &[Option<usize>]) -> [f64; ZONES.len()] {
    let exposure = picture.map_or(0.0, |picture| best_exposure(picture, truth));
    let (mut sums, mut power) = ([0.0; ZONES.len()], 0.0);
    for (place, (truth, zone)) in truth.iter().zip(zones).enumerate() {
        for channel in 0..3 {
            let found = picture.map_or(0.0, |picture| f64::from(picture[place][channel]));
            let truth = f64::from(truth[channel]);
            power += truth * truth;
            if let Some(zone) = zone {
                sums[*zone] += (exposure * found - truth).powi(2);
            }
        }
    }
    sums.map(|sum| (sum / power).sqrt())
}

/// Adds each scene's pictures: their distances from the walks, whole and by zone, and their times.
///
/// # Errors
/// Returns an error if a committed picture is missing or damaged, or if the device fails.
pub(super) fn measure(
    gpu: &Gpu,
    rounds: u32,
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let scenes: Vec<(&str, Scene)> =
        SCENES.into_iter().map(|name| Ok((name, Scene::named(name)?))).collect::<Result<_, CostError>>()?;
    let (mut rows, mut timed) = (Vec::new(), Vec::new());
    for (name, scene) in &scenes {
        let walked = |reference: Option<&WalkedReference>| -> Result<Vec<[f32; 4]>, CostError> {
            Ok(reference.map(|walk| walk.picture(gpu)).transpose()?.map_or_else(Vec::new, |picture| picture.linear))
        };
        let truth = walked(WalkedReference::of_scene(name))?;
        let refracted = walked(WalkedReference::behind_boundary(name))?;
        let zones = zones(gpu, scene)?;
        let add = |look: &str, found: [f64; ZONES.len()], report: &mut Report| {
            let row =
                |((zone, ..), value): (&(&str, f32, f32), f64)| Row::new(look, name, &zone_measure(zone), value, "");
            report.rows.extend(ZONES.iter().zip(found).map(row));
        };
        add(WALKS, by_zone(None, &truth, &zones), report);
        for (look, reflectance, law) in LOOKS {
            let settings = settings(reflectance, law, false);
            let picture = drawn(gpu, scene, &settings)?;
            add(look, by_zone(Some(&picture), &truth, &zones), report);
            let boundary = behind_boundary(gpu, scene, (reflectance, law))?;
            let values = [
                exposed_distance(&picture, &truth),
                distance(&picture, &truth),
                exposed_distance(&boundary, &refracted),
                distance(&boundary, &refracted),
            ];
            let row = |(measure, value)| Row::new(look, name, measure, Some(value), "");
            rows.push(MEASURES.into_iter().zip(values).map(row).collect());
            timed.push(Timed::new(scene, settings));
        }
        for (shadow, cast, without, form) in SHADOWS {
            let usual = settings(Reflectance::Drift, true, false);
            let settings = Settings {
                shadows: cast,
                without: usual.without.and(Effects::of(without)),
                diffuse: DiffuseOptions { shadows: form, ..usual.diffuse },
                ..usual
            };
            let picture = drawn(gpu, scene, &settings)?;
            rows.push(vec![Row::new(shadow, name, SHADOW, exposed_distance(&picture, &truth), "")]);
            timed.push(Timed::new(scene, settings));
        }
    }
    add_timed(gpu, (rows, &timed), rounds, report, progress)
}

/// Shows the distances of whole pictures.
pub(super) fn table(report: &Report) -> Table {
    let mut table = Table::of("cdrf_law", "The law of a half space, beside random walks", report.rungs(MEASURES[0]))
        .column("", |look| (*look).to_owned());
    for name in SCENES {
        let value = |look: &str, measure: &str| figure(report.value(look, name, measure), 3);
        table = table
            .column(name, |look| format!("{}, {}", value(look, MEASURES[0]), value(look, MEASURES[1])))
            .column("behind a boundary", |look| format!("{}, {}", value(look, MEASURES[2]), value(look, MEASURES[3])))
            .column("ms", |look| figure(report.ms(look, name, MEASURES[0]), 1));
    }
    table.note(format!(
        "Distance of linear radiance from the walks, over their root mean square, after the best exposure and at \
         exposure 1, all with shadows. Behind a boundary: drawn with the surface's reflection on, less the highlights, \
         beside walks through surfaces that refract. Pictures of {SIDE} × {SIDE} pixels, one sample each; milliseconds \
         without the reflection, {}.",
        report.run()
    ))
}

/// Shows the distances and times of each kind of shadow.
pub(super) fn shadows_table(report: &Report) -> Table {
    let mut table = Table::of("cdrf_shadows", "Shadows, beside random walks", report.rungs(SHADOW))
        .column("shadows", |shadow| (*shadow).to_owned());
    for name in SCENES {
        table = table
            .column(name, |shadow| figure(report.value(shadow, name, SHADOW), 3))
            .column("ms", |shadow| figure(report.ms(shadow, name, SHADOW), 1));
    }
    table.note(format!(
        "By the drift and the law of a half space: distance from the walks after the best exposure, and milliseconds of \
         {SIDE} × {SIDE} pixels, {}.",
        report.run()
    ))
}

/// Shows the distances by zone.
pub(super) fn zones_table(report: &Report) -> Table {
    let measured = |look: &&str, name: &str| report.value(look, name, &zone_measure(ZONES[0].0)).is_some();
    let looks = report.rungs(&zone_measure(ZONES[0].0));
    let lines: Vec<(&str, &str)> = SCENES
        .into_iter()
        .flat_map(|name| looks.iter().filter(move |look| measured(look, name)).map(move |look| (name, *look)))
        .collect();
    let mut table = Table::of("cdrf_zones", "Distance by zones of the light's cosine", lines)
        .column("scene", |(name, _)| (*name).to_owned())
        .column("", |(_, look)| (*look).to_owned());
    for (zone, ..) in ZONES {
        table = table.column(zone, |(name, look)| figure(report.value(look, name, &zone_measure(zone)), 3));
    }
    table.note(
        "By the cosine between the normal and the scene's first light: the zone's part of the distance after the best \
         exposure. Squares add up to that of the whole picture, less what lies beside the bodies. Of the walks: the \
         root of the zone's share of the power. In shadow: what faces the light, but does not see it; it is in no \
         other zone.",
    )
}

/// Judges the goals.
pub(super) fn goals(report: &Report) -> Table {
    let mut goals = Vec::new();
    for name in SCENES {
        for (measure, exposure) in [(MEASURES[0], "at the best exposures"), (MEASURES[1], "at exposure 1")] {
            let value_of = |look: &str| report.value(look, name, measure);
            if let (Some(found), Some(lambert)) = (value_of(GOAL), value_of(LAMBERT)) {
                let goal = format!("{name}: at most half of the distance of Lambert's law with shadows, {exposure}");
                let share = found / lambert;
                let measured = format!("{share:.2}: {found:.3} of {lambert:.3}");
                goals.push(Goal::new(goal, measured, share <= MOST));
            }
        }
    }
    Goal::table("cdrf_law_goals", goals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_gpu::AdapterChoice;

    /// The figures that docs/cdrf_shading.md rests on: the law helps every reflectance, the drift is
    /// nearest, and on the spheres and the ring less than half of Lambert's distance is left.
    #[test]
    fn the_law_and_the_drift_are_nearer_to_the_walks() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let mut report = Report::default();
        measure(gpu, 0, &mut report, &mut |_, _| {}).expect("measured");
        println!("{}", table(&report).text());
        println!("{}", zones_table(&report).text());
        println!("{}", goals(&report).text());
        let value_of = |look: &str, name: &str, measure: &str| report.value(look, name, measure).expect("measured");
        for name in SCENES {
            for measure in &MEASURES[..2] {
                for pair in LOOKS.chunks_exact(2) {
                    let [without, with] = [pair[0].0, pair[1].0];
                    assert!(
                        value_of(with, name, measure) < value_of(without, name, measure),
                        "{name}: {with}, {measure}"
                    );
                }
                let others = LOOKS.iter().filter(|(look, ..)| *look != GOAL);
                assert!(
                    others.clone().all(|(look, ..)| value_of(GOAL, name, measure) < value_of(look, name, measure)),
                    "{name}"
                );
                let share = value_of(GOAL, name, measure) / value_of(LAMBERT, name, measure);
                assert!((share <= MOST) == (name != "skin_bunny"), "{name}, {measure}: {share}");
            }
            // The zones hold nearly all of the difference.
            for (look, ..) in LOOKS {
                let squares: f64 =
                    ZONES.iter().map(|(zone, ..)| value_of(look, name, &zone_measure(zone)).powi(2)).sum();
                let share = squares.sqrt() / value_of(look, name, MEASURES[0]);
                assert!((0.9..1.0 + 1e-9).contains(&share), "{name}, {look}: {share}");
            }
        }
    }
}
