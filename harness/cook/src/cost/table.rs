//! The gem ladder as text.

use super::proxy_sizes::AtSize;
use super::{Choice, Colours, MEASURES, Reflection, Report, RungReport, Seen, Steadiness};
use std::fmt::Write as _;

/// The paper's own figures for comparison: NVIDIA GeForce GTX 760, 1920×1080 filled by the stone,
/// section 5 and Table 1.
const PAPER: &str = "The paper's figures (GeForce GTX 760, 1920x1080 filled): proxy 3 ms, exact 15 ms (5 times); 20 us of CPU for both;\n\
    vertex/geometry/pixel shader 16/160/181 slots and 2304 bytes of constants (proxy), 16/160/152 slots and 15056 bytes (exact).";

pub(super) fn text(report: &Report) -> String {
    let mut text = String::new();
    ladder(&mut text, report);
    each_view(&mut text, report);
    colours(&mut text, &report.colours);
    choices(&mut text, &report.choices);
    steadiness(&mut text, &report.steadiness);
    sizes(&mut text, &report.sizes);
    reflections(&mut text, &report.reflections);
    let _ = writeln!(text, "\n{PAPER}");
    text
}

fn ladder(text: &mut String, report: &Report) {
    let Report { frame: [width, height], side, samples, .. } = report;
    let _ = writeln!(text, "{}", report.adapter);
    let _ = writeln!(
        text,
        "{:26} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10} {:>9} {:>9} {:>8}",
        "rung", "ms", "x proxy", "flip", "rmse", "energy", "change", "ms filled", "SPIR-V", "bytes", "us CPU"
    );
    for rung in &report.rungs {
        let view_ms = rung.view_ms();
        let ms = view_ms.map_or("-".to_owned(), |ms| format!("{ms:.2}"));
        let ratio = view_ms.zip(report.rung("proxy-1").and_then(RungReport::view_ms));
        let ratio = ratio.map_or("-".to_owned(), |(ms, proxy)| format!("{:.2}", ms / proxy));
        let filled = rung.milliseconds();
        let cpu = rung.timing.map_or("-".to_owned(), |timing| format!("{:.0}", timing.encode_us));
        let instructions = format!("{}+{}", rung.vertex_instructions, rung.fragment_instructions);
        let _ = writeln!(
            text,
            "{:26} {ms:>9} {ratio:>8} {:>8.4} {:>8.4} {:>8.4} {:>8.4} {filled:>10} {instructions:>9} {:>9} {cpu:>8}{}",
            rung.rung,
            rung.mean(0),
            rung.mean(1),
            rung.mean(2),
            rung.mean(3),
            rung.geometry_bytes,
            if rung.dominated { "  dominated" } else { "" }
        );
    }
    let _ = writeln!(
        text,
        "\nms, flip, rmse, |energy|, change: of the same pictures, {side}x{side} and samples a pixel: {samples}; means over the views. ms: \
         least of the rounds,\ninterleaved. Errors are against the spectral reference; change is from this frame to one turned by 0.05 \
         degrees, RMS over the\nreference's. ms filled: {width}x{height} pixels that the brilliant fills; * timed on 1/16 of them and \
         scaled. SPIR-V: instructions of\nvertex + fragment shader, specialised. bytes: what the geometry needs beside positions and \
         indices. dominated: another rung is\nfaster and, in the mean over the views, no worse by FLIP nor by RMSE."
    );
}

fn each_view(text: &mut String, report: &Report) {
    let measures = MEASURES.into_iter().enumerate().map(|(measure, name)| (Some(measure), name));
    for (measure, name) in measures.chain([(None, "ms")]) {
        let _ = write!(text, "\n{name:26}");
        for view in report.views.iter().chain(&report.concave) {
            let _ = write!(text, " {view:>17}");
        }
        for rung in &report.rungs {
            let _ = write!(text, "\n{:26}", rung.rung);
            for seen in rung.views.iter().chain(&rung.concave) {
                let value = |seen: &Seen| match measure {
                    Some(2) => Some(seen.errors.energy),
                    Some(measure) => Some(seen.of(measure)),
                    None => seen.ms,
                };
                let value = seen.as_ref().and_then(value).map_or("-".to_owned(), |value| format!("{value:.4}"));
                let _ = write!(text, " {value:>17}");
            }
        }
        text.push('\n');
    }
}

fn steadiness(text: &mut String, steadiness: &[Steadiness]) {
    let _ = writeln!(text, "\nChange from frame to frame under a turn of 0.05 degrees, by samples a pixel");
    let _ = writeln!(text, "{:20} {:>8} {:>10} {:>10}", "rung", "samples", "views", "brilliant");
    for Steadiness { rung, samples, change, brilliant } in steadiness {
        let brilliant = brilliant.map_or("-".to_owned(), |change| format!("{change:.4}"));
        let _ = writeln!(text, "{rung:20} {samples:>8} {change:>10.4} {brilliant:>10}");
    }
}

fn sizes(text: &mut String, sizes: &[AtSize]) {
    if sizes.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "\nBy size, 16 samples a pixel: mean radiance over the reference's, and RMSE over its root mean square"
    );
    let _ =
        writeln!(text, "{:12} {:14} {:>6} {:20} {:>8} {:>8}", "stone", "environment", "pixels", "rung", "mean", "rmse");
    for AtSize { stone, environment, size, rung, mean, rmse } in sizes {
        let _ = writeln!(text, "{stone:12} {environment:14} {size:>6} {rung:20} {mean:>8.3} {rmse:>8.3}");
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
