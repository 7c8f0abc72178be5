//! The angular law of light that scattering matter sends back, as the part `scattering_law` of the
//! recipes takes it: computed once per material.

use crate::frame::record::Record;
use glam::Vec3;
use lapidary_fresnel::dielectric;
use lapidary_half_space as half_space;
use lapidary_plan::{Decisions, Effect, thickness};
use lapidary_scene::Material;
use std::f32::consts::PI;

/// The largest root of 1 - albedo: matter that scatters nothing reflects nothing, and the law's quotients
/// would have no value.
const DARKEST: f32 = 0.9999;
/// Number of cosines at which the mean of a law over all directions is taken.
const DIRECTIONS: u32 = 64;

/// The matter below a material's surface; fields as those of `ScatteringLaw` in the recipes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ScatteringLaw {
    gamma: Vec3,
    index: f32,
    gain: Vec3,
    edge: f32,
    light: Vec3,
    polished: f32,
    around: Vec3,
    inside: Vec3,
}

impl ScatteringLaw {
    /// Returns the law of an object's material. Its surface refracts if it also reflects.
    pub(crate) fn of_object(material: &Material, decisions: &Decisions) -> Self {
        Self::of(material, Self::index_of(material, decisions), decisions.has(Effect::Reflection))
    }

    /// Returns the law of a material without a boundary.
    pub(crate) fn matched(material: &Material) -> Self {
        Self::of(material, 1.0, false)
    }

    /// Returns the index at the boundary: 1 if the surface reflects nothing.
    pub(crate) fn index_of(material: &Material, decisions: &Decisions) -> f32 {
        let reflects = decisions.has(Effect::Microfacet) || decisions.has(Effect::Reflection);
        if reflects { material.ior } else { 1.0 }
    }

    /// Returns the law behind a boundary of this index. `is_polished` says that the recipe takes away what
    /// the boundary reflects of the light towards the eye.
    fn of(material: &Material, index: f32, is_polished: bool) -> Self {
        let edge = half_space::edge(index);
        // The share of diffuse light that passes the boundary from outside.
        let passing = index.max(1.0).powi(2) * (1.0 - edge * edge);
        let gamma = Vec3::from_array(std::array::from_fn(|channel| match thickness::albedo(material) {
            Some(albedo) => half_space::gamma(albedo[channel], 0.0),
            None => half_space::gamma_of_entered(material.base_color[channel] / passing, edge),
        }));
        let gamma = gamma.clamp(Vec3::ZERO, Vec3::splat(DARKEST));
        let returned = gamma.map(|gamma| passing * half_space::entered(gamma, edge));
        // With a medium the base color is the reflectance of a half space of it without a boundary, else that
        // of what is seen.
        let color = if material.medium.is_some() { gamma.map(half_space::reflectance) } else { returned };
        let seen = |cosine: f32| 1.0 - dielectric(cosine, index);
        let mean = |law: &dyn Fn(f32, f32) -> f32| {
            gamma.map(|gamma| mean(|cosine| seen(cosine) * law(half_space::refract(cosine, index), gamma)))
        };
        Self {
            gamma,
            index,
            gain: gamma.map(|gamma| half_space::gain(gamma, edge)),
            edge,
            light: PI / color,
            polished: f32::from(u8::from(is_polished)),
            around: returned / color / mean(&half_space::directional),
            inside: mean(&half_space::exit).recip(),
        }
    }

    /// Fills `ScatteringLaw` of the recipes.
    pub(crate) fn fill(&self, record: Record) -> Record {
        let record = record.with("gamma", self.gamma).with("index", self.index);
        let record = record.with("gain", self.gain).with("edge", self.edge);
        let record = record.with("light", self.light).with("polished", self.polished);
        record.with("around", self.around).with("inside", self.inside)
    }
}

/// Returns the mean over the directions of a hemisphere, each weighted with its cosine.
fn mean(law: impl Fn(f32) -> f32) -> f32 {
    // Equal steps of the square of the cosine have equal weights.
    let cosine = |step: u32| ((step as f32 + 0.5) / DIRECTIONS as f32).sqrt();
    (0..DIRECTIONS).map(|step| law(cosine(step))).sum::<f32>() / DIRECTIONS as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_scene::Scene;

    /// Mirror of `scattering_law_of_light`, times the cosine of the light.
    fn of_light(law: &ScatteringLaw, eye: f32, light: f32, channel: usize) -> f32 {
        let passed = |cosine: f32| 1.0 - dielectric(cosine, law.index);
        let returned = half_space::dielectric(eye, light, law.gamma[channel], law.index, law.edge, law.gain[channel]);
        law.light[channel] * passed(eye) * passed(light) * returned
    }

    /// Under diffuse light the law keeps the light that the base color stands for; with a boundary, that
    /// which the boundary lets through.
    #[test]
    fn the_law_keeps_the_energy_of_diffuse_light() {
        for name in ["skin", "wax", "jade"] {
            let of_medium = Scene::named(name).expect("built in").objects[0].material.clone();
            let of_color = Material { medium: None, ..of_medium.clone() };
            for (material, index) in [(&of_medium, 1.0), (&of_medium, 1.4), (&of_color, 1.0), (&of_color, 1.4)] {
                let law = ScatteringLaw::of(material, index, false);
                for channel in 0..3 {
                    let all = mean(|eye| mean(|light| of_light(&law, eye, light, channel)));
                    let around = law.around[channel]
                        * mean(|eye| {
                            let inside = half_space::refract(eye, index);
                            (1.0 - dielectric(eye, index)) * half_space::directional(inside, law.gamma[channel])
                        });
                    let passing = index * index * (1.0 - law.edge * law.edge);
                    let expected = if material.medium.is_some() {
                        let gamma = law.gamma[channel];
                        passing * half_space::entered(gamma, law.edge) / half_space::reflectance(gamma)
                    } else {
                        1.0
                    };
                    println!("{name} at {index}: lights {all:.4}, around {around:.4}, expected {expected:.4}");
                    assert!((all / expected - 1.0).abs() < 0.01, "{name} {index}: {all} {expected}");
                    assert!((around / expected - 1.0).abs() < 1e-3, "{name} {index}: {around} {expected}");
                }
            }
        }
    }

    /// The matter of a base color reflects that color, and that of a medium nearly the color that built-in
    /// scenes give with it.
    #[test]
    fn a_base_color_is_the_reflectance_of_its_matter() {
        let skin = Scene::named("skin").expect("built in").objects[0].material.clone();
        let law = ScatteringLaw::of(&skin, 1.0, false);
        assert!((PI / law.light - skin.base_color).abs().max_element() < 2e-3, "{law:?}");
        let none = Material { medium: None, ..skin.clone() };
        let law = ScatteringLaw::of(&none, 1.0, false);
        assert!((PI / law.light - skin.base_color).abs().max_element() < 1e-5, "{law:?}");
        // Neither black nor white breaks a number.
        for color in [Vec3::ZERO, Vec3::ONE] {
            let law = ScatteringLaw::of(&Material { base_color: color, ..none.clone() }, 1.4, true);
            assert!(law.light.is_finite() && law.around.is_finite() && law.inside.is_finite(), "{law:?}");
        }
    }
}
