//! Plain text as HTML.

/// Escapes plain text for HTML elements and attributes alike.
pub fn escape(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            '\'' => html.push_str("&#39;"),
            other => html.push(other),
        }
    }
    html
}

/// Converts plain text in which only `` `code` `` is markup, as in WGSL comments: their `*`, `_`
/// and `$` are mathematics.
pub fn prose(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    let mut html = String::new();
    for (index, part) in parts.iter().enumerate() {
        let closed = index + 1 < parts.len();
        match (index % 2 == 1, closed) {
            (true, true) => html.push_str(&format!("<code>{}</code>", escape(part))),
            (true, false) => html.push_str(&escape(&format!("`{part}"))),
            (false, _) => html.push_str(&escape(part)),
        }
    }
    html
}

/// Converts text to a part of an anchor's name: lower-case letters, digits and single hyphens.
pub fn slug(text: &str) -> String {
    let words: Vec<String> =
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_lowercase).collect();
    words.join("-")
}

/// Wraps HTML in its opening and closing tags; returns an empty string if there is nothing to wrap.
pub fn framed(opening: &str, html: &str, closing: &str) -> String {
    if html.is_empty() { String::new() } else { format!("{opening}{html}{closing}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_becomes_markup() {
        assert_eq!(escape("<a href=\"x\">'&amp;'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&#39;&lt;/a&gt;");
    }

    #[test]
    fn only_closed_code_is_markup_in_prose() {
        assert_eq!(prose("a * b_c * d, `x<y>` and `open"), "a * b_c * d, <code>x&lt;y&gt;</code> and `open");
    }

    #[test]
    fn anchors_hold_letters_digits_and_hyphens() {
        assert_eq!(slug("  Hard cases: n → 1 "), "hard-cases-n-1");
    }
}
