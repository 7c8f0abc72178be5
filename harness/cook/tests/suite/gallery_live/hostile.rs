//! No WebGPU, no device, a lost one, a small one, and a file that is no environment: one clear sentence, and
//! the renderer's picture stands there.

use super::{DRAWN, begin, differing, running, shown};
use crate::gallery_pages::browser::{SOON, started};
use image::codecs::hdr::HdrEncoder;
use lapidary_browser::Page;
use serde_json::json;

/// What the page says, its picture's visibility and the canvas's.
const SAID: &str = "(() => {
    const visible = (name) => Boolean(document.querySelector(`.live ${name}`).offsetParent);
    return [document.querySelector('.live-note').textContent, visible('img'), visible('canvas')];
})()";

const FAILED: &str = "document.querySelector('.live-note.failed')?.textContent";

/// The page has failed with a sentence that has these words, and shows the picture.
fn has_failed(page: &mut Page, words: &str) {
    page.wait_for(FAILED, DRAWN).unwrap_or_else(|error| panic!("{words}: {error}"));
    let said = page.evaluate(SAID).expect("words");
    let text = said[0].as_str().expect("a text");
    assert!(text.contains(words) && !text.contains('\n'), "{words}: {text}");
    assert_eq!((&said[1], &said[2]), (&json!(true), &json!(false)), "{text}");
    let broken = page.evaluate("document.querySelector('.live img').naturalWidth").expect("a width");
    assert_ne!(broken, 0);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0], "{words}");
}

#[test]
fn without_a_device_the_picture_stands_there() {
    let cases = [
        ("Object.defineProperty(Navigator.prototype, 'gpu', { value: undefined });", "no WebGPU"),
        ("GPU.prototype.requestAdapter = async () => null;", "no graphics device"),
        ("GPUAdapter.prototype.requestDevice = async () => { throw new Error('It is asleep'); };", "It is asleep"),
        // A quarter of what the picture takes.
        (
            "const limits = { maxTextureDimension2D: 256, maxBufferSize: 2 ** 28, maxStorageBufferBindingSize: 2 ** 27, maxStorageBuffersPerShaderStage: 8 };
            Object.defineProperty(GPUAdapter.prototype, 'limits', { value: limits });",
            "too small: its maxTextureDimension2D is 256",
        ),
    ];
    for (script, words) in cases {
        let Some(mut page) = started() else { return };
        page.before_scripts(script).expect("kept");
        begin(&mut page, "brilliant", "");
        has_failed(&mut page, words);
    }
}

/// Half of what WebGPU's least device has suffices.
#[test]
fn half_the_limits_are_enough() {
    if !super::runs_whole("half_the_limits_are_enough") {
        return;
    }
    let Some(mut page) = started() else { return };
    let halved = "
        const all = Object.getOwnPropertyDescriptor(GPUAdapter.prototype, 'limits').get;
        Object.defineProperty(GPUAdapter.prototype, 'limits', {
          get() {
            const whole = all.call(this);
            return new Proxy({}, { get: (_, name) => Math.floor(whole[name] / 2) });
          },
        });";
    page.before_scripts(halved).expect("kept");
    begin(&mut page, "brilliant", "");
    page.wait_for("!document.querySelector('.live canvas').hidden", DRAWN).expect("it runs");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

#[test]
fn a_lost_device_is_replaced() {
    let Some(mut page) = running("brilliant", "") else { return };
    let before = shown(&mut page);
    page.run("window.first = gallery.live.device; gallery.live.device.destroy();").expect("lost");
    page.wait_for(
        "gallery.live.device !== window.first && document.querySelector('.live-note').textContent === ''",
        DRAWN,
    )
    .expect("another device");
    assert_eq!(differing(&before, &shown(&mut page)), 0.0);
    // Sliders work on it.
    super::set(&mut page, "state.steps.index = 0");
    assert!(differing(&before, &shown(&mut page)) > 0.01);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// A device that is lost again and again is given up, until one asks for it.
#[test]
fn a_device_that_does_not_last_is_given_up() {
    if !super::runs_whole("a_device_that_does_not_last_is_given_up") {
        return;
    }
    let Some(mut page) = started() else { return };
    let lost = "
        const request = GPUAdapter.prototype.requestDevice;
        window.lasting = false;
        GPUAdapter.prototype.requestDevice = async function (...all) {
          const device = await request.apply(this, all);
          if (!window.lasting) setTimeout(() => device.destroy(), 500);
          return device;
        };";
    page.before_scripts(lost).expect("kept");
    begin(&mut page, "brilliant", "");
    let given_up = "document.querySelector('.live-note.failed')?.textContent.includes('again and again')";
    page.wait_for(given_up, DRAWN).expect("it gives up");
    has_failed(&mut page, "again and again");
    page.evaluate("window.lasting = true").expect("set");
    page.click(".live-run").expect("a button");
    page.wait_for(
        "!document.querySelector('.live canvas').hidden && document.querySelector('.live-note').textContent === ''",
        DRAWN,
    )
    .expect("it runs again");
}

/// Drops a file of these bytes, in base64, on the picture.
fn drop_file(page: &mut Page, name: &str, base64: &str) {
    let drop = format!(
        "const bytes = Uint8Array.from(atob('{base64}'), (letter) => letter.charCodeAt(0));
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([bytes], '{name}'));
        const target = document.querySelector('.live-picture');
        target.dispatchEvent(new DragEvent('dragover', {{ dataTransfer, bubbles: true, cancelable: true }}));
        target.dispatchEvent(new DragEvent('drop', {{ dataTransfer, bubbles: true, cancelable: true }}));"
    );
    page.run(&drop).expect("dropped");
}

#[test]
fn a_dropped_environment_lights_and_another_file_is_refused() {
    if !super::runs_whole("a_dropped_environment_lights_and_another_file_is_refused") {
        return;
    }
    use base64::Engine as _;
    let base64 = |bytes: &[u8]| base64::prelude::BASE64_STANDARD.encode(bytes);
    let Some(mut page) = running("brilliant", "") else { return };
    let before = shown(&mut page);
    // Cut short, of another kind, empty.
    let mut good = Vec::new();
    let texel = |at: usize| image::Rgb([if at % 64 < 20 { 4.0 } else { 0.1f32 }, 0.3, 0.2]);
    let texels: Vec<_> = (0..64 * 32).map(texel).collect();
    HdrEncoder::new(&mut good).encode(&texels, 64, 32).expect("encoded");
    let cases: [(&str, &[u8]); 3] =
        [("notes.txt", b"no picture"), ("cut.hdr", &good[..good.len() / 2]), ("empty.exr", b"")];
    for (name, bytes) in cases {
        page.evaluate("document.querySelector('.live-note').textContent = ''").expect("emptied");
        drop_file(&mut page, name, &base64(bytes));
        let note = "(() => { const note = document.querySelector('.live-note'); return note.matches('.failed') && note.textContent; })()";
        let said = page.wait_for(note, SOON).unwrap_or_else(|error| panic!("{name}: {error}"));
        let said = said.as_str().expect("words");
        println!("{name}: {said}");
        assert!(said.contains(name) && !said.contains('\n') && said.len() < 300, "{name}: {said}");
        assert_eq!(differing(&before, &shown(&mut page)), 0.0, "{name}");
    }
    drop_file(&mut page, "room.hdr", &base64(&good));
    page.wait_for("document.querySelector('.live-note').textContent.includes('Lit by room.hdr')", DRAWN).expect("lit");
    let share = differing(&before, &shown(&mut page));
    assert!(share > 0.1, "{share}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}
