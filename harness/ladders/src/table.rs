//! Tables, made of columns; shown as text and as Markdown.

use std::fmt::Write as _;

/// A table of a report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name, by which pages mark the table's place.
    pub name: &'static str,
    title: String,
    columns: Vec<(String, Vec<String>)>,
    note: String,
}

/// A table in the making, with a line for each of `keys`.
pub struct Lines<K> {
    table: Table,
    keys: Vec<K>,
}

impl Table {
    /// Begins a table with a line for each key; `title` stands above it in text.
    pub fn of<K>(name: &'static str, title: &str, keys: impl Into<Vec<K>>) -> Lines<K> {
        Lines { table: Self { name, title: title.to_owned(), ..Self::default() }, keys: keys.into() }
    }

    /// Whether the table has columns and no line.
    pub fn is_empty(&self) -> bool {
        self.columns.first().is_some_and(|(_, cells)| cells.is_empty())
    }

    /// Returns the cells of each line, the headings first.
    fn lines(&self) -> impl Iterator<Item = Vec<&str>> {
        let count = self.columns.first().map_or(0, |(_, cells)| cells.len());
        let head = self.columns.iter().map(|(heading, _)| heading.as_str()).collect();
        let line = |row: usize| self.columns.iter().map(|(_, cells)| cells[row].as_str()).collect();
        std::iter::once(head).chain((0..count).map(line))
    }

    /// Returns the table as Markdown, with its note below.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        for (row, cells) in self.lines().enumerate().filter(|(_, cells)| !cells.is_empty()) {
            let _ = writeln!(text, "| {} |", cells.join(" | "));
            if row == 0 {
                let _ = writeln!(text, "|{}", "---|".repeat(cells.len()));
            }
        }
        if !self.note.is_empty() {
            let gap = if text.is_empty() { "" } else { "\n" };
            let _ = writeln!(text, "{gap}{}", wrapped(&self.note));
        }
        text
    }

    /// Returns the table as text: its title, columns as wide as their widest cells, and its note.
    pub fn text(&self) -> String {
        let plain = |text: &str| text.replace('`', "");
        let mut text = if self.title.is_empty() { String::new() } else { format!("{}\n", self.title) };
        let lines: Vec<Vec<String>> = self.lines().map(|cells| cells.into_iter().map(plain).collect()).collect();
        let width = |column: usize| lines.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        for cells in lines.iter().filter(|cells| !cells.is_empty()) {
            let padded = cells.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| match column {
                0 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            });
            let _ = writeln!(text, "{}", padded.collect::<Vec<_>>().join("  ").trim_end());
        }
        if !self.note.is_empty() {
            let _ = writeln!(text, "{}", wrapped(&plain(&self.note)));
        }
        text
    }
}

impl<K> Lines<K> {
    /// Adds a column.
    #[must_use]
    pub fn column(mut self, heading: impl Into<String>, cell: impl Fn(&K) -> String) -> Self {
        self.table.columns.push((heading.into(), self.keys.iter().map(cell).collect()));
        self
    }

    /// Ends the table with a note; empty for none.
    pub fn note(self, note: impl Into<String>) -> Table {
        Table { note: note.into(), ..self.table }
    }
}

/// A goal, the measured figure, and whether it is met.
pub struct Goal {
    goal: String,
    measured: String,
    verdict: &'static str,
}

impl Goal {
    /// Returns a judged goal.
    pub fn new(goal: impl Into<String>, measured: String, met: bool) -> Self {
        Self { goal: goal.into(), measured, verdict: if met { "met" } else { "missed" } }
    }

    /// Returns a table of goals.
    pub fn table(name: &'static str, goals: Vec<Self>) -> Table {
        Table::of(name, "Goals", goals)
            .column("goal", |goal| goal.goal.clone())
            .column("measured", |goal| goal.measured.clone())
            .column("", |goal| goal.verdict.to_owned())
            .note("")
    }
}

/// Columns of text after which a line is broken.
const WIDTH: usize = 100;

/// Returns the text with line breaks between words so that no line is longer than a page's.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(word.to_owned());
        } else {
            let space = if lines[last].is_empty() { "" } else { " " };
            lines[last].push_str(space);
            lines[last].push_str(word);
        }
    }
    lines.join("\n")
}

/// Shows a figure with this many decimals, or a dash for none.
pub fn figure(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
}

/// Shows a figure that spans many powers of ten.
pub fn scientific(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.1e}"))
}

/// Shows how much larger a ratio is than 1.
pub fn beyond(ratio: Option<f64>) -> String {
    ratio.map_or("-".to_owned(), |ratio| format!("{:+.1} %", 100.0 * (ratio - 1.0)))
}

/// Shows numbers of instructions.
pub fn sum(instructions: &[u32]) -> String {
    instructions.iter().map(u32::to_string).collect::<Vec<_>>().join(" + ")
}

/// Shows a number of bytes.
pub fn bytes(count: Option<u64>) -> String {
    match count.unwrap_or(0) {
        0 => "0".to_owned(),
        count @ 1..10_000 => format!("{count} B"),
        count @ 10_000..10_000_000 => format!("{:.0} KiB", count as f64 / 1024.0),
        count => format!("{:.0} MiB", count as f64 / f64::from(1 << 20)),
    }
}

/// Marks the rungs that are dominated.
pub fn marked(rung: &str, dominated: &[&str]) -> String {
    if dominated.contains(&rung) { "dominated" } else { "" }.to_owned()
}

/// Returns the mean of the values; `None` if there are none.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_text_and_markdown() {
        let table = Table::of("squares", "Squares", [3, 10])
            .column("n", |n: &i32| format!("`{n}`"))
            .column("n²", |n| (n * n).to_string())
            .note("of `n`");
        assert_eq!(table.markdown(), "| n | n² |\n|---|---|\n| `3` | 9 |\n| `10` | 100 |\n\nof `n`\n");
        assert_eq!(table.text(), "Squares\nn    n²\n3     9\n10  100\nof n\n");
        let empty = Table::of("none", "", [0; 0]).column("n", i32::to_string).note("");
        assert_eq!((empty.markdown().as_str(), empty.text().as_str()), ("| n |\n|---|\n", "n\n"));
    }

    #[test]
    fn notes_are_wrapped_between_words() {
        let text = "word ".repeat(60);
        let lines = wrapped(&text);
        assert!(lines.lines().count() == 3 && lines.lines().all(|line| line.len() <= WIDTH), "{lines}");
        assert_eq!(lines.split_whitespace().count(), 60);
    }

    #[test]
    fn figures_are_shown_with_their_units() {
        assert_eq!(
            [bytes(None), bytes(Some(9999)), bytes(Some(20_480)), bytes(Some(20 << 20))],
            ["0", "9999 B", "20 KiB", "20 MiB"]
        );
        assert_eq!(
            [figure(Some(1.25), 1), figure(None, 1), scientific(Some(1e-7)), beyond(Some(1.055))],
            ["1.2", "-", "1.0e-7", "+5.5 %"]
        );
    }
}
