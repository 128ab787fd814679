//! The graphics device: a hardware adapter where there is one, software Vulkan otherwise.

use super::RenderError;

/// Adapter, device and queue.
pub struct Gpu {
    /// Entry to the driver; creates surfaces.
    pub instance: wgpu::Instance,
    /// The chosen adapter.
    pub adapter: wgpu::Adapter,
    /// Creates resources.
    pub device: wgpu::Device,
    /// Submits commands.
    pub queue: wgpu::Queue,
}

impl Gpu {
    /// A device without a window.
    ///
    /// # Errors
    /// Where there is no adapter or it gives no device.
    pub fn headless() -> Result<Self, RenderError> {
        Self::headless_on(wgpu::Backends::VULKAN)
    }

    /// A device without a window on the given backends.
    ///
    /// # Errors
    /// As [`Self::headless`].
    pub fn headless_on(backends: wgpu::Backends) -> Result<Self, RenderError> {
        let descriptor =
            wgpu::InstanceDescriptor { backends, ..wgpu::InstanceDescriptor::new_without_display_handle_from_env() };
        Self::open(wgpu::Instance::new(descriptor), None)
    }

    /// A device that can draw into `surface`, which `instance` created.
    ///
    /// # Errors
    /// As [`Self::headless`].
    pub fn for_surface(instance: wgpu::Instance, surface: &wgpu::Surface) -> Result<Self, RenderError> {
        Self::open(instance, Some(surface))
    }

    fn open(instance: wgpu::Instance, surface: Option<&wgpu::Surface>) -> Result<Self, RenderError> {
        let request = |force_fallback_adapter| wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            force_fallback_adapter,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&request(false)))
            .or_else(|_| pollster::block_on(instance.request_adapter(&request(true))))
            .map_err(|error| RenderError::NoAdapter(error.to_string()))?;
        let descriptor = wgpu::DeviceDescriptor { label: Some("soffio"), ..Default::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| RenderError::NoDevice(error.to_string()))?;
        Ok(Self { instance, adapter, device, queue })
    }

    /// Is it a software renderer? Then a few passes take the way that is faster on a CPU.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Can a shader read single samples of a multisampled texture? GL drivers differ.
    pub fn reads_samples(&self) -> bool {
        self.adapter.get_info().backend != wgpu::Backend::Gl
    }

    /// Name of the adapter and its driver, for display.
    pub fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{} ({})", info.name, info.driver_info)
    }
}
