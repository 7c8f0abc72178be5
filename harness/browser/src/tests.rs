//! The jobs in Chromium. Without it they say so and pass, as the tests of `driver` do.

use super::*;
use crate::driver::tests::chromium;

/// Adds one to each word.
const NEXT: &str = "@group(0) @binding(0) var<storage, read_write> x: array<u32>;
    @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) n: vec3u) {
        let i = id.x + 64u * n.x * id.y;
        if i < arrayLength(&x) { x[i] = x[i] + 1u; }
    }";

fn next(browser: &Browser, words: &[u32]) -> Result<Vec<u32>, BrowserError> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let buffers = [Buffer { size: bytes.len(), filled: Some(&bytes), read: true }];
    let workgroups = [1024, words.len().div_ceil(64 * 1024) as u32, 1];
    let found = browser.compute(&Compute { code: NEXT, entry: "main", buffers: &buffers, workgroups })?;
    Ok(found[0].as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
}

#[test]
fn a_browser_does_its_jobs_until_it_is_closed() {
    let Some(program) = chromium() else { return };
    let browser = Browser::start(&program, Adapter::SwiftShader).expect("a browser");
    assert!(browser.adapter().to_lowercase().contains("swiftshader"), "{}", browser.adapter());
    assert_eq!(next(&browser, &[1, 7, u32::MAX]).expect("a result"), [2, 8, 0]);
    // Quotes, lines and other letters of a text arrive as they are.
    let messages = browser.messages(&["// \"quoted\" 'twice' \\ é\nfn f() -> u32 { return nowhere; }", ""]);
    let messages = messages.expect("messages");
    assert_eq!((messages[0][0].kind.as_str(), messages[0][0].line, messages[1].len()), ("error", 2, 0));
    // A refusal ends nothing.
    let refused = browser.compute(&Compute { code: "fn", entry: "main", buffers: &[], workgroups: [1, 1, 1] });
    assert!(matches!(refused, Err(BrowserError::Refused(_))), "{refused:?}");
    let code = "#version 300 es\nflat out uvec4 found;\nvoid main() { found = uvec4(gl_VertexID); }";
    let varyings = ["found".to_owned()];
    let found = browser.transform(&Transform { code, varyings: &varyings, filled: &[], vertices: 2 });
    assert_eq!(found.expect("varyings")[12..20], [0, 0, 0, 0, 1, 0, 0, 0]);
    browser.close();
    let closed = browser.messages(&[]).expect_err("closed").to_string();
    assert_eq!(closed, "the browser is closed");
}

/// As many as a dispatch of `cook check` may have.
#[test]
fn many_bytes_arrive() {
    let Some(program) = chromium() else { return };
    let browser = Browser::start(&program, Adapter::SwiftShader).expect("a browser");
    let words: Vec<u32> = (0..4 << 20).collect();
    let found = next(&browser, &words).expect("a result");
    assert_eq!(found.len(), words.len());
    assert!(found.iter().zip(&words).all(|(found, word)| *found == word + 1));
}

#[test]
fn a_program_that_is_no_browser_is_told_from_none() {
    let error = |program: &str| Browser::start(Path::new(program), Adapter::Own).expect_err("no browser").to_string();
    assert!(error("/nowhere/chromium").contains("/nowhere/chromium cannot be started"));
    let ended = error("/bin/sh");
    assert!(ended.contains("it ended without an answer, exit status: "), "{ended}");
}
