//! The ladder as text.

use super::{Choice, Colours, Errors, MEASURES, Reflection, Report};
use std::fmt::Write as _;

/// The paper's own figures, for comparison: NVIDIA GeForce GTX 760, 1920×1080 filled by the stone, section 5 and Table 1.
const PAPER: &str = "The paper's figures (GeForce GTX 760, 1920x1080 filled): proxy 3 ms, exact 15 ms (5 times); 20 us of CPU for both;\n\
    vertex/geometry/pixel shader 16/160/181 slots and 2304 bytes of constants (proxy), 16/160/152 slots and 15056 bytes (exact).";

pub(super) fn text(report: &Report) -> String {
    let mut text = String::new();
    ladder(&mut text, report);
    each_view(&mut text, report);
    colours(&mut text, &report.colours);
    choices(&mut text, &report.choices);
    reflections(&mut text, &report.reflections);
    let _ = writeln!(text, "\n{PAPER}");
    text
}

fn ladder(text: &mut String, report: &Report) {
    let [width, height] = report.frame;
    let _ = writeln!(text, "{}", report.adapter);
    let _ = writeln!(
        text,
        "{:26} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>8}",
        "rung", "ms", "x proxy", "flip", "rmse", "energy", "SPIR-V", "bytes", "us CPU"
    );
    for rung in &report.rungs {
        let ms = rung.milliseconds();
        let ratio = report.ratio(&rung.rung, "proxy-1").map_or("-".to_owned(), |ratio| format!("{ratio:.2}"));
        let cpu = rung.timing.map_or("-".to_owned(), |timing| format!("{:.0}", timing.encode_us));
        let instructions = format!("{}+{}", rung.vertex_instructions, rung.fragment_instructions);
        let _ = writeln!(
            text,
            "{:26} {ms:>10} {ratio:>8} {:>8.4} {:>8.4} {:>8.4} {instructions:>9} {:>9} {cpu:>8}{}",
            rung.rung,
            rung.mean(0),
            rung.mean(1),
            rung.mean(2),
            rung.geometry_bytes,
            if rung.dominated { "  dominated" } else { "" }
        );
    }
    let _ = writeln!(
        text,
        "\nms: least of the rounds, interleaved, for {width}x{height} pixels filled by the brilliant; * timed on 1/16 of the pixels and \
         scaled.\nflip, rmse, |energy|: means over the views, against the spectral reference. SPIR-V: instructions of vertex + \
         fragment shader,\nspecialised. bytes: what the geometry needs beside positions and indices. dominated: another rung is \
         faster and,\nin the mean over the views, no worse by FLIP nor by RMSE."
    );
}

fn each_view(text: &mut String, report: &Report) {
    for (measure, name) in MEASURES.into_iter().enumerate() {
        let _ = write!(text, "\n{name:26}");
        for view in &report.views {
            let _ = write!(text, " {view:>17}");
        }
        for rung in &report.rungs {
            let _ = write!(text, "\n{:26}", rung.rung);
            for errors in &rung.errors {
                let value = |errors: &Errors| if measure == 2 { errors.energy } else { errors.of(measure) };
                let _ = write!(text, " {:>17}", errors.as_ref().map_or("-".into(), |e| format!("{:.4}", value(e))));
            }
        }
        text.push('\n');
    }
}

fn colours(text: &mut String, colours: &[Colours]) {
    if colours.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "\nColours where the three wavelengths meet the same facets, RMS of the difference from separate wavelengths\n\
         {:12} {:18} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>16}",
        "geometry", "view", "shared", "none", "paper", "strength", "fitted", "tracker", "fitted/tracker"
    );
    for colours in colours {
        let _ = writeln!(
            text,
            "{:12} {:18} {:>6.1}% {:>9.5} {:>9.5} {:>9.5} {:>9.5} {:>9.5} {:>16.1}",
            colours.rung,
            colours.view,
            100.0 * colours.shared,
            colours.none_rms,
            colours.paper_rms,
            colours.strength,
            colours.fitted_rms,
            colours.tracker_rms,
            colours.fitted_rms / colours.tracker_rms
        );
    }
}

fn choices(text: &mut String, choices: &[Choice]) {
    if choices.is_empty() {
        return;
    }
    let _ = writeln!(text, "\nHow a ray ends, means over the views");
    let _ = writeln!(text, "{:20} {:28} {:>8} {:>8} {:>8}", "rung", "choice", "flip", "rmse", "energy");
    for (rung, choice, [flip, rmse, energy]) in Choice::means(choices) {
        let _ = writeln!(text, "{rung:20} {choice:28} {flip:>8.4} {rmse:>8.4} {energy:>+8.4}");
    }
}

fn reflections(text: &mut String, reflections: &[Reflection]) {
    let _ = writeln!(
        text,
        "\nTotal internal reflection at the first hit, brilliant face-up, share of the rays that enter by\n{:52} {:>7} {:>7}",
        "", "table", "crown"
    );
    for Reflection { mesh, table, crown } in reflections {
        let _ = writeln!(text, "{mesh:52} {:>6.1}% {:>6.1}%", 100.0 * table, 100.0 * crown);
    }
}
