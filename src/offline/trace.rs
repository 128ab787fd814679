//! Traces: where every moving body was, as CSV.
//!
//! One row per body and frame, `t,body,x,y,z,qw,qx,qy,qz`: the world pose of its glTF node (m, unit quaternion) at
//! t = k / fps. Numbers are written as the shortest text that reads back to the same bits, so two equal runs give
//! equal files. The file appears whole when the run ends.

use std::io::{self, Write};
use std::path::Path;

use super::frames::Frames;
use super::whole_file::WholeFile;
use soffio_exhibit::Exhibit;
use soffio_math::Pose;
use soffio_simulation::{Simulation, Snapshot};

/// Frames per second of a trace nobody asked otherwise of.
pub const DEFAULT_FPS: u32 = 60;

/// Writes a trace while a run goes on.
pub struct TraceWriter {
    file: WholeFile,
    names: Vec<String>,
    fps: u32,
    frames: Frames<Vec<Pose>>,
}

impl TraceWriter {
    /// Begins a trace of the exhibit at `fps` frames per second.
    pub fn create(path: &Path, exhibit: &Exhibit, fps: u32) -> io::Result<Self> {
        let mut file = WholeFile::create(path)?;
        writeln!(file, "t,body,x,y,z,qw,qx,qy,qz")?;
        let names = exhibit.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Self { file, names, fps: fps.max(1), frames: Frames::new(fps) })
    }

    /// Takes notice of a moment; moments come in order, each step once, from the start.
    pub fn push(&mut self, snapshot: &Snapshot) -> io::Result<()> {
        self.push_poses(snapshot.step, || snapshot.poses.clone())
    }

    /// The same straight from the simulation.
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

    /// Puts the file in its place.
    pub fn finish(self) -> io::Result<()> {
        self.file.finish()
    }
}
