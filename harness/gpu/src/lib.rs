//! The device that everything runs on: which adapter, why that one, and how bytes are read back
//! from it.
//!
//! ```no_run
//! use lapidary_gpu::{AdapterChoice, Gpu};
//!
//! let gpu = Gpu::shared(&AdapterChoice::from_environment())?;
//! println!("{}", gpu.describe());
//! # Ok::<(), lapidary_gpu::GpuError>(())
//! ```

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// The adapter to run on (`--adapter`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AdapterChoice {
    /// Mesa's software Vulkan device, the reference for which the accuracy bounds are stated.
    Lavapipe,
    /// The first adapter that the system offers.
    Any,
    /// The first adapter whose name contains this text, ignoring case.
    Named(String),
}

/// Environment variable that replaces `--adapter`, also for the tests.
pub const ADAPTER_VARIABLE: &str = "LAPIDARY_ADAPTER";

impl AdapterChoice {
    /// Returns the choice from the environment, or the platform's default.
    pub fn from_environment() -> Self {
        let asked = std::env::var(ADAPTER_VARIABLE).ok().and_then(|text| text.parse().ok());
        asked.unwrap_or_else(Self::platform_default)
    }

    /// Lavapipe on Linux, where `./cook` installs it; elsewhere the first adapter.
    pub const fn platform_default() -> Self {
        if cfg!(target_os = "linux") { Self::Lavapipe } else { Self::Any }
    }

    fn accepts(&self, info: &wgpu::AdapterInfo) -> bool {
        match self {
            Self::Lavapipe => is_lavapipe(info),
            Self::Any => true,
            Self::Named(name) => info.name.to_lowercase().contains(&name.to_lowercase()),
        }
    }
}

impl std::str::FromStr for AdapterChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            // Every name contains the empty string, so it would choose at random.
            "" => return Err("expected lavapipe, any, or part of an adapter's name"),
            "lavapipe" => Self::Lavapipe,
            "any" => Self::Any,
            name => Self::Named(name.to_owned()),
        })
    }
}

impl std::fmt::Display for AdapterChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Lavapipe => "lavapipe",
            Self::Any => "any",
            Self::Named(name) => name,
        })
    }
}

fn is_lavapipe(info: &wgpu::AdapterInfo) -> bool {
    info.driver.contains("llvmpipe") || info.name.contains("llvmpipe")
}

/// Why there is no device, or why it refused a request.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// The system has no adapters, or none that matches the choice.
    #[error(
        "no adapter matches `{choice}`; this system offers {offered}. {}",
        if *choice == AdapterChoice::Lavapipe {
            "Install lavapipe (Debian, Ubuntu: apt-get install mesa-vulkan-drivers libvulkan1), or choose another with LAPIDARY_ADAPTER=any, or part of its name (cook: --adapter any)"
        } else {
            "Choose one of them with LAPIDARY_ADAPTER, by part of its name (cook: --adapter NAME)"
        }
    )]
    NoAdapter {
        /// The choice that was requested.
        choice: AdapterChoice,
        /// Names of the adapters that the system offers.
        offered: String,
    },
    /// The driver would not open a device.
    #[error("adapter `{adapter}` gives no device: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// The process already holds a device, and can hold only one.
    #[error("this process already runs on adapter `{opened}`; `{choice}` would be a second device; choose one for all")]
    AlreadyOpen {
        /// Name of the open adapter.
        opened: String,
        /// The choice that was requested.
        choice: AdapterChoice,
    },
    /// A shader, pipeline or command was refused.
    #[error("{what} failed on the device: {reason}")]
    Device {
        /// The object or command that was being made or run.
        what: String,
        /// The device's message.
        reason: String,
    },
}

/// An open device with its queue.
#[derive(Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Queue of the device.
    pub queue: wgpu::Queue,
    /// Description of the device, for reports.
    pub info: wgpu::AdapterInfo,
    chosen: AdapterChoice,
    id: u64,
}

fn next_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

static SHARED: OnceLock<Gpu> = OnceLock::new();

impl Gpu {
    /// Returns the process's one device, opened at the first call. A later call must choose the
    /// same adapter.
    pub fn shared(choice: &AdapterChoice) -> Result<&'static Gpu, GpuError> {
        static OPENING: std::sync::Mutex<()> = std::sync::Mutex::new(());
        // Opening can fail, which OnceLock::get_or_init cannot express; the lock keeps it to one
        // device.
        let _guard = OPENING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(gpu) = SHARED.get() {
            if gpu.chosen == *choice || choice.accepts(&gpu.info) {
                return Ok(gpu);
            }
            return Err(GpuError::AlreadyOpen { opened: gpu.info.name.clone(), choice: choice.clone() });
        }
        let gpu = Self::open(choice)?;
        Ok(SHARED.get_or_init(|| gpu))
    }

    fn open(choice: &AdapterChoice) -> Result<Gpu, GpuError> {
        let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = backends;
        descriptor.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(descriptor);
        let adapters = pollster::block_on(instance.enumerate_adapters(backends));
        let Some(adapter) = adapters.iter().find(|adapter| choice.accepts(&adapter.get_info())) else {
            let names: Vec<String> = adapters.iter().map(|adapter| format!("`{}`", adapter.get_info().name)).collect();
            let offered = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(GpuError::NoAdapter { choice: choice.clone(), offered });
        };
        let info = adapter.get_info();
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
                label: Some("lapidary"),
                ..wgpu::DeviceDescriptor::default()
            }))
            .map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        Ok(Gpu { device, queue, info, chosen: choice.clone(), id: next_id() })
    }

    /// Number that no other device of this process has. Objects made on one device must not be used
    /// on another.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// Returns whether this is lavapipe, whose accuracy bounds are tighter than the portable ones.
    pub fn is_lavapipe(&self) -> bool {
        is_lavapipe(&self.info)
    }

    /// Returns adapter, driver and backend in one line, for reports.
    pub fn describe(&self) -> String {
        format!("{} ({} {}, {:?})", self.info.name, self.info.driver, self.info.driver_info, self.info.backend)
    }

    /// Runs `make` and turns an error raised by the device into an `Err` instead of a panic.
    pub fn guarded<T>(&self, what: &str, make: impl FnOnce(&wgpu::Device) -> T) -> Result<T, GpuError> {
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let made = make(&self.device);
        let errors = [
            pollster::block_on(internal.pop()),
            pollster::block_on(memory.pop()),
            pollster::block_on(validation.pop()),
        ];
        match errors.into_iter().flatten().next() {
            None => Ok(made),
            Some(error) => Err(GpuError::Device { what: what.to_owned(), reason: error.to_string() }),
        }
    }

    /// Returns the words of a whole buffer that may be copied from. Waits for everything submitted.
    pub fn words(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
        let size = buffer.size();
        let readback = self.guarded("reading a buffer back", |device| {
            let readback = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("words to read"),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(buffer, 0, &readback, 0, size);
            self.queue.submit([encoder.finish()]);
            readback
        })?;
        self.read_back(&readback, size, bytemuck::pod_collect_to_vec)
    }

    /// Waits for everything submitted and passes the bytes of a `MAP_READ` buffer to `read`.
    pub fn read_back<T>(&self, buffer: &wgpu::Buffer, size: u64, read: impl FnOnce(&[u8]) -> T) -> Result<T, GpuError> {
        let failed = |reason: String| GpuError::Device { what: "reading results back".to_owned(), reason };
        let (sender, receiver) = std::sync::mpsc::channel();
        let slice = buffer.slice(..size);
        slice.map_async(wgpu::MapMode::Read, move |result| {
            // The receiver outlives the poll below, unless that poll fails and reports first.
            let _ = sender.send(result);
        });
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(error.to_string()))?;
        receiver.recv().map_err(|error| failed(error.to_string()))?.map_err(|error| failed(error.to_string()))?;
        let value = read(&slice.get_mapped_range().map_err(|error| failed(error.to_string()))?);
        buffer.unmap();
        Ok(value)
    }
}
