//! Mirror against oracle.
