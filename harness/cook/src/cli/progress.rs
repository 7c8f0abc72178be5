//! Progress bars: on stderr where it is a terminal, nowhere else.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of `length` steps.
pub(super) fn bar(length: u64, what: &'static str) -> ProgressBar {
    // indicatif draws on stderr, and hides itself where that is no terminal.
    let style = ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len} {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style).with_prefix(what)
}
