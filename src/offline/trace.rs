//! Traces: where every moving body was, as CSV.
//!
//! One row per body and frame, `t,body,x,y,z,qw,qx,qy,qz`: the world pose of its glTF node (m, unit quaternion) at
//! t = k / fps. Numbers are written as the shortest text that reads back to the same bits, so two equal runs give
//! equal files. The file appears whole when the run ends.

use std::io::{self, Write};
use std::path::Path;

use super::whole_file::WholeFile;
use crate::exhibit::Exhibit;
use crate::math::Pose;
use crate::simulation::{STEPS_PER_SECOND, Simulation, Snapshot};

/// Frames per second of a trace nobody asked otherwise of.
pub const DEFAULT_FPS: u32 = 60;

/// Writes a trace while a run goes on.
pub struct TraceWriter {
    file: WholeFile,
    names: Vec<String>,
    fps: u64,
    frame: u64,
    before: Option<(u64, Vec<Pose>)>,
}

impl TraceWriter {
    /// Begins a trace of the exhibit at `fps` frames per second.
    pub fn create(path: &Path, exhibit: &Exhibit, fps: u32) -> io::Result<Self> {
        let mut file = WholeFile::create(path)?;
        writeln!(file, "t,body,x,y,z,qw,qx,qy,qz")?;
        let names = exhibit.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Self { file, names, fps: u64::from(fps.max(1)), frame: 0, before: None })
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
        // Frame k lies at step 240 k / fps; only its neighbours matter.
        let due = |frame: u64, step: u64| frame * STEPS_PER_SECOND <= step * self.fps;
        let next_matters = due(self.frame, step + 1);
        if !next_matters && !due(self.frame, step) {
            return Ok(());
        }
        let poses = poses();
        while self.frame * STEPS_PER_SECOND <= step * self.fps {
            let at = self.frame as f64 * STEPS_PER_SECOND as f64 / self.fps as f64;
            let t = self.frame as f64 / self.fps as f64;
            for (index, name) in self.names.iter().enumerate() {
                let pose = match &self.before {
                    Some((earlier, old)) if *earlier < step => {
                        let alpha = (at - *earlier as f64) / (step - earlier) as f64;
                        if alpha >= 1.0 { poses[index] } else { old[index].interpolate(&poses[index], alpha) }
                    }
                    _ => poses[index],
                };
                let (p, q) = (pose.position, pose.rotation);
                writeln!(self.file, "{t},{name},{},{},{},{},{},{},{}", p.x, p.y, p.z, q.w, q.x, q.y, q.z)?;
            }
            self.frame += 1;
        }
        self.before = Some((step, poses));
        Ok(())
    }

    /// Puts the file in its place.
    pub fn finish(self) -> io::Result<()> {
        self.file.finish()
    }
}
