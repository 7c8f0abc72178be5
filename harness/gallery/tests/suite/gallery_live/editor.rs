//! "Edit a function and check it": the module as it is holds, an error is shown at its line, and a wrong
//! constant is found.

use crate::gallery_pages::browser::{SOON, opened, started};
use crate::gallery_pages::site::site;
use lapidary_browser::Page;
use serde_json::{Value, json};
use std::time::Duration;

/// Time for a check on SwiftShader.
const CHECK: Duration = Duration::from_secs(100);
/// Unless the suite is run whole, one function in this many is checked in its page.
const ONE_IN: u64 = 25;

/// What ends a line of WGSL.
const LINE_ENDS: [char; 7] = ['\n', '\u{b}', '\u{c}', '\r', '\u{85}', '\u{2028}', '\u{2029}'];

/// From here on each check waits in `waiting` for the test's answer, `holds` or another.
const ANSWERED: &str = "
    window.waiting = [];
    window.holds = {
        rows: 1, held: 1, messages: [], adapter: 'a GPU', worst: { label: 'input 0', holds: true, inputs: [], parts: [] },
    };
    gallery.check = (name, text) => new Promise((resolve, reject) => waiting.push({ name, text, resolve, reject }));";
/// Time for a task that the page may have queued.
const SETTLE: &str = "await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)));";

/// Opens the editor of a module at a function.
fn editing(page: &mut Page, function: &str) {
    page.click(".check-open").expect("a button");
    page.wait_for("!document.querySelector('.check-editor').hidden", SOON).expect("the editor opens");
    editing_other(page, function);
}

/// Chooses a function in an open editor.
fn editing_other(page: &mut Page, function: &str) {
    let choose = format!(
        "const choice = document.querySelector('.check-function');
        choice.value = {};
        choice.dispatchEvent(new Event('change', {{ bubbles: true }}));
        return choice.value;",
        Value::from(function)
    );
    assert_eq!(page.run(&choose).expect("a choice"), function);
}

/// Changes the text as typing does.
fn edit(page: &mut Page, from: &str, to: &str) {
    let change = format!(
        "const field = document.querySelector('.check-text');
        const text = field.value.replace({}, {});
        if (text === field.value) throw new Error('nothing to replace');
        field.value = text;
        field.dispatchEvent(new Event('input', {{ bubbles: true }}));",
        Value::from(from),
        Value::from(to)
    );
    page.run(&change).expect("changed");
}

/// Checks, and returns what the page says.
fn checked(page: &mut Page) -> String {
    page.click(".check-run").expect("a button");
    let said = "(() => {
        const result = document.querySelector('.check-result');
        return result.querySelector('.check-holds, .check-fails') && result.textContent;
    })()";
    page.wait_for(said, CHECK).expect("a result").as_str().expect("words").to_owned()
}

#[test]
fn the_editor_tells_right_from_wrong() {
    let Some(mut page) = opened("modules/fresnel.html") else { return };
    editing(&mut page, "fresnel_dielectric");
    let right = checked(&mut page);
    assert!(right.starts_with("All ") && right.contains("rows hold"), "{right}");
    // A wrong constant.
    edit(&mut page, "min(0.5f * (s * s", "min(0.5001f * (s * s");
    let wrong = checked(&mut page);
    // The failure first: "N of M rows fail".
    let words: Vec<&str> = wrong.split(' ').take(5).collect();
    assert!(words[0].parse::<u32>().is_ok_and(|count| count > 0), "{wrong}");
    assert_eq!((words[1], &words[3..]), ("of", &["rows", "fail"][..]), "{wrong}");
    for word in ["The worst", "expected", "got", "tolerance", "cosine", "relative_index"] {
        assert!(wrong.contains(word), "{word}: {wrong}");
    }
    page.click(".check-restore").expect("a button");
    // An error, at its line.
    edit(&mut page, "let p_root = n_squared * c + g;", "let p_root = n_squared * c + nowhere;");
    let line = page
        .evaluate("document.querySelector('.check-text').value.split('\\n').findIndex((line) => line.includes('nowhere')) + 1")
        .expect("a line");
    let said = checked(&mut page);
    assert!(said.contains("does not compile") && said.contains("nowhere"), "{said}");
    assert!(said.contains(&format!("Line {line}")), "{line}: {said}");
    let marked = "[document.querySelector('.check-text').getAttribute('aria-invalid'), document.querySelector('.check-wrong')?.textContent]";
    assert_eq!(page.evaluate(marked).expect("marks"), json!(["true", line.to_string()]));
    page.click(".check-restore").expect("a button");
    let again = checked(&mut page);
    assert!(again.starts_with("All "), "{again}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// A check runs one function of the text: what else is changed is named, seen and said, before anything holds.
#[test]
fn what_is_changed_but_not_checked_is_named() {
    let Some(mut page) = opened("modules/dispersion.html") else { return };
    editing(&mut page, "dispersion_sellmeier");
    // No function is another by a comment or a space.
    edit(&mut page, "    // From nm² to µm².\n", "        // Squared.\n");
    let right = checked(&mut page);
    assert!(right.starts_with("All ") && !right.contains("changed"), "{right}");
    let broken = ["return coefficients.x + (", "return coefficients.y + ("];
    edit(&mut page, broken[0], broken[1]);
    // What is checked is not: no "too".
    let left = "dispersion_cauchy is changed, but not checked: choose it to check it.";
    let other = checked(&mut page);
    assert!(other.starts_with(left), "{other}");
    assert!(
        other.contains("rows hold for dispersion_sellmeier") && other.contains("It is as in the cookbook."),
        "{other}"
    );
    let said = page.evaluate("document.querySelector('#status').textContent").expect("words");
    assert!(said.as_str().is_some_and(|said| said.starts_with(left) && said.contains("All ")), "{said}");
    // The button beside it checks it, and the result is in view.
    page.click(".check-left .check-line").expect("a button");
    let failed = "document.querySelector('.check-fails')?.textContent";
    let wrong = page.wait_for(failed, CHECK).expect("a failure");
    assert!(wrong.as_str().is_some_and(|wrong| wrong.contains("rows fail for dispersion_cauchy")), "{wrong}");
    let place = "(() => {
        const { top, bottom } = document.querySelector('.check-fails').getBoundingClientRect();
        return top >= 0 && bottom <= innerHeight && document.activeElement.className;
    })()";
    page.wait_for(&format!("{place} === 'check-run'"), SOON).expect("in view, with the focus on the button");
    // What held as it is needs no other check; what needs a change is named as well.
    edit(&mut page, broken[1], "return coefficients.x + 0.0f + (");
    assert!(checked(&mut page).starts_with("All "));
    edit(&mut page, "fn dispersion_sellmeier(", "const DISPERSION_NEW = 1.0f;\nfn dispersion_sellmeier(");
    edit(&mut page, "return max(sqrt(max(1.0f + material", "return max(sqrt(max(DISPERSION_NEW + material");
    let alone = checked(&mut page);
    assert!(alone.starts_with("dispersion_sellmeier is changed too, but not checked"), "{alone}");
    editing_other(&mut page, "dispersion_sellmeier");
    let both = checked(&mut page);
    assert!(both.starts_with("All ") && !both.contains("changed"), "{both}");
    edit(&mut page, "DISPERSION_NEW = 1.0f", "DISPERSION_NEW = 1.5f");
    editing_other(&mut page, "dispersion_cauchy");
    let through = checked(&mut page);
    assert!(through.starts_with("dispersion_sellmeier is changed too, but not checked"), "{through}");
    page.click(".check-restore").expect("a button");
    let again = checked(&mut page);
    assert!(again.starts_with("All ") && !again.contains("changed"), "{again}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// What is changed is found by WGSL's rules: its comments nest, its lines have seven ends, its names any script.
#[test]
fn changes_are_found_by_the_rules_of_wgsl() {
    let Some(mut page) = opened("modules/dispersion.html") else { return };
    page.run(ANSWERED).expect("replaced");
    page.run("gallery.check = async () => holds;").expect("replaced");
    editing(&mut page, "dispersion_sellmeier");
    let (cauchy, sellmeier) = ("return coefficients.x + (", "fn dispersion_sellmeier(");
    let mut same = vec![
        (cauchy, format!("/* a /* b */ c */ {cauchy}")),
        (cauchy, format!("/* /* a */ {{ */ {cauchy}")),
        (cauchy, format!("/* // */ {cauchy}")),
        (cauchy, format!("/* //* */ {{ */ {cauchy}")),
        (cauchy, format!("// /*\n{cauchy}")),
        (cauchy, "return coefficients.x\u{200e}\u{85}+ (".to_owned()),
        // Neither the suffix of 1.0f nor the member of coefficients.x.
        (sellmeier, format!("fn f() {{}}\nconst x = 1.0f;\n{sellmeier}")),
    ];
    let mut other =
        vec![(cauchy, "return coefficients.y + (".to_owned()), (cauchy, "return coefficients.x */* + */ (".to_owned())];
    for end in LINE_ENDS {
        same.push((cauchy, format!("// a{end}{cauchy}")));
        other.push((cauchy, format!("// a{end}let b = 1.0f;{cauchy}")));
    }
    let left = "dispersion_cauchy is changed, but not checked";
    for (changed, cases) in [(false, same), (true, other)] {
        for (from, to) in cases {
            edit(&mut page, from, &to);
            let said = checked(&mut page);
            assert_eq!((said.starts_with(left), said.contains("changed")), (changed, changed), "{to:?}: {said}");
            page.click(".check-restore").expect("a button");
        }
    }
    // The text as it was, in a comment below.
    page.run(
        "const field = document.querySelector('.check-text');
        const [own] = /fn dispersion_cauchy[^]*?\\n}/.exec(field.value);
        field.value = field.value.replace(own, `${own.replace('coefficients.x', 'coefficients.y')} /* /* old */ ${own} */`);
        field.dispatchEvent(new Event('input', { bubbles: true }));",
    )
    .expect("changed");
    let hidden = checked(&mut page);
    assert!(hidden.starts_with(left), "{hidden}");
    page.click(".check-restore").expect("a button");
    // A name that is not ASCII.
    let use_of = |page: &mut Page, name: &str| edit(page, "max(1.0f + material", &format!("max({name} + material"));
    edit(&mut page, sellmeier, &format!("const Δ = 1.0f;\n{sellmeier}"));
    use_of(&mut page, "Δ");
    assert!(!checked(&mut page).contains("not checked"));
    edit(&mut page, "Δ = 1.0f", "Δ = 1.5f");
    editing_other(&mut page, "dispersion_abbe");
    let through = checked(&mut page);
    assert!(through.starts_with("dispersion_sellmeier is changed, but not checked"), "{through}");
    page.click(".check-restore").expect("a button");
    // A chain of constants.
    let chain: String = (1..20_000).map(|index| format!("const C{index} = C{};", index - 1)).collect();
    edit(&mut page, sellmeier, &format!("const C0 = 1.0f;{chain}\n{sellmeier}"));
    use_of(&mut page, "C19999");
    let long = checked(&mut page);
    assert!(long.starts_with("dispersion_sellmeier is changed, but not checked"), "{long}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// What a check found is shown only with the text that it ran.
#[test]
fn a_result_of_another_text_is_not_shown() {
    let Some(mut page) = opened("modules/dispersion.html") else { return };
    page.run(ANSWERED).expect("replaced");
    editing(&mut page, "dispersion_sellmeier");
    let waits = |page: &mut Page| page.wait_for("waiting.length === 1", SOON).expect("a check");
    let answer = |page: &mut Page, how: &str| page.run(&format!("waiting.shift().{how}; {SETTLE}")).expect("an answer");
    let shown = "(() => {
        const parts = ['.check-result', '.check-wrong', '.check-run[aria-disabled]'];
        const [result, wrong, busy] = parts.map((part) => document.querySelector(part));
        return [result.textContent, wrong, busy];
    })()";
    let nothing = json!(["", null, null]);
    let wrong = "resolve({
        ...holds, held: 0, worst: null, messages: [{ type: 'error', line: 3, column: 1, text: 'no' }],
    })";
    // As it was, an error is shown.
    page.click(".check-run").expect("a button");
    waits(&mut page);
    answer(&mut page, wrong);
    assert_eq!(page.evaluate("document.querySelector('.check-wrong').textContent").expect("a mark"), "3");
    for how in [wrong, "reject(new Error('lost'))"] {
        for meanwhile in ["type", ".check-restore", ".check-open"] {
            edit(&mut page, "1.0f", "1.00f");
            page.click(".check-run").expect("a button");
            waits(&mut page);
            match meanwhile {
                "type" => edit(&mut page, "1.00f", "1.000f"),
                button => page.click(button).expect("a button"),
            }
            answer(&mut page, how);
            assert_eq!(page.evaluate(shown).expect("a page"), nothing, "{meanwhile}, {how}");
            if meanwhile == ".check-open" {
                editing(&mut page, "dispersion_sellmeier");
            }
            page.click(".check-restore").expect("a button");
        }
    }
    // What held did hold, though another function is chosen by now.
    edit(&mut page, "max(1.0f + material", "max(1.5f + material");
    page.click(".check-run").expect("a button");
    waits(&mut page);
    editing_other(&mut page, "dispersion_cauchy");
    answer(&mut page, "resolve(holds)");
    assert_eq!(page.evaluate(shown).expect("a page"), nothing);
    page.click(".check-run").expect("a button");
    waits(&mut page);
    answer(&mut page, "resolve(holds)");
    let said = page.evaluate("document.querySelector('.check-result').textContent").expect("words");
    assert!(said.as_str().is_some_and(|said| said.starts_with("All 1 rows hold for dispersion_cauchy")), "{said}");
    // A press while a check runs is not lost: the text of that moment comes next.
    page.click(".check-run").expect("a button");
    waits(&mut page);
    edit(&mut page, "max(1.5f + material", "max(1.75f + material");
    page.click(".check-run").expect("a button");
    assert_eq!(page.evaluate("waiting.length").expect("a count"), 1);
    answer(&mut page, "resolve(holds)");
    assert_eq!(page.evaluate("waiting[0].text.includes('max(1.75f')").expect("a text"), true);
    answer(&mut page, "resolve(holds)");
    let said = page.evaluate("document.querySelector('.check-result').textContent").expect("words");
    assert!(said.as_str().is_some_and(|said| said.starts_with("dispersion_sellmeier is changed, ")), "{said}");
    // A closed editor offers no check of a text that nobody sees.
    page.click(".check-open").expect("a button");
    let closed =
        "[document.querySelector('.check-editor').hidden, document.querySelector('.check-result').childElementCount]";
    assert_eq!(page.evaluate(closed).expect("a page"), json!([true, 0]));
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// A function's own link opens the editor there, each time with the caret in the text.
#[test]
fn a_link_opens_the_editor_in_the_text() {
    let Some(mut page) = opened("modules/dispersion.html") else { return };
    let link = |name: &str| format!("a[data-check=dispersion_{name}]");
    // In a tab of its own, nothing opens here.
    for key in ["ctrlKey", "metaKey", "shiftKey", "altKey"] {
        let click = format!(
            "let followed;
            const seen = (event) => {{ followed = !event.defaultPrevented; event.preventDefault(); }};
            addEventListener('click', seen, {{ once: true }});
            const click = new MouseEvent('click', {{ bubbles: true, cancelable: true, {key}: true }});
            document.querySelector('{}').dispatchEvent(click);
            {SETTLE}
            return [followed, document.querySelector('.check-editor').hidden, location.hash];",
            link("abbe")
        );
        assert_eq!(page.run(&click).expect("a click"), json!([true, true, ""]), "{key}");
    }
    for name in ["cauchy", "abbe", "abbe"] {
        page.click(&link(name)).expect("a link");
        let place = format!(
            "{SETTLE}
            const {{ selectionStart, value }} = document.querySelector('.check-text');
            const {{ top }} = document.querySelector('.check-field').getBoundingClientRect();
            return [document.activeElement.id, value.slice(selectionStart).startsWith('fn dispersion_{name}('),
                document.querySelector('.check-function').value, location.hash, top > 0 && top < innerHeight];"
        );
        page.wait_for("!document.querySelector('.check-editor').hidden", SOON).expect("the editor opens");
        let expected = json!(["check-text", true, format!("dispersion_{name}"), "#edit-and-check", true]);
        assert_eq!(page.run(&place).expect("a place"), expected, "{name}");
    }
    // One step back is the page as it was.
    page.run("history.back()").expect("a step");
    page.wait_for("location.hash === ''", SOON).expect("back");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// A result that comes late does not pull back a reader who has gone on; else it comes into view.
#[test]
fn a_late_result_leaves_the_reader_where_they_are() {
    let Some(mut page) = opened("modules/dispersion.html") else { return };
    page.run(ANSWERED).expect("replaced");
    let asked = |page: &mut Page, answers: &str, before: &str, how: &str| {
        page.wait_for(&format!("{answers}.length === 1"), SOON).expect("a wait");
        let run = format!(
            "{before};
            const from = scrollY;
            {answers}.shift().{how};
            {SETTLE}
            const {{ bottom }} = document.querySelector('.check-result p').getBoundingClientRect();
            return [scrollY === from, bottom > 0 && bottom <= innerHeight];"
        );
        page.run(&run).expect("an answer")
    };
    // The text does not load.
    let load = "window.loads = []; window.load = gallery.load;
        gallery.load = () => new Promise((resolve, reject) => loads.push({ resolve, reject }));";
    page.run(load).expect("replaced");
    for (before, expected) in [("", json!(true)), ("scrollTo(0, 0)", json!(false))] {
        page.click("a[data-check]").expect("a link");
        let seen = asked(&mut page, "loads", before, "reject(new Error('not there'))");
        assert_eq!(seen[1], expected, "{before}");
        assert!(before.is_empty() || seen[0] == true, "{before}");
    }
    page.run("gallery.load = load").expect("put back");
    editing(&mut page, "dispersion_sellmeier");
    let at_the_end =
        "scrollTo(0, scrollY + document.querySelector('.check-field').getBoundingClientRect().bottom - innerHeight)";
    for (before, moves) in [(at_the_end, true), ("scrollTo(0, 0)", false), ("document.activeElement.blur()", false)] {
        page.run("document.querySelector('.check-text').focus()").expect("focused");
        page.run(at_the_end).expect("scrolled");
        page.press("Control+Enter").expect("a key");
        let seen = asked(&mut page, "waiting", before, "resolve(holds)");
        assert_eq!(seen, json!([!moves, moves]), "{before}");
    }
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// Names and signatures that are gone are the visitor's error, and told as one.
#[test]
fn a_function_that_is_gone_is_told() {
    let Some(mut page) = opened("modules/fresnel.html") else { return };
    editing(&mut page, "fresnel_normal_incidence");
    page.run(
        "const field = document.querySelector('.check-text');
        field.value = field.value.replaceAll('fresnel_normal_incidence', 'elsewhere');
        field.dispatchEvent(new Event('input', { bubbles: true }));",
    )
    .expect("changed");
    let said = checked(&mut page);
    assert!(said.contains("does not compile") && said.contains("names and signatures must stay"), "{said}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// Without WebGPU the editor says so in a sentence.
#[test]
fn an_editor_without_webgpu_says_so() {
    let Some(mut page) = started() else { return };
    page.before_scripts("Object.defineProperty(Navigator.prototype, 'gpu', { value: undefined });").expect("kept");
    page.open(&site().address("modules/fresnel.html")).expect("the page");
    editing(&mut page, "fresnel_dielectric");
    let said = checked(&mut page);
    assert!(said.contains("WebGPU"), "{said}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}

/// Every function holds in its page as it is.
#[test]
fn functions_hold_in_their_pages() {
    let Some(mut page) = started() else { return };
    let modules = lapidary_cookbook::modules();
    let mut wrong = Vec::new();
    let all: Vec<(&str, String)> = modules
        .iter()
        .flat_map(|module| {
            let names = offered(module.name);
            names.into_iter().map(|name| (module.name, name))
        })
        .collect();
    assert!(all.len() > 40, "{} functions are offered", all.len());
    for (module, name) in lapidary_testing::sampled(all, ONE_IN) {
        page.open(&site().address(&format!("modules/{module}.html"))).expect(module);
        let check = format!(
            "const text = await gallery.load('source/{module}');
            const {{ rows, held, messages }} = await gallery.check('{name}', text);
            return [held === rows && rows > 0, held, rows, messages];"
        );
        let found = page.run(&check).unwrap_or_else(|error| panic!("{name}: {error}"));
        if found[0] != true {
            wrong.push(format!("{name}: {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The functions that a module's page offers to check.
fn offered(module: &str) -> Vec<String> {
    let Some(page) = site().pages.get(&format!("modules/{module}.html")) else { panic!("no page of {module}") };
    page.options("check-function")
}
