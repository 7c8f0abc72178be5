//! Tests of `cook` and of every function of the cookbook: a GPU, the compiled-in cookbook, or the real binary.

mod adapter;
mod bad_input;
mod chromium;
mod cli;
mod comparator;
mod constants;
mod formulas;
mod hard_cases;
mod inputs;
#[cfg(unix)]
mod launcher;
mod outside;
mod rewrites;
mod seams;
mod seeds;
mod slack;
mod specialise;
mod user_file;
