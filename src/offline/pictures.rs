//! Pictures of a run: the kiosk's own renderer, headless.

use std::io::{Cursor, Write};
use std::path::Path;
use std::sync::Arc;

use image::RgbaImage;

use super::whole_file::WholeFile;
use soffio_exhibit::Exhibit;
use soffio_render::{Frame, ImageRenderer, RenderError};
use soffio_simulation::Snapshot;

/// Pixels drawn for each of a picture in a file, along each side.
pub const FINER: u32 = 2;

/// Draws moments of one exhibit.
pub struct Pictures {
    renderer: ImageRenderer,
    exhibit: Arc<Exhibit>,
    size: (u32, u32),
}

impl Pictures {
    /// Prepares pictures of `size` pixels. Needs a Vulkan driver; software is enough.
    pub fn new(exhibit: &Arc<Exhibit>, size: (u32, u32)) -> Result<Self, RenderError> {
        Ok(Self { renderer: ImageRenderer::new(exhibit, |_| ())?.finer(FINER), exhibit: exhibit.clone(), size })
    }

    /// Draws a moment as its camera sees it.
    pub fn draw(&mut self, snapshot: &Snapshot) -> Result<RgbaImage, RenderError> {
        let view = self.exhibit.view(f64::from(self.size.0) / f64::from(self.size.1)).turned(snapshot.turn);
        let frame = Frame {
            poses: &snapshot.poses,
            motes: &snapshot.dust_particles,
            view,
            size: self.size,
            exposure: 1.0,
            time: snapshot.time,
        };
        self.renderer.draw(&frame)
    }
}

/// Writes a PNG that is there whole or not at all.
pub fn write_png(picture: &RgbaImage, path: &Path) -> std::io::Result<()> {
    let mut bytes = Vec::new();
    picture.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png).map_err(std::io::Error::other)?;
    let mut file = WholeFile::create(path)?;
    file.write_all(&bytes)?;
    file.finish()
}
