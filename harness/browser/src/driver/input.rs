//! Keys, clicks and files for a page.

use super::pipe::fault;
use super::{Page, keys};
use crate::BrowserError;
use serde_json::{Value, json};
use std::fs::File;
use std::io::Write as _;

/// Finds an element to click, brings it into view and returns where it is. What lies over it would get
/// the click in its stead.
const PLACE: &str = "((selector) => {
    const element = document.querySelector(selector);
    if (!element) throw new Error(`nothing is ${selector}`);
    element.scrollIntoView({ block: 'center', inline: 'center', behavior: 'instant' });
    const box = element.getBoundingClientRect();
    const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
    const top = document.elementFromPoint(x, y);
    if (!box.width || !box.height) throw new Error(`${selector} has no area`);
    if (!top || !(element.contains(top) || top.contains(element) || element.labels?.[0]?.contains(top))) {
        throw new Error(`${selector} is covered by ${top?.outerHTML.slice(0, 200) ?? 'nothing: it is out of view'}`);
    }
    return [x, y];
})";

impl Page {
    /// Presses a key: a name as in `KeyboardEvent.key` or a character, with `Shift+`, `Control+`,
    /// `Alt+` or `Meta+` before it.
    ///
    /// # Errors
    /// Returns an error if there is no such key, or the browser is gone.
    pub fn press(&mut self, key: &str) -> Result<(), BrowserError> {
        for event in keys::events(key)? {
            self.call("Input.dispatchKeyEvent", event)?;
        }
        Ok(())
    }

    /// Presses the keys of a text, one after another.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn type_text(&mut self, text: &str) -> Result<(), BrowserError> {
        text.chars().try_for_each(|letter| self.press(letter.encode_utf8(&mut [0; 4])))
    }

    /// Clicks in the middle of the first element of that selector.
    ///
    /// # Errors
    /// Returns an error if there is none, or something lies over it.
    pub fn click(&mut self, selector: &str) -> Result<(), BrowserError> {
        let place = self.evaluate(&format!("{PLACE}({})", Value::from(selector)))?;
        for kind in ["mouseMoved", "mousePressed", "mouseReleased"] {
            let count = u8::from(kind != "mouseMoved");
            let button = if kind == "mouseMoved" { "none" } else { "left" };
            let event = json!({ "type": kind, "x": place[0], "y": place[1], "button": button, "clickCount": count });
            self.call("Input.dispatchMouseEvent", event)?;
        }
        Ok(())
    }

    /// Drags with the left button from one place to another, in CSS pixels of the window.
    ///
    /// # Errors
    /// Returns an error if the browser is gone.
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) -> Result<(), BrowserError> {
        for (kind, [x, y]) in [("mousePressed", from), ("mouseMoved", to), ("mouseReleased", to)] {
            let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", event)?;
        }
        Ok(())
    }

    /// Returns the protocol's name for the object that an expression of JavaScript is.
    pub(crate) fn object(&mut self, expression: &str) -> Result<String, BrowserError> {
        let answer = self.call("Runtime.evaluate", json!({ "expression": expression }))?;
        let name = answer["result"]["objectId"].as_str();
        name.map(str::to_owned).ok_or_else(|| fault(format!("{expression} is no object")))
    }

    /// Chooses a file in a field for one, which is given as [`Page::object`] has it: a file of the browser's
    /// folder, with these bytes. The next one takes its place.
    pub(crate) fn choose_file(&mut self, input: &str, parts: &[&[u8]]) -> Result<(), BrowserError> {
        let path = self.pipe.folder().join("chosen");
        File::create(&path)
            .and_then(|mut file| parts.iter().try_for_each(|part| file.write_all(part)))
            .map_err(fault)?;
        let path = path.to_str().ok_or_else(|| fault("the folder's name is not in Unicode"))?;
        self.call("DOM.setFileInputFiles", json!({ "files": [path], "objectId": input })).map(|_| ())
    }
}
