//! A run as a glTF model with key frames, for any program that shows such models.
//!
//! Each moving body is a node of the scene's root by its own name, moved by a translation and a rotation channel; what
//! hangs from it in the exhibit's model hangs from it here. Wires are tubes. Key frames that straight lines between
//! others lead past are left out: no point of a body is farther than 10⁻⁵ m from where the run had it.

use std::io::{self, Write};
use std::path::Path;

use super::super::whole_file::WholeFile;
use super::scenery::Scenery;
use super::thin;
use soffio_authoring::model_writer;
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{Animation, Channel, Curve, Track};
use soffio_math::Pose;

/// Poses of a run's frames.
pub struct Bake {
    fps: u32,
    /// A list a body, a pose a frame.
    poses: Vec<Vec<Pose>>,
}

impl Bake {
    /// Begins with no frame.
    pub fn new(exhibit: &Exhibit, fps: u32) -> Self {
        Self { fps, poses: vec![Vec::new(); exhibit.bodies.len()] }
    }

    /// Adds the poses of the next frame, in the order of the exhibit's bodies.
    pub fn push(&mut self, poses: &[Pose]) {
        for (all, pose) in self.poses.iter_mut().zip(poses) {
            // Of a rotation's two quaternions the one that follows the last.
            let rotation = all.last().map_or(pose.rotation, |last| thin::near(pose.rotation, last.rotation));
            all.push(Pose { rotation, ..*pose });
        }
    }

    /// Writes the model with its key frames as a `.glb`.
    pub fn write(&self, exhibit: &Exhibit, path: &Path) -> io::Result<()> {
        let mut file = WholeFile::create(path)?;
        file.write_all(&self.bytes(exhibit))?;
        file.finish()
    }

    /// The same as bytes.
    pub fn bytes(&self, exhibit: &Exhibit) -> Vec<u8> {
        let mut scenery = Scenery::new(exhibit);
        let reaches = scenery.reaches(exhibit);
        let mut channels = Vec::new();
        for ((body, poses), reach) in exhibit.bodies.iter().zip(&self.poses).zip(reaches) {
            let Some(first) = poses.first() else { continue };
            if poses.iter().any(|pose| pose != first) {
                channels.extend(self.channels(body.node, poses, reach));
            }
        }
        if !channels.is_empty() {
            scenery.model.animations = vec![Animation { name: exhibit.id.clone(), channels }];
        }
        let credit = &exhibit.credit;
        let copyright = [&credit.model_author, &credit.model_license, &credit.notice];
        let said: Vec<&str> = copyright.into_iter().map(|part| part.trim()).filter(|part| !part.is_empty()).collect();
        model_writer::write(&scenery.model, &said.join("; "))
    }

    fn channels(&self, node: usize, poses: &[Pose], reach: f64) -> [Channel; 2] {
        let places: Vec<_> = poses.iter().map(|pose| pose.position).collect();
        let turns: Vec<_> = poses.iter().map(|pose| pose.rotation).collect();
        let times = |kept: &[usize]| kept.iter().map(|&k| k as f64 / f64::from(self.fps)).collect();
        let (kept_places, kept_turns) = (thin::places(&places), thin::turns(&turns, reach));
        let channel = |times, track| Channel { node, curve: Curve::Linear, times, track };
        [
            channel(times(&kept_places), Track::Translation(kept_places.iter().map(|&k| places[k]).collect())),
            channel(times(&kept_turns), Track::Rotation(kept_turns.iter().map(|&k| turns[k]).collect())),
        ]
    }
}
