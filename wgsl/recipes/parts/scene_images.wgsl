// scene_images: what the images of a scene's bodies, and the colours of their vertices, hold where rays meet them.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Khronos Group, glTF 2.0, sections 3.8 and 3.9; own.
//
// Rays meet bodies in any order, so that all images are layers of one texture, looked up without a sampler.
//
// A recipe adds: the bindings `corners` and the part texture_tangents.

// The base colour varies over a body. Called for by a material's baseColorTexture.
override EFFECT_BASE_COLOR_TEXTURE: bool = false;
// A body has slopes too fine for its mesh. Called for by a material's normalTexture.
override EFFECT_NORMAL_TEXTURE: bool = false;
// The share of light that enters varies over a clear body. Called for by a material's transmissionTexture.
override EFFECT_TRANSMISSION_TEXTURE: bool = false;
// The base colour varies from vertex to vertex. Called for by a mesh's COLOR_0.
override EFFECT_VERTEX_COLOR: bool = false;

// Values of SceneImage.wrap for each axis: u in the lower two bits, v above.
const SCENE_REPEAT = 0u;
const SCENE_MIRROR = 1u;

// Rows of texels, one after another. The first holds the number of the first corner's texel and the angle
// between the rays of neighbouring samples. Then come the images of each body that has any, nine texels: base
// colour, normal and transmission. Then each corner has two: its texture coordinates and the first texel of its body's
// images, 0 for none; and its colour, linear RGB.
@group(0) @binding(19) var scene_paint: texture_2d<f32>;
// A layer for each image, from its upper left corner on: linear RGBA, or a normal's slopes along u and against v.
@group(0) @binding(20) var scene_images: texture_2d_array<f32>;

fn scene_paint_at(place: u32) -> vec4f {
    let width = textureDimensions(scene_paint).x;
    return textureLoad(scene_paint, vec2u(place % width, place / width), 0);
}

// An image of a body.
struct SceneImage {
    // Rows of the map from the mesh's texture coordinates: KHR_texture_transform.
    u: vec3f,
    v: vec3f,
    // Below 0 if there is no image.
    layer: i32,
    wrap: u32,
    size: vec2u,
    // Share of what is behind that alpha 1 covers, below 0 if it covers all whatever its alpha; and the share from
    // which on it covers all, below 0 to mix.
    share: f32,
    cutoff: f32,
}

fn scene_image(place: u32) -> SceneImage {
    let u = scene_paint_at(place);
    let v = scene_paint_at(place + 1u);
    let rest = scene_paint_at(place + 2u);
    return SceneImage(u.xyz, v.xyz, i32(u.w), u32(v.w), vec2u(rest.xy), rest.z, rest.w);
}

// Where a ray meets a triangle of a body with images.
struct ScenePlace {
    // First texel of the body's images.
    images: u32,
    // Texture coordinates, and how they change along the first two edges.
    uv: vec2f,
    uv_b: vec2f,
    uv_c: vec2f,
    // These edges.
    edge_b: vec3f,
    edge_c: vec3f,
    // How far apart the rays of neighbouring samples meet the body.
    footprint: f32,
    // Of the vertices, linear RGB.
    color: vec3f,
}

// Reads a place by the weights of the second and the third corner.
fn scene_place(triangle: u32, barycentrics: vec2f, way: f32) -> ScenePlace {
    let head = scene_paint_at(0u);
    let first = u32(head.x) + 6u * triangle;
    let a = scene_paint_at(first);
    let b = scene_paint_at(first + 2u).xy - a.xy;
    let c = scene_paint_at(first + 4u).xy - a.xy;
    var place = ScenePlace();
    place.images = u32(a.z);
    place.uv = a.xy + barycentrics.x * b + barycentrics.y * c;
    place.uv_b = b;
    place.uv_c = c;
    let corner = corners[3u * triangle].xyz;
    place.edge_b = corners[3u * triangle + 1u].xyz - corner;
    place.edge_c = corners[3u * triangle + 2u].xyz - corner;
    place.footprint = head.y * way;
    place.color = (1.0f - barycentrics.x - barycentrics.y) * scene_paint_at(first + 1u).xyz
        + barycentrics.x * scene_paint_at(first + 3u).xyz
        + barycentrics.y * scene_paint_at(first + 5u).xyz;
    return place;
}

// The texels on both sides of a coordinate in units of the image's side, and in z the share of the second.
fn scene_texels(coordinate: f32, side: u32, wrap: u32) -> vec3f {
    let size = f32(side);
    var within = clamp(coordinate, 0.0f, 1.0f);
    if (wrap == SCENE_REPEAT) {
        within = fract(coordinate);
    }
    if (wrap == SCENE_MIRROR) {
        within = coordinate - 2.0f * floor(0.5f * coordinate);
    }
    let place = within * size - 0.5f;
    let first = floor(place);
    var texels = clamp(vec2f(first, first + 1.0f), vec2f(0.0f), vec2f(size - 1.0f));
    // They are at most one beyond either end.
    if (wrap == SCENE_REPEAT) {
        texels = vec2f(select(first, size - 1.0f, first < 0.0f), select(first + 1.0f, 0.0f, first + 1.0f >= size));
    }
    if (wrap == SCENE_MIRROR) {
        let beside = vec2f(max(first, 0.0f), first + 1.0f);
        let back = 2.0f * size - 1.0f - beside;
        texels = select(beside, back, beside >= vec2f(size));
    }
    return vec3f(clamp(texels, vec2f(0.0f), vec2f(size - 1.0f)), place - first);
}

// An image at a place: between four texels of the level whose texels are about as wide as the footprint.
fn scene_texel(image: SceneImage, place: ScenePlace) -> vec4f {
    let along = cross(place.edge_b, place.edge_c);
    let turned = place.uv_b.x * place.uv_c.y - place.uv_b.y * place.uv_c.x;
    let scaled = image.u.x * image.v.y - image.u.y * image.v.x;
    let texels = abs(turned * scaled) * f32(image.size.x) * f32(image.size.y);
    let squared = texels / max(length(along), 1e-30f) * place.footprint * place.footprint;
    let last = f32(firstLeadingBit(max(image.size.x, image.size.y)));
    let level = u32(clamp(0.5f * log2(max(squared, 1e-30f)) + 0.5f, 0.0f, last));
    let size = max(image.size >> vec2u(level), vec2u(1u));
    let column = scene_texels(dot(image.u, vec3f(place.uv, 1.0f)), size.x, image.wrap & 3u);
    let row = scene_texels(dot(image.v, vec3f(place.uv, 1.0f)), size.y, image.wrap >> 2u);
    let a = textureLoad(scene_images, vec2u(vec2f(column.x, row.x)), image.layer, level);
    let b = textureLoad(scene_images, vec2u(vec2f(column.y, row.x)), image.layer, level);
    let c = textureLoad(scene_images, vec2u(vec2f(column.x, row.y)), image.layer, level);
    let d = textureLoad(scene_images, vec2u(vec2f(column.y, row.y)), image.layer, level);
    return mix(mix(a, b, column.z), mix(c, d, column.z), row.z);
}

// Factor of the base colour in RGB; in w the share of what is behind that an opaque body covers, below 0 if no
// image says so.
fn scene_image_color(place: ScenePlace) -> vec4f {
    if (place.images == 0u) {
        return vec4f(1.0f, 1.0f, 1.0f, -1.0f);
    }
    let image = scene_image(place.images);
    if (image.layer < 0) {
        return vec4f(1.0f, 1.0f, 1.0f, -1.0f);
    }
    let texel = scene_texel(image, place);
    if (image.share < 0.0f) {
        return vec4f(texel.rgb, -1.0f);
    }
    let share = image.share * texel.a;
    return vec4f(texel.rgb, select(share, select(0.0f, 1.0f, share >= image.cutoff), image.cutoff >= 0.0f));
}

// Factor of the share of light that enters.
fn scene_image_transmission(place: ScenePlace) -> f32 {
    if (place.images == 0u) {
        return 1.0f;
    }
    let image = scene_image(place.images + 6u);
    if (image.layer < 0) {
        return 1.0f;
    }
    return scene_texel(image, place).r;
}

// An outward unit normal with the slopes of the body's image.
fn scene_image_normal(place: ScenePlace, normal: vec3f) -> vec3f {
    if (place.images == 0u) {
        return normal;
    }
    let image = scene_image(place.images + 3u);
    if (image.layer < 0) {
        return normal;
    }
    let slopes = scene_texel(image, place).xy;
    let uv_b = vec2f(dot(image.u.xy, place.uv_b), dot(image.v.xy, place.uv_b));
    let uv_c = vec2f(dot(image.u.xy, place.uv_c), dot(image.v.xy, place.uv_c));
    let tangents = texture_tangents(normal, place.edge_b, place.edge_c, uv_b, uv_c);
    let up = sqrt(max(1.0f - dot(slopes, slopes), 0.0f));
    return normalize(slopes.x * tangents.u - slopes.y * tangents.v + max(up, 1e-3f) * normal);
}
