//! Labels: words, and symbols with indices.

use super::number::Number;
use serde::Serialize;

/// A part of a label in one style.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// The style sheet's name: `word`, `symbol`, `vector` or `figure`.
    pub class: &'static str,
    /// Size of the letters; 0 for the label's own.
    pub size: Number,
    /// How far its baseline lies below that of the run before.
    pub shift: Number,
    /// The letters.
    pub text: String,
}

/// Size of an index, relative to its label.
const SMALL: f64 = 0.72;

/// Returns a label's parts. Between dollars stand symbols: letters are slanted, `'x` is a vector, `_x` and `_{xy}`
/// lower an index, `^x` raises one, and everything else is upright.
pub fn runs(text: &str, size: f64) -> Vec<Run> {
    let mut line = Line { runs: Vec::new(), size, level: 0.0 };
    for (part, words) in text.split('$').enumerate() {
        if part % 2 == 0 {
            line.push("word", 0.0, words);
        } else {
            line.symbols(words);
        }
    }
    line.runs
}

struct Line {
    runs: Vec<Run>,
    size: f64,
    /// How far the current run's baseline lies below the label's.
    level: f64,
}

impl Line {
    fn push(&mut self, class: &'static str, level: f64, text: &str) {
        if text.is_empty() {
            return;
        }
        if let Some(last) = self.runs.last_mut().filter(|last| last.class == class && self.level == level) {
            last.text.push_str(text);
            return;
        }
        let size = if level == 0.0 { 0.0 } else { SMALL * self.size };
        let shift = Number((level - self.level) * self.size);
        self.level = level;
        self.runs.push(Run { class, size: Number(size), shift, text: text.to_owned() });
    }

    fn symbols(&mut self, text: &str) {
        let mut letters = text.chars().peekable();
        while let Some(letter) = letters.next() {
            let level = match letter {
                '_' => 0.22,
                '^' => -0.38,
                '\'' => {
                    let vector: String = letters.next().into_iter().collect();
                    self.push("vector", 0.0, &vector);
                    continue;
                }
                other => {
                    self.push(class(other), 0.0, &other.to_string());
                    continue;
                }
            };
            let braced = letters.next_if_eq(&'{').is_some();
            let mut index = String::new();
            while let Some(letter) = letters.next_if(|letter| *letter != '}') {
                index.push(letter);
                if !braced {
                    break;
                }
            }
            if braced {
                letters.next();
            }
            for letter in index.chars() {
                self.push(class(letter), level, &letter.to_string());
            }
        }
    }
}

fn class(letter: char) -> &'static str {
    if letter.is_alphabetic() { "symbol" } else { "figure" }
}

/// Returns about how wide a label is, rather too much: a page may have wider fonts than one expects.
pub fn width(runs: &[Run], size: f64) -> f64 {
    let letter = |run: &Run, letter: char| {
        let narrow = "iljft.,'|: ()".contains(letter);
        let wide = "mwMWPON=+−<>→".contains(letter);
        let em = if narrow {
            0.36
        } else if wide {
            0.8
        } else {
            0.61
        };
        em * if run.size.0 == 0.0 { size } else { run.size.0 }
    };
    runs.iter().flat_map(|run| run.text.chars().map(move |one| letter(run, one))).sum()
}
