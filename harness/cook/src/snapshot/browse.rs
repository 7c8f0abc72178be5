//! `snapshots/README.md`: the committed pictures with their captions, to be browsed without a build.

use super::{Committed, Shot, WALKED, strip};
use lapidary_scene::BUILT_IN;
use std::fmt::Write as _;

/// The folders of pictures, each with its heading.
const TECHNIQUES: [(&str, &str); 4] = [
    ("gem", "Clear stones"),
    ("cdrf", "Skin, wax and jade, by curvature"),
    ("optical_path", "Light through stone, by the cheapest path"),
    ("diffusion", "Light through stone, by diffusion"),
];

const INTRODUCTION: &str = "\
# Pictures

<!-- Generated: ./cook test --refresh -->

Every committed picture, with the rung that drew it and the command that draws it again. `./cook snapshots`
renders all anew and compares them. Beside each PNG stands an EXR with linear radiance.

";

/// What stands beside a picture.
struct Entry {
    /// Path from this page.
    file: String,
    title: String,
    paragraph: String,
    rung: String,
    command: String,
}

/// Returns the page.
#[must_use]
pub fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    for (technique, heading) in TECHNIQUES {
        let _ = writeln!(page, "## {heading}\n\n| picture | what it shows |\n|---|---|");
        for entry in Committed::all().filter_map(|committed| entry(committed, technique)) {
            let Entry { file, title, paragraph, rung, command } = entry;
            let text = format!("**{title}.** {paragraph} {rung}<br>`{command}`");
            let _ = writeln!(page, "| ![{title}]({file}) | {} |", text.replace('|', "\\|"));
        }
        page.push('\n');
    }
    page.push_str(
        "## References\n\nRandom walks, as linear radiance alone; `reference/README.md` of each folder tells more.\n\n",
    );
    page.push_str("| scene | command |\n|---|---|\n");
    for walked in &WALKED {
        let _ = writeln!(page, "| {} | `{}` |", walked.title, walked.command());
    }
    page
}

/// Returns what stands beside a picture, if it is in a technique's folder.
fn entry(committed: Committed, technique: &str) -> Option<Entry> {
    committed.folder().ends_with(technique).then(|| {
        let file = format!("{technique}/{}.png", committed.name());
        let (title, paragraph, rung, command) = match committed {
            Committed::Shot(shot) => (shot.title, caption(shot), rung(shot), shot.command()),
            Committed::Strip => {
                (strip::TITLE, strip::PARAGRAPH, String::new(), format!("./cook snapshots {}", strip::NAME))
            }
            Committed::BesideWalks(of) => {
                (of.title, of.paragraph, String::new(), format!("./cook snapshots {}", of.name))
            }
        };
        Entry { file, title: title.to_owned(), paragraph: paragraph.to_owned(), rung, command }
    })
}

/// Returns a shot's caption, or that of its scene.
pub fn caption(shot: &Shot) -> &'static str {
    let of_scene = BUILT_IN.iter().find(|scene| scene.name == shot.scene).map_or("", |scene| scene.description);
    if shot.paragraph.is_empty() { of_scene } else { shot.paragraph }
}

/// Returns which rung draws a shot, as a sentence.
fn rung(shot: &Shot) -> String {
    match shot.rung {
        "by-material" => format!("Rung: each body's own, at quality {}.", shot.quality),
        rung => format!("Rung: `{rung}`."),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{SHOTS, beside_walks};
    use super::*;

    #[test]
    fn every_picture_stands_on_the_page_once() {
        let page = page();
        let pictures = page.matches("| ![").count();
        assert_eq!(pictures, Committed::COUNT);
        assert_eq!(SHOTS.len() + 1 + beside_walks::ALL.len(), pictures);
        for committed in Committed::all() {
            let file = format!("/{}.png)", committed.name());
            assert_eq!(page.matches(&file).count(), 1, "{}", committed.name());
            assert!(committed.folder().join(format!("{}.png", committed.name())).is_file(), "{}", committed.name());
        }
    }
}
