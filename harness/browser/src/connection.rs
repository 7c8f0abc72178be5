//! The socket, the page's turns, and the process.
//!
//! A file, or the DOM that `--dump-dom` prints, would not do instead of the socket: Chromium's
//! virtual time continues while its GPU process compiles, so the DOM may be printed before it
//! contains anything.

use crate::{Adapter, BrowserError};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tiny_http::{Header, Request, Response, Server};

const PAGE: &str = include_str!("page.html");

/// Maximum time to wait for one answer. The longest job compiles all texts of a program, which
/// takes seconds.
const PATIENCE: Duration = Duration::from_secs(120);

/// Maximum time for Chromium to exit by itself, so that its folder can be removed.
const FAREWELL: Duration = Duration::from_secs(5);

/// A message: its head as JSON, and its bytes.
type Answer = (Vec<u8>, Vec<u8>);

/// A browser with the page open.
pub(crate) struct Connection {
    server: Server,
    child: Child,
    log: PathBuf,
    /// The page's pending request for its next job; `None` while it has none.
    turn: Option<Request>,
    /// Open requests that keep the page loading, and thereby keep Chromium running.
    ends: Vec<Request>,
    _folder: tempfile::TempDir,
}

impl std::fmt::Debug for Connection {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Connection").field("child", &self.child.id()).finish_non_exhaustive()
    }
}

fn fault(error: impl std::fmt::Display) -> BrowserError {
    BrowserError::Connection(error.to_string())
}

impl Connection {
    pub(crate) fn open(program: &Path, adapter: Adapter) -> Result<Connection, BrowserError> {
        let server = Server::http("127.0.0.1:0").map_err(fault)?;
        let address = format!("http://{}/", server.server_addr());
        let folder = tempfile::tempdir().map_err(fault)?;
        let log = folder.path().join("stderr");
        let child = start(program, adapter, &address, folder.path(), &log)
            .map_err(|error| BrowserError::Connection(format!("{} cannot be started: {error}", program.display())))?;
        Ok(Connection { server, child, log, turn: None, ends: Vec::new(), _folder: folder })
    }

    /// Waits for the page's first message.
    pub(crate) fn greeting(&mut self) -> Result<Answer, BrowserError> {
        self.answer()
    }

    /// Gives the page a job and waits for its answer.
    pub(crate) fn ask(&mut self, job: &impl Serialize, parts: &[&[u8]]) -> Result<Answer, BrowserError> {
        let message = packed(job, parts)?;
        let turn = self.turn.take().ok_or_else(|| fault("it did not ask for a job"))?;
        turn.respond(Response::from_data(message)).map_err(fault)?;
        self.answer()
    }

    /// Serves the page's requests until it hands in an answer.
    fn answer(&mut self) -> Result<Answer, BrowserError> {
        #[derive(Deserialize)]
        struct Refusal {
            fault: String,
        }
        let started = Instant::now();
        loop {
            match self.server.recv_timeout(Duration::from_millis(100)).map_err(fault)? {
                None => {}
                Some(request) if request.url() == "/" => {
                    let kind = Header::from_bytes("Content-Type", "text/html; charset=utf-8");
                    let kind = kind.unwrap_or_else(|()| unreachable!("a header's name and value"));
                    // If Chromium has exited, the check below notices.
                    let _ = request.respond(Response::from_string(PAGE).with_header(kind));
                }
                Some(request) if request.url() == "/end" => self.ends.push(request),
                Some(mut request) if request.url() == "/turn" => {
                    let mut body = Vec::new();
                    request.as_reader().read_to_end(&mut body).map_err(fault)?;
                    self.turn = Some(request);
                    let (head, bytes) = unpacked(body)?;
                    return match serde_json::from_slice(&head) {
                        Ok(Refusal { fault }) => Err(BrowserError::Refused(fault)),
                        Err(_) => Ok((head, bytes)),
                    };
                }
                Some(request) => {
                    let _ = request.respond(Response::empty(404));
                }
            }
            let problem = match self.child.try_wait() {
                Ok(Some(status)) => format!("it ended without an answer, {status}"),
                _ if started.elapsed() > PATIENCE => format!("it gave no answer within {} s", PATIENCE.as_secs()),
                _ => continue,
            };
            return Err(BrowserError::Connection(format!("{problem}\n{}", last_lines(&self.log))));
        }
    }

    /// Lets the page finish, and Chromium with it. If it does not, dropping the connection kills
    /// it.
    pub(crate) fn end(&mut self, job: &impl Serialize) {
        if let (Some(turn), Ok(message)) = (self.turn.take(), packed(job, &[])) {
            let _ = turn.respond(Response::from_data(message));
        }
        for end in self.ends.drain(..) {
            let _ = end.respond(Response::empty(204));
        }
        let started = Instant::now();
        while started.elapsed() < FAREWELL {
            if let Ok(Some(_)) = self.child.try_wait() {
                return;
            }
            // The page may request its image only now.
            if let Ok(Some(request)) = self.server.recv_timeout(Duration::from_millis(5)) {
                let _ = request.respond(Response::empty(204));
            }
        }
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        // If the process has exited, there is nothing left to kill.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn start(program: &Path, adapter: Adapter, address: &str, profile: &Path, log: &Path) -> io::Result<Child> {
    let mut command = Command::new(program);
    // Chromium shows only this process's page; and as root, which most containers run as, it has no
    // sandbox.
    command.args(["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run"]);
    command.arg("--enable-unsafe-webgpu");
    if adapter == Adapter::SwiftShader {
        command.arg("--use-webgpu-adapter=swiftshader");
    }
    command
        .arg(format!("--user-data-dir={}", profile.display()))
        // Makes Chromium exit once the page is loaded.
        .args(["--dump-dom", address])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(log)?)
        .spawn()
}

/// Packs a message: the length of the head, the head, and the bytes.
fn packed(head: &impl Serialize, parts: &[&[u8]]) -> Result<Vec<u8>, BrowserError> {
    let head = serde_json::to_vec(head).map_err(fault)?;
    let length = u32::try_from(head.len()).map_err(fault)?;
    Ok([&length.to_le_bytes()[..], &head].into_iter().chain(parts.iter().copied()).collect::<Vec<_>>().concat())
}

fn unpacked(mut message: Vec<u8>) -> Result<Answer, BrowserError> {
    let short = || fault("its answer is too short");
    let length = message.first_chunk().map(|bytes| u32::from_le_bytes(*bytes) as usize).ok_or_else(short)?;
    if message.len() < 4 + length {
        return Err(short());
    }
    let bytes = message.split_off(4 + length);
    Ok((message.split_off(4), bytes))
}

/// Returns the last lines that Chromium wrote to stderr.
pub(crate) fn last_lines(log: &Path) -> String {
    let text = std::fs::read(log).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(8)..].join("\n")
}
