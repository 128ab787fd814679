//! The graphics device and its replacement, the state shown, and the camera sway.

use std::sync::Arc;

use winit::window::Window;

use crate::attract::camera_sway::CameraSway;
use crate::window::screen::Screen;
use crate::window::shader_watcher::ShaderWatcher;
use soffio_exhibit::Exhibit;
use soffio_simulation::Snapshot;

/// Lost graphics devices after which the kiosk ends, to be restarted by its supervisor.
const LOST_DEVICES: u32 = 3;

/// State of the graphics.
pub(crate) struct Graphics {
    /// Instance from which devices and surfaces are made.
    pub instance: wgpu::Instance,
    /// Reloads changed shaders.
    pub shader_watcher: Option<ShaderWatcher>,
    /// Sway of the camera in attract mode.
    pub camera_sway: CameraSway,
    /// State that the frame shows; reused to avoid allocations.
    pub moment: Snapshot,
    /// Time since the start at which the device is destroyed once, as a test of its replacement, s.
    pub lose_device_at: Option<f64>,
    lost: u32,
}

impl Graphics {
    /// Without a device yet.
    pub fn new(instance: wgpu::Instance, shader_watcher: Option<ShaderWatcher>, lose_device_at: Option<f64>) -> Self {
        Self {
            instance,
            shader_watcher,
            camera_sway: CameraSway::default(),
            moment: Snapshot::default(),
            lose_device_at,
            lost: 0,
        }
    }

    /// Opens a device for a window.
    ///
    /// # Errors
    /// There is no adapter that can draw to the window; the reason.
    pub fn open(&self, window: Arc<Window>, exhibit: &Arc<Exhibit>) -> Result<Screen, String> {
        Screen::new(self.instance.clone(), window, exhibit)
    }

    /// Must the device be destroyed now, at `time`, s? True once.
    pub fn loses_device(&mut self, time: f64) -> bool {
        self.lose_device_at.take_if(|at| time >= *at).is_some()
    }

    /// Opens a new device in place of a lost one; the error says why there is none.
    ///
    /// # Errors
    /// There is no adapter that can draw to the window; the reason.
    pub fn replace(&mut self, window: Arc<Window>, exhibit: &Arc<Exhibit>) -> Result<Screen, String> {
        self.lost += 1;
        if self.lost > LOST_DEVICES {
            return Err(format!("the graphics device was lost {} times", self.lost));
        }
        let screen = self.open(window, exhibit)?;
        tracing::info!("a new graphics device draws in the old window: {}", screen.adapter().0);
        self.shader_watcher = self.shader_watcher.take().map(ShaderWatcher::restarted);
        Ok(screen)
    }
}
