//! What accuracy costs in time: each rung of a technique's ladder is compared with its reference
//! and timed, all in one run.
//!
//! A ladder measures rows ([`Report`]); its tables are lists of columns over the rows ([`Table`]),
//! its plots are series of them ([`Plot`]).

pub mod builtins;
pub mod cdrf;
pub mod command;
pub mod effects;
pub mod error;
pub mod gem;
pub mod ladder;
mod list;
pub mod optical_path;
pub mod options;
pub mod page;
pub mod plot;
mod quality;
pub mod report;
pub mod shown;
pub mod table;
pub mod timing;
pub mod translucent;

pub use error::CostError;
pub use ladder::Ladder;
pub use list::LADDERS;
pub use options::{Options, Progress};
pub use plot::Plot;
pub use report::{Report, Row};
pub use table::Table;
pub use timing::{Timed, Timing};
