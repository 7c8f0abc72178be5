// What the recipe gem_convex does, by functions of the cookbook, in GLSL ES 3.00. It has no storage
// buffers: the planes of the facets are a uniform array. FACES and BOUNCES are defines of the material.

// The mesh's own, from three.js: a turn, a scale alike in all directions, and a move.
uniform mat4 modelMatrix;
uniform vec4 planes[FACES];
uniform vec3 base_color;
uniform vec3 absorption;
uniform float index;
uniform vec3 channel_indices;

// In the stone's own space, about its centre, as the planes are.
in vec3 v_position;
flat in vec3 v_eye;
flat in uint v_face;

// Light from far away, in a direction of the stone's space.
vec3 gem_surroundings(vec3 direction) {
    return environment_studio(normalize(mat3(modelMatrix) * direction));
}

// Direction and share of a channel's light that leaves through a facet.
vec4 gem_exit(vec3 inside, vec3 normal, float n) {
    RefractionHit leaving = refraction_refract(inside, normal, 1.0 / n);
    float reflected = fresnel_dielectric(-dot(normal, inside), 1.0 / n);
    return leaving.total ? vec4(inside, 0.0) : vec4(leaving.direction, 1.0 - reflected);
}

// Radiance of three channels, each from a direction of its own. A loop and not three calls, since
// compilers that inline every call then meet the studio's nine lights once. SwiftShader takes minutes
// otherwise.
vec3 gem_outside(vec3 red, vec3 green, vec3 blue) {
    vec3 directions[3] = vec3[3](red, green, blue);
    vec3 radiance;
    for (int channel = 0; channel < 3; channel++) {
        radiance[channel] = gem_surroundings(directions[channel])[channel];
    }
    return radiance;
}

// Radiance from inside: one ray at the d line, and its derivative by the index, which gives each
// channel's ray.
vec3 gem_inside(vec3 incident, vec3 normal) {
    vec3 offsets = channel_indices - index;
    // Per unit of length in the world.
    vec3 coefficient = absorption * length(modelMatrix[0].xyz);
    vec3 position = v_position;
    uint left = v_face;
    vec3 direction = refraction_refract(incident, normal, index).direction;
    vec3 gradient = dispersion_enter(incident, normal, index);
    vec3 throughput = vec3(1.0);
    vec3 radiance = vec3(0.0);
    for (int bounce = 0; bounce < BOUNCES; bounce++) {
        ConvexTraceHit hit = convex_trace_start(CONVEX_TRACE_FAR);
        for (uint face = 0u; face < uint(FACES); face++) {
            hit = convex_trace_step(hit, position, direction, planes[face], face, left);
        }
        if (hit.face == CONVEX_TRACE_NONE) {
            break;
        }
        vec4 plane = planes[hit.face];
        position = convex_trace_point(position, direction, hit.distance_, plane);
        left = hit.face;
        throughput *= absorption_transmittance(coefficient, hit.distance_);
        vec4 red = gem_exit(dispersion_direction(direction, gradient, offsets.r), -plane.xyz, channel_indices.r);
        vec4 green = gem_exit(dispersion_direction(direction, gradient, offsets.g), -plane.xyz, channel_indices.g);
        vec4 blue = gem_exit(dispersion_direction(direction, gradient, offsets.b), -plane.xyz, channel_indices.b);
        vec3 share = vec3(red.w, green.w, blue.w);
        radiance += share * throughput * gem_outside(red.xyz, green.xyz, blue.xyz);
        throughput *= 1.0 - share;
        direction = refraction_reflect(direction, -plane.xyz);
        gradient = dispersion_reflect(gradient, -plane.xyz);
    }
    // What a ray still carries at its end is taken from the environment along it.
    return radiance + throughput * gem_outside(
        dispersion_direction(direction, gradient, offsets.r),
        dispersion_direction(direction, gradient, offsets.g),
        dispersion_direction(direction, gradient, offsets.b)
    );
}

void main() {
    vec3 normal = planes[v_face].xyz;
    vec3 incident = normalize(v_position - v_eye);
    float cosine = -dot(normal, incident);
    vec3 reflectance = vec3(
        fresnel_dielectric(cosine, channel_indices.r),
        fresnel_dielectric(cosine, channel_indices.g),
        fresnel_dielectric(cosine, channel_indices.b)
    );
    vec3 surface = gem_surroundings(refraction_reflect(incident, normal));
    vec3 inside = (1.0 - reflectance) * base_color * gem_inside(incident, normal);
    gl_FragColor = vec4(reflectance * surface + inside, 1.0);
    #include <tonemapping_fragment>
    #include <colorspace_fragment>
}
