//! A compute device without a window.

use std::cell::Cell;
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::time::{Duration, Instant};

use welkin_shaders::PROGRAMS;
use wgpu::util::DeviceExt;

pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
    repeats: Cell<bool>,
    took: Cell<Duration>,
}

/// What a program is bound to in group 1 from binding 1 on.
pub enum Binding<'a> {
    Uniform(&'a [u8]),
    Input(&'a [u8]),
    /// So many vectors, which come back.
    Output(usize),
}

/// One device for the tests of a process, one test at a time; `None`, with a message, where there is no Vulkan, which
/// with `WELKIN_REQUIRE_GPU=1` is an error.
pub fn device() -> Option<MutexGuard<'static, Gpu>> {
    static DEVICE: OnceLock<Option<Mutex<Gpu>>> = OnceLock::new();
    let device = DEVICE.get_or_init(|| open().map(Mutex::new));
    let Some(device) = device else {
        let required = std::env::var_os("WELKIN_REQUIRE_GPU").is_some_and(|v| v == "1");
        assert!(!required, "no Vulkan device, and WELKIN_REQUIRE_GPU=1");
        eprintln!(
            "SKIPPED: no Vulkan device. For a software one: apt-get install mesa-vulkan-drivers libvulkan1"
        );
        return None;
    };
    Some(
        device
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner()),
    )
}

fn open() -> Option<Gpu> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN;
    let instance = wgpu::Instance::new(descriptor);
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options)).ok()?;
    let name = adapter.get_info().name;
    println!("on {name}");
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .expect("a device of the adapter");
    Some(Gpu {
        device,
        queue,
        name,
        repeats: Cell::new(false),
        took: Cell::default(),
    })
}

impl Gpu {
    /// What the device calls itself.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What a pass takes that has run before, of those that `runs` asks for: the last one.
    pub fn time(&self, runs: impl FnOnce(&Self)) -> Duration {
        self.repeats.set(true);
        runs(self);
        self.repeats.set(false);
        self.took.get()
    }

    /// Runs a program of this crate; see [`Gpu::run_source`].
    pub fn run(
        &self,
        name: &str,
        table: &[u8],
        place: [u32; 4],
        bindings: &[Binding],
        groups: [u32; 2],
    ) -> Vec<Vec<[f32; 4]>> {
        let program = PROGRAMS.iter().find(|p| p.name == name).expect("a program");
        self.run_source(&program.source(), table, place, bindings, groups)
    }

    /// Runs `main` over so many workgroups and returns all outputs.
    pub fn run_source(
        &self,
        source: &str,
        table: &[u8],
        place: [u32; 4],
        bindings: &[Binding],
        groups: [u32; 2],
    ) -> Vec<Vec<[f32; 4]>> {
        use wgpu::BufferUsages as Usage;
        let shader = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &shader,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        let place: Vec<u8> = place.iter().flat_map(|v| v.to_ne_bytes()).collect();
        let table = self.filled(table, Usage::STORAGE);
        let mut own = vec![self.filled(&place, Usage::UNIFORM)];
        own.extend(bindings.iter().map(|binding| match binding {
            Binding::Uniform(bytes) => self.filled(bytes, Usage::UNIFORM),
            Binding::Input(bytes) => self.filled(bytes, Usage::STORAGE),
            Binding::Output(n) => self.empty(*n, Usage::STORAGE | Usage::COPY_SRC),
        }));
        let groups_of = [
            self.group(&pipeline, 0, std::slice::from_ref(&table)),
            self.group(&pipeline, 1, &own),
        ];
        if self.repeats.get() {
            // The first time it may be compiled.
            for _ in 0..2 {
                let start = Instant::now();
                self.queue
                    .submit([self.pass(&pipeline, &groups_of, groups).finish()]);
                self.device
                    .poll(wgpu::PollType::wait_indefinitely())
                    .expect("the device");
                self.took.set(start.elapsed());
            }
        }
        let mut encoder = self.pass(&pipeline, &groups_of, groups);
        let outputs =
            bindings
                .iter()
                .zip(&own[1..])
                .filter_map(|(binding, buffer)| match binding {
                    Binding::Output(n) => Some((*n, buffer)),
                    _ => None,
                });
        let copies: Vec<wgpu::Buffer> = outputs
            .map(|(n, buffer)| {
                let copy = self.empty(n, Usage::MAP_READ | Usage::COPY_DST);
                encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, copy.size());
                copy
            })
            .collect();
        self.queue.submit([encoder.finish()]);
        copies.iter().map(|copy| self.read(copy)).collect()
    }

    fn pass(
        &self,
        pipeline: &wgpu::ComputePipeline,
        bound: &[wgpu::BindGroup; 2],
        groups: [u32; 2],
    ) -> wgpu::CommandEncoder {
        let descriptor = wgpu::CommandEncoderDescriptor::default();
        let mut encoder = self.device.create_command_encoder(&descriptor);
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            for (i, group) in (0..).zip(bound) {
                pass.set_bind_group(i, group, &[]);
            }
            pass.dispatch_workgroups(groups[0], groups[1], 1);
        }
        encoder
    }

    fn filled(&self, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let descriptor = wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        };
        self.device.create_buffer_init(&descriptor)
    }

    fn empty(&self, vectors: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16 * vectors as u64,
            usage,
            mapped_at_creation: false,
        })
    }

    fn group(
        &self,
        pipeline: &wgpu::ComputePipeline,
        group: u32,
        buffers: &[wgpu::Buffer],
    ) -> wgpu::BindGroup {
        let entries = buffers
            .iter()
            .enumerate()
            .map(|(i, buffer)| wgpu::BindGroupEntry {
                binding: i as u32,
                resource: buffer.as_entire_binding(),
            });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(group),
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Vec<[f32; 4]> {
        buffer.map_async(wgpu::MapMode::Read, .., |result| {
            result.expect("a mapped buffer")
        });
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device");
        let view = buffer.slice(..).get_mapped_range().expect("a mapped range");
        let number = |b: &[u8]| f32::from_ne_bytes(b.try_into().expect("four bytes"));
        let vectors = view
            .chunks_exact(16)
            .map(|v| std::array::from_fn(|i| number(&v[4 * i..4 * i + 4])));
        vectors.collect()
    }
}

pub fn bytes(vectors: &[[f32; 4]]) -> Vec<u8> {
    vectors
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_ne_bytes())
        .collect()
}

pub fn padded(vectors: &[[f32; 3]]) -> Vec<u8> {
    bytes(
        &vectors
            .iter()
            .map(|&[x, y, z]| [x, y, z, 0.0])
            .collect::<Vec<_>>(),
    )
}
