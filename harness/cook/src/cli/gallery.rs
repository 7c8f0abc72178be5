//! `cook gallery`.

use super::{Context, Failure, Outcome, output, progress};
use lapidary_cook::cost::plot::SIZE as PLOT_SIZE;
use lapidary_cook::gallery::{self, Picture, Site};
use lapidary_cook::repository;
use lapidary_cook::snapshot::{Committed, EXR_SIDE, WALKED};
use lapidary_render::file;
use std::path::{Path, PathBuf};

/// Renders every picture and builds the gallery, a static page that needs no network.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook gallery --open")]
pub(super) struct Arguments {
    /// Output folder; target/gallery of the cookbook by default.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Show the gallery in the browser.
    #[arg(long)]
    open: bool,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let root = repository::required("gallery")?;
    let out = arguments.out.clone().unwrap_or_else(|| root.join("target/gallery"));
    let gpu = context.gpu()?;
    let rendered = tempfile::tempdir()?;
    let bar = progress::bar(Committed::COUNT as u64, "rendering");
    let mut pictures = Vec::new();
    for committed in Committed::all() {
        bar.set_message(committed.name());
        let path = rendered.path().join(format!("{}.png", committed.name()));
        let [seen, _] = committed.render(gpu)?;
        file::write(&seen, &path)?;
        pictures.push(Picture {
            title: committed.title().to_owned(),
            file: path,
            paragraph: committed.caption().to_owned(),
            command: committed.command(),
            size: (seen.width, seen.height),
        });
        bar.inc(1);
    }
    for reference in &WALKED {
        let path = rendered.path().join(format!("{}_walked.png", reference.name()));
        file::write(&reference.picture(gpu)?, &path)?;
        pictures.push(Picture {
            title: reference.title.to_owned(),
            file: path,
            paragraph: format!(
                "What random walks find, {} for each pixel: light that enters anywhere, is scattered inside and leaves towards the eye. \
                 They know thickness and shadows, which no reflectance function does, and all ways, of which the cheapest is one.",
                reference.walks
            ),
            command: reference.command(),
            size: (EXR_SIDE, EXR_SIDE),
        });
    }
    bar.finish_and_clear();
    let figures = plots(&root);
    let index = gallery::write(&out, &Site { adapter: gpu.describe(), pictures: &pictures, figures: &figures })?;
    let index = index.canonicalize().unwrap_or(index);
    output::line(&index.display().to_string())?;
    if arguments.open {
        open(&index)?;
    }
    Ok(Outcome::Passed)
}

/// Committed plots, each with the name of its module or recipe. Measuring again takes minutes and a
/// quiet machine.
fn plots(root: &Path) -> Vec<(String, Picture)> {
    let figure = |name: &str, file: &str, command: &str, title: &str, paragraph: &str| {
        let picture = Picture {
            title: title.to_owned(),
            file: root.join("docs/measurements").join(file),
            paragraph: paragraph.to_owned(),
            command: command.to_owned(),
            size: PLOT_SIZE,
        };
        (name.to_owned(), picture)
    };
    let gem = "./cook cost gem --out docs/measurements/lavapipe";
    let sphere = "./cook cost sphere --out docs/measurements/random_walk";
    let cdrf = "./cook cost cdrf --out docs/measurements/lavapipe";
    let paths = "./cook cost optical_path --out docs/measurements/lavapipe";
    vec![
        figure(
            "gem",
            "lavapipe/gem_flip.svg",
            gem,
            "What accuracy costs: FLIP",
            "Time of a picture against its visible difference from the spectral reference, means over seven views. On the grey line lie the \
                rungs to choose from: nothing faster is better.",
        ),
        figure(
            "gem",
            "lavapipe/gem_rmse.svg",
            gem,
            "What accuracy costs: RMSE",
            "The same by the error in linear radiance.",
        ),
        figure(
            "gem",
            "lavapipe/gem_growth.svg",
            gem,
            "What facets cost",
            "Time of a frame that a brilliant fills against the number of its facets, eight hits. The walk's time hardly depends on it.",
        ),
        figure(
            "cdrf",
            "lavapipe/cdrf.svg",
            cdrf,
            "What accuracy costs",
            "Time of a frame that lit skin fills against the largest error of the reflectance. On the grey lines lie the rungs to choose from: \
                nothing faster is better.",
        ),
        figure(
            "optical_path",
            "lavapipe/optical_path_error.svg",
            paths,
            "What accuracy costs",
            "Time of a frame of the bunny against the error of the cost on the ball, which has a closed form, by solver and size of the grid. On \
                the grey line lie the rungs to choose from: nothing faster is better.",
        ),
        figure(
            "optical_path",
            "lavapipe/optical_path_growth.svg",
            paths,
            "How the time grows",
            "Time against the cells along an edge of the grid: solvers that look at every voxel in every pass grow faster than those that \
                look at what changes.",
        ),
        figure(
            "cdrf",
            "random_walk/sphere_sigma.svg",
            sphere,
            "The best width over the radius",
            "Width times radius, in mean free paths, that brings the function nearest to random walks through spheres. Were the width \
                proportional to curvature, lines would be level.",
        ),
        figure(
            "cdrf",
            "random_walk/sphere_profile.svg",
            sphere,
            "Spheres and the best function",
            "The scattered light that leaves a sphere by the angle from the light, as random walks give it with their standard errors, and the \
                function that comes nearest.",
        ),
    ]
}

/// Opens the page with the system's default program.
fn open(page: &Path) -> Result<(), Failure> {
    let (program, first) = match std::env::consts::OS {
        "macos" => ("open", None),
        "windows" => ("cmd", Some(["/C", "start", ""])),
        _ => ("xdg-open", None),
    };
    let mut command = std::process::Command::new(program);
    command.args(first.into_iter().flatten()).arg(page);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        _ => Err(Failure(format!("no browser could be opened with `{program}`; open {} yourself", page.display()))),
    }
}
