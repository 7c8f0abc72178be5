// gem: a transparent stone by proxy geometry, in one draw call and without any data but the soft-edged mesh.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", section 4.
// requires: absorption, bounds_trace, closest_point, dispersion, environment, fresnel
// requires: proxy_geometry, refraction, screen_trace
// parts: mesh, mesh_normals, surroundings, bodies, lights, glints, gem_shading, screen, gem_apart
// compares: closest_point
//
// Draw 3 vertices per triangle without a vertex buffer: the mesh is read from storage buffers, so
// that each vertex sees its whole triangle and the proxy needs no further data and no further pass.

// Light passes through the stone; if off, only its surface reflects (the paper's Fig. 2). Called
// for by KHR_materials_transmission.
override EFFECT_PROXY_GEOMETRY: bool = true;
// Computes the proxy's centre by the paper's eq. (4) instead of the stable form.
override CENTRE_PAPER: bool = false;

// Three floats per vertex: normals shared by the facets that meet there, averaged by angle.
@group(2) @binding(0) var<storage, read> normals: array<f32>;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    // The remaining members have one value per triangle.
    @location(1) @interpolate(flat, either) face_normal: vec3f,
    @location(2) @interpolate(flat, either) centre: vec3f,  //+proxy_geometry
    @location(3) @interpolate(flat, either) plane_origin: vec3f,  //+proxy_geometry
    @location(4) @interpolate(flat, either) edge_first: vec3f,  //+proxy_geometry
    @location(5) @interpolate(flat, either) edge_second: vec3f,  //+proxy_geometry
    @location(6) @interpolate(flat, either) instance: u32,  //+instances
}

// The proxy's centre, from the three vertex normals.
fn gem_centre(a: u32, b: u32, c: u32) -> vec3f {
    let position_a = mesh_position(a);
    let position_b = mesh_position(b);
    let position_c = mesh_position(c);
    if (CENTRE_PAPER) {
        return closest_point_centre_paper(
            position_a, mesh_normal(a), position_b, mesh_normal(b), position_c, mesh_normal(c)
        );
    }
    return closest_point_centre(position_a, mesh_normal(a), position_b, mesh_normal(b), position_c, mesh_normal(c));
}

// A corner of a triangle of the stone.
@vertex
fn gem_vertex(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,  //+instances
) -> GemVertex {
    let first = vertex - vertex % 3u;
    let position_a = mesh_position(indices[first]);
    let position_b = mesh_position(indices[first + 1u]);
    let position_c = mesh_position(indices[first + 2u]);
    let position = mesh_position(indices[vertex]);
    let face_normal = proxy_geometry_face_normal(position_a, position_b, position_c);
    //+proxy_geometry {
    var centre = position_a;
    if (EFFECT_PROXY_GEOMETRY) {
        centre = gem_centre(indices[first], indices[first + 1u], indices[first + 2u]);
        // At a dent, where normals diverge inwards, the lines meet outside. Such a triangle takes
        // the fallback.
        if (dot(face_normal, position_a - centre) <= 0.0f) {
            centre = closest_point_fallback(position_a, position_b, position_c);
        }
    }
    let plane = proxy_geometry_plane(centre, position_a, position_b, position_c);
    //+proxy_geometry }
    return GemVertex(
        //-instances gem_clip(position),
        gem_clip(position, instance),  //+instances
        position,
        face_normal,
        centre,  //+proxy_geometry
        plane.origin,  //+proxy_geometry
        plane.edge_first,  //+proxy_geometry
        plane.edge_second,  //+proxy_geometry
        instance,  //+instances
    );
}

// The place of a ray inside: the plane that it travels towards. All planes of a triangle's proxy
// are parallel to the triangle.
struct GemPlace {
    plane: ProxyGeometryPlane,
    centre: vec3f,
    normal: vec3f,
}

fn gem_enter(input: GemVertex) -> GemPlace {
    return GemPlace(
        ProxyGeometryPlane(input.plane_origin, input.edge_first, input.edge_second),
        input.centre,
        input.face_normal
    );
}

// The hit on a tile of the plane. A ray misses the next plane if a tile has turned it away from
// that plane or parallel to it.
fn gem_hit(place: ptr<function, GemPlace>, ray: GemRay) -> GemHit {
    let plane = (*place).plane;
    let hit = proxy_geometry_intersect(ray.position, ray.direction, plane.origin, (*place).normal);
    if (!hit.hit) {
        return GemHit(ray.position, -ray.direction, 0.0f, false);
    }
    let coordinates = proxy_geometry_coordinates(hit.point, plane.origin, plane.edge_first, plane.edge_second);
    let facet = proxy_geometry_facet(plane, proxy_geometry_cell(coordinates));
    let normal = proxy_geometry_facet_normal(
        (*place).centre, facet.vertex_first, facet.vertex_second, facet.vertex_third, ray.direction
    );
    (*place).plane = proxy_geometry_next_plane((*place).centre, facet);
    return GemHit(hit.point, normal, hit.distance, true);
}

// Radiance that the stone sends to the eye, linear, with an alpha of 1.
@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    let radiance = gem_radiance(input, EFFECT_PROXY_GEOMETRY);  //+proxy_geometry
    //-proxy_geometry let radiance = gem_radiance(input);
    if (EFFECT_PROXY_GEOMETRY) {
        return vec4f(radiance.surface + radiance.inside, 1.0f);
    }
    if (EFFECT_THIN_WALL) {
        return vec4f(radiance.surface + radiance.inside, 1.0f);
    }
    return vec4f(radiance.surface, 1.0f);
}

// For a deferred renderer, in place of gem_fragment; gem_composite shows how the lighting pass uses
// it.
@fragment
fn gem_deferred_fragment(input: GemVertex) -> GemGeometryBuffer {
    return gem_geometry_buffer(input, EFFECT_PROXY_GEOMETRY);  //+proxy_geometry
    //-proxy_geometry return gem_geometry_buffer(input);
}
