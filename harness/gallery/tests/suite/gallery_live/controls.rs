//! Sliders, rungs, effects, the eye and the address.

use super::{begin, differing, names, running, set, shown};
use crate::gallery_pages::browser::{SOON, started};
use crate::gallery_pages::site::site;
use lapidary_gallery::live::{SCENES, SIDE};
use serde_json::json;

/// The middle of the picture in the window.
const PLACE: &str = "(() => {
    const box = document.querySelector('.live canvas').getBoundingClientRect();
    return [box.left + box.width / 2, box.top + box.height / 2];
})()";

/// The least share of pixels that a control must change.
const LEAST: f64 = 0.001;

/// Unless the suite is run whole, one scene; always the first.
fn some_scenes() -> Vec<&'static str> {
    let all = SCENES.iter().map(|live| live.scene);
    if lapidary_testing::whole() { all.collect() } else { all.take(1).collect() }
}

/// By its own input, as a visitor moves it.
#[test]
#[ignore = "long; .ci/full runs it"]
fn every_slider_changes_the_picture() {
    for scene in some_scenes() {
        let Some(mut page) = running(scene, "") else { return };
        let before = shown(&mut page);
        for name in names(&mut page, "sliders") {
            for end in ["0", "input.max"] {
                let moved = format!(
                    "const input = document.querySelector('#live-{name}');
                    input.value = {end};
                    input.dispatchEvent(new Event('input', {{ bubbles: true }}));
                    await gallery.live.set({{}});
                    return document.querySelector('[data-slider=\"{name}\"] output').textContent;"
                );
                let text = page.run(&moved).expect("moved");
                let share = differing(&before, &shown(&mut page));
                println!("{scene} {name} {text}: {share:.4}");
                assert!(share > LEAST, "{scene}: {name} at {text} changes {share} of the picture");
            }
            page.click(&format!("[data-slider=\"{name}\"] [data-reset]")).expect("a button");
            page.run("await gallery.live.set({});").expect("drawn");
            assert_eq!(differing(&before, &shown(&mut page)), 0.0, "{scene}: {name} back at its start");
        }
        assert_eq!(page.problems().expect("a list"), [] as [String; 0], "{scene}");
    }
}

/// Left of the wipe is one rung, right of it the other.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_wipe_stands_between_two_rungs() {
    let Some(mut page) = running("brilliant", "") else { return };
    let one = shown(&mut page);
    let rung = page.evaluate("gallery.live.state.rung").expect("a state");
    set(&mut page, "state.rung = 'proxy-4+tracker'");
    let other = shown(&mut page);
    assert!(differing(&one, &other) > 0.05, "two rungs look the same");
    set(&mut page, &format!("state.rung = {rung}; state.other = 'proxy-4+tracker'; state.wipe = 25"));
    let sides = "[...document.querySelectorAll('.live-side:not([hidden])')].map((side) => side.textContent)";
    assert_eq!(page.evaluate(sides).expect("names"), json!([rung, "proxy-4+tracker"]));
    let both = shown(&mut page);
    let side = SIDE as usize;
    let split = side / 4;
    for (row, pixels) in both.chunks_exact(4 * side).enumerate() {
        let span = |from: usize, to: usize| 4 * (row * side + from)..4 * (row * side + to);
        assert_eq!(pixels[..4 * split], one[span(0, split)], "row {row}, left");
        assert_eq!(pixels[4 * split..], other[span(split, side)], "row {row}, right");
    }
}

/// An effect is another shader, which the copied text shows, and it compiles.
#[test]
#[ignore = "long; .ci/full runs it"]
fn an_effect_is_another_shader() {
    for scene in some_scenes() {
        let Some(mut page) = running(scene, "") else { return };
        page.grant_clipboard().expect("granted");
        let copied = |page: &mut lapidary_browser::Page| {
            page.run("await navigator.clipboard.writeText('')").expect("emptied");
            page.click("[data-do=shader]").expect("a button");
            let text = page.wait_for("navigator.clipboard.readText()", SOON).expect("a text");
            text.as_str().expect("a text").to_owned()
        };
        let before = copied(&mut page);
        lapidary_specialise::parse(&before, "the shader").unwrap_or_else(|error| panic!("{scene}: {error}"));
        let of_rung = page.evaluate("gallery.live.manifest.rungs[gallery.live.state.rung].toggles").expect("names");
        let toggles = of_rung.as_array().expect("names").clone();
        assert!(!toggles.is_empty(), "{scene}");
        let picture = shown(&mut page);
        for name in toggles.iter().filter_map(|name| name.as_str()) {
            page.click(&format!(".live [data-toggle][name=\"{name}\"]")).expect("a box");
            page.run("await gallery.live.set({});").expect("drawn");
            let after = copied(&mut page);
            lapidary_specialise::parse(&after, "the shader").unwrap_or_else(|error| panic!("{scene} {name}: {error}"));
            let share = differing(&picture, &shown(&mut page));
            println!("{scene} {name}: {} bytes, {} before; {share:.4} of the picture", after.len(), before.len());
            assert_ne!(before, after, "{scene}: {name} leaves the shader as it was");
            assert!(share > LEAST, "{scene}: {name} changes {share} of the picture");
            page.click(&format!(".live [data-toggle][name=\"{name}\"]")).expect("a box");
            page.run("await gallery.live.set({});").expect("drawn");
        }
        assert_eq!(differing(&picture, &shown(&mut page)), 0.0, "{scene}");
    }
}

/// What a visitor sees can be sent to another.
#[test]
#[ignore = "long; .ci/full runs it"]
fn the_address_holds_the_state() {
    let Some(mut page) = running("brilliant", "") else { return };
    assert_eq!(page.evaluate("location.hash").expect("an address"), "");
    set(
        &mut page,
        "Object.assign(state, { other: 'surface', wipe: 70, polar: 55, azimuth: -30, distance: 4.5 });
        Object.assign(state.steps, { index: 3, exposure: 20, dispersion: 2 }); state.on.dispersion = false",
    );
    let (hash, state) =
        (page.evaluate("location.hash").expect("a hash"), page.evaluate("gallery.live.state").expect("a state"));
    let picture = shown(&mut page);
    let hash = hash.as_str().expect("a text").trim_start_matches('#').to_owned();
    for word in ["index=", "other=surface", "wipe=70", "view=55"] {
        assert!(hash.contains(word), "{word}: {hash}");
    }
    // What is off has nothing to move.
    let is_disabled = "document.querySelector('#live-dispersion').disabled";
    assert_eq!(page.evaluate(is_disabled).expect("a slider"), true);
    // A comparison of pictures leaves it alone.
    page.evaluate("document.querySelector('.compare-swap').click()").expect("a button");
    let kept = page.evaluate("location.hash").expect("a hash");
    assert_eq!(kept.as_str().map(|kept| kept.trim_start_matches('#')), Some(hash.as_str()));
    // What is sent is the address.
    page.grant_clipboard().expect("granted");
    page.click("[data-do=link]").expect("a button");
    let link = page.wait_for("navigator.clipboard.readText()", SOON).expect("a link");
    assert_eq!(link, page.evaluate("location.href").expect("an address"));
    begin(&mut page, "brilliant", &hash);
    page.wait_for("!document.querySelector('.live canvas').hidden", super::DRAWN).expect("started");
    page.evaluate("gallery.live.ready").expect("drawn");
    assert_eq!(page.evaluate("gallery.live.state").expect("a state"), state);
    assert_eq!(differing(&picture, &shown(&mut page)), 0.0);
    // Back to the start, the address is empty again.
    page.click("[data-do=start]").expect("a button");
    page.wait_for("location.hash === ''", SOON).expect("an empty fragment");
    // What makes no sense is left out.
    begin(&mut page, "brilliant", "rung=none&index=x&view=1,2&wipe=1e9&nothing");
    page.wait_for("!document.querySelector('.live canvas').hidden", super::DRAWN).expect("started");
    let wipe = page.evaluate("gallery.live.state.wipe").expect("a state");
    assert_eq!(wipe, 100);
    assert_eq!(page.evaluate("gallery.live.state.rung").expect("a state"), SCENES[0].rungs[0]);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// The picture that stands there is not what a link asks for, and says so.
#[test]
fn a_link_says_what_it_asks_for() {
    let Some(mut page) = started() else { return };
    let mut said = |fragment: &str| {
        page.open("about:blank").expect("an empty page");
        page.open(&format!("{}#{fragment}", site().address("live/brilliant.html"))).expect("a page");
        let asked = "(() => { const asked = document.querySelector('.live-asked'); return asked.hidden ? '' : asked.textContent; })()";
        page.evaluate(asked).expect("a text")
    };
    assert_eq!(
        said("rung=walk-4&other=surface&index=1.5&dispersion=off&dispersion=2&view=60,40,3.2&unknown=1&environment=x"),
        "This link asks for walk-4; surface beside it; Index of refraction: 1.5; dispersion: an index for each colour: off; \
            Dispersion, as a factor of the mineral’s: 2; another view. Run it to see that."
    );
    for of_the_page in ["", "compare=convex,walk-4,walk-2", "ladder-convex", "unknown=1", "rung=none", "index=x"] {
        assert_eq!(said(of_the_page), "", "{of_the_page}");
    }
}

/// What appears by a choice or a press takes no other control's place, and a wipe says why it does nothing.
#[test]
#[ignore = "long; .ci/full runs it"]
fn no_control_slides_under_a_pointer() {
    let Some(mut page) = running("brilliant", "") else { return };
    page.grant_clipboard().expect("granted");
    // Within the controls: the window may scroll.
    let places = "(() => {
        const { left, top } = document.querySelector('.live-controls').getBoundingClientRect();
        return Array.from(document.querySelectorAll('.live-controls :is(select, input, button)'), (control) => {
            const box = control.getBoundingClientRect();
            return [box.left - left, box.top - top, box.width, box.height].map(Math.round).join();
        });
    })()";
    let wipe = "(() => {
        const row = document.querySelector('[data-wipe]');
        return [row.querySelector('input').disabled, row.querySelector('output').textContent];
    })()";
    let before = page.evaluate(places).expect("places");
    assert_eq!(page.evaluate(wipe).expect("a row"), json!([true, "nothing beside"]));
    set(&mut page, "state.other = 'surface'");
    assert_eq!(page.evaluate(places).expect("places"), before, "a rung beside it");
    assert_eq!(page.evaluate(wipe).expect("a row"), json!([false, "50 %"]));
    set(&mut page, "state.rung = 'surface'");
    assert_eq!(page.evaluate(wipe).expect("a row"), json!([true, "same rung twice"]));
    assert_eq!(page.evaluate(places).expect("places"), before, "the same rung twice");
    let left_out = "Array.from(document.querySelectorAll('[name=other] option:disabled'), ({ value }) => value)";
    assert_eq!(page.evaluate(left_out).expect("names"), json!(["surface"]));
    page.click("[data-do=shader]").expect("a button");
    page.wait_for("document.querySelector('[data-do=shader]').textContent === 'Copied'", SOON).expect("copied");
    assert_eq!(page.evaluate(places).expect("places"), before, "a text is copied");
    let width = "document.querySelector('.live-command .copy').getBoundingClientRect().width";
    let wide = page.evaluate(width).expect("a width");
    page.click(".live-command .copy").expect("a button");
    page.wait_for("document.querySelector('.live-command .copy').textContent === 'Copied'", SOON).expect("copied");
    assert_eq!(page.evaluate(width).expect("a width"), wide, "a command is copied");
    // A link keeps the focus while what it leads to stays the same.
    let focused = "document.activeElement.closest('.live-recipes a')?.textContent";
    page.evaluate("document.querySelector('.live-recipes a').focus()").expect("the focus");
    let recipe = page.evaluate(focused).expect("a link");
    assert!(recipe.is_string(), "{recipe}");
    set(&mut page, "state.steps.index = 3");
    assert_eq!(page.evaluate(focused).expect("a link"), recipe, "another picture");
    // The command is whole.
    let cut = "Array.from(document.querySelectorAll('.live-command code')).some((code) => code.scrollWidth > code.clientWidth + 1)";
    assert_eq!(page.evaluate(cut).expect("a comparison"), false);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// The wheel is the page's until the picture is clicked, and again after Escape. With Ctrl too, by which one enlarges
/// the page. Other buttons are the browser's.
#[test]
#[ignore = "long; .ci/full runs it"]
fn the_wheel_is_the_pages_until_a_click() {
    let Some(mut page) = running("brilliant", "") else { return };
    page.run("document.querySelector('.live canvas').scrollIntoView({ block: 'center', behavior: 'instant' });")
        .expect("in view");
    let turned = |page: &mut lapidary_browser::Page, modifiers: u32| {
        let place = page.evaluate(PLACE).expect("a place");
        let wheel = json!({ "type": "mouseWheel", "x": place[0], "y": place[1], "deltaX": 0, "deltaY": 40, "modifiers": modifiers });
        page.call("Input.dispatchMouseEvent", wheel).expect("turned");
    };
    let states = "[scrollY, gallery.live.state.distance]";
    let before = page.evaluate(states).expect("states");
    turned(&mut page, 0);
    page.wait_for(&format!("scrollY > {}", before[0]), SOON).expect("the page scrolls");
    assert_eq!(page.evaluate("gallery.live.state.distance").expect("a distance"), before[1]);
    let further = |page: &mut lapidary_browser::Page, modifiers: u32, why: &str| {
        let before = page.evaluate(states).expect("states");
        turned(page, modifiers);
        page.wait_for(&format!("gallery.live.state.distance > {}", before[1]), SOON).expect(why);
    };
    const CTRL: u32 = 2;
    let listen =
        "addEventListener('wheel', ({ ctrlKey, defaultPrevented }) => (window.wheel = [ctrlKey, defaultPrevented]));";
    page.run(listen).expect("listens");
    let is_the_browsers = |page: &mut lapidary_browser::Page, why: &str| {
        page.run("window.wheel = null;").expect("reset");
        turned(page, CTRL);
        assert_eq!(page.wait_for("window.wheel", SOON).expect(why), json!([true, false]), "{why}");
    };
    let before = page.evaluate("gallery.live.state").expect("a state");
    is_the_browsers(&mut page, "with Ctrl");
    for (button, buttons) in [("right", 2), ("middle", 4)] {
        let place = page.evaluate(PLACE).expect("a place");
        for (kind, moved) in [("mousePressed", 0.0), ("mouseMoved", 30.0), ("mouseReleased", 30.0)] {
            let x = place[0].as_f64().expect("a number") + moved;
            let event = json!({
                "type": kind, "x": x, "y": place[1], "button": button, "buttons": buttons, "clickCount": 1,
            });
            page.call("Input.dispatchMouseEvent", event).expect("pressed");
        }
        is_the_browsers(&mut page, button);
    }
    assert_eq!(page.evaluate("gallery.live.state").expect("a state"), before);
    page.click(".live canvas").expect("clicked");
    further(&mut page, 0, "after a click");
    further(&mut page, CTRL, "with Ctrl after a click");
    page.press("Escape").expect("pressed");
    let before = page.evaluate(states).expect("states");
    turned(&mut page, 0);
    page.wait_for(&format!("scrollY !== {}", before[0]), SOON).expect("the page scrolls again");
    assert_eq!(page.evaluate("gallery.live.state.distance").expect("a distance"), before[1]);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// By keys, by the mouse, and by the wheel.
#[test]
#[ignore = "long; .ci/full runs it"]
fn the_eye_is_moved() {
    let Some(mut page) = running("brilliant", "") else { return };
    let before = shown(&mut page);
    let state = "(({ polar, azimuth, distance }) => [polar, azimuth, distance])(gallery.live.state)";
    let start = page.evaluate(state).expect("a state");
    page.evaluate("document.querySelector('.live canvas').focus()").expect("the focus");
    page.press("ArrowRight").expect("pressed");
    page.press("ArrowUp").expect("pressed");
    page.press("+").expect("pressed");
    page.run("await gallery.live.set({});").expect("drawn");
    let by_keys = page.evaluate(state).expect("a state");
    for part in 0..3 {
        assert_ne!(start[part], by_keys[part], "part {part}: {start} {by_keys}");
    }
    assert!(differing(&before, &shown(&mut page)) > 0.01);
    let middle = page.evaluate(PLACE).expect("a place");
    let [x, y] = [0, 1].map(|part| middle[part].as_f64().expect("a number"));
    page.drag([x, y], [x + 50.0, y]).expect("dragged");
    page.run("await gallery.live.set({});").expect("drawn");
    let by_mouse = page.evaluate(state).expect("a state");
    assert_ne!(by_keys[1], by_mouse[1]);
    let wheel = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": 100 });
    page.call("Input.dispatchMouseEvent", wheel).expect("turned");
    page.wait_for(&format!("gallery.live.state.distance !== {}", by_mouse[2]), SOON).expect("further away");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// One finger turns sideways and scrolls up and down; two turn and zoom. None takes the wheel.
#[test]
#[ignore = "long; .ci/full runs it"]
fn fingers_turn_zoom_and_scroll() {
    let Some(mut page) = running("brilliant", "") else { return };
    page.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": true, "maxTouchPoints": 2 })).expect("a phone");
    page.run("document.querySelector('.live canvas').scrollIntoView({ block: 'center', behavior: 'instant' });")
        .expect("in view");
    let states = "(({ azimuth, polar, distance }) => [azimuth, polar, distance, scrollY])(gallery.live.state)";
    // Fingers go from some places to others around the picture's middle, in steps as a hand does.
    let mut dragged = |from: &[[f64; 2]], to: &[[f64; 2]]| {
        let before = page.evaluate(states).expect("states");
        let middle = page.evaluate(PLACE).expect("a place");
        let [x, y] = [0, 1].map(|part| middle[part].as_f64().expect("a number"));
        let mut touch = |kind: &str, share: Option<f64>| {
            let points = from.iter().zip(to).zip(0..).map(|((from, to), id)| {
                let offset = |part: usize| from[part] + share.unwrap_or(0.0) * (to[part] - from[part]);
                json!({ "x": x + offset(0), "y": y + offset(1), "id": id })
            });
            let points: Vec<_> = if share.is_some() { points.collect() } else { Vec::new() };
            page.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points })).expect(kind);
        };
        touch("touchStart", Some(0.0));
        for step in 1..=5 {
            touch("touchMove", Some(f64::from(step) / 5.0));
        }
        touch("touchEnd", None);
        page.run("await gallery.live.set({});").expect("drawn");
        let held = page.evaluate("document.querySelector('.live canvas').classList.contains('held')").expect("a class");
        assert_eq!(held, false, "{from:?}");
        let after = page.evaluate(states).expect("states");
        [0, 1, 2, 3].map(|part| after[part].as_f64().expect("a number") - before[part].as_f64().expect("a number"))
    };
    let [azimuth, _, distance, scrolled] = dragged(&[[-60.0, 0.0]], &[[60.0, 0.0]]);
    assert!(azimuth < -20.0 && distance == 0.0 && scrolled == 0.0, "sideways: {azimuth} {distance} {scrolled}");
    let [_, polar, distance, scrolled] = dragged(&[[-20.0, -40.0], [20.0, -40.0]], &[[-80.0, 40.0], [80.0, 40.0]]);
    assert!(polar < -20.0 && distance < -0.5 && scrolled == 0.0, "two: {polar} {distance} {scrolled}");
    let [azimuth, polar, distance, scrolled] = dragged(&[[0.0, 60.0]], &[[0.0, -60.0]]);
    assert!(scrolled > 50.0, "up: {scrolled}");
    assert!([azimuth, polar, distance] == [0.0; 3], "up: {azimuth} {polar} {distance}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// Begins a measurement, for statements that go on in its midst.
const MEASURES: &str = "
    const [note, time] = ['.live-note', '.live-time'].map((of) => document.querySelector(of));
    const measured = gallery.live.measure();
    while (note.textContent !== 'Measuring …') await new Promise(requestAnimationFrame);";

/// A picture does not stand still for a measurement: what is changed stops it, which is said.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_change_stops_a_measurement() {
    let Some(mut page) = running("brilliant", "") else { return };
    let before = shown(&mut page);
    let moved = format!(
        "{MEASURES}
        const submit = GPUQueue.prototype.submit;
        let runs = 0;
        GPUQueue.prototype.submit = function (...all) {{
            runs += 1;
            return submit.apply(this, all);
        }};
        const input = document.querySelector('#live-index');
        input.value = 0;
        input.dispatchEvent(new Event('input', {{ bubbles: true }}));
        const said = [note.textContent];
        await measured;
        const more = runs;
        await gallery.live.set({{}});
        said.push(note.textContent);
        return [said, time.textContent, more];"
    );
    let answer = page.run(&moved).expect("moved");
    let stopped = "Something was changed, so the measurement stopped.";
    assert_eq!((&answer[0], &answer[1]), (&json!([stopped, stopped]), &json!("")));
    // The run that is under way ends, with what reads its time.
    assert!(answer[2].as_u64().is_some_and(|more| more <= 2), "{answer}");
    assert!(differing(&before, &shown(&mut page)) > LEAST, "the picture stands still");
    assert_eq!(page.evaluate("document.querySelectorAll('svg.plot .visitor').length").expect("a count"), 0);
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// A device that is lost, or draws no picture, is not timed, and what was said of it stays.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_faulty_device_is_not_timed() {
    let Some(mut page) = running("brilliant", "") else { return };
    let lost = format!(
        "{MEASURES}
        const {{ device }} = gallery.live;
        device.destroy();
        await measured;
        while (gallery.live.device === device || note.textContent) {{
            if (note.textContent.includes('Measuring')) throw new Error('it measures on');
            await new Promise(requestAnimationFrame);
        }}
        return time.textContent;"
    );
    assert_eq!(page.run(&lost).expect("another device"), "");
    let fails = "
        const error = new GPUValidationError('broken on purpose');
        gallery.live.device.dispatchEvent(new GPUUncapturedErrorEvent('uncapturederror', { error }));
        gallery.live.set({});
        await gallery.live.measure();
        const [note, time] = ['.live-note', '.live-time'].map((of) => document.querySelector(of));
        return [note.textContent, note.matches('.failed'), time.textContent];";
    let said = "Broken on purpose. The picture above is the one that the renderer draws.";
    assert_eq!(page.run(fails).expect("a sentence"), json!([said, true, ""]));
    // Another one has another chance.
    page.click(".live-run").expect("a button");
    page.wait_for("!document.querySelector('.live canvas').hidden", super::DRAWN).expect("it runs again");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// The time is the visitor's own, and stands in the plot.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_measured_time_is_drawn_into_the_plot() {
    let Some(mut page) = running("brilliant", "") else { return };
    // One that was stopped is in no other's way.
    page.run(&format!("{MEASURES} gallery.live.set({{}});")).expect("stopped");
    page.click("[data-do=time]").expect("a button");
    let text = page.wait_for("document.querySelector('.live-time').textContent", super::DRAWN).expect("a time");
    let text = text.as_str().expect("a text");
    for words in [
        format!("{0} × {0} pixels, one sample each, controls as at the start", SCENES[0].timed_side),
        format!("The picture on screen ({SIDE} × {SIDE} pixels, 9 samples each, controls as they are)"),
    ] {
        assert!(text.contains(&words), "{words}: {text}");
    }
    assert_eq!(text.matches(" ms on your GPU").count(), 2, "{text}");
    page.wait_for("document.querySelectorAll('svg.plot .visitor').length > 0", SOON).expect("a point in the plot");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}
