//! A browser's WebGPU from Rust: a second WGSL compiler (Tint), and drivers other than one's own; and its
//! WebGL 2, for what is translated to GLSL ES.
//!
//! Chromium runs headless on a page of this crate, whose functions this process calls for each job over a
//! pipe: the page contains no shader, and this crate no technique.
//! [`Page`] shows a page of one's own instead, and reads, presses and clicks it as its reader does.
//!
//! ```no_run
//! use lapidary_browser::{Adapter, Browser, Buffer, Compute};
//!
//! let browser = Browser::start(&Browser::find().expect("Chromium on the PATH"), Adapter::SwiftShader)?;
//! let code = "@group(0) @binding(0) var<storage, read_write> x: array<f32>;
//!     @compute @workgroup_size(1) fn main() { x[0] = sqrt(x[0]); }";
//! let buffers = [Buffer { size: 4, filled: Some(&4f32.to_le_bytes()), read: true }];
//! let found = browser.compute(&Compute { code, entry: "main", buffers: &buffers, workgroups: [1, 1, 1] })?;
//! println!("{}: {:?}", browser.adapter(), found[0]);
//! # Ok::<(), lapidary_browser::BrowserError>(())
//! ```

mod adapter;
mod driver;
mod error;
mod jobs;

pub use adapter::Adapter;
pub use driver::Page;
pub use error::BrowserError;
use jobs::Worker;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Names of the programs searched for on the PATH.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// A compiler message about a text.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Message {
    /// Severity: `error`, `warning` or `info`.
    pub kind: String,
    /// Text of the message.
    pub text: String,
    /// Line number from 1; 0 if the message belongs to no line.
    pub line: usize,
}

/// A storage buffer of group 0; its position in the list is its binding.
#[derive(Clone, Copy, Debug)]
pub struct Buffer<'a> {
    /// Size in bytes.
    pub size: usize,
    /// Initial contents; `None` means zeros.
    pub filled: Option<&'a [u8]>,
    /// Whether the contents are returned after the dispatch.
    pub read: bool,
}

/// One dispatch of a compute shader.
#[derive(Clone, Copy, Debug)]
pub struct Compute<'a> {
    /// WGSL source; compiled once for all dispatches with the same text and entry point.
    pub code: &'a str,
    /// Name of the entry point.
    pub entry: &'a str,
    /// The buffers of group 0, in the order of their bindings.
    pub buffers: &'a [Buffer<'a>],
    /// Number of workgroups along each axis.
    pub workgroups: [u32; 3],
}

/// One draw of points by a vertex shader of WebGL 2, for what it computes: nothing is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Transform<'a> {
    /// GLSL ES 3.00; compiled once for all draws with the same text and varyings. It reads its words from
    /// the texture of unit 0, a `usampler2D` of 1,024 texels a row, one word each.
    pub code: &'a str,
    /// Names of the varyings that are returned, `uvec4` each.
    pub varyings: &'a [String],
    /// The words.
    pub filled: &'a [u8],
    /// Number of vertices.
    pub vertices: u32,
}

/// A job for the page.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Job<'a> {
    Compile { texts: &'a [&'a str] },
    Compute { key: usize, code: &'a str, entry: &'a str, buffers: Vec<Size>, workgroups: [u32; 3] },
    Transform { key: usize, code: &'a str, varyings: &'a [String], vertices: u32, size: usize },
}

#[derive(Serialize)]
struct Size {
    size: usize,
    filled: bool,
    read: bool,
}

/// A running browser; it ends with its last owner, at [`Browser::close`], or with this process.
#[derive(Debug)]
pub struct Browser {
    adapter: String,
    choice: Adapter,
    /// `None` once the browser is closed.
    state: Mutex<Option<State>>,
}

#[derive(Debug)]
struct State {
    worker: Worker,
    /// Job key of each pair of text and entry point.
    keys: BTreeMap<(String, String), usize>,
}

impl Browser {
    /// Returns the path of the first Chromium or Chrome on the PATH; `None` if there is none.
    pub fn find() -> Option<PathBuf> {
        let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
        NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
    }

    /// Starts `program`.
    ///
    /// # Errors
    /// Returns an error if the browser cannot be started, or has no WebGPU.
    pub fn start(program: &Path, adapter: Adapter) -> Result<Browser, BrowserError> {
        #[derive(Deserialize)]
        struct Greeting {
            adapter: String,
        }
        let (worker, greeting) = Worker::open(program, adapter)?;
        let Greeting { adapter: name } = parsed(greeting)?;
        let name = if name.is_empty() { "an adapter without a name".to_owned() } else { name };
        Ok(Browser { adapter: name, choice: adapter, state: Mutex::new(Some(State { worker, keys: BTreeMap::new() })) })
    }

    /// Returns the adapter's name, as reported by the browser.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Returns the adapter that the browser was asked to use.
    pub fn choice(&self) -> Adapter {
        self.choice
    }

    /// Returns the compiler's messages on each text.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn messages(&self, texts: &[&str]) -> Result<Vec<Vec<Message>>, BrowserError> {
        #[derive(Deserialize)]
        struct Answer {
            messages: Vec<Vec<Message>>,
        }
        let mut guard = self.state();
        let state = opened(&mut guard)?;
        let (head, _) = state.worker.ask(&Job::Compile { texts }, &[])?;
        let Answer { messages } = parsed(head)?;
        Ok(messages)
    }

    /// Runs a compute shader; returns the contents of the buffers with `read` set, in order.
    ///
    /// # Errors
    /// Returns an error if the browser is gone, or if its WebGPU refuses the shader or the buffers.
    pub fn compute(&self, compute: &Compute<'_>) -> Result<Vec<Vec<u8>>, BrowserError> {
        let Compute { code, entry, buffers, workgroups } = *compute;
        let mut guard = self.state();
        let state = opened(&mut guard)?;
        let next = state.keys.len();
        let key = *state.keys.entry((code.to_owned(), entry.to_owned())).or_insert(next);
        let sizes = buffers
            .iter()
            .map(|buffer| Size { size: buffer.size, filled: buffer.filled.is_some(), read: buffer.read })
            .collect();
        let parts: Vec<&[u8]> = buffers.iter().filter_map(|buffer| buffer.filled).collect();
        let job = Job::Compute { key, code, entry, buffers: sizes, workgroups };
        let (_, bytes) = state.worker.ask(&job, &parts)?;
        let mut rest = bytes.as_slice();
        let read = buffers.iter().filter(|buffer| buffer.read);
        read.map(|buffer| {
            let (part, left) = rest
                .split_at_checked(buffer.size)
                .ok_or_else(|| BrowserError::Connection("its answer is too short".to_owned()))?;
            rest = left;
            Ok(part.to_vec())
        })
        .collect()
    }

    /// Runs a vertex shader; returns its varyings, those of each vertex together.
    ///
    /// # Errors
    /// Returns an error if the browser is gone, or if its WebGL refuses the shader.
    pub fn transform(&self, transform: &Transform<'_>) -> Result<Vec<u8>, BrowserError> {
        let Transform { code, varyings, filled, vertices } = *transform;
        let mut guard = self.state();
        let state = opened(&mut guard)?;
        let next = state.keys.len();
        let key = *state.keys.entry((code.to_owned(), varyings.join(" "))).or_insert(next);
        let size = 16 * varyings.len() * vertices as usize;
        let job = Job::Transform { key, code, varyings, vertices, size };
        let (_, bytes) = state.worker.ask(&job, &[filled])?;
        match bytes.len() == size {
            true => Ok(bytes),
            false => Err(BrowserError::Connection("its answer is too short".to_owned())),
        }
    }

    /// Closes the browser. All later calls fail.
    pub fn close(&self) {
        drop(self.state().take());
    }

    fn state(&self) -> MutexGuard<'_, Option<State>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        self.close();
    }
}

fn opened<'a>(guard: &'a mut MutexGuard<'_, Option<State>>) -> Result<&'a mut State, BrowserError> {
    guard.as_mut().ok_or_else(|| BrowserError::Connection("the browser is closed".to_owned()))
}

fn parsed<T: DeserializeOwned>(head: Value) -> Result<T, BrowserError> {
    serde_json::from_value(head)
        .map_err(|error| BrowserError::Connection(format!("its answer is no such one: {error}")))
}

#[cfg(test)]
mod tests;
