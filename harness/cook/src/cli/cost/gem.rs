//! The gem ladder.

use super::{
    Context, Failure, Options, Outcome, Places, Report, Rung, Shown, behind_a_bar, file, number, output, parse_rung,
    parse_view, views,
};
use lapidary_cook::cost::{self, CostError, plot};

/// Ladder of the gem, timed. Takes minutes.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Rungs to measure, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung, conflicts_with = "from")]
    rungs: Vec<Rung>,
    /// Views to compare, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_view, conflicts_with = "from")]
    views: Vec<views::View>,
    /// Rounds of timing; 0 skips timing.
    #[arg(long, default_value_t = Options::default().rounds, conflicts_with = "from", value_parser = number::whole(0..=u32::MAX))]
    rounds: u32,
    /// Profile the cheapest rungs instead, with frames that leave out one part after another; with
    /// --out, written to gem_profile.txt.
    #[arg(long, conflicts_with_all = ["rungs", "views", "from", "json", "fill"])]
    profile: bool,
    #[command(flatten)]
    report: Report,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(rung) = arguments.rungs.iter().find(|rung| matches!(rung, Rung::Diffuse(_) | Rung::OpticalPath(_))) {
        let ladder = if matches!(rung, Rung::Diffuse(_)) { "cdrf" } else { "optical_path" };
        return Err(Failure(format!(
            "`gem` has no rung {rung}, which draws no clear stone; `./cook cost {ladder}` has it"
        )));
    }
    let mut options = Options { rounds: arguments.rounds, ..Options::default() };
    // The further data that a page needs are measured only with the whole ladder.
    options.sizes = arguments.rungs.is_empty() && arguments.views.is_empty();
    if !arguments.rungs.is_empty() {
        options.rungs.clone_from(&arguments.rungs);
    }
    if !arguments.views.is_empty() {
        (options.concave, options.views) = arguments.views.iter().partition(|view| views::CONCAVE.contains(view));
    }
    let places = Places::new("gem", &arguments.report)?;
    if arguments.profile {
        let gpu = context.gpu()?;
        let text = behind_a_bar(|progress| {
            let mut timing = |done, total| progress("timing", done, total);
            cost::profile(gpu, options.rounds.max(1), options.frame, &mut timing)
        })?;
        if let Some(out) = &arguments.report.out {
            file::replace(&out.join("gem_profile.txt"), format!("{text}\n").as_bytes())?;
        }
        output::line(&text)?;
        return Ok(Outcome::Passed);
    }
    let mut report = places.report(|| {
        let gpu = context.gpu()?;
        behind_a_bar(|progress| cost::run(gpu, &options, progress))
    })?;
    report.mark_dominated();
    let timed = arguments.report.out.is_some() && report.rungs.iter().any(|rung| rung.timing.is_some());
    let measures: &[&str] = if timed { &["flip", "rmse"] } else { &[] };
    let plot = |measure: &&str| Ok((format!("gem_{measure}.svg"), plot::svg(&report, measure)?));
    let shown = Shown {
        text: report.text(),
        rows: serde_json::to_string_pretty(&report.rows())?,
        plots: measures.iter().map(plot).collect::<Result<_, CostError>>()?,
    };
    places.write(&report, &shown)
}
