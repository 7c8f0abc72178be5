//! What a file may contain and what of it is supported: sizes, coordinates and extensions.

/// Maximum size of a file, and of all buffers of a file together: 1 GiB.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Maximum number of triangles in a scene, counting every instance: 2²⁴; three times as many
/// vertices are allowed. Such a scene takes 0.4 GB with shared vertices, 1.4 GB without, and 1.8 GB
/// if unshared vertices have texture coordinates; colours as well would exceed
/// [`MAX_SCENE_BYTES`].
pub const MAX_TRIANGLES: u64 = 1 << 24;

/// Maximum memory for all decoded images of a scene: 512 MiB, two of 8192 x 8192 texels.
pub const MAX_IMAGE_BYTES: u64 = 1 << 29;

/// Maximum memory for all bodies of a scene, counting every instance: 2 GiB. The file, its
/// buffers and its images come on top.
pub const MAX_SCENE_BYTES: u64 = 1 << 31;

/// Maximum number of bodies in a scene: 2¹⁶. The `EXT_mesh_gpu_instancing` instances of a primitive
/// form one body, or a few if they are large.
pub const MAX_OBJECTS: u64 = 1 << 16;

/// Largest world coordinate. Two edges within it are at most 2√3·10⁹ long, so the square of their
/// cross product, the largest number that the shaders compute from them, is below 1.5·10³⁸ and fits
/// in an f32.
pub const MAX_COORDINATE: f32 = 1e9;

/// Supported extensions.
pub const KNOWN_EXTENSIONS: [&str; 16] = [
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_lights_punctual",
    "EXT_mesh_gpu_instancing",
    "KHR_texture_transform",
    "WEBGI_materials_diamond",
    "KHR_mesh_quantization",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_draco_mesh_compression",
    "EXT_texture_webp",
    "KHR_texture_basisu",
];

/// Extensions of materials that are known and not drawn, and what is drawn instead.
pub(super) const NOT_DRAWN: [(&str, &str); 7] = [
    ("KHR_materials_anisotropy", "highlights are round"),
    ("KHR_materials_clearcoat", "the surface below is drawn alone"),
    ("KHR_materials_emissive_strength", "nothing shines by itself"),
    ("KHR_materials_iridescence", "the surface is drawn without its film"),
    ("KHR_materials_sheen", "the surface below is drawn alone"),
    ("KHR_materials_specular", "reflection follows the index of refraction alone"),
    ("KHR_materials_unlit", "lights and shadows fall on it"),
];
