//! Where a language finds what a shader binds.

use crate::{Language, Setting};
use naga::back::{hlsl, msl};
use naga::{AddressSpace, GlobalVariable, Handle, ImageClass, Module, ResourceBinding, StorageAccess, Type, TypeInner};
use std::collections::BTreeMap;

/// A binding's place in a language.
pub struct Place {
    /// Group and binding in WGSL; `None` for what it does not have.
    pub wgsl: Option<ResourceBinding>,
    /// Name in WGSL, the same in the language.
    pub name: String,
    /// Where the language finds it.
    pub place: String,
}

/// What a shader binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A uniform buffer.
    Uniform,
    /// A storage buffer.
    Storage {
        /// Whether the shader may write it.
        writes: bool,
    },
    /// A texture that is sampled or loaded.
    Texture,
    /// A texture whose texels are written, or read one by one.
    StorageTexture {
        /// Whether the shader may write it.
        writes: bool,
    },
    /// A sampler.
    Sampler,
}

impl Kind {
    /// Returns WebGPU's word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Storage { writes: true } => "storage",
            Self::Storage { writes: false } => "read-only-storage",
            Self::Texture => "texture",
            Self::StorageTexture { .. } => "storage-texture",
            Self::Sampler => "sampler",
        }
    }
}

/// A binding of a shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bound {
    /// Number of the group.
    pub group: u32,
    /// Number within the group.
    pub binding: u32,
    /// Name in WGSL.
    pub name: String,
    /// What is bound.
    pub kind: Kind,
    /// Its type in the module.
    pub ty: Handle<Type>,
}

/// Returns a shader's bindings, by group and number.
#[must_use]
pub fn bindings(module: &Module) -> Vec<Bound> {
    let bound = module.global_variables.iter().filter_map(|(_, variable)| {
        let slot = variable.binding?;
        let name = variable.name.clone().unwrap_or_default();
        Some(Bound { group: slot.group, binding: slot.binding, name, kind: kind(module, variable), ty: variable.ty })
    });
    let mut bound: Vec<Bound> = bound.collect();
    bound.sort_by_key(|bound| (bound.group, bound.binding));
    bound
}

fn kind(module: &Module, variable: &GlobalVariable) -> Kind {
    let writes = |access: StorageAccess| access.contains(StorageAccess::STORE);
    match (variable.space, &module.types[variable.ty].inner) {
        (AddressSpace::Uniform, _) => Kind::Uniform,
        (AddressSpace::Storage { access }, _) => Kind::Storage { writes: writes(access) },
        (_, TypeInner::Sampler { .. }) => Kind::Sampler,
        (_, TypeInner::Image { class: ImageClass::Storage { access, .. }, .. }) => {
            Kind::StorageTexture { writes: writes(*access) }
        }
        _ => Kind::Texture,
    }
}

/// Gives every binding of a shader its place, writes the places into `setting`, and returns in WGSL's order those
/// that are left in `used`. Its entry points have one numbering, so that they can be used together.
pub fn assign(module: &Module, used: &Module, language: Language, setting: &mut Setting) -> Vec<Place> {
    let mut bound: Vec<&GlobalVariable> =
        module.global_variables.iter().map(|(_, variable)| variable).filter(|it| it.binding.is_some()).collect();
    bound.sort_by_key(|variable| variable.binding.map(|binding| (binding.group, binding.binding)));
    // How many of a sort have a place.
    let mut counts: BTreeMap<&str, u32> = BTreeMap::new();
    let mut next = |sort: &'static str| {
        let count = counts.entry(sort).or_default();
        *count += 1;
        *count - 1
    };
    let mut resources = msl::BindingMap::default();
    let mut places = Vec::new();
    for variable in bound {
        let Some(binding) = variable.binding else { continue };
        let (kind, name) = (kind(module, variable), variable.name.clone().unwrap_or_default());
        let place = match language {
            Language::Hlsl => {
                let space = u8::try_from(binding.group).unwrap_or(u8::MAX);
                let target = hlsl::BindTarget { space, register: binding.binding, ..hlsl::BindTarget::default() };
                setting.hlsl.binding_map.insert(binding, target);
                format!("register({}, space{space})", register(kind, binding.binding))
            }
            Language::Msl => {
                let sort = match kind {
                    Kind::Uniform | Kind::Storage { .. } => "buffer",
                    Kind::Texture | Kind::StorageTexture { .. } => "texture",
                    Kind::Sampler => "sampler",
                };
                let slot = next(sort);
                let number = u8::try_from(slot).unwrap_or(u8::MAX);
                let mutable = matches!(kind, Kind::Storage { writes: true } | Kind::StorageTexture { writes: true });
                let mut target = msl::BindTarget { mutable, ..msl::BindTarget::default() };
                match sort {
                    "buffer" => target.buffer = Some(number),
                    "texture" => target.texture = Some(number),
                    _ => target.sampler = Some(msl::BindSamplerTarget::Resource(number)),
                }
                resources.insert(binding, target);
                format!("[[{sort}({slot})]]")
            }
            Language::Glsl => match kind {
                Kind::Sampler => "with its textures".to_owned(),
                _ => {
                    let sort = match kind {
                        Kind::Uniform => "uniform block",
                        Kind::Storage { .. } => "storage block",
                        Kind::StorageTexture { .. } => "image",
                        _ => "texture unit",
                    };
                    let slot = next(sort);
                    setting.glsl.insert(binding, u8::try_from(slot).unwrap_or(u8::MAX));
                    format!("{sort}, binding = {slot}")
                }
            },
            Language::GlslEs => match kind {
                Kind::Sampler => "with its textures".to_owned(),
                Kind::Uniform => format!("uniform block `{name}_block`"),
                _ => "uniform of its name".to_owned(),
            },
        };
        if used.global_variables.iter().any(|(_, left)| left.binding == variable.binding) {
            places.push(Place { wgsl: Some(binding), name, place });
        }
    }
    if language == Language::Msl {
        let sizes = (!sized(module).is_empty()).then(|| u8::try_from(next("buffer")).unwrap_or(u8::MAX));
        for entry in &used.entry_points {
            let entry_resources =
                msl::EntryPointResources { resources: resources.clone(), sizes_buffer: sizes, ..Default::default() };
            setting.msl.per_entry_point_map.insert(entry.name.clone(), entry_resources);
        }
        if let (Some(slot), false) = (sizes, sized(used).is_empty()) {
            let place = format!("[[buffer({slot})]]: the sizes in bytes of {}", sized(used).join(", "));
            places.push(Place { wgsl: None, name: "_buffer_sizes".to_owned(), place });
        }
    }
    places
}

/// Returns a register of HLSL.
pub fn register_of(module: &Module, variable: &GlobalVariable) -> String {
    register(kind(module, variable), variable.binding.map_or(0, |binding| binding.binding))
}

fn register(kind: Kind, number: u32) -> String {
    let class = match kind {
        Kind::Uniform => 'b',
        Kind::Storage { writes: true } | Kind::StorageTexture { .. } => 'u',
        Kind::Storage { writes: false } | Kind::Texture => 't',
        Kind::Sampler => 's',
    };
    format!("{class}{number}")
}

/// Returns the names of the buffers whose length the host chooses, in the order of their declarations.
fn sized(module: &Module) -> Vec<String> {
    let is_sized = |variable: &GlobalVariable| module.types[variable.ty].inner.is_dynamically_sized(&module.types);
    let variables = module.global_variables.iter().map(|(_, variable)| variable);
    variables.filter(|variable| is_sized(variable)).filter_map(|variable| variable.name.clone()).collect()
}
