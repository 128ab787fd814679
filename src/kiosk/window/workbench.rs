//! A folder of shaders that somebody works on while the kiosk runs (`--shaders`): read anew when a file in it changes. What has
//! a mistake is said and the last good one stays; see [`Shaders`].

use std::path::PathBuf;
use std::time::SystemTime;

use soffio_render::Shaders;
use soffio_render::shaders::ShaderError;

/// Between two looks at the folder, s.
const LOOK_S: f64 = 0.5;

/// The folder, as it was when it was last read.
#[derive(Debug)]
pub struct Workbench {
    folder: PathBuf,
    /// Name, time and length of each file.
    stamp: Vec<(PathBuf, Option<SystemTime>, u64)>,
    next: f64,
}

impl Workbench {
    /// Nothing is read yet.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder, stamp: Vec::new(), next: 0.0 }
    }

    /// The same folder, to be read once more: a new graphics device knows nothing of it.
    pub fn again(self) -> Self {
        Self::new(self.folder)
    }

    /// What the folder holds, where that is something else than at the last look; `time` in s, for a look now and then.
    pub fn news(&mut self, time: f64) -> Option<Result<Shaders, ShaderError>> {
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
