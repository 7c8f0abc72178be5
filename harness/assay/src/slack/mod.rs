//! Slack: a function as any device that conforms to WGSL may run it.
//!
//! WGSL's section on floating point (15.7) leaves a device much freedom. It may round sums and
//! products either way, let quotients and functions err by a number of units in the last place,
//! fuse products with sums, reorder sums and products, flush subnormals to zero, ignore the sign of
//! zero, and return any value if a result is infinite or NaN. A test on one device sees one choice
//! of each. Here the interpreter makes all of them: at random, by rule, or as bad as a search can
//! find.
//!
//! - [`Device`]: a machine for the interpreter that makes the choices of one call.
//! - [`Slackened`]: a [`Runner`](crate::runner::Runner) that runs each row on its own device.
//! - [`climb`]: the worst choices for one row.
//! - [`allowance`]: the error of a result to first order, compared with the bound in the function's
//!   comment.
//! - [`examine`]: all tests of a formula on such devices.
//!
//! [`Assumption`](crate::interpreter::Assumption) names what the model assumes beyond the standard.

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
