//! Renders a scene to a picture: the rung's recipe over tiles, supersampled, then the display
//! recipe; or the reference.
//!
//! ```no_run
//! use lapidary_gpu::{AdapterChoice, Gpu};
//! use lapidary_plan::Rung;
//! use lapidary_render::{Settings, render};
//! use lapidary_scene::Scene;
//!
//! let gpu = Gpu::shared(&AdapterChoice::from_environment())?;
//! let settings = Settings { rung: Rung::ByMaterial, ..Settings::of_size(640, 480) };
//! let picture = render(gpu, &Scene::open("brilliant")?, &settings)?;
//! println!("{} x {} pixels, sRGB in `picture.encoded`", picture.width, picture.height);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bloom;
mod drawing;
mod error;
pub mod frame;
mod light;
mod material;
mod objects;
mod picture;
pub mod pixel;
pub mod plan;
mod reference;
mod render;
mod settings;
mod shadow;
mod stone;
mod surface;
mod timer;
mod volume;

pub use bloom::{BLOOM, bloom};
pub use drawing::scene_frame::frame;
pub use error::RenderError;
pub use frame::{compute, shader};
pub use picture::displayed::encode;
pub use picture::{Picture, WalkedPicture, file};
pub use reference::scatters;
pub use render::{render, render_means, render_reporting, render_with};
pub use settings::{
    Curvature, DiffuseOptions, DiffusionOptions, EXTINCTION_SCALE, GemOptions, MOST_SAMPLES, OpticalPathOptions,
    ReferenceOptions, SCREEN_STEPS, Settings, ShadowForm, WALKS, WalkOptions,
};
pub use stone::gem::gem_constants;
pub use stone::geometry::geometry_bytes;
pub use stone::restraint;
pub use surface::translucent::translucent_constants;
pub use surface::{cdrf, texture_diffusion};
pub use timer::{FrameTime, FrameTimer};
pub use volume::stage::Stage;
pub use volume::{solver, voxel_grid, voxelization};
