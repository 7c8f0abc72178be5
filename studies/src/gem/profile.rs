//! Where a frame's time goes: frames of one stone, with one part after another cut from the recipe.

use lapidary_gpu::Gpu;
use lapidary_ladders::CostError;
use lapidary_ladders::gem::views;
use lapidary_ladders::table::figure;
use lapidary_ladders::timing::{self, Timed};
use lapidary_plan::Rung;
use lapidary_render::Settings;
use lapidary_scene::Scene;
use std::fmt::Write as _;

/// The cuts: description, source text to remove, and its replacement.
const CUTS: [(&str, &str, &str); 3] = [
    ("all of it", "", ""),
    (
        "an operation in place of each lookup of the studio",
        "    return environment_studio(direction);\n",
        "    return 0.5f * direction + 0.5f;\n",
    ),
    (
        "rasterising alone",
        "    if (EFFECT_PROXY_GEOMETRY) {\n        \
         return vec4f(radiance.surface + radiance.inside, 1.0f);\n    }\n",
        "    if (EFFECT_PROXY_GEOMETRY) {\n        \
         return vec4f(input.face_normal + input.position + input.plane_origin + input.edge_first + input.edge_second, \
         1.0f);\n    }\n",
    ),
];

/// The rungs whose recipes are cut.
const RUNGS: [&str; 3] = ["proxy-0", "proxy-1", "convex-1"];

/// Times the frames in interleaved `rounds` and returns the minima as a text table. `progress`
/// receives the number of frames done and the total.
pub fn profile(
    gpu: &Gpu,
    rounds: u32,
    [width, height]: [u32; 2],
    progress: &mut dyn FnMut(u64, u64),
) -> Result<String, CostError> {
    let scene = views::filled(&Scene::named("brilliant")?);
    let (mut places, mut timed) = (Vec::new(), Vec::new());
    for (row, (_, right, cut)) in CUTS.iter().enumerate() {
        for (column, name) in RUNGS.iter().enumerate() {
            let Ok(rung) = name.parse::<Rung>() else { continue };
            let source = lapidary_wgsl::recipe_source(rung.recipe());
            // The last cut concerns the outputs of the proxy's vertex shader.
            if !source.contains(right) || (row == 2 && *name != "proxy-1") {
                continue;
            }
            let settings = Settings { rung, samples: 1, ..Settings::of_size(width, height) };
            let source = if right.is_empty() { source } else { source.replace(right, cut) };
            places.push((row, column));
            timed.push(Timed { source: Some(source), scales: true, ..Timed::new(&scene, settings) });
        }
    }
    let timings = timing::time(gpu, &timed, rounds, progress)?;
    let mut text = format!("{}, {width}x{height}, least of {rounds} interleaved rounds, ms\n{:52}", gpu.describe(), "");
    for name in RUNGS {
        let _ = write!(text, "{name:>10}");
    }
    for (row, (what, ..)) in CUTS.iter().enumerate() {
        let _ = write!(text, "\n{what:52}");
        for column in 0..RUNGS.len() {
            let found = places.iter().position(|place| *place == (row, column));
            let _ =
                write!(text, "{:>10}", found.map_or(String::new(), |k| figure(timings[k].map(|timing| timing.ms), 1)));
        }
    }
    Ok(text)
}
