//! Scene-graph transforms of nodes whose scale is animated by key frames (glTF 2.0, 3.11).

use super::exhibit::Exhibit;
use super::model::Track;
use super::shape_tracks::ShapeTrack;
use soffio_math::{DMat4, DQuat, DVec3};

/// World transform of a node as a function of time, where key frames animate its own scale or an ancestor's.
#[derive(Clone, Debug)]
pub struct AnimatedScale(Vec<Link>);

/// A node on the path from the root.
#[derive(Clone, Debug)]
struct Link {
    /// Transform to the parent in the model.
    local: DMat4,
    /// Animated scale with the node's own rotation and translation; `None` where the scale is constant.
    track: Option<(ShapeTrack, DQuat, DVec3)>,
}

impl Link {
    fn at(&self, t: f64) -> DMat4 {
        let Some((track, rotation, translation)) = &self.track else { return self.local };
        let scale = track.channel.scale(track.time(t)).unwrap_or(DVec3::ONE);
        DMat4::from_scale_rotation_translation(scale, *rotation, *translation)
    }
}

impl AnimatedScale {
    /// The transforms of a node of an exhibit's model.
    pub fn of(exhibit: &Exhibit, node: usize) -> Self {
        let above = std::iter::successors(Some(node), |&n| exhibit.model.nodes[n].parent);
        let mut links: Vec<Link> =
            above.map(|n| Link { local: exhibit.model.nodes[n].local, track: scale_of(exhibit, n) }).collect();
        links.reverse();
        Self(links)
    }

    /// Is any scale on the path animated?
    pub fn is_animated(&self) -> bool {
        self.0.iter().any(|link| link.track.is_some())
    }

    /// Transform from node to world at `t` seconds.
    pub fn world(&self, t: f64) -> DMat4 {
        self.0.iter().fold(DMat4::IDENTITY, |above, link| above * link.at(t))
    }

    /// Rotation and position in the world at `t` seconds, without scale; `None` where a scale above the node is zero
    /// then.
    pub fn frame(&self, t: f64) -> Option<DMat4> {
        let (own, above) = self.0.split_last()?;
        let world = above.iter().fold(DMat4::IDENTITY, |above, link| above * link.at(t)) * own.local;
        let (_, rotation, translation) = world.to_scale_rotation_translation();
        let frame = DMat4::from_rotation_translation(rotation, translation);
        frame.is_finite().then_some(frame)
    }
}

fn scale_of(exhibit: &Exhibit, node: usize) -> Option<(ShapeTrack, DQuat, DVec3)> {
    exhibit.shapes.iter().filter(|track| track.channel.node == node).find_map(|track| match track.channel.track {
        Track::Scale(_, rotation, translation) => Some((track.clone(), rotation, translation)),
        _ => None,
    })
}
