//! Joint properties: the table and its reading against quadrature, compensation against random walks on the facets, the
//! prefiltered environment against the integral that it stands for; and the tables of docs/split_sum.md.

mod compensation;
mod prefiltered;
mod quadrature;
mod table;
mod walk;

use glam::DVec3;

const PAGE: &str = include_str!("../../../docs/split_sum.md");

/// Returns a direction towards an eye at this cosine to +z.
fn eye(cosine: f64) -> DVec3 {
    DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, cosine)
}

/// Checks that the page holds a table.
fn on_page(table: &str) {
    assert!(PAGE.contains(table), "docs/split_sum.md should hold:\n{table}");
}
