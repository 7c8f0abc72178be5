//! Values that an option takes by name.

use lapidary_files::nearest::suggest;

/// Returns the value of this name, or a message that says what there is; `what` is what the values are.
pub fn named<T: Copy>(
    what: &str,
    text: &str,
    all: impl IntoIterator<Item = T>,
    name: impl Fn(T) -> &'static str,
) -> Result<T, String> {
    let all: Vec<T> = all.into_iter().collect();
    let names: Vec<&str> = all.iter().map(|value| name(*value)).collect();
    let found = all.iter().find(|value| name(**value) == text).copied();
    found.ok_or_else(|| format!("no such {what}{}", suggest(text, &names)))
}
