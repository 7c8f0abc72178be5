//! Studies: what was measured once and decided, with its record and the page that rests on it.
//!
//! A study measures rows of a report as a ladder does ([`Report`](lapidary_ladders::Report)), and shows them in tables and
//! plots. Those of `gem` and `cdrf` share the report of the ladder that they are about. [`diagram`] draws the techniques'
//! diagrams.

mod among;
pub mod cdrf;
pub mod command;
pub mod diagram;
pub mod dynamic;
pub mod gem;
pub mod list;
pub mod outside;
pub mod restraint;
pub mod sphere;
