//! Chromium without a window, on a page from this process that asks WebGPU about each text.
//!
//! The page and its answer go through a socket of this machine, not through a file and the DOM that `--dump-dom` prints:
//! Chromium's virtual time runs on while its GPU process compiles, so that the DOM may be printed before it holds anything.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

const PAGE: &str = include_str!("page.html");

/// The programs that are looked for on the PATH.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// For all texts. They take seconds.
const PATIENCE: Duration = Duration::from_secs(120);

/// What Chromium says of a text.
#[derive(Debug, serde::Deserialize)]
pub(super) struct Message {
    /// `error`, `warning` or `info`.
    pub(super) kind: String,
    pub(super) text: String,
    /// From 1; 0 where the message is of no line.
    pub(super) line: usize,
}

#[derive(serde::Deserialize)]
#[serde(untagged)]
enum Answer {
    Judged { adapter: String, messages: Vec<Vec<Message>> },
    Fault { fault: String },
}

/// A request of the page, and where to answer it.
struct Request {
    path: String,
    body: String,
    stream: TcpStream,
}

/// The first of [`NAMES`] on the PATH.
pub(super) fn find() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

/// The adapter's name and the messages about each text; or why there are none.
pub(super) fn ask(program: &Path, texts: &[&str]) -> Result<(String, Vec<Vec<Message>>), String> {
    let fault = |error: io::Error| error.to_string();
    let texts = serde_json::to_string(texts).map_err(|error| error.to_string())?;
    let listener = TcpListener::bind("127.0.0.1:0").map_err(fault)?;
    listener.set_nonblocking(true).map_err(fault)?;
    let address = listener.local_addr().map_err(fault)?;
    let folder = tempfile::tempdir().map_err(fault)?;
    let log = folder.path().join("stderr");
    let mut child = start(program, &format!("http://{address}/"), folder.path(), &log).map_err(fault)?;
    let answer = serve(listener, &mut child, &texts);
    end(&mut child);
    match serde_json::from_str(&answer.map_err(|error| format!("{error}\n{}", last_lines(&log)))?) {
        Ok(Answer::Judged { adapter, messages }) => Ok((adapter, messages)),
        Ok(Answer::Fault { fault }) => Err(fault),
        Err(error) => Err(error.to_string()),
    }
}

fn start(program: &Path, address: &str, profile: &Path, log: &Path) -> io::Result<Child> {
    Command::new(program)
        // It shows this process's page alone; and root, which runs most containers, has no sandbox.
        .args(["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run"])
        // The adapter that Chromium brings along: the texts are judged alike on every machine, with or without a GPU.
        .args(["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"])
        .arg(format!("--user-data-dir={}", profile.display()))
        // Ends it once the page is loaded.
        .args(["--dump-dom", address])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(log)?)
        .spawn()
}

/// Answers the page's requests until the page has sent its answer, which is returned.
/// Takes the listener, so that whatever comes later is refused and keeps Chromium from nothing.
fn serve(listener: TcpListener, child: &mut Child, texts: &str) -> Result<String, String> {
    let started = Instant::now();
    let (sender, requests): (Sender<Request>, Receiver<Request>) = channel();
    let mut ends = Vec::new();
    loop {
        while let Ok((stream, _)) = listener.accept() {
            let sender = sender.clone();
            // Chromium opens connections ahead, on which nothing comes.
            std::thread::spawn(move || read_request(stream).map(|request| sender.send(request)));
        }
        while let Ok(request) = requests.try_recv() {
            match request.path.as_str() {
                "/" => respond(request.stream, "text/html", PAGE),
                "/texts" => respond(request.stream, "application/json", texts),
                "/answer" => {
                    ends.push(request.stream);
                    ends.into_iter().for_each(|stream| respond(stream, "text/plain", ""));
                    return Ok(request.body);
                }
                "/end" => ends.push(request.stream),
                _ => respond(request.stream, "text/plain", ""),
            }
        }
        if let Ok(Some(status)) = child.try_wait() {
            return Err(format!("it ended without an answer, {status}"));
        }
        if started.elapsed() > PATIENCE {
            return Err(format!("it gave no answer within {} s", PATIENCE.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn read_request(stream: TcpStream) -> io::Result<Request> {
    stream.set_nonblocking(false)?;
    let mut reader = BufReader::new(stream);
    let mut first = String::new();
    reader.read_line(&mut first)?;
    let path = first.split(' ').nth(1).unwrap_or_default().to_owned();
    let mut length = 0;
    loop {
        let mut line = String::new();
        reader.read_line(&mut line)?;
        match line.trim_end().split_once(':') {
            Some((name, value)) if name.eq_ignore_ascii_case("content-length") => {
                length = value.trim().parse().map_err(io::Error::other)?;
            }
            Some(_) => {}
            None => break,
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body)?;
    let body = String::from_utf8(body).map_err(io::Error::other)?;
    Ok(Request { path, body, stream: reader.into_inner() })
}

fn respond(mut stream: TcpStream, kind: &str, body: &str) {
    let length = body.len();
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    );
    // Where Chromium has gone, `serve` notices.
    let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body.as_bytes()));
}

/// Lets it end by itself, so that it leaves its folder to be removed; or ends it.
fn end(child: &mut Child) {
    let started = Instant::now();
    while started.elapsed() < Duration::from_secs(5) {
        if let Ok(Some(_)) = child.try_wait() {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let _ = child.kill();
    let _ = child.wait();
}

/// The end of what it wrote on stderr.
fn last_lines(log: &Path) -> String {
    let text = std::fs::read(log).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(8)..].join("\n")
}
