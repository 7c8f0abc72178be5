//! Accuracy of the proxy at small sizes, where it has been considered good enough: compared with
//! exact facets and a black stone, by size, cut and environment.

use glam::{UVec2, Vec3};
use lapidary_environment::direction_from_uv;
use lapidary_gpu::Gpu;
use lapidary_ladders::gem::Errors;
use lapidary_ladders::gem::views::{self, View};
use lapidary_ladders::{CostError, Report, Row};
use lapidary_plan::Rung;
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Environment, Scene};

/// The baseline: a completely black stone.
pub const BLACK: &str = "black";
/// The rungs that are compared with the baseline.
pub const RUNGS: [&str; 3] = ["proxy-1+tracker", "convex-3+tracker", "convex-8+tracker"];
const STONES: [&str; 4] = ["brilliant", "ruby", "step_cut", "quartz"];
/// Picture sizes whose references are traced on the spot, in seconds; larger references are the
/// committed ones, which are lit by the studio.
const SIZES: [u32; 2] = [16, 64];

/// Returns an environment map with the given radiance by direction.
fn map(radiance: impl Fn(Vec3) -> Vec3) -> Environment {
    let (width, height) = (128, 64);
    let pixel = |index: u32| {
        let middle = UVec2::new(index % width, index / width).as_vec2() + 0.5;
        let direction = direction_from_uv(middle / UVec2::new(width, height).as_vec2());
        radiance(direction).extend(1.0).to_array()
    };
    Environment::Map(EnvironmentMap { width, height, pixels: (0..width * height).map(pixel).collect() })
}

/// Blue sky, paler towards the horizon, over brown ground; a sun of 5° halfway up, which gives as
/// much light as the whole sky.
fn sun_and_sky() -> Environment {
    let sun = Vec3::new(0.5, 0.7, 0.5).normalize();
    map(|direction| {
        if direction.dot(sun) > 2.5f32.to_radians().cos() {
            return Vec3::new(560.0, 520.0, 450.0);
        }
        if direction.y < 0.0 {
            return Vec3::new(0.18, 0.15, 0.12);
        }
        Vec3::new(0.9, 0.95, 1.0).lerp(Vec3::new(0.2, 0.4, 0.9), direction.y.sqrt())
    })
}

/// A dim room with a warm lamp and a cool window.
fn two_lights() -> Environment {
    let near =
        |direction: Vec3, towards: Vec3, degrees: f32| direction.dot(towards.normalize()) > degrees.to_radians().cos();
    map(|direction| {
        if near(direction, Vec3::new(-0.6, 0.6, 0.5), 14.0) {
            Vec3::new(14.0, 11.0, 8.0)
        } else if near(direction, Vec3::new(0.9, 0.3, -0.3), 20.0) {
            Vec3::new(4.0, 5.0, 6.5)
        } else {
            Vec3::splat(0.06)
        }
    })
}

/// Number of references that are traced.
pub(super) const FOLLOWED: u64 = (STONES.len() * SIZES.len() * 3) as u64;

/// Adds, for every stone, environment and size by every rung at 16 samples per pixel, the mean
/// radiance over the reference's and the RMSE. `progress` receives the number of references traced
/// so far.
pub(super) fn measure(gpu: &Gpu, report: &mut Report, progress: &mut dyn FnMut(u64)) -> Result<(), CostError> {
    let environments = [("studio", Environment::Studio), ("sun and sky", sun_and_sky()), ("two lights", two_lights())];
    let mut done = 0;
    for stone in STONES {
        let scene = Scene::named(stone)?;
        for (environment_name, environment) in &environments {
            let of_size = |size| Settings { environment: environment.clone(), ..Settings::of_size(size, size) };
            let mut compare = |settings: &Settings, reference: &Picture| -> Result<(), CostError> {
                for rung in std::iter::once(BLACK).chain(RUNGS) {
                    let picture = match rung.parse() {
                        Ok(rung) => render::render(gpu, &scene, &Settings { rung, ..settings.clone() })?,
                        Err(_) => Picture { linear: vec![[0.0; 4]; reference.linear.len()], ..reference.clone() },
                    };
                    let Errors { rmse, energy, .. } = Errors::between(&picture, reference);
                    let view = format!("{stone}, {environment_name}, {0} × {0}", settings.width);
                    report.rows.push(Row::new(rung, &view, "mean", 1.0 + energy, ""));
                    report.rows.push(Row::new(rung, &view, "rmse", rmse, ""));
                }
                Ok(())
            };
            for size in SIZES {
                let settings = of_size(size);
                let reference = Settings { rung: Rung::Reference, ..settings.clone() };
                compare(&settings, &render::render(gpu, &scene, &reference)?)?;
                done += 1;
                progress(done);
            }
            if let (Environment::Studio, Some(view)) = (environment, View::named(stone)) {
                compare(&of_size(views::SIDE), &view.reference(gpu)?)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rough sum: the sky and the sun contribute about equally to a horizontal plane, and nothing
    /// is negative or dark all around.
    #[test]
    fn the_sun_brings_about_as_much_as_the_sky() {
        let Environment::Map(EnvironmentMap { width, height, pixels }) = sun_and_sky() else { panic!("a map") };
        let (mut sun, mut sky) = (0.0, 0.0);
        for (index, pixel) in pixels.iter().enumerate() {
            let polar = std::f32::consts::PI * ((index as u32 / width) as f32 + 0.5) / height as f32;
            let sum = (polar.cos() * polar.sin()).max(0.0) * pixel[1];
            if pixel[1] > 100.0 { sun += sum } else { sky += sum }
        }
        assert!((0.5..2.0).contains(&(sun / sky)), "{}", sun / sky);
    }
}
