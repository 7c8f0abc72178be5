//! Sizes of what recipes bind and numbers of workgroups, as formulas that are checked against frames.

/// Numbers of a frame that sizes depend on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quantities {
    pub(super) vertices: u64,
    pub(super) triangles: u64,
    /// Triangles beside the charts of an atlas.
    pub(super) halo: u64,
    /// Cells along each edge of the body's grid, or of a level of it.
    pub(super) n: u64,
    /// Views of lights.
    pub(super) views: u64,
    /// Texels along each side of a light's map.
    pub(super) texels: u64,
}

/// How a size is said.
#[derive(Clone, Copy)]
pub(super) enum Rule {
    /// Bytes, by a formula.
    Bytes(&'static str, fn(&Quantities) -> u64),
    /// So many elements, which the data decide.
    Each(&'static str),
    /// A texture, in words.
    Texture(&'static str),
}

/// Names of bindings, the start of the recipes' names, and how their sizes are said; the first row that fits
/// counts.
pub(super) const SIZES: &[(&[&str], &str, Rule)] = &[
    (&["indices"], "texture_irradiance", Rule::Bytes("12 × (triangles + halo)", |q| 12 * (q.triangles + q.halo))),
    (&["positions", "normals", "colors"], "", Rule::Bytes("12 × vertices", |q| 12 * q.vertices)),
    (&["indices"], "", Rule::Bytes("12 × triangles", |q| 12 * q.triangles)),
    (&["uvs"], "", Rule::Bytes("8 × vertices", |q| 8 * q.vertices)),
    (&["curvatures"], "", Rule::Bytes("4 × vertices", |q| 4 * q.vertices)),
    (&["lights"], "", Rule::Each("lights, at least one")),
    (&["views"], "", Rule::Each("views of lights")),
    (&["bodies"], "", Rule::Each("bodies")),
    // Clear stones.
    (&["glints"], "gem", Rule::Each("(1 + lights)")),
    (&["nodes"], "gem_scene", Rule::Each("nodes")),
    (&["scene_bodies"], "gem_scene", Rule::Each("bodies")),
    (&["corners", "corner_normals"], "gem_scene", Rule::Each("corners of all bodies' triangles")),
    (&["triangles"], "gem_scene", Rule::Bytes("4 × triangles", |q| 4 * q.triangles)),
    (&["body_indices"], "gem_scene", Rule::Each("wavelengths × bodies")),
    (&["wavelengths"], "gem", Rule::Each("wavelengths, at least one")),
    (&["instances"], "gem", Rule::Each("copies, at least one")),
    (&["planes"], "gem", Rule::Each("facets")),
    (&["face_of_triangle"], "gem", Rule::Bytes("4 × triangles", |q| 4 * q.triangles)),
    (&["facet_map"], "gem_walk", Rule::Each("words of the map")),
    (&["nodes"], "gem_walk", Rule::Each("nodes")),
    (&["corners"], "gem_walk", Rule::Each("corners of the triangles beside the stone, and one more")),
    (&["nodes"], "gem_bvh", Rule::Each("nodes")),
    (&["nodes"], "trace", Rule::Each("nodes")),
    (&["corners"], "gem_bvh", Rule::Bytes("48 × triangles", |q| 48 * q.triangles)),
    (&["corners"], "trace", Rule::Bytes("48 × triangles", |q| 48 * q.triangles)),
    (&["queries", "hits"], "trace", Rule::Each("rays")),
    // Voxels.
    (&["matter", "surface"], "voxelize", Rule::Bytes("4 × n² × ⌈n / 32⌉", |q| 4 * q.n * q.n * q.n.div_ceil(32))),
    (&["beyond"], "voxelize", Rule::Bytes("4 × ⌈n² / 32⌉", |q| 4 * (q.n * q.n).div_ceil(32))),
    (&["large"], "voxelize", Rule::Bytes("4 × (1 + triangles)", |q| 4 * (1 + q.triangles))),
    (&["corners"], "voxelize", Rule::Bytes("12 × vertices", |q| 12 * q.vertices)),
    // Paths.
    (&["matter"], "optical_path", Rule::Bytes("4 × n² × ⌈n / 32⌉", |q| 4 * q.n * q.n * q.n.div_ceil(32))),
    (&["tiles"], "optical_path_density", Rule::Bytes("4 × (n / 4)³", |q| 4 * tiles(q))),
    (
        &["costs", "costs_red", "costs_green", "costs_blue", "density", "work"],
        "optical_path",
        Rule::Bytes("4 × n³", |q| 4 * cube(q.n)),
    ),
    (&["tile_matter", "lists"], "optical_path_tiles", Rule::Bytes("8 × (n / 4)³", |q| 8 * tiles(q))),
    (&["tile_listed"], "optical_path_tiles", Rule::Bytes("4 × (n / 4)³", |q| 4 * tiles(q))),
    // Diffusion; a level has half as many cells along each edge as the one before.
    (&["tiles"], "diffusion", Rule::Bytes("4 × (n / 4)³", |q| 4 * tiles(q))),
    (&["filled", "nodes", "density"], "diffusion", Rule::Bytes("4 × n³", |q| 4 * cube(q.n))),
    (&["surfaces", "packed"], "diffusion", Rule::Bytes("8 × n³", |q| 8 * cube(q.n))),
    (&["large"], "diffusion", Rule::Bytes("4 × (1 + triangles)", |q| 4 * (1 + q.triangles))),
    (&["faces", "entering", "loads"], "diffusion", Rule::Bytes("12 × n³", |q| 12 * cube(q.n))),
    (&["reactions", "fluence", "right"], "diffusion", Rule::Bytes("16 × n³", |q| 16 * cube(q.n))),
    (&["fine"], "diffusion", Rule::Bytes("n³: a bit for each of (2n)³ voxels", |q| cube(q.n))),
    (&["coarser_faces"], "diffusion", Rule::Bytes("12 × (n / 2)³", |q| 12 * cube(q.n / 2))),
    (
        &["coarser_reactions", "coarser_fluence", "coarser_right"],
        "diffusion",
        Rule::Bytes("16 × (n / 2)³", |q| 16 * cube(q.n / 2)),
    ),
    (&["residuals"], "diffusion", Rule::Bytes("32 × (n / 4)³", |q| 32 * tiles(q))),
    (&["enclosed"], "diffusion", Rule::Each("lights")),
    // What runs outside of frames.
    (&["texels"], "cdrf_table", Rule::Each("texels")),
    (&["texels", "radiance"], "split_sum_tables", Rule::Each("texels")),
    (&["exits"], "random_walk", Rule::Each("walks")),
    (&["row_sums"], "environment_harmonics", Rule::Each("rows of the image × ⌈256 / rows⌉")),
    // Textures.
    (&["environment_map"], "", Rule::Texture("the image")),
    (&["maps"], "", Rule::Texture("texels × texels, a layer for each view; rgba32float")),
    (&["stones"], "", Rule::Texture("texels × texels, a layer for each view; rgba16float")),
    (&["screen_radiance", "screen_depth"], "gem", Rule::Texture("the picture of the other bodies")),
    (&["samples"], "display", Rule::Texture("samples × width, samples × height")),
    (&["irradiance", "stretch", "diffused"], "", Rule::Texture("the atlas")),
    (&["blurred"], "", Rule::Texture("1024 × 512, 7 levels; rgba16float, baked by `split_sum_tables`")),
    (&["metal_table"], "", Rule::Texture("64 × 64; rg16float, baked by `split_sum_tables`")),
    (&["table", "table_texels"], "cdrf", Rule::Texture("baked by `cdrf_table`; 1 × 1 if unused")),
    (
        &["base_color_texture", "normal_texture", "roughness_texture", "thickness_texture", "transmission_texture"],
        "cdrf",
        Rule::Texture("the material's image"),
    ),
    (&["scene_paint"], "gem_scene", Rule::Texture("4096 texels a row, rows as needed; rgba32float")),
    (&["scene_images"], "gem_scene", Rule::Texture("the largest image, a layer for each; rgba16float, all levels")),
    (&["emission", "normal", "reflectance", "depth"], "gem_composite", Rule::Texture("the geometry buffer")),
    (&["radiance", "neighbours"], "gem_resolve", Rule::Texture("the targets of `gem_footprint_fragment`")),
    (&["radiance", "depth"], "screen_copy", Rule::Texture("the picture of the other bodies")),
    (&["densities"], "optical_path_density", Rule::Texture("a density for each cell of the file's grid")),
];

/// A number of workgroups along each axis: its text, and its value.
pub(super) type Workgroups = (&'static str, fn(&Quantities) -> [u64; 3]);

/// Entry points of compute shaders that are dispatched by a number.
pub(super) const WORKGROUPS: &[(&str, Workgroups)] = &[
    ("voxelize_vertices", ("⌈vertices / 64⌉", |q| [q.vertices.div_ceil(64), 1, 1])),
    ("voxelize_triangles", ("⌈triangles / 64⌉", |q| [q.triangles.div_ceil(64), 1, 1])),
    ("voxelize_large", ("64", |_| [64, 1, 1])),
    ("voxelize_finish", ("⌈n² / 64⌉", |q| [(q.n * q.n).div_ceil(64), 1, 1])),
    ("optical_path_density", ("1 × n × n", |q| [1, q.n, q.n])),
    ("optical_path_clear", ("1 × n × n", |q| [1, q.n, q.n])),
    ("optical_path_seed_texel", ("⌈texels / 8⌉ × ⌈texels / 8⌉ × views", texel_groups)),
    ("optical_path_sweep_begin", ("n / 8 × n / 8 × n", |q| [q.n / 8, q.n / 8, q.n])),
    ("optical_path_sweep_next", ("1", |_| [1, 1, 1])),
    ("optical_path_tiles_begin", ("⌈(n / 4)³ / 32⌉", |q| [tiles(q).div_ceil(32), 1, 1])),
    ("optical_path_tiles_next", ("1", |_| [1, 1, 1])),
    ("diffusion_cells_surface", ("⌈triangles / 64⌉", |q| [q.triangles.div_ceil(64), 1, 1])),
    ("diffusion_cells_large", ("32", |_| [32, 1, 1])),
    ("diffusion_cells_fill", ("⌈n³ / 2048⌉", |q| [cube(q.n).div_ceil(2048), 1, 1])),
    ("diffusion_cells_list", ("⌈(n / 4)³ / 64⌉", |q| [tiles(q).div_ceil(64), 1, 1])),
    ("diffusion_solve_stop", ("1", |_| [1, 1, 1])),
    ("diffusion_solve_list", ("⌈(n / 4)³ / 64⌉", |q| [tiles(q).div_ceil(64), 1, 1])),
    ("diffusion_source_texel", ("⌈texels / 8⌉ × ⌈texels / 8⌉ × views", texel_groups)),
];

fn cube(side: u64) -> u64 {
    side * side * side
}

/// Tiles of 4 × 4 × 4 cells.
fn tiles(q: &Quantities) -> u64 {
    cube((q.n / 4).max(1))
}

fn texel_groups(q: &Quantities) -> [u64; 3] {
    [q.texels.div_ceil(8), q.texels.div_ceil(8), q.views]
}

/// Returns how the size of a binding without a fixed one is said.
pub(super) fn rule(recipe: &str, binding: &str) -> Option<Rule> {
    let fits = |(names, start, _): &&(&[&str], &str, Rule)| names.contains(&binding) && recipe.starts_with(start);
    SIZES.iter().find(fits).map(|(_, _, rule)| *rule)
}

/// Returns the number of workgroups of an entry point.
pub(super) fn workgroups(entry: &str) -> Option<Workgroups> {
    WORKGROUPS.iter().find(|(name, _)| *name == entry).map(|(_, workgroups)| *workgroups)
}
