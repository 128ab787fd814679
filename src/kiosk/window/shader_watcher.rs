//! Watches a folder of shaders (`--shaders`) and reloads them when a file changes. Mistakes are reported, and the last valid
//! shaders stay; see [`Shaders`].

use std::path::PathBuf;
use std::time::SystemTime;

use soffio_render::Shaders;
use soffio_render::shaders::ShaderError;

/// Time between two checks of the folder, s.
const LOOK_S: f64 = 0.5;

/// The folder, and its state when it was last read.
#[derive(Debug)]
pub struct ShaderWatcher {
    folder: PathBuf,
    /// Name, time and length of each file.
    stamp: Vec<(PathBuf, Option<SystemTime>, u64)>,
    next: f64,
}

impl ShaderWatcher {
    /// Nothing has been read yet.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder, stamp: Vec::new(), next: 0.0 }
    }

    /// The same folder, to be read again for a new graphics device.
    pub fn restarted(self) -> Self {
        Self::new(self.folder)
    }

    /// The shaders, if the folder has changed since the last check; `time` in s limits the rate of the checks.
    pub fn reload_if_changed(&mut self, time: f64) -> Option<Result<Shaders, ShaderError>> {
        if time < self.next {
            return None;
        }
        self.next = time + LOOK_S;
        let mut stamp: Vec<_> = std::fs::read_dir(&self.folder)
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|file| {
                let data = file.metadata().ok()?;
                Some((file.path(), data.modified().ok(), data.len()))
            })
            .collect();
        stamp.sort_unstable();
        if stamp == self.stamp {
            return None;
        }
        self.stamp = stamp;
        Some(Shaders::load(&self.folder))
    }
}
