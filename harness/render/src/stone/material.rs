//! A clear stone's material, as the gem recipes take it.

use super::restraint;
use crate::frame::record::Record;
use crate::settings::Settings;
use glam::Vec3;
use lapidary_plan::Rung;
use lapidary_scene::Material;

/// `GemMaterial` of the recipe.
pub(crate) struct GemMaterial {
    pub(crate) base_color: Vec3,
    pub(crate) index: f32,
    pub(crate) absorption: Vec3,
    pub(crate) distance_limit: f32,
    pub(crate) channel_indices: Vec3,
    pub(crate) dispersion_strength: f32,
    pub(crate) throughput_limit: f32,
}

impl GemMaterial {
    pub(crate) fn of(material: &Material, rung: Rung, settings: &Settings) -> Self {
        Self {
            base_color: material.base_color,
            index: material.ior,
            absorption: lapidary_absorption::coefficient(material.attenuation_color, material.attenuation_distance),
            // No ray travels as far as this.
            distance_limit: settings.gem.distance_limit.unwrap_or(f32::MAX),
            channel_indices: material.channel_indices(),
            dispersion_strength: settings.gem.dispersion_strength,
            throughput_limit: restraint::throughput_limit(material, rung, settings),
        }
    }

    pub(super) fn record(&self) -> Record {
        let record = Record::new("GemMaterial").with("base_color", self.base_color).with("index", self.index);
        let record = record.with("absorption", self.absorption).with("distance_limit", self.distance_limit);
        let record = record.with("channel_indices", self.channel_indices);
        let record = record.with("dispersion_strength", self.dispersion_strength);
        record.with("throughput_limit", self.throughput_limit)
    }
}
