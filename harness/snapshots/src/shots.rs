//! Pictures of a single scene each, and the commands that render them.

use super::files::folder;
use super::sizes::PNG_SIDE;
use lapidary_plan::{Decisions, Effect, Effects, Outside, Quality, Rung};
use lapidary_render::{Curvature, DiffuseOptions, GemOptions, MOST_SAMPLES, Settings};
use lapidary_scene::{SAMPLES, Scene, SceneError};
use std::path::PathBuf;

/// A picture made by a recipe.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// Name of its files.
    pub name: &'static str,
    /// Title in the gallery.
    pub title: &'static str,
    /// Name of the built-in scene.
    pub scene: &'static str,
    /// Name of the rung.
    pub rung: &'static str,
    /// Camera angles in degrees: polar angle from the vertical, and azimuth from +z towards +x;
    /// `None` for the scene's own camera.
    pub from: Option<(f32, f32)>,
    /// Whether the proxy's centre is that of the paper's eq. (4).
    pub paper_centre: bool,
    /// Whether facets' edges inside are smoothed.
    pub footprint: bool,
    /// What light that leaves a stone meets; `None` for the default.
    pub outside: Option<Outside>,
    /// Whether scattering materials are lit by the scene's lights alone.
    pub lights_alone: bool,
    /// Whether their surface also reflects nothing, as in the reference.
    pub matte: bool,
    /// Whether scattering bodies follow the law of a half space and stand in shadows under a named rung too.
    pub with_law: bool,
    /// Factor of radiance before the tone curve.
    pub exposure: f32,
    /// The curvature that spreads the light.
    pub curvature: Curvature,
    /// Width and height of the PNG in pixels.
    pub side: u32,
    /// The quality that chooses rungs by material.
    pub quality: Quality,
    /// Samples along each side of a pixel.
    pub samples: u32,
    /// Description in the gallery; if empty, the scene's own description.
    pub paragraph: &'static str,
}

/// Exposure of pictures lit by a scene's lights alone.
pub(super) const LIGHTS_ALONE: f32 = 1.5;

/// The rung that draws each body by its material and shape, like a command without `--rung`.
pub(super) const BY_MATERIAL: &str = "by-material";

/// All committed pictures of a single scene.
pub const SHOTS: [Shot; 58] = [
    Shot {
        paragraph: "Each body by what its material calls for: a table and a stand that are opaque, a diamond with \
            dispersion and a ruby without, a jade ball by curvature, light that diffuses through a paraffin candle and a veined marble \
            figure, and a chain of clear glass. `./cook plan vitrine --quality best` says why, and what follows: nothing is compiled, bound \
            or run that no body calls for.",
        exposure: 0.3,
        side: 1024,
        quality: Quality::Best,
        ..fine(shot(
            "vitrine",
            "A vitrine: eleven bodies, each by the technique that it calls for",
            "vitrine",
            BY_MATERIAL,
        ))
    },
    shot("ring", "A ring of gold, by a jeweller's light", "ring", BY_MATERIAL),
    Shot {
        paragraph: "The exact stone: each ray inside finds its facet by a map of all 73, to eight hits. The default for closed, convex \
            bodies.",
        ..fine(shot("brilliant_exact", "Round brilliant, diamond", "brilliant", BY_MATERIAL))
    },
    Shot {
        paragraph: "The same stone by proxy geometry, four hits: facets behind are guessed from the one in front, and never looked for. It is \
            cheap, and it is another stone: darker by half, with its lights elsewhere.",
        ..shot("brilliant", "Round brilliant by proxy, diamond", "brilliant", "proxy-4+tracker")
    },
    shot("sapphire", "Round brilliant, sapphire", "sapphire", BY_MATERIAL),
    shot("ruby", "Round brilliant, ruby", "ruby", BY_MATERIAL),
    shot("quartz", "Round brilliant, quartz", "quartz", BY_MATERIAL),
    shot("step_cut", "Step cut, emerald", "step_cut", BY_MATERIAL),
    shot("octahedron", "Octahedron, diamond", "octahedron", BY_MATERIAL),
    shot("prism", "Pentagonal prism, quartz", "prism", BY_MATERIAL),
    fine(shot("prism_chain", "A chain of prisms, one draw call", "prism_chain", BY_MATERIAL)),
    fine(shot("chandelier", "A chandelier, one draw call", "chandelier", BY_MATERIAL)),
    fine(shot("pave_ring", "A band of 200 stones, one draw call", "pave_ring", BY_MATERIAL)),
    shot("bunny_stone", "Bunny, glass", "bunny_stone", BY_MATERIAL),
    Shot {
        paragraph: "As the paper has it: proxy geometry, one internal hit, no dispersion. What is reflected inside comes from the environment \
            along the reflected ray.",
        ..shot("brilliant_paper", "Round brilliant, one internal hit", "brilliant", "proxy-1")
    },
    Shot {
        paragraph: "The paper's dispersion as printed, eq. (10) to (12): direction and sign are right, but its size is the length of the \
            path in whatever unit the model has, and knows nothing of the material.",
        ..shot("brilliant_paper_dispersion", "Round brilliant, the paper's dispersion", "brilliant", "proxy-1+paper")
    },
    Shot {
        paragraph: "The cheapest rung, and what many games ship: exact Fresnel reflection at the surface, and nothing of \
            what goes on inside. Compare it with the exact stone to see what is missing.",
        ..shot("brilliant_surface", "Round brilliant, surface reflection alone", "brilliant", "surface")
    },
    Shot {
        paper_centre: true,
        paragraph: "One internal hit, with the proxy's centre by the paper's eq. (4) instead of the regularised least squares. \
            The facets seen inside differ where the normals of a triangle lie close together: the paper's centre runs off \
            there, and depends on the order of the vertices.",
        ..shot("brilliant_paper_centre", "Round brilliant, the paper's centre", "brilliant", "proxy-1")
    },
    Shot {
        paragraph: "Face-up, every ray inside is tested against all facet planes, to eight hits. What the five pictures of the table beside \
            this one should show.",
        ..face_up("table_exact", "Face-up, exact", "brilliant", "convex-8")
    },
    Shot {
        paragraph: "Face-up by proxy, one hit, the table cut into triangles about its centre: the inside repeats the triangles.",
        ..face_up("table_centre", "Face-up by proxy, the table about its centre", "brilliant", "proxy-1")
    },
    face_up("table_fan", "Face-up by proxy, the table as a fan", "brilliant_fan", "proxy-1"),
    face_up("table_strip", "Face-up by proxy, the table as a strip", "brilliant_strip", "proxy-1"),
    face_up("table_sliver", "Face-up by proxy, the table in slivers", "brilliant_sliver", "proxy-1"),
    face_up("normals_area", "Face-up by proxy, normals averaged by area", "brilliant_area", "proxy-1"),
    face_up("normals_plain", "Face-up by proxy, normals averaged plainly", "brilliant_plain", "proxy-1"),
    shot("brilliant_separate", "Round brilliant by proxy, three separate wavelengths", "brilliant", "proxy-4+3"),
    Shot {
        paragraph: "Each wavelength by a ray of its own: where they meet different facets they part, and edges inside have colours. Trackers \
            keep them together.",
        ..shot("exact_separate", "Round brilliant, exact, three separate wavelengths", "brilliant", "convex-8+3")
    },
    Shot {
        paragraph: "Two rays, one for blue and one for green, from which red is tracked: most of the fire of separate rays, in six tenths of their time.",
        ..shot("exact_split", "Round brilliant, exact, two rays", "brilliant", "walk-8+split")
    },
    Shot {
        samples: 1,
        paragraph: "One sample a pixel, as in real time: seen through facets, the edges of others are finer than pixels, and break up.",
        ..shot("footprint_off", "Round brilliant, one sample a pixel", "brilliant", "walk-8+tracker")
    },
    Shot {
        samples: 1,
        footprint: true,
        paragraph: "The same sample, edges smoothed: each pixel knows the edge next to each hit, and takes what lies beyond from the neighbour that \
            shows it.",
        ..shot("footprint_on", "Round brilliant, one sample a pixel, edges smoothed", "brilliant", "walk-8+tracker")
    },
    Shot {
        paragraph: "What light that leaves a stone meets: a diamond and an emerald on a tray. Most of their light comes from the tray and from \
            what stands on it, and the diamond shows the emerald: here by the triangles of all.",
        ..shot("tray", "Stones on a tray", "tray", "scene-16+3")
    },
    Shot {
        outside: Some(Outside::Bodies),
        paragraph: "The same by the bounds of each body but the stones.",
        ..shot("tray_bodies", "Stones on a tray, by bounds", "tray", BY_MATERIAL)
    },
    Shot {
        outside: Some(Outside::Environment),
        paragraph: "The same with the environment alone: through the tray, the stones show the studio's floor.",
        ..shot("tray_environment", "Stones on a tray, the environment alone", "tray", BY_MATERIAL)
    },
    Shot {
        outside: Some(Outside::Screen),
        paragraph: "The same by the picture: rays that leave are followed over the colour and depth of the bodies that were drawn before.",
        ..shot("tray_screen", "Stones on a tray, by the picture", "tray", BY_MATERIAL)
    },
    Shot {
        paragraph: "A stone in its setting. Facets show the prongs and the band, and not only the studio.",
        ..shot("solitaire", "A diamond on a band", "solitaire", BY_MATERIAL)
    },
    Shot {
        quality: Quality::Fast,
        side: 256,
        paragraph: "Bodies within bodies: water in glass, a straw in the water, which is larger behind it and breaks at its surface, and a candle \
            behind frosted glass.",
        ..shot("tumbler", "A glass of water with a straw, and a candle behind frosted glass", "tumbler", BY_MATERIAL)
    },
    by_lights("skin", "Skin: spheres of falling radius", "skin", "accurate"),
    Shot {
        paragraph: "The same by Lambert's law: the terminator is as sharp on the smallest sphere as on the largest.",
        ..by_lights("skin_lambert", "Skin: spheres by Lambert's law", "skin", "lambert")
    },
    by_lights("wax", "Wax: spheres of falling radius", "wax", "accurate"),
    bright("jade", "Jade: polished spheres of falling radius", "jade", "accurate"),
    bright("skin_ring", "Skin: a ring under a sun and two lamps", "skin_ring", "accurate"),
    bright("wax_ring", "Wax: a ring", "wax_ring", "accurate"),
    bright("jade_ring", "Jade: a polished ring", "jade_ring", "accurate"),
    Shot {
        paragraph: "One mesh five ways, by one light: Lambert's law, a blur in the mesh's texture, the curvature-dependent reflectance, the same \
            with its shadows, and random walks. This is Lambert's law.",
        ..by_lights("skin_bunny_lambert", "Skin: the bunny by Lambert's law", "skin_bunny", "lambert")
    },
    Shot {
        paragraph: "Irradiance drawn into a texture of 1024 texels a side and blurred there by a Gaussian for each channel, with the stretch of \
            the texture taken into account: what the reflectance function replaces.",
        ..by_lights("skin_bunny_blur", "Skin: the bunny by texture diffusion", "skin_bunny", "blur")
    },
    Shot {
        paragraph: "The curvature-dependent reflectance, with the mean curvature of the mesh at its vertices. No texture, no second pass.",
        ..by_lights("skin_bunny", "Skin: the bunny by curvature", "skin_bunny", "accurate")
    },
    Shot {
        with_law: true,
        paragraph: "The same by the drift, with the law of a half space and the shadows of matter that scatters: soft where light spreads into \
            them, and bright where it comes through the ears.",
        ..by_lights("skin_bunny_translucent", "Skin: the bunny by curvature, with its shadows", "skin_bunny", "drift")
    },
    Shot {
        curvature: Curvature::Mean,
        paragraph: "The reflectance alone with curvature from the pixel's derivatives, which need no data and jump from triangle to triangle \
            of a mesh as coarse as this.",
        ..by_lights("skin_bunny_derivatives", "Skin: the bunny by curvature from derivatives", "skin_bunny", "accurate")
    },
    Shot {
        with_law: true,
        paragraph: "Skin by the reflectance of curved surfaces: the drift and width of random walks, the law of a half space, shadows, and the \
            scan's colour and slopes, of which each colour keeps what its light does not even out. The red of the terminator comes of \
            the curvature alone.",
        ..face("head", "Skin: a head by curvature", "drift")
    },
    Shot {
        paragraph: "The same by Lambert's law with shadows: what one would use without any of it. The terminator is grey, and hard.",
        ..face("head_lambert", "Skin: a head by Lambert's law with shadows", "lambert-shadowed")
    },
    Shot {
        paragraph: "The same by a blur of the irradiance in the scan's own texture, which knows no shadows here.",
        ..face("head_blur", "Skin: a head by texture diffusion", "blur")
    },
    stone("bunny", "Marble: the bunny, light from the left"),
    stone("dragon", "Veined jade: the dragon, light from behind"),
    stone("figure", "Marble: a winged figure, light from behind"),
    Shot {
        paragraph: "The same by diffusion: light spreads on from every scattering, and not along the one way that loses least. Against \
            random walks it leaves half of what optical paths leave.",
        ..diffused("bunny_diffusion", "Marble by diffusion: the bunny, light from the left", "bunny")
    },
    diffused("dragon_diffusion", "Veined jade by diffusion: the dragon, light from behind", "dragon"),
    diffused("figure_diffusion", "Marble by diffusion: a winged figure, light from behind", "figure"),
    bright("wax_bunny", "Wax: the bunny", "wax_bunny", "accurate"),
];

const fn shot(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot {
        name,
        title,
        scene,
        rung,
        from: None,
        paper_centre: false,
        footprint: false,
        outside: None,
        lights_alone: false,
        matte: false,
        with_law: false,
        exposure: 1.0,
        curvature: Curvature::Vertex,
        side: PNG_SIDE,
        quality: Quality::Good,
        samples: SAMPLES,
        paragraph: "",
    }
}

/// Returns the shot with the most samples: for pictures that are seen first or consist of edges.
const fn fine(shot: Shot) -> Shot {
    Shot { samples: MOST_SAMPLES, ..shot }
}

/// Returns a shot lit by the scene's lights and the studio, at an exposure of 0.45: the studio is
/// made for stones.
const fn bright(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot { exposure: 0.45, ..shot(name, title, scene, rung) }
}

/// Returns a shot lit by the scene's lights alone, on a surface that reflects nothing: what the
/// references by random walks account for.
const fn by_lights(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot { lights_alone: true, matte: true, exposure: LIGHTS_ALONE, ..shot(name, title, scene, rung) }
}

/// Returns a shot of the head, lit by its lights alone.
const fn face(name: &'static str, title: &'static str, rung: &'static str) -> Shot {
    Shot { lights_alone: true, ..shot(name, title, "head", rung) }
}

/// Returns a shot of light through the body, along optical paths.
const fn stone(name: &'static str, title: &'static str) -> Shot {
    Shot { lights_alone: true, exposure: LIGHTS_ALONE, ..shot(name, title, name, "godunov-128") }
}

/// Returns a shot of light that diffuses through the body.
const fn diffused(name: &'static str, title: &'static str, scene: &'static str) -> Shot {
    Shot { lights_alone: true, exposure: LIGHTS_ALONE, ..shot(name, title, scene, "diffusion-128") }
}

const fn face_up(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot { from: Some((0.0, 0.0)), ..shot(name, title, scene, rung) }
}

impl Shot {
    /// Returns its scene with its camera.
    pub fn open(&self) -> Result<Scene, SceneError> {
        let scene = Scene::named(self.scene)?;
        Ok(self.from.map_or_else(|| scene.clone(), |(polar, azimuth)| scene.seen_from(polar, azimuth)))
    }

    /// Returns its scene, and the settings for a picture of it in its own environment with `side` pixels along each side.
    pub fn drawn(&self, side: u32) -> Result<(Scene, Settings), SceneError> {
        let scene = self.open()?;
        let settings = Settings { environment: scene.environment.make(), ..self.settings(side) };
        Ok((scene, settings))
    }

    /// Returns the settings for a picture in the studio with `side` pixels along each side.
    ///
    /// # Panics
    /// If no rung has its rung's name; the names are compiled in.
    pub fn settings(&self, side: u32) -> Settings {
        let rung = self.rung.parse().unwrap_or_else(|error| panic!("{}: {error}", self.name));
        Settings {
            rung,
            gem: GemOptions {
                paper_centre: self.paper_centre,
                footprint: self.footprint,
                outside: self.outside,
                ..GemOptions::default()
            },
            without: self.without(),
            half_space: self.with_law,
            shadows: self.with_law,
            exposure: self.exposure,
            diffuse: DiffuseOptions { curvature: self.curvature, ..DiffuseOptions::default() },
            samples: self.samples,
            quality: self.quality,
            ..Settings::of_size(side, side)
        }
    }

    /// Returns the effects to leave out even if the scene needs them.
    fn without(&self) -> Effects {
        let environment = if self.lights_alone { Effects::of(&[Effect::Environment]) } else { Effects::NONE };
        environment.and(if self.matte { Effects::SHEEN } else { Effects::NONE })
    }

    /// Returns the names of the effects that the scene needs and the shot leaves out.
    fn left_out(&self) -> Vec<&'static str> {
        let Ok(scene) = self.open() else { return Vec::new() };
        let settings = Settings { without: Effects::NONE, ..self.settings(1) };
        let all: Vec<Decisions> =
            scene.objects.iter().map(|object| Decisions::of(object, &scene, &settings.request())).collect();
        let is_called =
            |effect: &Effect| self.without().has(*effect) && all.iter().any(|decisions| decisions.has(*effect));
        Effect::ALL.into_iter().filter(is_called).map(Effect::name).collect()
    }

    /// Returns the folder of its files.
    pub fn folder(&self) -> PathBuf {
        folder(match self.settings(1).rung {
            Rung::Diffuse(_) => "cdrf",
            Rung::OpticalPath(_) => "optical_path",
            Rung::Diffusion(_) => "diffusion",
            _ => "gem",
        })
    }

    /// Returns the source of the composed recipe that draws it.
    pub fn source(&self) -> String {
        lapidary_wgsl::recipe_source(self.settings(1).rung.recipe())
    }

    /// Returns the command that renders it.
    pub fn command(&self) -> String {
        let centre = if self.paper_centre { " --centre paper" } else { "" };
        let footprint = if self.footprint { " --footprint" } else { "" };
        let outside = self.outside.map_or(String::new(), |outside| format!(" --outside {outside}"));
        let from = self.from.map_or(String::new(), |(polar, azimuth)| format!(" --from {polar},{azimuth}"));
        let left_out = self.left_out();
        let light = if left_out.is_empty() { String::new() } else { format!(" --without {}", left_out.join(",")) };
        let law = if self.with_law { " --with half_space,shadow" } else { "" };
        let curvature = match self.curvature {
            Curvature::Vertex => String::new(),
            other => format!(" --curvature {}", other.name()),
        };
        let exposure = if self.exposure == 1.0 { String::new() } else { format!(" --exposure {}", self.exposure) };
        let samples = if self.samples == SAMPLES { String::new() } else { format!(" --samples {}", self.samples) };
        let rung = if self.rung == BY_MATERIAL { String::new() } else { format!(" --rung {}", self.rung) };
        let quality =
            if self.quality == Quality::default() { String::new() } else { format!(" --quality {}", self.quality) };
        let size = if self.side == PNG_SIDE { String::new() } else { format!(" --size {0}x{0}", self.side) };
        let choices = format!(
            "{quality}{from}{rung}{centre}{footprint}{outside}{law}{light}{curvature}{exposure}{samples}{size}"
        );
        format!("./cook render {}{choices} --out {}.png", self.scene, self.name)
    }
}
