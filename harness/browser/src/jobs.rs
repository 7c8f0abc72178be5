//! The page that does the jobs, and the calls of its functions.
//!
//! Chromium's `--dump-dom`, which needs no protocol, would not do instead: its virtual time continues while
//! the GPU process compiles, so the DOM may be printed before it contains anything. An awaited promise has
//! no such clock.

use crate::driver::Page;
use crate::{Adapter, BrowserError};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

const PAGE: &str = include_str!("page.html");

/// A browser with the page open.
#[derive(Debug)]
pub(crate) struct Worker {
    page: Page,
    /// The protocol's name for the page's field for a file.
    input: String,
    /// Whether a call failed. The page may still be at its job, and would do the next beside it.
    is_lost: bool,
}

fn fault(error: impl std::fmt::Display) -> BrowserError {
    BrowserError::Connection(error.to_string())
}

impl Worker {
    /// Opens the page; returns it with its first words.
    pub(crate) fn open(program: &Path, adapter: Adapter) -> Result<(Worker, Value), BrowserError> {
        let flags: &[&str] = match adapter {
            Adapter::SwiftShader => &["--use-webgpu-adapter=swiftshader"],
            Adapter::Own => &[],
        };
        let mut page = Page::start_with(program, flags)?;
        page.open_text(PAGE)?;
        let input = page.object("input")?;
        let mut worker = Worker { page, input, is_lost: false };
        let greeting = worker.call(|page, _| page.evaluate("connected()"))?;
        Ok((worker, accepted(greeting)?))
    }

    /// Gives the page a job and its bytes; returns the head and the bytes of its answer.
    pub(crate) fn ask(&mut self, job: &impl Serialize, parts: &[&[u8]]) -> Result<(Value, Vec<u8>), BrowserError> {
        let job = serde_json::to_string(job).map_err(fault)?;
        let mut found = self.call(|page, input| {
            page.choose_file(input, parts)?;
            page.evaluate(&format!("answer({job})"))
        })?;
        let head = accepted(found["head"].take())?;
        let text = found["bytes"].as_str().ok_or_else(|| fault("its answer has no bytes"))?;
        Ok((head, BASE64_STANDARD.decode(text).map_err(fault)?))
    }

    /// Calls the page. Its functions throw nothing, they return what is refused: any error is one of the
    /// connection.
    fn call<T>(&mut self, call: impl FnOnce(&mut Page, &str) -> Result<T, BrowserError>) -> Result<T, BrowserError> {
        if self.is_lost {
            return Err(fault("it did not answer before"));
        }
        call(&mut self.page, &self.input).map_err(|error| {
            self.is_lost = true;
            fault(error)
        })
    }
}

/// Returns the head of an answer, if it is no refusal.
fn accepted(head: Value) -> Result<Value, BrowserError> {
    match head["fault"].as_str() {
        Some(fault) => Err(BrowserError::Refused(fault.to_owned())),
        None => Ok(head),
    }
}
