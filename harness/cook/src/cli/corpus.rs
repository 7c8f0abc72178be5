//! `cook corpus`.

use super::asked::{Asked, parse_quality, parse_size};
use super::environment::EnvironmentAsked;
use super::{Context, Failure, Outcome, output, progress};
use lapidary_plan::{Decisions, Geometry, Quality};
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_render::file;
use lapidary_scene::Scene;
use lapidary_scene::convex::planes_of_convex;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Opens every glTF file of a folder and of those in it, and prints a table: a row for each file, with its stones, what of it is
/// not drawn, and the time. A file that cannot be read or drawn has a row as well; the exit code is then 1.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook corpus my_rings --jewellery\n  ./cook corpus my_rings --jewellery --out pictures --size 1024x1024"
)]
pub(super) struct Arguments {
    /// Folder of .glb and .gltf files.
    folder: PathBuf,
    /// Draw each file as well, into this folder, as `ring.glb.png` for `ring.glb`; the table goes there as `corpus.json`.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Width and height of the pictures in pixels.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = parse_size)]
    size: (u32, u32),
    /// Give bodies that look like stones or metals, and are not marked so, the preset of what they look like.
    #[arg(long)]
    jewellery: bool,
    /// Time budget of each object's technique: fast, good or best; good by default.
    #[arg(long, value_name = "QUALITY", value_parser = parse_quality)]
    quality: Option<Quality>,
    /// Light from far away: studio, jeweller (softboxes, black flags and small bright lights), or a latitude-longitude .exr or
    /// .hdr image; by default each file's own, which is the studio unless it names another.
    #[arg(long, value_name = "NAME|FILE", value_parser = EnvironmentAsked::parser())]
    environment: Option<EnvironmentAsked>,
}

/// The table of the folder that the pictures go to.
const TABLE: &str = "corpus.json";

/// Widest column of names; longer names move their row's figures.
const WIDEST: usize = 60;

/// What became of a file.
#[derive(Serialize)]
struct Row {
    /// Its path in the folder.
    file: String,
    /// Why it could not be read or drawn.
    error: Option<String>,
    found: Option<Found>,
    /// Time in which it was opened, planned and drawn.
    seconds: f64,
    /// Its picture's path in the output folder.
    picture: Option<String>,
}

/// What a file holds.
#[derive(Serialize)]
struct Found {
    /// Clear bodies with an inside, each copy counted.
    stones: usize,
    /// Those that are drawn by a map of their facets.
    walked: usize,
    /// Share of the stones that are convex, as they are drawn; `None` without stones.
    convex: Option<f64>,
    /// What the file asks for and is not drawn.
    lacking: Vec<String>,
}

impl Found {
    fn of(scene: &Scene, settings: &Settings) -> Self {
        let decisions = Decisions::all(scene, &settings.request());
        let (mut stones, mut walked, mut convex) = (0, 0, 0);
        for (object, decisions) in scene.objects.iter().zip(&decisions) {
            if !object.material.has_clear_inside() || object.mesh.indices.is_empty() {
                continue;
            }
            let count = object.copies.as_ref().map_or(1, |copies| copies.places.len());
            let of = |is_so: bool| if is_so { count } else { 0 };
            stones += count;
            walked += of(decisions.rung.geometry_of_inside() == Some(Geometry::Walk));
            convex += of(planes_of_convex(object.shape()).is_some());
        }
        let convex = (stones > 0).then(|| convex as f64 / stones as f64);
        Self { stones, walked, convex, lacking: scene.lacking.clauses() }
    }
}

impl Row {
    /// Formats the row of the table.
    fn line(&self, width: usize) -> String {
        let Self { file, error, found, seconds, picture } = self;
        let Some(Found { stones, walked, convex, lacking }) = found else {
            return format!("{file:width$} error: {}", error.as_deref().unwrap_or_default());
        };
        let convex = convex.map_or("-".to_owned(), |convex| format!("{convex:.2}"));
        let mut line = format!("{file:width$} {stones:>6} {walked:>6} {convex:>6} {:>7} {seconds:>7.1}", lacking.len());
        let error = error.as_ref().map(|error| format!("error: {error}"));
        for part in picture.iter().chain(&error).chain(lacking.first()) {
            line.push_str("  ");
            line.push_str(part);
        }
        line
    }
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let files = files(&arguments.folder)?;
    if files.is_empty() {
        return Err(Failure(format!("{}: has no .glb or .gltf file; name another folder", arguments.folder.display())));
    }
    // Read here, once for all files: one that cannot be read is told before any.
    if let Some(environment) = &arguments.environment {
        environment.make()?;
    }
    if let Some(out) = &arguments.out {
        std::fs::create_dir_all(out).map_err(|error| in_folder(out, &error))?;
        lapidary_files::check_writable(&out.join(TABLE))?;
    }
    let width = files.iter().map(|file| file.to_string_lossy().chars().count()).max().unwrap_or(0).clamp(4, WIDEST);
    output::line(&format!("{:width$} stones walked convex lacking seconds", "file"))?;
    let bar = progress::bar(files.len() as u64, "files");
    let mut rows = Vec::new();
    for file in &files {
        let row = arguments.row(context, file);
        bar.suspend(|| output::line(&row.line(width)))?;
        bar.inc(1);
        rows.push(row);
    }
    bar.finish_and_clear();
    if let Some(out) = &arguments.out {
        lapidary_files::replace(&out.join(TABLE), serde_json::to_string_pretty(&rows)?.as_bytes())?;
    }
    let failed = rows.iter().filter(|row| row.error.is_some()).count();
    if failed == 0 {
        return Ok(Outcome::Passed);
    }
    output::remark(&format!("{failed} of {} files could not be read or drawn", rows.len()));
    Ok(Outcome::Failed)
}

impl Arguments {
    /// Opens a file of the folder, and draws it if that was asked for.
    fn row(&self, context: &Context, file: &Path) -> Row {
        let start = Instant::now();
        let mut row = Row { file: file.display().to_string(), error: None, found: None, seconds: 0.0, picture: None };
        row.error = self.fill(context, file, &mut row).err().map(|Failure(message)| message);
        row.seconds = start.elapsed().as_secs_f64();
        row
    }

    fn fill(&self, context: &Context, file: &Path, row: &mut Row) -> Result<(), Failure> {
        let path = self.folder.join(file);
        let scene = path.to_str().ok_or_else(|| Failure("its name is no Unicode; rename it".to_owned()))?;
        let asked = Asked {
            scene: scene.to_owned(),
            size: self.size,
            jewellery: self.jewellery,
            quality: self.quality,
            environment: self.environment.clone(),
            ..Asked::default()
        };
        let opened = asked.open()?;
        let (settings, _) = asked.settings(&opened)?;
        row.found = Some(Found::of(&opened.scene, &settings));
        let Some(out) = &self.out else { return Ok(()) };
        let mut name = file.as_os_str().to_owned();
        name.push(".png");
        let picture = out.join(&name);
        let folder = picture.parent().unwrap_or(out);
        std::fs::create_dir_all(folder).map_err(|error| in_folder(folder, &error))?;
        lapidary_files::refuse_input(&picture, asked.inputs().iter().map(PathBuf::as_path))?;
        file::write(&render::render(context.gpu()?, &opened.scene, &settings)?, &picture)?;
        row.picture = Some(name.to_string_lossy().into_owned());
        Ok(())
    }
}

/// Returns the paths of the glTF files in a folder and the folders in it, sorted. Links to folders are not followed.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    let mut waiting = vec![PathBuf::new()];
    while let Some(inner) = waiting.pop() {
        let path = if inner.as_os_str().is_empty() { folder.to_owned() } else { folder.join(&inner) };
        for entry in std::fs::read_dir(&path).map_err(|error| in_folder(&path, &error))? {
            let entry = entry.map_err(|error| in_folder(&path, &error))?;
            let name = inner.join(entry.file_name());
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                waiting.push(name);
            } else if name
                .extension()
                .is_some_and(|ending| ["glb", "gltf"].iter().any(|known| ending.eq_ignore_ascii_case(known)))
            {
                found.push(name);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn in_folder(path: &Path, error: &std::io::Error) -> Failure {
    Failure(format!("{}: {error}; name a folder that can be read and written", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(error: Option<&str>, found: Option<Found>) -> Row {
        Row { file: "ring.glb".to_owned(), error: error.map(str::to_owned), found, seconds: 1.25, picture: None }
    }

    #[test]
    fn a_row_is_a_line() {
        let found = |lacking: &[&str]| {
            let lacking = lacking.iter().map(|line| (*line).to_owned()).collect();
            Some(Found { stones: 53, walked: 52, convex: Some(1.0), lacking })
        };
        assert_eq!(row(None, found(&[])).line(10), "ring.glb       53     52   1.00       0     1.2");
        let lost = row(None, found(&["emission", "metal"])).line(8);
        assert_eq!(lost, "ring.glb     53     52   1.00       2     1.2  emission");
        let drawn = Row { picture: Some("ring.glb.png".to_owned()), ..row(Some("lost"), found(&["metal"])) }.line(8);
        assert_eq!(drawn, "ring.glb     53     52   1.00       1     1.2  ring.glb.png  error: lost  metal");
        assert_eq!(row(Some("is empty"), None).line(10), "ring.glb   error: is empty");
        let none = Found { stones: 0, walked: 0, convex: None, lacking: Vec::new() };
        assert_eq!(row(None, Some(none)).line(8), "ring.glb      0      0      -       0     1.2");
    }

    #[test]
    fn files_of_folders_in_the_folder_are_found() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["b.glb", "a.GLTF", "in/side/c.glb", "in/c.bin", "glb"] {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            std::fs::write(path, "").expect("written");
        }
        let found = files(folder.path()).expect("read");
        assert_eq!(found, ["a.GLTF", "b.glb", "in/side/c.glb"].map(PathBuf::from));
        assert!(files(&folder.path().join("none")).is_err());
    }
}
