use super::*;
use lapidary_ladders::plot::four_digits;
use std::collections::HashSet;

/// Returns a ladder's pictures as they would be drawn, without drawing them.
fn pretended(kind: &'static Kind) -> Vec<RungPicture> {
    let picture = |rung: &str| RungPicture {
        rung: rung.to_owned(),
        file: format!("images/rungs/{}/{}.jpg", kind.name, rung.replace('+', "-")),
        exact: Some(format!("images/rungs/{}/{}.png", kind.name, rung.replace('+', "-"))),
        side: 384,
        command: format!("./cook render {} --rung {rung}", kind.scene()),
        ..RungPicture::default()
    };
    let measured = kind.steps().into_iter().map(|step| picture(&step.rung));
    [picture(REFERENCE)].into_iter().chain(measured).chain(kind.others.iter().map(|rung| picture(rung))).collect()
}

fn html(kind: &'static Kind, pictures: &[RungPicture]) -> String {
    section(kind, pictures, "../").expect("the committed report").0
}

/// Returns the values of an attribute.
fn values<'h>(html: &'h str, attribute: &str) -> Vec<&'h str> {
    let start = format!(" {attribute}=\"");
    html.split(&start).skip(1).filter_map(|rest| rest.split_once('"')).map(|(value, _)| value).collect()
}

/// Returns the rungs of a ladder that the GPU was measured with.
fn on_gpu(kind: &Kind) -> Vec<&'static Step> {
    kind.steps().into_iter().filter(|step| OnGpu::of(kind).ms(&step.rung).is_some()).collect()
}

#[test]
fn every_rung_of_the_report_is_in_the_table_and_in_both_drawings() {
    for kind in &KINDS {
        let html = html(kind, &[]);
        let (plots, table) = html.split_once("<tbody>").expect("a table");
        let (drawings, _) = plots.split_once("data-device=\"2\"").expect("a plot of the GPU");
        assert!(kind.steps().len() >= 6, "{}: {}", kind.name, kind.steps().len());
        for step in kind.steps() {
            let row = format!("<th scope=\"row\">{}</th><td class=\"number\">{}</td>", step.rung, figure(step.error));
            assert_eq!(table.matches(&row).count(), 1, "{}: {row}", kind.name);
            let point = format!("data-x=\"{}\" data-y=\"{}\"", four_digits(step.ms), four_digits(step.error));
            assert!(drawings.matches(&point).count() >= 2, "{}: {point} of {}", kind.name, step.rung);
        }
        for quality in Quality::ALL {
            let rung = kind.technique.rung(quality).to_string();
            assert!(kind.qualities(&rung).contains(&quality.name()));
            let names = kind.qualities(&rung).join(", ");
            assert_eq!(drawings.matches(&format!(">{names}: {rung}")).count(), 2, "{}: {names}: {rung}", kind.name);
        }
        assert!(!html.contains("<a "), "without pictures nothing leads to one");
    }
}

/// The ladders of which a default is beaten on the GPU: `tiled-26-32` and `godunov-32`, of `fast`.
const BEATEN: [&str; 2] = ["optical_path", "translucent"];

#[test]
fn what_the_gpu_was_measured_with_is_in_its_own_plot_and_in_the_table() {
    for kind in &KINDS {
        let (html, gpu) = (html(kind, &[]), OnGpu::of(kind));
        let (plots, table) = html.split_once("<tbody>").expect("a table");
        let (_, drawings) = plots.split_once("data-device=\"2\"").expect("a plot of the GPU");
        let steps = on_gpu(kind);
        assert!(steps.len() >= 6, "{}: {}", kind.name, steps.len());
        assert_eq!(drawings.matches("<g class=\"point ").count(), 2 * steps.len(), "{}", kind.name);
        for step in steps {
            let ms = gpu.ms(&step.rung).expect("measured");
            let point = format!("data-x=\"{}\" data-y=\"{}\"", four_digits(ms), four_digits(step.error));
            assert!(drawings.matches(&point).count() >= 2, "{}: {point} of {}", kind.name, step.rung);
            let row = table.lines().find(|row| row.contains(&format!("<th scope=\"row\">{}</th>", step.rung)));
            // The last of figures, before what chooses the rung.
            let cells = row.expect("its row").matches("class=\"number\"").count();
            let last = row.and_then(|row| row.split("<td class=\"number\">").nth(cells)).expect("figures");
            assert!(last.starts_with(&format!("{ms:.1}</td><td>")), "{row:?}");
        }
        assert!(drawings.contains(&gpu.report.adapter), "{}", kind.name);
        assert_eq!(drawings.contains("60 frames a second"), gpu.fills, "{}", kind.name);
        // By the CPU's times no default is beaten, which the planner's own tests hold.
        assert_eq!(
            html.matches("is faster here than").count(),
            usize::from(BEATEN.contains(&kind.name)),
            "{}",
            kind.name
        );
        // A live page times the pictures of its own ladder.
        assert_eq!(drawings.contains("data-live"), !gpu.fills, "{}", kind.name);
    }
}

#[test]
fn every_point_and_every_row_leads_to_a_picture_that_is_there() {
    for kind in &KINDS {
        let pictures = pretended(kind);
        let files: HashSet<String> = pictures.iter().map(|picture| format!("../{}", picture.file)).collect();
        let html = html(kind, &pictures);
        let links = values(&html, "href");
        let (steps, there) = (kind.steps().len(), on_gpu(kind).len());
        let drawn = 2 * (steps + there);
        assert_eq!(links.len(), drawn + steps + 2, "a link a point in two drawings, one a row, and two that are shown");
        for link in links.into_iter().chain(values(&html, "src")).chain(values(&html, "data-src")) {
            assert!(files.contains(link), "{}: {link}", kind.name);
        }
        let exact = values(&html, "data-exact");
        assert_eq!(exact.len(), 2 * pictures.len(), "an option a side");
        assert!(exact.iter().all(|file| file.starts_with("../images/rungs/") && file.ends_with(".png")));
        assert_eq!(html.matches("<template").count(), pictures.len());
        let missing: Vec<RungPicture> = pictures.iter().filter(|picture| picture.rung == REFERENCE).cloned().collect();
        assert!(
            section(kind, &missing, "").expect("drawn").0.contains("reference.jpg"),
            "one picture is enough to compare"
        );
    }
}

#[test]
fn what_is_drawn_for_another_rung_has_the_same_error() {
    let mut twins = 0;
    for kind in &KINDS {
        let steps = kind.steps();
        for step in &steps {
            let pictured = kind.pictured(&step.rung, &steps);
            let pictured_step = steps.iter().find(|other| other.rung == pictured).expect("a measured rung");
            // The same hits or costs give the same picture up to rounding.
            assert!(
                (step.error / pictured_step.error - 1.0).abs() < 1e-3,
                "{} by {pictured}: {} {}",
                step.rung,
                step.error,
                pictured_step.error
            );
            twins += usize::from(pictured != step.rung);
        }
    }
    assert!(twins > 10, "{twins}");
}

#[test]
fn what_is_filled_in_is_escaped() {
    let kind = &KINDS[0];
    let mut pictures = pretended(kind);
    pictures[0].note = "<b>&\"".to_owned();
    pictures[0].command = "./cook render '<x>'".to_owned();
    let html = html(kind, &pictures);
    assert!(!html.contains("<b>") && !html.contains("<x>"), "text is never markup");
    assert!(html.contains("&lt;b&gt;&amp;"));
    // Balanced: what opens is closed.
    for tag in ["svg", "figure", "template", "section", "details", "table", "g", "a", "select"] {
        let opened = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
        assert_eq!(opened, html.matches(&format!("</{tag}>")).count(), "{tag}");
    }
}

#[test]
fn a_figure_has_its_caption_command_and_file() {
    let text = figure_of("../", "images/full.png", "t < u", "./cook render ruby");
    for part in [
        "href=\"../images/full.png\"",
        "alt=\"t &lt; u\"",
        "<em>caption</em>",
        "<code>walk-8</code>",
        "./cook render ruby",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

fn figure_of(root: &str, file: &str, title: &str, command: &str) -> String {
    #[derive(Serialize)]
    struct Values<'a> {
        p: Shown<'a>,
        root: &'a str,
    }
    #[derive(Serialize)]
    struct Shown<'a> {
        thumb: &'a str,
        file: &'a str,
        width: u32,
        height: u32,
        title: &'a str,
        caption: Markup,
        command: &'a str,
        adapter: &'a str,
        rung: &'a str,
        samples: &'a str,
    }
    let p = Shown {
        thumb: file,
        file,
        width: 384,
        height: 384,
        title,
        caption: Markup("<em>caption</em>".to_owned()),
        command,
        adapter: "llvmpipe",
        rung: "walk-8",
        samples: "2 × 2 samples a pixel",
    };
    templates::render("figure_alone.html", Values { p, root }).0
}
