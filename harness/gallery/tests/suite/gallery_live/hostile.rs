//! No WebGPU, no device, a lost one, a small one, and a file that is no environment: one clear sentence, and
//! the renderer's picture stands there.

use super::{DRAWN, begin, differing, running, shown};
use crate::gallery_pages::browser::{SOON, started};
use image::codecs::hdr::HdrEncoder;
use lapidary_browser::Page;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What the page says, its picture's visibility and the canvas's.
const SAID: &str = "(() => {
    const visible = (name) => Boolean(document.querySelector(`.live ${name}`).offsetParent);
    return [document.querySelector('.live-note').textContent, visible('img'), visible('canvas')];
})()";

const FAILED: &str = "document.querySelector('.live-note.failed')?.textContent";

/// The page has failed with a sentence that has these words, and shows the picture; returns the sentence.
fn has_failed(page: &mut Page, words: &[&str]) -> String {
    page.wait_for(FAILED, DRAWN).unwrap_or_else(|error| panic!("{words:?}: {error}"));
    let said = page.evaluate(SAID).expect("words");
    let text = said[0].as_str().expect("a text");
    assert!(words.iter().all(|part| text.contains(part)) && !text.contains('\n'), "{words:?}: {text}");
    assert_eq!((&said[1], &said[2]), (&json!(true), &json!(false)), "{text}");
    let broken = page.evaluate("document.querySelector('.live img').naturalWidth").expect("a width");
    assert_ne!(broken, 0);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0], "{words:?}");
    text.to_owned()
}

#[test]
#[ignore = "long; .ci/full runs it"]
fn without_a_device_the_picture_stands_there() {
    // Less than the picture's side.
    let small = limited(|name, default| if name == "maxTextureDimension2D" { 256 } else { default });
    let cases: [(&str, &[&str]); 4] = [
        ("Object.defineProperty(Navigator.prototype, 'gpu', { value: undefined });", &["no WebGPU"]),
        ("GPU.prototype.requestAdapter = async () => null;", &["no graphics device"]),
        ("GPUAdapter.prototype.requestDevice = async () => { throw new Error('It is asleep'); };", &["It is asleep"]),
        (&small, &["maxTextureDimension2D", "256"]),
    ];
    for (script, words) in cases {
        let Some(mut page) = started() else { return };
        page.before_scripts(script).expect("kept");
        begin(&mut page, "brilliant", "");
        has_failed(&mut page, words);
    }
}

/// WebGPU's default limits, which every device has at least, by its specification's table; without the two
/// alignments, whose larger value is the worse.
const DEFAULTS: [(&str, u64); 29] = [
    ("maxTextureDimension1D", 8192),
    ("maxTextureDimension2D", 8192),
    ("maxTextureDimension3D", 2048),
    ("maxTextureArrayLayers", 256),
    ("maxBindGroups", 4),
    ("maxBindGroupsPlusVertexBuffers", 24),
    ("maxBindingsPerBindGroup", 1000),
    ("maxDynamicUniformBuffersPerPipelineLayout", 8),
    ("maxDynamicStorageBuffersPerPipelineLayout", 4),
    ("maxSampledTexturesPerShaderStage", 16),
    ("maxSamplersPerShaderStage", 16),
    ("maxStorageBuffersPerShaderStage", 8),
    ("maxStorageTexturesPerShaderStage", 4),
    ("maxUniformBuffersPerShaderStage", 12),
    ("maxUniformBufferBindingSize", 1 << 16),
    ("maxStorageBufferBindingSize", 1 << 27),
    ("maxVertexBuffers", 8),
    ("maxBufferSize", 1 << 28),
    ("maxVertexAttributes", 16),
    ("maxVertexBufferArrayStride", 2048),
    ("maxInterStageShaderVariables", 16),
    ("maxColorAttachments", 8),
    ("maxColorAttachmentBytesPerSample", 32),
    ("maxComputeWorkgroupStorageSize", 1 << 14),
    ("maxComputeInvocationsPerWorkgroup", 256),
    ("maxComputeWorkgroupSizeX", 256),
    ("maxComputeWorkgroupSizeY", 256),
    ("maxComputeWorkgroupSizeZ", 64),
    ("maxComputeWorkgroupsPerDimension", 65535),
];

/// A script for a browser whose adapter and devices have these limits, and that refuses a device of more.
fn limited(limit: impl Fn(&str, u64) -> u64) -> String {
    let limits: serde_json::Map<String, Value> =
        DEFAULTS.iter().map(|(name, default)| ((*name).to_owned(), json!(limit(name, *default)))).collect();
    format!(
        "const limits = {{ minUniformBufferOffsetAlignment: 256, minStorageBufferOffsetAlignment: 256, ...{} }};
        for (const {{ prototype }} of [GPUAdapter, GPUDevice]) Object.defineProperty(prototype, 'limits', {{ value: limits }});
        const request = GPUAdapter.prototype.requestDevice;
        GPUAdapter.prototype.requestDevice = async function ({{ requiredLimits = {{}}, ...rest }} = {{}}) {{
          for (const [name, asked] of Object.entries(requiredLimits)) {{
            if (!(asked <= limits[name])) throw new DOMException(`${{name}} of ${{asked}}`, 'OperationError');
          }}
          return request.call(this, rest);
        }};",
        Value::from(limits)
    )
}

/// The frame that a live page draws for its state.
const FRAME: &str = "
    const { manifest, state } = gallery.live;
    const rung = manifest.rungs[state.rung];
    const file = rung.frames[rung.toggles.filter((name) => state.on[name]).join('+')];
    return JSON.parse(new TextDecoder().decode(await gallery.bytes(`live/${file}`)));";

/// Bytes that a sample of a colour target counts for, by WebGPU's table of formats.
fn target_bytes(format: &str) -> u64 {
    match format {
        "r8unorm" => 1,
        "r32float" | "rg16float" => 4,
        "rgba8unorm" | "rgba8unorm-srgb" | "rgba16float" | "rg32float" => 8,
        "rgba32float" => 16,
        other => panic!("{other}: a target of another format"),
    }
}

/// What a frame needs of some limits, by its rows. Both stages of a pipeline count as one.
fn needs(frame: &Value) -> BTreeMap<&'static str, u64> {
    let rows = |object: &Value, key: &str| object[key].as_array().cloned().unwrap_or_default();
    let resources = rows(frame, "resources");
    let number = |value: &Value| value.as_u64().unwrap_or_default();
    let mut needs = BTreeMap::new();
    let mut need = |name: &'static str, count: u64| {
        let most = needs.entry(name).or_insert(0);
        *most = count.max(*most);
    };
    for resource in &resources {
        let uses = rows(resource, "usage");
        need("maxBufferSize", number(&resource["bytes"]));
        if uses.contains(&json!("STORAGE")) {
            need("maxStorageBufferBindingSize", number(&resource["bytes"]));
        }
        if uses.contains(&json!("UNIFORM")) {
            need("maxUniformBufferBindingSize", number(&resource["bytes"]));
        }
        for side in rows(resource, "size").iter().take(2) {
            need("maxTextureDimension2D", number(side));
        }
    }
    let mut buffers: BTreeMap<(u64, &'static str), u64> = BTreeMap::new();
    for group in &rows(frame, "bind_groups") {
        need("maxBindGroups", number(&group["group"]) + 1);
        for entry in &rows(group, "entries") {
            let resource = &resources[usize::try_from(number(&entry["resource"])).expect("a place")];
            let uses = rows(resource, "usage");
            let limit = match resource["kind"].as_str() {
                Some("sampler") => "maxSamplersPerShaderStage",
                Some("texture") => "maxSampledTexturesPerShaderStage",
                _ if uses.contains(&json!("STORAGE")) => "maxStorageBuffersPerShaderStage",
                _ => "maxUniformBuffersPerShaderStage",
            };
            *buffers.entry((number(&group["pipeline"]), limit)).or_default() += 1;
        }
    }
    for pipeline in &rows(frame, "pipelines") {
        let targets = rows(pipeline, "targets");
        need("maxColorAttachments", targets.len() as u64);
        let bytes = targets.iter().map(|format| target_bytes(format.as_str().expect("a format"))).sum();
        need("maxColorAttachmentBytesPerSample", bytes);
    }
    for ((_, limit), count) in buffers {
        need(limit, count);
    }
    needs
}

/// A live page runs on a device of WebGPU's default limits. Half of them are less than its frame needs: it has
/// three bind groups, and targets of 24 bytes a sample. Then one sentence says what is missing.
#[test]
#[ignore = "long; .ci/full runs it"]
fn the_default_limits_are_enough_and_half_of_them_are_not() {
    for divisor in [1, 2] {
        let limits: BTreeMap<&str, u64> = DEFAULTS.iter().map(|(name, default)| (*name, default / divisor)).collect();
        let Some(mut page) = started() else { return };
        page.before_scripts(&limited(|name, _| limits[name])).expect("kept");
        begin(&mut page, "brilliant", "");
        // A lost device is replaced, which is not the end.
        let ended =
            format!("!document.querySelector('.live canvas').hidden || /^(?!.*was lost)./.test({FAILED} ?? '')");
        page.wait_for(&ended, DRAWN).expect("it runs, or says why not");
        let needs = needs(&page.run(FRAME).expect("a frame"));
        let lacking: Vec<_> = needs.iter().filter(|(name, need)| **need > limits[**name]).collect();
        println!("defaults / {divisor}: {lacking:?} lacking of {needs:?}");
        assert_eq!(lacking.is_empty(), divisor == 1, "{lacking:?}");
        if divisor == 1 {
            let said = page.evaluate(SAID).expect("words");
            assert_eq!(said, json!(["", false, true]));
            assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
            continue;
        }
        let said = has_failed(&mut page, &[]);
        let words: Vec<&str> = said.split(|letter: char| !letter.is_alphanumeric()).collect();
        let is_said = |(name, need): &(&&str, &u64)| {
            let numbers = [**need, limits[**name]].map(|number| number.to_string());
            words.contains(*name) && numbers.iter().all(|number| words.contains(&number.as_str()))
        };
        assert!(lacking.iter().any(is_said), "{said}: {lacking:?}");
    }
}

#[test]
#[ignore = "long; .ci/full runs it"]
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
#[ignore = "long; .ci/full runs it"]
fn a_device_that_does_not_last_is_given_up() {
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
    has_failed(&mut page, &["again and again"]);
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
#[ignore = "long; .ci/full runs it"]
fn a_dropped_environment_lights_and_another_file_is_refused() {
    use base64::Engine as _;
    let base64 = |bytes: &[u8]| base64::prelude::BASE64_STANDARD.encode(bytes);
    let Some(mut page) = running("brilliant", "") else { return };
    let before = shown(&mut page);
    // Cut short, of another kind, empty.
    let mut good = Vec::new();
    let texel = |index: usize| image::Rgb([if index % 64 < 20 { 4.0 } else { 0.1f32 }, 0.3, 0.2]);
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
