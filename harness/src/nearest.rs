//! The nearest known name to one that is not known.

/// The nearest of `known`, with its similarity from 0 to 1; none where nothing is known.
pub fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<(f64, &'a str)> {
    let similarities = known.into_iter().map(|name| (strsim::jaro_winkler(unknown, name), name));
    similarities.max_by(|left, right| left.0.total_cmp(&right.0))
}

/// `; did you mean ...?` where a name is close, else the list of all names.
pub fn suggest(unknown: &str, known: &[&str]) -> String {
    match nearest(unknown, known.iter().copied()) {
        Some((similarity, name)) if similarity > 0.75 => format!("; did you mean `{name}`?"),
        _ => format!("; there are {}", known.join(", ")),
    }
}
