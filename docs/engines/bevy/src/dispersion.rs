//! KHR_materials_dispersion, which Bevy's glTF loader passes over.

use bevy::asset::LoadContext;
use bevy::gltf::extensions::{ErasedGltfExtensionHandler, GltfExtensionHandler, GltfExtensionHandlers};
use bevy::gltf::gltf;
use bevy::prelude::*;
use lapidary_dispersion::{channels, oracle};
use serde_json::Value;

/// A clear material's refractive indices for red, green and blue; on every body of a glTF file.
#[derive(Component, Reflect, Clone)]
#[reflect(Component)]
pub struct ChannelIndices(pub Vec3);

pub struct DispersionPlugin;

impl Plugin for DispersionPlugin {
    fn build(&self, app: &mut App) {
        let handlers = &app.world().resource::<GltfExtensionHandlers>().0;
        handlers.write_blocking().push(Box::new(Dispersion));
    }
}

#[derive(Clone)]
struct Dispersion;

impl GltfExtensionHandler for Dispersion {
    fn dyn_clone(&self) -> Box<dyn ErasedGltfExtensionHandler> {
        Box::new(self.clone())
    }

    fn on_spawn_mesh_and_material(
        &mut self,
        _: &mut LoadContext<'_>,
        _: &gltf::Primitive<'_>,
        _: &gltf::Mesh<'_>,
        material: &gltf::Material<'_>,
        entity: &mut EntityWorldMut<'_>,
        _: &str,
    ) {
        entity.insert(ChannelIndices(channel_indices(material)));
    }
}

fn channel_indices(material: &gltf::Material<'_>) -> Vec3 {
    // A mineral's measured curve says more than two numbers. The cookbook's own files name it.
    let extras: Option<Value> = material.extras().as_ref().and_then(|extras| serde_json::from_str(extras.get()).ok());
    let mineral = extras.as_ref().and_then(|extras| extras.get("lapidary")?.get("sellmeier")?.as_str());
    let measured = match mineral {
        Some("diamond") => oracle::DISPERSION_DIAMOND,
        Some("corundum") => oracle::DISPERSION_CORUNDUM,
        Some("quartz") => oracle::DISPERSION_QUARTZ,
        Some("crown_glass") => oracle::DISPERSION_CROWN_GLASS,
        Some("cubic_zirconia") => oracle::DISPERSION_CUBIC_ZIRCONIA,
        _ => {
            let dispersion = material.extension_value("KHR_materials_dispersion");
            let dispersion = dispersion.and_then(|values| values.get("dispersion")?.as_f64()).unwrap_or(0.0);
            return channels::of_abbe(material.ior().unwrap_or(1.5), dispersion as f32);
        }
    };
    channels::of_sellmeier(measured)
}
