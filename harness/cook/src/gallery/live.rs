//! The frames that the live pages run.
