//! Diagrams of the techniques that are geometry, drawn from the cookbook's own functions: a ray bends as
//! `refraction` bends it, and a voxel is filled if `voxelization` fills it. So a diagram cannot say what the code
//! doesn't do.

mod label;
pub mod legible;
pub mod plane;
pub mod scene;

mod bvh_trace;
mod closest_point;
mod convex_trace;
mod convex_walk;
mod curvature;
mod optical_path;
mod proxy_geometry;
mod ray_footprint;
mod reflective_shadow_map;
mod refraction;
mod screen_trace;
mod voxelization;

use crate::gallery::templates::{self, Markup};
use scene::Scene;
use serde::Serialize;

/// A diagram of a technique.
#[derive(Clone, Copy, Debug)]
pub struct Diagram {
    /// Name of its file, `docs/diagrams/NAME.svg`.
    pub name: &'static str,
    /// The module or recipe that it explains.
    pub module: &'static str,
    /// What it shows, in a few words.
    pub title: &'static str,
    /// What one sees, in plain text with `` `code` ``.
    pub caption: &'static str,
    /// Draws it.
    pub draw: fn() -> Scene,
}

/// Every diagram.
#[must_use]
pub fn all() -> &'static [Diagram] {
    ALL
}

const ALL: &[Diagram] = &[
    refraction::DIAGRAM,
    closest_point::DIAGRAM,
    proxy_geometry::DIAGRAM,
    convex_trace::DIAGRAM,
    convex_walk::DIAGRAM,
    bvh_trace::DIAGRAM,
    reflective_shadow_map::DIAGRAM,
    voxelization::DIAGRAM,
    optical_path::DIAGRAM,
    curvature::DIAGRAM,
    screen_trace::DIAGRAM,
    ray_footprint::DIAGRAM,
];

/// A diagram's style, as the page has it.
const STYLE: &str = include_str!("../gallery/assets/diagram.css");
/// The colours of a file of its own, light and dark.
const COLOURS: &str = include_str!("../gallery/assets/diagram_colours.css");

/// What the template takes.
#[derive(Serialize)]
struct Sheet<'a> {
    name: &'a str,
    title: &'a str,
    description: String,
    style: Option<Markup>,
    scene: Scene,
}

impl Diagram {
    /// Returns the diagram as a file of its own, which carries its colours for light and dark grounds.
    pub fn file_text(&self) -> String {
        self.render(Some(Markup(format!("{}\n{}", COLOURS.trim_end(), STYLE.trim_end())))).0
    }

    /// Returns the diagram for a page, whose style sheet colours it.
    pub fn inline(&self) -> Markup {
        self.render(None)
    }

    fn render(&self, style: Option<Markup>) -> Markup {
        let description = self.caption.replace('`', "");
        let (name, title, scene) = (self.name, self.title, (self.draw)());
        let Markup(mut text) = templates::render("diagram.xml", Sheet { name, title, description, style, scene });
        if !text.ends_with('\n') {
            text.push('\n');
        }
        Markup(text)
    }
}

#[cfg(test)]
mod tests;
