//! The pictures that are committed, and how a new one is compared with them: FLIP on what is seen, RMSE on linear radiance.

pub mod strip;

use crate::gpu::Gpu;
use crate::render::{self, Curvature, Picture, RenderError, Rung, Settings, file};
use crate::scene::{Scene, SceneError};
use std::path::{Path, PathBuf};

/// Side of the PNG that is looked at.
pub const PNG_SIDE: u32 = 512;
/// Side of the EXR that holds linear radiance.
pub const EXR_SIDE: u32 = 256;
/// Largest committed file in bytes.
pub const LARGEST_FILE: u64 = 512 * 1024;
/// Largest mean FLIP. Another driver moves single facet edges by a sample (below 0.001); a turn of 1° gives above 0.02.
pub const MOST_FLIP: f32 = 0.005;
/// Largest RMSE in linear radiance, relative to the reference's root mean square.
pub const MOST_RMSE: f32 = 0.05;

/// A picture of a recipe.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// Its file's name.
    pub name: &'static str,
    /// What the gallery calls it.
    pub title: &'static str,
    /// The built-in scene.
    pub scene: &'static str,
    /// The rung, by its name.
    pub rung: &'static str,
    /// Where it is seen from, in degrees off the vertical and from +z towards +x; the scene's own camera where there is none.
    pub from: Option<(f32, f32)>,
    /// The proxy's centre by the paper's eq. (4).
    pub paper_centre: bool,
    /// What scatters light is lit by the scene's lights alone.
    pub lights_alone: bool,
    /// And its surface reflects nothing, as in the reference.
    pub matte: bool,
    /// Radiance is multiplied by this before the tone curve.
    pub exposure: f32,
    /// Which curvature spreads its light.
    pub curvature: Curvature,
    /// What it shows; where empty, the scene's own description.
    pub paragraph: &'static str,
}

/// The exposure of pictures by a scene's lights alone.
const LIGHTS_ALONE: f32 = 1.5;

/// Every committed picture.
pub const SHOTS: [Shot; 39] = [
    Shot {
        paragraph: "The exact stone: every ray inside is tested against all 73 facet planes, to eight hits. Compare it with the proxy's \
            picture, which takes a small part of the time and never looks at another facet than the one that the ray entered by.",
        ..shot("brilliant_exact", "Round brilliant, diamond", "brilliant", "convex-8+tracker")
    },
    shot("brilliant", "Round brilliant by proxy, diamond", "brilliant", "proxy-4+tracker"),
    shot("sapphire", "Round brilliant, sapphire", "sapphire", "convex-8+tracker"),
    shot("ruby", "Round brilliant, ruby", "ruby", "convex-8+tracker"),
    shot("quartz", "Round brilliant, quartz", "quartz", "proxy-4+tracker"),
    shot("step_cut", "Step cut, emerald", "step_cut", "convex-8+tracker"),
    shot("octahedron", "Octahedron, diamond", "octahedron", "proxy-4+tracker"),
    shot("prism", "Pentagonal prism, quartz", "prism", "proxy-2+tracker"),
    shot("prism_chain", "A chain of prisms, one draw call", "prism_chain", "proxy-2+tracker"),
    shot("chandelier", "A chandelier, one draw call", "chandelier", "proxy-2+tracker"),
    shot("bunny_stone", "Bunny, glass", "bunny_stone", "bvh-8+tracker"),
    Shot {
        paragraph: "As the paper has it: one internal hit, no dispersion. What is reflected inside comes from the environment along \
            the reflected ray.",
        ..shot("brilliant_paper", "Round brilliant, one internal hit", "brilliant", "proxy-1")
    },
    Shot {
        paragraph: "The paper's dispersion as printed, eq. (10) to (12): direction and sign are right, but its size is the length of the \
            path in whatever unit the model has, and knows nothing of the material.",
        ..shot("brilliant_paper_dispersion", "Round brilliant, the paper's dispersion", "brilliant", "proxy-1+paper")
    },
    Shot {
        paragraph: "The cheapest rung, and what many games ship: exact Fresnel reflection at the surface, and nothing of \
            what goes on inside. Compare it with the full stone to see what one internal hit buys.",
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
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        ..shot("skin", "Skin: spheres of falling radius", "skin", "accurate")
    },
    Shot {
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        paragraph: "The same by Lambert's law: the terminator is as sharp on the smallest sphere as on the largest.",
        ..shot("skin_lambert", "Skin: spheres by Lambert's law", "skin", "lambert")
    },
    Shot {
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        ..shot("wax", "Wax: spheres of falling radius", "wax", "accurate")
    },
    bright("jade", "Jade: polished spheres of falling radius", "jade", "accurate"),
    bright("skin_ring", "Skin: a ring under a sun and two lamps", "skin_ring", "accurate"),
    bright("wax_ring", "Wax: a ring", "wax_ring", "accurate"),
    bright("jade_ring", "Jade: a polished ring", "jade_ring", "accurate"),
    Shot {
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        paragraph: "One mesh four ways, by one light: Lambert's law, a blur in the mesh's texture, the curvature-dependent reflectance, and random \
            walks. This is Lambert's law.",
        ..shot("skin_bunny_lambert", "Skin: the bunny by Lambert's law", "skin_bunny", "lambert")
    },
    Shot {
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        paragraph: "Irradiance drawn into a texture of 1024 texels a side and blurred there by a Gaussian for each channel, with the stretch of \
            the texture taken into account: what the reflectance function replaces.",
        ..shot("skin_bunny_blur", "Skin: the bunny by texture diffusion", "skin_bunny", "blur")
    },
    Shot {
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        curvature: Curvature::Vertex,
        paragraph: "The curvature-dependent reflectance, with the mean curvature of the mesh at its vertices. No texture, no second pass.",
        ..shot("skin_bunny", "Skin: the bunny by curvature", "skin_bunny", "accurate")
    },
    Shot {
        lights_alone: true,
        matte: true,
        exposure: LIGHTS_ALONE,
        paragraph: "The same with curvature from the pixel's derivatives, which need no data and jump from triangle to triangle of a mesh as coarse \
            as this.",
        ..shot("skin_bunny_derivatives", "Skin: the bunny by curvature from derivatives", "skin_bunny", "accurate")
    },
    stone("bunny", "Marble: the bunny, light from the left"),
    stone("dragon", "Veined jade: the dragon, light from behind"),
    stone("figure", "Marble: a winged figure, light from behind"),
    Shot { curvature: Curvature::Vertex, ..bright("wax_bunny", "Wax: the bunny", "wax_bunny", "accurate") },
];

const fn shot(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot {
        name,
        title,
        scene,
        rung,
        from: None,
        paper_centre: false,
        lights_alone: false,
        matte: false,
        exposure: 1.0,
        curvature: Curvature::Mean,
        paragraph: "",
    }
}

/// Under the scene's lights and the studio's, which is made for stones: half of that is enough.
const fn bright(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot { exposure: 0.45, ..shot(name, title, scene, rung) }
}

/// Light through the body, along the cheapest ways.
const fn stone(name: &'static str, title: &'static str) -> Shot {
    Shot { lights_alone: true, exposure: LIGHTS_ALONE, ..shot(name, title, name, "godunov-128") }
}

const fn face_up(name: &'static str, title: &'static str, scene: &'static str, rung: &'static str) -> Shot {
    Shot { from: Some((0.0, 0.0)), ..shot(name, title, scene, rung) }
}

impl Shot {
    /// Its scene, with its camera.
    pub fn open(&self) -> Result<Scene, SceneError> {
        let scene = Scene::named(self.scene)?;
        Ok(self.from.map_or_else(|| scene.clone(), |(polar, azimuth)| scene.seen_from(polar, azimuth)))
    }

    /// How to render it at `side` pixels.
    ///
    /// # Panics
    /// Where its rung's name is none: the names are compiled in.
    pub fn settings(&self, side: u32) -> Settings {
        let rung = self.rung.parse().unwrap_or_else(|error| panic!("{}: {error}", self.name));
        Settings {
            rung,
            paper_centre: self.paper_centre,
            light_from_environment: !self.lights_alone,
            reflection: !self.matte,
            exposure: self.exposure,
            curvature: self.curvature,
            ..Settings::of_size(side, side)
        }
    }

    /// Where its pictures are.
    pub fn folder(&self) -> PathBuf {
        folder(match self.settings(1).rung {
            Rung::Diffuse(_) => "cdrf",
            Rung::OpticalPath(_) => "optical_path",
            _ => "gem",
        })
    }

    /// The composed recipe that draws it.
    pub fn source(&self) -> String {
        crate::cookbook::recipe_source(self.settings(1).rung.recipe())
    }

    /// The command that renders it.
    pub fn command(&self) -> String {
        let centre = if self.paper_centre { " --centre paper" } else { "" };
        let from = self.from.map_or(String::new(), |(polar, azimuth)| format!(" --from {polar},{azimuth}"));
        let light = match (self.lights_alone, self.matte) {
            (false, false) => "",
            (true, false) => " --without environment",
            (false, true) => " --without reflection",
            (true, true) => " --without environment,reflection",
        };
        let curvature = match self.curvature {
            Curvature::Mean => String::new(),
            other => format!(" --curvature {}", other.name()),
        };
        let exposure = if self.exposure == 1.0 { String::new() } else { format!(" --exposure {}", self.exposure) };
        let choices = format!("{from} --rung {}{centre}{light}{curvature}{exposure}", self.rung);
        format!("./cook render {}{choices} --out {}.png", self.scene, self.name)
    }
}

/// A committed picture: a file to look at and one of linear radiance.
#[derive(Clone, Copy, Debug)]
pub enum Committed {
    /// Of one scene.
    Shot(&'static Shot),
    /// Of translucent stone in motion.
    Strip,
}

impl Committed {
    /// Every one.
    pub const COUNT: usize = SHOTS.len() + 1;

    /// Each once.
    pub fn all() -> impl Iterator<Item = Self> {
        SHOTS.iter().map(Self::Shot).chain([Self::Strip])
    }

    /// Its files' name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shot(shot) => shot.name,
            Self::Strip => strip::NAME,
        }
    }

    /// Where they are.
    #[must_use]
    pub fn folder(self) -> PathBuf {
        match self {
            Self::Shot(shot) => shot.folder(),
            Self::Strip => folder("optical_path"),
        }
    }

    /// Renders it anew, as its PNG and as its EXR would hold it.
    ///
    /// # Errors
    /// Where its scene does not load, or the device refuses.
    pub fn render(self, gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
        match self {
            Self::Shot(shot) => render_shot(gpu, shot, &shot.source()),
            Self::Strip => strip::render(gpu),
        }
    }
}

/// Where the pictures of a technique's recipes are.
pub fn folder(technique: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../snapshots").join(technique)
}

/// A committed reference by random walks, of a scene by its lights alone.
#[derive(Clone, Copy, Debug)]
pub struct WalkedReference {
    /// Of the scene, and its file's name.
    pub scene: &'static str,
    /// What the gallery calls it.
    pub title: &'static str,
    /// Walks from each pixel.
    pub walks: u32,
}

/// Every one.
pub const WALKED: [WalkedReference; 3] = [
    WalkedReference { scene: "skin", title: "Skin: spheres by random walks", walks: 1024 },
    WalkedReference { scene: "skin_bunny", title: "Skin: the bunny by random walks", walks: 1024 },
    WalkedReference { scene: "skin_ring", title: "Skin: the ring by random walks", walks: 576 },
];

impl WalkedReference {
    /// Where it is kept.
    pub fn file(&self) -> PathBuf {
        folder("cdrf").join("reference").join(format!("{}.exr", self.scene))
    }

    /// The command that makes it again.
    pub fn command(&self) -> String {
        let Self { scene, walks, .. } = self;
        format!(
            "./cook render {scene} --rung reference --size {EXR_SIDE}x{EXR_SIDE} --walks {walks} --without environment \
             --out snapshots/cdrf/reference/{scene}.exr"
        )
    }

    /// As it was followed, and as it is seen.
    pub fn picture(&self, gpu: &Gpu) -> Result<Picture, SnapshotError> {
        let settings = Settings { exposure: LIGHTS_ALONE, ..Settings::of_size(EXR_SIDE, EXR_SIDE) };
        reference_picture(gpu, &self.file(), &settings)
    }
}

/// A committed reference's linear radiance, and as it is seen with the settings' size and exposure.
pub(crate) fn reference_picture(gpu: &Gpu, path: &Path, settings: &Settings) -> Result<Picture, SnapshotError> {
    let (width, height) = (settings.width, settings.height);
    let linear: Vec<[f32; 4]> = read(path, (width, height))?.into_rgba32f().pixels().map(|pixel| pixel.0).collect();
    let encoded = vec![[0; 4]; linear.len()];
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    render::encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Why a snapshot does not hold.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// No reference: it is never made by itself.
    #[error("{}: missing; look at the new picture, then accept it with `./cook snapshots --accept`", .0.display())]
    Missing(PathBuf),
    /// A reference that cannot be decoded.
    #[error("{path}: unreadable: {reason}; restore it from version control")]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// The decoder's word.
        reason: String,
    },
    /// A reference of another size.
    #[error("{path}: is {found:?} pixels, expected {expected:?}; accept a new one with `./cook snapshots --accept`")]
    Size {
        /// Which file.
        path: PathBuf,
        /// Its size.
        found: (u32, u32),
        /// The size rendered.
        expected: (u32, u32),
    },
    /// A file too large to commit.
    #[error("{path}: {bytes} bytes, at most {LARGEST_FILE} are committed")]
    TooLarge {
        /// Which file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// No picture to compare.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// No scene to render.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] file::FileError),
}

/// How far a picture is from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean FLIP of the PNGs, 0 to 1.
    pub flip: f32,
    /// RMSE of linear radiance over the reference's root mean square.
    pub rmse: f32,
}

impl Comparison {
    /// Whether the pictures count as the same.
    pub fn holds(&self) -> bool {
        // A NaN does not hold.
        self.flip <= MOST_FLIP && self.rmse <= MOST_RMSE
    }
}

/// Renders `shot` with `source`, the composed recipe, as PNG and as EXR would hold it.
pub fn render_shot(gpu: &Gpu, shot: &Shot, source: &str) -> Result<[Picture; 2], SnapshotError> {
    render_scene(gpu, shot, &shot.open()?, source)
}

/// The same for another scene in the shot's place.
pub fn render_scene(gpu: &Gpu, shot: &Shot, scene: &Scene, source: &str) -> Result<[Picture; 2], SnapshotError> {
    let render = |side| render::render_with(gpu, scene, &shot.settings(side), source, &mut |_, _| {});
    Ok([render(PNG_SIDE)?, render(EXR_SIDE)?])
}

/// Compares new pictures with the references called `name` in `folder`. Where they differ too much, the new PNG and a picture of the
/// difference are left beside the reference, as `<name>.new.png` and `<name>.difference.png`.
pub fn compare(name: &str, [seen, linear]: &[Picture; 2], folder: &Path) -> Result<Comparison, SnapshotError> {
    let png = folder.join(format!("{name}.png"));
    let exr = folder.join(format!("{name}.exr"));
    let reference = read(&png, (seen.width, seen.height))?.into_rgb8();
    let reference_linear = read(&exr, (linear.width, linear.height))?.into_rgba32f();
    let map = flip_map(seen, reference.as_raw());
    let comparison = Comparison {
        flip: nv_flip::FlipPool::from_image(&map).mean(),
        rmse: relative_rmse(&linear.linear, reference_linear.as_raw()),
    };
    let beside = ["new", "difference"].map(|kind| folder.join(format!("{name}.{kind}.png")));
    if comparison.holds() {
        // What an earlier failure left is out of date.
        for path in beside {
            let _ = std::fs::remove_file(path);
        }
    } else {
        file::write(seen, &beside[0])?;
        let colored = map.apply_color_lut(&nv_flip::magma_lut()).to_vec();
        let pixels: Vec<[u8; 4]> = colored.chunks_exact(3).map(|c| [c[0], c[1], c[2], 255]).collect();
        let encode = |reason| file::FileError::Encode { path: beside[1].clone(), reason };
        let bytes = file::png(seen.width, seen.height, &pixels).map_err(encode)?;
        file::replace(&beside[1], &bytes)?;
    }
    Ok(comparison)
}

/// FLIP of what is seen, against `reference`, RGB of the same size.
fn flip_map(seen: &Picture, reference: &[u8]) -> nv_flip::FlipImageFloat {
    let image = |data: &[u8]| nv_flip::FlipImageRgb8::with_data(seen.width, seen.height, data);
    nv_flip::flip(image(reference), image(&rgb(seen)), nv_flip::DEFAULT_PIXELS_PER_DEGREE)
}

fn rgb(picture: &Picture) -> Vec<u8> {
    picture.encoded.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

/// FLIP of each pixel of two pictures of one size, row by row.
pub(crate) fn flip(picture: &Picture, reference: &Picture) -> Vec<f32> {
    flip_map(picture, &rgb(reference)).to_vec()
}

/// Makes new pictures the references called `name`.
pub fn accept(name: &str, [seen, linear]: &[Picture; 2], folder: &Path) -> Result<(), SnapshotError> {
    std::fs::create_dir_all(folder).map_err(|error| file::FileError::Write { path: folder.to_owned(), error })?;
    for (picture, extension) in [(seen, "png"), (linear, "exr")] {
        let path = folder.join(format!("{name}.{extension}"));
        file::write(picture, &path)?;
        let bytes = std::fs::metadata(&path).map_or(0, |metadata| metadata.len());
        if bytes > LARGEST_FILE {
            return Err(SnapshotError::TooLarge { path, bytes });
        }
    }
    Ok(())
}

pub(crate) fn read(path: &Path, expected: (u32, u32)) -> Result<image::DynamicImage, SnapshotError> {
    if !path.exists() {
        return Err(SnapshotError::Missing(path.to_owned()));
    }
    let image = image::open(path)
        .map_err(|error| SnapshotError::Unreadable { path: path.to_owned(), reason: error.to_string() })?;
    let found = (image.width(), image.height());
    if found != expected {
        return Err(SnapshotError::Size { path: path.to_owned(), found, expected });
    }
    Ok(image)
}

fn relative_rmse(new: &[[f32; 4]], reference: &[f32]) -> f32 {
    let (mut error, mut power) = (0.0, 0.0);
    for (new, reference) in new.iter().flatten().zip(reference) {
        error += f64::from(new - reference).powi(2);
        power += f64::from(*reference).powi(2);
    }
    (error / power).sqrt() as f32
}
