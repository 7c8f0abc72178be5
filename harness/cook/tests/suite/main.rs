//! Tests of `cook` and of every function of the cookbook: a GPU, the compiled-in cookbook, or the real binary.

mod adapter;
mod bad_input;
mod chromium;
mod cli;
mod comparator;
mod constants;
mod copying;
mod formulas;
mod hard_cases;
mod inputs;
#[cfg(unix)]
mod launcher;
mod outside;
mod own_files;
mod pictures;
mod rewrites;
mod seams;
mod seeds;
mod slack;
mod specialise;
mod user_file;

use serde_json::Value;

/// Returns the rows that a command printed.
fn json(text: &str) -> Vec<Value> {
    match serde_json::from_str(text) {
        Ok(Value::Array(rows)) => rows,
        other => panic!("no JSON array: {other:?}\n{text}"),
    }
}
