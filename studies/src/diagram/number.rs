//! Numbers of a drawing, and how they are written.

use serde::{Serialize, Serializer};

/// A number of the drawing, written with two decimals at most, so that the last bits of a sine leave no trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let text = format!("{:.2}", self.0);
        let short = text.trim_end_matches('0').trim_end_matches('.');
        serializer.serialize_str(if short == "-0" { "0" } else { short })
    }
}
