//! Renders a scene to a picture: its frame run on a device, or the reference.

use crate::drawing::copies::with_copies_apart;
use crate::drawing::scene_frame::{Drawing, Texts, check_size};
use crate::error::RenderError;
use crate::frame::Executor;
use crate::picture::display::ENCODED;
use crate::picture::displayed::encode;
use crate::picture::{Picture, Tile};
use crate::reference;
use crate::settings::Settings;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::Scene;

/// Renders `scene` with the cookbook's recipe.
pub fn render(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    render_reporting(gpu, scene, settings, &mut |_, _| {})
}

/// Renders `scene` like [`render`], and calls `progress` with the number of steps done and in
/// total.
pub fn render_reporting(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    render_from(gpu, scene, settings, Texts::default(), progress)
}

/// Renders `scene` and displays its mean radiance instead of its samples.
///
/// Committed references are displayed this way, because only their means are stored. If two
/// pictures are compared as displayed, both must be displayed alike.
pub fn render_means(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    let mut picture = render(gpu, scene, settings)?;
    encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Renders `scene` with another source text for the rung's recipe.
pub fn render_with(gpu: &Gpu, scene: &Scene, settings: &Settings, source: &str) -> Result<Picture, RenderError> {
    render_from(gpu, scene, settings, Texts { rung: Some(source), composite: None }, &mut |_, _| {})
}

/// Renders `scene` with other source texts.
pub(crate) fn render_from(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    texts: Texts<'_>,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    check_size(settings)?;
    let (width, height) = (settings.width, settings.height);
    let pixels = width as usize * height as usize;
    let (linear, encoded) = (vec![[0.0; 4]; pixels], vec![[0; 4]; pixels]);
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    if settings.rung == Rung::Reference {
        reference::fill(gpu, &with_copies_apart(scene, settings), settings, &mut picture, progress)?;
        return Ok(picture);
    }
    let Drawing { frame, pass } = Drawing::new(Some(gpu), scene, settings, texts)?;
    let executor = Executor::new(gpu, frame)?;
    let tiles = Tile::all(width, height, settings.samples).count() as u64;
    let mut done = 0;
    executor.run(|read, texels| {
        picture.take(read, texels);
        // The last read of a tile.
        if read.picture == ENCODED {
            done += 1;
            progress(done, tiles);
        }
    })?;
    let path_notes = pass.paths().map(|paths| paths.notes(&executor));
    let diffusion_notes = pass.diffusions().map(|diffusions| diffusions.notes(&executor));
    picture.notes = path_notes.chain(diffusion_notes).collect::<Result<Vec<_>, _>>()?.concat();
    Ok(picture)
}
