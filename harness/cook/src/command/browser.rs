//! Browser of a command: started at most once, and closed when the command ends.

use super::Failure;
use lapidary_browser::{Adapter, Browser};
use std::sync::OnceLock;

/// Message if no browser is installed.
pub const MISSING: &str = "no Chromium or Chrome is on the PATH; install one";

static BROWSER: OnceLock<Result<Browser, String>> = OnceLock::new();

/// Returns the browser, which the first call starts.
pub fn started(adapter: Adapter) -> Result<&'static Browser, Failure> {
    let start = || {
        let program = Browser::find().ok_or(MISSING)?;
        Browser::start(&program, adapter).map_err(|error| format!("{}: {error}", program.display()))
    };
    BROWSER.get_or_init(start).as_ref().map_err(|fault| Failure(fault.clone()))
}

/// Returns an error if a browser is required, as in `.ci/run`.
pub fn may_be_missing() -> Result<(), Failure> {
    let required = std::env::var_os("LAPIDARY_CHROMIUM").is_some_and(|value| value == "required");
    if required { Err(Failure(format!("{MISSING} (LAPIDARY_CHROMIUM=required)"))) } else { Ok(()) }
}

/// Closes the browser if it was started.
pub fn close() {
    if let Some(Ok(browser)) = BROWSER.get() {
        browser.close();
    }
}
