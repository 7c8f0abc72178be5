//! The wavelengths for which separate rays are followed through a stone.

use crate::frame::record::Record;
use glam::{DMat3, Mat3};
use lapidary_plan::Spectrum;
use lapidary_scene::{Material, spectrum};

/// `GemWavelength` of the recipe.
pub(crate) struct GemWavelength {
    pub(crate) weights: Mat3,
    pub(crate) index: f32,
}

impl GemWavelength {
    pub(super) fn record(&self) -> Record {
        Record::new("GemWavelength").with("weights", self.weights).with("index", self.index)
    }
}

/// Returns the wavelengths for which separate rays are followed.
pub(crate) fn wavelengths(material: &Material, spectrum: Spectrum) -> Vec<GemWavelength> {
    let entry = |weights: DMat3, index: f32| GemWavelength { weights: weights.as_mat3(), index };
    match spectrum {
        // Without separate wavelengths, one entry fills the binding.
        Spectrum::One | Spectrum::Paper | Spectrum::Tracker | Spectrum::Split => {
            vec![entry(DMat3::IDENTITY, material.ior)]
        }
        Spectrum::Separate(3) => {
            let channels = [glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z].map(DMat3::from_diagonal);
            channels.into_iter().zip(material.channel_indices().to_array()).map(|(w, n)| entry(w, n)).collect()
        }
        Spectrum::Separate(count) => spectrum::weights(count as usize)
            .iter()
            .map(|wavelength| entry(wavelength.weights, material.index_at(wavelength.nanometres) as f32))
            .collect(),
    }
}

/// Returns `SceneWavelength` of the recipe for each wavelength, and every body's index of refraction at each, wavelength by
/// wavelength.
pub(super) fn of_bodies(materials: &[Material], spectrum: Spectrum) -> (Vec<Record>, Vec<f32>) {
    let tables: Vec<Vec<GemWavelength>> = materials.iter().map(|material| wavelengths(material, spectrum)).collect();
    let first = tables.first().map_or(&[][..], Vec::as_slice);
    let weights = first.iter().map(|entry| Record::new("SceneWavelength").with("weights", entry.weights)).collect();
    let indices = (0..first.len()).flat_map(|place| tables.iter().map(move |table| table[place].index)).collect();
    (weights, indices)
}
