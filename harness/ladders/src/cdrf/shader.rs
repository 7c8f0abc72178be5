//! A rung's specialised shaders, counted in SPIR-V instructions.

use crate::error::CostError;
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_render::shader::Shader;
use lapidary_scene::Scene;
use lapidary_scene::solver::Reflectance;
use lapidary_specialise::spirv_counts::SpirvCounts;

/// The recipe's entry points.
const ENTRIES: [&str; 2] = ["cdrf_vertex", "cdrf_fragment"];

/// Counts the instructions that draw `scene` with `settings`.
pub(super) fn counts(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Result<SpirvCounts, CostError> {
    let recipe = settings.rung.recipe();
    let constants = render::translucent_constants(scene, settings, reflectance);
    let shader = Shader::new(recipe, &lapidary_wgsl::recipe_source(recipe), &ENTRIES, &constants);
    Ok(shader.map_err(render::RenderError::from)?.counts()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cdrf::{RUNGS, options};
    use lapidary_assay::dispatch;
    use lapidary_plan::{Effect, Effects, Rung};
    use lapidary_render::{Curvature, DiffuseOptions};

    #[test]
    fn every_override_of_the_recipe_has_a_value() {
        let scene = Scene::named("skin").expect("built in");
        let settings = Settings { rung: Rung::Diffuse(Reflectance::Cheap), ..Settings::of_size(1, 1) };
        let recipe = settings.rung.recipe();
        let (ir, _) = dispatch::parse(&lapidary_wgsl::recipe_source(recipe), recipe).expect("the recipe");
        let mut declared: Vec<&str> = ir.overrides.iter().filter_map(|(_, over)| over.name.as_deref()).collect();
        let constants = render::translucent_constants(&scene, &settings, Reflectance::Cheap);
        let given: Vec<&str> = constants.iter().map(|(name, _)| *name).collect();
        declared.retain(|name| !given.contains(name));
        assert!(declared.is_empty(), "{declared:?}");
    }

    #[test]
    fn what_a_rung_does_not_use_is_not_counted() {
        let scene = Scene::named("skin").expect("built in");
        let options = options();
        let counted = |curvature, without| -> Vec<u32> {
            let instructions_of = |&reflectance: &Reflectance| {
                let rung = Rung::Diffuse(reflectance);
                let settings = Settings {
                    rung,
                    diffuse: DiffuseOptions { curvature, ..DiffuseOptions::default() },
                    without,
                    ..Settings::of_size(1, 1)
                };
                counts(&scene, &settings, reflectance).expect("counted").fragment_instructions
            };
            options.rungs.iter().map(instructions_of).collect()
        };
        let dark = Effects::of(&[Effect::Environment]);
        let [lit, vertex, whole] =
            [(Curvature::Mean, dark), (Curvature::Vertex, dark), (Curvature::Mean, Effects::NONE)]
                .map(|(c, e)| counted(c, e));
        for (index, name) in RUNGS.iter().enumerate() {
            // Only rungs that use curvature receive it.
            assert_eq!(vertex[index] < lit[index], !["lambert", "blur"].contains(name), "{name}: {lit:?} {vertex:?}");
            // The light that reaches the texture is counted with the texture's recipe.
            assert_eq!(whole[index] > lit[index], *name != "blur", "{name}: {lit:?} {whole:?}");
        }
        let count_of = |name: &str| lit[RUNGS.iter().position(|rung| *rung == name).expect(name)];
        assert!(
            count_of("blur") < count_of("lambert")
                && count_of("lambert") < count_of("cheap")
                && count_of("cheap") < count_of("accurate"),
            "{lit:?}"
        );
    }
}
