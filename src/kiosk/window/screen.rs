//! The screen: the surface of a window, the scene drawn into it, and the panels over the scene.
//!
//! The surface's texture has two views: the scene goes through an sRGB one (the renderer writes linear light), type
//! and panels through a plain one (the panel library blends in display values). Whatever the system does to the
//! surface (resized, outdated, lost) costs a frame at most.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui_wgpu::{RendererOptions, ScreenDescriptor};
use winit::dpi::PhysicalSize;
use winit::window::Window;

use soffio_exhibit::{Exhibit, View};
use soffio_render::{Baked, FrameInput, Gpu, GpuExhibit, Lighting, Options, Renderer, Sampling, Shaders};
use soffio_simulation::Snapshot;

use crate::pages::fonts;

/// Longest press that is a click, s, and its largest displacement, points: for a finger.
const LONGEST_CLICK: f64 = 5.0;
const CLICK_REACH: f32 = 12.0;

/// A window with its graphics device and renderers.
pub struct Screen {
    /// The window.
    pub window: Arc<Window>,
    /// The panel library's own state of the window.
    pub panel: egui_winit::State,
    gpu: Gpu,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    scene: Renderer,
    shown: Arc<Exhibit>,
    /// The next exhibit, ready to be drawn.
    next: Option<(Arc<Exhibit>, GpuExhibit)>,
    type_setter: egui_wgpu::Renderer,
    broken: Arc<AtomicBool>,
    refresh: Option<f64>,
}

/// Result of drawing a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// The frame was presented.
    Shown,
    /// The surface is unavailable for a moment; the next frame will work.
    Skipped,
    /// The display accepts no frame: it is off, or the window is covered.
    Dark,
    /// The graphics device is lost: create a new [`Screen`].
    DeviceLost,
}

impl Screen {
    /// Opens a graphics device for a window. The error says what is missing.
    ///
    /// # Errors
    /// There is no adapter that can draw to the window, or the exhibit cannot be drawn; what is missing.
    pub fn new(instance: wgpu::Instance, window: Arc<Window>, exhibit: &Arc<Exhibit>) -> Result<Self, String> {
        let surface = instance.create_surface(window.clone()).map_err(|error| error.to_string())?;
        let gpu = Gpu::for_surface(instance, &surface).map_err(|error| error.to_string())?;
        let PhysicalSize { width, height } = window.inner_size();
        let mut config = surface
            .get_default_config(&gpu.adapter, width.max(1), height.max(1))
            .ok_or("the graphics adapter cannot draw into this window")?;
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        config.format = formats.iter().copied().find(|format| !format.is_srgb()).unwrap_or(config.format);
        config.present_mode = wgpu::PresentMode::AutoVsync;
        config.view_formats = vec![config.format.add_srgb_suffix()];
        surface.configure(&gpu.device, &config);

        let broken = Arc::new(AtomicBool::new(false));
        let theirs = broken.clone();
        gpu.device.set_device_lost_callback(move |reason, message| {
            tracing::error!("graphics device lost ({reason:?}): {message}");
            theirs.store(true, Ordering::Relaxed);
        });
        let options = Options::for_gpu(&gpu, config.format.add_srgb_suffix());
        let scene = Renderer::new(&gpu, exhibit, options).map_err(|error| error.to_string())?;
        let type_setter = egui_wgpu::Renderer::new(&gpu.device, config.format, RendererOptions::default());
        let context = egui::Context::default();
        context.set_fonts(fonts::definitions());
        context.set_theme(egui::Theme::Light);
        // A press by a finger is longer and less steady than by a mouse.
        context.options_mut(|options| {
            options.input_options.max_click_duration = LONGEST_CLICK;
            options.input_options.max_click_dist = CLICK_REACH;
        });
        let largest = gpu.device.limits().max_texture_dimension_2d as usize;
        let scale = Some(window.scale_factor() as f32);
        let panel =
            egui_winit::State::new(context, egui::ViewportId::ROOT, &window, scale, window.theme(), Some(largest));
        let shown = exhibit.clone();
        let refresh = refresh(&window);
        Ok(Self { window, refresh, panel, gpu, surface, config, scene, shown, next: None, type_setter, broken })
    }

    /// Pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.config.width) / f64::from(self.config.height)
    }

    /// Refresh interval of the display, s; `None` where it is unknown.
    pub fn refresh(&self) -> Option<f64> {
        self.refresh
    }

    /// Name of the adapter, and whether it is a software renderer.
    pub fn adapter(&self) -> (String, bool) {
        (self.gpu.name(), self.gpu.is_software())
    }

    /// Sets the quality from the next frame on.
    pub fn set_finish(&mut self, finish: Sampling) {
        self.scene.set_sampling(&self.gpu, finish);
    }

    /// Sets the shaders from the next frame on.
    pub fn set_shaders(&mut self, shaders: Shaders) {
        self.scene.set_shaders(&self.gpu, shaders.into());
    }

    /// Destroys the graphics device, as a crashed driver would.
    pub fn destroy_device(&self) {
        self.gpu.device.destroy();
    }

    /// Takes over a changed size of the window.
    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        if size.width > 0 && size.height > 0 {
            (self.config.width, self.config.height) = (size.width, size.height);
            self.refresh = refresh(&self.window);
            self.surface.configure(&self.gpu.device, &self.config);
        }
    }

    /// Draws a frame: the state `moment`, and over it the panels that `paint` lays out.
    pub fn draw(
        &mut self,
        exhibit: &Arc<Exhibit>,
        view: &View,
        moment: &Snapshot,
        paint: impl FnMut(&mut egui::Ui),
    ) -> Drawn {
        if self.broken.load(Ordering::Relaxed) {
            return Drawn::DeviceLost;
        }
        self.show(exhibit);
        let input = self.panel.take_egui_input(&self.window);
        let context = self.panel.egui_ctx().clone();
        // Its requests for cursor, clipboard and links are ignored: a kiosk has none of them.
        let mut laid_out = context.run_ui(input, paint);
        // Textures are taken over even without a surface: the panel library sends them only once.
        for (id, deltas) in laid_out.textures_delta.set.drain() {
            for delta in deltas {
                self.type_setter.update_texture(&self.gpu.device, &self.gpu.queue, id, &delta);
            }
        }
        let drawn = match self.acquire() {
            Ok(frame) => {
                self.draw_into(&frame, view, moment, &mut laid_out);
                self.window.pre_present_notify();
                self.gpu.queue.present(frame);
                Drawn::Shown
            }
            Err(why) => {
                // A lost device is reported only when it is polled.
                let _ = self.gpu.device.poll(wgpu::PollType::Poll);
                why
            }
        };
        for id in laid_out.textures_delta.free.drain() {
            self.type_setter.free_texture(&id);
        }
        drawn
    }

    /// Loads the GPU resources of the next exhibit in advance, so that its first frames are not late.
    pub fn prepare(&mut self, exhibit: &Arc<Exhibit>, baked: Baked) {
        self.next = Some((exhibit.clone(), self.scene.prepare(&self.gpu, exhibit, baked)));
    }

    /// Shows another exhibit. If it cannot be drawn, the last scene stays.
    fn show(&mut self, exhibit: &Arc<Exhibit>) {
        if Arc::ptr_eq(&self.shown, exhibit) {
            return;
        }
        self.shown = exhibit.clone();
        if let Some((_, prepared)) = self.next.take().filter(|(next, _)| Arc::ptr_eq(next, exhibit)) {
            return self.scene.show(prepared);
        }
        match Baked::new(exhibit, &Lighting::default()) {
            Ok(baked) => {
                let prepared = self.scene.prepare(&self.gpu, exhibit, baked);
                self.scene.show(prepared);
            }
            Err(error) => tracing::error!("{} cannot be drawn: {error}", exhibit.id),
        }
    }

    fn draw_into(
        &mut self,
        frame: &wgpu::SurfaceTexture,
        view: &View,
        moment: &Snapshot,
        laid_out: &mut egui::FullOutput,
    ) {
        let as_srgb = wgpu::TextureViewDescriptor {
            format: Some(self.config.format.add_srgb_suffix()),
            ..wgpu::TextureViewDescriptor::default()
        };
        let light = frame.texture.create_view(&as_srgb);
        let plain = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let size = (self.config.width, self.config.height);
        let picture = FrameInput {
            poses: &moment.poses,
            dust: &moment.dust_particles,
            curves: &moment.curves,
            view: *view,
            size,
            exposure: 1.0,
            time: moment.time,
        };
        self.scene.draw(&self.gpu, &light, &picture);

        let pixels_per_point = laid_out.pixels_per_point;
        let shapes = std::mem::take(&mut laid_out.shapes);
        let jobs = self.panel.egui_ctx().tessellate(shapes, pixels_per_point);
        let screen = ScreenDescriptor { size_in_pixels: self.size(), pixels_per_point };
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let uploads = self.type_setter.update_buffers(&self.gpu.device, &self.gpu.queue, &mut encoder, &jobs, &screen);
        let over = wgpu::RenderPassColorAttachment {
            view: &plain,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        };
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("overlay"),
            color_attachments: &[Some(over)],
            ..wgpu::RenderPassDescriptor::default()
        });
        self.type_setter.render(&mut pass.forget_lifetime(), &jobs, &screen);
        self.gpu.queue.submit(uploads.into_iter().chain([encoder.finish()]));
    }

    /// The next texture of the surface; recreates the surface if needed.
    fn acquire(&mut self) -> Result<wgpu::SurfaceTexture, Drawn> {
        use wgpu::CurrentSurfaceTexture as Current;
        match self.surface.get_current_texture() {
            Current::Success(frame) | Current::Suboptimal(frame) => return Ok(frame),
            Current::Timeout | Current::Occluded => return Err(Drawn::Dark),
            Current::Outdated => self.resize(self.window.inner_size()),
            Current::Lost => match self.gpu.instance.create_surface(self.window.clone()) {
                Ok(surface) => {
                    self.surface = surface;
                    self.resize(self.window.inner_size());
                }
                Err(error) => tracing::error!("the window's surface is lost and no new one is given: {error}"),
            },
            Current::Validation => {}
        }
        Err(Drawn::Skipped)
    }
}

/// Refresh interval of the window's display, s.
fn refresh(window: &Window) -> Option<f64> {
    let millihertz = window.current_monitor()?.refresh_rate_millihertz()?;
    (millihertz > 0).then(|| 1e3 / f64::from(millihertz))
}
