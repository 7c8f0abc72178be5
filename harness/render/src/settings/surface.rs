//! Options of bodies that are shaded at their surface: curvature and shadows in the forms that the recipe
//! `cdrf_shading` numbers.

/// Options of the recipe `cdrf_shading`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiffuseOptions {
    /// Curvature that spreads the light.
    pub curvature: Curvature,
    /// How far shadows follow the light inside, where they are those of scattering matter.
    pub shadows: ShadowForm,
    /// Whether the environment's light is summed per vertex; per pixel otherwise.
    pub environment_at_vertices: bool,
}

impl Default for DiffuseOptions {
    fn default() -> Self {
        Self { curvature: Curvature::Vertex, shadows: ShadowForm::default(), environment_at_vertices: true }
    }
}

/// The curvature that determines how far light spreads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// The mean curvature.
    Mean,
    /// The normal curvature of the section towards each light.
    Towards,
    /// The usual |dN| / |dP|.
    Naive,
    /// The mean curvature of the mesh, given for each vertex.
    Vertex,
}

impl Curvature {
    /// All curvatures.
    pub const ALL: [Self; 4] = [Self::Mean, Self::Towards, Self::Naive, Self::Vertex];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Towards => "towards",
            Self::Naive => "naive",
            Self::Vertex => "vertex",
        }
    }

    /// Returns `CURVATURE_FORM` of the recipe.
    pub(crate) fn form(self) -> u32 {
        match self {
            Self::Mean => 0,
            Self::Towards => 1,
            Self::Naive => 2,
            Self::Vertex => 3,
        }
    }
}

/// How far the shadows of bodies that scatter follow their light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowForm {
    /// Edges of one width for all colours.
    Soft,
    /// Edges of each colour's width.
    Colors,
    /// These, and light that comes through thin parts.
    #[default]
    Through,
}

impl ShadowForm {
    /// All forms, each with more than the one before.
    pub const ALL: [Self; 3] = [Self::Soft, Self::Colors, Self::Through];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Soft => "soft",
            Self::Colors => "colors",
            Self::Through => "through",
        }
    }

    /// Returns `SHADOW_FORM` of the recipe.
    pub(crate) fn form(self) -> u32 {
        match self {
            Self::Soft => 0,
            Self::Colors => 1,
            Self::Through => 2,
        }
    }
}
