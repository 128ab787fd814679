//! Pictures without a window: draw into an own texture, read it back.

use super::{Frame, Gpu, Options, RenderError, Renderer};
use crate::exhibit::Exhibit;

/// Format of a headless picture.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Draws pictures of one exhibit. Built once, draws many.
pub struct ImageRenderer {
    gpu: Gpu,
    renderer: Renderer,
    target: Option<Target>,
}

/// Texture and read-back buffer of one size.
struct Target {
    size: (u32, u32),
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    buffer: wgpu::Buffer,
    /// Bytes of a row in the buffer, padded as copies demand.
    row: u32,
}

impl ImageRenderer {
    /// Prepares an exhibit on a headless device; `adjust` may change the options that suit the device.
    pub fn new(exhibit: &Exhibit, adjust: impl FnOnce(&mut Options)) -> Result<Self, RenderError> {
        Self::on(Gpu::headless()?, exhibit, adjust)
    }

    /// Prepares an exhibit on this device.
    pub fn on(gpu: Gpu, exhibit: &Exhibit, adjust: impl FnOnce(&mut Options)) -> Result<Self, RenderError> {
        let mut options = Options::for_gpu(&gpu, FORMAT);
        adjust(&mut options);
        let renderer = Renderer::new(&gpu, exhibit, options)?;
        Ok(Self { gpu, renderer, target: None })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// What draws.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Draws one frame.
    pub fn draw(&mut self, frame: &Frame) -> Result<image::RgbaImage, RenderError> {
        let (width, height) = frame.size;
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(RenderError::Size { width, height, limit });
        }
        if self.target.as_ref().is_none_or(|target| target.size != frame.size) {
            self.target = Some(Target::new(&self.gpu, frame.size));
        }
        let Some(target) = &self.target else { unreachable!("made above") };
        self.renderer.draw(&self.gpu, &target.view, frame);
        target.read(&self.gpu)
    }
}

impl Target {
    fn new(gpu: &Gpu, (width, height): (u32, u32)) -> Self {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let view = texture.create_view(&Default::default());
        Self { size: (width, height), texture, view, buffer, row }
    }

    fn read(&self, gpu: &Gpu) -> Result<image::RgbaImage, RenderError> {
        let failed = |error: &dyn std::fmt::Display| RenderError::ReadBack(error.to_string());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.row), rows_per_image: None },
            },
            self.texture.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        self.buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver lives until the poll below has run this.
            let _ = sender.send(result);
        });
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(&e))?;
        receiver.recv().map_err(|e| failed(&e))?.map_err(|e| failed(&e))?;
        let (width, height) = self.size;
        let mut pixels = Vec::with_capacity((4 * width * height) as usize);
        let mapped = self.buffer.get_mapped_range(..).map_err(|e| failed(&e))?;
        for row in mapped.chunks_exact(self.row as usize) {
            pixels.extend_from_slice(&row[..4 * width as usize]);
        }
        drop(mapped);
        self.buffer.unmap();
        image::RgbaImage::from_raw(width, height, pixels).ok_or_else(|| failed(&"too few bytes came back"))
    }
}
