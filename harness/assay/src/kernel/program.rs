//! A compute entry point on the device: reflects its bindings, uploads buffers and reads them back.

use super::buffers::Type;
use crate::dispatch::layout::Layout;
use crate::dispatch::parse;
use crate::dispatch::signature::of_type;
use crate::formula::Words;
use lapidary_gpu::Gpu;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A buffer that the entry point uses.
#[derive(Clone, Debug)]
pub(super) struct Binding {
    pub(super) name: String,
    pub(super) ty: Type,
    pub(super) is_written: bool,
    group: u32,
    binding: u32,
    is_uniform: bool,
    layout: Layout,
}

/// A compiled entry point.
#[derive(Debug)]
pub(super) struct Program<'a> {
    gpu: &'a Gpu,
    entry: String,
    pipeline: wgpu::ComputePipeline,
    pub(super) bindings: Vec<Binding>,
}

impl<'a> Program<'a> {
    /// Compiles `entry` of `source` with the given values of its overrides.
    pub(super) fn new(
        gpu: &'a Gpu,
        source: &str,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Result<Program<'a>, String> {
        let (module, info) = parse(source, "the source").map_err(|error| error.to_string())?;
        let index = module
            .entry_points
            .iter()
            .position(|point| point.name == entry && point.stage == naga::ShaderStage::Compute)
            .ok_or("the source has no compute entry point of that name")?;
        let used = info.get_entry_point(index);
        let mut bindings = Vec::new();
        for (handle, variable) in module.global_variables.iter().filter(|(handle, _)| !used[*handle].is_empty()) {
            if let Some(place) = variable.binding {
                bindings.push(reflect(&module, handle, place)?);
            }
        }
        bindings.sort_by_key(|binding| (binding.group, binding.binding));
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
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                cache: None,
            })
        });
        let pipeline = pipeline.map_err(|error| error.to_string())?;
        Ok(Self { gpu, entry: entry.to_owned(), pipeline, bindings })
    }

    /// Dispatches the entry point on these buffers and returns the words of every buffer
    /// afterwards.
    pub(super) fn run(&self, before: &[Words], workgroups: [u32; 3]) -> Result<Vec<Words>, String> {
        let mut buffers = Vec::new();
        for (binding, words) in self.bindings.iter().zip(before) {
            let elements = words.len() / binding.ty.shape.words();
            if elements == 0 {
                return Err(format!("`{}` is empty, and WebGPU has no empty buffers; draw an element", binding.name));
            }
            let mut bytes = vec![0; elements * binding.layout.stride];
            binding.layout.scatter(words, &mut bytes);
            buffers.push((self.upload(binding, &bytes)?, elements));
        }
        self.dispatch(&buffers, workgroups)?;
        let mut after = before.to_vec();
        for ((binding, words), (buffer, elements)) in self.bindings.iter().zip(&mut after).zip(&buffers) {
            if binding.is_written {
                let read = self.gpu.words(buffer).map_err(|error| error.to_string())?;
                let bytes: Vec<u8> = read.iter().flat_map(|word| word.to_ne_bytes()).collect();
                binding.layout.gather(&bytes, *elements, words);
            }
        }
        Ok(after)
    }

    fn upload(&self, binding: &Binding, bytes: &[u8]) -> Result<wgpu::Buffer, String> {
        use wgpu::BufferUsages as Usage;
        let usage = if binding.is_uniform { Usage::UNIFORM } else { Usage::STORAGE };
        let buffer = self.gpu.guarded(&format!("allocating `{}`", binding.name), |device| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(&binding.name),
                size: bytes.len() as u64,
                usage: usage | Usage::COPY_DST | Usage::COPY_SRC,
                mapped_at_creation: false,
            });
            self.gpu.queue.write_buffer(&buffer, 0, bytes);
            buffer
        });
        buffer.map_err(|error| error.to_string())
    }

    fn dispatch(&self, buffers: &[(wgpu::Buffer, usize)], workgroups: [u32; 3]) -> Result<(), String> {
        let mut groups: BTreeMap<u32, Vec<wgpu::BindGroupEntry<'_>>> = BTreeMap::new();
        for (binding, (buffer, _)) in self.bindings.iter().zip(buffers) {
            let entry = wgpu::BindGroupEntry { binding: binding.binding, resource: buffer.as_entire_binding() };
            groups.entry(binding.group).or_default().push(entry);
        }
        let run = self.gpu.guarded(&format!("running `{}`", self.entry), |device| {
            let groups: Vec<(u32, wgpu::BindGroup)> = groups
                .iter()
                .map(|(group, entries)| {
                    let layout = self.pipeline.get_bind_group_layout(*group);
                    let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &layout, entries };
                    (*group, device.create_bind_group(&descriptor))
                })
                .collect();
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&self.pipeline);
                for (group, bound) in &groups {
                    pass.set_bind_group(*group, bound, &[]);
                }
                let [x, y, z] = workgroups;
                pass.dispatch_workgroups(x, y, z);
            }
            self.gpu.queue.submit([encoder.finish()]);
        });
        run.map_err(|error| error.to_string())
    }
}

/// Describes a global variable as a buffer.
fn reflect(
    module: &naga::Module,
    handle: naga::Handle<naga::GlobalVariable>,
    place: naga::ResourceBinding,
) -> Result<Binding, String> {
    let variable = &module.global_variables[handle];
    let name = variable.name.clone().unwrap_or_default();
    let (is_uniform, is_written) = match variable.space {
        naga::AddressSpace::Uniform => (true, false),
        naga::AddressSpace::Storage { access } => (false, access.contains(naga::StorageAccess::STORE)),
        _ => return Err(format!("`{name}` is no buffer; test kernels of buffers, or the functions that they call")),
    };
    let (element, is_runtime_sized) = match module.types[variable.ty].inner {
        naga::TypeInner::Array { base, size: naga::ArraySize::Dynamic, .. } => (base, true),
        _ => (variable.ty, false),
    };
    let shape = of_type(module, element).map_err(|fault| format!("`{name}`: {fault}"))?;
    Ok(Binding {
        name,
        ty: Type { shape, is_runtime_sized },
        is_written,
        group: place.group,
        binding: place.binding,
        is_uniform,
        layout: Layout::of_type(module, variable.ty),
    })
}
