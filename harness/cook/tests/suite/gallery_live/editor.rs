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
    let left = "dispersion_cauchy is changed too, but not checked: choose it to check it.";
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
    let own = checked(&mut page);
    assert!(own.starts_with("dispersion_sellmeier is changed too, but not checked"), "{own}");
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
    let modules = lapidary_cook::cookbook::modules();
    let mut wrong = Vec::new();
    let all: Vec<(&str, String)> = modules
        .iter()
        .flat_map(|module| {
            let names = offered(module.name);
            names.into_iter().map(|name| (module.name, name))
        })
        .collect();
    assert!(all.len() > 40, "{} functions are offered", all.len());
    for (module, name) in crate::sampled(all, ONE_IN) {
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
