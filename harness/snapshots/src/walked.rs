//! Committed references by random walks.

use super::error::SnapshotError;
use super::files::{folder, reference_picture};
use super::shots::LIGHTS_ALONE;
use super::sizes::EXR_SIDE;
use lapidary_gpu::Gpu;
use lapidary_reference::random_walk::mesh::{Boundary, Origin};
use lapidary_render::{Picture, Settings};
use std::path::PathBuf;

/// A committed reference by random walks, of a scene lit by its own lights alone.
#[derive(Clone, Copy, Debug)]
pub struct WalkedReference {
    /// Name of the scene.
    pub scene: &'static str,
    /// Title in the gallery.
    pub title: &'static str,
    /// The technique whose recipes it is a reference for.
    pub technique: &'static str,
    /// Walks per pixel.
    pub walks: u32,
    /// Starting point of the walks.
    pub origin: Origin,
    /// Effect of surfaces on the walks.
    pub boundary: Boundary,
}

/// All references by random walks.
pub const WALKED: [WalkedReference; 11] = [
    skin("skin", "Skin: spheres by random walks", 1024),
    skin("skin_bunny", "Skin: the bunny by random walks", 1024),
    skin("skin_ring", "Skin: the ring by random walks", 576),
    skin("skin_head", "Skin: a head by random walks", 1024),
    stone("bunny", "Marble: the bunny by random walks", 4096),
    stone("dragon", "Veined jade: the dragon by random walks", 4096),
    stone("figure", "Marble: the figure by random walks", 4900),
    stone("wax_bunny", "Wax: the bunny by random walks", 4096),
    behind_boundary("skin", "Skin: spheres by random walks through a surface that refracts", 1296),
    behind_boundary("skin_bunny", "Skin: the bunny by random walks through a surface that refracts", 1936),
    behind_boundary("skin_ring", "Skin: the ring by random walks through a surface that refracts", 1024),
];

const fn skin(scene: &'static str, title: &'static str, walks: u32) -> WalkedReference {
    WalkedReference { scene, title, technique: "cdrf", walks, origin: Origin::Eye, boundary: Boundary::Matched }
}

const fn stone(scene: &'static str, title: &'static str, walks: u32) -> WalkedReference {
    let (origin, boundary) = (Origin::Lights, Boundary::Matched);
    WalkedReference { scene, title, technique: "optical_path", walks, origin, boundary }
}

const fn behind_boundary(scene: &'static str, title: &'static str, walks: u32) -> WalkedReference {
    let (origin, boundary) = (Origin::Lights, Boundary::Dielectric);
    WalkedReference { scene, title, technique: "cdrf", walks, origin, boundary }
}

impl WalkedReference {
    /// Returns the references of a technique's recipes through matched surfaces.
    pub fn of(technique: &str) -> impl Iterator<Item = &'static Self> {
        WALKED
            .iter()
            .filter(move |reference| reference.technique == technique && reference.boundary == Boundary::Matched)
    }

    /// Returns the reference of a scene through matched surfaces; `None` if it has none.
    pub fn of_scene(scene: &str) -> Option<&'static Self> {
        WALKED.iter().find(|reference| reference.scene == scene && reference.boundary == Boundary::Matched)
    }

    /// Returns the reference of a scene through surfaces that refract; `None` if it has none.
    pub fn behind_boundary(scene: &str) -> Option<&'static Self> {
        WALKED.iter().find(|reference| reference.scene == scene && reference.boundary == Boundary::Dielectric)
    }

    /// Returns the name of its file.
    pub fn name(&self) -> String {
        match self.boundary {
            Boundary::Matched => self.scene.to_owned(),
            Boundary::Dielectric => format!("{}_dielectric", self.scene),
        }
    }

    /// Returns the path of its file.
    pub fn file(&self) -> PathBuf {
        folder(self.technique).join("reference").join(format!("{}.exr", self.name()))
    }

    /// Returns the command that remakes it.
    pub fn command(&self) -> String {
        let Self { scene, technique, walks, origin, .. } = self;
        let (name, boundary) = match self.boundary {
            Boundary::Matched => (self.name(), ""),
            Boundary::Dielectric => (self.name(), " --boundary dielectric"),
        };
        let origin = match origin {
            Origin::Eye => String::new(),
            other => format!(" --walks-from {}", other.name()),
        };
        format!(
            "./cook render {scene} --rung reference --size {EXR_SIDE}x{EXR_SIDE} --walks {walks}{origin}{boundary} --without environment \
             --out snapshots/{technique}/reference/{name}.exr"
        )
    }

    /// Reads the picture, both linear and encoded for display.
    pub fn picture(&self, gpu: &Gpu) -> Result<Picture, SnapshotError> {
        let settings = Settings { exposure: LIGHTS_ALONE, ..Settings::of_size(EXR_SIDE, EXR_SIDE) };
        reference_picture(gpu, &self.file(), &settings)
    }
}
