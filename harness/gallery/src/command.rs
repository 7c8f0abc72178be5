//! `cook gallery`.

use crate::{Site, pictures};
use lapidary_cook::command::{Context, Failure, Outcome, output, progress};
use lapidary_cookbook as cookbook;
use lapidary_cookbook::repository;
use lapidary_render::file;
use lapidary_snapshots::{Committed, WALKED};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Builds the gallery, a static site that needs no network: every technique, module and picture.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook gallery --open")]
pub struct Arguments {
    /// Output folder; target/gallery of the cookbook by default.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Render the committed pictures anew on this device, instead of taking their files.
    #[arg(long)]
    render: bool,
    /// Show the gallery in the browser.
    #[arg(long)]
    open: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let root = repository::required("gallery")?;
    let out = arguments.out.clone().unwrap_or_else(|| root.join("target/gallery"));
    let gpu = context.gpu()?;
    let rustdoc = rustdoc(&root)?;
    let rendered = tempfile::tempdir()?;
    let mut sources = pictures::committed();
    if arguments.render {
        render(context, rendered.path(), &mut sources)?;
    }
    for reference in &WALKED {
        let path = rendered.path().join([&reference.name(), "_walked.png"].concat());
        file::write(&reference.picture(gpu)?, &path)?;
    }
    sources.extend(pictures::walked(rendered.path()));
    let bar = progress::bar(1, "writing");
    let site =
        Site { root: &root, adapter: gpu.describe(), pictures: sources, rustdoc: Some(rustdoc), device: Some(gpu) };
    let index = crate::write(&out, &site)?;
    bar.finish_and_clear();
    let index = index.canonicalize().unwrap_or(index);
    output::line(&index.display().to_string())?;
    if arguments.open {
        open(&index)?;
    }
    Ok(Outcome::Passed)
}

/// Renders the committed pictures into a folder, and takes their files instead of the committed ones.
fn render(context: &Context, folder: &Path, sources: &mut [pictures::Source]) -> Result<(), Failure> {
    let gpu = context.gpu()?;
    let bar = progress::bar(Committed::COUNT as u64, "rendering");
    for (committed, source) in Committed::all().zip(sources) {
        bar.set_message(committed.name());
        let [seen, _] = committed.render(gpu)?;
        source.file = folder.join([committed.name(), ".png"].concat());
        file::write(&seen, &source.file)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(())
}

/// Lets rustdoc write the mirrors' documentation, and returns its folder.
fn rustdoc(root: &Path) -> Result<PathBuf, Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // A target folder of its own: it holds these crates alone, whatever else was documented.
    let target = root.join("target/rustdoc");
    // Pages of modules that are gone would stay.
    if target.join("doc").exists() {
        std::fs::remove_dir_all(target.join("doc"))?;
    }
    let mut command = Command::new(cargo);
    command.current_dir(root).args(["doc", "--no-deps", "--quiet", "--lib", "--target-dir"]).arg(&target);
    command.args(
        cookbook::modules()
            .iter()
            .flat_map(|module| ["--package".to_owned(), ["lapidary-", &module.name.replace('_', "-")].concat()]),
    );
    command.args(["--package", "lapidary-wgsl"]).stdout(Stdio::null());
    match command.status() {
        Ok(status) if status.success() => Ok(target.join("doc")),
        Ok(_) => Err(Failure("cargo doc failed for the mirrors; its messages are above".to_owned())),
        Err(error) => Err(Failure(format!("cargo doc cannot be run for the mirrors: {error}"))),
    }
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
