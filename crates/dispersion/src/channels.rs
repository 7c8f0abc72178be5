//! The refractive indices of the three colour channels, which the gem recipes read as
//! `channel_indices`, from what is known of a material.
//!
//! They are computed in f64, so that each is right to its last place.
//!
//! ```
//! use lapidary_dispersion::{channels, oracle};
//!
//! // Diamond, by its Sellmeier equation and by glTF's KHR_materials_dispersion (20 / V_d).
//! let exact = channels::of_sellmeier(oracle::DISPERSION_DIAMOND);
//! let by_abbe = channels::of_abbe(2.41749, 20.0 / 55.3);
//! assert!((exact - by_abbe).abs().max_element() < 1e-3);
//! ```

use crate::oracle::{self, DispersionSellmeier};
use crate::{DISPERSION_BLUE, DISPERSION_GREEN, DISPERSION_RED};
use glam::Vec3;

/// Returns the indices at [`DISPERSION_RED`], [`DISPERSION_GREEN`] and [`DISPERSION_BLUE`], given the
/// index at any wavelength in nm.
pub fn of(index_at: impl Fn(f64) -> f64) -> Vec3 {
    Vec3::from([DISPERSION_RED, DISPERSION_GREEN, DISPERSION_BLUE].map(|wavelength| index_at(wavelength.into()) as f32))
}

/// Returns the indices of a material with this Sellmeier equation.
pub fn of_sellmeier(material: DispersionSellmeier) -> Vec3 {
    of(|wavelength| oracle::sellmeier(material, wavelength))
}

/// Returns the indices of a material as glTF has it: `index` at the d line by KHR_materials_ior, and
/// `dispersion`, 20 / V_d, by KHR_materials_dispersion. Without dispersion, all three are `index`.
pub fn of_abbe(index: f32, dispersion: f32) -> Vec3 {
    if dispersion == 0.0 {
        return Vec3::splat(index);
    }
    of(|wavelength| oracle::abbe(index.into(), dispersion.into(), wavelength))
}
