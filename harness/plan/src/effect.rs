//! The effects, each by its one name.

use lapidary_scene::nearest::suggest;
use std::fmt;
use std::str::FromStr;

/// Declares the effects: variant, name, and the recipes' override, which is the name in capitals.
macro_rules! effects {
    ($($(#[$doc:meta])* $effect:ident = $name:literal, $override:literal;)*) => {
        /// What a material or a scene may call for, and what else is neither compiled, nor bound, nor dispatched.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Effect {
            $($(#[$doc])* $effect,)*
        }

        impl Effect {
            /// Every effect, each once.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$effect),*];

            /// Its name in plans and on the command line: a module's, where it is one module.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$effect => $name,)*
                }
            }

            /// The recipes' override that compiles it.
            #[must_use]
            pub const fn override_name(self) -> &'static str {
                match self {
                    $(Self::$effect => $override,)*
                }
            }
        }
    };
}

effects! {
    /// Light through a clear stone, by a proxy of its inside.
    ProxyGeometry = "proxy_geometry", "EFFECT_PROXY_GEOMETRY";
    /// Light through a convex clear stone, by its facets' planes.
    ConvexTrace = "convex_trace", "EFFECT_CONVEX_TRACE";
    /// Light through any clear stone, by its triangles.
    BvhTrace = "bvh_trace", "EFFECT_BVH_TRACE";
    /// The environment behind a clear wall without an inside.
    ThinWall = "thin_wall", "EFFECT_THIN_WALL";
    /// Light is absorbed inside a clear stone.
    Absorption = "absorption", "EFFECT_ABSORPTION";
    /// The refractive index differs from colour to colour.
    Dispersion = "dispersion", "EFFECT_DISPERSION";
    /// Light that crosses below the surface from the lit side to the dark one, by curvature.
    Cdrf = "cdrf", "EFFECT_CDRF";
    /// The same by a blur of the light that arrives.
    TextureDiffusion = "texture_diffusion", "EFFECT_TEXTURE_DIFFUSION";
    /// Light that comes through a body, along the way that costs it least.
    OpticalPath = "optical_path", "EFFECT_OPTICAL_PATH";
    /// Voxels that the surface touches, beside those whose centre is inside.
    Surface = "surface", "EFFECT_SURFACE";
    /// A way's cost differs from colour to colour.
    Color = "color", "EFFECT_COLOR";
    /// Matter is denser here than there.
    ExtinctionPerVoxel = "extinction_per_voxel", "EFFECT_EXTINCTION_PER_VOXEL";
    /// Bodies keep a light from one another and from themselves.
    Shadow = "shadow", "EFFECT_SHADOW";
    /// Diffuse light from all around.
    Environment = "environment", "EFFECT_ENVIRONMENT";
    /// The environment is an image.
    EnvironmentMap = "environment_map", "EFFECT_ENVIRONMENT_MAP";
    /// The lights' highlights on a rough surface.
    Microfacet = "microfacet", "EFFECT_MICROFACET";
    /// The environment in a polished surface.
    Reflection = "reflection", "EFFECT_REFLECTION";
    /// Lights that shine into a cone.
    Spot = "spot", "EFFECT_SPOT";
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
