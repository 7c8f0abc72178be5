//! The effects, each with its one name.

use lapidary_files::nearest::suggest;
use std::fmt;
use std::str::FromStr;

/// Declares the effects: variant, name, and the recipes' override, which is the name in capitals.
macro_rules! effects {
    ($($(#[$doc:meta])* $effect:ident = $name:literal, $override:literal;)*) => {
        /// Something that a material or a scene may require. If neither does, it is neither
        /// compiled, bound nor dispatched.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Effect {
            $($(#[$doc])* $effect,)*
        }

        impl Effect {
            /// Every effect, once.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$effect),*];

            /// Returns the name used in plans and on the command line; if the effect is a single
            /// module, the module's name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$effect => $name,)*
                }
            }

            /// Returns the name of the recipes' override that compiles the effect.
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
    /// Light through a clear stone, using a proxy of its inside.
    ProxyGeometry = "proxy_geometry", "EFFECT_PROXY_GEOMETRY";
    /// Light through a convex clear stone, using the planes of its facets.
    ConvexTrace = "convex_trace", "EFFECT_CONVEX_TRACE";
    /// Light through any clear stone, using its triangles.
    BvhTrace = "bvh_trace", "EFFECT_BVH_TRACE";
    /// The environment seen through a clear wall without an inside.
    ThinWall = "thin_wall", "EFFECT_THIN_WALL";
    /// Absorption of light inside a clear stone.
    Absorption = "absorption", "EFFECT_ABSORPTION";
    /// Refractive index that differs between colours.
    Dispersion = "dispersion", "EFFECT_DISPERSION";
    /// Copies of a clear stone, drawn in one call at places and in colours of their own.
    Instances = "instances", "EFFECT_INSTANCES";
    /// Facets' edges inside a clear stone, smoothed from one sample per pixel.
    Footprint = "footprint", "EFFECT_FOOTPRINT";
    /// Bodies that the picture shows, met by what leaves a clear stone.
    ScreenTrace = "screen_trace", "EFFECT_SCREEN_TRACE";
    /// Bounds of other bodies, met by what leaves a clear stone.
    BoundsTrace = "bounds_trace", "EFFECT_BOUNDS_TRACE";
    /// Bodies within clear ones, or in the same space.
    Nested = "nested", "EFFECT_NESTED";
    /// Clear bodies behind clear ones.
    Behind = "behind", "EFFECT_BEHIND";
    /// Bodies that are not clear, met by what leaves a clear one, by their triangles.
    Around = "around", "EFFECT_AROUND";
    /// Normals between a triangle's corners that reflect and refract in a clear body.
    Smooth = "smooth", "EFFECT_SMOOTH";
    /// Facets of a clear body's rough surface that reflect and refract, at random.
    Rough = "rough", "EFFECT_ROUGH";
    /// Discs of suns and lamps, which light that leaves a clear body comes from.
    Light = "light", "EFFECT_LIGHT";
    /// Subsurface light from the lit side to the dark side, by curvature.
    Cdrf = "cdrf", "EFFECT_CDRF";
    /// Subsurface light as in `cdrf`, by a blur of the incident light.
    TextureDiffusion = "texture_diffusion", "EFFECT_TEXTURE_DIFFUSION";
    /// The law by which a half space of scattering matter sends light back, in place of Lambert's.
    HalfSpace = "half_space", "EFFECT_HALF_SPACE";
    /// Light through a body, along the path of least cost.
    OpticalPath = "optical_path", "EFFECT_OPTICAL_PATH";
    /// Light through a body, by the diffusion of its fluence.
    Diffusion = "diffusion", "EFFECT_DIFFUSION";
    /// Lamps inside a body through which light diffuses.
    LampInside = "lamp_inside", "EFFECT_LAMP_INSIDE";
    /// Voxels touched by the surface, in addition to those whose centre is inside.
    Surface = "surface", "EFFECT_SURFACE";
    /// Path cost that differs between colours.
    Color = "color", "EFFECT_COLOR";
    /// Density that varies within the body.
    ExtinctionPerVoxel = "extinction_per_voxel", "EFFECT_EXTINCTION_PER_VOXEL";
    /// Shadows that bodies cast on one another and on themselves.
    Shadow = "shadow", "EFFECT_SHADOW";
    /// Shadows on a scattering body that its light softens, and light through its thin parts.
    TranslucentShadow = "translucent_shadow", "EFFECT_TRANSLUCENT_SHADOW";
    /// Light that clear stones let through and colour, on what lies behind them.
    ColoredShadow = "colored_shadow", "EFFECT_COLORED_SHADOW";
    /// Diffuse light from all directions.
    Environment = "environment", "EFFECT_ENVIRONMENT";
    /// Surface that refracts light and reflects it back inside.
    Dielectric = "dielectric", "EFFECT_DIELECTRIC";
    /// Environment given as an image.
    EnvironmentMap = "environment_map", "EFFECT_ENVIRONMENT_MAP";
    /// Diffuse colour that varies over the surface, by an image.
    BaseColorTexture = "base_color_texture", "EFFECT_BASE_COLOR_TEXTURE";
    /// Slopes of the surface that are too fine for the mesh, by an image.
    NormalTexture = "normal_texture", "EFFECT_NORMAL_TEXTURE";
    /// Roughness, and what of a surface is a metal's, which vary over it by an image.
    RoughnessTexture = "roughness_texture", "EFFECT_ROUGHNESS_TEXTURE";
    /// Spread of light that varies over the surface, by an image.
    ThicknessTexture = "thickness_texture", "EFFECT_THICKNESS_TEXTURE";
    /// Light that does not enter a body, and is reflected as by an opaque one.
    PartialTransmission = "partial_transmission", "EFFECT_PARTIAL_TRANSMISSION";
    /// Share of the light that enters, which varies over the surface by an image.
    TransmissionTexture = "transmission_texture", "EFFECT_TRANSMISSION_TEXTURE";
    /// Diffuse colour that varies from vertex to vertex.
    VertexColor = "vertex_color", "EFFECT_VERTEX_COLOR";
    /// Points that cover what is behind them in part, or not at all: `alphaMode`.
    Coverage = "coverage", "EFFECT_COVERAGE";
    /// Highlights of the lights on a rough surface.
    Microfacet = "microfacet", "EFFECT_MICROFACET";
    /// A second width of the highlights, mixed with the first.
    SecondLobe = "second_lobe", "EFFECT_SECOND_LOBE";
    /// Reflection of the environment in a polished surface.
    Reflection = "reflection", "EFFECT_REFLECTION";
    /// What a metal reflects of the environment, rough as it is, and of the lights.
    Metal = "metal", "EFFECT_METAL";
    /// Lights that shine into a cone.
    Spot = "spot", "EFFECT_SPOT";
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that belongs to no effect.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no effect `{name}`{suggestion}")]
pub struct UnknownEffect {
    /// The unknown name.
    pub name: String,
    /// `; did you mean ...?`, or empty.
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
pub struct Effects(u64);

impl Effects {
    /// The empty set.
    pub const NONE: Self = Self(0);
    /// The effects of a scattering body's surface that reflects light, from outside and from inside.
    pub const SHEEN: Self = Self::of(&[Effect::Dielectric, Effect::Microfacet, Effect::SecondLobe, Effect::Reflection]);

    /// Returns the set of the given effects.
    #[must_use]
    pub const fn of(effects: &[Effect]) -> Self {
        let (mut set, mut index) = (0, 0);
        while index < effects.len() {
            set |= 1 << effects[index] as u64;
            index += 1;
        }
        Self(set)
    }

    /// Returns the union of two sets.
    #[must_use]
    pub const fn and(self, others: Self) -> Self {
        Self(self.0 | others.0)
    }

    /// Whether the set contains an effect.
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
            for (_, declaration) in module.overrides.iter() {
                let name = declaration.name.clone().unwrap_or_default();
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
            let sheen = [Effect::Dielectric, Effect::Microfacet, Effect::SecondLobe, Effect::Reflection];
            let expected = effect == Effect::Spot || sheen.contains(&effect);
            assert_eq!(both.has(effect), expected, "{effect}");
        }
    }
}
