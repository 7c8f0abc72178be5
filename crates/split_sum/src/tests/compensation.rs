//! The compensation against random walks on the facets.

use super::walk::{schlick, walk};
use super::{on_page, quadrature};
use crate::oracle::{compensation, compensation_turquin};
use glam::DVec3;

const COUNT: u32 = 400_000;

/// Where all facets reflect the same share F, only what stays is fitted: the total is right to 1.3 % of itself, with a walk's
/// own error, four standard deviations of the mean of a share, included.
#[test]
fn constant_reflectance_is_made_up_for() {
    for roughness in [0.3, 0.5, 0.7, 0.85, 1.0f64] {
        let alpha = roughness * roughness;
        for cosine in [1.0, 0.7, 0.3, 0.1] {
            let shares = [0.3, 0.5, 0.7, 0.9];
            let walked = walk(cosine, alpha, shares, |share, _| share, COUNT);
            let once = quadrature::over_light(cosine, alpha, 400, |_, _| 1.0);
            for (share, left) in shares.into_iter().zip(walked.left) {
                // The f0 whose mean by Schlick is this share.
                let f0 = (21.0 * share - 1.0) / 20.0;
                let made_up = share * once * compensation(DVec3::splat(f0), once).x;
                let error = made_up / left - 1.0;
                assert!(error.abs() < 0.0133, "alpha {alpha}, cosine {cosine}, share {share}: {error}");
            }
        }
    }
}

/// Checks the page's table: errors in percent of single scattering, Turquin's factor and this module's, for Schlick's
/// reflectance at f0 = 1/2; and this module's at f0 = 0.9.
#[test]
fn table_of_compensations_is_current() {
    let mut table = String::new();
    for roughness in [0.3, 0.5, 0.7, 0.85, 1.0f64] {
        for cosine in [1.0, 0.5, 0.1] {
            let alpha = roughness * roughness;
            let [factor, rest] = quadrature::parts(cosine, alpha);
            let walked = walk(cosine, alpha, [0.5, 0.9], schlick, COUNT);
            let error = |f0: f64, left: f64, made_up: f64| 100.0 * ((f0 * factor + rest) * made_up / left - 1.0);
            let of = |f0: f64| DVec3::splat(f0);
            let once = factor + rest;
            table += &format!(
                "| {roughness} | {cosine} | {:+.0} | {:+.0} | {:+.0} | {:+.0} |\n",
                error(0.5, walked.left[0], 1.0),
                error(0.5, walked.left[0], compensation_turquin(of(0.5), once).x),
                error(0.5, walked.left[0], compensation(of(0.5), once).x),
                error(0.9, walked.left[1], compensation(of(0.9), once).x),
            );
        }
    }
    on_page(&table);
}
