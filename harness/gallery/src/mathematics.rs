//! LaTeX as MathML by pulldown-latex, mended for browsers.

use super::templates;
use pulldown_latex::config::{DisplayMode, RenderConfig};
use std::convert::Infallible;

/// An error for LaTeX that could not be converted.
#[derive(Debug, thiserror::Error)]
#[error("`{latex}` is not LaTeX that can be converted to MathML: {reason}")]
pub struct MathError {
    latex: String,
    reason: String,
}

/// Converts LaTeX to a `<math>` element, with its source as an annotation.
pub fn math(latex: &str, display_mode: DisplayMode) -> Result<String, MathError> {
    let error = |reason: String| MathError { latex: latex.trim().to_owned(), reason };
    let storage = pulldown_latex::Storage::new();
    let events = pulldown_latex::Parser::new(latex, &storage)
        .collect::<Result<Vec<_>, _>>()
        .map_err(|reason| error(reason.to_string()))?;
    let mut html = String::new();
    // The writer does not escape an annotation.
    let annotation = templates::escaped(latex.trim());
    let config = RenderConfig { display_mode, annotation: Some(&annotation), ..RenderConfig::default() };
    pulldown_latex::push_mathml(&mut html, events.into_iter().map(Ok::<_, Infallible>), config)
        .map_err(|reason| error(reason.to_string()))?;
    Ok(mended(&html))
}

/// Mends what browsers set badly of pulldown-latex's MathML, in its own text, since the library has no tree to change: a control space that is escaped twice; the micro sign for
/// `\mu`, which no browser makes italic; a slash, which is an operator to MathML and spaced like one, but none to TeX;
/// the arrows of vectors, which stand like limits above a sum unless they are accents; the space before an operator's
/// name, which is written into the element of its limits as a child too many.
fn mended(html: &str) -> String {
    const SLASH: (&str, &str) = ("<mo>/</mo>", "<mo lspace=\"0\" rspace=\"0\">/</mo>");
    const SPACE: &str = "<mspace width=\"0.1667em\" />";
    const ARROW: (&str, &str) =
        ("<mi>→</mi></mover>", "<mo stretchy=\"false\" lspace=\"0\" rspace=\"0\" mathsize=\"60%\">→</mo></mover>");
    let html = html.replace("&amp;nbsp;", "\u{a0}").replace('\u{b5}', "\u{3bc}").replace(SLASH.0, SLASH.1);
    let html = ["<munder>", "<munderover>", "<msub>", "<msubsup>", "<msup>"]
        .iter()
        .fold(html, |html, element| html.replace(&[element, SPACE].join(""), &[SPACE, element].join("")));
    let mut written = String::with_capacity(html.len());
    let mut parts = html.split(ARROW.0).peekable();
    while let Some(part) = parts.next() {
        match part.rsplit_once("<mover>") {
            Some((before, base)) if parts.peek().is_some() => {
                written.extend([before, "<mover accent=\"true\">", base, ARROW.1]);
            }
            _ => written.push_str(part),
        }
    }
    written
}

/// Splits a display equation at each `\qquad` or `\quad` after a comma that is in no group, so that narrow screens can
/// break it there.
pub fn clauses(latex: &str) -> Vec<&str> {
    let mut clauses = Vec::new();
    let (mut depth, mut start, mut rest) = (0_i32, 0, latex);
    while let Some(first) = rest.chars().next() {
        let name = rest.strip_prefix('\\').map(|rest| {
            let letters = rest.find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(rest.len());
            &rest[..letters.max(rest.chars().next().map_or(0, char::len_utf8))]
        });
        let length = name.map_or(first.len_utf8(), |name| 1 + name.len());
        match name {
            Some("left" | "begin") => depth += 1,
            Some("right" | "end") => depth -= 1,
            Some("qquad" | "quad") if depth == 0 => {
                let place = latex.len() - rest.len();
                let clause = latex[start..place].trim();
                if clause.ends_with(',') {
                    clauses.push(clause);
                    start = place + length;
                }
            }
            None if first == '{' => depth += 1,
            None if first == '}' => depth -= 1,
            _ => {}
        }
        rest = &rest[length..];
    }
    clauses.push(latex[start..].trim());
    clauses.retain(|clause| !clause.is_empty());
    clauses
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mathematics_becomes_mathml() {
        let html = math(r"a < \sqrt{\vec n_i}", DisplayMode::Inline).expect("valid LaTeX");
        assert!(html.starts_with("<math") && html.contains("<msqrt") && html.contains("&lt;"), "{html}");
        assert!(!html.contains("< "), "{html}");
    }

    #[test]
    fn mathematics_is_mended() {
        let html = math(r"\vec r\ \mu / 2^{-1} \max_i x", DisplayMode::Block).expect("valid LaTeX");
        for part in [
            "<mover accent=\"true\"><mi>r</mi><mo stretchy=\"false\" lspace=\"0\" rspace=\"0\" mathsize=\"60%\">→</mo></mover>",
            "<mtext>\u{a0}</mtext>",
            "<mi>\u{3bc}</mi>",
            "<mo lspace=\"0\" rspace=\"0\">/</mo>",
            "<munder><mi>max</mi><mi>i</mi></munder>",
        ] {
            assert!(html.contains(part), "{part} is not in {html}");
        }
        let arrow = math(r"n \to 1", DisplayMode::Inline).expect("valid LaTeX");
        assert!(arrow.contains("→") && !arrow.contains("mathsize"), "{arrow}");
    }

    #[test]
    fn equations_break_between_clauses_but_in_no_group() {
        assert_eq!(clauses(r"a, \qquad b = 1, \quad c \quad d"), ["a,", "b = 1,", r"c \quad d"]);
        assert_eq!(clauses(r"\{ a, \qquad b \} \leftarrow c"), [r"\{ a,", r"b \} \leftarrow c"]);
        for whole in [r"\left( a, \qquad b \right)", r"\begin{x} a, \qquad b \end{x}", r"{a, \qquad b}", r"\", r"\é"] {
            assert_eq!(clauses(whole), [whole]);
        }
    }

    #[test]
    fn what_is_no_latex_is_refused() {
        assert!(math(r"\frac{1}{", DisplayMode::Block).is_err());
    }
}
