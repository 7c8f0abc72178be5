//! The gallery by keyboard alone.

use super::browser::{SOON, opened};
use lapidary_browser::Page;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// What has the focus: its name, whether it lies in the window, and whether the focus can be seen: an
/// outline or a shadow that it does not have without.
const FOCUSED: &str = "(() => {
    const element = document.activeElement;
    const look = () => {
      const { outlineStyle, outlineWidth, boxShadow, backgroundColor, borderColor } = getComputedStyle(element);
      return JSON.stringify([outlineStyle === 'none' ? '0px' : outlineWidth, boxShadow, backgroundColor, borderColor]);
    };
    const focused = look();
    const box = element.getBoundingClientRect();
    const inside = box.width > 0 && box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth;
    element.blur();
    const plain = look();
    element.focus({ preventScroll: true });
    return {
      name: element.matches('a.skip') ? 'skip' : element.closest('nav') ? 'navigation'
        : element.matches('button.copy') ? 'copy' : element.matches('.search-open') ? 'search' : element.tagName,
      html: element.outerHTML.slice(0, 160), inside, visible: focused !== plain,
    };
})()";

fn focused(page: &mut Page) -> Value {
    page.evaluate(FOCUSED).expect("an element")
}

#[test]
fn tab_reaches_everything_and_shows_where_it_is() {
    let Some(mut page) = opened("modules/refraction.html") else { return };
    page.press("Tab").expect("pressed");
    let first = focused(&mut page);
    assert_eq!(
        (&first["name"], &first["inside"], &first["visible"]),
        (&"skip".into(), &true.into(), &true.into()),
        "{first}"
    );
    let mut reached = BTreeSet::new();
    for _ in 0..150 {
        let focus = focused(&mut page);
        assert!(focus["inside"] == true && focus["visible"] == true, "a focus that cannot be seen: {focus}");
        reached.insert(focus["name"].as_str().expect("a name").to_owned());
        if ["skip", "search", "navigation", "copy"].iter().all(|name| reached.contains(*name)) {
            break;
        }
        page.press("Tab").expect("pressed");
    }
    for name in ["skip", "search", "navigation", "copy"] {
        assert!(reached.contains(name), "{name} was not reached: {reached:?}");
    }
}

/// The first link leads past the navigation.
#[test]
fn the_skip_link_skips() {
    let Some(mut page) = opened("modules/refraction.html") else { return };
    page.press("Tab").expect("pressed");
    page.press("Enter").expect("pressed");
    page.press("Tab").expect("pressed");
    let within = page.evaluate("document.querySelector('main').contains(document.activeElement)").expect("a value");
    assert_eq!(within, true, "{}", focused(&mut page));
}

#[test]
fn a_function_is_found_without_a_mouse() {
    for (from, words, function, module) in [
        ("index.html", "refraction_refl", "refraction_reflect", "refraction"),
        ("guides/glossary.html", "fresnel schlick", "fresnel_schlick", "fresnel"),
    ] {
        let Some(mut page) = opened(from) else { return };
        page.press("/").expect("pressed");
        page.wait_for("document.activeElement.matches('input')", SOON).expect("a field for the words");
        page.type_text(words).expect("typed");
        assert_eq!(page.evaluate("document.activeElement.value").expect("a value"), words);
        let found = format!(
            "[...document.querySelectorAll('dialog[open] a, [role=dialog] a, [role=option]')].some((link) => link.outerHTML.includes('modules/{module}.html#'))"
        );
        page.wait_for(&found, SOON).unwrap_or_else(|error| panic!("{words}: {error}"));
        page.press("Enter").expect("pressed");
        let arrived =
            format!("location.pathname.endsWith('modules/{module}.html') && location.hash.startsWith('#{function}')");
        page.wait_for(&arrived, SOON).unwrap_or_else(|error| panic!("{words}: {error}"));
        let there = page.wait_for("document.getElementById(location.hash.slice(1)) !== null", SOON);
        there.unwrap_or_else(|error| panic!("{words}: {error}"));
        assert_eq!(page.problems().expect("a list"), [] as [String; 0], "{words}");
    }
}

/// What nothing is called is said to be so, and Escape gives the focus back.
#[test]
fn a_search_without_a_find_says_so_and_closes() {
    let Some(mut page) = opened("index.html") else { return };
    page.press("/").expect("pressed");
    page.wait_for("document.activeElement.matches('input')", SOON).expect("a field for the words");
    page.type_text("zzqxj").expect("typed");
    page.wait_for("/no(thing|ne)?\\b/i.test(document.querySelector('dialog[open], [role=dialog]').textContent)", SOON)
        .expect("it says that there is nothing");
    // Where a page has some of the words, it is shown.
    page.type_text(" refraction").expect("typed");
    let some = "document.querySelectorAll('#found > li').length > 0 && document.querySelector('.search .hint').textContent.includes('some')";
    page.wait_for(some, SOON).expect("what has some of the words");
    // The first empties the field, as Chromium's fields for searching do.
    page.press("Escape").expect("pressed");
    page.press("Escape").expect("pressed");
    page.wait_for("!document.querySelector('dialog[open]') && !document.activeElement.matches('input')", SOON)
        .expect("it closes");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

#[test]
fn a_comparison_moves_by_arrows() {
    let Some(mut page) = opened("techniques/gems.html") else { return };
    page.evaluate("document.querySelector('.compare-wipe').scrollIntoView({ block: 'center' }); document.querySelector('.compare-wipe').focus()")
        .expect("a slider");
    // What it looks like, but for the number itself.
    let look = "(() => {
        const figure = document.querySelector('.compare-wipe').closest('figure');
        const parts = [...figure.querySelectorAll('.compare-side, .compare-line, .compare-side *, .compare-stage')];
        return parts.map((part) => { const style = getComputedStyle(part); return [style.clipPath, style.left, style.width, style.transform].join(); }).join(';');
    })()";
    let number = "Number(document.querySelector('.compare-wipe').value)";
    let (before, from) = (page.evaluate(look).expect("a look"), page.evaluate(number).expect("a value"));
    for _ in 0..10 {
        page.press("ArrowRight").expect("pressed");
    }
    let (after, to) = (page.evaluate(look).expect("a look"), page.evaluate(number).expect("a value"));
    assert!(to.as_f64() > from.as_f64(), "{from} {to}");
    assert_ne!(before, after, "the picture does not follow the slider");
    page.press("Home").expect("pressed");
    assert_eq!(page.evaluate(number).expect("a value"), 0);
}

/// The times of the other device are an arrow away.
#[test]
fn a_plots_device_is_chosen_by_arrows() {
    let Some(mut page) = opened("techniques/diffusion.html") else { return };
    let shown = "[...document.querySelectorAll('.ladder figure.plot')].map((plot) => plot.getClientRects().length > 0)";
    assert_eq!(page.evaluate(shown).expect("plots"), json!([true, false]));
    page.evaluate("document.querySelector('.plot-devices input').focus()").expect("a choice");
    page.press("ArrowRight").expect("pressed");
    assert_eq!(page.evaluate(shown).expect("plots"), json!([false, true]));
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// Whether the large picture is that of the link at a place, which stands there once it has come.
fn is_large(place: usize) -> String {
    format!(
        "(() => {{
            const links = [...new Set([...document.querySelectorAll('a.picture')].map((link) => link.href))];
            const image = document.querySelector('dialog[open] img');
            return image?.complete && image.naturalWidth > 0 && image.src === links[{place}];
        }})()"
    )
}

/// A finger to the left goes on, as a page is turned, one to the right back; one that goes down does neither.
#[test]
fn pictures_go_on_by_a_finger() {
    let Some(mut page) = opened("techniques/gems.html") else { return };
    page.evaluate("document.querySelector('a.picture').click()").expect("a picture");
    page.wait_for(&is_large(0), SOON).expect("a large picture");
    for (to, place) in [([150.0, 310.0], 1), ([360.0, 420.0], 1), ([270.0, 300.0], 1), ([420.0, 290.0], 0)] {
        let mut touch = |kind: &str, points: Value| {
            page.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points })).expect(kind);
        };
        touch("touchStart", json!([{ "x": 300.0, "y": 300.0 }]));
        touch("touchMove", json!([{ "x": to[0], "y": to[1] }]));
        touch("touchEnd", json!([]));
        page.wait_for(&is_large(place), SOON).unwrap_or_else(|error| panic!("{to:?}: {error}"));
        let count = page.evaluate("document.querySelector('.lightbox-place').textContent").expect("a place");
        assert!(
            count.as_str().is_some_and(|count| count.starts_with(&format!("{} of ", place + 1))),
            "{to:?}: {count}"
        );
    }
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// A picture opens large, Right goes on to the next, Escape closes it, and the focus is where it was.
#[test]
fn pictures_open_go_on_and_close_by_keys() {
    let Some(mut page) = opened("techniques/gems.html") else { return };
    page.evaluate("[...document.querySelectorAll('a.picture')].forEach((link, at) => { link.dataset.at = at; }); document.querySelector('a.picture').focus()")
        .expect("pictures");
    page.press("Enter").expect("pressed");
    page.wait_for(&is_large(0), SOON).expect("a large picture");
    assert!(
        page.evaluate("location.pathname").expect("a value").as_str().is_some_and(|path| path.ends_with("gems.html"))
    );
    page.press("ArrowRight").expect("pressed");
    page.wait_for(&is_large(1), SOON).expect("the next picture");
    // Its caption says what drew it, and how to draw it again.
    let caption =
        page.evaluate("document.querySelector('dialog[open] .lightbox-caption').textContent").expect("a caption");
    assert!(caption.as_str().is_some_and(|caption| caption.contains("./cook")), "{caption}");
    page.press("ArrowLeft").expect("pressed");
    page.wait_for(&is_large(0), SOON).expect("back again");
    page.press("Escape").expect("pressed");
    page.wait_for("!document.querySelector('dialog[open]')", SOON).expect("it closes");
    assert_eq!(page.evaluate("document.activeElement.dataset.at").expect("the focus"), "0");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}
