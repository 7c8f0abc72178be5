// gem_scene: clear bodies among other bodies: light goes through all of them, by one hierarchy of all triangles.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980 (the tree of
//   rays); Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics
//   Tools 7(2), 2002 (priorities). Own: the strongest ray first.
// requires: absorption, bvh_trace, cdrf, curved_triangle, environment, fresnel, half_space, microfacet
// requires: proxy_geometry, random_walk, refraction, split_sum
// parts: surroundings, lights, glints, harmonics, trace_nearest, sample_rank, texture_tangents
// parts: scene_images, scattering_law, metal
//
// Draw each clear body with 3 vertices per triangle, without a vertex buffer, and cull back faces;
// set TRAVERSAL_TWO_SIDED. At every surface a ray is split into its reflection and its refraction;
// the strongest ray that waits is followed next, until HITS surfaces were found.

// Clear bodies share space: each ray knows the bodies that it is within. Called for by a body that lies
// within a clear one, or overlaps it.
override EFFECT_NESTED: bool = false;
// Light that leaves a clear body comes from clear bodies too. Called for by two clear bodies that
// overlap in the view.
override EFFECT_BEHIND: bool = false;
// Light comes from bodies that are not clear, too; if off, leave them out of the hierarchy. Called for by
// any of them.
override EFFECT_AROUND: bool = false;
// The interpolated normal refracts and reflects. Called for by a clear body with smooth normals.
override EFFECT_SMOOTH: bool = false;
// Facets at random reflect and refract. Called for by a clear body of a roughness above 0.0316.
override EFFECT_ROUGH: bool = false;
// A share of the light does not enter: to it the surface is matt. Called for by a transmission between 0 and 1.
override EFFECT_PARTIAL_TRANSMISSION: bool = false;
// Opaque bodies cover a share of what is behind them. Called for by an alphaMode of MASK or BLEND of one of
// them.
override EFFECT_COVERAGE: bool = false;
// Light that scatters in a body spreads over its curved surface. Called for by KHR_materials_diffuse_transmission, or
// extras.lapidary, of a body that is not clear.
override EFFECT_CDRF: bool = false;
// Light is absorbed on its way through bodies. Called for by KHR_materials_volume with an attenuation
// colour below white.
override EFFECT_ABSORPTION: bool = false;
// The refractive index depends on the wavelength. Called for by KHR_materials_dispersion above 0.
override EFFECT_DISPERSION: bool = false;
// Light from all around falls on bodies that are not clear.
override EFFECT_ENVIRONMENT: bool = false;
// Number of trees of rays: one for each entry of `wavelengths` if light is dispersed, each with facets of
// its own if they are rough.
override WAVELENGTHS: u32 = 1u;
// Number of surfaces at which light is split, for each wavelength, after the one that the eye sees.
override BOUNCES: u32 = 16u;
// The light that rays still carry when they end is taken from the environment along them; if false, it
// is dropped.
override REST_FROM_ENVIRONMENT: bool = true;

// Number of rays that wait. Of more, the weakest end.
const SCENE_WAITING = 6u;
// Number of facets of a rough surface after which light leaves as it goes.
const SCENE_FACETS = 6u;
// Stands for no body.
const SCENE_NONE = 0xffffffffu;
// Values of SceneBody.kind.
const SCENE_THIN_WALL = 1u;
const SCENE_OPAQUE = 2u;

struct GemView {
    clip_from_world: mat4x4f,
    eye: vec3f,
}

// A body. Of two that share space, the one of the lower number is there.
struct SceneBody {
    // Factor for light that enters, or for light that an opaque body sends back; linear RGB.
    base_color: vec3f,
    // Index of refraction at the d line, relative to the air.
    index: f32,
    // Absorption per unit of length.
    absorption: vec3f,
    // 0 for a clear body, else SCENE_THIN_WALL or SCENE_OPAQUE.
    kind: u32,
    // Slope of the surface's facets: the square of glTF's roughness; 0 if it is polished.
    alpha: f32,
    // Share of the light that comes from outside, and is not reflected, that enters; of an opaque body, the
    // share that it does not cover.
    clear: f32,
    // Transport mean free path of a body in which light scatters, per channel; 0 of others.
    free_path: vec3f,
    // Its law, without a boundary.
    law: ScatteringLaw,
    // Share of an opaque body's surface that is a metal's.
    metallic: f32,
}

struct SceneStart {
    // The bodies around the eye, as in SceneRay.
    within: vec4u,
    // Mean radiance of the environment, linear RGB.
    around: vec3f,
    // Share of the light below which a ray ends.
    throughput_limit: f32,
}

// One of the wavelengths that are followed.
struct SceneWavelength {
    // Contribution of its radiance to the pixel's, both in linear RGB.
    weights: mat3x3f,
}

@group(0) @binding(0) var<uniform> view: GemView;
// The root is first.
@group(0) @binding(11) var<storage, read> nodes: array<BvhTraceNode>;
// Three per triangle, counter-clockwise from outside, in the order of the leaves. w is the number of
// the body.
@group(0) @binding(12) var<storage, read> corners: array<vec4f>;
// Normals at these corners; 0 where the triangle is flat. w is the mean curvature of a body in which light scatters.
@group(0) @binding(13) var<storage, read> corner_normals: array<vec4f>;
@group(0) @binding(14) var<storage, read> scene_bodies: array<SceneBody>;
@group(0) @binding(15) var<uniform> scene_start: SceneStart;
// The numbers of the drawn body's triangles.
@group(1) @binding(0) var<storage, read> triangles: array<u32>;
@group(1) @binding(1) var<storage, read> wavelengths: array<SceneWavelength>;
// The bodies' indices of refraction, wavelength by wavelength.
@group(1) @binding(2) var<storage, read> body_indices: array<f32>;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    // Weights of the second and the third corner.
    @location(1) barycentrics: vec2f,
    @location(2) @interpolate(flat, either) triangle: u32,
}

// A corner of a triangle of the body.
@vertex
fn gem_vertex(@builtin(vertex_index) vertex: u32) -> GemVertex {
    let triangle = triangles[vertex / 3u];
    let corner = vertex % 3u;
    let position = corners[3u * triangle + corner].xyz;
    let barycentrics = vec2f(f32(corner == 1u), f32(corner == 2u));
    return GemVertex(view.clip_from_world * vec4f(position, 1.0f), position, barycentrics, triangle);
}

// A ray outside or inside bodies.
struct SceneRay {
    position: vec3f,
    // Unit vector.
    direction: vec3f,
    // Share of light that it carries, per channel; 0 if it has ended.
    throughput: vec3f,
    // The clear bodies around it, the one whose matter is there first: twice the number, and 1 more once
    // light has taken the body's colour. The rest is SCENE_NONE.
    within: vec4u,
    // The triangle that it left last, and another one in the same place: it cannot meet them again
    // immediately.
    left: vec2u,
}

var<private> scene_waiting: array<SceneRay, SCENE_WAITING>;
// Radiance found so far.
var<private> scene_found: vec3f;
// Counter of random numbers: the sample's place, how many were drawn, and the tree.
var<private> scene_counter: vec4u;
// The rank of this tree among those of 4 x 4 samples.
var<private> scene_rank: f32;

fn scene_strength(ray: SceneRay) -> f32 {
    return max(max(ray.throughput.r, ray.throughput.g), ray.throughput.b);
}

// Ends a ray. The rest of its light comes from the environment: outside, from where it goes; within a
// body, whose surface turns it nobody knows where, evenly from all around.
fn scene_end(ray: SceneRay) {
    if (REST_FROM_ENVIRONMENT) {
        if (ray.within.x == SCENE_NONE) {
            scene_found += ray.throughput * surroundings_radiance(ray.direction);
        } else {
            scene_found += ray.throughput * scene_start.around;
        }
    }
}

// Lets a ray wait, before all weaker ones. Places are constant: an array by a variable place would not
// fit into registers.
fn scene_wait(arriving: SceneRay) {
    var ray = arriving;
    if (scene_strength(ray) <= scene_start.throughput_limit) {
        scene_end(ray);
        return;
    }
    for (var place = 0u; place < SCENE_WAITING; place++) {
        let other = scene_waiting[place];
        if (scene_strength(ray) > scene_strength(other)) {
            scene_waiting[place] = ray;
            ray = other;
        }
    }
    scene_end(ray);
}

// Takes the strongest ray that waits.
fn scene_next() -> SceneRay {
    let ray = scene_waiting[0];
    for (var place = 1u; place < SCENE_WAITING; place++) {
        scene_waiting[place - 1u] = scene_waiting[place];
    }
    scene_waiting[SCENE_WAITING - 1u].throughput = vec3f(0.0f);
    return ray;
}

// Whether a body is among those around a ray.
fn scene_holds(within: vec4u, body: u32) -> bool {
    return any((within >> vec4u(1u)) == vec4u(body));
}

// The bodies around a ray, and one more; the fifth is left out.
fn scene_with(within: vec4u, body: u32) -> vec4u {
    // In an ordered list, each place keeps its body, or takes the new one or that of the place before.
    return clamp(vec4u(2u * body), vec4u(0u, within.xyz), within);
}

// The bodies around a ray without one of them.
fn scene_without(within: vec4u, body: u32) -> vec4u {
    return select(within, vec4u(within.yzw, SCENE_NONE), within >= vec4u(2u * body));
}

// The colour that light takes from the matter that it is in, if it has not taken it yet. `painted` is the factor of the
// body whose surface it crosses.
fn scene_color(within: vec4u, crossed: u32, painted: vec3f) -> vec3f {
    if (within.x == SCENE_NONE || (within.x & 1u) != 0u) {
        return vec3f(1.0f);
    }
    let color = scene_bodies[within.x >> 1u].base_color;
    return select(color, painted * color, (within.x >> 1u) == crossed);
}

// The bodies around a ray once light has taken the colour of the first.
fn scene_colored(within: vec4u) -> vec4u {
    return vec4u(within.x | 1u, within.yzw);
}

fn scene_index(within: vec4u, wavelength: u32) -> f32 {
    if (within.x == SCENE_NONE) {
        return 1.0f;
    }
    if (EFFECT_DISPERSION) {
        return body_indices[wavelength * arrayLength(&scene_bodies) + (within.x >> 1u)];
    }
    return scene_bodies[within.x >> 1u].index;
}

// The normal at a place on a triangle: interpolated, or that of its plane where the triangle is flat or
// the normals cancel.
fn scene_normal(triangle: u32, barycentrics: vec2f, flat_normal: vec3f) -> vec3f {
    let first = 1.0f - barycentrics.x - barycentrics.y;
    let normal = first * corner_normals[3u * triangle].xyz
        + barycentrics.x * corner_normals[3u * triangle + 1u].xyz
        + barycentrics.y * corner_normals[3u * triangle + 2u].xyz;
    let squared = dot(normal, normal);
    if (squared < 1e-6f) {
        return flat_normal;
    }
    return normal * inverseSqrt(squared);
}

// The normal by which a place on a triangle is matt.
fn scene_matte_normal(hit: BvhTraceHit, place: ScenePlace, flat_normal: vec3f) -> vec3f {
    let normal = scene_normal(hit.triangle, hit.barycentrics, flat_normal);
    if (EFFECT_NORMAL_TEXTURE) {
        return scene_image_normal(place, normal);
    }
    return normal;
}

// Where a ray meets the curved surface that a triangle's normals describe.
fn scene_curved(hit: BvhTraceHit, position: vec3f, direction: vec3f, outward: vec3f) -> CurvedTriangleHit {
    let first = 3u * hit.triangle;
    let triangle = CurvedTriangle(
        corners[first].xyz,
        corners[first + 1u].xyz,
        corners[first + 2u].xyz,
        corner_normals[first].xyz,
        corner_normals[first + 1u].xyz,
        corner_normals[first + 2u].xyz,
    );
    return curved_triangle_meet(triangle, hit.barycentrics, position, direction, outward);
}

// Radiance that an opaque body sends: Lambert's law, without shadows.
fn scene_sent(base_color: vec3f, position: vec3f, normal: vec3f) -> vec3f {
    var irradiance = vec3f(0.0f);
    if (EFFECT_ENVIRONMENT) {
        let weights = cdrf_harmonic_weights(0.0f);
        irradiance = harmonics_irradiance(harmonics_around(normal), weights, weights, weights);
    }
    for (var number = 0u; number < arrayLength(&lights); number++) {
        let arrival = light_arrival(lights[number], position);
        irradiance += max(dot(arrival.direction, normal), 0.0f) * arrival.irradiance;
    }
    return 0.318309886f * base_color * irradiance;
}

//+metal {
// Radiance that a metal sends in a direction, without shadows and other bodies.
fn scene_metal(body: SceneBody, base_color: vec3f, position: vec3f, normal: vec3f, toward_eye: vec3f) -> vec3f {
    let metal = metal_seen(base_color, body.alpha, dot(normal, toward_eye));
    var radiance = metal.reflectance * metal_surroundings(reflect(-toward_eye, normal), body.alpha);
    if (body.alpha > 0.0f) {
        for (var number = 0u; number < arrayLength(&lights); number++) {
            radiance += metal_highlight(metal, light_arrival(lights[number], position), normal, toward_eye);
        }
    }
    return radiance;
}
//+metal }

//+cdrf {
// Irradiance of one channel by its cosine with the light, after the drift of light that scatters.
fn scene_drifted(cosine: f32, drift: CdrfDrift) -> f32 {
    return drift.share * cdrf_cheap(cdrf_shifted(cosine, drift.shift), drift.sigma);
}

// Radiance that a body sends in a direction in which light scatters, by the curvature of its surface, without shadows
// and highlights.
fn scene_spread(
    body: SceneBody, base_color: vec3f, position: vec3f, normal: vec3f, curvature: f32, cosine_eye: f32
) -> vec3f {
    let red = cdrf_drift(body.free_path.x, curvature, body.law.gamma.x);
    let green = cdrf_drift(body.free_path.y, curvature, body.law.gamma.y);
    let blue = cdrf_drift(body.free_path.z, curvature, body.law.gamma.z);
    let sigma = vec3f(red.sigma, green.sigma, blue.sigma);
    var irradiance = vec3f(0.0f);
    if (EFFECT_ENVIRONMENT) {
        irradiance = harmonics_irradiance(
            harmonics_around(normal),
            cdrf_harmonic_weights(red.sigma),
            cdrf_harmonic_weights(green.sigma),
            cdrf_harmonic_weights(blue.sigma),
        );
        if (EFFECT_HALF_SPACE) {
            irradiance *= scattering_law_around(cosine_eye, body.law);
        }
    }
    for (var number = 0u; number < arrayLength(&lights); number++) {
        let arrival = light_arrival(lights[number], position);
        let cosine = dot(arrival.direction, normal);
        var received = vec3f(scene_drifted(cosine, red), scene_drifted(cosine, green), scene_drifted(cosine, blue));
        if (EFFECT_HALF_SPACE) {
            // The cosine at which light has entered that leaves here.
            let entered = min(sqrt(received * received + sigma * sigma), vec3f(1.0f));
            received *= scattering_law_of_light(cosine_eye, entered, body.law);
        }
        irradiance += received * arrival.irradiance;
    }
    return 0.318309886f * base_color * irradiance;
}

// The mean curvature at a place on a triangle.
fn scene_curvature(triangle: u32, barycentrics: vec2f) -> f32 {
    return (1.0f - barycentrics.x - barycentrics.y) * corner_normals[3u * triangle].w
        + barycentrics.x * corner_normals[3u * triangle + 1u].w
        + barycentrics.y * corner_normals[3u * triangle + 2u].w;
}
//+cdrf }

// Random numbers, four for each call.
fn scene_random() -> vec4f {
    scene_counter.z++;
    return random_walk_random(scene_counter);
}

// Random numbers of the first two surfaces, which for all trees of 4 x 4 samples lie evenly: Roberts' sequence in
// eight dimensions, from a random start.
fn scene_evenly() -> vec4f {
    if (scene_counter.z > 2u) {
        return scene_random();
    }
    let first = vec4f(0.9215993f, 0.8493453f, 0.7827561f, 0.7213874f);
    let second = vec4f(0.6648302f, 0.612707f, 0.5646704f, 0.5203999f);
    let step = select(second, first, scene_counter.z == 0u);
    let start = random_walk_random(vec4u(scene_counter.xy >> vec2u(2u), scene_counter.z, 0x10000u));
    scene_counter.z++;
    return min(fract(start + scene_rank * step), vec4f(0.99999994f));
}

// Light among the facets of a rough surface.
struct SceneAmong {
    direction: vec3f,
    // 1 on the side from which light came, -1 on the other.
    side: f32,
    // Share of the surface that lies farther from that side's outside; 1 outside.
    below: f32,
}

// Share of the surface below the next facet that light meets, at random; above 1 if it meets none. Smith's
// lambda is the mean number of facets that light on its way out meets from the lowest point on; light on its
// way in meets one for certain.
fn scene_below(cosine: f32, below: f32, alpha: f32, u: f32) -> f32 {
    let c = max(abs(cosine), 1e-6f);
    let sine_squared = max((1.0f - c) * (1.0f + c), 0.0f);
    let stretched = sqrt(alpha * alpha * sine_squared + c * c);
    let lambda = alpha * alpha * sine_squared / (2.0f * c * (stretched + c));
    let depth = -log2(1.0f - u);
    if (cosine < 0.0f) {
        return below * exp2(-depth / (1.0f + lambda));
    }
    return below * exp2(min(depth / max(lambda, 1e-6f), 64.0f));
}

// Follows light from facet to facet until it leaves them: its direction, and 1 or -1 for the side.
fn scene_leave(
    start: SceneAmong, normal: vec3f, alpha: f32, relative_index: f32, first: vec4f
) -> vec4f {
    var among = start;
    var random = first;
    for (var facets = 1u; facets < SCENE_FACETS; facets++) {
        let up = among.side * normal;
        let below = scene_below(dot(up, among.direction), among.below, alpha, random.x);
        if (below >= 1.0f) {
            break;
        }
        among.below = below;
        let facet = microfacet_facet(up, -among.direction, alpha, random.y, random_walk_azimuth(random.z));
        let index = select(1.0f / relative_index, relative_index, among.side > 0.0f);
        let refracted = refraction_refract(among.direction, facet, index);
        let crosses = !refracted.total && random.w >= fresnel_dielectric(-dot(among.direction, facet), index);
        among.direction = select(refraction_reflect(among.direction, facet), refracted.direction, crosses);
        among.side = select(among.side, -among.side, crosses);
        among.below = select(below, 1.0f - below, crosses);
        random = scene_random();
    }
    return vec4f(among.direction, among.side);
}

// Turns a direction to a side of a surface, by a mirror in its plane.
fn scene_turn(direction: vec3f, facing: vec3f, side: f32) -> vec3f {
    let along = dot(direction, facing);
    return direction - (along - side * abs(along)) * facing;
}

// The two rays that leave a surface.
struct SceneSplit {
    reflected: vec3f,
    refracted: vec3f,
    // Share of light that is reflected.
    reflectance: f32,
    // Whether each of the two stays on the ray's side: between rough facets light may change it.
    stay: vec2<bool>,
}

// Splits light at the first facet of a rough surface that it meets. What is reflected there and what is
// refracted may meet more facets, at which each takes one way at random.
fn scene_split_rough(
    direction: vec3f, facing: vec3f, normal: vec3f, relative_index: f32, alpha: f32
) -> SceneSplit {
    let random = scene_evenly();
    let below = scene_below(dot(direction, normal), 1.0f, alpha, random.x);
    let facet = microfacet_facet(normal, -direction, alpha, random.y, random_walk_azimuth(random.z));
    let refracted = refraction_refract(direction, facet, relative_index);
    let next = scene_random();
    let back = SceneAmong(refraction_reflect(direction, facet), 1.0f, below);
    let reflected = scene_leave(back, normal, alpha, relative_index, next);
    var split = SceneSplit(scene_turn(reflected.xyz, facing, reflected.w), direction, 1.0f, vec2<bool>(true, false));
    split.stay.x = reflected.w > 0.0f;
    if (!refracted.total) {
        let through = SceneAmong(refracted.direction, -1.0f, 1.0f - below);
        let crossed = scene_leave(through, normal, alpha, relative_index, next.yxwz);
        split.reflectance = fresnel_dielectric(-dot(direction, facet), relative_index);
        split.refracted = scene_turn(crossed.xyz, facing, crossed.w);
        split.stay.y = crossed.w > 0.0f;
    }
    return split;
}

// The normal that reflects and refracts: that of the triangle's plane where the other one faces away from the ray.
fn scene_facing(smooth_normal: vec3f, facing: vec3f, direction: vec3f) -> vec3f {
    return select(facing, smooth_normal, dot(smooth_normal, direction) < 0.0f);
}

// The two rays by the triangle's plane where its normal would send them to the wrong side of it.
fn scene_mended(given: SceneSplit, direction: vec3f, facing: vec3f, relative_index: f32) -> SceneSplit {
    var split = given;
    if (dot(split.reflected, facing) <= 0.0f) {
        split.reflected = refraction_reflect(direction, facing);
    }
    if (split.reflectance < 1.0f && dot(split.refracted, facing) >= 0.0f) {
        let straight = refraction_refract(direction, facing, relative_index);
        split.refracted = straight.direction;
        if (straight.total) {
            split.reflectance = 1.0f;
        }
    }
    return split;
}

// `facing` is the normal of the triangle's plane on the ray's side, `smooth_normal` the one that
// reflects and refracts. Where that would send light to the wrong side of the triangle, or faces away,
// the triangle's plane stands in. What one normal does not reflect, it refracts: no light is lost.
fn scene_split(
    direction: vec3f, facing: vec3f, smooth_normal: vec3f, relative_index: f32, alpha: f32
) -> SceneSplit {
    var normal = facing;
    if (EFFECT_SMOOTH) {
        normal = scene_facing(smooth_normal, facing, direction);
    }
    if (EFFECT_NORMAL_TEXTURE) {
        normal = scene_facing(smooth_normal, facing, direction);
    }
    if (EFFECT_ROUGH) {
        if (alpha > 0.0f) {
            return scene_split_rough(direction, facing, normal, relative_index, alpha);
        }
    }
    let refracted = refraction_refract(direction, normal, relative_index);
    let stay = vec2<bool>(true, false);
    var split = SceneSplit(refraction_reflect(direction, normal), refracted.direction, 1.0f, stay);
    if (!refracted.total) {
        split.reflectance = fresnel_dielectric(-dot(direction, normal), relative_index);
    }
    if (EFFECT_SMOOTH) {
        split = scene_mended(split, direction, facing, relative_index);
    }
    if (EFFECT_NORMAL_TEXTURE) {
        split = scene_mended(split, direction, facing, relative_index);
    }
    return split;
}

// Follows a ray that has come to a triangle, at a distance.
fn scene_surface(arriving: SceneRay, hit: BvhTraceHit, wavelength: u32) {
    var ray = arriving;
    let a = corners[3u * hit.triangle];
    let b = corners[3u * hit.triangle + 1u].xyz;
    let c = corners[3u * hit.triangle + 2u].xyz;
    let number = u32(a.w);
    let body = scene_bodies[number];
    if (EFFECT_ABSORPTION) {
        if (ray.within.x != SCENE_NONE) {
            ray.throughput *= absorption_transmittance(scene_bodies[ray.within.x >> 1u].absorption, hit.distance);
        }
    }
    ray.position = a.xyz + hit.barycentrics.x * (b - a.xyz) + hit.barycentrics.y * (c - a.xyz);
    ray.left = vec2u(hit.triangle, BVH_TRACE_NONE);
    if (hit.distance <= TRACE_MOST_AHEAD * trace_margin) {
        ray.left.y = arriving.left.x;
    }
    let outward = proxy_geometry_face_normal(a.xyz, b, c);
    let enters = dot(outward, ray.direction) < 0.0f;
    let facing = select(-outward, outward, enters);
    var painted = vec3f(1.0f);
    var clear = body.clear;
    var place = ScenePlace();
    let way = length(ray.position - view.eye);
    if (EFFECT_NORMAL_TEXTURE) {
        place = scene_place(hit.triangle, hit.barycentrics, way);
    }
    if (EFFECT_BASE_COLOR_TEXTURE) {
        place = scene_place(hit.triangle, hit.barycentrics, way);
        let color = scene_image_color(place);
        painted *= color.rgb;
        if (EFFECT_COVERAGE) {
            if (body.kind == SCENE_OPAQUE && color.w >= 0.0f) {
                clear = 1.0f - color.w;
            }
        }
    }
    if (EFFECT_TRANSMISSION_TEXTURE) {
        place = scene_place(hit.triangle, hit.barycentrics, way);
        if (body.kind != SCENE_OPAQUE) {
            clear *= scene_image_transmission(place);
        }
    }
    if (EFFECT_VERTEX_COLOR) {
        place = scene_place(hit.triangle, hit.barycentrics, way);
        painted *= place.color;
    }
    var passes = true;
    if (EFFECT_AROUND) {
        // Its back is not there.
        if (body.kind == SCENE_OPAQUE && enters) {
            let normal = scene_matte_normal(hit, place, outward);
            var sent = scene_sent(painted * body.base_color, ray.position, normal);
            if (EFFECT_CDRF) {
                //+cdrf {
                if (any(body.free_path > vec3f(0.0f))) {
                    let curvature = scene_curvature(hit.triangle, hit.barycentrics);
                    let cosine = max(-dot(ray.direction, normal), -0.5f * dot(ray.direction, outward));
                    sent = scene_spread(body, painted * body.base_color, ray.position, normal, curvature, cosine);
                }
                //+cdrf }
            }
            if (EFFECT_METAL) {
                //+metal {
                if (body.metallic > 0.0f) {
                    let metal = scene_metal(body, painted * body.base_color, ray.position, normal, -ray.direction);
                    sent = mix(sent, metal, body.metallic);
                }
                //+metal }
            }
            var covered = ray.throughput;
            if (EFFECT_COVERAGE) {
                covered = (1.0f - clear) * ray.throughput;
                ray.throughput *= clear;
                scene_wait(ray);
            }
            scene_found += covered * sent;
            passes = false;
        }
    }
    if (passes) {
        var behind = ray.within;
        if (body.kind != SCENE_THIN_WALL && enters != scene_holds(ray.within, number)) {
            behind = vec4u(select(SCENE_NONE, 2u * number, enters), SCENE_NONE, SCENE_NONE, SCENE_NONE);
            if (EFFECT_NESTED) {
                behind = select(scene_without(ray.within, number), scene_with(ray.within, number), enters);
            }
        }
        var split = SceneSplit(ray.direction, ray.direction, 0.0f, vec2<bool>(true, false));
        var color = vec3f(1.0f);
        var is_surface = false;
        if (body.kind == SCENE_THIN_WALL) {
            var normal = facing;
            if (EFFECT_NORMAL_TEXTURE) {
                let bent = scene_image_normal(place, outward);
                normal = select(facing, select(-bent, bent, enters), (dot(bent, ray.direction) < 0.0f) == enters);
            }
            if (EFFECT_ROUGH) {
                if (body.alpha > 0.0f) {
                    let random = scene_evenly();
                    normal = microfacet_facet(
                        normal, -ray.direction, body.alpha, random.x, random_walk_azimuth(random.y)
                    );
                }
            }
            split.reflected = refraction_reflect(ray.direction, normal);
            if (EFFECT_NORMAL_TEXTURE) {
                if (body.alpha == 0.0f && dot(split.reflected, facing) <= 0.0f) {
                    split.reflected = refraction_reflect(ray.direction, facing);
                }
            }
            if (EFFECT_ROUGH) {
                if (body.alpha > 0.0f) {
                    // What goes through is turned as what is reflected, on the other side.
                    split.refracted = select(ray.direction, scene_turn(split.reflected, facing, -1.0f), enters);
                    split.reflected = scene_turn(split.reflected, facing, 1.0f);
                }
            }
            // Light goes back and forth between the wall's two interfaces. Its back is not there.
            let once = select(0.0f, fresnel_dielectric(-dot(ray.direction, normal), body.index), enters);
            split.reflectance = 2.0f * once / (1.0f + once);
            color = select(vec3f(1.0f), painted * body.base_color, enters);
            is_surface = enters;
        } else if ((behind.x >> 1u) != (ray.within.x >> 1u)) {
            // Otherwise there is the same matter on both sides, and no surface.
            var smooth_normal = outward;
            if (EFFECT_SMOOTH) {
                let curved = scene_curved(hit, ray.position, ray.direction, outward);
                ray.position = curved.position;
                smooth_normal = curved.normal;
            }
            if (EFFECT_NORMAL_TEXTURE) {
                smooth_normal = scene_image_normal(place, smooth_normal);
            }
            smooth_normal = select(-smooth_normal, smooth_normal, enters);
            let relative_index = scene_index(behind, wavelength) / scene_index(ray.within, wavelength);
            split = scene_split(ray.direction, facing, smooth_normal, relative_index, body.alpha);
            is_surface = enters;
            color = scene_color(ray.within, number, painted) * scene_color(behind, number, painted);
            behind = scene_colored(behind);
        }
        var reflected = ray;
        reflected.direction = split.reflected;
        reflected.throughput *= split.reflectance;
        // Of two surfaces in one place, light that goes back at the second crosses the first again.
        reflected.left.y = BVH_TRACE_NONE;
        ray.direction = split.refracted;
        ray.throughput *= 1.0f - split.reflectance;
        if (EFFECT_ROUGH) {
            if (!split.stay.x) {
                reflected.throughput *= color;
                reflected.within = behind;
                reflected.left.y = ray.left.y;
            }
            if (split.stay.y) {
                color = vec3f(1.0f);
                behind = ray.within;
                ray.left.y = BVH_TRACE_NONE;
            }
        }
        ray.throughput *= color;
        if (EFFECT_PARTIAL_TRANSMISSION) {
            if (is_surface && clear < 1.0f) {
                var entering = ray.throughput;
                if (EFFECT_ROUGH) {
                    entering = f32(!split.stay.y) * ray.throughput + f32(!split.stay.x) * reflected.throughput;
                    reflected.throughput *= select(clear, 1.0f, split.stay.x);
                }
                let normal = scene_matte_normal(hit, place, outward);
                scene_found += (1.0f - clear) * entering * scene_sent(vec3f(1.0f), ray.position, normal);
                ray.throughput *= select(clear, 1.0f, split.stay.y);
            }
        }
        scene_wait(reflected);
        ray.within = behind;
        scene_wait(ray);
    }
}

// Radiance of one wavelength.
fn scene_radiance(input: GemVertex, wavelength: u32) -> vec3f {
    scene_found = vec3f(0.0f);
    for (var place = 0u; place < SCENE_WAITING; place++) {
        scene_waiting[place].throughput = vec3f(0.0f);
    }
    let way = input.position - view.eye;
    var ray = SceneRay(view.eye, normalize(way), vec3f(1.0f), scene_start.within, vec2u(BVH_TRACE_NONE));
    var hit = BvhTraceHit(length(way), input.barycentrics, input.triangle);
    for (var hits = 0u; hits <= BOUNCES; hits++) {
        if (hits > 0u) {
            ray = scene_next();
            if (scene_strength(ray) == 0.0f) {
                break;
            }
            hit = bvh_trace_start(TRACE_FAR);
            // Outside, a ray may meet other bodies.
            var searches = ray.within.x != SCENE_NONE;
            if (EFFECT_BEHIND) {
                searches = true;
            }
            if (EFFECT_AROUND) {
                searches = true;
            }
            if (searches) {
                trace_also_left = ray.left.y;
                hit = trace_nearest(ray.position, ray.direction, ray.left.x, TRACE_FAR);
            }
        }
        if (hit.triangle == BVH_TRACE_NONE) {
            scene_found += ray.throughput * surroundings_radiance(ray.direction);
            if (EFFECT_LIGHT && ray.within.x == SCENE_NONE) {
                scene_found += ray.throughput * glints_radiance(ray.position, ray.direction, view.eye);
            }
        } else {
            scene_surface(ray, hit, wavelength);
        }
    }
    for (var place = 0u; place < SCENE_WAITING; place++) {
        scene_end(scene_waiting[place]);
    }
    return scene_found;
}

// Sets the random numbers of a tree of rays.
fn scene_start_tree(input: GemVertex, tree: u32) {
    if (EFFECT_ROUGH) {
        let place = vec2u(input.clip.xy);
        scene_counter = vec4u(place, 0u, tree);
        scene_rank = f32(sample_rank(place) * WAVELENGTHS + tree);
    }
}

// Radiance that the body sends to the eye, linear, with an alpha of 1.
@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    if (EFFECT_DISPERSION) {
        var radiance = vec3f(0.0f);
        for (var wavelength = 0u; wavelength < WAVELENGTHS; wavelength++) {
            scene_start_tree(input, wavelength);
            radiance += wavelengths[wavelength].weights * scene_radiance(input, wavelength);
        }
        return vec4f(radiance, 1.0f);
    }
    if (EFFECT_ROUGH) {
        var radiance = vec3f(0.0f);
        for (var tree = 0u; tree < WAVELENGTHS; tree++) {
            scene_start_tree(input, tree);
            radiance += scene_radiance(input, 0u);
        }
        return vec4f(radiance / f32(WAVELENGTHS), 1.0f);
    }
    return vec4f(scene_radiance(input, 0u), 1.0f);
}
