//! A rung's shaders, specialised to what it uses and counted in SPIR-V.

use super::CostError;
use crate::cdrf::table::Format;
use crate::cookbook;
use crate::dispatch;
use crate::render::{self, Curvature, Environment, Reflectance, Settings};
use crate::scene::Scene;
use crate::specialise::specialise;
use crate::spirv_counts::{SpirvCounts, spirv_counts};
use glam::Vec3;

/// The recipe's entry points.
const ENTRIES: [&str; 2] = ["cdrf_vertex", "cdrf_fragment"];

/// What `settings` draw `scene` with.
pub(super) fn counts(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Result<SpirvCounts, CostError> {
    let recipe = settings.rung.recipe();
    let (ir, _) = dispatch::parse(&cookbook::recipe_source(recipe), recipe).map_err(render::RenderError::from)?;
    let constants = overrides(scene, settings, reflectance);
    let (ir, info) = specialise(ir, &constants, &ENTRIES)?;
    Ok(spirv_counts(&ir, &info, ENTRIES[0], ENTRIES[1])?)
}

/// The value of each of the recipe's overrides, by the numbers that its comments give.
fn overrides(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let any =
        |what: &dyn Fn(&crate::scene::Material) -> bool| scene.objects.iter().any(|object| what(&object.material));
    let scatters = any(&|material| material.sigma0.is_some_and(|sigma0| sigma0 != Vec3::ZERO));
    let polished = any(&|material| material.roughness == 0.0 && material.ior > 1.0);
    let form = match reflectance {
        Reflectance::Lambert | Reflectance::Blur => None,
        Reflectance::Wrap => Some(0.0),
        Reflectance::Table(_, Format::Rgba8 | Format::Rgba16Float) => Some(1.0),
        Reflectance::Table(_, Format::R32Float) => Some(2.0),
        Reflectance::Cheap => Some(3.0),
        Reflectance::Accurate => Some(4.0),
        Reflectance::Quadrature => Some(5.0),
        Reflectance::Spherical => Some(6.0),
    };
    let curvature = match settings.curvature {
        Curvature::Mean => 0.0,
        Curvature::Towards => 1.0,
        Curvature::Naive => 2.0,
        Curvature::Vertex => 3.0,
    };
    vec![
        ("EFFECT_CDRF", flag(scatters && form.is_some())),
        ("CDRF_FORM", form.unwrap_or(0.0)),
        ("CURVATURE_FORM", curvature),
        ("EFFECT_TEXTURE_DIFFUSION", flag(reflectance == Reflectance::Blur)),
        ("EFFECT_ENVIRONMENT", flag(settings.light_from_environment)),
        ("ENVIRONMENT_AT_VERTICES", flag(settings.environment_at_vertices)),
        ("EFFECT_REFLECTION", flag(settings.reflection && polished)),
        ("EFFECT_ENVIRONMENT_MAP", flag(matches!(settings.environment, Environment::Map(_)))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::cdrf::{Options, RUNGS};
    use crate::render::Rung;

    #[test]
    fn every_override_of_the_recipe_has_a_value() {
        let scene = Scene::named("skin").expect("built in");
        let settings = Settings { rung: Rung::Diffuse(Reflectance::Cheap), ..Settings::of_size(1, 1) };
        let recipe = settings.rung.recipe();
        let (ir, _) = dispatch::parse(&cookbook::recipe_source(recipe), recipe).expect("the recipe");
        let mut declared: Vec<&str> = ir.overrides.iter().filter_map(|(_, over)| over.name.as_deref()).collect();
        let constants = overrides(&scene, &settings, Reflectance::Cheap);
        let mut given: Vec<&str> = constants.iter().map(|(name, _)| *name).collect();
        declared.sort_unstable();
        given.sort_unstable();
        assert_eq!(given, declared);
    }

    #[test]
    fn what_a_rung_does_not_use_is_not_counted() {
        let scene = Scene::named("skin").expect("built in");
        let options = Options::default();
        let counted = |curvature, light_from_environment| -> Vec<u32> {
            let of = |&reflectance: &Reflectance| {
                let rung = Rung::Diffuse(reflectance);
                let settings = Settings { rung, curvature, light_from_environment, ..Settings::of_size(1, 1) };
                counts(&scene, &settings, reflectance).expect("counted").fragment_instructions
            };
            options.rungs.iter().map(of).collect()
        };
        let [lit, vertex, whole] =
            [(Curvature::Mean, false), (Curvature::Vertex, false), (Curvature::Mean, true)].map(|(c, e)| counted(c, e));
        for (index, name) in RUNGS.iter().enumerate() {
            // Only rungs that ask for a curvature get to know it.
            assert_eq!(vertex[index] < lit[index], !["lambert", "blur"].contains(name), "{name}: {lit:?} {vertex:?}");
            // What arrives in the texture is counted with the texture's recipe.
            assert_eq!(whole[index] > lit[index], *name != "blur", "{name}: {lit:?} {whole:?}");
        }
        let of = |name: &str| lit[RUNGS.iter().position(|rung| *rung == name).expect(name)];
        assert!(of("blur") < of("lambert") && of("lambert") < of("cheap") && of("cheap") < of("accurate"), "{lit:?}");
    }
}
