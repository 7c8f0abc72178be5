//! `cook snapshots`.

use lapidary_cook::command::{Context, Failure, Outcome, output, progress};
use lapidary_cookbook::repository;
use lapidary_files::nearest::suggest;
use lapidary_snapshots as snapshot;
use lapidary_snapshots::{self, Committed};

/// Renders the committed pictures again and compares them, or accepts the new ones.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  ./cook snapshots\n  ./cook snapshots --accept\n  ./cook snapshots strip")]
pub struct Arguments {
    /// One picture, by its file name; all by default.
    #[arg(value_parser = parse_name)]
    name: Option<String>,
    /// Make the new pictures the references. Look at them first.
    #[arg(long)]
    accept: bool,
}

fn parse_name(text: &str) -> Result<String, String> {
    let names: Vec<&str> = Committed::all().map(Committed::name).collect();
    let known = names.contains(&text).then(|| text.to_owned());
    known.ok_or_else(|| format!("no such picture{}", suggest(text, &names)))
}

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    repository::required("snapshots")?;
    let gpu = context.gpu()?;
    let chosen: Vec<Committed> = Committed::all()
        .filter(|committed| arguments.name.as_ref().is_none_or(|name| name == committed.name()))
        .collect();
    let bar = progress::bar(chosen.len() as u64, "rendering");
    let mut outcome = Outcome::Passed;
    let mut lines = Vec::new();
    for committed in chosen {
        let (name, folder) = (committed.name(), committed.folder());
        bar.set_message(name);
        let pictures = committed.render(gpu)?;
        if arguments.accept {
            snapshot::accept(name, &pictures, &folder)?;
            lines.push(format!("{name:<24} accepted"));
        } else {
            match snapshot::compare(name, &pictures, &folder) {
                Ok(comparison) => {
                    let verdict = if comparison.holds() { "same" } else { "DIFFERENT" };
                    lines.push(format!(
                        "{name:<24} {verdict}: FLIP {:.4} (at most {}), of a thousandth above {:.4} (at most {}), \
                         relative RMSE {:.4} (at most {})",
                        comparison.flip,
                        snapshot::MOST_FLIP,
                        comparison.high_flip,
                        snapshot::MOST_HIGH_FLIP,
                        comparison.rmse,
                        snapshot::MOST_RMSE
                    ));
                    if !comparison.holds() {
                        outcome = Outcome::Failed;
                    }
                }
                Err(error) => {
                    lines.push(format!("{name:<24} FAILED: {error}"));
                    outcome = Outcome::Failed;
                }
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    output::line(&lines.join("\n"))?;
    Ok(outcome)
}
