//! A compute entry point of a recipe, specialised, and bound by what is left of its bindings.

use crate::dispatch::{self, DispatchError};
use crate::gpu::{Gpu, GpuError};
use crate::specialise::{SpecialiseError, specialise};
use std::borrow::Cow;

/// Why an entry point was not compiled.
#[derive(Debug, thiserror::Error)]
pub enum KernelError {
    /// The text is not valid.
    #[error(transparent)]
    Dispatch(#[from] DispatchError),
    /// It does not specialise.
    #[error(transparent)]
    Specialise(#[from] SpecialiseError),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// A compiled entry point.
#[derive(Debug)]
pub struct Kernel {
    /// The pipeline.
    pub pipeline: wgpu::ComputePipeline,
    /// Group and number of each binding that it reads or writes.
    bindings: Vec<(u32, u32)>,
}

impl Kernel {
    /// Compiles `entry` of `source` with these overrides: bools as 0 or 1; those that the text does not declare are left out.
    ///
    /// # Errors
    /// Where the text is not valid or the device refuses it.
    pub fn new(gpu: &Gpu, source: &str, entry: &str, constants: &[(&str, f64)]) -> Result<Self, KernelError> {
        let (module, _) = dispatch::parse(source, entry)?;
        let constants = dispatch::declared(&module, constants);
        let (module, _) = specialise(module, &constants, &[entry])?;
        let places = module.global_variables.iter().filter_map(|(_, global)| global.binding);
        let bindings = places.map(|at| (at.group, at.binding)).collect();
        let pipeline = gpu.guarded(&format!("compiling `{entry}`"), |device| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(entry),
                source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })?;
        Ok(Self { pipeline, bindings })
    }

    /// The bind group of those of `resources`, by number, that the entry point reads or writes. Nothing where it has none in this group.
    pub fn bind(
        &self,
        device: &wgpu::Device,
        group: u32,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> Option<wgpu::BindGroup> {
        let used = resources.iter().filter(|(binding, _)| self.bindings.contains(&(group, *binding)));
        let entries: Vec<wgpu::BindGroupEntry<'_>> = used
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding: *binding, resource: resource.clone() })
            .collect();
        if entries.is_empty() {
            return None;
        }
        let layout = &self.pipeline.get_bind_group_layout(group);
        Some(device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries }))
    }
}
