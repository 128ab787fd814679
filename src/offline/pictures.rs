//! Pictures of a run: the kiosk's own renderer, headless.

use std::io::Cursor;
use std::io::Write;
use std::path::Path;

use super::whole_file::WholeFile;
use crate::exhibit::Exhibit;
use crate::render::{Frame, ImageRenderer, RenderError};
use crate::simulation::Simulation;

/// Draws moments of one exhibit.
pub struct Pictures {
    renderer: ImageRenderer,
    size: (u32, u32),
}

impl Pictures {
    /// Prepares pictures of `size` pixels. Needs a Vulkan driver; software is enough.
    pub fn new(exhibit: &Exhibit, size: (u32, u32)) -> Result<Self, RenderError> {
        Ok(Self { renderer: ImageRenderer::new(exhibit, |_| ())?, size })
    }

    /// Draws the present moment into a PNG.
    pub fn save(&mut self, simulation: &Simulation, path: &Path) -> Result<(), String> {
        let snapshot = simulation.snapshot();
        let view = simulation.view(f64::from(self.size.0) / f64::from(self.size.1));
        let frame = Frame { poses: &snapshot.poses, motes: &snapshot.motes, view, size: self.size, exposure: 1.0 };
        let picture = self.renderer.draw(&frame).map_err(|e| e.to_string())?;
        write_png(&picture, path).map_err(|e| e.to_string())
    }
}

/// Writes a PNG that is there whole or not at all.
pub fn write_png(picture: &image::RgbaImage, path: &Path) -> std::io::Result<()> {
    let mut bytes = Vec::new();
    picture.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png).map_err(std::io::Error::other)?;
    let mut file = WholeFile::create(path)?;
    file.write_all(&bytes)?;
    file.finish()
}
