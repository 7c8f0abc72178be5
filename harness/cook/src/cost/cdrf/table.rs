//! The ladder as text.

use super::scenes::SIDE;
use super::{BLUR, CdrfReport, CurvatureSource, LAMBERT, Part, RungReport};
use std::fmt::Write as _;

/// The paper's own figures for comparison.
const PAPER: &str = "The paper's figures, by table-256-rgba8 on a PlayStation 3, the GPU's part alone: 5.5 % over Lambert, and 379 % faster (4.8 times as\n\
    fast) than a blur in a texture of 1024x1024.";

/// Placeholder for a missing figure.
pub(super) const NONE: &str = "-";

pub(super) fn text(report: &CdrfReport) -> String {
    let mut text = format!("{}\n", report.adapter);
    errors(&mut text, report);
    for part in Part::ALL {
        times(&mut text, report, part);
    }
    let [width, height] = report.frame;
    let _ = writeln!(
        text,
        "\nms: least of {} interleaved rounds for {width}x{height} pixels; * timed on 1/16 of the pixels and scaled. lit: skin_bunny fills \
         the frame, under one light.\nwhole: skin_bunny before a backdrop, in the studio and under one light, tone-mapped and encoded. \
         screen, vertex: where curvature\ncomes from. + Lambert: what it takes beyond Lambert's law. blur /: how many times as long the \
         texture's blur takes. SPIR-V: instructions\nof vertex + fragment shader, specialised; the blur has other shaders besides. dominated: \
         in the lit part another rung is faster with\ncurvature from either source, and errs no more.",
        report.rounds
    );
    scenes(&mut text, report);
    tables(&mut text, report);
    let _ = writeln!(text, "\n{PAPER}");
    text
}

/// Formats a number that spans many powers of ten.
pub(super) fn scientific(value: Option<f64>) -> String {
    value.map_or(NONE.to_owned(), |value| format!("{value:.1e}"))
}

/// Formats the time in milliseconds, with a star if only part of the frame was timed.
pub(super) fn milliseconds(rung: &RungReport, part: Part, source: CurvatureSource) -> String {
    let timing = rung.frame(part, source).and_then(|frame| frame.timing);
    timing.map_or(NONE.to_owned(), |timing| format!("{:.1}{}", timing.ms, if timing.share < 1.0 { "*" } else { "" }))
}

/// Formats the additional time of `rung` relative to Lambert's law.
pub(super) fn over_lambert(report: &CdrfReport, rung: &str, part: Part, source: CurvatureSource) -> String {
    let ratio = report.ratio(rung, LAMBERT, part, source);
    ratio.map_or(NONE.to_owned(), |ratio| format!("{:+.1} %", 100.0 * (ratio - 1.0)))
}

/// Formats the time of the blur divided by the time of `rung`.
pub(super) fn under_blur(report: &CdrfReport, rung: &str, part: Part, source: CurvatureSource) -> String {
    report.ratio(BLUR, rung, part, source).map_or(NONE.to_owned(), |ratio| format!("{ratio:.1}"))
}

/// Formats the residuals against random walks, with a free and with a fixed scale.
pub(super) fn residuals(rung: &RungReport) -> String {
    rung.residuals.map_or(NONE.to_owned(), |found| format!("{:.4} / {:.4}", found.free, found.fixed))
}

fn errors(text: &mut String, report: &CdrfReport) {
    let _ =
        writeln!(text, "{:20} {:>9} {:>9} {:>17} {:>10} {:>8}", "rung", "largest", "rms", "walks", "textures", "mesh");
    for rung in &report.rungs {
        let _ = writeln!(
            text,
            "{:20} {:>9} {:>9} {:>17} {:>10} {:>8}{}",
            rung.rung,
            scientific(rung.distance.map(|distance| distance.largest)),
            scientific(rung.distance.map(|distance| distance.rms)),
            residuals(rung),
            rung.texture_bytes,
            rung.mesh_bytes,
            if rung.dominated { "  dominated" } else { "" }
        );
    }
    let _ = writeln!(
        text,
        "\nlargest, rms: from the convolution, angles 0 to 180 degrees, sigma 0 to 3; spherical: from its own definition, while from the \
         circle's it is\n{} and {}. walks: what is left beside {} spheres of random walks, each with the sigma that fits it best; scale \
         free / fixed.\ntextures: bytes for one material. mesh: bytes for its {} vertices beside positions, normals and indices: \
         curvatures, where they come from\nthere; for the blur texture coordinates and halos.",
        scientific(Some(report.spherical_from_circular.largest)),
        scientific(Some(report.spherical_from_circular.rms)),
        report.spheres,
        report.vertices
    );
}

fn times(text: &mut String, report: &CdrfReport, part: Part) {
    let _ = write!(text, "\n{:20}", part.name());
    for source in CurvatureSource::ALL {
        let _ = write!(text, " | {:>9} {:>10} {:>7} {:>9}", source.name(), "+ Lambert", "blur /", "SPIR-V");
    }
    text.push('\n');
    for rung in &report.rungs {
        let _ = write!(text, "{:20}", rung.rung);
        for source in CurvatureSource::ALL {
            let counts = rung.frame(part, source).map_or(NONE.to_owned(), |frame| {
                format!("{}+{}", frame.vertex_instructions, frame.fragment_instructions)
            });
            let _ = write!(
                text,
                " | {:>9} {:>10} {:>7} {counts:>9}",
                milliseconds(rung, part, source),
                over_lambert(report, &rung.rung, part, source),
                under_blur(report, &rung.rung, part, source),
            );
        }
        text.push('\n');
    }
}

fn scenes(text: &mut String, report: &CdrfReport) {
    let _ = writeln!(text, "\n{:12} {:20} {:>8} {:>7} {:>9}", "from walks", "rung", "shadows", "error", "ms");
    for scene in &report.scenes {
        let ms = scene.timing.map_or(NONE.to_owned(), |timing| format!("{:.1}", timing.ms));
        let shadows = if scene.shadows { "cast" } else { "none" };
        let _ = writeln!(text, "{:12} {:20} {shadows:>8} {:>7.3} {ms:>9}", scene.scene, scene.rung, scene.walks);
    }
    let _ = writeln!(
        text,
        "\nerror: of the picture from the committed one by random walks, over its root mean square, after the best exposure. Pictures of {SIDE}x{SIDE} \
         pixels, one\nsample each, curvature from vertices, by the lights alone; ms is of these very pictures."
    );
}

fn tables(text: &mut String, report: &CdrfReport) {
    let _ = writeln!(text, "\n{:40} {:>9} {:>9}", "lookup tables", "largest", "rms");
    for table in &report.tables {
        let [largest, rms] = [table.distance.largest, table.distance.rms].map(|error| scientific(Some(error)));
        let _ = writeln!(text, "{:40} {largest:>9} {rms:>9}", table.name);
    }
}
