//! Compute shader on wgpu, which reads buffers and returns a picture.

use crate::{SAMPLES, SIDE};
use glam::Vec3;
use std::error::Error;
use wgpu::{
    BufferDescriptor, BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor,
    ComputePipelineDescriptor, DeviceDescriptor, DeviceType, Instance, MapMode, PollType,
    RequestAdapterOptions, ShaderModuleDescriptor, ShaderSource,
};

/// Draws the picture with `draw` of the module `source`: returns the sum of the samples of each pixel, and whether the adapter is a
/// software driver. Buffers 0 to 2 are the hairs, the numbers of the material, and the picture.
pub(crate) fn draw(
    source: &str,
    hairs: &[(Vec3, Vec3)],
    material: &[f32],
) -> Result<(Vec<Vec3>, bool), Box<dyn Error>> {
    let instance = Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&RequestAdapterOptions::default()))?;
    let info = adapter.get_info();
    println!("{}", info.name);
    let request = adapter.request_device(&DeviceDescriptor::default());
    let (device, queue) = pollster::block_on(request)?;

    let hairs: Vec<f32> = hairs
        .iter()
        .flat_map(|(root, tangent)| {
            [
                root.x, root.y, root.z, 0.0, tangent.x, tangent.y, tangent.z, 0.0,
            ]
        })
        .collect();
    let size = (16 * SIDE * SIDE) as u64;
    let buffer = |size: u64, usage| {
        device.create_buffer(&BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let input = |numbers: &[f32]| {
        let bytes: &[u8] = bytemuck::cast_slice(numbers);
        let buffer = buffer(
            bytes.len() as u64,
            BufferUsages::STORAGE | BufferUsages::COPY_DST,
        );
        queue.write_buffer(&buffer, 0, bytes);
        buffer
    };
    let picture = buffer(size, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let read = buffer(size, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let buffers = [input(&hairs), input(material), picture];

    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: None,
        source: ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("draw"),
        compilation_options: Default::default(),
        cache: None,
    });
    let entries: Vec<_> = buffers
        .iter()
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        // One sample per dispatch, because drivers end a shader that loops for long, and lavapipe does so without an error.
        for _ in 0..SAMPLES {
            pass.dispatch_workgroups(u32::try_from((SIDE * SIDE).div_ceil(64))?, 1, 1);
        }
    }
    encoder.copy_buffer_to_buffer(&buffers[2], 0, &read, 0, size);
    queue.submit([encoder.finish()]);
    read.slice(..).map_async(MapMode::Read, |mapped| {
        mapped.expect("the buffer is mapped")
    });
    device.poll(PollType::wait_indefinitely())?;
    let bytes = read.slice(..).get_mapped_range()?;
    let numbers: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
    let (pixels, _) = numbers.as_chunks::<4>();
    let picture = pixels.iter().map(|[r, g, b, _]| Vec3::new(*r, *g, *b));
    Ok((picture.collect(), info.device_type == DeviceType::Cpu))
}
