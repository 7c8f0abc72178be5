//! `Gem`, a material for cut stones, and the system that gives it to the clear bodies of a glTF file.

use crate::dispersion::{ChannelIndices, DispersionPlugin};
use bevy::mesh::{Indices, MeshVertexAttribute, MeshVertexBufferLayoutRef, VertexAttributeValues};
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, Face, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError, VertexFormat,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use bevy::world_serialization::WorldInstanceReady;
use lapidary_convex_trace::Facets;
use lapidary_convex_walk::{CONVEX_WALK_FACE, FacetMap};

/// The facet that a vertex belongs to. Any large number will do as its id.
const FACE: MeshVertexAttribute = MeshVertexAttribute::new("Face", 0x6c61_7069_6461, VertexFormat::Uint32);

const STAGES: &str = "gem_material.wgsl";
const RECIPE: &str = "gem_walk.wgsl";

/// A clear, convex stone. Its bindings are those in the first comment of assets/gem_walk.wgsl.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub struct Gem {
    #[storage(0, read_only)]
    material: Handle<ShaderBuffer>,
    #[storage(1, read_only)]
    planes: Handle<ShaderBuffer>,
    #[storage(2, read_only)]
    facet_map: Handle<ShaderBuffer>,
    #[storage(3, read_only)]
    stone: Handle<ShaderBuffer>,
}

/// `GemMaterial` of the recipe: the names and the order of its fields.
#[derive(ShaderType)]
struct GemMaterial {
    base_color: Vec3,
    index: f32,
    absorption: Vec3,
    distance_limit: f32,
    channel_indices: Vec3,
    dispersion_strength: f32,
    throughput_limit: f32,
}

/// `GemStone` of the recipe.
#[derive(ShaderType)]
struct GemStone {
    centre: Vec3,
    side: u32,
    lower: Vec3,
    upper: Vec3,
}

impl Material for Gem {
    fn vertex_shader() -> ShaderRef {
        STAGES.into()
    }

    fn fragment_shader() -> ShaderRef {
        STAGES.into()
    }

    // Bevy's own prepass and shadows would want the attributes of its own vertex stage; and a clear
    // stone's shadow is not that of an opaque body.
    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let attributes = [Mesh::ATTRIBUTE_POSITION.at_shader_location(0), FACE.at_shader_location(1)];
        descriptor.vertex.buffers = vec![layout.0.get_layout(&attributes)?];
        // A ray that enters by a back face would start outside the stone.
        descriptor.primitive.cull_mode = Some(Face::Back);
        Ok(())
    }
}

/// Gives [`Gem`] to the clear bodies of every glTF file that is spawned.
pub struct GemPlugin;

impl Plugin for GemPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((MaterialPlugin::<Gem>::default(), DispersionPlugin)).add_observer(polish);
        // The stages import it by name, which loads nothing.
        let recipe = app.world().resource::<AssetServer>().load(RECIPE);
        app.insert_resource(Recipe { _shader: recipe });
    }
}

/// Keeps the recipe loaded.
#[derive(Resource)]
struct Recipe {
    _shader: Handle<Shader>,
}

/// A body's mesh and material as glTF has them.
type Body = (&'static Mesh3d, &'static MeshMaterial3d<StandardMaterial>, &'static ChannelIndices);

fn polish(
    ready: On<WorldInstanceReady>,
    children: Query<&Children>,
    bodies: Query<Body>,
    standard: Res<Assets<StandardMaterial>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut gems: ResMut<Assets<Gem>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut commands: Commands,
) {
    let mut cut = HashMap::new();
    for entity in children.iter_descendants(ready.entity) {
        let Ok((mesh, material, indices)) = bodies.get(entity) else { continue };
        let Some(clear) = standard.get(&material.0).filter(|material| material.specular_transmission > 0.0) else {
            continue;
        };
        // Bodies of one mesh and one material are one gem, whatever their transforms.
        let gem = cut.entry((mesh.0.id(), material.0.id())).or_insert_with(|| {
            let Some(rough) = meshes.get(&mesh.0) else { return Err("its mesh is not loaded".to_owned()) };
            let (faceted, gem) = facet(rough, clear, indices.0, &mut buffers)?;
            Ok((Mesh3d(meshes.add(faceted)), MeshMaterial3d(gems.add(gem))))
        });
        match gem {
            Ok((mesh, gem)) => {
                commands
                    .entity(entity)
                    .remove::<MeshMaterial3d<StandardMaterial>>()
                    .insert((mesh.clone(), gem.clone()));
            }
            Err(reason) => error!("a clear body is no gem: {reason}"),
        }
    }
}

/// Returns a mesh whose vertices know their facets, and its material.
fn facet(
    rough: &Mesh,
    clear: &StandardMaterial,
    channel_indices: Vec3,
    buffers: &mut Assets<ShaderBuffer>,
) -> Result<(Mesh, Gem), String> {
    let Some(VertexAttributeValues::Float32x3(corners)) = rough.attribute(Mesh::ATTRIBUTE_POSITION) else {
        return Err("its mesh has no positions".to_owned());
    };
    let positions: Vec<Vec3> = corners.iter().copied().map(Vec3::from).collect();
    let indices: Vec<u32> = match rough.indices() {
        Some(Indices::U32(indices)) => indices.clone(),
        Some(Indices::U16(indices)) => indices.iter().copied().map(u32::from).collect(),
        None => (0..positions.len() as u32).collect(),
    };
    let most = CONVEX_WALK_FACE as usize + 1;
    let facets = Facets::of_mesh(&positions, &indices, most)
        .ok_or_else(|| format!("its mesh {}", Facets::obstacle(&positions, &indices, most)))?;
    // Any point well inside will do for the map's centre.
    let centre =
        positions.iter().map(|position| position.as_dvec3()).sum::<bevy::math::DVec3>() / positions.len() as f64;
    let centre = centre.as_vec3();
    let planes: Vec<Vec4> = facets
        .planes
        .iter()
        .map(|plane| plane.truncate().extend(plane.w - plane.truncate().dot(centre.as_dvec3())).as_vec4())
        .collect();
    let map = FacetMap::of_stone(&planes).map_err(|error| error.to_string())?;

    // A corner where facets meet is several vertices, one for each facet.
    let mut mesh = rough.clone();
    mesh.duplicate_vertices();
    mesh.insert_attribute(FACE, facets.face_of_triangle.iter().flat_map(|face| [*face; 3]).collect::<Vec<u32>>());

    let color = |color: Color| {
        let LinearRgba { red, green, blue, .. } = color.to_linear();
        Vec3::new(red, green, blue)
    };
    let material = GemMaterial {
        base_color: color(clear.base_color),
        index: clear.ior,
        absorption: lapidary_absorption::coefficient(color(clear.attenuation_color), clear.attenuation_distance),
        // No ray travels as far; the other two are for techniques that are off.
        distance_limit: f32::MAX,
        channel_indices,
        dispersion_strength: 1.0,
        throughput_limit: 0.0,
    };
    let stone = GemStone { centre, side: map.side, lower: map.lower, upper: map.upper };
    let gem = Gem {
        material: buffers.add(ShaderBuffer::from(material)),
        planes: buffers.add(ShaderBuffer::from(planes)),
        facet_map: buffers.add(ShaderBuffer::from(map.words)),
        stone: buffers.add(ShaderBuffer::from(stone)),
    };
    Ok((mesh, gem))
}
