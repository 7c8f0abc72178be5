//! Branches that continuity does not hold for, each with a reason: `tests/branches.txt`.

use std::sync::LazyLock;

/// What a line of the list excepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exception {
    /// No two neighbouring inputs of the domain lie on both sides of a condition.
    NotStraddled,
    /// The mathematics itself jumps, where no discrete result says so.
    Jumps,
    /// Floats beside a line's branch are outside of the domain.
    LeavesTheDomain,
}

impl Exception {
    /// As the list has it.
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
    /// Of which function.
    pub function: &'static str,
    /// What.
    pub exception: Exception,
    /// Where: a condition, or the line that a branch is on, as the WGSL has it.
    pub place: &'static str,
    /// Why.
    pub reason: &'static str,
}

/// The whole list.
///
/// # Panics
/// Where a line is not `function | what | where | why`, which a test forbids.
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

/// Whether the list excepts this.
pub fn excepts(function: &str, exception: Exception, place: &str) -> bool {
    all().iter().any(|line| (line.function, line.exception, line.place) == (function, exception, place))
}
