//! glTF export: a run as a model with key-frame animation.
//!
//! Each moving body is a root node of its own name with a translation and a rotation channel. Its descendants in the
//! exhibit's model are its descendants here; wires are tubes. Redundant key frames are left out: no point of a body
//! deviates by more than 10⁻⁵ m from the run.

use std::io::{self, Write};
use std::path::Path;

use super::super::atomic_file::AtomicFile;
use super::export_model::ExportModel;
use super::key_reduction;
use soffio_authoring::model_writer;
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{Animation, Channel, Curve, Track};
use soffio_math::Pose;

/// The poses of a run's frames.
pub struct AnimationBake {
    fps: u32,
    /// For each body, its poses frame by frame.
    poses: Vec<Vec<Pose>>,
}

impl AnimationBake {
    /// An empty bake.
    pub fn new(exhibit: &Exhibit, fps: u32) -> Self {
        Self { fps, poses: vec![Vec::new(); exhibit.bodies.len()] }
    }

    /// Adds the poses of the next frame, in the order of the exhibit's bodies.
    pub fn push(&mut self, poses: &[Pose]) {
        for (all, pose) in self.poses.iter_mut().zip(poses) {
            // Of a rotation's two quaternions, the one nearer to the last.
            let rotation = all.last().map_or(pose.rotation, |last| key_reduction::near(pose.rotation, last.rotation));
            all.push(Pose { rotation, ..*pose });
        }
    }

    /// Writes the model with its key frames as a `.glb`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, exhibit: &Exhibit, path: &Path) -> io::Result<()> {
        let mut file = AtomicFile::create(path)?;
        file.write_all(&self.bytes(exhibit))?;
        file.finish()
    }

    /// The model with its key frames as the bytes of a `.glb`.
    pub fn bytes(&self, exhibit: &Exhibit) -> Vec<u8> {
        let mut scenery = ExportModel::new(exhibit);
        let reaches = scenery.node_radii(exhibit);
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
        let (kept_places, kept_turns) =
            (key_reduction::position_keys(&places), key_reduction::rotation_keys(&turns, reach));
        let channel = |times, track| Channel { node, curve: Curve::Linear, times, track };
        [
            channel(times(&kept_places), Track::Translation(kept_places.iter().map(|&k| places[k]).collect())),
            channel(times(&kept_turns), Track::Rotation(kept_turns.iter().map(|&k| turns[k]).collect())),
        ]
    }
}
