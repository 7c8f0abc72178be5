//! What a user should know about a picture, beside what it shows.

use std::fmt;

/// Something about a picture that is not as it should be, or may not be.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// A mesh with a hole: where its inside is not known, it is taken to be empty.
    Open {
        /// The object's name.
        object: String,
        /// Columns of voxels that cross the surface an odd number of times.
        odd_columns: u32,
        /// How many columns its grid has.
        columns: u32,
    },
    /// The paths through a body were not followed to their ends.
    StoppedEarly {
        /// The object's name.
        object: String,
        /// No pixel's linear radiance is too low by more than this.
        bound: f32,
    },
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
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_is_a_line_with_its_figures() {
        let open = Note::Open { object: "hare".to_owned(), odd_columns: 7, columns: 4096 }.to_string();
        assert!(open.starts_with("object `hare` is not closed: 7 of the 4096 columns"), "{open}");
        let stopped = Note::StoppedEarly { object: "spring".to_owned(), bound: 0.25 }.to_string();
        assert!(stopped.contains("`spring`") && stopped.contains("at most 2.5e-1"), "{stopped}");
        for line in [open, stopped] {
            assert!(!line.contains('\n') && !line.contains("  "), "{line}");
        }
    }
}
