//! The pictures of a ladder's rungs: one scene, each rung, and the committed reference.

use super::error::LadderError;
use super::kind::{KINDS, Kind, SAMPLES, SIDE};
use lapidary_gpu::Gpu;
use lapidary_plan::ladder::Step;
use lapidary_render::{self as render, Picture, Settings, file};
use lapidary_snapshots::EXR_SIDE;
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// Name of the reference among a ladder's pictures.
pub const REFERENCE: &str = "reference";
/// The share of the best quality at which pictures to look at are compressed.
const JPEG_QUALITY: u8 = 92;

/// The picture of a rung.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RungPicture {
    /// Name of the rung; [`REFERENCE`] for the reference.
    pub rung: String,
    /// Its file, below the site's folder.
    pub file: String,
    /// The same at the size of the reference, without loss and encoded like it, to be subtracted; `None` for rungs by
    /// which no choice is made.
    pub exact: Option<String>,
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

/// Draws all ladders' rungs into the site's folder, as `images/rungs/LADDER/RUNG.jpg`, and those by which choices are
/// made once more as `RUNG.png`, to be subtracted. `adapter` is what captions call the device.
///
/// # Errors
/// Returns an error if a committed reference is damaged, or if the device or the file system fails.
pub fn pictures(gpu: &Gpu, adapter: &str, folder: &Path) -> Result<Vec<LadderPictures>, LadderError> {
    KINDS.iter().map(|kind| of_kind(gpu, adapter, kind, folder)).collect()
}

/// Draws a ladder's rungs.
fn of_kind(gpu: &Gpu, adapter: &str, kind: &'static Kind, folder: &Path) -> Result<LadderPictures, LadderError> {
    let made = folder.join(place(kind));
    std::fs::create_dir_all(&made).map_err(|error| LadderError::Folder { path: made, error })?;
    if let Some(truth) = kind.truth.read(gpu)? {
        save(&enlarged(gpu, kind, &truth)?, &folder.join(file_of(kind, REFERENCE, "jpg")))?;
        save(&truth, &folder.join(file_of(kind, REFERENCE, "png")))?;
    }
    drawn(kind, &kind.steps()).par_iter().try_for_each(|rung| draw(gpu, kind, rung, folder))?;
    Ok(listed(adapter, kind))
}

/// Lists a ladder's pictures as this device draws them.
pub(super) fn listed(adapter: &str, kind: &'static Kind) -> LadderPictures {
    let steps = kind.steps();
    let mut pictures = vec![RungPicture {
        rung: REFERENCE.to_owned(),
        file: file_of(kind, REFERENCE, "jpg"),
        exact: Some(file_of(kind, REFERENCE, "png")),
        side: SIDE,
        adapter: "the CPU".to_owned(),
        samples: kind.truth.description(),
        note: format!("Committed at {EXR_SIDE} × {EXR_SIDE} pixels, enlarged: edges are softer than the rungs’."),
        command: kind.truth.command(),
    }];
    let measured = steps.iter().map(|step| step.rung.as_str());
    let rungs = measured.chain(kind.others.iter().copied());
    pictures.extend(rungs.map(|rung| described(adapter, kind, rung, kind.pictured(rung, &steps))));
    LadderPictures { kind, pictures }
}

fn place(kind: &Kind) -> String {
    format!("images/rungs/{}", kind.name)
}

/// Lists the rungs of a ladder that have a picture of their own.
fn drawn(kind: &Kind, steps: &[&'static Step]) -> Vec<&'static str> {
    let rungs = steps.iter().map(|step| step.rung.as_str()).filter(|rung| kind.pictured(rung, steps) == *rung);
    rungs.chain(kind.others.iter().copied()).collect()
}

/// Whether a choice is made by this rung's picture: it is on the front, a default, the paper's, or asked for by name.
pub(super) fn is_chosen(kind: &Kind, rung: &str) -> bool {
    let is_default = !kind.qualities(rung).is_empty();
    let is_front = kind.ladder().is_some_and(|ladder| ladder.front().iter().any(|step| step.rung == rung));
    is_default || is_front || kind.is_of_paper(rung) || kind.others.contains(&rung)
}

/// Returns the file of a rung's picture below the site's folder.
fn file_of(kind: &Kind, rung: &str, ending: &str) -> String {
    // `+` is a space in some servers' paths.
    format!("{}/{}.{ending}", place(kind), rung.replace('+', "-"))
}

/// Draws a rung's pictures.
fn draw(gpu: &Gpu, kind: &Kind, rung: &'static str, folder: &Path) -> Result<(), LadderError> {
    let Some(shot) = kind.shot(rung) else { return Ok(()) };
    let scene = shot.open().map_err(lapidary_snapshots::SnapshotError::from)?;
    let settings = shot.settings(SIDE);
    let picture = render::render(gpu, &scene, &settings)?;
    save(&picture, &folder.join(file_of(kind, rung, "jpg")))?;
    if is_chosen(kind, rung) {
        let mut small = shrunk(&picture, EXR_SIDE);
        render::encode(gpu, &settings, &mut small)?;
        save(&small, &folder.join(file_of(kind, rung, "png")))?;
    }
    Ok(())
}

/// Writes a picture in the format of its file's name.
fn save(picture: &Picture, path: &Path) -> Result<(), file::FileError> {
    if path.extension().is_some_and(|extension| extension == "png") {
        return file::write(picture, path);
    }
    let bytes = jpeg(picture).map_err(|reason| file::FileError::Encode { path: path.to_owned(), reason })?;
    Ok(lapidary_files::replace(path, &bytes)?)
}

fn jpeg(picture: &Picture) -> Result<Vec<u8>, String> {
    let rgb: Vec<u8> = picture.encoded.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let mut bytes = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
        .encode(&rgb, picture.width, picture.height, image::ExtendedColorType::Rgb8)
        .map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn described(adapter: &str, kind: &Kind, rung: &str, drawn: &str) -> RungPicture {
    let note = if kind.others.contains(&rung) {
        "Without the law of a half space and cast shadows, which the ladder’s pictures have; so it has no place in the plot.".to_owned()
    } else if rung != drawn {
        format!("It finds what {drawn} finds, in another way; this is the picture of {drawn}.")
    } else {
        String::new()
    };
    RungPicture {
        rung: rung.to_owned(),
        file: file_of(kind, drawn, "jpg"),
        exact: is_chosen(kind, drawn).then(|| file_of(kind, drawn, "png")),
        side: SIDE,
        adapter: adapter.to_owned(),
        samples: format!("{SAMPLES} × {SAMPLES} samples a pixel"),
        note,
        command: kind.command(drawn),
    }
}

/// Returns the linear radiance at a smaller size: each pixel is the mean over its area.
fn shrunk(picture: &Picture, side: u32) -> Picture {
    let scale = f64::from(picture.width) / f64::from(side);
    // The share of each old pixel in a new one, along an axis.
    let shares = |new_pixel: u32| -> Vec<(usize, f64)> {
        let [start, end] = [f64::from(new_pixel) * scale, f64::from(new_pixel + 1) * scale];
        let old = start.floor() as usize..(end.ceil() as usize).min(picture.width as usize);
        old.map(|old| (old, (end.min(old as f64 + 1.0) - start.max(old as f64)) / scale)).collect()
    };
    let axis: Vec<Vec<(usize, f64)>> = (0..side).map(shares).collect();
    let pixel = |index: u32| -> [f32; 4] {
        let mut sum = [0.0_f64; 4];
        for &(row, down) in &axis[(index / side) as usize] {
            for &(column, along) in &axis[(index % side) as usize] {
                let old = picture.linear[row * picture.width as usize + column];
                sum.iter_mut().zip(old).for_each(|(sum, old)| *sum += down * along * f64::from(old));
            }
        }
        sum.map(|value| value as f32)
    };
    let linear: Vec<[f32; 4]> = (0..side * side).map(pixel).collect();
    let encoded = vec![[0; 4]; linear.len()];
    Picture { width: side, height: side, linear, encoded, lost: None, walked: None, notes: Vec::new() }
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
    let mut picture =
        Picture { width: SIDE, height: SIDE, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    let usual = Settings::of_size(SIDE, SIDE);
    let settings =
        kind.steps().first().and_then(|step| kind.shot(&step.rung)).map_or(usual, |shot| shot.settings(SIDE));
    render::encode(gpu, &settings, &mut picture)?;
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_picture_has_the_means_of_the_larger_one() {
        // Three columns, 1, 2 and 6, as two: each takes half of the middle one.
        let linear: Vec<[f32; 4]> = (0..9).map(|index| [[1.0, 2.0, 6.0][index % 3], index as f32, 0.0, 1.0]).collect();
        let encoded = vec![[0; 4]; 9];
        let picture = Picture { width: 3, height: 3, linear, encoded, lost: None, walked: None, notes: Vec::new() };
        let small = shrunk(&picture, 2);
        let close = |found: f32, expected: f32| (found - expected).abs() < 1e-6;
        for row in small.linear.chunks(2) {
            assert!(close(row[0][0], 4.0 / 3.0) && close(row[1][0], 14.0 / 3.0), "{row:?}");
            assert!(close(row[0][3], 1.0));
        }
        let mean = small.linear.iter().map(|pixel| pixel[1]).sum::<f32>() / 4.0;
        assert!(close(mean, 4.0), "{mean}");
    }
}
