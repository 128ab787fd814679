//! Headless pictures of a run.

use std::io::{Cursor, Write};
use std::path::Path;
use std::sync::Arc;

use image::RgbaImage;

use super::atomic_file::AtomicFile;
use soffio_exhibit::Exhibit;
use soffio_render::{FrameInput, ImageRenderer, RenderError};
use soffio_simulation::Snapshot;

/// Supersampling of pictures in files: pixels drawn for each pixel, along each side.
pub const SUPERSAMPLING: u32 = 2;

/// Draws snapshots of one exhibit.
pub struct Pictures {
    renderer: ImageRenderer,
    exhibit: Arc<Exhibit>,
    size: (u32, u32),
}

impl Pictures {
    /// Prepares pictures of `size` pixels.
    ///
    /// # Errors
    /// Where there is no Vulkan driver; software is enough.
    pub fn new(exhibit: &Arc<Exhibit>, size: (u32, u32)) -> Result<Self, RenderError> {
        Ok(Self {
            renderer: ImageRenderer::new(exhibit, |_| ())?.with_supersampling(SUPERSAMPLING),
            exhibit: exhibit.clone(),
            size,
        })
    }

    /// Draws a snapshot through its camera.
    ///
    /// # Errors
    /// The graphics device fails.
    pub fn draw(&mut self, snapshot: &Snapshot) -> Result<RgbaImage, RenderError> {
        let view = self.exhibit.view(f64::from(self.size.0) / f64::from(self.size.1)).orbited(snapshot.turn);
        let frame = FrameInput {
            poses: &snapshot.poses,
            dust: &snapshot.dust_particles,
            curves: &snapshot.curves,
            view,
            size: self.size,
            exposure: 1.0,
            time: snapshot.time,
        };
        self.renderer.draw(&frame)
    }
}

/// Writes a PNG atomically.
///
/// # Errors
/// The file cannot be written.
pub fn write_png(picture: &RgbaImage, path: &Path) -> std::io::Result<()> {
    let mut bytes = Vec::new();
    picture.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png).map_err(std::io::Error::other)?;
    let mut file = AtomicFile::create(path)?;
    file.write_all(&bytes)?;
    file.finish()
}
