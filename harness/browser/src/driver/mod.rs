//! A page as its reader has it: in Chromium without a window, by its keys and clicks.
//!
//! Chromium is spoken to over a pipe in the DevTools protocol. It ends with the page that it shows,
//! or with this process. It needs `sh`.
//!
//! ```no_run
//! use lapidary_browser::{Browser, Page};
//!
//! let mut page = Page::start(&Browser::find().expect("Chromium on the PATH"))?;
//! page.open("file:///tmp/index.html")?;
//! page.press("Tab")?;
//! assert_eq!(page.evaluate("document.activeElement.textContent")?, "Skip to the text");
//! assert!(page.problems()?.is_empty());
//! # Ok::<(), lapidary_browser::BrowserError>(())
//! ```

mod input;
mod keys;
mod pipe;
mod record;

use crate::BrowserError;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use pipe::{CANVAS, PATIENCE, Pipe, fault};
use record::Record;
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// Time between two questions whether something has come about.
const PAUSE: Duration = Duration::from_millis(50);

/// A browser with one page, which it may open at one address after another.
#[derive(Debug)]
pub struct Page {
    pipe: Pipe,
    session: String,
    record: Record,
}

impl Page {
    /// Starts `program` with an empty page. WebGPU runs on SwiftShader, which is part of Chromium.
    ///
    /// # Errors
    /// Returns an error if the program cannot be started, or does not speak the protocol.
    pub fn start(program: &Path) -> Result<Page, BrowserError> {
        Page::start_with(program, &CANVAS)
    }

    /// Starts `program` with an empty page. With those flags alone, WebGPU cannot draw into a canvas.
    pub(crate) fn start_with(program: &Path, flags: &[&str]) -> Result<Page, BrowserError> {
        let mut pipe = Pipe::open(program, flags)?;
        let mut outside = |method: &str, params: Value| pipe.call(None, method, &params, |_| {});
        let target = outside("Target.createTarget", json!({ "url": "about:blank" }))?;
        let attached = outside("Target.attachToTarget", json!({ "targetId": target["targetId"], "flatten": true }))?;
        let session = attached["sessionId"].as_str().ok_or_else(|| fault("no session"))?.to_owned();
        let mut page = Page { pipe, session, record: Record::default() };
        for domain in ["Page", "Runtime", "Network", "Log", "Inspector"] {
            page.call(&format!("{domain}.enable"), json!({}))?;
        }
        // A page without focus shows none, and may not use the clipboard.
        page.call("Emulation.setFocusEmulationEnabled", json!({ "enabled": true }))?;
        Ok(page)
    }

    /// Opens an address, and waits until it has loaded. Requests and problems count from here on.
    ///
    /// # Errors
    /// Returns an error if nothing is there, or it does not load in time.
    pub fn open(&mut self, url: &str) -> Result<(), BrowserError> {
        self.record = Record::default();
        let answer = self.call("Page.navigate", json!({ "url": url }))?;
        if let Some(error) = answer["errorText"].as_str() {
            return Err(BrowserError::Refused(format!("{url}: {error}")));
        }
        // Another place of the same page loads nothing.
        let loads = answer["loaderId"].is_string();
        let until = Instant::now() + PATIENCE;
        while loads && !self.record.loaded {
            if Instant::now() > until {
                return Err(fault(format!("{url} has not loaded after {} s", PATIENCE.as_secs())));
            }
            self.listen(PAUSE)?;
        }
        Ok(())
    }

    /// Opens a page that is given as text. It becomes a file of the browser's folder: Chromium takes files
    /// for a secure context, and only there has a page WebGPU.
    pub(crate) fn open_text(&mut self, html: &str) -> Result<(), BrowserError> {
        let path = self.pipe.folder().join("page.html");
        std::fs::write(&path, html).map_err(fault)?;
        self.open(&address(&path))
    }

    /// Returns the value of an expression of JavaScript as JSON. A promise is awaited.
    ///
    /// # Errors
    /// Returns an error with the exception's text if the expression throws or its promise is rejected.
    pub fn evaluate(&mut self, expression: &str) -> Result<Value, BrowserError> {
        let call = json!({
            "expression": expression, "awaitPromise": true, "returnByValue": true, "userGesture": true,
        });
        let mut answer = self.call("Runtime.evaluate", call)?;
        match &answer["exceptionDetails"] {
            Value::Null => Ok(answer["result"]["value"].take()),
            details => Err(BrowserError::Refused(record::exception(details))),
        }
    }

    /// Runs statements, `await` among them, and returns as JSON what they `return`.
    ///
    /// # Errors
    /// Returns an error with the exception's text if they throw.
    pub fn run(&mut self, statements: &str) -> Result<Value, BrowserError> {
        self.evaluate(&format!("(async () => {{\n{statements}\n}})()"))
    }

    /// Waits until an expression is truthy, and returns its value. While the page goes to another
    /// address, it has none.
    ///
    /// # Errors
    /// Returns an error if it is not so within the time, with the last exception if there was one.
    pub fn wait_for(&mut self, expression: &str, within: Duration) -> Result<Value, BrowserError> {
        let until = Instant::now() + within;
        loop {
            let found = self.evaluate(expression);
            let why = match found {
                Ok(value) if is_truthy(&value) => return Ok(value),
                Ok(value) => format!("it is {value}"),
                Err(BrowserError::Refused(error)) => error,
                Err(error) => return Err(error),
            };
            if Instant::now() > until {
                let problems = self.record.problems.join("\n");
                return Err(BrowserError::Refused(format!(
                    "not so after {} s: {expression}: {why}\n{problems}",
                    within.as_secs_f32()
                )));
            }
            self.listen(PAUSE)?;
        }
    }

    /// Returns what the window shows at that size as a PNG.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn screenshot(&mut self, width: u32, height: u32, dark: bool) -> Result<Vec<u8>, BrowserError> {
        self.set_viewport(width, height, false)?;
        self.set_media(dark, true)?;
        let answer = self.call("Page.captureScreenshot", json!({ "format": "png" }))?;
        BASE64_STANDARD.decode(answer["data"].as_str().unwrap_or_default()).map_err(fault)
    }

    /// Gives the window a size in CSS pixels, as a phone has it or a desktop.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn set_viewport(&mut self, width: u32, height: u32, mobile: bool) -> Result<(), BrowserError> {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile });
        self.call("Emulation.setDeviceMetricsOverride", size).map(|_| ())
    }

    /// Sets what the reader prefers: dark colours, and little motion.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn set_media(&mut self, dark: bool, reduced_motion: bool) -> Result<(), BrowserError> {
        let scheme = if dark { "dark" } else { "light" };
        let motion = if reduced_motion { "reduce" } else { "no-preference" };
        let features = json!([
            { "name": "prefers-color-scheme", "value": scheme },
            { "name": "prefers-reduced-motion", "value": motion },
        ]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": features })).map(|_| ())
    }

    /// Lets pages read and write the clipboard.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn grant_clipboard(&mut self) -> Result<(), BrowserError> {
        let permissions = json!({ "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"] });
        self.pipe.call(None, "Browser.grantPermissions", &permissions, |_| {}).map(|_| ())
    }

    /// Runs a script in every page that is opened from now on, before the page's own.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn before_scripts(&mut self, source: &str) -> Result<(), BrowserError> {
        self.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": source })).map(|_| ())
    }

    /// Returns what has gone wrong since the page was opened: `console.error`, uncaught exceptions,
    /// unhandled rejections, and requests that failed.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn problems(&mut self) -> Result<&[String], BrowserError> {
        // What has happened before the answer to a question is told before it.
        self.evaluate("new Promise((done) => setTimeout(done))")?;
        Ok(&self.record.problems)
    }

    /// Returns the addresses that have been asked for since the page was opened, itself the first.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn requests(&mut self) -> Result<&[String], BrowserError> {
        self.evaluate("new Promise((done) => setTimeout(done))")?;
        Ok(&self.record.requests)
    }

    /// Calls a method of the protocol for this page, and returns its result.
    ///
    /// # Errors
    /// Returns an error if the browser is gone, the page crashed, or the method says so.
    pub fn call(&mut self, method: &str, params: Value) -> Result<Value, BrowserError> {
        let record = &mut self.record;
        let answer = self.pipe.call(Some(&self.session), method, &params, |message| {
            record.note(&message.method, &message.params);
        });
        if self.record.crashed {
            return Err(fault(format!("{method}: the page's process crashed")));
        }
        answer
    }

    /// Takes in the events of some time.
    fn listen(&mut self, within: Duration) -> Result<(), BrowserError> {
        let until = Instant::now() + within;
        while let Some(message) = self.pipe.next(until.saturating_duration_since(Instant::now()))? {
            self.record.note(&message.method, &message.params);
        }
        Ok(())
    }
}

/// Returns the address of a file: `%`, `?`, `#` and what is not ASCII have another meaning there, or none.
fn address(path: &Path) -> String {
    let escaped = |&byte: &u8| match byte {
        b'/' | b'.' | b'-' | b'_' | b'~' => char::from(byte).to_string(),
        _ if byte.is_ascii_alphanumeric() => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    format!("file://{}", path.as_os_str().as_encoded_bytes().iter().map(escaped).collect::<String>())
}

/// What JavaScript takes for true in a condition.
fn is_truthy(value: &Value) -> bool {
    !(matches!(value, Value::Null | Value::Bool(false)) || *value == "" || value.as_f64() == Some(0.0))
}

#[cfg(test)]
pub(crate) mod tests;
