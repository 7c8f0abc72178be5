//! The lights' maps of the bodies through which light is followed: what they show, and who reads them.

use super::voxelization::MOST_TRIANGLES;
use crate::error::RenderError;
use crate::frame::{Bound, Buffer, Builder};
use crate::light::lighting::Lighting;
use crate::objects::part::{Drawn, Part};
use crate::shadow::casters::{Caster, casters_on};
use crate::shadow::light_views;
use crate::shadow::reflective_shadow_map::{self, ReflectiveShadowMaps};
use glam::Vec3;
use lapidary_plan::casting::{self, Casting};
use lapidary_plan::{Effect, Rung};
use lapidary_scene::{Bounds, Light, Object};

/// Texels along a side of a map for each voxel along an edge of a grid that encloses all bodies:
/// the sphere around a body is up to 1.7 grids wide.
const TEXELS_PER_VOXEL: u32 = 4;
/// Upper limit on a map's side in texels: smaller bodies get larger maps, so that none of their
/// voxels is missed, up to this side.
const MOST_TEXELS: u32 = 2048;

/// Data of the lights that passes over the maps' texels look up.
#[derive(Clone, Copy)]
pub(crate) struct Lit {
    pub(crate) lights: Buffer,
    pub(crate) views: Buffer,
    /// The texture with all layers.
    pub(crate) maps: Bound,
    /// Width, height and number of layers.
    pub(crate) size: [u32; 3],
}

/// The maps of a part's bodies.
pub(crate) struct LightMaps {
    pub(crate) maps: ReflectiveShadowMaps,
    pub(crate) lit: Lit,
    /// Largest irradiance from any single light, for each channel.
    pub(crate) largest: Vec3,
}

impl LightMaps {
    /// Creates the maps for the bodies of a part, whose grids have `cells` along each edge. Refuses
    /// bodies through which no light can be followed.
    pub(crate) fn of(
        builder: &mut Builder<'_>,
        lighting: &Lighting<'_>,
        part: &Part<'_>,
        cells: u32,
    ) -> Result<Self, RenderError> {
        for drawn in &part.objects {
            check(drawn.object, part.rung)?;
        }
        let bounds = part.bounds();
        let casters = casters(lighting, part);
        let before = casters.iter().map(|(_, body)| casting::bounds(body)).reduce(Bounds::joined);
        // A scene without lights gets a sun of zero irradiance.
        let dark = [Light::Directional { toward: Vec3::Y, irradiance: Vec3::ZERO }];
        let lights = if part.lights.is_empty() { &dark[..] } else { part.lights };
        let views = light_views::views(lights, bounds, before);
        let largest = light_views::largest_irradiance(lights, bounds);
        // Without lights, one texel is enough to say so.
        let side = if part.lights.is_empty() { 1 } else { map_side(part, cells) };
        let side = side.min(builder.limits().max_texture_dimension_2d);
        let mut maps = ReflectiveShadowMaps::new(builder, &views, side, &format!("of {}", part.rung))?;
        for (name, body) in casters {
            let shape = lighting.shapes.of(builder, &name, body)?;
            maps.add_caster(builder, &name, &shape)?;
        }
        let views = reflective_shadow_map::view_buffer(builder, &views);
        let lit = Lit { views, maps: maps.layers(), size: maps.size(), lights: lighting.lights(builder) };
        Ok(Self { maps, lit, largest })
    }
}

/// Returns the other bodies that may keep light from those of a part that receive shadows.
fn casters<'a>(lighting: &Lighting<'a>, part: &Part<'_>) -> Vec<Caster<'a>> {
    let is_lit = |drawn: &&Drawn<'_>| drawn.decisions.has(Effect::Shadow);
    let lit: Vec<_> =
        part.objects.iter().filter(is_lit).map(|drawn| (drawn.object, casting::bounds(drawn.object))).collect();
    let is_own = |other: &Object| part.objects.iter().any(|drawn| std::ptr::eq(drawn.object, other));
    let mut casters = casters_on(lighting, &lit, Casting::Opaque);
    casters.retain(|(_, other)| !is_own(other));
    casters
}

/// Rejects a body through which no light can be followed.
fn check(object: &Object, rung: Rung) -> Result<(), RenderError> {
    let Object { name, material, mesh, .. } = object;
    if material.medium.is_none() {
        return Err(RenderError::NoMedium { object: name.clone(), material: material.name.clone(), rung });
    }
    if mesh.triangle_count() > MOST_TRIANGLES as usize {
        let [bytes, limit] = [mesh.triangle_count() as u64, MOST_TRIANGLES.into()].map(|count| 12 * count);
        return Err(RenderError::TooLarge { what: format!("mesh `{name}`"), bytes, limit });
    }
    Ok(())
}

/// Returns the side in texels of the lights' maps, which show all bodies: large enough that the
/// smallest body's voxels are seen.
fn map_side(part: &Part<'_>, cells: u32) -> u32 {
    let widest = 2.0 / 3f32.sqrt() * part.bounds().radius();
    let extent = |drawn: &Drawn<'_>| {
        let bounds = Bounds::of(drawn.object.mesh.positions.iter().copied());
        (bounds.max - bounds.min).max_element()
    };
    let extents = part.objects.iter().map(extent);
    let least = extents.filter(|extent| *extent > 0.0).fold(widest, f32::min);
    let side = TEXELS_PER_VOXEL * cells;
    if least < widest { (side as f32 * (widest / least)).min(MOST_TEXELS.max(side) as f32) as u32 } else { side }
}
