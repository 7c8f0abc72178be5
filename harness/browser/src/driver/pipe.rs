//! The process, and the messages of the DevTools protocol on its pipe: JSON, each ended by a zero byte.

use crate::BrowserError;
use serde::Deserialize;
use serde_json::{Value, json};
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// Maximum time for one answer. The longest compiles a recipe on SwiftShader.
pub(super) const PATIENCE: Duration = Duration::from_secs(120);

/// Maximum time for Chromium to exit when it is asked to.
const FAREWELL: Duration = Duration::from_secs(10);

/// Flags for every page. The process shows only pages of this project; and as root, which most containers run
/// as, Chromium has no sandbox.
const FLAGS: [&str; 10] = [
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--enable-unsafe-webgpu",
];

/// Further flags by which WebGPU draws into a canvas, on SwiftShader, as the examples for engines have them:
/// `docs/engines/browser.js`. Chromium takes a second longer to start with them.
pub(super) const CANVAS: [&str; 7] = [
    // SwiftShader is slow, and would be taken for hung.
    "--disable-gpu-watchdog",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--use-webgpu-adapter=swiftshader",
    // A canvas of WebGPU's needs Chromium's own surfaces on Vulkan too: on GL its GPU process ends.
    "--use-vulkan=swiftshader",
    "--enable-features=Vulkan",
];

/// Name of the file, in the folder, with what Chromium writes to stderr.
const LOG: &str = "stderr";

/// Chromium speaks on the descriptors 3 and 4, which only a shell can set without unsafe code.
const SHELL: &str = r#"exec "$@" 3<&0 4>&1 0</dev/null 1>/dev/null"#;

/// A message from Chromium: the answer to a call, or an event.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Message {
    id: Option<u64>,
    result: Value,
    error: Option<Fault>,
    /// The event's name; empty for an answer.
    pub(super) method: String,
    /// The event's values.
    pub(super) params: Value,
}

#[derive(Debug, Deserialize)]
struct Fault {
    message: String,
}

/// A running Chromium, and its pipe.
#[derive(Debug)]
pub(super) struct Pipe {
    child: Child,
    /// `None` once it is closed, at which Chromium exits by itself, also if this process is killed.
    input: Option<ChildStdin>,
    messages: Receiver<Result<Message, String>>,
    calls: u64,
    program: PathBuf,
    folder: tempfile::TempDir,
}

pub(super) fn fault(error: impl std::fmt::Display) -> BrowserError {
    BrowserError::Connection(error.to_string())
}

impl Pipe {
    /// Starts `program` with those flags too, on an empty folder of its own.
    pub(super) fn open(program: &Path, flags: &[&str]) -> Result<Pipe, BrowserError> {
        let folder = tempfile::Builder::new().prefix("lapidary-").tempdir().map_err(fault)?;
        let mut command = Command::new("sh");
        command.args(["-c", SHELL, "sh"]).arg(program).args(FLAGS).args(flags);
        command.arg("--remote-debugging-pipe").arg(format!("--user-data-dir={}", folder.path().display()));
        // It leaves folders of sockets in the system's folder for temporary files.
        command.env("TMPDIR", folder.path());
        let log = File::create(folder.path().join(LOG)).map_err(fault)?;
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(log);
        let mut child = command.spawn().map_err(|error| fault(format!("sh cannot be started: {error}")))?;
        let (input, output) = (child.stdin.take(), child.stdout.take());
        let output = output.ok_or_else(|| fault("no pipe"))?;
        let (sender, messages) = mpsc::channel();
        // It ends with Chromium, at the end of the pipe.
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(message) = next(&mut output) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        Ok(Pipe { child, input, messages, calls: 0, program: program.to_owned(), folder })
    }

    /// Returns the folder of this Chromium, which is removed with it.
    pub(super) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Calls a method, and returns its result; events that come meanwhile are handed to `seen`.
    pub(super) fn call(
        &mut self,
        session: Option<&str>,
        method: &str,
        params: &Value,
        mut seen: impl FnMut(Message),
    ) -> Result<Value, BrowserError> {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": params });
        if let Some(session) = session {
            call["sessionId"] = session.into();
        }
        let sent = match &mut self.input {
            Some(input) => input.write_all(format!("{call}\0").as_bytes()).and_then(|()| input.flush()),
            None => return Err(fault("the browser is closed")),
        };
        sent.map_err(|error| self.ended(&format!("{method}: {error}")))?;
        let until = Instant::now() + PATIENCE;
        loop {
            let Some(message) = self.next(until.saturating_duration_since(Instant::now()))? else {
                return Err(self.gone(&format!("{method} gave no answer within {} s", PATIENCE.as_secs())));
            };
            match message.id {
                Some(id) if id == self.calls => {
                    return match message.error {
                        Some(error) => Err(BrowserError::Refused(format!("{method}: {}", error.message))),
                        None => Ok(message.result),
                    };
                }
                // The answer to a call that was given up.
                Some(_) => {}
                None => seen(message),
            }
        }
    }

    /// Returns the next message; `None` if none comes in that time.
    pub(super) fn next(&mut self, within: Duration) -> Result<Option<Message>, BrowserError> {
        match self.messages.recv_timeout(within) {
            Ok(Ok(message)) => Ok(Some(message)),
            Ok(Err(error)) => Err(self.gone(&error)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(self.ended("it closed its pipe")),
        }
    }

    /// The error for a browser that has exited, or at least left its pipe with that problem.
    fn ended(&mut self, problem: &str) -> BrowserError {
        match self.exit_within(FAREWELL) {
            // So says the shell.
            Some(status) if matches!(status.code(), Some(126 | 127)) => {
                self.gone(&format!("{} cannot be started", self.program.display()))
            }
            Some(status) => self.gone(&format!("it ended without an answer, {status}")),
            None => self.gone(problem),
        }
    }

    /// The error for a browser that is gone, with the last that it said.
    fn gone(&self, problem: &str) -> BrowserError {
        fault(format!("{problem}\n{}", last_lines(&self.folder().join(LOG))))
    }

    /// Waits for Chromium's exit; `None` if it stays for longer than that.
    fn exit_within(&mut self, within: Duration) -> Option<ExitStatus> {
        let until = Instant::now() + within;
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                _ if Instant::now() > until => return None,
                _ => std::thread::sleep(Duration::from_millis(10)),
            }
        }
    }

    /// Asks Chromium to exit, and waits for it; kills it if it stays.
    fn close(&mut self) {
        if let Some(mut input) = self.input.take() {
            let _ = input.write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        }
        if self.exit_within(FAREWELL).is_none() {
            // If it has exited meanwhile, there is nothing left to kill.
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

impl Drop for Pipe {
    fn drop(&mut self) {
        self.close();
    }
}

/// Returns the last lines that Chromium wrote to stderr.
fn last_lines(log: &Path) -> String {
    let text = std::fs::read(log).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(8)..].join("\n")
}

/// Reads one message; `None` at the end of the pipe.
fn next(output: &mut BufReader<impl Read>) -> Option<Result<Message, String>> {
    let mut bytes = Vec::new();
    match output.read_until(0, &mut bytes) {
        Ok(_) if bytes.pop() != Some(0) => None,
        Ok(_) => Some(serde_json::from_slice(&bytes).map_err(|error| format!("its message is no such one: {error}"))),
        Err(error) => Some(Err(error.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_end_with_a_zero() {
        let mut output = BufReader::new(&b"{\"method\":\"a\"}\0{\"id\":3,\"result\":{\"b\":1}}\0nothing\0cut"[..]);
        let first = next(&mut output).expect("one").expect("JSON");
        assert_eq!((first.id, first.method.as_str()), (None, "a"));
        let second = next(&mut output).expect("one").expect("JSON");
        assert_eq!((second.id, &second.result["b"]), (Some(3), &1.into()));
        assert!(next(&mut output).expect("one").is_err());
        assert!(next(&mut output).is_none());
    }

    #[test]
    fn a_program_that_is_no_browser_is_named_with_what_it_says() {
        let mut pipe = Pipe::open(Path::new("/nowhere/chromium"), &[]).expect("the shell starts");
        let error = pipe.call(None, "Browser.getVersion", &json!({}), |_| {}).expect_err("no browser").to_string();
        assert!(error.contains("/nowhere/chromium cannot be started"), "{error}");
    }
}
