//! Nodes whose scale key frames change.

use super::exhibit::Exhibit;
use super::model::Track;
use super::shapes::ShapeTrack;
use soffio_math::{DMat4, DQuat, DVec3};

/// Where a node stands at a time as far as scales move it, its own and those above it.
#[derive(Clone, Debug)]
pub struct Growth(Vec<Link>);

/// A node on the way from the root.
#[derive(Clone, Debug)]
struct Link {
    /// In its parent at rest.
    local: DMat4,
    /// What changes its scale, beside the rotation and translation that it has.
    track: Option<(ShapeTrack, DQuat, DVec3)>,
}

impl Link {
    fn at(&self, t: f64) -> DMat4 {
        let Some((track, rotation, translation)) = &self.track else { return self.local };
        let scale = track.channel.scale(track.time(t)).unwrap_or(DVec3::ONE);
        DMat4::from_scale_rotation_translation(scale, *rotation, *translation)
    }
}

impl Growth {
    /// Of a node of an exhibit's model.
    pub fn of(exhibit: &Exhibit, node: usize) -> Self {
        let above = std::iter::successors(Some(node), |&n| exhibit.model.nodes[n].parent);
        let mut links: Vec<Link> =
            above.map(|n| Link { local: exhibit.model.nodes[n].local, track: scale_of(exhibit, n) }).collect();
        links.reverse();
        Self(links)
    }

    /// Does any scale change?
    pub fn grows(&self) -> bool {
        self.0.iter().any(|link| link.track.is_some())
    }

    /// Node to world at `t` seconds.
    pub fn world(&self, t: f64) -> DMat4 {
        self.0.iter().fold(DMat4::IDENTITY, |above, link| above * link.at(t))
    }

    /// Its rotation and place in the world at `t` seconds; `None` where a scale above it is zero then.
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
