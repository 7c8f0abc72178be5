//! A rung chosen by technique and quality, and what it costs.

use crate::Rung;
use crate::quality::{Quality, Technique, figure};
use std::fmt;

/// A rung chosen by technique and quality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// Technique of the body.
    pub technique: Technique,
    /// Requested quality.
    pub quality: Quality,
}

impl Chosen {
    /// Returns the rung that the quality selects.
    #[must_use]
    pub fn rung(self) -> Rung {
        self.technique.rung(self.quality)
    }

    /// Returns the rung's error in its committed ladder, and its time as a multiple of the time of
    /// [`Quality::Fast`]. `None` if the ladder lacks either rung, or there is no ladder.
    #[must_use]
    pub fn measured(self) -> Option<Measured> {
        let ladder = self.technique.ladder()?;
        let step = |quality| ladder.step(&self.technique.rung(quality).to_string());
        let (chosen, fast) = (step(self.quality)?, step(Quality::Fast)?);
        Some(Measured {
            error: chosen.error,
            worst: chosen.worst,
            measure: ladder.measure,
            times_fast: chosen.ms / fast.ms,
        })
    }
}

/// Error and relative cost of a chosen rung.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Mean error over the ladder's views.
    pub error: f64,
    /// Largest error of any view.
    pub worst: f64,
    /// Name of the error measure.
    pub measure: &'static str,
    /// Time as a multiple of the time of [`Quality::Fast`].
    pub times_fast: f64,
}

impl fmt::Display for Chosen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quality, .. } = self;
        let Some(Measured { error, worst, measure, times_fast }) = self.measured() else {
            return write!(f, "quality {quality}: the technique's only rung");
        };
        write!(f, "quality {quality}: {measure} {}", figure(error))?;
        if worst != error {
            write!(f, " in the mean over the ladder's views, {} in the worst", figure(worst))?;
        }
        if *quality == Quality::Fast { Ok(()) } else { write!(f, "; {times_fast:.1} times the time of fast") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_says_its_error_and_its_time() {
        let chosen = |technique, quality| Chosen { technique, quality }.to_string();
        let good = chosen(Technique::Convex, Quality::Good);
        assert!(good.starts_with("quality good: FLIP 0.") && good.contains(" times the time of fast"), "{good}");
        let fast = chosen(Technique::OpticalPath, Quality::Fast);
        assert!(fast.contains("nats") && !fast.contains("time"), "{fast}");
        assert_eq!(chosen(Technique::Opaque, Quality::Best), "quality best: the technique's only rung");
    }
}
