//! Traces: poses of all moving bodies as CSV.
//!
//! One row for each body and frame, `t,body,x,y,z,qw,qx,qy,qz`: the world pose of its glTF node (m, unit quaternion) at
//! t = k / fps. Numbers are the shortest text that reads back to the same bits, so equal runs give equal files. The
//! file is written atomically.

use std::io::{self, Write};
use std::path::Path;

use super::atomic_file::AtomicFile;
use super::frames::Frames;
use soffio_exhibit::Exhibit;
use soffio_math::Pose;
use soffio_simulation::{Simulation, Snapshot};

/// Default frames per second.
pub const DEFAULT_FPS: u32 = 60;

/// Writes a trace during a run.
pub struct TraceWriter {
    file: AtomicFile,
    names: Vec<String>,
    fps: u32,
    frames: Frames<Vec<Pose>>,
}

impl TraceWriter {
    /// Creates a trace at `path` of the exhibit's bodies, at `fps` frames per second of simulated time.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(path: &Path, exhibit: &Exhibit, fps: u32) -> io::Result<Self> {
        let mut file = AtomicFile::create(path)?;
        writeln!(file, "t,body,x,y,z,qw,qx,qy,qz")?;
        let names = exhibit.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Self { file, names, fps: fps.max(1), frames: Frames::new(fps) })
    }

    /// Adds the frames that are due. Snapshots come in order, each step once, from the start.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, snapshot: &Snapshot) -> io::Result<()> {
        self.push_poses(snapshot.step, || snapshot.poses.clone())
    }

    /// As [`Self::push`], directly from the simulation.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push_simulation(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.push_poses(simulation.steps(), || simulation.bodies().iter().map(|body| body.pose()).collect())
    }

    fn push_poses(&mut self, step: u64, poses: impl FnOnce() -> Vec<Pose>) -> io::Result<()> {
        let Self { file, names, fps, frames } = self;
        frames.push(step, poses, |frame, poses| {
            let t = frame as f64 / f64::from(*fps);
            for (name, pose) in names.iter().zip(poses) {
                let (p, q) = (pose.position, pose.rotation);
                writeln!(file, "{t},{name},{},{},{},{},{},{},{}", p.x, p.y, p.z, q.w, q.x, q.y, q.z)?;
            }
            Ok(())
        })
    }

    /// Completes the file.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn finish(self) -> io::Result<()> {
        self.file.finish()
    }
}
