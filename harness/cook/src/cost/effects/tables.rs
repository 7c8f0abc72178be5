//! The report as text, and as a table for the pages of `docs/`.

use super::{EffectsReport, Frame, Study};
use crate::cost::page::{Table, Tables, header, row};
use std::fmt::Write as _;

impl Tables for EffectsReport {
    const TABLES: &'static [Table<Self>] = &[("effects", page_table)];

    fn whole(&self) -> Result<(), String> {
        let untimed = self.studies.iter().flat_map(|study| &study.frames).any(|frame| frame.timing.is_none());
        if self.studies.is_empty() || untimed {
            return Err("the report has no times; only a whole report fills a page".to_owned());
        }
        Ok(())
    }
}

/// Formats the signed difference from another frame's value.
fn beyond(value: f64, below: Option<f64>, digits: usize) -> String {
    below.map_or_else(|| "–".to_owned(), |below| format!("{:+.digits$}", value - below))
}

fn cells(study: &Study, frame: &Frame) -> Vec<String> {
    let below = study.below(frame).filter(|below| below.effects != frame.effects);
    let kibi = |frame: &Frame| frame.bytes as f64 / 1024.0;
    let ms = |frame: &Frame| frame.timing.map(|timing| timing.ms);
    let time = ms(frame).map_or_else(|| "–".to_owned(), |ms| format!("{ms:.1}"));
    let more = ms(frame).map_or_else(|| "–".to_owned(), |value| beyond(value, below.and_then(ms), 1));
    vec![
        frame.effects.clone(),
        time,
        more,
        frame.instructions.to_string(),
        beyond(frame.instructions as f64, below.map(|below| below.instructions as f64), 0),
        format!("{:.0}", kibi(frame)),
        beyond(kibi(frame), below.map(kibi), 1),
        frame.steps.to_string(),
    ]
}

const COLUMNS: [&str; 8] = ["effects", "ms", "more", "instructions", "more", "KiB", "more", "draws, dispatches"];

/// Returns the report as text.
pub(super) fn text(report: &EffectsReport) -> String {
    let mut text = String::new();
    let [width, height] = report.frame;
    let _ = writeln!(
        text,
        "{}; frames of {width}x{height}, displayed; the least of {} interleaved rounds. `more` is beyond the frame without effects, or with what the effect stands on.",
        report.adapter, report.rounds
    );
    for study in &report.studies {
        let _ = writeln!(text, "\n{} by {}", study.scene, study.rung);
        let lines = std::iter::once(COLUMNS.map(str::to_owned).to_vec())
            .chain(study.frames.iter().map(|frame| cells(study, frame)));
        for line in lines {
            let _ = write!(text, "  {:<42}", line[0]);
            for (cell, width) in line[1..].iter().zip([8, 8, 13, 8, 10, 10, 18]) {
                let _ = write!(text, "{cell:>width$}");
            }
            text.push('\n');
        }
    }
    text
}

/// Returns the report as a table for a page.
fn page_table(report: &EffectsReport) -> String {
    let mut table = String::new();
    let [width, height] = report.frame;
    let _ = writeln!(table, "{}; {width}x{height}; the least of {} rounds.\n", report.adapter, report.rounds);
    table.push_str(&header(&["scene and rung", COLUMNS[0], COLUMNS[1], "more", "instructions", "more", "KiB", "more"]));
    for study in &report.studies {
        for (place, frame) in study.frames.iter().enumerate() {
            let name = if place == 0 { format!("{} by `{}`", study.scene, study.rung) } else { String::new() };
            let cells: Vec<String> = std::iter::once(name).chain(cells(study, frame).into_iter().take(7)).collect();
            row(&mut table, &cells);
        }
    }
    table
}
