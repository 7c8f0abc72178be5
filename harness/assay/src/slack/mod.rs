//! Slack: a function as any device may run it that conforms to WGSL.
//!
//! WGSL's section on floating point (15.7) leaves a device much freedom: sums and products rounded either way, quotients and functions off by so many units in the last
//! place, products fused with sums, sums and products in another order, subnormals flushed to zero, the sign of zero ignored, anything where a result is infinite or no number. A test
//! on one device sees one choice of each. Here the interpreter makes them all, by chance, by rule, or as bad as they can be found.
//!
//! - [`Device`]: a machine for the interpreter that makes the choices of one call.
//! - [`Slackened`]: a [`Runner`](crate::runner::Runner) whose rows run on a device each.
//! - [`climb`]: the worst choices for one row.
//! - [`allowance`]: how far a result may be off to first order, beside the bound that its comment states.
//! - [`examine`]: everything that is tested of a formula, so.
//!
//! What the model takes to hold beyond the standard is named: [`Assumption`](crate::interpreter::Assumption).

pub mod allowance;
pub mod climb;
mod device;
mod examination;
mod slackened;

#[cfg(test)]
mod tests;

pub use device::{Device, Direction, Habit, Mode};
pub use examination::{Found, examine};
pub use slackened::{Reassociation, Slackened};
