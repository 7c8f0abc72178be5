//! Each on a small page of its own. Without Chromium they say so and pass; with
//! `LAPIDARY_CHROMIUM=required`, as in `.ci/run`, they fail.

use super::{Page, address};
use crate::Browser;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

const HTML: &str = r#"<!DOCTYPE html>
<html lang="en"><head><meta name="viewport" content="width=device-width"><title>A page</title>
<style>body { margin: 0 } @media (prefers-color-scheme: dark) { body { background: #000 } }
.over { position: absolute; top: 200px; left: 0; width: 200px; height: 50px }</style></head>
<body><button id="first" onclick="this.textContent = 'clicked'">first</button>
<input id="second" aria-label="second"><button id="third">third</button>
<button class="over" id="under">under</button><div class="over" id="above"></div>
<img src="nowhere.png" alt="">
<script>window.keys = []; addEventListener('keydown', (event) => keys.push(event.key));</script></body></html>
"#;

/// Returns the path of Chromium; nothing without one, if it is not required.
pub(crate) fn chromium() -> Option<PathBuf> {
    let required = std::env::var_os("LAPIDARY_CHROMIUM").is_some_and(|value| value == "required");
    let program = Browser::find();
    if program.is_none() {
        assert!(!required, "no Chromium on the PATH");
        let _ = writeln!(std::io::stderr(), "not checked: no Chromium on the PATH");
    }
    program
}

/// Starts a browser at the page; nothing without Chromium.
fn opened() -> Option<(Page, tempfile::TempDir)> {
    let program = chromium()?;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("page.html");
    std::fs::write(&path, HTML).expect("written");
    let mut page = Page::start(&program).expect("a browser");
    page.open(&format!("file://{}", path.display())).expect("the page");
    Some((page, folder))
}

#[test]
fn addresses_are_escaped() {
    assert_eq!(address(Path::new("/tmp/.a-1/page.html")), "file:///tmp/.a-1/page.html");
    assert_eq!(address(Path::new("/a b/50%/#é?")), "file:///a%20b/50%25/%23%C3%A9%3F");
}

#[test]
fn a_page_answers() {
    let Some((mut page, folder)) = opened() else { return };
    assert_eq!(page.evaluate("document.title").expect("a value"), "A page");
    assert_eq!(
        page.evaluate("Promise.resolve([1, { a: null }])").expect("a value"),
        serde_json::json!([1, { "a": null }])
    );
    assert_eq!(page.run("const one = await Promise.resolve(1); return one + 1;").expect("a value"), 2);
    assert!(page.evaluate("undefined").expect("nothing").is_null());
    let error = page.evaluate("nowhere.at.all").expect_err("thrown").to_string();
    assert!(error.contains("nowhere is not defined"), "{error}");
    let error = page.evaluate("Promise.reject(new Error('too late'))").expect_err("rejected").to_string();
    assert!(error.contains("too late"), "{error}");
    let error = page.evaluate("one +").expect_err("no expression").to_string();
    assert!(error.contains("SyntaxError"), "{error}");
    // What comes later is waited for, and what does not come is said.
    page.evaluate("setTimeout(() => { window.late = 7; }, 200); 0").expect("set");
    assert_eq!(page.wait_for("window.late", Duration::from_secs(20)).expect("it comes"), 7);
    let error = page.wait_for("window.never", Duration::from_millis(100)).expect_err("never").to_string();
    assert!(error.contains("window.never"), "{error}");
    // A place that is not there is no page.
    let error = page.open(&format!("file://{}/none.html", folder.path().display())).expect_err("none").to_string();
    assert!(error.contains("none.html") && error.contains("ERR_FILE_NOT_FOUND"), "{error}");
}

#[test]
fn what_goes_wrong_is_seen() {
    let Some((mut page, folder)) = opened() else { return };
    let problems = page.problems().expect("a list").to_vec();
    assert!(problems.iter().any(|problem| problem.contains("nowhere.png")), "{problems:?}");
    page.evaluate("console.log('fine'); console.error('spilt', 3); 0").expect("said");
    page.evaluate("setTimeout(() => { throw new Error('loose'); }); Promise.reject(new Error('unwanted')); 0")
        .expect("set");
    let _ = page.evaluate("new Promise((done) => setTimeout(done, 100))").expect("a while");
    let all = page.problems().expect("a list").join("\n");
    for words in ["console.error: spilt 3", "loose", "unwanted"] {
        assert!(all.contains(words), "{words}: {all}");
    }
    assert!(!all.contains("fine"), "{all}");
    let requests = page.requests().expect("a list").to_vec();
    assert!(requests[0].ends_with("/page.html") && requests[1].ends_with("/nowhere.png"), "{requests:?}");
    // Another opening starts with a clean slate, after a script of its own.
    page.before_scripts("window.early = typeof keys;").expect("kept");
    page.open(&format!("file://{}/page.html", folder.path().display())).expect("again");
    assert_eq!(page.evaluate("early").expect("a value"), "undefined");
    assert!(!page.problems().expect("a list").iter().any(|problem| problem.contains("spilt")));
}

#[test]
fn keys_and_clicks_arrive() {
    let Some((mut page, _folder)) = opened() else { return };
    page.press("Tab").expect("pressed");
    page.press("Tab").expect("pressed");
    page.type_text("a/ b").expect("typed");
    assert_eq!(page.evaluate("document.activeElement.value").expect("a value"), "a/ b");
    page.press("Shift+Tab").expect("pressed");
    assert_eq!(page.evaluate("document.activeElement.id").expect("a value"), "first");
    assert_eq!(
        page.evaluate("getComputedStyle(document.activeElement).outlineStyle !== 'none'").expect("a value"),
        true
    );
    page.press("Enter").expect("pressed");
    assert_eq!(page.evaluate("first.textContent").expect("a value"), "clicked");
    assert_eq!(page.evaluate("keys.join()").expect("a value"), "Tab,Tab,a,/, ,b,Shift,Tab,Enter".replace("Shift,", ""));
    page.click("#third").expect("clicked");
    assert_eq!(page.evaluate("document.activeElement.id").expect("a value"), "third");
    let covered = page.click("#under").expect_err("covered").to_string();
    assert!(covered.contains("#under is covered by <div"), "{covered}");
    let absent = page.click("#fourth").expect_err("absent").to_string();
    assert!(absent.contains("nothing is #fourth"), "{absent}");
    page.grant_clipboard().expect("granted");
    let copied = page.evaluate("navigator.clipboard.writeText('taken').then(() => navigator.clipboard.readText())");
    assert_eq!(copied.expect("a clipboard"), "taken");
}

#[test]
fn a_window_has_its_size_and_its_colours() {
    let Some((mut page, _folder)) = opened() else { return };
    // A PNG's width and height stand in its header.
    let size = |png: &[u8]| {
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
        [16, 20].map(|offset| u32::from_be_bytes(png[offset..offset + 4].try_into().expect("four bytes")))
    };
    let light = page.screenshot(320, 480, false).expect("a picture");
    let dark = page.screenshot(320, 480, true).expect("a picture");
    assert_eq!((size(&light), size(&dark)), ([320, 480], [320, 480]));
    assert_ne!(light, dark);
    page.set_viewport(390, 844, true).expect("set");
    assert_eq!(page.evaluate("[innerWidth, innerHeight]").expect("a value"), serde_json::json!([390, 844]));
    page.set_media(false, true).expect("set");
    assert_eq!(page.evaluate("matchMedia('(prefers-reduced-motion: reduce)').matches").expect("a value"), true);
}

/// A canvas of WebGPU's on SwiftShader, which the flags are for; and none, if a script before the page's says so.
#[test]
fn webgpu_is_there_unless_a_script_takes_it() {
    let Some((mut page, folder)) = opened() else { return };
    let drawn = page.run(
        "const adapter = await navigator.gpu.requestAdapter();
        const device = await adapter.requestDevice();
        const canvas = document.createElement('canvas');
        const context = canvas.getContext('webgpu');
        context.configure({ device, format: 'rgba8unorm' });
        const encoder = device.createCommandEncoder();
        const view = context.getCurrentTexture().createView();
        encoder.beginRenderPass({ colorAttachments: [{ view, loadOp: 'clear', storeOp: 'store' }] }).end();
        device.queue.submit([encoder.finish()]);
        await device.queue.onSubmittedWorkDone();
        return adapter.info.architecture;",
    );
    assert_eq!(drawn.expect("a canvas"), "swiftshader");
    page.before_scripts("Object.defineProperty(Navigator.prototype, 'gpu', { value: undefined });").expect("kept");
    page.open(&format!("file://{}/page.html", folder.path().display())).expect("the page");
    assert_eq!(page.evaluate("navigator.gpu === undefined").expect("a value"), true);
}
