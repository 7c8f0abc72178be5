//! A recipe specialised: some of its entry points with override values, and the bindings that are left of it.

use lapidary_gpu::capture::Pipeline;
use lapidary_gpu::{Device, GpuError};
use lapidary_specialise::spirv_counts::{self, SpirvCounts, SpirvCountsError, spirv_counts};
use lapidary_specialise::{SourceError, SpecialiseError, declared, parse, specialise};
use naga::valid::ModuleInfo;
use std::borrow::Cow;

/// Why a recipe was not compiled.
#[derive(Debug, thiserror::Error)]
pub enum ShaderError {
    /// The text is not valid.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// It does not specialise.
    #[error(transparent)]
    Specialise(#[from] SpecialiseError),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// A recipe's specialised part.
#[derive(Debug)]
pub struct Shader {
    recipe: String,
    entries: Vec<String>,
    overrides: Vec<(String, f64)>,
    module: naga::Module,
    info: ModuleInfo,
}

impl Shader {
    /// Specialises the `entries` of `source`, the composed text of `recipe`, to override values: bools as 0 or 1; those that the text does not declare are
    /// left out.
    pub fn new(recipe: &str, source: &str, entries: &[&str], constants: &[(&str, f64)]) -> Result<Self, ShaderError> {
        let (module, _) = parse(source, &format!("recipe {recipe}"))?;
        let declared = declared(&module, constants);
        let (module, info) = specialise(module, &declared, entries).map_err(|error| match error {
            SpecialiseError::NoEntryPoint { .. } => {
                ShaderError::Source(SourceError(format!("recipe {recipe}: {error}")))
            }
            error => error.into(),
        })?;
        Ok(Self {
            recipe: recipe.to_owned(),
            entries: entries.iter().map(|&entry| entry.to_owned()).collect(),
            overrides: declared.iter().map(|&(name, value)| (name.to_owned(), value)).collect(),
            module,
            info,
        })
    }

    /// Group and number of each binding that is left.
    pub fn bindings(&self) -> Bindings {
        let places = self.module.global_variables.iter().filter_map(|(_, global)| global.binding);
        Bindings(places.map(|at| (at.group, at.binding)).collect())
    }

    /// Sends it to the device.
    pub fn upload(&self, device: &Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&self.recipe),
            source: wgpu::ShaderSource::Naga(Cow::Owned(self.module.clone())),
        })
    }

    /// What a vertex and a fragment entry point, in this order, are made of.
    pub fn counts(&self) -> Result<SpirvCounts, SpirvCountsError> {
        let [vertex, fragment] = [0, 1].map(|place| self.entries.get(place).map_or("", String::as_str));
        spirv_counts(&self.module, &self.info, vertex, fragment)
    }

    /// What a capture says of a pipeline called `name`.
    pub fn description(&self, name: &str) -> Pipeline {
        let counts = spirv_counts::instructions(&self.module, &self.info);
        Pipeline {
            name: name.to_owned(),
            recipe: self.recipe.clone(),
            entries: self.entries.clone(),
            overrides: self.overrides.clone(),
            bindings: self.bindings().0,
            instructions: counts,
        }
    }
}

/// The bindings of a shader: group and number.
#[derive(Clone, Debug, Default)]
pub struct Bindings(Vec<(u32, u32)>);

impl Bindings {
    /// Whether there is this one.
    pub fn has(&self, group: u32, binding: u32) -> bool {
        self.0.contains(&(group, binding))
    }

    /// The bind group of those of `resources`, by number, that there are. Nothing where there is none in this group.
    pub fn bind(
        &self,
        device: &Device,
        layout: impl FnOnce(u32) -> wgpu::BindGroupLayout,
        group: u32,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> Option<wgpu::BindGroup> {
        let used = resources.iter().filter(|(binding, _)| self.has(group, *binding));
        let entries: Vec<wgpu::BindGroupEntry<'_>> = used
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding: *binding, resource: resource.clone() })
            .collect();
        if entries.is_empty() {
            return None;
        }
        let layout = &layout(group);
        Some(device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries }))
    }
}
