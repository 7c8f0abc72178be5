//! Branches without continuity, each with a reason, from `tests/branches.txt`.

use std::sync::LazyLock;

/// Kind of exception in a line of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exception {
    /// No two neighbouring inputs of the domain lie on different sides of a condition.
    NotStraddled,
    /// The function itself jumps, and no discrete result says so.
    Jumps,
    /// Floats next to a line's branch are outside of the domain.
    LeavesTheDomain,
}

impl Exception {
    /// Returns the name in the list.
    pub fn name(self) -> &'static str {
        match self {
            Exception::NotStraddled => "not straddled",
            Exception::Jumps => "jumps",
            Exception::LeavesTheDomain => "leaves the domain",
        }
    }

    fn named(name: &str) -> Option<Self> {
        [Exception::NotStraddled, Exception::Jumps, Exception::LeavesTheDomain].into_iter().find(|it| it.name() == name)
    }
}

/// A line of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Line {
    /// Name of the function.
    pub function: &'static str,
    /// Kind of exception.
    pub exception: Exception,
    /// A condition, or the line of a branch, as written in the WGSL.
    pub place: &'static str,
    /// Cause of the exception.
    pub reason: &'static str,
}

/// Returns the whole list.
///
/// # Panics
/// Panics if a line is not `function | what | where | why`, which a test forbids.
pub fn all() -> &'static [Line] {
    static ALL: LazyLock<Vec<Line>> = LazyLock::new(|| {
        let text = include_str!("../../branches.txt");
        let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        lines.map(|line| read(line).unwrap_or_else(|| panic!("branches.txt: {line}"))).collect()
    });
    &ALL
}

fn read(line: &'static str) -> Option<Line> {
    let mut parts = line.splitn(4, " | ").map(str::trim);
    let (function, what, place) = (parts.next()?, parts.next()?, parts.next()?);
    let reason = parts.next().filter(|reason| !reason.is_empty())?;
    Some(Line { function, exception: Exception::named(what)?, place, reason })
}

/// Returns whether the list contains this exception.
pub fn excepts(function: &str, exception: Exception, place: &str) -> bool {
    all().iter().any(|line| (line.function, line.exception, line.place) == (function, exception, place))
}
