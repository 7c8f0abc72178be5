//! Lines of WGSL indented by the brackets that are open.

use crate::declarations::without_comment;

/// Operators with which a line may begin.
const OPERATORS: [&str; 18] =
    ["+", "-", "*", "/", "%", "&&", "||", "&", "|", "^", "<<", ">>", "==", "!=", "<=", ">=", "<", ">"];

/// Returns the lines, each indented by four for every line whose brackets are open there, and once more if a
/// statement goes on with an operator.
#[must_use]
pub fn indented(text: &str) -> String {
    let mut result = String::new();
    // Each open bracket, with the line on which it stands.
    let mut open: Vec<(usize, char)> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        let code = without_comment(line);
        let closing = code.chars().take_while(|c| ")]}".contains(*c)).count();
        let around = &open[..open.len().saturating_sub(closing)];
        let mut levels: Vec<usize> = around.iter().map(|(line, _)| *line).collect();
        levels.dedup();
        // In parentheses the line is indented already.
        let is_statement = around.last().is_none_or(|(_, bracket)| *bracket == '{');
        let goes_on =
            OPERATORS.iter().any(|operator| code.strip_prefix(operator).is_some_and(|rest| rest.starts_with(' ')));
        if !line.is_empty() {
            result.push_str(&" ".repeat(4 * (levels.len() + usize::from(goes_on && is_statement))));
            result.push_str(line);
        }
        result.push('\n');
        for bracket in code.chars() {
            match bracket {
                '(' | '[' | '{' => open.push((number, bracket)),
                ')' | ']' | '}' => {
                    open.pop();
                }
                _ => {}
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::indented;

    #[test]
    fn brackets_indent_once_a_line_and_operators_once_more() {
        let text = "\
fn f(
    a: f32,
) -> f32 {
    // First.
    if (a > 0.0f) {
        return g(vec3f(
            a,
        ));
    } else {
        let b = a
            + 1.0f;
        if (b > a
            || b < 0.0f) {
            return a;
        }
        return b;
    }
}
";
        assert_eq!(indented(text), text);
        let flat: String = text.lines().flat_map(|line| [line.trim(), "\n"]).collect();
        assert_eq!(indented(&flat), text);
    }
}
