//! Sums over samples, and the pictures that they estimate.

use glam::DVec3;

/// Sums over independent samples of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    radiance: DVec3,
    squares: DVec3,
}

impl Sums {
    pub(super) fn add(&mut self, radiance: DVec3) {
        self.radiance += radiance;
        self.squares += radiance * radiance;
    }

    /// Mean of `count` samples; samples that were not added count as 0.
    pub(super) fn mean(&self, count: u32) -> DVec3 {
        self.radiance * (1.0 / f64::from(count))
    }

    /// Variance of the mean of `count` samples.
    pub(super) fn variance(&self, count: u32) -> DVec3 {
        let count = f64::from(count);
        let mean = self.radiance / count;
        // Rounding may make the difference slightly negative.
        (self.squares / count - mean * mean).max(DVec3::ZERO) / (count - 1.0)
    }
}

/// A rendered image.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Linear radiance and coverage, row by row from the top: means over a pixel, so that its
    /// uncovered part counts as black.
    pub linear: Vec<[f32; 4]>,
    /// Standard error of each pixel's red, green and blue.
    ///
    /// From the eye, it is computed as for independent samples. Since they are spread evenly over
    /// the pixel, the true error is no greater, and less where the pixel's brightness varies. From
    /// the lights, it is computed from the spread of 64 batches. Errors of walks from both ends are
    /// added as independent.
    pub standard_error: Vec<[f32; 3]>,
    /// Number of walks that met a body.
    pub walks: u64,
    /// Number of scatterings of all walks together.
    pub scatterings: u64,
    /// Number of walks that slipped through a surface by rounding and were followed no further.
    pub lost: u64,
}

/// An estimated picture, row by row.
#[derive(Debug, Default)]
pub(super) struct Estimate {
    /// Linear RGB radiance of each pixel.
    pub(super) radiance: Vec<DVec3>,
    /// Its variance.
    pub(super) variance: Vec<DVec3>,
    /// Share of each pixel that bodies cover; empty if it was not determined.
    pub(super) coverage: Vec<f32>,
    pub(super) walks: u64,
    pub(super) scatterings: u64,
    pub(super) lost: u64,
}

impl Estimate {
    /// Adds the independent estimate of another part of the light.
    pub(super) fn plus(mut self, other: Self) -> Self {
        let add = |to: &mut Vec<DVec3>, from: Vec<DVec3>| to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        add(&mut self.radiance, other.radiance);
        add(&mut self.variance, other.variance);
        if self.coverage.is_empty() {
            self.coverage = other.coverage;
        }
        self.walks += other.walks;
        self.scatterings += other.scatterings;
        self.lost += other.lost;
        self
    }

    pub(super) fn rendering(&self) -> Rendering {
        let pixel = |(radiance, coverage): (&DVec3, &f32)| {
            let [red, green, blue] = radiance.as_vec3().to_array();
            [red, green, blue, *coverage]
        };
        Rendering {
            linear: self.radiance.iter().zip(&self.coverage).map(pixel).collect(),
            standard_error: self.variance.iter().map(|variance| variance.map(f64::sqrt).as_vec3().to_array()).collect(),
            walks: self.walks,
            scatterings: self.scatterings,
            lost: self.lost,
        }
    }
}
