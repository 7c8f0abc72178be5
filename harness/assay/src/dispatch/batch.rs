//! One dispatch: sends a batch of rows to the device and reads back results and turn counts.

use super::compiled::Compiled;
use super::error::DispatchError;
use super::kernel::WORKGROUP_SIZE;
use super::turns::{self, LAVAPIPE_ENDS_AT};
use lapidary_gpu::Gpu;

/// Workgroups along one axis that WebGPU guarantees.
const MOST_WORKGROUPS: usize = 65_535;

/// Device buffers for the rows.
#[derive(Debug)]
struct Buffers {
    capacity: usize,
    inputs: wgpu::Buffer,
    outputs: wgpu::Buffer,
    readback: wgpu::Buffer,
    /// Counts, and the buffer that reads them back; `None` if the function has no loop.
    turns: Option<[wgpu::Buffer; 2]>,
    staging: Vec<u8>,
}

/// A compiled kernel on its device, with the buffers that its batches share.
#[derive(Debug)]
pub(super) struct Dispatcher<'gpu> {
    pub(super) gpu: &'gpu Gpu,
    pub(super) compiled: Compiled,
    buffers: Option<Buffers>,
}

impl<'gpu> Dispatcher<'gpu> {
    pub(super) fn new(gpu: &'gpu Gpu, compiled: Compiled) -> Self {
        Self { gpu, compiled, buffers: None }
    }

    /// Runs a batch. `turns` then holds the count of each row, or is empty if the function has no
    /// loop.
    pub(super) fn batch(
        &mut self,
        arguments: &[u32],
        results: &mut Vec<u32>,
        turns: &mut Vec<u32>,
    ) -> Result<(), DispatchError> {
        let pipeline = self.compiled.pipeline.clone();
        self.dispatch(&pipeline, WORKGROUP_SIZE as usize, arguments, results, turns)?;
        let Some(alone) = self.compiled.turns.as_ref().and_then(|turns| turns.alone.clone()) else { return Ok(()) };
        // lavapipe counts a turn that any invocation of a group takes. Together they take at most
        // the sum of all. If that reaches its limit, a row may have been cut short although its own
        // count is below the limit.
        let suspect: Vec<usize> = turns
            .chunks(WORKGROUP_SIZE as usize)
            .enumerate()
            .filter(|(_, group)| group.iter().map(|turns| u64::from(*turns)).sum::<u64>() >= LAVAPIPE_ENDS_AT)
            .flat_map(|(group, rows)| (0..rows.len()).map(move |row| group * WORKGROUP_SIZE as usize + row))
            .filter(|row| !self.compiled.is_over(turns[*row]))
            .collect();
        let (width, result_width) = (self.compiled.argument_words(), self.compiled.result_words());
        let (mut again, mut counted) = (Vec::new(), Vec::new());
        for rows in suspect.chunks(MOST_WORKGROUPS) {
            let inputs: Vec<u32> =
                rows.iter().flat_map(|row| &arguments[row * width..(row + 1) * width]).copied().collect();
            self.dispatch(&alone, 1, &inputs, &mut again, &mut counted)?;
            for ((row, result), count) in rows.iter().zip(again.chunks_exact(result_width)).zip(&counted) {
                results[row * result_width..(row + 1) * result_width].copy_from_slice(result);
                turns[*row] = *count;
            }
        }
        Ok(())
    }

    fn dispatch(
        &mut self,
        pipeline: &wgpu::ComputePipeline,
        workgroup: usize,
        arguments: &[u32],
        results: &mut Vec<u32>,
        turns: &mut Vec<u32>,
    ) -> Result<(), DispatchError> {
        let rows = arguments.len() / self.compiled.argument_words();
        if self.buffers.as_ref().is_none_or(|buffers| buffers.capacity < rows) {
            self.buffers = Some(self.allocate(rows)?);
        }
        let Some(buffers) = &mut self.buffers else { unreachable!("allocated above") };
        let input_bytes = rows * self.compiled.input.stride;
        let output_bytes = (rows * self.compiled.output.stride) as u64;
        let turn_bytes = 4 * rows as u64;
        self.compiled.input.scatter(arguments, &mut buffers.staging[..input_bytes]);
        self.gpu.queue.write_buffer(&buffers.inputs, 0, &buffers.staging[..input_bytes]);
        self.gpu.guarded(&format!("running `{}`", self.compiled.signature.function), |device| {
            // The bindings cover only the rows in use, so that arrayLength is their number.
            let mut entries = vec![
                wgpu::BindGroupEntry { binding: 0, resource: sized(&buffers.inputs, input_bytes as u64) },
                wgpu::BindGroupEntry { binding: 1, resource: sized(&buffers.outputs, output_bytes) },
            ];
            if let Some([counts, _]) = &buffers.turns {
                let resource = sized(counts, turn_bytes);
                entries.push(wgpu::BindGroupEntry { binding: turns::BINDING, resource });
            }
            let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &bind_group, &[]);
                let workgroups = rows.div_ceil(workgroup);
                pass.dispatch_workgroups(u32::try_from(workgroups).expect("at most 65,535 workgroups"), 1, 1);
            }
            encoder.copy_buffer_to_buffer(&buffers.outputs, 0, &buffers.readback, 0, output_bytes);
            if let Some([counts, readback]) = &buffers.turns {
                encoder.copy_buffer_to_buffer(counts, 0, readback, 0, turn_bytes);
            }
            self.gpu.queue.submit([encoder.finish()]);
        })?;
        self.gpu
            .read_back(&buffers.readback, output_bytes, |bytes| self.compiled.output.gather(bytes, rows, results))?;
        turns.clear();
        if let Some([_, readback]) = &buffers.turns {
            self.gpu.read_back(readback, turn_bytes, |bytes| {
                turns
                    .extend(bytes.chunks_exact(4).map(|word| u32::from_ne_bytes([word[0], word[1], word[2], word[3]])));
            })?;
        }
        Ok(())
    }

    fn allocate(&self, rows: usize) -> Result<Buffers, DispatchError> {
        let capacity = rows.next_power_of_two();
        let buffer = |label, bytes: usize, usage| {
            self.gpu.guarded("allocating kernel buffers", |device| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: bytes as u64,
                    usage,
                    mapped_at_creation: false,
                })
            })
        };
        use wgpu::BufferUsages as Usage;
        let (written, read) = (Usage::STORAGE | Usage::COPY_SRC, Usage::COPY_DST | Usage::MAP_READ);
        let turns = match self.compiled.turns {
            None => None,
            Some(_) => Some([buffer("turns", 4 * capacity, written)?, buffer("turns read", 4 * capacity, read)?]),
        };
        Ok(Buffers {
            capacity,
            inputs: buffer("inputs", capacity * self.compiled.input.stride, Usage::STORAGE | Usage::COPY_DST)?,
            outputs: buffer("outputs", capacity * self.compiled.output.stride, written)?,
            readback: buffer("readback", capacity * self.compiled.output.stride, read)?,
            turns,
            staging: vec![0; capacity * self.compiled.input.stride],
        })
    }
}

fn sized(buffer: &wgpu::Buffer, size: u64) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: wgpu::BufferSize::new(size) })
}
