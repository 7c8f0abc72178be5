//! Joint properties.
