// The stages of the material `Gem`: Bevy's meshes, Bevy's view, and the light inside a stone from the
// cookbook. lapidary::gem_walk is written by `cook copy`; see ../run.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_functions::{get_world_from_local, mesh_position_local_to_world}
#import bevy_pbr::mesh_view_bindings
#import bevy_pbr::view_transformations::position_world_to_clip
#import lapidary::gem_walk

struct Vertex {
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3f,
    // The facet that this vertex's triangle lies in: an attribute of our own.
    @location(1) face: u32,
}

struct Corner {
    @builtin(position) clip: vec4f,
    // In the stone's own space, in which rays inside are traced.
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) face: u32,
    @location(2) @interpolate(flat) instance: u32,
}

@vertex
fn vertex(in: Vertex) -> Corner {
    let world = mesh_position_local_to_world(get_world_from_local(in.instance), vec4f(in.position, 1.0f));
    return Corner(position_world_to_clip(world.xyz), in.position, in.face, in.instance);
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
    // What the recipe reads of the view and of the stone's place comes from Bevy's own bindings.
    gem_walk::view.eye = mesh_view_bindings::view.world_position;
    gem_walk::instances[0] = gem_walk::GemInstance(
        mesh[in.instance].world_from_local,
        gem_walk::material.base_color,
        gem_walk::material.absorption,
    );
    let seen = gem_walk::GemVertex(in.clip, in.position, gem_walk::planes[in.face].xyz, in.face, 0u);
    let radiance = gem_walk::gem_radiance(seen, true);
    return vec4f(radiance.surface + radiance.inside, 1.0f);
}
