//! The techniques: what each is in plain words, and which parts of the cookbook belong to it.

/// A technique, as the gallery presents it.
#[derive(Clone, Copy, Debug)]
pub struct Technique {
    /// Name of its page.
    pub name: &'static str,
    /// Title.
    pub title: &'static str,
    /// What it is, in plain words.
    pub summary: &'static str,
    /// Its doc page in `docs/`.
    pub doc: &'static str,
    /// The committed picture that stands for it.
    pub hero: &'static str,
    /// Folder of its committed pictures.
    pub pictures: &'static str,
    /// Names of its ladders.
    pub ladders: &'static [&'static str],
    /// Guides that say which of its rungs to choose.
    pub guides: &'static [&'static str],
    /// Modules that hold its mathematics, those most its own first.
    pub modules: &'static [&'static str],
    /// Recipes that draw it, the one to take first.
    pub recipes: &'static [&'static str],
    /// The function that says most of how it works.
    pub function: &'static str,
    /// Whether other recipes run before the one that draws.
    pub solves: bool,
    /// The scene of its live page.
    pub live: &'static str,
    /// Name of the technique to take instead, and when: the beginning of a sentence.
    pub beside: Option<(&'static str, &'static str)>,
}

/// All techniques, in the order of the gallery.
pub const TECHNIQUES: [Technique; 4] = [
    Technique {
        name: "gems",
        title: "Clear stones",
        summary: "A diamond shows the room around it, folded by its facets and split into colours. Each ray inside finds its next facet \
            exactly, in a few steps over a map of the facets, and every bounce adds what it lets out.",
        doc: "gem",
        hero: "brilliant_exact",
        pictures: "gem",
        ladders: &["convex", "concave"],
        guides: &["gem_ladder", "gem_proxy"],
        modules: &[
            "refraction",
            "fresnel",
            "convex_walk",
            "convex_trace",
            "bvh_trace",
            "proxy_geometry",
            "closest_point",
            "dispersion",
            "absorption",
            "environment",
            "ray_footprint",
            "screen_trace",
            "bounds_trace",
            "curved_triangle",
        ],
        recipes: &["gem_walk", "gem_convex", "gem_bvh", "gem", "gem_composite", "gem_resolve"],
        function: "refraction_refract",
        solves: false,
        live: "brilliant",
        beside: None,
    },
    Technique {
        name: "curvature",
        title: "Skin, wax and jade by curvature",
        summary: "Light enters skin, spreads, and leaves a little further on: shadows soften and turn red. Where a surface is curved, one \
            look at its curvature says how far, without a blur and without a second pass.",
        doc: "cdrf_shading",
        hero: "head",
        pictures: "cdrf",
        ladders: &["cdrf"],
        guides: &["cdrf_ladder"],
        modules: &["cdrf", "curvature", "half_space", "microfacet", "texture_diffusion", "random_walk"],
        recipes: &["cdrf_shading", "cdrf_table", "texture_irradiance", "blur_texture"],
        function: "cdrf_drift",
        solves: false,
        live: "skin_ring",
        beside: Some((
            "diffusion",
            "This technique draws bodies that let little light through. For jade, marble, wax or ears with the light behind them,",
        )),
    },
    Technique {
        name: "optical-path",
        title: "Light through stone, by the cheapest path",
        summary: "Light reaches the far side of a thin body by the way on which it loses least. A solver finds that way to every voxel, in \
            every frame, so the body, the lights and the eye may all move.",
        doc: "optical_path_shading",
        hero: "bunny",
        pictures: "optical_path",
        ladders: &["optical_path"],
        guides: &["optical_path_ladder"],
        modules: &["optical_path", "voxelization", "reflective_shadow_map", "veins", "microfacet", "half_space"],
        recipes: &[
            "optical_path_shading",
            "voxelize",
            "draw_light_map",
            "optical_path_seed",
            "optical_path_density",
            "optical_path_sweep",
            "optical_path_tiles",
        ],
        function: "optical_path_godunov",
        solves: true,
        live: "bunny",
        beside: None,
    },
    Technique {
        name: "diffusion",
        title: "Light through stone, by diffusion",
        summary: "In marble, wax and milk light has been scattered so often that it spreads like heat. Solved on a grid inside the body, with \
            an exact law for what the grid misses at the surface, it halves the distance from random walks.",
        doc: "diffusion",
        hero: "dragon_diffusion",
        pictures: "diffusion",
        ladders: &["translucent"],
        guides: &[],
        modules: &["diffusion", "half_space", "voxelization", "reflective_shadow_map", "random_walk", "veins"],
        recipes: &[
            "diffusion_shading",
            "diffusion_cells",
            "diffusion_source",
            "diffusion_solve",
            "voxelize",
            "draw_light_map",
        ],
        function: "diffusion_local",
        solves: true,
        live: "dragon",
        beside: Some((
            "curvature",
            "This technique draws bodies with the light behind them. For skin, wax or jade that lets little light through,",
        )),
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_cookbook as cookbook;
    use lapidary_snapshots::Committed;
    use std::collections::BTreeSet;

    #[test]
    fn what_a_technique_names_is_there() {
        for technique in &TECHNIQUES {
            assert!(technique.modules.iter().all(|name| cookbook::module(name).is_some()), "{}", technique.name);
            assert!(technique.recipes.iter().all(|name| lapidary_wgsl::recipe(name).is_some()), "{}", technique.name);
            assert!(Committed::all().any(|picture| picture.name() == technique.hero), "{}", technique.hero);
            let function =
                |name: &&str| cookbook::module(name).is_some_and(|found| found.function(technique.function).is_some());
            assert!(technique.modules.iter().any(function), "{}", technique.function);
            let beside = technique.beside.iter().all(|(name, _)| TECHNIQUES.iter().any(|other| other.name == *name));
            assert!(beside, "{}: another technique", technique.name);
        }
    }

    #[test]
    fn every_folder_of_pictures_belongs_to_a_technique() {
        let folders: BTreeSet<String> = Committed::all()
            .filter_map(|picture| Some(picture.folder().file_name()?.to_string_lossy().into_owned()))
            .collect();
        assert!(
            folders.iter().all(|folder| TECHNIQUES.iter().any(|technique| technique.pictures == folder)),
            "{folders:?}"
        );
    }
}
