//! The screen without a window: pictures of the exhibit with the overlay, as the kiosk draws both. Without a Vulkan driver the tests
//! that need it report so and pass.

use image::RgbaImage;
use soffio_kiosk::{egui, egui_wgpu};
use soffio_render::Gpu;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Draws type over pictures.
pub struct Glass {
    gpu: Gpu,
    type_setter: egui_wgpu::Renderer,
}

impl Glass {
    /// On whatever driver there is.
    pub fn new() -> Option<Self> {
        let gpu = crate::require::require("Vulkan driver", Gpu::headless())?;
        let type_setter = egui_wgpu::Renderer::new(&gpu.device, FORMAT, egui_wgpu::RendererOptions::default());
        Some(Self { gpu, type_setter })
    }

    /// Takes over what the panel library says only once.
    pub fn learn(&mut self, laid_out: &mut egui::FullOutput) {
        for (id, deltas) in laid_out.textures_delta.set.drain() {
            for delta in deltas {
                self.type_setter.update_texture(&self.gpu.device, &self.gpu.queue, id, &delta);
            }
        }
        laid_out.textures_delta.free.clear();
    }

    /// Shapes over a picture of the same size, one pixel a point.
    pub fn draw(
        &mut self,
        context: &egui::Context,
        picture: &RgbaImage,
        shapes: Vec<egui::epaint::ClippedShape>,
    ) -> RgbaImage {
        let (width, height) = picture.dimensions();
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout =
            |row: u32| wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        queue.write_texture(texture.as_image_copy(), picture, layout(4 * width), size);

        let jobs = context.tessellate(shapes, 1.0);
        let screen = egui_wgpu::ScreenDescriptor { size_in_pixels: [width, height], pixels_per_point: 1.0 };
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let uploads = self.type_setter.update_buffers(device, queue, &mut encoder, &jobs, &screen);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let over = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        };
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(over)],
            ..wgpu::RenderPassDescriptor::default()
        });
        self.type_setter.render(&mut pass.forget_lifetime(), &jobs, &screen);

        let padded = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(padded * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout: layout(padded) };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, size);
        queue.submit(uploads.into_iter().chain([encoder.finish()]));
        buffer.map_async(wgpu::MapMode::Read, .., |read| read.expect("it can be read"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the driver answers");
        let data = buffer.get_mapped_range(..).expect("it was read");
        let rows = data.chunks_exact(padded as usize).flat_map(|row| &row[..4 * width as usize]);
        RgbaImage::from_raw(width, height, rows.copied().collect()).expect("a whole picture")
    }
}

/// Relative luminance of a pixel (WCAG 2.2), 0 to 1.
pub fn luminance(pixel: &image::Rgba<u8>) -> f64 {
    let linear = |value: u8| {
        let value = f64::from(value) / 255.0;
        if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(pixel[0]) + 0.7152 * linear(pixel[1]) + 0.0722 * linear(pixel[2])
}
