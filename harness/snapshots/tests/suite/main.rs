//! Tests of pictures against the committed ones and against random walks.

mod cdrf_shading;
mod snapshots;
mod walked_references;
