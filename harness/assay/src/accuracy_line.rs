//! The `Accuracy:` line of a function: the tolerance that its tests apply. [`Accuracy::parse`]
//! gives the grammar.

use crate::shape::Shape;
use std::fmt;

/// The accuracy that a function promises.
#[derive(Clone, Debug, PartialEq)]
pub enum Accuracy {
    /// A form kept for comparison; promises nothing.
    Naive,
    /// Bounds on lavapipe and on any conforming WebGPU implementation.
    Bounded {
        /// Bounds on the reference device.
        lavapipe: Vec<FieldBound>,
        /// Bounds from WGSL's own guarantees.
        portable: Vec<FieldBound>,
        /// Whether the portable bounds require sums and products in the written order. WGSL lets a
        /// compiler reorder them.
        order_kept: bool,
    },
}

/// The bound on one field of the result.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldBound {
    /// Name of the struct's field; `None` if the result is a scalar, a vector or a matrix.
    pub field: Option<String>,
    /// Allowed error of the field.
    pub bound: Bound,
}

/// The allowed error of a field, a sum of terms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// Error in units in the last place of the exact value's largest component.
    pub ulp: f64,
    /// Absolute error.
    pub absolute: f64,
    /// Error relative to the exact value's largest component.
    pub relative: f64,
    /// Backward error: the result is exact for an input that is off by up to this many ulp in each
    /// component.
    pub backward: f64,
}

impl Accuracy {
    /// Parses the text after `Accuracy:`, either `naive` or `lavapipe BOUNDS; portable BOUNDS`.
    /// BOUNDS is a comma-separated list of one bound for each field of the result. A bound is
    /// `[field] NUMBER UNIT {+ NUMBER UNIT}`, with the units `ulp`, `abs`, `rel` and `backward`. A
    /// final `; order kept` states that the portable bounds require sums and products in the
    /// written order.
    pub fn parse(text: &str) -> Result<Accuracy, String> {
        let text = text.trim();
        if text == "naive" {
            return Ok(Self::Naive);
        }
        let expected = || "expected `naive` or `lavapipe BOUNDS; portable BOUNDS`".to_owned();
        let (bounds, order_kept) = match text.strip_suffix("; order kept") {
            Some(bounds) => (bounds, true),
            None => (text, false),
        };
        let (lavapipe, portable) = bounds.split_once(';').ok_or_else(expected)?;
        let lavapipe = lavapipe.trim().strip_prefix("lavapipe ").ok_or_else(expected)?;
        let portable = portable.trim().strip_prefix("portable ").ok_or_else(expected)?;
        Ok(Self::Bounded { lavapipe: parse_bounds(lavapipe)?, portable: parse_bounds(portable)?, order_kept })
    }

    /// Reads the comment above `fn name` in a WGSL `source`, from its `Accuracy:` to the comment's
    /// end.
    ///
    /// # Errors
    /// Returns an error if the function or the line is missing, or if the line is malformed.
    pub fn of_function(source: &str, name: &str) -> Result<Accuracy, String> {
        let lines: Vec<&str> = source.lines().collect();
        let is_function = |line: &&str| {
            let named = line.strip_prefix("fn ").and_then(|rest| rest.split('(').next());
            named.is_some_and(|found| found.trim() == name)
        };
        let place =
            lines.iter().position(is_function).ok_or_else(|| format!("{name}: the source has no such function"))?;
        let start = lines[..place].iter().rposition(|line| !line.starts_with("//")).map_or(0, |line| line + 1);
        let comment: Vec<&str> = lines[start..place].iter().map(|line| line.trim_start_matches('/').trim()).collect();
        let comment = comment.join(" ");
        let (_, accuracy) = comment
            .split_once("Accuracy:")
            .ok_or_else(|| format!("{name}: its comment has no line `Accuracy: lavapipe BOUNDS; portable BOUNDS`"))?;
        Self::parse(accuracy).map_err(|fault| format!("{name}: Accuracy: {fault}"))
    }

    /// Returns the bounds for a device, or `None` for a naive form.
    pub fn bounds(&self, lavapipe: bool) -> Option<&[FieldBound]> {
        match self {
            Self::Naive => None,
            Self::Bounded { lavapipe: bounds, .. } if lavapipe => Some(bounds),
            Self::Bounded { portable, .. } => Some(portable),
        }
    }

    /// Checks that the named fields are those of `result`, each once.
    pub fn check_fields(&self, result: &Shape) -> Result<(), String> {
        let Self::Bounded { lavapipe, portable, .. } = self else { return Ok(()) };
        check_fields(lavapipe, result).and_then(|()| check_fields(portable, result))
    }
}

/// Checks that the bounds cover the fields of `result`, each once.
pub fn check_fields(bounds: &[FieldBound], result: &Shape) -> Result<(), String> {
    let fields: Vec<Option<&str>> = match result {
        Shape::Struct(_, fields) => fields.iter().map(|(name, _)| Some(name.as_str())).collect(),
        _ => vec![None],
    };
    let named: Vec<Option<&str>> = bounds.iter().map(|bound| bound.field.as_deref()).collect();
    if named != fields {
        let spell = |names: &[Option<&str>]| {
            names.iter().map(|name| name.unwrap_or("(no field name)")).collect::<Vec<_>>().join(", ")
        };
        return Err(format!("bounds are for {}, the result has {}", spell(&named), spell(&fields)));
    }
    // All fields share one box of inputs.
    let mut backward = bounds.iter().map(|bound| bound.bound.backward).filter(|backward| *backward > 0.0);
    if let Some(first) = backward.next()
        && backward.any(|other| other != first)
    {
        return Err("fields that allow backward error must allow the same".to_owned());
    }
    Ok(())
}

/// Parses bounds for the fields of a result, such as `direction 12 ulp + 8 backward, total 8
/// backward`.
pub fn parse_bounds(text: &str) -> Result<Vec<FieldBound>, String> {
    text.split(',').map(|bound| parse_bound(bound.trim())).collect()
}

fn parse_bound(text: &str) -> Result<FieldBound, String> {
    let (field, terms) = match text.split_once(' ') {
        Some((first, rest)) if first.parse::<f64>().is_err() => (Some(first.to_owned()), rest),
        _ => (None, text),
    };
    let mut bound = Bound::default();
    for term in terms.split('+') {
        let (number, unit) = term
            .trim()
            .split_once(' ')
            .ok_or_else(|| format!("`{term}`: expected a number and ulp, abs, rel or backward"))?;
        let number: f64 = number.parse().map_err(|_| format!("`{number}` is not a number"))?;
        if !(number.is_finite() && number >= 0.0) {
            return Err(format!("`{number}` is no bound"));
        }
        let slot = match unit.trim() {
            "ulp" => &mut bound.ulp,
            "abs" => &mut bound.absolute,
            "rel" => &mut bound.relative,
            "backward" => &mut bound.backward,
            other => return Err(format!("`{other}` is not ulp, abs, rel or backward")),
        };
        *slot += number;
    }
    Ok(FieldBound { field, bound })
}

/// Formats the accuracy in the line's own grammar.
impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Bounded { lavapipe, portable, order_kept } = self else { return f.write_str("naive") };
        let spell = |bounds: &[FieldBound]| bounds.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        write!(f, "lavapipe {}; portable {}", spell(lavapipe), spell(portable))?;
        if *order_kept { f.write_str("; order kept") } else { Ok(()) }
    }
}

/// Formats the bound in the line's own grammar.
impl fmt::Display for FieldBound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(field) = &self.field {
            write!(f, "{field} ")?;
        }
        let Bound { ulp, absolute, relative, backward } = self.bound;
        let terms = [(ulp, "ulp"), (absolute, "abs"), (relative, "rel"), (backward, "backward")];
        let mut terms: Vec<String> = terms
            .iter()
            .filter(|(number, _)| *number != 0.0)
            // Tiny numbers get an exponent, to stay readable.
            .map(
                |(number, unit)| if *number < 1e-9 { format!("{number:e} {unit}") } else { format!("{number} {unit}") },
            )
            .collect();
        if terms.is_empty() {
            terms.push("0 ulp".to_owned());
        }
        f.write_str(&terms.join(" + "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_reads_back_as_it_was_written() {
        for line in [
            "naive",
            "lavapipe 0.5 ulp; portable 2.5 ulp",
            "lavapipe 0.5 ulp; portable 2.5 ulp; order kept",
            "lavapipe direction 5 ulp + 3 backward, total 3 backward; portable direction 9 ulp, total 0 ulp",
            "lavapipe 0.000001 abs; portable 0.001 rel",
        ] {
            assert_eq!(Accuracy::parse(line).expect(line).to_string(), line);
        }
    }

    #[test]
    fn a_functions_line_is_read_from_its_comment() {
        let source = "/// Half.\n/// Accuracy: lavapipe 0 ulp;\n/// portable 1 ulp\nfn half(x: f32) -> f32 { return 0.5f * x; }\n\nfn bare() {}\n";
        let stated = Accuracy::of_function(source, "half").expect("a line");
        assert_eq!(stated.to_string(), "lavapipe 0 ulp; portable 1 ulp");
        for (name, said) in [("bare", "no line `Accuracy:"), ("missing", "no such function")] {
            let fault = Accuracy::of_function(source, name).expect_err(name);
            assert!(fault.starts_with(name) && fault.contains(said), "{fault}");
        }
    }

    #[test]
    fn a_broken_line_is_refused() {
        for line in [
            "",
            "exact",
            "lavapipe 3 ulp",
            "lavapipe 3 ulp; order kept",
            "portable 3 ulp; lavapipe 3 ulp",
            "lavapipe 3; portable 3 ulp",
            "lavapipe 3 cm; portable 3 ulp",
            "lavapipe inf ulp; portable 1 ulp",
            "lavapipe -1 ulp; portable 1 ulp",
        ] {
            assert!(Accuracy::parse(line).is_err(), "{line}");
        }
    }
}
