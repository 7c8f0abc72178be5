//! The pictures of a ladder's rungs: one scene, each rung, and the committed reference.

use super::LadderError;
use super::kind::{KINDS, Kind, SAMPLES, SIDE};
use crate::snapshot::EXR_SIDE;
use lapidary_gpu::Gpu;
use lapidary_plan::Quality;
use lapidary_plan::ladder::Step;
use lapidary_render::{self as render, Picture, Settings, file};
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// Name of the reference among a ladder's pictures.
pub const REFERENCE: &str = "reference";
/// The share of the best quality at which pictures are compressed that no choice is made by.
const JPEG_QUALITY: u8 = 92;

/// The picture of a rung.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RungPicture {
    /// Name of the rung; [`REFERENCE`] for the reference.
    pub rung: String,
    /// Its file, below the site's folder.
    pub file: String,
    /// Width and height in pixels.
    pub side: u32,
    /// What drew it, and its driver.
    pub adapter: String,
    /// Samples, or wavelengths and walks.
    pub samples: String,
    /// What else is to be known of it; may be empty.
    pub note: String,
    /// The command that draws it again.
    pub command: String,
}

/// The pictures of a ladder, the reference first, then rungs by increasing time.
#[derive(Clone, Debug)]
pub struct LadderPictures {
    /// The ladder.
    pub kind: &'static Kind,
    /// Its pictures.
    pub pictures: Vec<RungPicture>,
}

/// A picture to draw and the rung that it is of.
struct Job {
    rung: &'static str,
    file: String,
}

/// Draws all ladders' rungs into the site's folder, as `images/rungs/LADDER/RUNG.png`. Pictures that no choice is made
/// by are compressed with loss, as `.jpg`.
///
/// # Errors
/// Returns an error if a committed reference is damaged, or if the device or the file system fails.
pub fn pictures(gpu: &Gpu, folder: &Path) -> Result<Vec<LadderPictures>, LadderError> {
    KINDS.iter().map(|kind| of_kind(gpu, kind, folder)).collect()
}

/// Draws a ladder's rungs.
fn of_kind(gpu: &Gpu, kind: &'static Kind, folder: &Path) -> Result<LadderPictures, LadderError> {
    let made = folder.join(place(kind));
    std::fs::create_dir_all(&made).map_err(|error| LadderError::Folder { path: made, error })?;
    if let Some(truth) = kind.truth.read(gpu)? {
        file::write(&enlarged(gpu, kind, &truth)?, &folder.join(reference_file(kind)))?;
    }
    jobs(kind, &kind.steps()).par_iter().try_for_each(|job| draw(gpu, kind, job, folder))?;
    Ok(listed(&gpu.describe(), kind))
}

/// Lists a ladder's pictures as this device draws them.
pub(super) fn listed(adapter: &str, kind: &'static Kind) -> LadderPictures {
    let steps = kind.steps();
    let scale = f64::from(SIDE) / f64::from(EXR_SIDE);
    let mut pictures = vec![RungPicture {
        rung: REFERENCE.to_owned(),
        file: reference_file(kind),
        side: SIDE,
        adapter: "the CPU".to_owned(),
        samples: kind.truth.description(),
        note: format!(
            "Committed at {EXR_SIDE} × {EXR_SIDE} pixels, shown {scale} times as large: edges are softer than the rungs’."
        ),
        command: kind.truth.command(),
    }];
    let jobs = jobs(kind, &steps);
    for step in &steps {
        let drawn = kind.pictured(&step.rung, &steps);
        pictures.extend(jobs.iter().find(|job| job.rung == drawn).map(|job| described(adapter, kind, job, &step.rung)));
    }
    let unmeasured = jobs.iter().filter(|job| kind.others.contains(&job.rung));
    pictures.extend(unmeasured.map(|job| described(adapter, kind, job, job.rung)));
    LadderPictures { kind, pictures }
}

fn place(kind: &Kind) -> String {
    format!("images/rungs/{}", kind.name)
}

fn reference_file(kind: &Kind) -> String {
    format!("{}/{REFERENCE}.png", place(kind))
}

/// Lists the different pictures of a ladder.
fn jobs(kind: &Kind, steps: &[&'static Step]) -> Vec<Job> {
    let own = steps.iter().map(|step| step.rung.as_str()).filter(|rung| kind.pictured(rung, steps) == *rung);
    own.chain(kind.others.iter().copied()).map(|rung| Job { rung, file: file_of(kind, rung) }).collect()
}

/// Whether a choice is made by this rung's picture: it is on the front, a default, the paper's, or asked for by name.
pub(super) fn is_chosen(kind: &Kind, rung: &str) -> bool {
    let is_default = Quality::ALL.into_iter().any(|quality| kind.technique.rung(quality).to_string() == rung);
    let is_front = kind.ladder().is_some_and(|ladder| ladder.hull().iter().any(|step| step.rung == rung));
    is_default || is_front || kind.paper.contains(&rung) || kind.others.contains(&rung)
}

fn file_of(kind: &Kind, rung: &str) -> String {
    // `+` is a space in some servers' paths.
    let ending = if is_chosen(kind, rung) { "png" } else { "jpg" };
    format!("{}/{}.{ending}", place(kind), rung.replace('+', "-"))
}

fn draw(gpu: &Gpu, kind: &Kind, job: &Job, folder: &Path) -> Result<(), LadderError> {
    let Some(shot) = kind.shot(job.rung) else { return Ok(()) };
    let scene = shot.open().map_err(crate::snapshot::SnapshotError::from)?;
    let picture = render::render(gpu, &scene, &shot.settings(SIDE))?;
    let path = folder.join(&job.file);
    if job.file.ends_with(".png") {
        return Ok(file::write(&picture, &path)?);
    }
    Ok(file::replace(&path, &jpeg(&picture).map_err(|reason| file::FileError::Encode { path: path.clone(), reason })?)?)
}

fn jpeg(picture: &Picture) -> Result<Vec<u8>, String> {
    let rgb: Vec<u8> = picture.encoded.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let mut bytes = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
        .encode(&rgb, picture.width, picture.height, image::ExtendedColorType::Rgb8)
        .map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn described(adapter: &str, kind: &Kind, job: &Job, rung: &str) -> RungPicture {
    let note = match (rung == job.rung, job.file.ends_with(".jpg")) {
        (false, _) => format!("It follows the same rays or costs as {0}, in another way; this is the picture of {0}.", job.rung),
        (true, true) => "Compressed with loss, by up to a few steps of 255.".to_owned(),
        _ => String::new(),
    };
    RungPicture {
        rung: rung.to_owned(),
        file: job.file.clone(),
        side: SIDE,
        adapter: adapter.to_owned(),
        samples: format!("{SAMPLES} × {SAMPLES} samples a pixel"),
        note,
        command: kind.shot(job.rung).map(|shot| shot.command()).unwrap_or_default(),
    }
}

/// Returns the reference at the size of the rungs' pictures, interpolated in linear radiance, and encoded like them.
fn enlarged(gpu: &Gpu, kind: &Kind, truth: &Picture) -> Result<Picture, LadderError> {
    let linear = truth.linear.concat();
    let Some(image) = image::Rgba32FImage::from_raw(truth.width, truth.height, linear) else {
        return Ok(truth.clone());
    };
    let image = image::imageops::resize(&image, SIDE, SIDE, image::imageops::FilterType::CatmullRom);
    // The interpolation overshoots at edges.
    let linear: Vec<[f32; 4]> = image.pixels().map(|pixel| pixel.0.map(|value| value.max(0.0))).collect();
    let encoded = vec![[0; 4]; linear.len()];
    let mut picture = Picture { width: SIDE, height: SIDE, linear, encoded, ..truth.clone() };
    let usual = Settings::of_size(SIDE, SIDE);
    let settings = kind.steps().first().and_then(|step| kind.shot(&step.rung)).map_or(usual, |shot| shot.settings(SIDE));
    render::encode(gpu, &settings, &mut picture)?;
    Ok(picture)
}
