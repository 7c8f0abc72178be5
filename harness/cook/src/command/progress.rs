//! Progress bars: shown on stderr if it is a terminal, otherwise hidden.

use indicatif::{ProgressBar, ProgressStyle};

/// Returns a bar of `length` steps.
pub fn bar(length: u64, what: &'static str) -> ProgressBar {
    // indicatif draws on stderr, and hides itself if that is not a terminal.
    let style = ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len} {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style).with_prefix(what)
}
