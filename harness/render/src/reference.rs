//! A picture by the reference, on the CPU: the rung without a recipe.

use crate::error::RenderError;
use crate::picture::displayed::{Display, encode};
use crate::picture::{Picture, Tile, WalkedPicture};
use crate::settings::Settings;
use lapidary_gpu::Gpu;
use lapidary_plan::Effect;
use lapidary_reference::random_walk::mesh::{self, Lone, Rendering as Walked};
use lapidary_reference::spectral::{self, Lost, Rendering, Scatterer, Window};
use lapidary_scene::{Material, Object, Scene};
use std::sync::Mutex;

/// Returns whether all bodies of `scene` scatter light, and there are any: then the reference is made of random walks alone.
pub fn scatters(scene: &Scene) -> bool {
    !scene.objects.is_empty() && scene.objects.iter().all(|object| object.material.scatters())
}

/// Fills `picture` with the reference of `scene`: random walks, whose errors are estimated, if all bodies scatter light, otherwise
/// spectral rays, and a walk where one meets a body that scatters.
pub(crate) fn fill(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    picture: &mut Picture,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<(), RenderError> {
    if !scatters(scene) {
        return follow(gpu, scene, settings, picture, progress);
    }
    let Walked { linear, standard_error, walks, lost, .. } = walk(scene, settings, progress)?;
    picture.walked = Some(WalkedPicture { error: mean_error(&linear, &standard_error), walks, lost });
    picture.linear = linear;
    // A walk's radiance is an estimate that is right only in the mean; the tone curve
    // applied to single estimates would be too dark.
    encode(gpu, settings, picture)
}

/// Renders `scene` by random walks.
fn walk(
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Walked, RenderError> {
    let of_walks = mesh::Settings {
        width: settings.width,
        height: settings.height,
        samples_per_pixel: settings.walks.walks,
        origin: settings.walks.from,
        seed: settings.walks.seed,
        environment: (!settings.without.has(Effect::Environment)).then_some(&settings.environment),
        boundary: settings.walks.boundary,
    };
    Ok(mesh::render(scene, &of_walks, &from_any_thread(progress))?)
}

/// Wraps a progress callback so that several threads may call it.
fn from_any_thread(progress: &mut (dyn FnMut(u64, u64) + Send)) -> impl Fn(u64, u64) + Sync {
    let progress = Mutex::new(progress);
    move |done, total| {
        if let Ok(mut progress) = progress.lock() {
            progress(done, total);
        }
    }
}

/// Returns the root mean square of the standard errors of covered pixels, relative to their mean
/// brightness.
fn mean_error(linear: &[[f32; 4]], standard_error: &[[f32; 3]]) -> f64 {
    let covered = || linear.iter().zip(standard_error).filter(|(pixel, _)| pixel[3] > 0.0);
    let squares: f64 = covered().flat_map(|(_, error)| error).map(|error| f64::from(*error).powi(2)).sum();
    let sum: f64 = covered().flat_map(|(pixel, _)| &pixel[..3]).map(|value| f64::from(*value)).sum();
    let count = 3.0 * covered().count() as f64;
    if sum > 0.0 { (squares / count).sqrt() / (sum / count) } else { 0.0 }
}

/// Fills `picture` with the reference of `scene`, with the settings' size, samples and environment.
/// Its samples are displayed like those of any rung.
fn follow(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    picture: &mut Picture,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<(), RenderError> {
    // What is opaque and no metal is drawn matte. The rule of the effect `reflection` says whether it also reflects.
    let reflects = |Material { ior, roughness, .. }: &Material| *ior != 1.0 && *roughness == 0.0;
    let is_matte = |material: &Material| material.is_opaque() && !material.is_all_metal();
    let polished = |object: &&Object| is_matte(&object.material) && reflects(&object.material);
    if let Some(opaque) = scene.objects.iter().find(polished) {
        return Err(RenderError::OpaqueReference { object: opaque.name.clone() });
    }
    let environment = (!settings.without.has(Effect::Environment)).then_some(&settings.environment);
    let lone = Lone::all(scene, environment)?;
    let scatterers: Vec<Option<&dyn Scatterer>> =
        lone.iter().map(|lone| lone.as_ref().map(|lone| lone as &dyn Scatterer)).collect();
    let (width, height) = (settings.width, settings.height);
    let rows: u64 = Tile::all(width, height, settings.samples).map(|tile| u64::from(tile.height)).sum();
    let (mut done, mut covered, mut lost) = (0u64, 0.0, Lost::default());
    let display = Display::new(gpu, settings)?;
    for tile in &display.tiles {
        let Tile { left, top, width, height } = tile.0;
        let of_reference = spectral::Settings {
            window: Some(Window { left, top, width, height }),
            samples: settings.samples,
            wavelengths: settings.reference.wavelengths,
            energy_bound: settings.reference.energy_bound,
            environment: &settings.environment,
            lights: !settings.without.has(Effect::Light),
            scatterers: &scatterers,
            lit_by_environment: !settings.without.has(Effect::Environment),
            ..spectral::Settings::of_size(settings.width, settings.height)
        };
        let mut of_all = |of_tile: u64, _: u64| progress(done + of_tile, rows);
        let (Rendering { linear, lost: of_tile, .. }, samples) =
            spectral::render_samples(scene, &of_reference, &from_any_thread(&mut of_all))?;
        done += u64::from(height);
        let share: f64 = linear.iter().map(|pixel| f64::from(pixel[3])).sum();
        covered += share;
        lost = Lost { max: lost.max.max(of_tile.max), mean: lost.mean + share * of_tile.mean };
        display.show(tile, &samples, picture)?;
        // Replaces the device's means, which are f32.
        for (row, means) in (top..).zip(linear.chunks_exact(width as usize)) {
            let start = (row * picture.width + left) as usize;
            picture.linear[start..start + means.len()].copy_from_slice(means);
        }
    }
    picture.lost = Some(Lost { mean: if covered > 0.0 { lost.mean / covered } else { 0.0 }, ..lost });
    Ok(())
}
