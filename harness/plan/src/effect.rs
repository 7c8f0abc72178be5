//! The effects, each by its one name.

use lapidary_scene::nearest::suggest;
use std::fmt;
use std::str::FromStr;

/// What a material or a scene may call for, and what else is neither compiled, nor bound, nor dispatched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Effect {
    /// Light through a clear stone, by a proxy of its inside.
    ProxyGeometry,
    /// Light through a convex clear stone, by its facets' planes.
    ConvexTrace,
    /// Light through any clear stone, by its triangles.
    BvhTrace,
    /// The environment behind a clear wall without an inside.
    ThinWall,
    /// Light is absorbed inside a clear stone.
    Absorption,
    /// The refractive index differs from colour to colour.
    Dispersion,
    /// Light that crosses below the surface from the lit side to the dark one, by curvature.
    Cdrf,
    /// The same by a blur of the light that arrives.
    TextureDiffusion,
    /// Light that comes through a body, along the way that costs it least.
    OpticalPath,
    /// Voxels that the surface touches, beside those whose centre is inside.
    Surface,
    /// A way's cost differs from colour to colour.
    Color,
    /// Matter is denser here than there.
    ExtinctionPerVoxel,
    /// Bodies keep a light from one another and from themselves.
    Shadow,
    /// Diffuse light from all around.
    Environment,
    /// The environment is an image.
    EnvironmentMap,
    /// The lights' highlights on a rough surface.
    Microfacet,
    /// The environment in a polished surface.
    Reflection,
    /// Lights that shine into a cone.
    Spot,
}

impl Effect {
    /// Every effect, each once.
    pub const ALL: [Self; 18] = [
        Self::ProxyGeometry,
        Self::ConvexTrace,
        Self::BvhTrace,
        Self::ThinWall,
        Self::Absorption,
        Self::Dispersion,
        Self::Cdrf,
        Self::TextureDiffusion,
        Self::OpticalPath,
        Self::Surface,
        Self::Color,
        Self::ExtinctionPerVoxel,
        Self::Shadow,
        Self::Environment,
        Self::EnvironmentMap,
        Self::Microfacet,
        Self::Reflection,
        Self::Spot,
    ];

    /// Its name in plans and on the command line: a module's, where it is one module.
    #[must_use]
    pub const fn name(self) -> &'static str {
        // The override's, in small letters.
        match self {
            Self::ProxyGeometry => "proxy_geometry",
            Self::ConvexTrace => "convex_trace",
            Self::BvhTrace => "bvh_trace",
            Self::ThinWall => "thin_wall",
            Self::Absorption => "absorption",
            Self::Dispersion => "dispersion",
            Self::Cdrf => "cdrf",
            Self::TextureDiffusion => "texture_diffusion",
            Self::OpticalPath => "optical_path",
            Self::Surface => "surface",
            Self::Color => "color",
            Self::ExtinctionPerVoxel => "extinction_per_voxel",
            Self::Shadow => "shadow",
            Self::Environment => "environment",
            Self::EnvironmentMap => "environment_map",
            Self::Microfacet => "microfacet",
            Self::Reflection => "reflection",
            Self::Spot => "spot",
        }
    }

    /// The recipes' override that compiles it.
    #[must_use]
    pub const fn override_name(self) -> &'static str {
        match self {
            Self::ProxyGeometry => "EFFECT_PROXY_GEOMETRY",
            Self::ConvexTrace => "EFFECT_CONVEX_TRACE",
            Self::BvhTrace => "EFFECT_BVH_TRACE",
            Self::ThinWall => "EFFECT_THIN_WALL",
            Self::Absorption => "EFFECT_ABSORPTION",
            Self::Dispersion => "EFFECT_DISPERSION",
            Self::Cdrf => "EFFECT_CDRF",
            Self::TextureDiffusion => "EFFECT_TEXTURE_DIFFUSION",
            Self::OpticalPath => "EFFECT_OPTICAL_PATH",
            Self::Surface => "EFFECT_SURFACE",
            Self::Color => "EFFECT_COLOR",
            Self::ExtinctionPerVoxel => "EFFECT_EXTINCTION_PER_VOXEL",
            Self::Shadow => "EFFECT_SHADOW",
            Self::Environment => "EFFECT_ENVIRONMENT",
            Self::EnvironmentMap => "EFFECT_ENVIRONMENT_MAP",
            Self::Microfacet => "EFFECT_MICROFACET",
            Self::Reflection => "EFFECT_REFLECTION",
            Self::Spot => "EFFECT_SPOT",
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no effect has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no effect `{name}`{suggestion}")]
pub struct UnknownEffect {
    /// The name.
    pub name: String,
    /// `; did you mean ...?` or nothing.
    pub suggestion: String,
}

impl FromStr for Effect {
    type Err = UnknownEffect;

    fn from_str(text: &str) -> Result<Self, UnknownEffect> {
        let unknown = || UnknownEffect { name: text.to_owned(), suggestion: suggest(text, &Self::ALL.map(Self::name)) };
        Self::ALL.into_iter().find(|effect| effect.name() == text).ok_or_else(unknown)
    }
}

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects(u32);

impl Effects {
    /// None of them.
    pub const NONE: Self = Self(0);
    /// What light does at the surface of what scatters it, beside being scattered.
    pub const SHEEN: Self = Self::of(&[Effect::Microfacet, Effect::Reflection]);

    /// These.
    #[must_use]
    pub const fn of(effects: &[Effect]) -> Self {
        let (mut set, mut index) = (0, 0);
        while index < effects.len() {
            set |= 1 << effects[index] as u32;
            index += 1;
        }
        Self(set)
    }

    /// These and those.
    #[must_use]
    pub const fn and(self, others: Self) -> Self {
        Self(self.0 | others.0)
    }

    /// Whether it is one of them.
    #[must_use]
    pub const fn has(self, effect: Effect) -> bool {
        self.0 & (1 << effect as u32) != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_override_is_named_as_its_effect() {
        for effect in Effect::ALL {
            assert_eq!(effect.override_name(), format!("EFFECT_{}", effect.name().to_uppercase()));
            assert_eq!(effect.name().parse(), Ok(effect));
        }
        let error = "absorbtion".parse::<Effect>().expect_err("no such effect").to_string();
        assert!(error.contains("did you mean `absorption`"), "{error}");
    }

    #[test]
    fn every_recipes_effects_are_known() {
        let mut seen = Effects::NONE;
        for recipe in lapidary_wgsl::RECIPES {
            let (module, _) = lapidary_specialise::parse(&recipe.compose(), recipe.name).expect("a valid recipe");
            for (_, of) in module.overrides.iter() {
                let name = of.name.clone().unwrap_or_default();
                if name.starts_with("EFFECT_") {
                    let known = Effect::ALL.into_iter().find(|effect| effect.override_name() == name);
                    seen = seen.and(Effects::of(&[known.unwrap_or_else(|| panic!("{name} of {}", recipe.name))]));
                }
            }
        }
        for effect in Effect::ALL {
            assert!(seen.has(effect), "no recipe has {effect}");
        }
    }

    #[test]
    fn a_set_has_what_was_put_into_it() {
        let both = Effects::of(&[Effect::Spot]).and(Effects::SHEEN);
        for effect in Effect::ALL {
            let expected = [Effect::Spot, Effect::Microfacet, Effect::Reflection].contains(&effect);
            assert_eq!(both.has(effect), expected, "{effect}");
        }
    }
}
