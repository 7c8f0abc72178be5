//! The nearest known name to one that is not known.

/// `; did you mean ...?` where a name is close, else the list of all names.
pub fn suggest(unknown: &str, known: &[&str]) -> String {
    let best = known
        .iter()
        .map(|name| (strsim::jaro_winkler(unknown, name), *name))
        .max_by(|left, right| left.0.total_cmp(&right.0));
    match best {
        Some((similarity, name)) if similarity > 0.75 => format!("; did you mean `{name}`?"),
        _ => format!("; there are {}", known.join(", ")),
    }
}
