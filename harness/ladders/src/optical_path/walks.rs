//! The committed pictures by random walks: a rung's distance from one after the best exposure, and
//! the picture's own uncertainty.

use super::measured::Measured;
use super::views::{SIDE, settings};
use crate::error::CostError;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_reference::random_walk::mesh;
use lapidary_render as render;
use lapidary_render::RenderError;
use lapidary_scene::Scene;
use lapidary_snapshots::exposure::{best_exposure, distance, exposed_distance};
use lapidary_snapshots::frames::halved;
use lapidary_snapshots::{EXR_SIDE, WalkedReference};

/// Walks per pixel of the picture that is simulated again to estimate the spread of the walks.
const FEW: u32 = 4;

/// A scene and its committed picture by random walks.
pub(crate) struct Walks {
    name: &'static str,
    scene: Scene,
    linear: Vec<[f32; 4]>,
    /// Walks per pixel.
    count: u32,
    origin: mesh::Origin,
}

impl Walks {
    /// Returns the picture of the built-in scene with that name, in its own colours; `None` if no
    /// picture of it is committed.
    pub(crate) fn of(gpu: &Gpu, name: &'static str) -> Result<Option<Self>, CostError> {
        let Some(reference) = WalkedReference::of_scene(name) else { return Ok(None) };
        let linear = reference.picture(gpu)?.linear;
        Ok(Some(Self { name, scene: Scene::named(name)?, linear, count: reference.walks, origin: reference.origin }))
    }

    /// Returns the distance of a rung's timed picture from this one. This one has half the side, so
    /// four pixels of one sample each are averaged into one. For the reference, returns this
    /// picture's own standard error.
    pub(super) fn distance(&self, gpu: &Gpu, variant: Measured) -> Result<f64, CostError> {
        Ok(self.distances(gpu, variant)?[0])
    }

    /// Returns the distance after the best exposure, that as both are, and the best exposure. For the
    /// reference, this picture's own standard error.
    pub(crate) fn distances(&self, gpu: &Gpu, variant: Measured) -> Result<[f64; 3], CostError> {
        if variant.rung == Rung::Reference {
            let error = self.standard_error()?;
            return Ok([error, error, 1.0]);
        }
        let picture = halved(&render::render(gpu, &self.scene, &settings(self.name, variant, [SIDE; 2]))?).linear;
        let truth = &self.linear;
        Ok([exposed_distance(&picture, truth), distance(&picture, truth), best_exposure(&picture, truth)])
    }

    /// Returns the root mean square of the pixels' standard errors, divided by the root mean square
    /// of their radiance. A picture does not store errors, so a few walks are repeated to estimate
    /// their spread.
    fn standard_error(&self) -> Result<f64, CostError> {
        let few = mesh::Settings {
            width: EXR_SIDE,
            height: EXR_SIDE,
            samples_per_pixel: FEW,
            origin: self.origin,
            seed: 1,
            environment: None,
            boundary: mesh::Boundary::Matched,
        };
        let walked = mesh::render(&self.scene, &few, &|_, _| {}).map_err(RenderError::from)?;
        let square = |value: &f32| f64::from(*value).powi(2);
        let variance: f64 = walked.standard_error.iter().flatten().map(square).sum();
        // The power of the committed picture, to which its noise adds almost nothing.
        let power: f64 = self.linear.iter().flat_map(|pixel| &pixel[..3]).map(square).sum();
        Ok((variance / power * f64::from(FEW) / f64::from(self.count)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_gpu::AdapterChoice;

    #[test]
    fn a_committed_picture_is_found_by_its_scene_and_its_walks_are_surer_than_lamberts_law() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let walks = Walks::of(gpu, "skin_bunny").expect("read").expect("committed");
        let distance_of = |rung: &str| {
            let rung = rung.parse().expect(rung);
            walks.distance(gpu, Measured { rung, unscaled: false }).expect("rendered")
        };
        let [noise, lambert, shadowed, paths] =
            ["reference", "lambert", "lambert-shadowed", "godunov-32"].map(distance_of);
        println!("the walks' own {noise:.4}, Lambert {lambert:.4}, with shadows {shadowed:.4}, ways {paths:.4}");
        assert!(noise > 0.0 && noise < 0.3 * lambert && lambert < 1.0 && paths < 1.0);
        assert!(shadowed < 0.8 * lambert, "a body that is in the way of its own light: {shadowed} {lambert}");
        assert!(Walks::of(gpu, "ball").expect("read").is_none());
    }
}
