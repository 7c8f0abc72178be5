//! `snapshots/README.md`: the committed pictures with their captions, to be browsed without a build.

use super::committed::Committed;
use super::walked::WALKED;
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

/// Returns the page.
#[must_use]
pub fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    for (technique, heading) in TECHNIQUES {
        let _ = writeln!(page, "## {heading}\n\n| picture | what it shows |\n|---|---|");
        for picture in Committed::all().filter(|picture| picture.folder().ends_with(technique)) {
            let (title, file) = (picture.title(), format!("{technique}/{}.png", picture.name()));
            let text = format!("**{title}.** {} {}<br>`{}`", picture.caption(), rung(picture), picture.command());
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

/// Returns which rung draws a picture of one scene, as a sentence.
fn rung(picture: Committed) -> String {
    let Committed::Shot(shot) = picture else { return String::new() };
    match shot.rung {
        "by-material" => format!("Rung: each body's own, at quality {}.", shot.quality),
        rung => format!("Rung: `{rung}`."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SHOTS, beside_walks};

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
