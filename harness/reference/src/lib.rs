//! Reference images computed on the CPU in f64: [`spectral`] for clear stones and [`random_walk`]
//! for scattering media.
//!
//! ```
//! use lapidary_reference::spectral::{Settings, render};
//! use lapidary_scene::Scene;
//!
//! let scene = Scene::open("brilliant")?;
//! let settings = Settings { wavelengths: 7, samples: 1, ..Settings::of_size(16, 16) };
//! let rendering = render(&scene, &settings, &|_, _| {})?;
//! println!("{} pixels", rendering.linear.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod generator;
pub mod random_walk;
pub mod spectral;
