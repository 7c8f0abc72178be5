//! Plots of series of points, as SVG: for files with colours of their own ([`Plot::svg`]) and for pages, whose style
//! gives the colours to classes ([`Plot::drawing`]). Axes are logarithmic or linear, labels keep off lines, points and
//! each other, and the points that nothing faster beats lie on a staircase.

mod axis;
mod drawing;
mod file;
mod labels;
mod ladder;
mod markup;
mod series;

pub use axis::Axis;
pub use drawing::{Drawing, Format};
pub use ladder::{Dot, ladder};
pub use markup::four_digits;
pub use series::{COLORS, Color, GREY, Link, Marker, Plot, Point, Series};
