//! `cook render`.

use super::drawn::{Drawn, Given, given, planned, tell};
use super::named::named;
use super::{Context, Failure, Outcome, number, output, progress};
use lapidary_plan::{Note, Rung};
use lapidary_reference::random_walk::mesh::{Boundary, Origin};
use lapidary_reference::spectral::Lost;
use lapidary_render as render;
use lapidary_render::file::{self, Format};
use lapidary_render::{Picture, ReferenceOptions, Settings, WalkOptions, WalkedPicture};
use lapidary_scene::Scene;
use std::mem::{Discriminant, discriminant, take};
use std::path::{Path, PathBuf};

/// Renders a scene: a built-in by name, or a .glb or .gltf file.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook render brilliant\n  ./cook render ruby --quality best --from 0,0\n  ./cook render brilliant --rung proxy-1+paper\n  ./cook render quartz --rung reference --size 256x256 --out quartz.exr\n  ./cook render my_stone.glb --size 1920x1080 --out stone.exr --environment studio.hdr"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    drawn: Drawn,
    /// Output file, PNG (tone-mapped sRGB) or EXR (linear, half float); SCENE.png in the current
    /// folder by default, or SCENE.picture.png if the scene is read from a file of that name.
    #[arg(short, long, value_name = "F.png|F.exr", help_heading = "Options")]
    out: Option<PathBuf>,
    /// So many pictures in place of one, of the bodies as they turn once about the vertical, under the same lights: F-000.png,
    /// F-001.png and so on.
    #[arg(long, value_name = "N", value_parser = number::whole(1..=MOST_PICTURES), help_heading = "Options")]
    turntable: Option<u32>,
    /// Glow around bright places, for a PNG: the share of light that is spread, above 0 and at most 1; 0.06 by `--bloom` alone.
    /// Only the written picture has it: ladders and tests do not.
    #[arg(long, value_name = "SHARE", num_args = 0..=1, default_missing_value = DEFAULT_BLOOM, value_parser = parse_share, help_heading = "Options")]
    bloom: Option<f32>,
    #[command(flatten)]
    reference: Option<Reference>,
    #[command(flatten)]
    walks: Option<Walks>,
}

/// Options of the reference for clear stones.
#[derive(clap::Args)]
#[command(next_help_heading = "The reference of clear stones")]
struct Reference {
    /// Number of wavelengths; 31 by default.
    #[arg(long, value_parser = number::whole(0..=usize::MAX))]
    wavelengths: Option<usize>,
    /// Share of a camera ray's energy that may be left untraced; 1e-4 by default.
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    energy_bound: Option<f64>,
}

/// Options of the reference for scattering bodies.
#[derive(clap::Args)]
#[command(next_help_heading = "The reference of scattering bodies")]
struct Walks {
    /// Walks per pixel; 256 by default.
    #[arg(long, value_parser = number::whole(0..=u32::MAX))]
    walks: Option<u32>,
    /// Where the walks start: starting from the lights gives less noise, but leaves out the
    /// environment.
    #[arg(long, value_name = "END", value_parser = parse_origin)]
    walks_from: Option<Origin>,
    /// Seed of the walks; 1 by default.
    #[arg(long, value_parser = number::whole(0..=u64::MAX))]
    seed: Option<u64>,
    /// Effect of surfaces on walks: none (matched), or refraction and reflection by the material's
    /// ior (dielectric).
    #[arg(long, value_parser = ["matched", "dielectric"])]
    boundary: Option<String>,
}

/// Most pictures of a turn: ten for each degree.
const MOST_PICTURES: u32 = 3600;

impl Walks {
    fn options(&self) -> WalkOptions {
        let usual = WalkOptions::default();
        WalkOptions {
            walks: self.walks.unwrap_or(usual.walks),
            from: self.walks_from.unwrap_or(usual.from),
            seed: self.seed.unwrap_or(usual.seed),
            boundary: match self.boundary.as_deref() {
                Some("dielectric") => Boundary::Dielectric,
                _ => usual.boundary,
            },
        }
    }
}

impl Reference {
    fn options(&self) -> ReferenceOptions {
        let usual = ReferenceOptions::default();
        ReferenceOptions {
            wavelengths: self.wavelengths.unwrap_or(usual.wavelengths),
            energy_bound: self.energy_bound.unwrap_or(usual.energy_bound),
        }
    }
}

/// [`render::BLOOM`] as a text.
const DEFAULT_BLOOM: &str = "0.06";

fn parse_share(text: &str) -> Result<f32, String> {
    let share = text.parse::<f32>().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| "expected a share above 0 and at most 1, such as 0.06; the scene comes before it".to_owned())
}

fn parse_origin(text: &str) -> Result<Origin, String> {
    named("end of a walk", text, Origin::ALL, Origin::name)
}

impl Arguments {
    /// The options of the references that were given.
    fn given(&self) -> Vec<Given> {
        let follows = self.reference.iter().map(|reference| Given {
            technique: "the reference of clear stones",
            flags: given([
                ("--wavelengths", reference.wavelengths.is_some()),
                ("--energy-bound", reference.energy_bound.is_some()),
            ]),
            draws: |rung, scatters| rung == Rung::Reference && !scatters,
        });
        let walks = self.walks.iter().map(|walks| Given {
            technique: "the reference of scattering bodies alone",
            flags: given([
                ("--walks", walks.walks.is_some()),
                ("--walks-from", walks.walks_from.is_some()),
                ("--seed", walks.seed.is_some()),
                ("--boundary", walks.boundary.is_some()),
            ]),
            draws: |rung, scatters| rung == Rung::Reference && scatters,
        });
        follows.chain(walks).collect()
    }
}

/// Whether a note from before drawing is repeated with more detail by a note from drawing.
fn is_told_again(note: &Note, found: &[Note]) -> bool {
    let Note::NotSolid { objects, rung: Rung::OpticalPath(_) | Rung::Diffusion(_), .. } = note else { return false };
    objects.count == 1
        && found.iter().any(|found| matches!(found, Note::Open { object, .. } if *object == objects.first))
}

/// Returns the name of a picture of `scene` in the current folder, which is none of the files that are read.
fn default_output<'a, Inputs: Iterator<Item = &'a Path>>(scene: &str, inputs: impl Fn() -> Inputs) -> PathBuf {
    let named = |ending: &str| {
        // Not the scene's name, which comes from the file: it would decide where the picture is written.
        let mut name = Scene::stem(scene);
        name.push(ending);
        PathBuf::from(name)
    };
    let plain = named(".png");
    if lapidary_files::refuse_input(&plain, inputs()).is_ok() { plain } else { named(".picture.png") }
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let (scene, settings, mut notes) = arguments.drawn.open(arguments.given())?;
    let settings = Settings {
        reference: arguments.reference.as_ref().map_or(settings.reference, Reference::options),
        walks: arguments.walks.as_ref().map_or(settings.walks, Walks::options),
        ..settings
    };
    let inputs = arguments.drawn.asked.inputs();
    let inputs = || inputs.iter().map(PathBuf::as_path);
    let out = arguments.out.clone().unwrap_or_else(|| default_output(&arguments.drawn.asked.scene, inputs));
    let format = Format::of_path(&out)?;
    if arguments.bloom.is_some() {
        refuse_bloom(format, settings.backdrop)?;
    }
    let mut lacking = scene.lacking.clauses();
    let size = [settings.width, settings.height];
    let (files, scenes): (Vec<PathBuf>, Box<dyn Iterator<Item = Scene>>) = match arguments.turntable {
        None => (vec![out], Box::new(std::iter::once(scene))),
        Some(count) => {
            let files = (0..count).map(|number| numbered(&out, number, count, format)).collect();
            (files, Box::new(scene.turntable(count, size)))
        }
    };
    files.iter().try_for_each(|file| check_output(file, inputs()))?;
    // Of a turn's further pictures a kind of note is told that none before had: what is small in one may not be so in another.
    let mut told: Vec<Discriminant<Note>> = Vec::new();
    for (scene, out) in scenes.zip(&files) {
        let mut picture = draw(context, &scene, &settings)?;
        if let Some(share) = arguments.bloom {
            render::bloom(&mut picture, settings.exposure, share);
        }
        file::write(&picture, out)?;
        notes.extend(planned(&scene, &settings));
        notes.retain(|note| !is_told_again(note, &picture.notes));
        notes.extend(picture.notes.iter().cloned());
        notes.retain(|note| !told.contains(&discriminant(note)));
        told.extend(notes.iter().map(discriminant));
        tell(&take(&mut notes), &take(&mut lacking));
        output::line(&out.display().to_string())?;
        tell_quality(&picture)?;
    }
    Ok(Outcome::Passed)
}

/// Refuses a glow where it would not be shown, or be taken for radiance.
fn refuse_bloom(format: Format, backdrop: bool) -> Result<(), Failure> {
    let reason = match (format, backdrop) {
        (Format::Exr, _) => ": an EXR holds the radiance itself; write a .png, or leave --bloom out",
        (Format::Png, false) => {
            " with --background none: straight alpha has no place for light where no body is; leave one of the two out"
        }
        (Format::Png, true) => return Ok(()),
    };
    Err(Failure(format!("--bloom{reason}")))
}

/// Refuses to write over what is read, and where nothing can be written.
fn check_output<'a>(out: &Path, inputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    lapidary_files::refuse_input(out, inputs)?;
    Ok(lapidary_files::check_writable(out)?)
}

/// Returns the file of one picture of `count`, whose names sort in their order: `ring-007.png` for `ring.png`, of a thousand
/// `ring-0007.png`.
fn numbered(out: &Path, number: u32, count: u32, format: Format) -> PathBuf {
    let width = count.to_string().len().max(3);
    let mut name = out.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{number:0width$}.{}", format.ending()));
    out.with_file_name(name)
}

fn draw(context: &Context, scene: &Scene, settings: &Settings) -> Result<Picture, Failure> {
    let bar = progress::bar(0, "rendering");
    let picture = render::render_reporting(context.gpu()?, scene, settings, &mut |done, total| {
        bar.set_length(total);
        bar.set_position(done);
    })?;
    bar.finish_and_clear();
    Ok(picture)
}

/// Tells what a reference says of its picture.
fn tell_quality(picture: &Picture) -> Result<(), Failure> {
    if let Some(Lost { max, mean }) = picture.lost {
        output::line(&format!(
            "energy of a camera ray that was not traced to its end: {max:.1e} at most, {mean:.1e} on average"
        ))?;
    }
    if let Some(WalkedPicture { error, walks, lost }) = picture.walked {
        output::line(&format!(
            "standard error {:.1} % of the mean brightness; {walks} walks, {lost} lost",
            100.0 * error
        ))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glow_is_for_pictures_that_are_looked_at() {
        assert!(refuse_bloom(Format::Png, true).is_ok());
        for (format, backdrop, says) in [(Format::Exr, true, ".png"), (Format::Png, false, "--background none")] {
            let Failure(message) = refuse_bloom(format, backdrop).expect_err("refused");
            assert!(message.starts_with("--bloom") && message.contains(says) && !message.contains('\n'), "{message}");
        }
        assert_eq!(parse_share(DEFAULT_BLOOM), Ok(render::BLOOM));
        assert!(["0", "-1", "1.1", "nan", "ring"].into_iter().all(|wrong| parse_share(wrong).is_err()));
    }

    #[test]
    fn pictures_of_a_turn_sort_by_their_names() {
        let name = |number, count| numbered(Path::new("a/ring.png"), number, count, Format::Png);
        assert_eq!(name(7, 36), Path::new("a/ring-007.png"));
        assert_eq!(name(998, 999), Path::new("a/ring-998.png"));
        assert_eq!(name(7, 1000), Path::new("a/ring-0007.png"));
        assert_eq!(name(3599, 3600), Path::new("a/ring-3599.png"));
    }
}
