//! Finds the known name nearest to an unknown one.

/// Similarity above which a name is suggested.
const CLOSE: f64 = 0.75;

/// Returns the nearest of `known`, with its similarity from 0 to 1; `None` if `known` is empty.
pub fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<(f64, &'a str)> {
    let similarities = known.into_iter().map(|name| (strsim::jaro_winkler(unknown, name), name));
    similarities.max_by(|left, right| left.0.total_cmp(&right.0))
}

/// [`suggest`] for a function of a module, as `MODULE::FUNCTION`. Names in a module differ only
/// after the module's name, so that prefix is left out of the comparison.
pub fn suggest_function(module: &str, unknown: &str, known: &[&str]) -> String {
    let short =
        |name: &str| name.strip_prefix(module).and_then(|rest| rest.strip_prefix('_')).unwrap_or(name).to_owned();
    let known: Vec<String> = known.iter().map(|name| short(name)).collect();
    match close(&short(unknown), known.iter().map(String::as_str)) {
        Some(name) => format!("; did you mean `{module}::{name}`?"),
        None => format!("; there are {}", known.join(", ")),
    }
}

/// Returns [`nearest`] if it is close enough to be suggested.
pub fn close<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    nearest(unknown, known).filter(|(similarity, _)| *similarity > CLOSE).map(|(_, name)| name)
}

/// Returns `; did you mean ...?` if a name is close, or else the list of all names.
pub fn suggest(unknown: &str, known: &[&str]) -> String {
    match close(unknown, known.iter().copied()) {
        Some(name) => format!("; did you mean `{name}`?"),
        None => format!("; there are {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_compared_without_their_modules_name() {
        let known = ["fresnel_dielectric", "fresnel_schlick"];
        for unknown in ["dieletric", "fresnel_dieletric", "dielectrik"] {
            assert_eq!(
                suggest_function("fresnel", unknown, &known),
                "; did you mean `fresnel::dielectric`?",
                "{unknown}"
            );
        }
        assert_eq!(suggest_function("fresnel", "zzz", &known), "; there are dielectric, schlick");
    }
}
