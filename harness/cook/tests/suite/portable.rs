//! The functions that do not hold on every device that WGSL allows: `tests/portable.txt`.

use std::collections::BTreeMap;

/// Function and reason of each line of the list.
///
/// # Panics
/// Where a line is not `function | why`.
pub fn excepted() -> BTreeMap<&'static str, &'static str> {
    let lines = include_str!("../portable.txt").lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| line.split_once(" | ").unwrap_or_else(|| panic!("portable.txt: {line}"))).collect()
}
