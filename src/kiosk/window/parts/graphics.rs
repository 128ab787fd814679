//! The graphics devices, one after another, and what is drawn with them: the moment shown, the camera's sway.

use std::sync::Arc;

use winit::window::Window;

use crate::attract::drift::Drift;
use crate::window::screen::Screen;
use crate::window::workbench::Workbench;
use soffio_exhibit::Exhibit;
use soffio_simulation::Snapshot;

/// Graphics devices that may be lost before the kiosk ends and leaves mending to whoever supervises it.
const LOST_DEVICES: u32 = 3;

/// What draws.
pub(crate) struct Graphics {
    pub instance: wgpu::Instance,
    /// Shaders that somebody works on.
    pub workbench: Option<Workbench>,
    pub drift: Drift,
    /// What is shown; kept so that a picture needs no new memory for it.
    pub moment: Snapshot,
    /// The device is destroyed once, after so many seconds.
    pub lose_device_at: Option<f64>,
    lost: u32,
}

impl Graphics {
    /// Nothing is drawn yet.
    pub fn new(instance: wgpu::Instance, workbench: Option<Workbench>, lose_device_at: Option<f64>) -> Self {
        Self { instance, workbench, drift: Drift::default(), moment: Snapshot::default(), lose_device_at, lost: 0 }
    }

    /// A device for a window.
    pub fn open(&self, window: Arc<Window>, exhibit: &Arc<Exhibit>) -> Result<Screen, String> {
        Screen::new(self.instance.clone(), window, exhibit)
    }

    /// Is the device to be destroyed now, at `time`, s? Once.
    pub fn loses_device(&mut self, time: f64) -> bool {
        self.lose_device_at.take_if(|at| time >= *at).is_some()
    }

    /// A new device in the place of one that is lost; the error says why there is none.
    pub fn replace(&mut self, window: Arc<Window>, exhibit: &Arc<Exhibit>) -> Result<Screen, String> {
        self.lost += 1;
        if self.lost > LOST_DEVICES {
            return Err(format!("the graphics device was lost {} times", self.lost));
        }
        let screen = self.open(window, exhibit)?;
        tracing::info!("a new graphics device draws in the old window: {}", screen.adapter().0);
        self.workbench = self.workbench.take().map(Workbench::again);
        Ok(screen)
    }
}
