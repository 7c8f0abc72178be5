//! The gallery's live parts in Chromium, on SwiftShader: the editor, and the frames that run in a page.
//!
//! Without Chromium these tests say so and pass. With `LAPIDARY_CHROMIUM=required`, as in `.ci/run`,
//! they fail.

mod controls;
mod editor;
mod hostile;
mod pictures;

use crate::gallery_pages::browser::started;
use crate::gallery_pages::site::site;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use lapidary_browser::Page;
use serde_json::Value;
use std::time::Duration;

/// Time until a scene is compiled and drawn on SwiftShader.
const DRAWN: Duration = Duration::from_secs(110);

/// A picture that the canvas shows: sRGB, four bytes a pixel.
type Shown = Vec<u8>;

/// Starts a live page at a part of its address after `#`, and the scene in it by a click; nothing without
/// Chromium.
fn running(scene: &str, fragment: &str) -> Option<Page> {
    let mut page = started()?;
    begin(&mut page, scene, fragment);
    page.wait_for("!document.querySelector('.live canvas').hidden", DRAWN).expect(scene);
    page.evaluate("gallery.live.ready").expect(scene);
    Some(page)
}

/// Opens a live page anew, and clicks what starts it.
fn begin(page: &mut Page, scene: &str, fragment: &str) {
    // The same page at another fragment would not be loaded anew.
    page.open("about:blank").expect("an empty page");
    let hash = if fragment.is_empty() { String::new() } else { format!("#{fragment}") };
    page.open(&format!("{}{hash}", site().address(&format!("live/{scene}.html")))).expect(scene);
    page.click(".live-run").expect("a button");
}

/// Reads back the texture that the canvas shows.
fn shown(page: &mut Page) -> Shown {
    let read = "
        const { width, height, rgba } = await gallery.live.readback();
        if (rgba.length !== 4 * width * height) throw new Error(`${rgba.length} bytes`);
        let text = '';
        for (let at = 0; at < rgba.length; at += 8192) text += String.fromCharCode(...rgba.subarray(at, at + 8192));
        return btoa(text);";
    let text = page.run(read).expect("a picture");
    BASE64_STANDARD.decode(text.as_str().expect("base64")).expect("base64")
}

/// Changes the state by statements about a copy of it, and waits until that is drawn.
fn set(page: &mut Page, change: &str) {
    page.run(&format!("const state = gallery.live.state; {change}; await gallery.live.set(state);")).expect(change);
}

/// The share of pixels that differ by more than rounding.
fn differing(one: &[u8], other: &[u8]) -> f64 {
    assert_eq!(one.len(), other.len());
    let differs = |(one, other): (&[u8], &[u8])| one.iter().zip(other).any(|(one, other)| one.abs_diff(*other) > 2);
    let count = one.chunks_exact(4).zip(other.chunks_exact(4)).filter(|pair| differs(*pair)).count();
    count as f64 / (one.len() / 4) as f64
}

/// The names in an object of the page's manifest.
fn names(page: &mut Page, key: &str) -> Vec<String> {
    let names = page.evaluate(&format!("Object.keys(gallery.live.manifest.{key})")).expect("a manifest");
    names.as_array().into_iter().flatten().filter_map(Value::as_str).map(str::to_owned).collect()
}
