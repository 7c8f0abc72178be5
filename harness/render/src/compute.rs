//! A compute entry point of a recipe, specialised, and bound by what is left of its bindings.

mod recipe;

pub use recipe::{Binding, RecipeRun, run_recipe};

use crate::shader::{Bindings, Shader, ShaderError};
use lapidary_gpu::{Device, Gpu, capture};

/// A compiled entry point.
#[derive(Debug)]
pub struct Kernel {
    /// The pipeline.
    pub pipeline: wgpu::ComputePipeline,
    bindings: Bindings,
}

impl Kernel {
    /// Compiles `entry` of `source`, the composed text of `recipe`, with these overrides: bools as 0 or 1; those that the text does not declare are left out.
    ///
    /// # Errors
    /// Where the text is not valid or the device refuses it.
    pub fn new(
        gpu: &Gpu,
        recipe: &str,
        source: &str,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Result<Self, ShaderError> {
        let shader = Shader::new(recipe, source, &[entry], constants)?;
        let pipeline = gpu.guarded(&format!("compiling `{entry}`"), |device| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: None,
                module: &shader.upload(device),
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })?;
        capture::compute_pipeline(&pipeline, || shader.description(entry));
        Ok(Self { pipeline, bindings: shader.bindings() })
    }

    /// Whether it reads or writes this binding.
    #[must_use]
    pub fn binds(&self, group: u32, binding: u32) -> bool {
        self.bindings.has(group, binding)
    }

    /// The bind group of those of `resources`, by number, that the entry point reads or writes. Nothing where it has none in this group.
    pub fn bind(
        &self,
        device: &Device,
        group: u32,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> Option<wgpu::BindGroup> {
        self.bindings.bind(device, |group| self.pipeline.get_bind_group_layout(group), group, resources)
    }
}
