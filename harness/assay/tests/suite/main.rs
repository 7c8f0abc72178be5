//! Tests of the library on a device.

mod dispatch;
