//! Warnings about a picture that the picture itself does not show.

use super::Rung;
use super::numbers::{percent, short, triple};
use glam::Vec3;
use lapidary_scene::jewellery::Guess;
use lapidary_scene::stones::StoneNote;
use std::fmt;

/// Number of clear bodies around a point that the rungs scene-HITS follow.
pub(crate) const MOST_AROUND: usize = 4;

/// A warning: something about a picture is wrong, or may be.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// A mesh with a hole: wherever its inside is unknown, it is assumed to be empty.
    Open {
        /// Name of the object.
        object: String,
        /// Number of voxel columns that cross the surface an odd number of times.
        odd_columns: u32,
        /// Number of voxel columns in the object's grid.
        columns: u32,
    },
    /// The paths through a body were not followed to their ends.
    StoppedEarly {
        /// Name of the object.
        object: String,
        /// Upper bound on the linear radiance that any pixel lacks.
        bound: f32,
    },
    /// How far the diffusion through a body was solved, which was asked for.
    Solved {
        /// Name of the object.
        object: String,
        /// Largest number of multigrid cycles.
        cycles: u32,
        /// What is left of the equations in each channel, as a share of their right side.
        residual: [f64; 3],
    },
    /// Meshes that a rung treats as the surface of a solid although they are not.
    NotSolid {
        /// The objects concerned.
        objects: Objects,
        /// The rung that needs a solid.
        rung: Rung,
        /// Faults of the first object's mesh.
        faults: Vec<String>,
    },
    /// Opaque bodies whose triangles face inwards, so that their far side is drawn.
    InsideOut {
        /// The objects concerned.
        objects: Objects,
    },
    /// Surfaces with a hole whose material asks for both sides to be drawn.
    BackNotDrawn {
        /// The objects concerned.
        objects: Objects,
    },
    /// Bodies whose triangles have no area, as after a scale of 0.
    NoArea {
        /// The objects concerned.
        objects: Objects,
    },
    /// Clear bodies without a thickness.
    ThinWall {
        /// The objects concerned.
        objects: Objects,
        /// Properties that the material asks for but that need an inside.
        unused: Vec<&'static str>,
    },
    /// Clear bodies that let no visible light through.
    Black {
        /// The objects concerned.
        objects: Objects,
        /// Share of light left after the first object's thin parts, in the channel with the most
        /// light left.
        share: f32,
        /// Thickness of those parts in units of length.
        thickness: f32,
    },
    /// Bodies so bright that every channel is shown at its maximum.
    ClipsToWhite {
        /// The objects concerned.
        objects: Objects,
        /// Linear radiance of the first object times the exposure, in the brightest channel.
        radiance: f32,
    },
    /// Meshes with one normal per face, although the technique needs one per position.
    HardEdges {
        /// The objects concerned.
        objects: Objects,
        /// The rung that needs a normal per position.
        rung: Rung,
    },
    /// Bodies whose images and colours of vertices the rung does not draw: their factors alone are seen.
    FactorsAlone {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
        /// What is not drawn.
        what: Vec<&'static str>,
    },
    /// Scattering bodies that some of the light does not enter, under a rung that does not draw this share.
    AllEnters {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
        /// The share that enters, by the first one's material.
        share: f32,
    },
    /// Scattering bodies with a lamp inside, under a rung that shows nothing of its light.
    LampInside {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
    },
    /// Bodies within a clear one whose rung shows nothing of them.
    Within {
        /// The objects concerned.
        objects: Objects,
        /// Name of the clear body.
        around: String,
        /// The rung that draws it.
        rung: Rung,
    },
    /// A body that shares space with a clear one, without lying within it.
    ShareSpace {
        /// The object concerned.
        objects: Objects,
        /// Name of the clear body.
        with: String,
        /// Name of the one that the reference takes to be there.
        there: String,
        /// The rung that draws the clear one.
        rung: Rung,
        /// Whether that rung shows both.
        shown: bool,
    },
    /// Clear bodies drawn as polished, or as wholly clear.
    PolishedAndClear {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
        /// What is left out, by its name in the file.
        what: Vec<&'static str>,
    },
    /// Scattering bodies whose base colour is not the one that their coefficients have.
    OtherColor {
        /// The objects concerned.
        objects: Objects,
        /// The colour of the coefficients.
        color: Vec3,
    },
    /// Clear bodies under a rung that shows no lights.
    LightsNotSeen {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
    },
    /// Copies of a clear body, seen through one another, under a rung that follows light through one of them.
    CopiesApart {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
    },
    /// Clear stones drawn without other clear bodies that overlap them in the view.
    OthersNotSeen {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
        /// Largest share of an object's light that comes from the others.
        share: f32,
    },
    /// Scattering bodies that clear ones show by a simpler way than their own.
    SimplerThroughOthers {
        /// The objects concerned.
        objects: Objects,
    },
    /// A clear body within more clear ones than a ray knows.
    TooDeep {
        /// The objects concerned.
        objects: Objects,
        /// Number of clear bodies around a point of it, itself included.
        within: usize,
        /// The rung that draws them.
        rung: Rung,
    },
    /// So many bodies that none is compared with the others.
    NotCompared {
        /// Number of bodies.
        count: usize,
    },
    /// A clear body around the camera, under a rung that draws bodies from outside alone.
    EyeWithin {
        /// The objects concerned.
        objects: Objects,
        /// The rung that draws them.
        rung: Rung,
    },
    /// Bodies that are not clear, under a rung for clear stones.
    NotClear {
        /// The objects concerned.
        objects: Objects,
        /// The rung that was requested.
        asked: Rung,
        /// The rung that draws the first object instead.
        instead: Rung,
    },
    /// A camera that sees no body.
    NothingInView,
    /// What was mended, parted or joined of clear bodies.
    Stones(StoneNote),
    /// Bodies that look like stones or metals, and are not marked so.
    Unmarked(Guess),
    /// Bodies that were given the material of what they look like.
    Guessed(Guess),
    /// Nothing looks like an unmarked stone or metal, though the guess was asked for.
    NothingGuessed,
    /// An environment with negative radiance.
    NegativeRadiance {
        /// File of the environment.
        file: String,
        /// Number of pixels with a negative channel.
        pixels: usize,
        /// Smallest channel value.
        least: f32,
    },
}

/// The objects that share a note.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objects {
    /// Name of the first object.
    pub first: String,
    /// Number of objects.
    pub count: usize,
}

/// How much a note says is wrong, the gravest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gravity {
    /// Bodies are not seen, or stand where they are not.
    Wrong,
    /// What was asked for is left out.
    LeftOut,
    /// The picture is right, and black or white.
    Exposure,
    /// A figure about the picture, or how its input was mended.
    Figure,
}

impl Note {
    /// Returns how much the note says is wrong.
    #[must_use]
    pub fn gravity(&self) -> Gravity {
        match self {
            Self::NothingInView
            | Self::Within { .. }
            | Self::ShareSpace { .. }
            | Self::EyeWithin { .. }
            | Self::NotSolid { .. }
            | Self::InsideOut { .. }
            | Self::Open { .. } => Gravity::Wrong,
            Self::BackNotDrawn { .. }
            | Self::NoArea { .. }
            | Self::ThinWall { .. }
            | Self::FactorsAlone { .. }
            | Self::AllEnters { .. }
            | Self::PolishedAndClear { .. }
            | Self::LightsNotSeen { .. }
            | Self::CopiesApart { .. }
            | Self::OthersNotSeen { .. }
            | Self::SimplerThroughOthers { .. }
            | Self::OtherColor { .. }
            | Self::NotCompared { .. }
            | Self::TooDeep { .. }
            | Self::LampInside { .. }
            | Self::Unmarked(..)
            | Self::NothingGuessed
            | Self::Stones(StoneNote::TooLarge { .. } | StoneNote::AsModelled { .. })
            | Self::NotClear { .. } => Gravity::LeftOut,
            Self::Black { .. } | Self::ClipsToWhite { .. } => Gravity::Exposure,
            Self::StoppedEarly { .. }
            | Self::Solved { .. }
            | Self::HardEdges { .. }
            | Self::Stones(..)
            | Self::Guessed(..)
            | Self::NegativeRadiance { .. } => Gravity::Figure,
        }
    }
}

impl fmt::Display for Objects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count {
            1 => write!(f, "object `{}`", self.first),
            count => write!(f, "{count} objects, first `{}`", self.first),
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { object, odd_columns, columns } => write!(
                f,
                "object `{object}` is not closed: {odd_columns} of the {columns} columns of its voxels pass its surface an odd number of \
                 times and are left empty inside; close its mesh, or light may go round the gap"
            ),
            Self::StoppedEarly { object, bound } => write!(
                f,
                "object `{object}`: its paths wind more than the solver follows, which stopped early; its radiance may be too low by at most \
                 {bound:.1e}"
            ),
            Self::Solved { object, cycles, residual: [red, green, blue] } => write!(
                f,
                "object `{object}`: after {cycles} cycle{} of multigrid at most, {red:.1e}, {green:.1e} and {blue:.1e} of its equations of diffusion are \
                 left in red, green and blue",
                if *cycles == 1 { "" } else { "s" }
            ),
            Self::NotSolid { objects, rung, faults } => write!(
                f,
                "{objects}: rung `{rung}` takes a mesh for the surface of a solid, but {}; mend the mesh, or light inside goes astray",
                faults.join(", ")
            ),
            Self::InsideOut { objects } => write!(
                f,
                "{objects}: the triangles run clockwise seen from outside, so that the far side is drawn; turn them over"
            ),
            Self::BackNotDrawn { objects } => write!(
                f,
                "{objects}: the material is doubleSided and the mesh is open, but the backs of its triangles are not drawn; give it a thickness of \
                 its own"
            ),
            Self::NoArea { objects } => write!(
                f,
                "{objects}: no triangle has an area, so that nothing of it is drawn; give its node a scale other than 0, or remove it"
            ),
            Self::ThinWall { objects, unused } => {
                let lost = if unused.is_empty() { "refraction".to_owned() } else { format!("refraction, {}", unused.join(" and ")) };
                write!(
                    f,
                    "{objects}: clear with thickness 0, so drawn as a thin wall, without {lost}; if it is solid, give KHR_materials_volume a \
                     thicknessFactor"
                )
            }
            Self::Black { objects, share, thickness } => write!(
                f,
                "{objects}: of light inside {share:.0e} is left after {thickness:.3}, the way through its thin parts, so that it is drawn black; \
                 make its base colour and attenuation colour lighter, or the attenuation distance longer (a length of the scene)"
            ),
            Self::ClipsToWhite { objects, radiance } => write!(
                f,
                "{objects}: radiance of up to {} is shown as plain white; make the lights weaker, or give an --exposure of \
                 about {:.0e}",
                short(*radiance),
                0.5 / radiance
            ),
            Self::HardEdges { objects, rung } => write!(
                f,
                "{objects}: the mesh has a normal for each face, where rung `{rung}` needs one for each position; they were averaged by angle"
            ),
            Self::FactorsAlone { objects, rung, what } => write!(
                f,
                "{objects}: rung `{rung}` does not draw {}, so that the factor alone is seen",
                what.join(" and ")
            ),
            Self::AllEnters { objects, rung, share } => write!(
                f,
                "{objects}: rung `{rung}` draws no diffuseTransmissionFactor between 0 and 1, here {share}; only rungs that spread light by curvature do"
            ),
            Self::LampInside { objects, rung } => write!(
                f,
                "{objects}: a lamp stands inside, and rung `{rung}` shows nothing of its light; give the body a rung such as `diffusion-64`"
            ),
            Self::Within { objects, around, rung } => write!(
                f,
                "{objects}: inside the clear `{around}`, of which rung `{rung}` shows nothing but the surroundings; rung `scene-16` shows what is inside"
            ),
            Self::EyeWithin { objects, rung } => write!(
                f,
                "{objects}: the camera stands inside, and rung `{rung}` draws nothing of it; --rung reference looks out of it"
            ),
            Self::PolishedAndClear { objects, rung, what } => write!(
                f,
                "{objects}: rung `{rung}` draws a clear body polished and all of it clear, without its {}",
                what.join(" and ")
            ),
            Self::TooDeep { objects, within, rung } => write!(
                f,
                "{objects}: {within} clear bodies lie within one another there, of which rung `{rung}` follows {MOST_AROUND}; --rung reference \
                 follows 12"
            ),
            Self::OtherColor { objects, color } => write!(
                f,
                "{objects}: its coefficients of scattering and absorption decide its colour, {}, not its base colour",
                triple(*color)
            ),
            Self::LightsNotSeen { objects, rung } => {
                write!(f, "{objects}: rung `{rung}` shows no lights on a clear body; add --with light")
            }
            Self::CopiesApart { objects, rung } => write!(
                f,
                "{objects}: rung `{rung}` follows light through one copy, and what leaves it meets no other; rung `scene-16+3` follows it through \
                 all"
            ),
            Self::OthersNotSeen { objects, rung, share } => write!(
                f,
                "{objects}: other clear bodies overlap it in the view, of which rung `{rung}` shows nothing: at most {} of its light comes from \
                 them; rung `scene-16+3` shows them",
                percent(*share)
            ),
            Self::SimplerThroughOthers { objects } => write!(
                f,
                "{objects}: through clear bodies it looks as rung `drift` draws it: no light comes through it there, all light enters it, and \
                 its images of thickness and diffuse transmission are left out"
            ),
            Self::NotCompared { count } => write!(
                f,
                "{count} bodies: too many to look which of them share space or stand before one another, so each clear one is drawn as if \
                 it were alone; rung `scene-16` follows light through all"
            ),
            Self::ShareSpace { objects, with, there, shown: true, .. } => write!(
                f,
                "{objects}: shares space with the clear `{with}`; `{there}` is there, unless extras.lapidary.priority says otherwise"
            ),
            Self::ShareSpace { objects, with, rung, .. } => write!(
                f,
                "{objects}: shares space with the clear `{with}`, through which rung `{rung}` follows light as if it were alone; rung `scene-16` \
                 follows both"
            ),
            Self::NotClear { objects, asked, instead } => write!(
                f,
                "{objects}: rung `{asked}` is for clear stones, and the material lets nothing through, so drawn by `{instead}`"
            ),
            Self::NothingInView => f.write_str(
                "nothing is in view: the camera sees no body; give another direction with --from, such as --from 60,20, or mend the file's \
                 camera",
            ),
            Self::Stones(note) => note.fmt(f),
            Self::Unmarked(guess) if guess.options().is_empty() => write!(f, "{guess}; no preset is of that name"),
            Self::Unmarked(guess) => write!(f, "{guess}; --jewellery makes it one, or {}", guess.options()),
            Self::Guessed(guess) if guess.options().is_empty() => {
                write!(f, "{guess}; drawn as the file says, since no preset is of that name")
            }
            Self::Guessed(guess) => write!(f, "{guess}; drawn so, as by {}", guess.options()),
            Self::NothingGuessed => f.write_str(
                "--jewellery: nothing looks like a stone or a metal that is not marked as one; name bodies by --material",
            ),
            Self::NegativeRadiance { file, pixels, least } => write!(
                f,
                "{file}: {pixels} pixels have negative parts, down to {least:.1e}, which count as 0"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guesses_and_changed_stones_are_lines_as_well() {
        let look = lapidary_scene::jewellery::Look::Stone("ruby");
        let guess = Guess {
            look,
            bodies: vec![0, 1],
            first: "hare".to_owned(),
            material: "Gem".to_owned(),
            evidence: vec!["a blend".to_owned()],
            named: vec!["Gem".to_owned()],
        };
        let line = Note::Unmarked(guess.clone()).to_string();
        let what = "2 objects, first `hare` of `Gem`: looks like a stone, ruby (a blend)";
        assert_eq!(line, format!("{what}; --jewellery makes it one, or --material 'Gem=ruby'"));
        assert_eq!(Note::Guessed(guess).to_string(), format!("{what}; drawn so, as by --material 'Gem=ruby'"));
        let joined = StoneNote::Joined { first: "a".to_owned(), bodies: 2, copies: 3 };
        assert_eq!(Note::Stones(joined.clone()).to_string(), joined.to_string());
        assert!(!Note::NothingGuessed.to_string().contains('\n'));
    }

    #[test]
    fn a_note_is_a_line_with_its_figures() {
        let open = Note::Open { object: "hare".to_owned(), odd_columns: 7, columns: 4096 }.to_string();
        assert!(open.starts_with("object `hare` is not closed: 7 of the 4096 columns"), "{open}");
        let stopped = Note::StoppedEarly { object: "spring".to_owned(), bound: 0.25 }.to_string();
        assert!(stopped.contains("`spring`") && stopped.contains("at most 2.5e-1"), "{stopped}");
        let objects = |count| Objects { first: "hare".to_owned(), count };
        let rung: Rung = "convex-8".parse().expect("a rung");
        let faults = vec!["3 edges are open".to_owned(), "1 part is inside out".to_owned()];
        let line_of = |note: Note, says: &str| {
            let line = note.to_string();
            assert!(line.contains(says), "{line}");
            line
        };
        let solved = Note::Solved { object: "hare".to_owned(), cycles: 3, residual: [1e-3, 2.5e-4, 0.0] }.to_string();
        assert!(solved.contains("after 3 cycles of multigrid at most, 1.0e-3, 2.5e-4 and 0.0e0"), "{solved}");
        let mut lines = vec![open, stopped, solved];
        lines.extend([
            line_of(Note::NotSolid { objects: objects(1), rung, faults }, "object `hare`: rung `convex-8` takes"),
            line_of(Note::InsideOut { objects: objects(3) }, "3 objects, first `hare`: the triangles run clockwise"),
            line_of(Note::BackNotDrawn { objects: objects(1) }, "doubleSided"),
            line_of(Note::NoArea { objects: objects(2) }, "2 objects, first `hare`: no triangle has an area"),
            line_of(
                Note::ThinWall { objects: objects(1), unused: vec!["absorption", "dispersion"] },
                "refraction, absorption and dispersion;",
            ),
            line_of(Note::Black { objects: objects(1), share: 3e-5, thickness: 0.25 }, "3e-5 is left after 0.250"),
            line_of(Note::ClipsToWhite { objects: objects(1), radiance: 50.0 }, "about 1e-2"),
            line_of(Note::HardEdges { objects: objects(1), rung }, "averaged by angle"),
            line_of(
                Note::FactorsAlone { objects: objects(1), rung, what: vec!["baseColorTexture", "normalTexture"] },
                "does not draw baseColorTexture and normalTexture",
            ),
            line_of(Note::AllEnters { objects: objects(2), rung, share: 0.25 }, "between 0 and 1, here 0.25"),
            line_of(Note::LampInside { objects: objects(1), rung }, "a rung such as `diffusion-64`"),
            line_of(
                Note::Within { objects: objects(2), around: "glass".to_owned(), rung },
                "2 objects, first `hare`: inside the clear `glass`, of which rung `convex-8` shows nothing",
            ),
            line_of(
                Note::PolishedAndClear {
                    objects: objects(2),
                    rung,
                    what: vec!["roughnessFactor", "transmissionFactor"],
                },
                "polished and all of it clear, without its roughnessFactor and transmissionFactor",
            ),
            line_of(
                Note::OtherColor { objects: objects(1), color: Vec3::new(0.7, 0.5, 0.25) },
                "colour, (0.7, 0.5, 0.25), not",
            ),
            line_of(Note::LightsNotSeen { objects: objects(1), rung }, "add --with light"),
            line_of(Note::CopiesApart { objects: objects(1), rung }, "what leaves it meets no other"),
            line_of(
                Note::OthersNotSeen { objects: objects(2), rung, share: 0.031 },
                "of which rung `convex-8` shows nothing: at most 3 % of its light",
            ),
            line_of(
                Note::SimplerThroughOthers { objects: objects(1) },
                "through clear bodies it looks as rung `drift` draws it",
            ),
            line_of(Note::TooDeep { objects: objects(1), within: 6, rung }, "6 clear bodies lie within one another"),
            line_of(Note::NotCompared { count: 900 }, "900 bodies: too many to look which of them share space"),
            line_of(Note::EyeWithin { objects: objects(1), rung }, "object `hare`: the camera stands inside"),
            line_of(
                Note::ShareSpace {
                    objects: objects(1),
                    with: "glass".to_owned(),
                    there: "glass".to_owned(),
                    rung: Rung::Reference,
                    shown: true,
                },
                "shares space with the clear `glass`; `glass` is there",
            ),
            line_of(
                Note::ShareSpace {
                    objects: objects(1),
                    with: "glass".to_owned(),
                    there: "glass".to_owned(),
                    rung,
                    shown: false,
                },
                "follows light as if it were alone",
            ),
            line_of(Note::NotClear { objects: objects(1), asked: rung, instead: Rung::Surface }, "drawn by `surface`"),
            line_of(Note::NothingInView, "--from"),
            line_of(
                Note::NegativeRadiance { file: "sky.exr".to_owned(), pixels: 5, least: -0.001 },
                "5 pixels have negative parts, down to -1.0e-3",
            ),
        ]);
        for line in lines {
            assert!(!line.contains('\n') && !line.contains("  "), "{line}");
        }
    }
}
