//! Keys by their names: what a keyboard would send.

use crate::BrowserError;
use serde_json::{Value, json};

/// Keys with a name: the name in `KeyboardEvent.key`, its code, its virtual key code, and its text.
const NAMED: [(&str, &str, u32, &str); 13] = [
    ("Tab", "Tab", 9, ""),
    ("Enter", "Enter", 13, "\r"),
    ("Escape", "Escape", 27, ""),
    (" ", "Space", 32, " "),
    ("PageUp", "PageUp", 33, ""),
    ("PageDown", "PageDown", 34, ""),
    ("End", "End", 35, ""),
    ("Home", "Home", 36, ""),
    ("ArrowLeft", "ArrowLeft", 37, ""),
    ("ArrowUp", "ArrowUp", 38, ""),
    ("ArrowRight", "ArrowRight", 39, ""),
    ("ArrowDown", "ArrowDown", 40, ""),
    ("Backspace", "Backspace", 8, ""),
];

/// Bits of the modifiers in the protocol.
const MODIFIERS: [(&str, u32); 4] = [("Alt+", 1), ("Control+", 2), ("Meta+", 4), ("Shift+", 8)];

/// Returns the events of a key that is pressed and let go: a name as in `KeyboardEvent.key` or a
/// character, with `Shift+`, `Control+`, `Alt+` or `Meta+` before it.
pub(super) fn events(key: &str) -> Result<[Value; 2], BrowserError> {
    let (mut name, mut modifiers) = (key, 0);
    while let Some((rest, bit)) = MODIFIERS.iter().find_map(|(word, bit)| Some((name.strip_prefix(word)?, bit))) {
        (name, modifiers) = (rest, modifiers | bit);
    }
    let mut letters = name.chars();
    let (code, number, text) = match NAMED.iter().find(|known| known.0 == name || known.1 == name) {
        Some(&(key, code, number, text)) => {
            name = key;
            (code.to_owned(), number, text)
        }
        None => match (letters.next(), letters.next()) {
            (Some(letter), None) => (code_of(letter), u32::from(letter.to_ascii_uppercase()), name),
            _ => return Err(BrowserError::Refused(format!("no key `{key}`"))),
        },
    };
    // With these the key is a shortcut and no text.
    let text = if modifiers & 7 == 0 { text } else { "" };
    let event = |kind: &str, text: &str| {
        json!({
            "type": kind, "key": name, "code": code, "windowsVirtualKeyCode": number, "modifiers": modifiers,
            "text": text,
        })
    };
    Ok([event(if text.is_empty() { "rawKeyDown" } else { "keyDown" }, text), event("keyUp", "")])
}

fn code_of(letter: char) -> String {
    match letter {
        'a'..='z' | 'A'..='Z' => format!("Key{}", letter.to_ascii_uppercase()),
        '0'..='9' => format!("Digit{letter}"),
        '/' => "Slash".to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_what_a_keyboard_sends() {
        let [down, up] = events("Shift+Tab").expect("a key");
        assert_eq!((&down["type"], &down["key"], &down["modifiers"]), (&"rawKeyDown".into(), &"Tab".into(), &8.into()));
        assert_eq!(up["type"], "keyUp");
        let [down, _] = events("Space").expect("a key");
        assert_eq!((&down["key"], &down["text"]), (&" ".into(), &" ".into()));
        let [down, _] = events("/").expect("a key");
        assert_eq!((&down["code"], &down["text"]), (&"Slash".into(), &"/".into()));
        assert_eq!(events("Control+a").expect("a key")[0]["text"], "");
        assert!(events("Hyper").expect_err("none").to_string().contains("no key `Hyper`"));
    }
}
