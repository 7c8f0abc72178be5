//! The rungs of the ladder: how exactly light is followed.

use lapidary_files::nearest;
use lapidary_scene::solver::{Diffusion, NoSolver, Paths, Reflectance, Solver};
use std::fmt;
use std::str::FromStr;

/// A step of the ladder from cheap to exact: geometry, number of hits, and treatment of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rung {
    /// A rung for each object, chosen by its material: [`crate`].
    ByMaterial,
    /// Reflection at the surface alone (the paper's Fig. 2).
    Surface,
    /// Light through the stone, by one of the gem recipes.
    Inside {
        /// How a ray inside finds the stone's surface.
        geometry: Geometry,
        /// Number of internal hits; 0 looks up the environment along the refracted ray.
        hits: u32,
        /// How dispersion is computed.
        spectrum: Spectrum,
    },
    /// Subsurface scattering, by a model of the surface's reflectance.
    Diffuse(Reflectance),
    /// Light along the cheapest paths through a body, on voxels.
    OpticalPath(Paths),
    /// Diffusion of light through a body, on a grid.
    Diffusion(Diffusion),
    /// The reference, on the CPU in f64: spectral for clear stones, random walks for scattering
    /// bodies.
    Reference,
}

/// How a ray finds the next facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// An estimate from the triangle through which the ray entered (the paper).
    Proxy,
    /// All facet planes of a convex stone, one after another (the paper's Fig. 7).
    Convex,
    /// A few facet planes of a convex stone, by a map of its facets by direction: the same hits.
    Walk,
    /// All triangles, one after another (the paper's comparison).
    Triangles,
    /// A bounding volume hierarchy of the triangles.
    Bvh,
    /// A bounding volume hierarchy of the triangles of all bodies: light goes from one to another.
    Scene,
}

/// How the wavelength dependence of the refractive index is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spectrum {
    /// No dispersion: a single index.
    One,
    /// The paper's tracker, eq. (10) to (12).
    Paper,
    /// The exact first-order tracker.
    Tracker,
    /// A ray for blue and one for green, from which red is tracked.
    Split,
    /// The given number of wavelengths, each with a ray of its own; 3 stands for the colour
    /// channels.
    Separate(u32),
}

/// Maximum number of internal hits.
pub const MOST_HITS: u32 = 64;
/// Maximum number of wavelengths.
pub const MOST_WAVELENGTHS: u32 = 61;
/// The rungs suggested when a name is not understood, from cheap to exact.
pub const NAMES: [&str; 41] = [
    "by-material",
    "surface",
    "proxy-0",
    "proxy-1",
    "proxy-1+paper",
    "proxy-1+tracker",
    "proxy-1+3",
    "proxy-2",
    "proxy-4",
    "proxy-8",
    "walk-8",
    "walk-8+tracker",
    "walk-8+split",
    "convex-1",
    "convex-8",
    "convex-8+tracker",
    "convex-8+31",
    "triangles-1",
    "bvh-8",
    "scene-16",
    "scene-16+3",
    "lambert",
    "lambert-shadowed",
    "wrap",
    "table-256-rgba8",
    "table-257-rgba16f",
    "table-257-r32f",
    "cheap",
    "accurate",
    "quadrature",
    "spherical",
    "power",
    "drift",
    "blur",
    "paper-64",
    "ping-pong-26-64",
    "tiled-26-64",
    "godunov-64",
    "diffusion-64",
    "diffusion-limited-64",
    "reference",
];
/// The grammar of rung names, for messages and help.
pub const GRAMMAR: &str = "for clear stones surface, (proxy|walk|convex|triangles|bvh)-HITS[+paper|+tracker|+split|+WAVELENGTHS], such as \
     convex-8+31, or scene-HITS[+WAVELENGTHS], such as scene-16; for what scatters light lambert, lambert-shadowed, wrap, table-256-rgba8, table-257-rgba16f, table-257-r32f, cheap, accurate, \
     quadrature, spherical, power, drift, blur, or diffusion[-limited]-CELLS with 16 to 128 cells, such as diffusion-64, or \
     (paper|ping-pong-NEIGHBOURS|tiled-NEIGHBOURS|godunov)-CELLS with 6, 18 or 26 neighbours and 16 to 256 cells, such as godunov-64; \
     for both reference";

const GEOMETRIES: [(&str, Geometry); 6] = [
    ("proxy", Geometry::Proxy),
    ("convex", Geometry::Convex),
    ("walk", Geometry::Walk),
    ("triangles", Geometry::Triangles),
    ("bvh", Geometry::Bvh),
    ("scene", Geometry::Scene),
];

impl Rung {
    /// The paper's rung: the proxy, one internal hit, no dispersion.
    pub const PAPER: Self = Self::Inside { geometry: Geometry::Proxy, hits: 1, spectrum: Spectrum::One };

    /// Returns the name of the recipe that draws the rung; for `ByMaterial`, the one for clear
    /// stones.
    pub fn recipe(self) -> &'static str {
        match self {
            Self::Inside { geometry: Geometry::Convex, .. } => "gem_convex",
            Self::Inside { geometry: Geometry::Walk, .. } => "gem_walk",
            Self::Inside { geometry: Geometry::Bvh | Geometry::Triangles, .. } => "gem_bvh",
            Self::Inside { geometry: Geometry::Scene, .. } => "gem_scene",
            Self::Diffuse(_) => "cdrf_shading",
            Self::OpticalPath(_) => "optical_path_shading",
            Self::Diffusion(_) => "diffusion_shading",
            Self::ByMaterial | Self::Surface | Self::Reference | Self::Inside { geometry: Geometry::Proxy, .. } => {
                "gem"
            }
        }
    }

    /// Whether the rung is for clear stones only; it would draw any other body as if it were one.
    pub fn is_for_clear_stones(self) -> bool {
        matches!(self, Self::Inside { .. } | Self::Surface)
    }

    /// Whether light goes from one body to another.
    pub fn is_among(self) -> bool {
        matches!(self, Self::Inside { geometry: Geometry::Scene, .. })
    }

    /// Whether the rung draws a material's images of colour and normals, and a mesh's colours.
    pub fn draws_images(self) -> bool {
        matches!(self, Self::Diffuse(_))
    }

    /// Whether the rung spreads light over a surface by its curvature.
    pub fn spreads_by_curvature(self) -> bool {
        matches!(self, Self::Diffuse(reflectance) if !reflectance.is_lambert() && reflectance != Reflectance::Blur)
    }

    /// Returns how rays inside find facets; `None` if no light is followed inside.
    pub fn geometry_of_inside(self) -> Option<Geometry> {
        if let Self::Inside { geometry, .. } = self { Some(geometry) } else { None }
    }

    /// Returns how rays find facets; the proxy if no light is followed inside.
    pub fn geometry(self) -> Geometry {
        if let Self::Inside { geometry, .. } = self { geometry } else { Geometry::Proxy }
    }

    /// Returns the number of internal hits; 0 if no light is followed inside.
    pub fn hits(self) -> u32 {
        if let Self::Inside { hits, .. } = self { hits } else { 0 }
    }

    /// Returns how dispersion is computed; one index if no light is followed inside.
    pub fn spectrum(self) -> Spectrum {
        if let Self::Inside { spectrum, .. } = self { spectrum } else { Spectrum::One }
    }
}

impl From<Solver> for Rung {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Diffuse(reflectance) => Self::Diffuse(reflectance),
            Solver::OpticalPath(paths) => Self::OpticalPath(paths),
            Solver::Diffusion(diffusion) => Self::Diffusion(diffusion),
        }
    }
}

impl fmt::Display for Rung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (geometry, hits, spectrum) = match self {
            Self::Inside { geometry, hits, spectrum } => (geometry, hits, spectrum),
            Self::ByMaterial => return f.write_str("by-material"),
            Self::Surface => return f.write_str("surface"),
            Self::Diffuse(reflectance) => return write!(f, "{}", Solver::Diffuse(*reflectance)),
            Self::OpticalPath(paths) => return write!(f, "{}", Solver::OpticalPath(*paths)),
            Self::Diffusion(diffusion) => return write!(f, "{}", Solver::Diffusion(*diffusion)),
            Self::Reference => return f.write_str("reference"),
        };
        let name = GEOMETRIES.iter().find(|(_, g)| g == geometry).map_or("", |(name, _)| name);
        write!(f, "{name}-{hits}")?;
        match spectrum {
            Spectrum::One => Ok(()),
            Spectrum::Paper => f.write_str("+paper"),
            Spectrum::Tracker => f.write_str("+tracker"),
            Spectrum::Split => f.write_str("+split"),
            Spectrum::Separate(count) => write!(f, "+{count}"),
        }
    }
}

impl FromStr for Rung {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "by-material" => return Ok(Self::ByMaterial),
            "surface" => return Ok(Self::Surface),
            "reference" => return Ok(Self::Reference),
            _ => {}
        }
        match text.parse::<Solver>() {
            Ok(solver) => return Ok(solver.into()),
            Err(NoSolver::Unknown) => {}
            Err(error @ NoSolver::Cells { .. }) => return Err(error.to_string()),
        }
        let unknown = || format!("no such rung{}; a rung is {GRAMMAR}", nearest::suggest(text, &NAMES));
        let (way, spectrum) = text.split_once('+').map_or((text, None), |(way, spectrum)| (way, Some(spectrum)));
        let (name, hits) = way.split_once('-').ok_or_else(unknown)?;
        let geometry = GEOMETRIES.iter().find(|(known, _)| *known == name).map(|(_, g)| *g).ok_or_else(unknown)?;
        let hits = whole(hits).ok_or_else(unknown)?;
        if hits > MOST_HITS {
            return Err(format!("{hits} internal hits; at most {MOST_HITS} are followed"));
        }
        let spectrum = match spectrum {
            None => Spectrum::One,
            Some("paper") => Spectrum::Paper,
            Some("tracker") => Spectrum::Tracker,
            Some("split") => Spectrum::Split,
            Some(count) => match whole(count).ok_or_else(unknown)? {
                count if (3..=MOST_WAVELENGTHS).contains(&count) => Spectrum::Separate(count),
                count => return Err(format!("{count} wavelengths; 3 to {MOST_WAVELENGTHS} are followed")),
            },
        };
        if geometry == Geometry::Scene && !matches!(spectrum, Spectrum::One | Spectrum::Separate(_)) {
            return Err(format!(
                "{name} follows one index of refraction, or wavelengths of its own, as in {name}-{hits}+3"
            ));
        }
        Ok(Self::Inside { geometry, hits, spectrum })
    }
}

/// Parses a number that consists of digits only.
fn whole(text: &str) -> Option<u32> {
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_offered_name_is_its_rungs_name() {
        for name in NAMES {
            assert_eq!(name.parse::<Rung>().expect(name).to_string(), name);
        }
    }

    #[test]
    fn wrong_names_say_what_a_rung_is() {
        for (text, expected) in [
            ("proxi-1", "did you mean `proxy-1`"),
            ("proxy", "a rung is"),
            ("proxy--1", "a rung is"),
            ("proxy-+1", "a rung is"),
            ("proxy-65", "at most 64"),
            ("proxy-1+2", "3 to 61"),
            ("proxy-1+", "a rung is"),
            ("scene-8+tracker", "scene-8+3"),
            ("", "a rung is"),
            ("godunov-65", "a multiple of 8"),
            ("godunov-8", "16 to 256"),
            ("diffusion-136", "16 to 128"),
            ("diffusion-12", "a multiple of 8"),
            ("tiled-26", "a rung is"),
            ("ping-pong-26-x", "`x` cells"),
        ] {
            let message = text.parse::<Rung>().expect_err(text);
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
