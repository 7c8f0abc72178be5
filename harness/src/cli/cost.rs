//! `cook cost`.

use super::{Context, Failure, Outcome, output, progress};
use lapidary_harness::cost::{self, CostError, Options, Report, page, plot, views};
use lapidary_harness::render::Rung;
use lapidary_harness::render::file;
use std::path::{Path, PathBuf};

/// What accuracy costs: the error and the time of every rung of a ladder.
///
/// Takes minutes. Times are the least of interleaved rounds; leave the machine alone meanwhile.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook cost gem\n  ./cook cost gem --rungs proxy-1,convex-1,bvh-1,triangles-1 --rounds 15\n  ./cook cost gem --json --out target/cost\n  ./cook cost gem --from docs/measurements/lavapipe/gem.json --fill docs/gem_ladder.md,docs/gem_proxy.md"
)]
pub(super) struct Arguments {
    /// The ladder: gem.
    #[arg(default_value = "gem")]
    technique: String,
    /// Rungs to measure, comma-separated; all where left out.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung)]
    rungs: Vec<Rung>,
    /// Views to compare in, comma-separated; all where left out.
    #[arg(long, value_delimiter = ',', value_parser = parse_view)]
    views: Vec<views::View>,
    /// Rounds of timing; 0 leaves times out.
    #[arg(long, default_value_t = Options::default().rounds)]
    rounds: u32,
    /// Show an earlier run's gem.json again instead of measuring.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["rungs", "views", "rounds"])]
    from: Option<PathBuf>,
    /// One JSON document on stdout, a row for each rung, measure and view, and nothing else.
    #[arg(long)]
    json: bool,
    /// A folder for gem.txt, gem.json (everything), gem_flip.svg and gem_rmse.svg.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Pages, comma-separated, whose generated tables are made anew.
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    fill: Vec<PathBuf>,
    /// Where the time of the cheapest rungs goes instead: frames from which one thing after another is taken away; with --out,
    /// gem_profile.txt.
    #[arg(long, conflicts_with_all = ["rungs", "views", "from", "json", "fill"])]
    profile: bool,
}

fn parse_rung(text: &str) -> Result<Rung, String> {
    match text.parse()? {
        Rung::Reference => Err("the reference is what the others are compared with".to_owned()),
        rung => Ok(rung),
    }
}

fn parse_view(text: &str) -> Result<views::View, String> {
    let names: Vec<&str> = views::VIEWS.iter().map(|view| view.name).collect();
    let found = views::VIEWS.iter().find(|view| view.name == text).copied();
    found.ok_or_else(|| format!("no such view{}", lapidary_harness::nearest::suggest(text, &names)))
}

/// Runs what takes minutes behind a progress bar.
fn behind_a_bar<T>(
    run: impl FnOnce(&mut dyn FnMut(&'static str, u64, u64)) -> Result<T, CostError>,
) -> Result<T, Failure> {
    let bar = progress::bar(0, "measuring");
    let done = run(&mut |what, done, total| {
        bar.set_message(what);
        bar.set_length(total);
        bar.set_position(done);
    })?;
    bar.finish_and_clear();
    Ok(done)
}

fn read_text(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|error| Failure(format!("{}: cannot be read: {error}", path.display())))
}

fn read(path: &Path) -> Result<Report, Failure> {
    serde_json::from_str(&read_text(path)?).map_err(|error| {
        Failure(format!("{}: not a gem.json of `./cook cost gem --out`: {error}; measure anew", path.display()))
    })
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.technique != "gem" {
        return Err(CostError::Technique(arguments.technique.clone()).into());
    }
    let mut options = Options { rounds: arguments.rounds, ..Options::default() };
    if !arguments.rungs.is_empty() {
        options.rungs.clone_from(&arguments.rungs);
    }
    if !arguments.views.is_empty() {
        options.views.clone_from(&arguments.views);
    }
    if let Some(out) = &arguments.out {
        let failed = |error: std::io::Error| Failure(format!("{}: cannot be made: {error}", out.display()));
        std::fs::create_dir_all(out).map_err(failed)?;
        file::check_writable(&out.join("gem.txt"))?;
    }
    if arguments.profile {
        let gpu = context.gpu()?;
        let text = behind_a_bar(|progress| {
            let mut timing = |done, total| progress("timing", done, total);
            cost::profile(gpu, options.rounds.max(1), options.frame, &mut timing)
        })?;
        if let Some(out) = &arguments.out {
            file::replace(&out.join("gem_profile.txt"), format!("{text}\n").as_bytes())?;
        }
        output::line(&text)?;
        return Ok(Outcome::Passed);
    }
    let pages: Vec<(&PathBuf, String)> =
        arguments.fill.iter().map(|path| Ok((path, read_text(path)?))).collect::<Result<_, Failure>>()?;
    for (path, page) in &pages {
        page::check(page).map_err(|error| Failure(format!("{}: {error}", path.display())))?;
        file::check_writable(path)?;
    }
    let mut report = match &arguments.from {
        Some(path) => read(path)?,
        None => {
            let gpu = context.gpu()?;
            behind_a_bar(|progress| cost::run(gpu, &options, progress))?
        }
    };
    report.mark_dominated();
    let filled: Vec<(&PathBuf, String)> = pages
        .iter()
        .map(|(path, page)| match page::fill(page, &report) {
            Ok(filled) => Ok((*path, filled)),
            Err(error) => Err(Failure(format!("{}: {error}", path.display()))),
        })
        .collect::<Result<_, _>>()?;
    let text = report.text();
    if let Some(out) = &arguments.out {
        let write = |name: &str, contents: &str| -> Result<(), Failure> {
            Ok(file::replace(&out.join(name), contents.as_bytes())?)
        };
        write("gem.txt", &text)?;
        write("gem.json", &serde_json::to_string_pretty(&report)?)?;
        if report.rungs.iter().any(|rung| rung.timing.is_some()) {
            for measure in ["flip", "rmse"] {
                write(&format!("gem_{measure}.svg"), &plot::svg(&report, measure)?)?;
            }
        }
    }
    for (path, page) in filled {
        file::replace(path, page.as_bytes())?;
    }
    if arguments.json {
        output::line(&serde_json::to_string_pretty(&report.rows())?)?;
    } else {
        output::line(text.trim_end())?;
    }
    Ok(Outcome::Passed)
}
