//! Chromium's WGSL compiler, Tint, accepts the cookbook's modules and recipes, and the results of
//! specialising recipes and random programs. naga, which all other tests use, accepts some texts
//! that the language forbids. The functions also run in Chromium.
//!
//! If there is no Chromium with WebGPU, these tests say so and pass. With
//! `LAPIDARY_CHROMIUM=required`, as in `.ci/run`, they fail.

mod functions;
mod webgl;

use crate::specialise::{specialised_program, specialised_texts};
use lapidary_assay::dispatch;
use lapidary_browser::{Adapter, Browser, Message};
use lapidary_cookbook::modules;
use lapidary_wgsl::{RECIPES, compose};
use std::io::Write as _;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};
use std::time::Instant;

/// Variable with the value `required` if a missing Chromium is a failure.
const VARIABLE: &str = "LAPIDARY_CHROMIUM";

/// Unless the suite is run whole, one function in this many runs there.
const ONE_IN: u64 = 3;

/// Number of random programs that are specialised.
const PROGRAMS: u64 = 300;

/// A text that WGSL forbids.
struct Planted {
    text: &'static str,
    /// A word of Chromium's message.
    word: &'static str,
    /// Whether naga accepts it.
    passes_naga: bool,
}

const PLANTED: [Planted; 4] = [
    Planted {
        text: "fn mixed(a: u32, b: u32, c: u32) -> u32 {\n    return a | b << c;\n}\n",
        word: "parenthesis",
        passes_naga: true,
    },
    Planted {
        text: "\
@fragment
fn ragged(@location(0) x: f32) -> @location(0) vec4f {
    var slope = 0.0f;
    if x > 0.0f {
        slope = dpdx(x);
    }
    return vec4f(slope);
}
",
        word: "uniform",
        passes_naga: true,
    },
    Planted { text: "fn split(n: u32) -> u32 {\n    return n / 0u;\n}\n", word: "zero", passes_naga: false },
    Planted { text: "fn lost() -> u32 {\n    return nowhere;\n}\n", word: "unresolved", passes_naga: false },
];

/// A text and Chromium's messages about it.
struct Judged {
    name: String,
    text: String,
    messages: Vec<Message>,
}

impl Judged {
    /// Returns the messages of a kind, each with the text's name and the line that it points at.
    fn of_kind(&self, kind: &str) -> impl Iterator<Item = String> {
        self.messages.iter().filter(move |message| message.kind == kind).map(|message| {
            let line = message.line.checked_sub(1).and_then(|line| self.text.lines().nth(line)).unwrap_or_default();
            format!("{}:{}: {}\n    {}\n", self.name, message.line, message.text, line.trim())
        })
    }
}

/// Returns all texts to judge in one start of Chromium, the planted ones first.
fn texts() -> Vec<(String, String)> {
    let planted = PLANTED.iter().map(|planted| (format!("planted: {}", planted.word), planted.text.to_owned()));
    let each = modules().iter().map(|module| (module.name.to_owned(), module.whole.to_owned()));
    let names: Vec<&str> = modules().iter().map(|module| module.name).collect();
    let together = ("all modules".to_owned(), compose(&names, ""));
    let whole = RECIPES.iter().map(|recipe| (recipe.name.to_owned(), recipe.compose()));
    let special = specialised_texts().iter().map(|special| (special.name.clone(), special.text.clone()));
    let programs = (0..PROGRAMS).map(|row| (format!("program {row}"), specialised_program(row)));
    planted.chain(each).chain([together]).chain(whole).chain(special).chain(programs).collect()
}

/// Returns the browser that the running tests share. It ends with the last of them.
fn browser() -> Result<Arc<Browser>, String> {
    static SHARED: Mutex<Weak<Browser>> = Mutex::new(Weak::new());
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(browser) = shared.upgrade() {
        return Ok(browser);
    }
    let program = Browser::find().ok_or("no Chromium on the PATH")?;
    let browser = Browser::start(&program, Adapter::SwiftShader);
    let browser = Arc::new(browser.map_err(|error| format!("{} cannot be asked: {error}", program.display()))?);
    *shared = Arc::downgrade(&browser);
    Ok(browser)
}

/// Returns the result of a test. Without Chromium, if it is not required, reports the skip and
/// returns nothing.
fn found<T, E: std::fmt::Display>(found: Result<T, E>, skipped: &str) -> Option<T> {
    found
        .inspect_err(|error| {
            let required = std::env::var_os(VARIABLE).is_some_and(|value| value == "required");
            assert!(!required, "{VARIABLE}=required: {error}");
            // Bypasses the test's own capture, which shows nothing of a passing test.
            let _ = writeln!(std::io::stderr(), "{skipped} not checked in Chromium: {error}");
        })
        .ok()
}

fn judge() -> Result<Vec<Judged>, String> {
    let browser = browser()?;
    let texts = texts();
    let started = Instant::now();
    let codes: Vec<&str> = texts.iter().map(|(_, text)| text.as_str()).collect();
    let messages = browser.messages(&codes).map_err(|error| error.to_string())?;
    if messages.len() != texts.len() {
        return Err(format!("{} texts were asked about, {} answered", texts.len(), messages.len()));
    }
    println!("{} texts, {}: {:.1?}", texts.len(), browser.adapter(), started.elapsed());
    let judged = texts.into_iter().zip(messages);
    Ok(judged.map(|((name, text), messages)| Judged { name, text, messages }).collect())
}

/// Returns the planted texts and the others, judged; nothing without Chromium, if it is not
/// required.
fn judged() -> Option<(&'static [Judged], &'static [Judged])> {
    static JUDGED: OnceLock<Result<Vec<Judged>, String>> = OnceLock::new();
    let judged = JUDGED.get_or_init(judge).as_ref();
    found(judged, &format!("{} texts", texts().len())).map(|judged| judged.split_at(PLANTED.len()))
}

#[test]
fn chromium_takes_every_text() {
    let Some((_, texts)) = judged() else { return };
    let warnings: Vec<String> = texts.iter().flat_map(|judged| judged.of_kind("warning")).collect();
    println!("{} warnings\n{}", warnings.len(), warnings.concat());
    let errors: Vec<String> = texts.iter().flat_map(|judged| judged.of_kind("error")).collect();
    assert!(errors.is_empty(), "{} errors\n{}", errors.len(), errors.concat());
}

#[test]
fn chromium_refuses_what_wgsl_forbids() {
    let Some((planted, _)) = judged() else { return };
    for (judged, Planted { text, word, passes_naga }) in planted.iter().zip(&PLANTED) {
        let errors: String = judged.of_kind("error").collect();
        assert!(errors.contains(word), "{text}{errors}");
        assert_eq!(dispatch::parse(text, "planted").is_ok(), *passes_naga, "{text}");
    }
}
