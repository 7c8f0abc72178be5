//! The ladders that the gallery shows: what each is of, and how its rungs' pictures are drawn.

use super::error::LadderError;
use lapidary_cookbook::repository;
use lapidary_gpu::Gpu;
use lapidary_ladders::gem::views::{CONCAVE, VIEWS, View};
use lapidary_ladders::optical_path::{COMPARED, WALKED as TRANSLUCENT_VIEWS};
use lapidary_ladders::{CostError, Report};
use lapidary_plan::ladder::{Ladder, Step};
use lapidary_plan::{Quality, Technique};
use lapidary_render::Picture;
use lapidary_snapshots::{SHOTS, Shot, WalkedReference};

/// Width and height in pixels of a rung's picture.
pub(super) const SIDE: u32 = 384;
/// Samples along each side of a pixel of it.
pub(super) const SAMPLES: u32 = 2;

/// What the rungs' pictures are compared with.
#[derive(Clone, Copy, Debug)]
pub(super) enum Truth {
    /// The spectral reference of a view of clear stones.
    Spectral(&'static str),
    /// Random walks in a scene of scattering bodies.
    Walks(&'static str),
}

/// A ladder as the gallery shows it.
#[derive(Debug)]
pub struct Kind {
    /// Its name: a folder of `images/rungs`, and part of ids.
    pub name: &'static str,
    /// The technique whose committed ladder it is.
    pub technique: Technique,
    /// Name of the report, `docs/measurements/lavapipe/REPORT.json`.
    pub report: &'static str,
    /// Title.
    pub title: &'static str,
    /// What the error axis shows.
    pub error: &'static str,
    /// Where the rungs come from, in a sentence.
    pub paragraph: &'static str,
    /// Series: the starts of their rungs' names, and their names.
    pub(super) series: &'static [(&'static [&'static str], &'static str)],
    /// The paper's rungs.
    pub(super) paper: &'static [&'static str],
    /// Rungs with a picture that the ladder did not measure.
    pub(super) others: &'static [&'static str],
    /// The committed picture whose scene, camera, light and exposure the rungs' pictures take.
    pub(super) like: &'static str,
    /// The reference.
    pub(super) truth: Truth,
    /// Starts of rungs' names, each with that of rungs that find the same hits or costs in another way.
    pub(super) twins: &'static [(&'static str, &'static str)],
}

const GEM_SERIES: &[(&[&str], &str)] = &[
    (&["surface"], "surface alone"),
    (&["proxy"], "proxy geometry"),
    (&["walk"], "facets by a map"),
    (&["convex"], "every facet plane"),
    (&["bvh"], "hierarchy of triangles"),
    (&["triangles"], "every triangle"),
];

/// The ladders in the order in which the gallery shows them.
pub const KINDS: [Kind; 5] = [
    Kind {
        name: "convex",
        technique: Technique::Convex,
        report: "gem",
        title: "Clear and convex",
        error: "FLIP",
        paragraph: "How a ray inside the stone finds the next facet, how many it meets, and what becomes of the colours. FLIP is the visible \
            difference from the spectral reference, from 0 to 1.",
        series: GEM_SERIES,
        paper: &["proxy-1", "proxy-1+paper", "triangles-1"],
        others: &[],
        like: "brilliant_paper",
        truth: Truth::Spectral("brilliant"),
        twins: &[("convex", "walk"), ("bvh", "walk"), ("triangles", "walk")],
    },
    Kind {
        name: "concave",
        technique: Technique::Concave,
        report: "gem",
        title: "Clear, of any shape",
        error: "FLIP",
        paragraph: "A ray that left may enter again, so facets alone no longer do: triangles are found by a hierarchy of boxes. FLIP is the \
            visible difference from the spectral reference, from 0 to 1.",
        series: GEM_SERIES,
        paper: &["proxy-1", "proxy-1+paper"],
        others: &[],
        like: "bunny_stone",
        truth: Truth::Spectral("bunny_stone"),
        twins: &[],
    },
    Kind {
        name: "cdrf",
        technique: Technique::Cdrf,
        report: "cdrf",
        title: "Skin, wax and jade by curvature",
        error: "distance from walks",
        paragraph: "Whole pictures with shadows and the law of a half space, as the defaults are drawn. The distance is that of linear radiance \
            from random walks after the best exposure, over their root mean square.",
        series: &[
            (&["lambert"], "Lambert’s law"),
            (&["wrap"], "wrapped cosine"),
            (&["cheap", "accurate", "power"], "closed forms of the convolution"),
            (&["drift"], "widths fitted to walks"),
        ],
        paper: &["table-256-rgba8"],
        others: &["table-256-rgba8", "blur"],
        like: "skin_bunny_lambert",
        truth: Truth::Walks("skin_bunny"),
        twins: &[],
    },
    Kind {
        name: "optical_path",
        technique: Technique::OpticalPath,
        report: "optical_path",
        title: "Light along the cheapest paths",
        error: "error of the cost in nats",
        paragraph: "Solvers of the paths of least optical depth on a grid of voxels; the number after the solver is that of voxels along an edge. \
            An error of one nat is a factor of e in the light.",
        series: &[
            (&["lambert"], "Lambert’s law, without paths"),
            (&["paper"], "the paper’s solver"),
            (&["ping-pong"], "every voxel in every pass"),
            (&["tiled"], "tiles that change"),
            (&["godunov"], "the Eikonal equation by tiles"),
        ],
        paper: &["paper-64"],
        others: &[],
        like: "bunny",
        truth: Truth::Walks("bunny"),
        twins: &[("ping-pong", "tiled")],
    },
    Kind {
        name: "translucent",
        technique: Technique::Translucent,
        report: "translucent",
        title: "Light through a body",
        error: "distance from walks",
        paragraph: "Paths of least cost and diffusion side by side, against random walks: the distance of linear radiance after the best \
            exposure, over the walks’ root mean square.",
        series: &[
            (&["lambert"], "Lambert’s law"),
            (&["tiled", "godunov"], "paths of least cost"),
            (&["diffusion"], "diffusion"),
        ],
        paper: &[],
        others: &[],
        like: "dragon",
        truth: Truth::Walks("dragon"),
        twins: &[],
    },
];

impl Kind {
    /// Returns the ladder with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        KINDS.iter().find(|kind| kind.name == name)
    }

    /// Returns the measured rungs, each with its mean error and its mean time.
    pub(super) fn ladder(&self) -> Option<&'static Ladder> {
        self.technique.ladder()
    }

    /// Returns the rungs by increasing time. A record also holds forms that are no rungs, for comparison.
    pub fn steps(&self) -> Vec<&'static Step> {
        let is_rung = |step: &&Step| step.rung.parse::<lapidary_plan::Rung>().is_ok();
        let mut steps: Vec<&Step> =
            self.ladder().into_iter().flat_map(|ladder| &ladder.steps).filter(is_rung).collect();
        steps.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        steps
    }

    /// Returns the number of a rung's series, from 0.
    pub(super) fn series_of(&self, rung: &str) -> usize {
        self.series.iter().position(|(starts, _)| starts.iter().any(|start| rung.starts_with(start))).unwrap_or(0)
    }

    /// Returns the qualities that choose a rung.
    pub(super) fn qualities(&self, rung: &str) -> Vec<&'static str> {
        let chosen = Quality::ALL.into_iter().filter(|quality| self.technique.rung(*quality).to_string() == rung);
        chosen.map(Quality::name).collect()
    }

    /// Whether a rung is the paper's.
    pub(super) fn is_of_paper(&self, rung: &str) -> bool {
        self.paper.contains(&rung)
    }

    /// Returns the rung whose picture stands for this one: its own, or that of a measured rung which finds the same.
    pub(super) fn pictured<'a>(&self, rung: &'a str, steps: &[&'a Step]) -> &'a str {
        let twin = self.twins.iter().find_map(|(start, other)| Some(format!("{other}{}", rung.strip_prefix(start)?)));
        steps.iter().find(|step| Some(&step.rung) == twin.as_ref()).map_or(rung, |step| &step.rung)
    }

    /// Returns the shot of a rung.
    pub(super) fn shot(&self, rung: &str) -> Option<Shot> {
        let measured = self.steps().into_iter().map(|step| step.rung.as_str());
        let rung = measured.chain(self.others.iter().copied()).find(|other| *other == rung)?;
        let like = SHOTS.iter().find(|shot| shot.name == self.like)?;
        let scatters = matches!(self.truth, Truth::Walks(_));
        let with_law = self.technique == Technique::Cdrf && !self.others.contains(&rung);
        Some(Shot { name: rung, rung, side: SIDE, samples: SAMPLES, matte: scatters, with_law, ..*like })
    }

    /// Returns the name of the scene of its pictures.
    pub fn scene(&self) -> &'static str {
        SHOTS.iter().find(|shot| shot.name == self.like).map_or("", |shot| shot.scene)
    }

    /// Returns the command that draws a rung's picture; empty for a rung that the ladder does not know.
    pub(super) fn command(&self, rung: &str) -> String {
        self.shot(rung).map(|shot| shot.command()).unwrap_or_default()
    }

    /// Reads the committed report.
    ///
    /// # Errors
    /// Returns an error if it is missing or damaged.
    pub fn report(&self) -> Result<Report, CostError> {
        let path = repository::place().join("docs/measurements/lavapipe").join(format!("{}.json", self.report));
        let unfit = |error: std::io::Error| CostError::Record { path: path.clone(), what: error.to_string() };
        Report::from_json(self.report, &std::fs::read_to_string(&path).map_err(unfit)?)
    }

    /// Returns the size of the timed pictures, in words.
    pub fn size(&self, report: &Report) -> String {
        let (side, _) = self.measured(report);
        format!("{side} × {side}")
    }

    /// Returns the side of the timed pictures, and the views over which errors and times are averaged.
    pub fn measured<'r>(&self, report: &'r Report) -> (u64, Vec<&'r str>) {
        match self.technique {
            Technique::Convex => (report.setting("side"), VIEWS.map(|view| view.name).into()),
            Technique::Concave => (report.setting("side"), CONCAVE.map(|view| view.name).into()),
            Technique::Cdrf => (report.setting("side"), report.views("as drawn")),
            Technique::OpticalPath => (report.setting("width"), COMPARED.into()),
            _ => (report.setting("width"), TRANSLUCENT_VIEWS.into()),
        }
    }
}

impl Truth {
    /// Reads the committed picture: linear, and the exposure of its display.
    pub(super) fn read(self, gpu: &Gpu) -> Result<Option<Picture>, LadderError> {
        Ok(match self {
            Self::Spectral(name) => View::named(name).map(|view| view.reference(gpu)).transpose()?,
            Self::Walks(scene) => WalkedReference::of_scene(scene).map(|walked| walked.picture(gpu)).transpose()?,
        })
    }

    /// Returns the command that remakes it.
    pub(super) fn command(self) -> String {
        match self {
            Self::Spectral(name) => View::named(name).map(|view| view.command()).unwrap_or_default(),
            Self::Walks(scene) => WalkedReference::of_scene(scene).map(WalkedReference::command).unwrap_or_default(),
        }
    }

    /// Says what it is, and by how many samples or walks.
    pub(super) fn description(self) -> String {
        match self {
            Self::Spectral(_) => "traced in 31 wavelengths on the CPU in double precision".to_owned(),
            Self::Walks(scene) => {
                let walks = WalkedReference::of_scene(scene).map_or(0, |walked| walked.walks);
                format!("{walks} random walks a pixel, on the CPU in double precision")
            }
        }
    }
}
