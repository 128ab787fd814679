//! Headless rendering: draw into a texture, read it back.
//!
//! Files may be supersampled: the picture is drawn larger and reduced in linear light, so that a thin tube of a mesh is a
//! line and not a row of dashes. The mean has lost the shader's dither, so it is dithered again, as in `common.wgsl`.

use super::textures::{to_linear, to_srgb};
use super::{FrameInput, Gpu, Options, RenderError, Renderer, Tonemap};
use soffio_exhibit::Exhibit;

/// Format of a headless picture.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Draws pictures of one exhibit without a window.
pub struct ImageRenderer {
    gpu: Gpu,
    renderer: Renderer,
    target: Option<Target>,
    /// Pixels drawn for each pixel of the picture, along each side.
    supersampling: u32,
    /// Whether pictures have a tone curve: those without are measurements, and are not dithered.
    dithers: bool,
}

/// Texture and read-back buffer of one size.
struct Target {
    size: (u32, u32),
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    buffer: wgpu::Buffer,
    /// Bytes of a row in the buffer, with the padding that copies require.
    row: u32,
}

impl ImageRenderer {
    /// Prepares an exhibit on a headless device; `adjust` can change the default options.
    ///
    /// # Errors
    /// Where there is no device, or the exhibit has too many bodies.
    pub fn new(exhibit: &Exhibit, adjust: impl FnOnce(&mut Options)) -> Result<Self, RenderError> {
        Self::on(Gpu::headless()?, exhibit, adjust)
    }

    /// Prepares an exhibit on this device, as [`Self::new`].
    ///
    /// # Errors
    /// The exhibit cannot be drawn on this device.
    pub fn on(gpu: Gpu, exhibit: &Exhibit, adjust: impl FnOnce(&mut Options)) -> Result<Self, RenderError> {
        let mut options = Options::for_gpu(&gpu, FORMAT);
        adjust(&mut options);
        let dithers = options.lighting.tonemap != Tonemap::Clamp;
        let renderer = Renderer::new(&gpu, exhibit, options)?;
        Ok(Self { gpu, renderer, target: None, supersampling: 1, dithers })
    }

    /// Draws `supersampling` pixels for each pixel of the picture, along each side, where the device has textures that large.
    pub fn with_supersampling(self, supersampling: u32) -> Self {
        Self { supersampling: supersampling.max(1), ..self }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The renderer.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Draws one frame.
    ///
    /// # Errors
    /// Where the size exceeds the device's limit, or the picture cannot be read back.
    pub fn draw(&mut self, frame: &FrameInput) -> Result<image::RgbaImage, RenderError> {
        let (width, height) = frame.size;
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(RenderError::Size { width, height, limit });
        }
        let supersampling = self.supersampling.min(limit / width.max(height));
        let frame = FrameInput { size: (supersampling * width, supersampling * height), ..*frame };
        if self.target.as_ref().is_none_or(|target| target.size != frame.size) {
            self.target = Some(Target::new(&self.gpu, frame.size));
        }
        let Some(target) = &self.target else { unreachable!("made above") };
        self.renderer.draw(&self.gpu, &target.view, &frame);
        let drawn = target.read(&self.gpu)?;
        Ok(if supersampling == 1 { drawn } else { means(&drawn, supersampling, self.dithers) })
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
            // The receiver lives until the poll below has run this callback.
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

/// Reduces a picture in linear light by a tent filter two pixels wide, under which a slanting line neither beads nor
/// blurs.
fn means(drawn: &image::RgbaImage, side: u32, dithers: bool) -> image::RgbaImage {
    let linear: [f32; 256] = std::array::from_fn(|byte| to_linear(byte as f32 / 255.0));
    let (width, height, side) = (drawn.width() / side, drawn.height() / side, side as i32);
    let tent: Vec<f32> = (-side..side).map(|k| (1.0 - ((k as f32 + 0.5) / side as f32).abs()) / side as f32).collect();
    // Along the rows first.
    let mut rows = vec![[0.0; 3]; (width * drawn.height()) as usize];
    for (at, sum) in rows.iter_mut().enumerate() {
        let (x, y) = (at as u32 % width, at as u32 / width);
        for (k, weight) in (-side..side).zip(&tent) {
            let from = (x as i32 * side + side / 2 + k).clamp(0, drawn.width() as i32 - 1);
            let pixel = drawn.get_pixel(from as u32, y);
            sum.iter_mut().zip(pixel.0).for_each(|(sum, byte)| *sum += weight * linear[usize::from(byte)]);
        }
    }
    image::RgbaImage::from_fn(width, height, |x, y| {
        let mut sum = [0.0; 3];
        for (k, weight) in (-side..side).zip(&tent) {
            let from = (y as i32 * side + side / 2 + k).clamp(0, drawn.height() as i32 - 1);
            let row = rows[(from as u32 * width + x) as usize];
            sum.iter_mut().zip(row).for_each(|(sum, c)| *sum += weight * c);
        }
        let noise = if dithers { triangular_noise(x, y) } else { [0.0; 3] };
        let [r, g, b] = std::array::from_fn(|k| (255.0 * to_srgb(sum[k]) + noise[k] + 0.5) as u8);
        image::Rgba([r, g, b, 255])
    })
}

/// 32 random bits from a number, as in `common.wgsl`.
fn hashed(seed: u32) -> u32 {
    let h = ((seed >> ((seed >> 28) + 4)) ^ seed).wrapping_mul(277_803_737);
    (h >> 22) ^ h
}

/// Noise in −1 … 1 of triangular density, one value a channel, as in `common.wgsl`.
fn triangular_noise(x: u32, y: u32) -> [f32; 3] {
    let seed = x.wrapping_mul(1_664_525).wrapping_add(y.wrapping_mul(1_013_904_223)).wrapping_add(12345);
    let a = hashed(seed);
    let b = hashed(a.wrapping_add(2_654_435_769));
    [0, 11, 22].map(|shift| (((a >> shift) & 1023) as f32 - ((b >> shift) & 1023) as f32) / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_and_white_make_the_grey_of_half_the_light() {
        let checks =
            image::RgbaImage::from_fn(8, 8, |x, y| image::Rgba([[0, 0, 0, 255], [255; 4]][(x + y) as usize % 2]));
        let grey = means(&checks, 2, false);
        // sRGB of linear 0.5; at the border the outermost pixels are repeated.
        assert_eq!(grey.dimensions(), (4, 4));
        assert_eq!(grey.get_pixel(1, 2).0, [188, 188, 188, 255]);
        for byte in 0..=255 {
            let plain = image::RgbaImage::from_pixel(6, 6, image::Rgba([byte, byte, byte, 255]));
            assert!(means(&plain, 2, false).pixels().all(|p| p.0[0] == byte), "{byte} comes back as it was");
        }
    }

    #[test]
    fn a_dithered_ramp_has_no_bands_and_each_channel_its_own_noise() {
        // Between two codes in linear light, a quarter of the way: drawn as every fourth pixel of a block a code higher.
        let drawn = image::RgbaImage::from_fn(512, 512, |x, y| {
            let byte = if x % 2 == 0 && y % 2 == 0 { 129 } else { 128 };
            image::Rgba([byte, byte, byte, 255])
        });
        let picture = means(&drawn, 2, true);
        let inner = picture.pixels().map(|p| p.0).collect::<Vec<_>>();
        // The mean of 65,536 pixels, each off by half a code or so, is exact to a hundredth of a code.
        const MEAN: f64 = 0.02;
        let mean = |k: usize| inner.iter().map(|p| f64::from(p[k])).sum::<f64>() / inner.len() as f64;
        assert!((0..3).all(|k| (mean(k) - 128.25).abs() < MEAN), "{:?}", [0, 1, 2].map(mean));
        let together = inner.iter().filter(|p| p[0] == p[1] && p[1] == p[2]).count();
        assert!(together < inner.len() / 2, "{together} grey pixels of {}", inner.len());
    }

    #[test]
    fn a_line_keeps_its_darkness_wherever_it_falls_between_pixels() {
        // Eight bits of the picture.
        const ROUNDING: f32 = 0.02;
        for at in 8..12 {
            let line =
                image::RgbaImage::from_fn(24, 24, |x, _| image::Rgba(if x == at { [0, 0, 0, 255] } else { [255; 4] }));
            let picture = means(&line, 2, false);
            let ink: f32 = (0..12).map(|x| 1.0 - to_linear(f32::from(picture.get_pixel(x, 6).0[0]) / 255.0)).sum();
            assert!((ink - 0.5).abs() < ROUNDING, "{ink} at {at}");
        }
    }
}
